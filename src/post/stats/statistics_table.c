/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns of a CSV file: the time, which increases from row to row, and the wanted ones. */
#include "csv.h"
#include "page_read.h"
#include "statistics.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct mps_table {
    mps__csv csv;
    int32_t columns; /* including the time, which is the first */
    int32_t *column; /* [columns] their indices in `csv` */
    char *label;     /* of a reference, or NULL */
    bool points;
};

/* Selected columns of a file. */
typedef struct choice {
    const char *folder; /* that must contain the file; NULL: any */
    const char *path;
    int32_t count; /* 0: all columns */
    const char *const *names;
} choice;

static mps_status status_of(const mps_stats_config *config, const mps__csv *t, mps__csv_error error)
{
    if (error == CSV_OK) return MPS_OK;
    if (error == CSV_MEMORY) return mps__stats_no_memory(config);
    return mps__stats_fail(config, MPS_E_IO, "%s", t->why);
}

/* Whether this is the name of column k, with or without its unit. */
static bool has_name(const mps__csv *t, int32_t k, const char *name)
{
    const size_t length = strlen(t->name[k]), unit = strlen(t->unit[k]);
    if (strncmp(name, t->name[k], length) != 0) return false;
    if (!name[length]) return true;
    return unit > 0 && strlen(name) == length + unit + 2 && name[length] == '[' &&
           strncmp(name + length + 1, t->unit[k], unit) == 0 && name[length + 1 + unit] == ']';
}

/* The index of a column; -1 and an error text if there is none. */
static int32_t find_column(const mps_stats_config *config, const mps__csv *t, const char *name)
{
    int32_t found = -1, count = 0;
    char list[256] = "";
    for (int32_t k = 1; k < t->columns; k++) {
        const size_t used = strlen(list);
        if (has_name(t, k, name)) {
            found = k;
            count++;
        }
        snprintf(list + used, sizeof list - used, t->unit[k][0] ? "%s'%s[%s]'" : "%s'%s'",
                 k > 1 ? ", " : "", t->name[k], t->unit[k]);
    }
    if (count == 1) return found;
    mps__stats_fail(config, MPS_E_NAME, "%s: %s column has the name '%s'; columns are %s%s",
                    t->path, count ? "more than one" : "no", name, list,
                    strlen(list) + 1 == sizeof list ? " ..." : "");
    return -1;
}

static mps_status choose_columns(const mps_stats_config *config, int32_t count,
                                 const char *const *names, mps_table *table)
{
    mps__csv *t = &table->csv;
    const int32_t wanted = count > 0 ? count : t->columns - 1;
    table->column = calloc((size_t)wanted + 1, sizeof *table->column);
    if (!table->column) return mps__stats_no_memory(config);
    for (int32_t k = 0; k < t->columns; k++) t->wanted[k] = k == 0 || count == 0;
    for (int32_t k = 1; k <= wanted; k++) {
        table->column[k] = count == 0 ? k : find_column(config, t, names[k - 1]);
        if (table->column[k] < 0) return MPS_E_NAME;
        t->wanted[table->column[k]] = true;
    }
    table->columns = wanted + 1;
    return MPS_OK;
}

static mps_status check_times(const mps_stats_config *config, const mps__csv *t)
{
    for (int64_t i = 0; i < t->rows; i++) {
        const double *time = t->value[0], before = i > 0 ? time[i - 1] : -INFINITY;
        if (isfinite(time[i]) && time[i] > before) continue;
        return mps__stats_fail(config, MPS_E_IO,
                               "%s:%lld: the time is %.9g: must be larger than the one before it, "
                               "%.9g",
                               t->path, (long long)t->line[i], time[i], before);
    }
    return MPS_OK;
}

static mps_status read_file(const mps_stats_config *config, const choice *w, mps_table *table)
{
    mps__csv *t = &table->csv;
    const int32_t flags = w->folder ? CSV_OWN : CSV_OWN | CSV_ROUND;
    MPS__STATS_TRY(status_of(config, t, mps__csv_open_in(t, w->folder, w->path, flags)));
    MPS__STATS_TRY(choose_columns(config, w->count, w->names, table));
    MPS__STATS_TRY(status_of(config, t, mps__csv_read(t)));
    return check_times(config, t);
}

static mps_status read_table(const mps_stats_config *config, const choice *w, mps_table **table)
{
    mps_table *out = calloc(1, sizeof *out);
    const mps_status status = out ? read_file(config, w, out) : mps__stats_no_memory(config);
    if (status == MPS_OK)
        *table = out;
    else
        mps_table_destroy(out);
    return status;
}

