/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of probes.csv and steps.csv. */
#include "table.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE_ROWS = 8192 }; /* kept in memory; more than a plot has pixels */

/* Forget every second kept row: a run of any length needs the same memory. */
static void table_thin(table *t)
{
    int64_t half = (t->count + 1) / 2;
    size_t size = (size_t)t->columns * sizeof *t->kept;
    for (int64_t i = 1; i < half; i++) memmove(t->kept + i * t->columns, t->kept + 2 * i * t->columns, size);
    t->count = half;
    t->stride *= 2;
}

static void table_keep(table *t, const double *row)
{
    if (t->seen++ % t->stride != 0) return;
    if (t->count == TABLE_ROWS) {
        table_thin(t);
        if ((t->seen - 1) % t->stride != 0) return;
    }
    memcpy(t->kept + t->count++ * t->columns, row, (size_t)t->columns * sizeof *row);
}

bool table_open(table *t, const char *folder, const char *name, const char *header, int columns, double interval)
{
    *t = (table){.columns = columns, .interval = interval, .stride = 1};
    snprintf(t->path, sizeof t->path, "%s/%s", folder, name);
    t->before = calloc((size_t)columns, sizeof *t->before);
    t->row = calloc((size_t)columns, sizeof *t->row);
    t->kept = calloc((size_t)columns * TABLE_ROWS, sizeof *t->kept);
    t->file = fopen(t->path, "w");
    if (!t->file)
        fprintf(stderr, "%s: %s\n", t->path, strerror(errno));
    else if (!t->before || !t->row || !t->kept)
        fprintf(stderr, "%s: out of memory\n", t->path);
    else
        return fprintf(t->file, "%s\n", header) > 0;
    return false;
}

void table_append(table *t, const double *row)
{
    for (int i = 0; i < t->columns; i++) {
        if (fprintf(t->file, i ? ",%.17g" : "%.17g", row[i]) < 0) t->failed = true;
    }
    if (fputc('\n', t->file) == EOF) t->failed = true;
    table_keep(t, row);
}

/* Output times are met within a billionth of the interval, so that 0.1 + 0.2 counts as 0.3. */
static double table_time(const table *t)
{
    return (double)t->next * t->interval;
}

bool table_wants(const table *t, double time, double ahead)
{
    return table_time(t) <= time + ahead + 1e-9 * t->interval;
}

void table_sample(table *t, const double *row)
{
    while (table_wants(t, row[0], 0)) {
        double time = table_time(t), span = row[0] - t->before[0];
        double f = t->has_before && span > 0 ? (time - t->before[0]) / span : 1;
        if (f < 0) f = 0;
        if (f > 1) f = 1;
        for (int i = 1; i < t->columns; i++) t->row[i] = f < 1 ? t->before[i] + f * (row[i] - t->before[i]) : row[i];
        t->row[0] = time;
        table_append(t, t->row);
        t->next++;
    }
    memcpy(t->before, row, (size_t)t->columns * sizeof *row);
    t->has_before = true;
}

void table_flush(table *t)
{
    if (fflush(t->file) != 0) t->failed = true;
}

bool table_close(table *t)
{
    if (t->file && fclose(t->file) != 0) t->failed = true;
    t->file = NULL;
    if (t->failed) fprintf(stderr, "%s: could not be written completely\n", t->path);
    return !t->failed;
}

void table_free(table *t)
{
    free(t->before);
    free(t->row);
    free(t->kept);
    *t = (table){0};
}
