/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of a run: a line "t[s],P1[Pa],..." and rows of numbers. */
#include "page_read.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE_COLUMNS = 4096 };

static mps_status no_memory(page_errors *e)
{
    return mps__page_fail(e, MPS_E_NOMEM, "no memory for the page");
}

/* "P1[Pa]" becomes "P1", "Pa". */
static mps_status take_name(page_errors *e, page_table *t, const char *text, size_t length)
{
    const char *open = memchr(text, '[', length);
    const size_t name = open ? (size_t)(open - text) : length;
    const size_t unit = open && text[length - 1] == ']' ? length - name - 2 : 0;
    t->name[t->columns] = strndup(text, name);
    t->unit[t->columns] = strndup(unit ? open + 1 : "", unit);
    if (t->name[t->columns] && t->unit[t->columns]) {
        t->columns++;
        return MPS_OK;
    }
    free(t->name[t->columns]);
    free(t->unit[t->columns]);
    return no_memory(e);
}

static mps_status read_header(page_errors *e, const char *path, page_table *t, const char *line)
{
    int32_t count = 1;
    for (const char *c = line; *c; c++) count += *c == ',';
    if (count > TABLE_COLUMNS)
        return mps__page_fail(e, MPS_E_IO, "'%s' has %d columns, at most %d are read", path,
                              (int)count, TABLE_COLUMNS);
    t->name = calloc((size_t)count, sizeof *t->name);
    t->unit = calloc((size_t)count, sizeof *t->unit);
    if (!t->name || !t->unit) return no_memory(e);
    mps_status status = MPS_OK;
    for (int32_t k = 0; status == MPS_OK && k < count; k++) {
        const size_t length = strcspn(line, ",\r\n");
        status = take_name(e, t, line, length);
        line += length + (line[length] == ',');
    }
    return status;
}

static bool grow(page_table *t, int64_t *capacity)
{
    if (t->rows < *capacity) return true;
    const int64_t wanted = *capacity ? 2 * *capacity : 1024;
    double *more = realloc(t->value, (size_t)wanted * (size_t)t->columns * sizeof *more);
    if (!more) return false;
    t->value = more;
    *capacity = wanted;
    return true;
}

/* A row without an end was cut off by the end of its program. @return false: it is not a row */
static bool read_row(const char *line, int32_t columns, double *row)
{
    for (int32_t i = 0; i < columns; i++) {
        char *end;
        row[i] = strtod(line, &end);
        if (end == line) return false;
        if (i + 1 < columns ? *end != ',' : *end != '\n' && *end != '\r') return false;
        line = end + 1;
    }
    return isfinite(row[0]);
}

/* Why there is no further line: no memory, an error of the file, or its end, which is MPS_OK. */
static mps_status no_line(page_errors *e, const char *path, FILE *file)
{
    if (errno == ENOMEM) return no_memory(e);
    if (!ferror(file)) return MPS_OK;
    return mps__page_fail(e, MPS_E_IO, "cannot read '%s': %s", path, strerror(errno));
}

static mps_status read_rows(page_errors *e, const char *path, page_table *t, FILE *file)
{
    char *line = NULL;
    size_t size = 0;
    int64_t capacity = 0;
    bool cut = false;
    mps_status status = MPS_OK;
    errno = 0;
    while (status == MPS_OK && getline(&line, &size, file) > 0) {
        if (cut)
            status = mps__page_fail(e, MPS_E_IO, "'%s', line %lld: %d numbers are wanted", path,
                                    (long long)t->rows + 2, (int)t->columns);
        else if (!grow(t, &capacity))
            status = no_memory(e);
        else if (read_row(line, t->columns, t->value + t->rows * t->columns))
            t->rows++;
        else
            cut = true;
    }
    if (status == MPS_OK) status = no_line(e, path, file);
    free(line);
    return status;
}

static mps_status read_open(page_errors *e, const char *path, page_table *t, FILE *file)
{
    char *line = NULL;
    size_t size = 0;
    mps_status status = MPS_OK;
    errno = 0;
    if (getline(&line, &size, file) <= 0) {
        status = no_line(e, path, file);
        if (status == MPS_OK) status = mps__page_fail(e, MPS_E_IO, "'%s' is empty", path);
    }
    if (status == MPS_OK) status = read_header(e, path, t, line);
    if (status == MPS_OK) status = read_rows(e, path, t, file);
    free(line);
    return status;
}

mps_status mps__page_table_read(page_errors *e, const char *path, page_table *out)
{
    *out = (page_table){0};
    FILE *file = fopen(path, "r");
    if (!file && errno == ENOENT) return MPS_E_NAME;
    if (!file) return mps__page_fail(e, MPS_E_IO, "cannot open '%s': %s", path, strerror(errno));
    mps_status status = read_open(e, path, out, file);
    fclose(file);
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
