/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of a run: a line "t[s],P1[Pa],..." and rows of numbers. */
#include "csv.h"
#include "page_read.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE_COLUMNS = 4096 };

static mps_status status_of(page_errors *e, const mps__csv *t, mps__csv_error error)
{
    if (error == CSV_OK) return MPS_OK;
    if (error == CSV_MISSING) return MPS_E_NAME;
    if (error == CSV_MEMORY) return mps__page_fail(e, MPS_E_NOMEM, "no memory for the page");
    return mps__page_fail(e, MPS_E_IO, "%s", t->why);
}

/* Transpose columns to rows, as pages use them. */
static mps_status take_rows(page_errors *e, page_table *out, mps__csv *t)
{
    const size_t columns = (size_t)t->columns, rows = (size_t)t->rows;
    out->value = calloc(rows > 0 ? rows : 1, columns * sizeof *out->value);
    if (!out->value) return status_of(e, t, CSV_MEMORY);
    for (size_t i = 0; i < rows; i++) {
        for (size_t k = 0; k < columns; k++) out->value[i * columns + k] = t->value[k][i];
        if (!isfinite(t->value[0][i]))
            return mps__page_fail(e, MPS_E_IO, "%s:%lld: the time is %g", t->path,
                                  (long long)t->line[i], t->value[0][i]);
    }
    out->columns = t->columns;
    out->rows = t->rows;
    out->name = t->name;
    out->unit = t->unit;
    t->name = NULL;
    t->unit = NULL;
    return MPS_OK;
}

mps_status mps__page_table_read(const page_run *r, const char *path, page_table *out)
{
    mps__csv t;
    *out = (page_table){0};
    mps_status status = status_of(r->errors, &t, mps__csv_open_in(&t, r->folder, path, CSV_OWN));
    if (status == MPS_OK && t.columns > TABLE_COLUMNS)
        status = mps__page_fail(r->errors, MPS_E_IO, "'%s' has %d columns, at most %d are read",
                                path, (int)t.columns, TABLE_COLUMNS);
    if (status == MPS_OK) status = status_of(r->errors, &t, mps__csv_read(&t));
    if (status == MPS_OK) status = take_rows(r->errors, out, &t);
    mps__csv_free(&t);
    if (status != MPS_OK) mps__page_table_free(out);
    return status;
}

void mps__page_table_free(page_table *t)
{
    for (int32_t k = 0; k < t->columns; k++) {
        free(t->name[k]);
        free(t->unit[k]);
    }
    free(t->name);
    free(t->unit);
    free(t->value);
    *t = (page_table){0};
}

bool mps__is_common(const char *name)
{
    static const char *const names[] = {"ke",       "x_tank",  "pe",        "wall_work_momentum",
                                        "viscous",  "plugins", "collision", "wall_work_probes",
                                        "shift",    "added",   "numerical", "volume_error",
                                        "friction", "layers"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp(name, names[k]) == 0) return true;
    return false;
}

int32_t mps__page_table_find(const page_table *t, const char *name)
{
    for (int32_t k = 0; k < t->columns; k++)
        if (strcmp(t->name[k], name) == 0) return k;
    return -1;
}

double mps__page_table_last(const page_table *t, int32_t column)
{
    return t->rows > 0 && column >= 0 ? t->value[(t->rows - 1) * t->columns + column] : NAN;
}
