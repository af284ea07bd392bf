/* SPDX-License-Identifier: BSD-3-Clause */
/* STL. Binary files have an arbitrary header of 80 bytes, the number of triangles, and 50 bytes per
 * triangle; ASCII files consist of words. A file without control characters is ASCII, whatever its
 * beginning; a file at least as long as its number of triangles requires is binary. */
#include "stl.h"
#include "regular.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <mps/numbers.h>
#include <stdio.h>
#include <string.h>

enum { NEWLINE = '\n', RETURN = '\r', END_OF_FILE = 26 /* of DOS */ };
enum { HEADER = 84, RECORD = 50, WORD = 64, BLOCK = 1 << 16 };

typedef struct file {
    const char *path;
    unsigned char *bytes;
    int64_t size, capacity;
    int64_t at, line; /* position and line of the next word of an ASCII file */
} file;

static mps_status read_all(mps__context *c, FILE *in, file *f)
{
    for (;;) {
        MPS__TRY(mps__grow(c, (void **)&f->bytes, &f->capacity, f->size, f->size + BLOCK, 1));
        const size_t got = fread(f->bytes + f->size, 1, BLOCK, in);
        f->size += (int64_t)got;
        if (got < BLOCK) break;
    }
    if (ferror(in))
        return mps__fail(c, MPS_E_IO, "cannot read \"%.200s\": %s", f->path, strerror(errno));
    return MPS_OK;
}

static mps_status load(mps__context *c, file *f)
{
    const char *why;
    FILE *in = mps__regular_stream(f->path, O_RDONLY, &why);
    if (!in)
        return mps__fail(c, MPS_E_IO, "cannot open \"%.200s\": %s", f->path,
                         why ? why : strerror(errno));
    const mps_status status = read_all(c, in, f);
    fclose(in);
    return status;
}

/* Append a triangle; its corners are the next nine numbers. */
static mps_status next_triangle(mps__mesh *m, double **x)
{
    MPS__TRY(mps__mesh_reserve(m, 3, 1));
    *x = m->x + 3 * m->points;
    for (int k = 0; k < 3; k++) m->corner[3 * m->elements + k] = (int32_t)m->points++;
    m->elements++;
    return MPS_OK;
}

/* ---- binary ---- */

