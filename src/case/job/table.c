/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes and reads rows of tables. */
#include "table.h"
#include "regular.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NUMBER_SIZE = 32 }; /* characters of a number and its comma */

static void table_fail(table *t)
{
    if (!t->failed) t->error = errno;
    t->failed = true;
}

static bool table_refuse(table *t, const char *why)
{
    snprintf(t->why, sizeof t->why, "%s: %s", t->path, why);
    return false;
}

bool mps__table_create(table *t, const char *folder, const char *name, int columns, double interval)
{
    *t = (table){.columns = columns, .interval = interval};
    snprintf(t->path, sizeof t->path, "%s/%s", folder, name);
    t->before = calloc((size_t)columns, sizeof *t->before);
    t->row = calloc((size_t)columns, sizeof *t->row);
    if (t->before && t->row) return true;
    return table_refuse(t, "out of memory");
}

bool mps__table_begin(table *t, const char *header)
{
    t->file = fopen(t->path, "w");
    if (!t->file) return table_refuse(t, strerror(errno));
    if (fprintf(t->file, "%s\n", header) > 0) return true;
    return table_refuse(t, strerror(errno));
}

void mps__table_append(table *t, const double *row)
{
    for (int i = 0; i < t->columns; i++) {
        if (fprintf(t->file, i ? ",%.17g" : "%.17g", row[i]) < 0) table_fail(t);
    }
    if (fputc('\n', t->file) == EOF) table_fail(t);
}

/* Output times have a tolerance of 1e-9 of the interval, so that 0.1 + 0.2 equals 0.3. */
static double table_time(const table *t)
{
    return (double)t->next * t->interval;
}

bool mps__table_wants(const table *t, double time, double ahead)
{
    return table_time(t) <= time + ahead + 1e-9 * t->interval;
}

void mps__table_sample(table *t, const double *row)
{
    while (mps__table_wants(t, row[0], 0)) {
        double time = table_time(t), span = row[0] - t->before[0];
        double f = t->has_before && span > 0 ? (time - t->before[0]) / span : 1;
        if (f < 0) f = 0;
        if (f > 1) f = 1;
        for (int i = 1; i < t->columns; i++)
            t->row[i] = f < 1 ? t->before[i] + f * (row[i] - t->before[i]) : row[i];
        t->row[0] = time;
        mps__table_append(t, t->row);
        if (t->each) t->each(t->user, t->row);
        t->next++;
    }
    memcpy(t->before, row, (size_t)t->columns * sizeof *row);
    t->has_before = true;
}

/* ---- continuing a file ----------------------------------------------------------------------- */

/* Parse a complete row: one number per column, and nothing else. */
static bool table_parse(const char *line, int columns, double *row)
{
    for (int i = 0; i < columns; i++) {
        char *end;
        row[i] = strtod(line, &end);
        if (end == line || *end != (i + 1 < columns ? ',' : '\n')) return false;
        line = end + 1;
    }
    return *line == '\0';
}

/* Read a line of less than `size` bytes. A file of another length has no more memory than that.
 * @return false: there is none, or it is longer or incomplete */
static bool next_line(table *t, char *line, size_t size)
{
    return fgets(line, (int)size, t->file) && strchr(line, '\n');
}

/* Read rows while they are complete and not later than `time`; t->end is the offset after the last
 * of them. */
static bool table_read(table *t, double time)
{
    const size_t size = (size_t)t->columns * NUMBER_SIZE + 2;
    char *line = malloc(size);
    bool good = line != NULL;
    while (good && next_line(t, line, size) && table_parse(line, t->columns, t->row)) {
        if (t->row[0] > time + 1e-9 * t->interval) break;
        good = t->interval == 0 || t->row[0] == table_time(t);
        if (!good) break;
        if (t->each) t->each(t->user, t->row);
        t->next++;
        t->end = ftell(t->file);
    }
    free(line);
    return good;
}

static bool table_same_header(table *t, const char *header)
{
    const size_t length = strlen(header);
    char *line = malloc(length + 2);
    const bool same = line && next_line(t, line, length + 2) && strncmp(line, header, length) == 0;
    free(line);
    t->end = ftell(t->file);
    return same;
}

bool mps__table_resume(table *t, const char *header, double time)
{
    const char *why;
    t->file = mps__regular_stream(t->path, O_RDWR, &why);
    if (!t->file) return table_refuse(t, why ? why : strerror(errno));
    if (!table_same_header(t, header)) return table_refuse(t, "has not the columns of this run");
    if (!table_read(t, time))
        return table_refuse(t, "has rows at other times; their rate must be what it was");
    if (t->interval > 0 && mps__table_wants(t, time, 0))
        return table_refuse(t, "ends before the checkpoint");
    return true;
}

bool mps__table_cut(table *t)
{
    if (fseek(t->file, t->end, SEEK_SET) == 0 && ftruncate(fileno(t->file), (off_t)t->end) == 0)
        return true;
    return table_refuse(t, strerror(errno));
}

/* ---- the end --------------------------------------------------------------------------------- */

void mps__table_flush(table *t)
{
    if (fflush(t->file) != 0) table_fail(t);
}

void mps__table_sync(table *t)
{
    mps__table_flush(t);
    if (fsync(fileno(t->file)) != 0) table_fail(t);
}

bool mps__table_close(table *t)
{
    if (t->file && fclose(t->file) != 0) table_fail(t);
    t->file = NULL;
    return !t->failed;
}

void mps__table_free(table *t)
{
    if (t->file) fclose(t->file); /* NULL in a job that could not open all of its tables */
    free(t->before);
    free(t->row);
    *t = (table){0};
}
