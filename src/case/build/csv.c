/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading tables of numbers. */
#include "csv.h"
#include "units.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { CSV_BYTES = 1 << 30, CSV_ROOM = 1024 };

/* ---- the file ---- */

static char *read_file(mps_case *c, const tree_node *at, const char *path)
{
    FILE *file = fopen(path, "rb");
    long size = -1;
    struct stat s;
    if (file && fstat(fileno(file), &s) == 0 && S_ISDIR(s.st_mode)) /* it opens, and seems huge */
        errno = EISDIR;
    else if (file && fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    char *text = size >= 0 && size < CSV_BYTES ? malloc((size_t)size + 1) : NULL;
    const bool whole = text && fseek(file, 0, SEEK_SET) == 0 &&
                       fread(text, 1, (size_t)size, file) == (size_t)size;
    if (!text && size >= 0 && size < CSV_BYTES) c->no_memory = true;
    if (!whole) {
        mps__case_say(c, at, false, "%s: %s", path,
                      size >= CSV_BYTES ? "is larger than 1 GB" : strerror(errno));
        free(text);
        text = NULL;
    } else
        text[size] = '\0';
    if (file) fclose(file);
    return text;
}

/* A field without blanks and quotes around it. */
static void trim(const char **begin, const char **end)
{
    while (*begin < *end && strchr(" \t\r\"", **begin)) ++*begin;
    while (*end > *begin && strchr(" \t\r\"", (*end)[-1])) --*end;
}

static const char *field_end(const char *at, const char *end, char separator)
{
    while (at < end && *at != separator) at++;
    return at;
}

/* "roll[deg]", "roll (deg)" or "roll". */
static void read_name(csv *t, const char *begin, const char *end)
{
    char *name = t->name[t->columns], *unit = t->unit[t->columns];
    trim(&begin, &end);
    const char *bracket = begin;
    while (bracket < end && *bracket != '[' && *bracket != '(') bracket++;
    const char *name_end = bracket, *unit_begin = bracket + (bracket < end), *unit_end = end;
    if (unit_end > unit_begin && (unit_end[-1] == ']' || unit_end[-1] == ')')) unit_end--;
    trim(&begin, &name_end);
    trim(&unit_begin, &unit_end);
    snprintf(name, CSV_NAME, "%.*s", (int)(name_end - begin), begin);
    snprintf(unit, CSV_NAME, "%.*s", unit_end > unit_begin ? (int)(unit_end - unit_begin) : 0,
             unit_begin);
    t->columns++;
}

static char find_separator(const char *begin, const char *end)
{
    static const char separators[] = ",;\t";
    for (const char *s = separators; *s; s++)
        if (memchr(begin, *s, (size_t)(end - begin))) return *s;
    return ' ';
}

static bool grow(mps_case *c, csv *t, int64_t *room)
{
    if (t->rows < *room) return true;
    *room = *room ? 2 * *room : CSV_ROOM;
    double *value = realloc(t->value, (size_t)(*room * t->columns) * sizeof *value);
    if (value) t->value = value;
    int64_t *line = realloc(t->line, (size_t)*room * sizeof *line);
    if (line) t->line = line;
    if (!value || !line) c->no_memory = true;
    return value && line;
}

/* One line of numbers. */
static bool read_row(mps_case *c, const tree_node *at, csv *t, const char *begin, const char *end,
                     char separator, int64_t number)
{
    double *row = t->value + t->rows * t->columns;
    t->line[t->rows] = number;
    for (int32_t k = 0; k < t->columns; k++) {
        while (separator == ' ' && begin < end && *begin == ' ') begin++;
        const char *stop = field_end(begin, end, separator), *from = begin, *to = stop;
        char *rest, text[CSV_NAME];
        trim(&from, &to);
        snprintf(text, sizeof text, "%.*s", (int)(to - from), from);
        row[k] = strtod(text, &rest);
        if (to == from || *rest || !isfinite(row[k])) {
            mps__case_say(c, at, false, "%s:%lld: column '%s': '%s' is not a number", t->path,
                          (long long)number, t->name[k], text);
            return false;
        }
        begin = stop + (stop < end);
    }
    trim(&begin, &end);
    if (begin < end)
        mps__case_say(c, at, false, "%s:%lld: more numbers than the header has names, %d", t->path,
                      (long long)number, (int)t->columns);
    t->rows++;
    return begin >= end;
}

static void read_header(csv *t, const char *begin, const char *end, char separator)
{
    while (begin <= end && t->columns < CSV_COLUMNS) {
        while (separator == ' ' && begin < end && *begin == ' ') begin++;
        const char *stop = field_end(begin, end, separator);
        if (separator == ' ' && begin == end) return;
        read_name(t, begin, stop);
        begin = stop + 1;
    }
}

bool mps__csv_read(mps_case *c, const tree_node *at, const char *path, csv *out)
{
    int64_t number = 0, room = 0;
    char separator = ',', *text = read_file(c, at, path);
    bool good = text != NULL;
    *out = (csv){.path = path};
    for (const char *line = text; good && line && *line;) {
        const char *end = line + strcspn(line, "\n"), *from = line, *to = end;
        number++;
        trim(&from, &to);
        line = end + (*end != '\0');
        if (from == to || *from == '#') continue;
        if (out->columns == 0) {
            separator = find_separator(from, to);
            read_header(out, from, to, separator);
        } else
            good = grow(c, out, &room) && read_row(c, at, out, from, to, separator, number);
    }
    if (good && out->rows == 0) {
        mps__case_say(c, at, false, "%s: has no numbers", path);
        good = false;
    }
    free(text);
    return good;
}

void mps__csv_free(csv *t)
{
    free(t->value);
    free(t->line);
    t->value = NULL;
    t->line = NULL;
}

/* ---- columns ---- */

int32_t mps__csv_find(const csv *t, const char *name)
{
    for (int32_t k = 0; k < t->columns; k++)
        if (strcasecmp(t->name[k], name) == 0) return k;
    return -1;
}

void mps__csv_names(const csv *t, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    for (int32_t k = 0; k < t->columns && used < size; k++)
        used += (size_t)snprintf(out + used, size - used, "%s%s", k ? ", " : "", t->name[k]);
}

static const char *first_unit(uint64_t kinds)
{
    const mps__unit *u = NULL;
    for (int32_t k = 0; (u = mps__unit_get(k)) != NULL && !(u->kinds & kinds);) k++;
    return u ? u->name : "";
}

double mps__csv_factor(mps_case *c, const tree_node *at, const csv *t, int32_t column,
                       uint64_t kinds, const char *unit)
{
    char wanted[80];
    const char *text = unit ? unit : t->unit[column];
    const mps__unit *u = text[0] ? mps__unit_find(text, strlen(text)) : NULL;
    mps__kinds_name(kinds, wanted, sizeof wanted);
    if (!text[0])
        mps__case_say(
            c, at, false,
            "%s: column '%s' has no unit; write it into the header, e.g. '%s[%s]': %s is wanted",
            t->path, t->name[column], t->name[column], first_unit(kinds), wanted);
    else if (!u || !(u->kinds & kinds) || u->scale != SCALE_NONE)
        mps__case_say(c, at, false, "%s: column '%s' has the unit '%s', %s is wanted", t->path,
                      t->name[column], text, wanted);
    else
        return pow(10, u->tens) * u->times / u->over;
    return NAN;
}
