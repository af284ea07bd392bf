/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads tables of numbers. The file is read in blocks; only the wanted columns are kept. */
#include "csv.h"
#include "grow.h"
#include "regular.h"
#include "run_file.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { BLOCK = 1 << 16, LINE_MOST = 1 << 24, SHOWN = 40 };

/* A field of a line: its text without quotes and surrounding blanks, 0-terminated. */
typedef struct field {
    char *text;
    char *unit; /* unit of a name; "" for none */
} field;

struct mps__csv_lines {
    int file;
    char *buffer;
    size_t size, begin, end; /* capacity of the buffer; range that is not processed yet */
    int64_t number;          /* number of the last line, from 1 */
    bool over;               /* end of file reached */
    bool carriage;           /* the last line ended with CR: a following LF belongs to it */
    bool comment;            /* a line that begins with # precedes the names */
    char separator;
    int32_t fields; /* capacity of `field` */
    field *field;
};

static mps__csv_error refuse(mps__csv *t, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static mps__csv_error refuse(mps__csv *t, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(t->why, sizeof t->why, format, list);
    va_end(list);
    return CSV_FILE;
}

#define TRY(call)                             \
    do {                                      \
        const mps__csv_error error_ = (call); \
        if (error_ != CSV_OK) return error_;  \
    } while (0)

/* ---- lines ---- */

static mps__csv_error open_file(mps__csv *t)
{
    const char *why = NULL;
    char *real = t->folder ? mps__run_name(t->folder, t->path, &why) : NULL;
    if (!t->folder || real) t->in->file = mps__regular_open(real ? real : t->path, O_RDONLY, &why);
    const int number = errno;
    free(real);
    errno = number;
    if (why) return refuse(t, "%s: %s", t->path, why);
    if (t->in->file < 0 && errno == ENOMEM) return CSV_MEMORY;
    if (t->in->file < 0 && errno == ENOENT) {
        refuse(t, "%s: %s", t->path, strerror(errno));
        return CSV_MISSING;
    }
    return t->in->file < 0 ? refuse(t, "%s: %s", t->path, strerror(errno)) : CSV_OK;
}

static void close_file(mps__csv *t)
{
    if (!t->in) return;
    if (t->in->file >= 0) close(t->in->file);
    free(t->in->buffer);
    free(t->in->field);
    free(t->in);
    t->in = NULL;
}

/* More of the file into the buffer, which may move. One byte of it stays free for a 0. */
static mps__csv_error fill(mps__csv *t)
{
    struct mps__csv_lines *r = t->in;
    if (r->begin > 0) memmove(r->buffer, r->buffer + r->begin, r->end - r->begin);
    r->end -= r->begin;
    r->begin = 0;
    if (r->size - r->end <= BLOCK) {
        if (r->size > LINE_MOST)
            return refuse(t, "%s:%lld: a line of more than %d bytes", t->path,
                          (long long)r->number + 1, LINE_MOST);
        const size_t size = 2 * r->size + 2 * BLOCK;
        char *buffer = realloc(r->buffer, size);
        if (!buffer) return CSV_MEMORY;
        r->buffer = buffer;
        r->size = size;
    }
    ssize_t got;
    do got = read(r->file, r->buffer + r->end, BLOCK);
    while (got < 0 && errno == EINTR);
    if (got < 0) return refuse(t, "%s: %s", t->path, strerror(errno));
    r->end += (size_t)got;
    r->over = got == 0;
    return CSV_OK;
}

static bool is_text(mps__csv *t, const char *line, size_t length)
{
    if (!memchr(line, '\0', length)) return true;
    refuse(t, "%s:%lld: has a byte 0: it is no text, or is written as UTF-16; save it as UTF-8",
           t->path, (long long)t->in->number);
    return false;
}

/* The next line without its line break; NULL: end of file. */
static mps__csv_error next_line(mps__csv *t, char **line)
{
    struct mps__csv_lines *r = t->in;
    size_t at = 0; /* searched so far */
    *line = NULL;
    for (;;) {
        if (r->carriage && r->begin < r->end) {
            r->begin += r->buffer[r->begin] == '\n';
            r->carriage = false;
        }
        const size_t length = r->end - r->begin;
        char *from = r->buffer + r->begin;
        while (at < length && from[at] != '\n' && from[at] != '\r') at++;
        if (at < length || (r->over && length > 0)) {
            const bool ends = at < length;
            r->carriage = ends && from[at] == '\r';
            r->number++;
            r->begin += at + ends;
            if (!is_text(t, from, at)) return CSV_FILE;
            from[at] = '\0';
            if (ends || !(t->flags & CSV_OWN)) *line = from;
            return CSV_OK;
        }
        if (r->over) return CSV_OK;
        TRY(fill(t));
    }
}

static bool blank(char c)
{
    return c == ' ' || c == '\t';
}

/* The next line that is neither empty nor a comment; NULL: end of file. */
static mps__csv_error next_text(mps__csv *t, char **line)
{
    for (;;) {
        TRY(next_line(t, line));
        if (!*line) return CSV_OK;
        if (t->in->number == 1 && strncmp(*line, "\xef\xbb\xbf", 3) == 0) *line += 3;
        while (blank(**line) && **line != t->in->separator) ++*line;
        if (**line == '#')
            t->in->comment = true;
        else if ((*line)[strspn(*line, " \t")])
            return CSV_OK;
    }
}

/* ---- fields ---- */

/* Separators between quotes or in the brackets of a unit are ignored.
 * @return whether `c` is inside */
static bool inside(char c, bool *quoted, char *bracket)
{
    if (c == '"') *quoted = !*quoted;
    if (*quoted) return true;
    if (!*bracket && (c == '[' || c == '(')) *bracket = c == '[' ? ']' : ')';
    if (c == *bracket) *bracket = '\0';
    return *bracket != '\0';
}

static char find_separator(const char *line)
{
    static const char separators[] = "\t;,";
    for (const char *s = separators; *s; s++) {
        bool quoted = false;
        char bracket = '\0';
        for (const char *c = line; *c; c++)
            if (!inside(*c, &quoted, &bracket) && *c == *s) return *s;
    }
    return ' ';
}

/* The end of the field that begins at `at`. Separators in quotes belong to the field; in a line of
 * names also those in brackets, and blanks before a bracket: "time [s] surge [m]". */
static char *field_end(char *at, char separator, bool names)
{
    bool quoted = false;
    char bracket = '\0';
    for (; *at; at++) {
        const bool in = names ? inside(*at, &quoted, &bracket) : (quoted ^= *at == '"');
        if (in || *at != separator) continue;
        const char *next = at + strspn(at, " ");
        if (separator != ' ' || !names || (*next != '[' && *next != '(')) return at;
    }
    return at;
}

/* Trim blanks around a text. */
static char *trimmed(char *text)
{
    while (blank(*text)) text++;
    size_t length = strlen(text);
    while (length > 0 && blank(text[length - 1])) text[--length] = '\0';
    return text;
}

/* Trim blanks around a field, and remove the quotes of parts of it. */
static char *plain_text(char *text)
{
    bool quoted = false;
    char *to = text;
    for (const char *from = text; *from; from++) {
        if (*from == '"' && quoted && from[1] == '"')
            *to++ = *from++;
        else if (*from == '"')
            quoted = !quoted;
        else
            *to++ = *from;
    }
    *to = '\0';
    return trimmed(text);
}

static mps__csv_error add_field(mps__csv *t, int32_t index, char *text)
{
    struct mps__csv_lines *r = t->in;
    if (index >= r->fields) {
        const int32_t capacity = 2 * r->fields + 64;
        field *more = realloc(r->field, (size_t)capacity * sizeof *more);
        if (!more) return CSV_MEMORY;
        r->field = more;
        r->fields = capacity;
    }
    r->field[index] = (field){.text = text, .unit = text + strlen(text)};
    return CSV_OK;
}

/* Split a line into 0-terminated fields. An empty field after the last separator is ignored. */
static mps__csv_error split(mps__csv *t, char *line, bool names, int32_t *count)
{
    const char separator = t->in->separator;
    *count = 0;
    for (char *at = line;;) {
        while (separator == ' ' && blank(*at)) at++;
        char *end = field_end(at, separator, names);
        const bool last = !*end;
        *end = '\0';
        if (last && !at[strspn(at, " \t")]) return CSV_OK;
        TRY(add_field(t, (*count)++, names ? at : plain_text(at)));
        if (last) return CSV_OK;
        at = end + 1;
    }
}

static bool is_number(const char *text)
{
    char *end;
    strtod(text, &end);
    if (end != text && *end == ',') end += 1 + strspn(end + 1, "0123456789eE+-"); /* "0,5" */
    return end != text && !*end;
}

/* ---- names ---- */

/* Split "roll[deg]", "roll (deg)" or "roll" into name and unit. */
static void divide_name(field *f, int32_t flags)
{
    const size_t length = strlen(f->text);
    size_t open = length;
    while (open > 0 && blank(f->text[open - 1])) open--;
    const size_t end = open;
    const char close = end > 0 ? f->text[end - 1] : '\0';
    const char *inner = close == ')' ? strrchr(f->text, '(') : NULL;
    const bool number = inner && inner[1] >= '0' && inner[1] <= '9';
    const bool round = !(flags & CSV_OWN) || (flags & CSV_ROUND && inner && !number);
    if (close != ']' && (close != ')' || !round)) { /* an unclosed bracket is no unit */
        char *bracket = strchr(f->text, '[');
        if (bracket && bracket > f->text) *bracket = '\0';
        return;
    }
    while (open > 0 && f->text[open] != (close == ']' ? '[' : '(')) open--;
    if (open == 0) return;
    f->text[end - 1] = '\0';
    f->text[open] = '\0';
    f->unit = f->text + open + 1;
}

static mps__csv_error refuse_numbers(mps__csv *t)
{
    return refuse(t,
                  "%s:%lld: the first line has numbers, no names; write a line such as "
                  "'time[s],surge[m]' above it%s",
                  t->path, (long long)t->in->number,
                  t->in->comment ? ", or take the # away from the names" : "");
}

static mps__csv_error keep_names(mps__csv *t, int32_t count)
{
    t->name = calloc((size_t)count, sizeof *t->name);
    t->unit = calloc((size_t)count, sizeof *t->unit);
    t->value = calloc((size_t)count, sizeof *t->value);
    t->wanted = calloc((size_t)count, sizeof *t->wanted);
    if (!t->name || !t->unit || !t->value || !t->wanted) return CSV_MEMORY;
    for (int32_t k = 0; k < count; k++) {
        t->wanted[k] = true;
        t->name[k] = strdup(t->in->field[k].text);
        t->unit[k] = strdup(t->in->field[k].unit);
        t->columns = k + 1;
        if (!t->name[k] || !t->unit[k]) return CSV_MEMORY;
    }
    return CSV_OK;
}

static mps__csv_error read_names(mps__csv *t)
{
    char *line;
    int32_t count = 0, numbers = 0;
    TRY(next_text(t, &line));
    if (!line) return refuse(t, "%s: has no line of names", t->path);
    t->in->separator = find_separator(line);
    if (t->in->separator == ' ') /* tabs separate fields on their own */
        for (char *c = line; *c; c++) *c = *c == '\t' ? ' ' : *c;
    TRY(split(t, line, true, &count));
    if (count == 0) return refuse(t, "%s: has no line of names", t->path);
    for (int32_t k = 0; k < count; k++) {
        field *f = &t->in->field[k];
        f->text = plain_text(f->text);
        f->unit = f->text + strlen(f->text);
        numbers += is_number(f->text);
        divide_name(f, t->flags);
        f->text = trimmed(f->text);
        f->unit = trimmed(f->unit);
    }
    return numbers == count ? refuse_numbers(t) : keep_names(t, count);
}

mps__csv_error mps__csv_open(mps__csv *t, const char *path, int32_t flags)
{
    return mps__csv_open_in(t, NULL, path, flags);
}

mps__csv_error mps__csv_open_in(mps__csv *t, const char *folder, const char *path, int32_t flags)
{
    *t = (mps__csv){.folder = folder, .path = path, .flags = flags};
    t->in = calloc(1, sizeof *t->in);
    if (!t->in) return CSV_MEMORY;
    t->in->file = -1;
    TRY(open_file(t));
    return read_names(t);
}

/* ---- rows ---- */

static mps__csv_error reserve(mps__csv *t)
{
    for (int32_t k = 0; k < t->columns; k++) {
        if (!t->wanted[k]) continue;
        double *value = mps__grown(t->value[k], t->rows, sizeof *value);
        if (!value) return CSV_MEMORY;
        t->value[k] = value;
    }
    int64_t *line = mps__grown(t->line, t->rows, sizeof *line);
    if (!line) return CSV_MEMORY;
    t->line = line;
    return CSV_OK;
}

static mps__csv_error refuse_count(mps__csv *t, int32_t count)
{
    return refuse(t, "%s:%lld: has %d value%s, the line of names has %d name%s%s", t->path,
                  (long long)t->in->number, (int)count, count == 1 ? "" : "s", (int)t->columns,
                  t->columns == 1 ? "" : "s",
                  t->in->separator == ',' && count > t->columns
                      ? "; numbers have a decimal point, no comma"
                      : "");
}

static mps__csv_error read_number(mps__csv *t, int32_t column, const char *text)
{
    char *end;
    const double value = strtod(text, &end);
    t->value[column][t->rows] = value;
    if (end != text && !*end && (isfinite(value) || t->flags & CSV_OWN)) return CSV_OK;
    return refuse(t, "%s:%lld: column '%s': '%.*s' is no number%s", t->path,
                  (long long)t->in->number, t->name[column], SHOWN, text,
                  is_number(text) && *end == ',' ? "; write its decimal comma as a point" : "");
}

static mps__csv_error read_rows(mps__csv *t)
{
    for (;;) {
        char *line;
        int32_t count;
        TRY(next_text(t, &line));
        if (!line) return CSV_OK;
        for (char *c = line; t->in->separator == ' ' && *c; c++) *c = *c == '\t' ? ' ' : *c;
        TRY(split(t, line, false, &count));
        /* the last field may be empty */
        const bool empty = count == t->columns - 1 && !t->wanted[count];
        if (count != t->columns && !empty) return refuse_count(t, count);
        TRY(reserve(t));
        for (int32_t k = 0; k < t->columns; k++)
            if (t->wanted[k]) TRY(read_number(t, k, t->in->field[k].text));
        t->line[t->rows++] = t->in->number;
    }
}

mps__csv_error mps__csv_read(mps__csv *t)
{
    const mps__csv_error error = read_rows(t);
    close_file(t);
    return error;
}

void mps__csv_free(mps__csv *t)
{
    for (int32_t k = 0; k < t->columns; k++) {
        free(t->name[k]);
        free(t->unit[k]);
        free(t->value[k]);
    }
    free((void *)t->name);
    free((void *)t->unit);
    free((void *)t->value);
    free(t->wanted);
    free(t->line);
    close_file(t);
    *t = (mps__csv){0};
}

/* ---- columns ---- */

int32_t mps__csv_find(const mps__csv *t, const char *name)
{
    int32_t same = -1, like = -1;
    for (int32_t k = 0; k < t->columns; k++) {
        if (strcmp(t->name[k], name) == 0) same = same == -1 ? k : -2;
        if (strcasecmp(t->name[k], name) == 0) like = like == -1 ? k : -2;
    }
    return same != -1 ? same : like;
}

void mps__csv_names(const mps__csv *t, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    for (int32_t k = 0; k < t->columns; k++) {
        const int more = snprintf(out + used, size - used, "%s%s", k ? ", " : "", t->name[k]);
        if (more < 0 || used + (size_t)more + 5 >= size) {
            snprintf(out + used, size - used, ", ...");
            return;
        }
        used += (size_t)more;
    }
}
