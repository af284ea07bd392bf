/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads numbers with units. */
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { DIGITS = 60, SHOWN = 60 };

/* The text of a number: digits with at most one point, and an exponent. */
typedef struct number_text {
    const char *start;
    size_t length, mantissa; /* of the whole text, and of the part before the exponent */
    int32_t exponent;
} number_text;

static bool digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool blank(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

static bool begins_number(const char *at)
{
    if (*at == '+' || *at == '-') at++;
    if (*at == '.') at++;
    return digit(*at);
}

/* Find a number at `start`. @return false: there is none, or it is too long */
static bool find_number(const char *start, number_text *n)
{
    const char *at = start;
    bool point = false;
    if (!begins_number(at)) return false;
    if (*at == '+' || *at == '-') at++;
    for (; digit(*at) || (*at == '.' && !point); at++) point = point || *at == '.';
    *n = (number_text){.start = start, .mantissa = (size_t)(at - start)};
    if ((*at == 'e' || *at == 'E') &&
        (digit(at[1]) || ((at[1] == '+' || at[1] == '-') && digit(at[2])))) {
        const char *e = at + 1;
        const bool minus = *e == '-';
        if (*e == '+' || *e == '-') e++;
        for (; digit(*e); e++)
            if (n->exponent < 100000) n->exponent = 10 * n->exponent + (*e - '0');
        if (minus) n->exponent = -n->exponent;
        at = e;
    }
    n->length = (size_t)(at - start);
    return n->mantissa < DIGITS;
}

/* The value times 10^tens, rounded once. */
static double number_value(const number_text *n, int32_t tens)
{
    char text[DIGITS + 40];
    snprintf(text, sizeof text, "%.*se%d", (int)n->mantissa, n->start, (int)(n->exponent + tens));
    return strtod(text, NULL);
}

double mps__unit_value(const mps__unit *unit)
{
    const number_text one = {.start = "1", .mantissa = 1};
    return number_value(&one, unit->tens) * unit->times / unit->over;
}

static bool refuse(mps__numbers *n, const char *why, const char *what, size_t length)
{
    snprintf(n->why, sizeof n->why, why, length < SHOWN ? (int)length : SHOWN, what);
    return false;
}

/* Refuse a text where a number is expected. */
static bool refuse_text(mps__numbers *n, const char *at)
{
    char kinds[120];
    mps__kinds_name(n->kinds, kinds, sizeof kinds);
    snprintf(n->why, sizeof n->why, "'%.*s' is no number; %s is wanted%s%.60s%s", SHOWN, at, kinds,
             n->like && *n->like ? ", e.g. '" : "", n->like ? n->like : "",
             n->like && *n->like ? "'" : "");
    return false;
}

/* The unit at the end of an example, "[0 0 m, 2 30 mm]": the longest that matches, "mPa s"; NULL:
 * none. */
static const mps__unit *unit_of(const char *example, uint64_t kinds)
{
    const mps__unit *found = NULL, *u;
    size_t end = strlen(example);
    while (end > 0 && strchr(" ]}", example[end - 1])) end--;
    for (int32_t k = 0; (u = mps__unit_get(k)) != NULL; k++) {
        const size_t length = strlen(u->name);
        if (!(u->kinds & kinds) || length >= end || example[end - length - 1] != ' ') continue;
        if (memcmp(example + end - length, u->name, length) != 0) continue;
        if (!found || length > strlen(found->name)) found = u;
    }
    return found;
}

/* Add an example of an allowed unit, "60 s' or '60 T1": the usual unit, and that of `like`. */
static void add_example(mps__numbers *n, const char *number, int length)
{
    const size_t used = strlen(n->why);
    const mps__unit *first = NULL, *relative = NULL, *u;
    const mps__unit *like = n->like ? unit_of(n->like, n->kinds) : NULL;
    for (int32_t k = 0; (u = mps__unit_get(k)) != NULL; k++) {
        if (!(u->kinds & n->kinds)) continue;
        if (!first) first = u;
        if (!relative && u->scale != SCALE_NONE && u != first) relative = u;
    }
    if (like) relative = like != first ? like : NULL;
    if (length > SHOWN) length = SHOWN;
    if (first)
        snprintf(n->why + used, sizeof n->why - used, ", e.g. '%.*s %s'", length, number,
                 first->name);
    if (relative && n->kinds != UNIT_ANY)
        snprintf(n->why + strlen(n->why), sizeof n->why - strlen(n->why), " or '%.*s %s'", length,
                 number, relative->name);
}

static bool refuse_bare(mps__numbers *n, const char *number, int length)
{
    char kinds[120];
    mps__kinds_name(n->kinds, kinds, sizeof kinds);
    snprintf(n->why, sizeof n->why, "'%.*s' has no unit; %s is wanted",
             length < SHOWN ? length : SHOWN, number, kinds);
    add_example(n, number, length);
    return false;
}

static bool refuse_unit(mps__numbers *n, const mps__unit *u, const char *unit, int length)
{
    char kinds[120], is[120];
    mps__kinds_name(n->kinds, kinds, sizeof kinds);
    if (length > SHOWN) length = SHOWN;
    if (u) {
        mps__kinds_name(u->kinds, is, sizeof is);
        snprintf(n->why, sizeof n->why, "'%.*s' is the unit of %s; %s is wanted", length, unit, is,
                 kinds);
        if (n->kinds != UNIT_NONE) add_example(n, "1", 1);
        return false;
    }
    char list[160];
    for (int32_t k = 0; (u = mps__unit_get(k)) != NULL; k++) {
        if ((u->kinds & n->kinds) && strlen(u->name) == (size_t)length &&
            strncasecmp(u->name, unit, (size_t)length) == 0) {
            snprintf(n->why, sizeof n->why, "'%.*s' is no unit; did you mean '%s'?", length, unit,
                     u->name);
            return false;
        }
    }
    mps__kinds_units(n->kinds, list, sizeof list);
    if (n->kinds == UNIT_ANY || n->kinds == UNIT_NONE || !list[0])
        snprintf(n->why, sizeof n->why, "'%.*s' is no unit; %s is wanted", length, unit, kinds);
    else
        snprintf(n->why, sizeof n->why, "'%.*s' is no unit; units of %s: %s", length, unit, kinds,
                 list);
    return false;
}

/* Length of the unit at `at`: up to the next number, without trailing blanks. */
static size_t unit_length(const char *at)
{
    size_t length = 0, end = 0;
    for (; at[length]; length++) {
        if (length > 0 && blank(at[length - 1]) && begins_number(at + length)) break;
        if (!blank(at[length])) end = length + 1;
    }
    return end;
}

/* Convert numbers first .. last - 1, whose text begins at `at`, from this unit; NULL: no unit. */
static bool convert(mps__numbers *n, const char *at, int32_t first, int32_t last,
                    const mps__unit *u)
{
    /* where a length is not allowed, or any unit is, 40 % is 0.4 */
    const bool is_share = u && u->scale == SCALE_WHOLE &&
                          (n->kinds == UNIT_ANY || !(n->kinds & UNIT_LENGTH));
    for (int32_t k = first; k < last; k++) {
        number_text text;
        at += strspn(at, " \n\t\r");
        find_number(at, &text);
        at += text.length;
        const double number = number_value(&text, u ? u->tens : 0);
        const bool relative = u && u->scale != SCALE_NONE && !is_share;
        const double scale = relative ? n->scale[u->scale] : 1;
        if (!u && number != 0 && !(n->kinds & UNIT_NONE))
            return refuse_bare(n, text.start, (int)text.length);
        n->out[k] = u ? number * u->times / u->over * scale : number;
        n->relative = n->relative || relative;
        if (isnan(scale)) n->missing = u->name;
        if (isinf(n->out[k])) return refuse(n, "'%.*s' is too large", text.start, text.length);
        if (!u && number != 0) n->found &= UNIT_NONE;
    }
    if (u) n->found &= u->kinds;
    return true;
}

/* Whether the character after a number makes it invalid. */
static bool follows_badly(mps__numbers *n, const number_text *number, const char *at)
{
    const char *why = NULL;
    if (*at == ',' && digit(at[1]))
        why = "'%.*s' is no number; write a decimal point as '.', and a list with blanks, '1 2 3'";
    else if (*at == ',' || *at == ';' || *at == '-' || *at == '+' || *at == '.' || digit(*at))
        why = "'%.*s' is no number; write a list with blanks, '1 2 3'";
    return why && !refuse(n, why, number->start, number->length + strcspn(at, " \n\t\r"));
}

/* Read the unit at `at`, for the numbers from `first` on, whose text begins at `pending`. */
static bool take_unit(mps__numbers *n, const char *pending, int32_t first, const char **at)
{
    const size_t length = unit_length(*at);
    const mps__unit *u = mps__unit_find(*at, length);
    if (!u || !(u->kinds & n->kinds)) return refuse_unit(n, u, *at, (int)length);
    *at += length;
    return convert(n, pending, first, n->count, u);
}

static bool refuse_count(mps__numbers *n)
{
    snprintf(n->why, sizeof n->why, "more than %d number%s", (int)n->most, n->most == 1 ? "" : "s");
    return false;
}

bool mps__numbers_read(mps__numbers *n)
{
    const char *at = n->text, *pending = at;
    int32_t first = 0; /* first number without a unit so far */
    bool done = true;
    n->count = 0;
    n->found = n->kinds;
    n->relative = false;
    n->missing = NULL;
    n->why[0] = '\0';
    for (at += strspn(at, " \n\t\r"); done && *at; at += strspn(at, " \n\t\r")) {
        number_text text;
        if (find_number(at, &text)) {
            if (n->count == n->most) return refuse_count(n);
            n->count++;
            at += text.length;
            done = !follows_badly(n, &text, at);
        } else if (n->count > first) {
            done = take_unit(n, pending, first, &at);
            first = n->count;
            pending = at;
        } else {
            done = refuse_text(n, at);
        }
    }
    if (done && n->count == 0) done = refuse_text(n, n->text);
    return done && convert(n, pending, first, n->count, NULL);
}

bool mps__numbers_split(const char *text, int32_t index, char *buffer, size_t size)
{
    number_text number, wanted = {0};
    int32_t count = 0;
    bool found = false;
    for (text += strspn(text, " \n\t\r"); *text; text += strspn(text, " \n\t\r")) {
        if (find_number(text, &number)) {
            if (count++ == index) wanted = number;
            found = count > index;
            text += number.length;
            continue;
        }
        const size_t length = unit_length(text);
        if (found || length == 0)
            return found && (size_t)snprintf(buffer, size, "%.*s %.*s", (int)wanted.length,
                                             wanted.start, (int)length, text) < size;
        text += length;
    }
    return found && (size_t)snprintf(buffer, size, "%.*s", (int)wanted.length, wanted.start) < size;
}
