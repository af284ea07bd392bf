/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns of a CSV file. The file is read in blocks; only the columns that are wanted are kept. */
#include "statistics.h"
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 1 << 16, LINE_MOST = 1 << 24, SHOWN = 24 };

typedef struct column {
    char *name, *unit; /* one block; free `name` */
    int32_t field;     /* in the file */
    double *value;     /* [capacity] */
} column;

struct mps_table {
    int64_t rows, capacity;
    int32_t columns; /* with the time, which is the first */
    column *column;
};

/* A file, read line by line. */
typedef struct reader {
    const mps_stats_config *config;
    const char *path;
    FILE *in;
    char *buffer;
    size_t size, begin, end; /* of what is read and not yet used */
    int64_t line;            /* number of the last line, from 1 */
    bool over;
    int32_t fields;
} reader;

/* ---- lines ---- */

/* More of the file into the buffer, which may move. */
static mps_status fill(reader *r)
{
    if (r->begin > 0) /* the rest of a line */
        memmove(r->buffer, r->buffer + r->begin, r->end - r->begin);
    r->end -= r->begin;
    r->begin = 0;
    if (r->size - r->end < BLOCK) {
        if (r->size > LINE_MOST)
            return mps__stats_fail(r->config, MPS_E_IO, "%s:%lld: a line of more than %d bytes",
                                   r->path, (long long)r->line + 1, LINE_MOST);
        const size_t size = 2 * r->size + 2 * BLOCK;
        char *buffer = realloc(r->buffer, size);
        if (!buffer) return mps__stats_no_memory(r->config);
        r->buffer = buffer;
        r->size = size;
    }
    errno = 0;
    const size_t got = fread(r->buffer + r->end, 1, BLOCK, r->in);
    r->end += got;
    r->over = got < BLOCK;
    if (ferror(r->in))
        return mps__stats_fail(r->config, MPS_E_IO, "%s: %s", r->path, strerror(errno));
    return MPS_OK;
}

/* The next line, without its end; NULL: no more. */
static mps_status next_line(reader *r, char **line)
{
    size_t searched = 0;
    *line = NULL;
    for (;;) {
        char *from = r->buffer + r->begin;
        char *end = memchr(from + searched, '\n', r->end - r->begin - searched);
        if (end) {
            *end = '\0';
            *line = from;
            r->begin = (size_t)(end - r->buffer) + 1;
            r->line++;
            if (strlen(from) == (size_t)(end - from)) return MPS_OK;
            return mps__stats_fail(r->config, MPS_E_IO, "%s:%lld: has a byte 0: no text file",
                                   r->path, (long long)r->line);
        }
        if (r->over) return MPS_OK;
        searched = r->end - r->begin;
        MPS__STATS_TRY(fill(r));
    }
}

static char *skip_blanks(char *s)
{
    while (*s == ' ' || *s == '\t' || *s == '\r') s++;
    return s;
}

/* Empty lines and comments. */
static bool is_nothing(char *line)
{
    const char first = *skip_blanks(line);
    return first == '\0' || first == '#';
}

