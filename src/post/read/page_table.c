/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of a run: a line "t[s],P1[Pa],..." and rows of numbers. */
#include "page_read.h"
#include "tables.h"
#include <math.h>
#include <string.h>

enum { TABLE_COLUMNS = 4096 };

static mps_status status_of(page_errors *e, const mps__csv *t, mps__csv_error error)
{
    if (error == CSV_OK) return MPS_OK;
    if (error == CSV_MISSING) return MPS_E_NAME;
    if (error == CSV_MEMORY) return mps__page_fail(e, MPS_E_NOMEM, "no memory for the page");
    return mps__page_fail(e, MPS_E_IO, "%s", t->why);
}

static mps_status check_times(page_errors *e, const mps__csv *t)
{
    for (int64_t i = 0; i < t->rows; i++)
        if (!isfinite(t->value[0][i]))
            return mps__page_fail(e, MPS_E_IO, "%s:%lld: the time is %g", t->path,
                                  (long long)t->line[i], t->value[0][i]);
    return MPS_OK;
}

mps_status mps__page_table_read(const page_run *r, const char *path, mps__csv *out)
{
    page_errors *e = r->errors;
    mps_status status = status_of(e, out, mps__csv_open_in(out, r->folder, path, CSV_OWN));
    if (status == MPS_OK && out->columns > TABLE_COLUMNS)
        status = mps__page_fail(e, MPS_E_IO, "'%s' has %d columns, at most %d are read", path,
                                (int)out->columns, TABLE_COLUMNS);
    if (status == MPS_OK) status = status_of(e, out, mps__csv_read(out));
    if (status == MPS_OK) status = check_times(e, out);
    if (status != MPS_OK) mps__csv_free(out);
    return status;
}

bool mps__is_common(const char *name)
{
#define QUOTED(name) #name,
    static const char *const names[] = {COMMON_COLUMNS(QUOTED)};
#undef QUOTED
    _Static_assert(sizeof names / sizeof *names == COLUMN_COMMON, "a name for each index");
    for (int k = 0; k < COLUMN_COMMON; k++)
        if (strcmp(name, names[k]) == 0) return true;
    return false;
}

int32_t mps__page_table_find(const mps__csv *t, const char *name)
{
    for (int32_t k = 0; k < t->columns; k++)
        if (strcmp(t->name[k], name) == 0) return k;
    return -1;
}

double mps__page_table_last(const mps__csv *t, int32_t column)
{
    return t->rows > 0 && column >= 0 ? t->value[column][t->rows - 1] : NAN;
}
