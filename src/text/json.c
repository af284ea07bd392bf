/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 };

/* The text being read, and the first error. */
typedef struct reader {
    const char *at, *begin;
    const char *why;
    bool failed;
    int depth;
} reader;

static bool fail(reader *r, const char *why)
{
    if (!r->failed) r->why = why;
    r->failed = true;
    return false;
}

static void skip_space(reader *r)
{
    r->at += strspn(r->at, " \t\r\n");
}

static bool take(reader *r, char c)
{
    skip_space(r);
    if (*r->at != c) return false;
    r->at++;
    return true;
}

/* ---- texts ---- */

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Four hexadecimal digits after "\u". @return -1: invalid */
static long take_unit(reader *r)
{
    long code = 0;
    for (int k = 0; k < 4; k++, r->at++) {
        const int digit = hex_digit(*r->at);
        if (digit < 0) return -1;
        code = 16 * code + digit;
    }
    return code;
}

/* A character of any plane, as UTF-8. @return bytes, 0: invalid */
static size_t take_character(reader *r, char *out)
{
    long code = take_unit(r);
    if (code >= 0xd800 && code < 0xdc00 && r->at[0] == '\\' && r->at[1] == 'u') {
        r->at += 2;
        const long low = take_unit(r);
        code = low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00)
                                             : -1;
    }
    if (code <= 0 || (code >= 0xd800 && code < 0xe000)) return 0;
    const size_t more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const unsigned char lead[] = {0, 0xc0, 0xe0, 0xf0};
    for (size_t k = more; k > 0; k--, code >>= 6) out[k] = (char)(0x80 | (code & 0x3f));
    out[0] = (char)(lead[more] | code);
    return more + 1;
}

/* @return bytes written to `out`, 0: no such escape */
static size_t take_escape(reader *r, char *out)
{
    static const char from[] = "\"\\/bfnrt", to[] = "\"\\/\b\f\n\r\t";
    const char c = *r->at++;
    const char *found = c ? strchr(from, c) : NULL;
    if (c == 'u') return take_character(r, out);
    if (!found) return 0;
    *out = to[found - from];
    return 1;
}

/* Bytes up to the closing quote; an escape is never shorter than its character. */
static size_t text_capacity(const char *at)
{
    const char *end = at;
    while (*end && *end != '"') end += *end == '\\' && end[1] ? 2 : 1;
    return (size_t)(end - at) + 1;
}

static bool take_text(reader *r, char **out)
{
    if (!take(r, '"')) return fail(r, "a text in quotes is wanted");
    char *text = malloc(text_capacity(r->at));
    size_t n = 0;
    *out = text;
    if (!text) return fail(r, NULL);
    while (*r->at != '"') {
        if ((unsigned char)*r->at < 0x20) return fail(r, "a text does not end on its line");
        if (*r->at != '\\') {
            text[n++] = *r->at++;
            continue;
        }
        r->at++;
        const size_t size = take_escape(r, text + n);
        if (size == 0) return fail(r, "a text has an escape that JSON does not know");
        n += size;
    }
    r->at++;
    text[n] = '\0';
    return true;
}

/* ---- numbers and words ---- */

static size_t digits(const char *at)
{
    return strspn(at, "0123456789");
}

static bool take_number(reader *r, double *out)
{
    const char *c = r->at + (*r->at == '-');
    const size_t whole = digits(c);
    if (whole == 0 || (whole > 1 && *c == '0')) return fail(r, "a value is wanted");
    c += whole;
    if (*c == '.') {
        if (digits(c + 1) == 0) return fail(r, "a number ends behind its point");
        c += 1 + digits(c + 1);
    }
    if (*c == 'e' || *c == 'E') {
        const char *power = c + 1 + (c[1] == '-' || c[1] == '+');
        if (digits(power) == 0) return fail(r, "a number ends behind its e");
        c = power + digits(power);
    }
    *out = strtod(r->at, NULL);
    r->at = c;
    return true;
}