/* End this field with a 0, without the blanks around it. @return the next field, NULL behind the last */
static char *split(char **field)
{
    char *comma = strchr(*field, ','), *end = comma ? comma : *field + strlen(*field);
    *field = skip_blanks(*field);
    while (end > *field && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r')) end--;
    *end = '\0';
    return comma ? comma + 1 : NULL;
}

/* ---- columns ---- */

/* "P1[Pa]": name and unit. */
static bool name_column(column *c, const char *header, int32_t field)
{
    const size_t length = strlen(header);
    c->name = malloc(length + 2);
    if (!c->name) return false;
    memcpy(c->name, header, length + 1);
    c->unit = c->name + length;
    c->field = field;
    char *bracket = length > 1 && header[length - 1] == ']' ? strrchr(c->name, '[') : NULL;
    if (!bracket || bracket == c->name) return true;
    c->name[length - 1] = '\0';
    *bracket = '\0';
    c->unit = bracket + 1;
    return true;
}

/* Does the header "P1[Pa]" have this name, with or without its unit? */
static bool has_name(const char *header, const char *name)
{
    const size_t length = strlen(name), whole = strlen(header);
    if (strncmp(header, name, length) != 0) return false;
    return header[length] == '\0' ||
           (length > 0 && header[length] == '[' && header[whole - 1] == ']');
}

/* The field of a name; -1 and a text otherwise. */
static int32_t find_field(const reader *r, char **header, const char *name)
{
    int32_t found = -1, count = 0;
    char list[256] = "";
    for (int32_t k = 1; k < r->fields; k++) {
        const size_t used = strlen(list);
        if (has_name(header[k], name)) {
            found = k;
            count++;
        }
        snprintf(list + used, sizeof list - used, "%s'%s'", k > 1 ? ", " : "", header[k]);
    }
    if (count == 1) return found;
    mps__stats_fail(r->config, MPS_E_NAME, "%s: %s column has the name '%s'; columns are %s%s",
                    r->path, count ? "more than one" : "no", name, list,
                    strlen(list) + 1 == sizeof list ? " ..." : "");
    return -1;
}

static mps_status choose_columns(const reader *r, char **header, int32_t count,
                                 const char *const *names, mps_table *table)
{
    const int32_t wanted = count > 0 ? count : r->fields - 1;
    table->column = calloc((size_t)wanted + 1, sizeof *table->column);
    if (!table->column) return mps__stats_no_memory(r->config);
    for (int32_t k = 0; k <= wanted; k++) {
        const int32_t field = k == 0 || count == 0 ? k : find_field(r, header, names[k - 1]);
        if (field < 0) return MPS_E_NAME;
        table->columns = k + 1;
        if (!name_column(&table->column[k], header[field], field))
            return mps__stats_no_memory(r->config);
    }
    return MPS_OK;
}

static mps_status read_header(reader *r, int32_t count, const char *const *names, mps_table *table)
{
    char *line = NULL;
    do MPS__STATS_TRY(next_line(r, &line));
    while (line && is_nothing(line));
    if (!line) return mps__stats_fail(r->config, MPS_E_IO, "%s: has no header", r->path);
    if (r->line == 1 && strncmp(line, "\xef\xbb\xbf", 3) == 0) line += 3; /* mark of UTF-8 */
    r->fields = 1;
    for (const char *s = line; *s; s++) r->fields += *s == ',';
    char **header = malloc((size_t)r->fields * sizeof *header);
    if (!header) return mps__stats_no_memory(r->config);
    char *field = line;
    for (int32_t k = 0; k < r->fields; k++) {
        char *next = split(&field);
        header[k] = field;
        field = next;
    }
    const mps_status status = choose_columns(r, header, count, names, table);
    free(header);
    return status;
}

/* ---- rows ---- */

static mps_status make_room(const reader *r, mps_table *table)
{
    if (table->rows < table->capacity) return MPS_OK;
    const int64_t capacity = table->capacity ? 2 * table->capacity : 1024;
    if ((uint64_t)capacity > SIZE_MAX / sizeof(double)) return mps__stats_no_memory(r->config);
    for (int32_t k = 0; k < table->columns; k++) {
        double *value = realloc(table->column[k].value, (size_t)capacity * sizeof *value);
        if (!value) return mps__stats_no_memory(r->config);
        table->column[k].value = value;
    }
    table->capacity = capacity;
    return MPS_OK;
}

static mps_status read_number(const reader *r, char *field, double *value)
{
    char *end;
    *value = strtod(field, &end);
    if (end != field && *end == '\0') return MPS_OK;
    return mps__stats_fail(r->config, MPS_E_IO, "%s:%lld: '%.*s' is no number", r->path,
                           (long long)r->line, SHOWN, field);
}

static mps_status read_fields(const reader *r, char *line, char **fields)
{
    int32_t count = 0;
    for (char *field = line; field; count++) {
        char *next = split(&field);
        if (count < r->fields) fields[count] = field;
        field = next;
    }
    if (count == r->fields) return MPS_OK;
    return mps__stats_fail(r->config, MPS_E_IO, "%s:%lld: has %d values, the header has %d names",
                           r->path, (long long)r->line, (int)count, (int)r->fields);
}

static mps_status read_row(const reader *r, char *line, char **fields, mps_table *table)
{
    MPS__STATS_TRY(read_fields(r, line, fields));
    MPS__STATS_TRY(make_room(r, table));
    for (int32_t k = 0; k < table->columns; k++)
        MPS__STATS_TRY(
            read_number(r, fields[table->column[k].field], &table->column[k].value[table->rows]));
    const double *t = table->column[0].value, now = t[table->rows];
    if (!isfinite(now) || (table->rows > 0 && !(now > t[table->rows - 1])))
        return mps__stats_fail(r->config, MPS_E_IO,
                               "%s:%lld: the time is %.9g: must be larger than the one before it, "
                               "%.9g",
                               r->path, (long long)r->line, now,
                               table->rows > 0 ? t[table->rows - 1] : -INFINITY);
    table->rows++;
    return MPS_OK;
}

static mps_status read_rows(reader *r, mps_table *table)
{
    mps_status status = MPS_OK;
    char *line = NULL, **fields = malloc((size_t)r->fields * sizeof *fields);
    if (!fields) return mps__stats_no_memory(r->config);
    do {
        status = next_line(r, &line);
        if (status == MPS_OK && line && !is_nothing(line))
            status = read_row(r, line, fields, table);
    } while (status == MPS_OK && line);
    free(fields);
    return status;
}

/* ---- the file ---- */

static mps_status read_file(const mps_stats_config *config, const char *path, int32_t count,
                            const char *const *names, mps_table *table)
{
    errno = 0;
    reader r = {.config = config, .path = path, .in = fopen(path, "rb")};
    if (!r.in) return mps__stats_fail(config, MPS_E_IO, "%s: %s", path, strerror(errno));
    mps_status status = fill(&r);
    if (status == MPS_OK) status = read_header(&r, count, names, table);
    if (status == MPS_OK) status = read_rows(&r, table);
    free(r.buffer);
    fclose(r.in);
    return status;
}

/* Numbers have a point, whatever the locale of the program is. */
static mps_status read_in_c(const mps_stats_config *config, const char *path, int32_t count,
                            const char *const *names, mps_table *table)
{
    const locale_t c = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (!c) return mps__stats_no_memory(config);
    const locale_t before = uselocale(c);
    const mps_status status = read_file(config, path, count, names, table);
    uselocale(before);
    freelocale(c);
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
    mps_table *out = calloc(1, sizeof *out);
    const mps_status status = out ? read_in_c(config, path, count, names, out)
                                  : mps__stats_no_memory(config);
    if (status == MPS_OK)
        *table = out;
    else
        mps_table_destroy(out);
    return status;
}

void mps_table_destroy(mps_table *table)
{
    if (!table) return;
    for (int32_t k = 0; k < table->columns; k++) {
        free(table->column[k].name);
        free(table->column[k].value);
    }
    free(table->column);
    free(table);
}

int64_t mps_table_rows(const mps_table *table)
{
    return table ? table->rows : 0;
}

int32_t mps_table_columns(const mps_table *table)
{
    return table ? table->columns - 1 : 0;
}

static const column *column_at(const mps_table *table, int32_t index)
{
    return table && index >= -1 && index < table->columns - 1 ? &table->column[index + 1] : NULL;
}

const char *mps_table_name(const mps_table *table, int32_t index)
{
    const column *c = column_at(table, index);
    return c ? c->name : NULL;
}

const char *mps_table_unit(const mps_table *table, int32_t index)
{
    const column *c = column_at(table, index);
    return c ? c->unit : NULL;
}

const double *mps_table_values(const mps_table *table, int32_t index)
{
    const column *c = column_at(table, index);
    return c ? c->value : NULL;
}