mps_status mps_table_read(const mps_stats_config *config, const char *path, int32_t count,
                          const char *const *names, mps_table **table)
{
    if (table) *table = NULL;
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, table, "table is NULL");
    MPS__STATS_CHECK(config, path, "path is NULL");
    MPS__STATS_CHECK(config, count >= 0 && (names || count == 0), "count is %d: must be >= 0",
                     (int)count);
    for (int32_t k = 0; k < count; k++)
        MPS__STATS_CHECK(config, names[k], "names[%d] is NULL", (int)k);
    return read_table(config, &(choice){NULL, path, count, names}, table);
}

mps_status mps_table_read_run(const mps_stats_config *config, const char *folder, const char *name,
                              mps_table **table)
{
    if (table) *table = NULL;
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, table, "table is NULL");
    MPS__STATS_CHECK(config, folder && folder[0], "folder is required");
    MPS__STATS_CHECK(config, name && name[0], "name is required");
    char *path = mps__page_path(folder, name);
    if (!path) return mps__stats_no_memory(config);
    const mps_status status = read_table(config, &(choice){folder, path, 0, NULL}, table);
    free(path);
    return status;
}

void mps_table_destroy(mps_table *table)
{
    if (!table) return;
    mps__csv_free(&table->csv);
    free(table->column);
    free(table->label);
    free(table);
}

const char *mps_table_label(const mps_table *table)
{
    if (!table) return NULL;
    return table->label ? table->label : "";
}

int32_t mps_table_is_points(const mps_table *table)
{
    return table ? table->points : 0;
}

/* ---- references ---- */

/* Two columns, the time and the value, for so many rows. @return false: no memory */
static bool make_columns(mps_table *t, const json_value *one, size_t rows)
{
    static const char *const time[2] = {"t", "s"};
    mps__csv *c = &t->csv;
    c->name = calloc(2, sizeof *c->name);
    c->unit = calloc(2, sizeof *c->unit);
    c->value = calloc(2, sizeof *c->value);
    t->column = calloc(2, sizeof *t->column);
    t->label = strdup(mps__json_member(one, "label"));
    if (!c->name || !c->unit || !c->value || !t->column || !t->label) return false;
    c->columns = t->columns = 2;
    t->column[1] = 1;
    for (int k = 0; k < 2; k++) {
        c->name[k] = strdup(k ? mps__json_member(one, "column") : time[0]);
        c->unit[k] = strdup(k ? mps__json_member(one, "unit") : time[1]);
        c->value[k] = malloc((rows + 1) * sizeof **c->value);
        if (!c->name[k] || !c->unit[k] || !c->value[k]) return false;
    }
    return true;
}

bool mps__stats_reference(const json_value *one, mps_table **table)
{
    const json_value *list = mps__json_get(one, "points");
    mps_table *t = calloc(1, sizeof *t);
    *table = t;
    if (!t || !make_columns(t, one, mps__json_count(list))) return false;
    mps__csv *c = &t->csv;
    t->points = !mps__json_true(mps__json_get(one, "line"));
    for (const json_value *p = list ? list->first : NULL; p; p = p->next) {
        const double at = mps__json_number(mps__json_at(p, 0));
        if (!isfinite(at) || (c->rows > 0 && !(at > c->value[0][c->rows - 1]))) continue;
        c->value[0][c->rows] = at;
        c->value[1][c->rows++] = mps__json_number(mps__json_at(p, 1));
    }
    return true;
}

int64_t mps_table_rows(const mps_table *table)
{
    return table ? table->csv.rows : 0;
}

int32_t mps_table_columns(const mps_table *table)
{
    return table ? table->columns - 1 : 0;
}

/* Index of a column in the file; -1: none. */
static int32_t column_at(const mps_table *table, int32_t index)
{
    return table && index >= -1 && index < table->columns - 1 ? table->column[index + 1] : -1;
}

const char *mps_table_name(const mps_table *table, int32_t index)
{
    const int32_t k = column_at(table, index);
    return k >= 0 ? table->csv.name[k] : NULL;
}

const char *mps_table_unit(const mps_table *table, int32_t index)
{
    const int32_t k = column_at(table, index);
    return k >= 0 ? table->csv.unit[k] : NULL;
}

int32_t mps_table_is_common(const mps_table *table, int32_t index)
{
    const int32_t k = column_at(table, index);
    return k >= 0 && mps__is_common(table->csv.name[k]);
}

const double *mps_table_values(const mps_table *table, int32_t index)
{
    const int32_t k = column_at(table, index);
    return k >= 0 ? table->csv.value[k] : NULL;
}