static bool take_word(reader *r, const char *word)
{
    const size_t length = strlen(word);
    if (strncmp(r->at, word, length) != 0) return false;
    r->at += length;
    return true;
}

/* ---- values ---- */

static bool take_value(reader *r, json_value *out);

static json_value *add_member(reader *r, json_value *parent, json_value *last)
{
    json_value *member = calloc(1, sizeof *member);
    if (!member) {
        fail(r, NULL);
        return NULL;
    }
    if (last)
        last->next = member;
    else
        parent->first = member;
    parent->count++;
    return member;
}

static bool take_member(reader *r, json_value *parent, json_value *member)
{
    if (parent->type == JSON_OBJECT) {
        if (!take_text(r, &member->key)) return false;
        if (mps__json_get(parent, member->key) != member)
            return fail(r, "a key stands twice in an object");
        if (!take(r, ':')) return fail(r, "':' is wanted behind a key");
    }
    return take_value(r, member);
}

static bool take_members(reader *r, json_value *parent, char end)
{
    json_value *last = NULL;
    if (++r->depth > DEEPEST) return fail(r, "values lie too deep in each other");
    if (!take(r, end)) do {
            last = add_member(r, parent, last);
            if (!last || !take_member(r, parent, last)) return false;
        } while (take(r, ','));
    if (last && !take(r, end)) return fail(r, "',' or the end of a list or object is wanted");
    r->depth--;
    return true;
}

static bool take_value(reader *r, json_value *out)
{
    skip_space(r);
    switch (*r->at) {
    case '{':
    case '[':
        out->type = *r->at == '{' ? JSON_OBJECT : JSON_LIST;
        r->at++;
        return take_members(r, out, out->type == JSON_OBJECT ? '}' : ']');
    case '"':
        out->type = JSON_TEXT;
        return take_text(r, &out->text);
    default:
        break;
    }
    if (take_word(r, "null")) return true;
    out->type = JSON_TRUE;
    if (take_word(r, "true")) return true;
    out->type = JSON_FALSE;
    if (take_word(r, "false")) return true;
    out->type = JSON_NUMBER;
    return take_number(r, &out->number);
}

json_value *mps__json_read(const char *text, json_error *error)
{
    reader r = {.at = text, .begin = text};
    json_value *all = calloc(1, sizeof *all);
    *error = (json_error){.line = 1};
    if (!all) return NULL;
    if (take_value(&r, all)) {
        skip_space(&r);
        if (*r.at) fail(&r, "there is more behind the end");
    }
    if (!r.failed) return all;
    error->why = r.why;
    for (const char *c = text; c < r.at; c++) error->line += *c == '\n';
    mps__json_free(all);
    return NULL;
}

void mps__json_free(json_value *value)
{
    while (value) {
        json_value *next = value->next;
        mps__json_free(value->first); /* recursion is limited by the nesting of values */
        free(value->text);
        free(value->key);
        free(value);
        value = next;
    }
}

const json_value *mps__json_get(const json_value *object, const char *key)
{
    if (!object || !key || object->type != JSON_OBJECT) return NULL;
    for (const json_value *v = object->first; v; v = v->next)
        if (v->key && strcmp(v->key, key) == 0) return v;
    return NULL;
}

const json_value *mps__json_at(const json_value *list, size_t index)
{
    const json_value *v = list && list->type == JSON_LIST ? list->first : NULL;
    while (v && index-- > 0) v = v->next;
    return v;
}

size_t mps__json_count(const json_value *list)
{
    return list && list->type == JSON_LIST ? list->count : 0;
}

double mps__json_number(const json_value *value)
{
    return value && value->type == JSON_NUMBER ? value->number : NAN;
}

const char *mps__json_text(const json_value *value)
{
    return value && value->type == JSON_TEXT ? value->text : NULL;
}

const char *mps__json_member(const json_value *object, const char *key)
{
    const char *text = mps__json_text(mps__json_get(object, key));
    return text ? text : "";
}

bool mps__json_true(const json_value *value)
{
    return value && value->type == JSON_TRUE;
}