static uint32_t word_at(const unsigned char *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static float float_at(const unsigned char *b)
{
    const uint32_t word = word_at(b);
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static mps_status parse_binary(mps__mesh *m, const file *f)
{
    const int64_t count = word_at(f->bytes + HEADER - 4);
    for (int64_t t = 0; t < count; t++) {
        double *x;
        MPS__TRY(next_triangle(m, &x));
        for (int k = 0; k < 9; k++) {
            x[k] = float_at(f->bytes + HEADER + RECORD * t + 12 + 4 * k);
            MPS__CHECK(m->context, isfinite(x[k]),
                       "\"%.200s\": coordinate %d of triangle %lld is %g: must be finite", f->path,
                       k, (long long)t, x[k]);
        }
    }
    return MPS_OK;
}

/* ---- ASCII ---- */

static bool is_blank(unsigned char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r') || c == END_OF_FILE;
}

/* Whether a line ends here: LF, CR LF or CR. */
static bool ends_line(const file *f, int64_t at)
{
    return f->bytes[at] == NEWLINE ||
           (f->bytes[at] == RETURN && (at + 1 == f->size || f->bytes[at + 1] != NEWLINE));
}

/* The next word, truncated to WORD-1 characters; false at the end. */
static bool next_word(file *f, char word[WORD])
{
    int length = 0;
    for (; f->at < f->size && is_blank(f->bytes[f->at]); f->at++) f->line += ends_line(f, f->at);
    for (; f->at < f->size && !is_blank(f->bytes[f->at]); f->at++)
        if (length < WORD - 1) word[length++] = (char)f->bytes[f->at];
    word[length] = '\0';
    return length > 0;
}

static void skip_line(file *f)
{
    while (f->at < f->size && !ends_line(f, f->at)) f->at++;
}

static bool same_word(const char *a, const char *b)
{
    for (; *a && *b; a++, b++)
        if ((*a >= 'A' && *a <= 'Z' ? *a - 'A' + 'a' : *a) != *b) return false;
    return *a == *b;
}

static double digits(const char **p, int *count, double value)
{
    for (; **p >= '0' && **p <= '9'; (*p)++, (*count)++) value = 10 * value + (**p - '0');
    return value;
}

/* A decimal number with a point, in any locale. False if the word is no number. */
static bool number(const char *p, double *value)
{
    const double sign = *p == '-' ? -1 : 1;
    int whole = 0, fraction = 0, power = 0;
    p += *p == '-' || *p == '+';
    double v = digits(&p, &whole, 0), e = 0;
    if (*p == '.') {
        p++;
        v = digits(&p, &fraction, v);
    }
    if (whole + fraction == 0) return false;
    if (*p == 'e' || *p == 'E') {
        const double turn = p[1] == '-' ? -1 : 1;
        p += p[1] == '-' || p[1] == '+' ? 2 : 1;
        e = turn * digits(&p, &power, 0);
        if (power == 0) return false;
    }
    *value = sign * v * mps_pow(10, e - fraction);
    return *p == '\0';
}

static mps_status bad_word(const mps__mesh *m, const file *f, const char *word, const char *wanted)
{
    if (!word[0])
        return mps__fail(m->context, MPS_E_IO, "\"%.200s\" ends in line %lld: \"%s\" is missing",
                         f->path, (long long)f->line, wanted);
    return mps__fail(m->context, MPS_E_IO, "\"%.200s\", line %lld: \"%s\" instead of \"%s\"",
                     f->path, (long long)f->line, word, wanted);
}

static mps_status expect(mps__mesh *m, file *f, const char *wanted)
{
    char word[WORD];
    next_word(f, word);
    return same_word(word, wanted) ? MPS_OK : bad_word(m, f, word, wanted);
}

static mps_status parse_numbers(mps__mesh *m, file *f, double *x, bool used)
{
    for (int k = 0; k < 3; k++) {
        char word[WORD];
        next_word(f, word);
        if (!number(word, &x[k])) {
            if (!used && word[0]) continue; /* a normal may be nan: it is not used */
            return bad_word(m, f, word, "a finite number");
        }
        if (used && !isfinite(x[k])) return bad_word(m, f, word, "a finite number");
    }
    return MPS_OK;
}

/* Text after "facet". */
static mps_status parse_facet(mps__mesh *m, file *f)
{
    double normal[3], *x;
    MPS__TRY(expect(m, f, "normal"));
    MPS__TRY(parse_numbers(m, f, normal, false));
    MPS__TRY(expect(m, f, "outer"));
    MPS__TRY(expect(m, f, "loop"));
    MPS__TRY(next_triangle(m, &x));
    for (int k = 0; k < 3; k++) {
        MPS__TRY(expect(m, f, "vertex"));
        MPS__TRY(parse_numbers(m, f, x + 3 * k, true));
    }
    MPS__TRY(expect(m, f, "endloop"));
    return expect(m, f, "endfacet");
}

/* "solid" name facets "endsolid" name, perhaps several times; the last "endsolid" may be
 * missing. */
static mps_status parse_ascii(mps__mesh *m, file *f, mps__stl_notes *notes)
{
    char word[WORD];
    f->line = 1;
    for (bool within = false; next_word(f, word);) {
        if (same_word(word, "solid") || (within && same_word(word, "endsolid"))) {
            within = same_word(word, "solid");
            notes->no_end = within;
            skip_line(f);
        } else if (!within || !same_word(word, "facet")) {
            return bad_word(m, f, word, within ? "facet" : "solid");
        } else {
            MPS__TRY(parse_facet(m, f));
        }
    }
    return MPS_OK;
}

/* ---- both ---- */

/* Length of a UTF-8 byte order mark. */
static int64_t mark_of(const file *f)
{
    return f->size >= 3 && memcmp(f->bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

/* The triangle count of a binary file has a zero byte, since files have fewer than 16 million
 * triangles. */
static bool is_text(const file *f)
{
    for (int64_t k = 0; k < f->size; k++)
        if (f->bytes[k] < ' ' && !is_blank(f->bytes[k])) return false;
    return true;
}

static bool begins_solid(const file *f)
{
    file words = {.bytes = f->bytes, .size = f->size, .at = f->at};
    char word[WORD];
    return next_word(&words, word) && same_word(word, "solid");
}

static mps_status no_stl(mps__context *c, const file *f, int64_t triangles)
{
    if (f->size > 1 && f->bytes[0] + f->bytes[1] == 0xff + 0xfe)
        return mps__fail(c, MPS_E_IO, "\"%.200s\" is a text in UTF-16: save it as UTF-8", f->path);
    if (f->size < HEADER)
        return mps__fail(c, MPS_E_IO,
                         "\"%.200s\" has %lld bytes: a binary STL file has at least %d, an ASCII "
                         "one begins with \"solid\"",
                         f->path, (long long)f->size, HEADER);
    return mps__fail(c, MPS_E_IO,
                     "\"%.200s\" has %lld bytes: a binary STL file of %lld triangles has %lld, an "
                     "ASCII one begins with \"solid\" and has no control characters",
                     f->path, (long long)f->size, (long long)triangles,
                     HEADER + RECORD * (long long)triangles);
}

static mps_status parse(mps__mesh *m, file *f, mps__stl_notes *notes)
{
    mps__context *c = m->context;
    const int64_t count = f->size >= HEADER ? (int64_t)word_at(f->bytes + HEADER - 4) : 0,
                  tail = f->size - HEADER - RECORD * count;
    f->at = mark_of(f);
    if (f->size > 0 && is_text(f)) {
        MPS__TRY(parse_ascii(m, f, notes));
    } else if (f->size >= HEADER && tail >= 0) {
        notes->tail = tail;
        MPS__TRY(parse_binary(m, f));
    } else if (begins_solid(f)) {
        MPS__TRY(parse_ascii(m, f, notes));
    } else {
        return no_stl(c, f, count);
    }
    MPS__CHECK(c, m->elements > 0, "\"%.200s\" has no triangles", f->path);
    return MPS_OK;
}

mps_status mps__stl_read(mps__mesh *m, const char *path, mps__stl_notes *notes)
{
    *notes = (mps__stl_notes){0};
    file f = {.path = path};
    mps_status status = load(m->context, &f);
    if (status == MPS_OK) status = parse(m, &f, notes);
    mps__free(m->context, f.bytes);
    return status;
}
