/* SPDX-License-Identifier: BSD-3-Clause */
/* Parse and explain the command line by a table of options. */
#include "options.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* @return false */
static bool refuse(char *message, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(message, OPTION_MESSAGE, format, values);
    va_end(values);
    return false;
}

/* Word `index` of "one|two"; its length, or 0 after the last. */
static int word_of(const char *words, int32_t index, const char **word)
{
    if (!words) words = ""; /* an option without an argument */
    for (; index > 0 && *words; index--) {
        words += strcspn(words, "|");
        words += *words == '|';
    }
    *word = words;
    return (int)strcspn(words, "|");
}

/* ---- help ---- */

/* The default of an option in --help. */
static void default_text(const option *e, char *text, size_t size)
{
    text[0] = '\0';
    if (e->type == TYPE_TEXT && *(const char **)e->value)
        snprintf(text, size, " (%s)", *(const char **)e->value);
    if (e->type == TYPE_INT) snprintf(text, size, " (%d)", *(int32_t *)e->value);
    if (e->type == TYPE_REAL &&
        (*(double *)e->value > 0 || (e->min < 0 && *(double *)e->value == 0)))
        snprintf(text, size, " (%g)", *(double *)e->value);
    if (e->type == TYPE_CHOICE) {
        const char *word;
        int length = word_of(e->argument, *(int32_t *)e->value, &word);
        snprintf(text, size, " (%.*s)", length, word);
    }
}

void options_help(FILE *out, const option *table, int count)
{
    for (int i = 0; i < count; i++) {
        char left[64], initial[128];
        snprintf(left, sizeof left, "%s %s", table[i].name,
                 table[i].argument ? table[i].argument : "");
        default_text(&table[i], initial, sizeof initial);
        fprintf(out, "  %-18s %s%s\n", left, table[i].help, initial);
    }
}

/* ---- values ---- */

static bool refuse_value(const option *e, const char *text, char *message)
{
    char allowed[128];
    if (e->type == TYPE_INT)
        snprintf(allowed, sizeof allowed, "a whole number, %g to %g", e->min, e->max);
    else if (e->min > 0)
        snprintf(allowed, sizeof allowed, "a number, %g to %g", e->min, e->max);
    else
        snprintf(allowed, sizeof allowed, "a number %s 0, at most %g",
                 e->min < 0 ? "not less than" : "greater than", e->max);
    return refuse(message, "%s %s: must be %s", e->name, text, allowed);
}

static bool set_number(const option *e, const char *text, char *message)
{
    char *end;
    double value = strtod(text, &end);
    bool lower = e->type == TYPE_INT || e->min > 0 ? value >= e->min
                 : e->min < 0                      ? value >= 0
                                                   : value > 0;
    bool whole = e->type != TYPE_INT || value == floor(value);
    if (end == text || *end != '\0' || !isfinite(value) || !lower || value > e->max || !whole)
        return refuse_value(e, text, message);
    if (e->type == TYPE_INT)
        *(int32_t *)e->value = (int32_t)value;
    else
        *(double *)e->value = value;
    return true;
}

static bool set_choice(const option *e, const char *text, char *message)
{
    const char *word;
    int32_t index = 0;
    for (int length; (length = word_of(e->argument, index, &word)) > 0; index++) {
        if ((int)strlen(text) != length || strncmp(text, word, (size_t)length) != 0) continue;
        *(int32_t *)e->value = index;
        return true;
    }
    return refuse(message, "%s %s: must be one of %s", e->name, text, e->argument);
}

static bool set_times(const option *e, const char *text, char *message)
{
    option_times *times = e->value;
    const char *at = text;
    times->count = 0;
    for (bool more = true; more; at++) {
        char *end;
        double t = strtod(at, &end), before = times->count > 0 ? times->t[times->count - 1] : 0;
        more = *end == ',';
        if (end == at || (*end && !more) || !isfinite(t) || t <= before ||
            times->count == OPTION_NUMBERS)
            return refuse(message,
                          "%s %s: must be increasing times greater than 0, at most %d of them",
                          e->name, text, OPTION_NUMBERS);
        times->t[times->count++] = t;
        at = end;
    }
    return true;
}

static bool add_text(const option *e, const char *text, char *message)
{
    option_list *list = e->value;
    if (list->count == OPTION_TEXTS)
        return refuse(message, "%s %s: is one too many", e->name, text);
    list->text[list->count++] = text;
    return true;
}

static bool set(const option *e, const char *text, char *message)
{
    switch (e->type) {
    case TYPE_TEXT:
        *(const char **)e->value = text;
        return true;
    case TYPE_LIST:
        return add_text(e, text, message);
    case TYPE_TIMES:
        return set_times(e, text, message);
    case TYPE_CHOICE:
        return set_choice(e, text, message);
    default:
        return set_number(e, text, message);
    }
}

/* ---- command line ---- */

static const option *find(const option *table, int count, const char *name, size_t length)
{
    for (int i = 0; i < count; i++)
        if (strlen(table[i].name) == length && strncmp(table[i].name, name, length) == 0)
            return &table[i];
    return NULL;
}

/* The option argv[*i] and its value, which may be the next argument. */
static bool take(const option *e, int argc, char **argv, int *i, char *message)
{
    const char *name = argv[*i], *equals = strchr(name, '=');
    if (e->given) *e->given = true;
    if (e->type == TYPE_FLAG) {
        if (equals) return refuse(message, "%s takes no value", e->name);
        *(bool *)e->value = e->flag;
        return true;
    }
    const char *text = equals ? equals + 1 : *i + 1 < argc ? argv[++*i] : NULL;
    if (!text) return refuse(message, "%s needs a value: %s", e->name, e->argument);
    if (!text[0]) return refuse(message, "%s: must not be empty", e->name);
    return set(e, text, message);
}

const option *options_parse(const option *table, int count, int argc, char **argv, char *message)
{
    message[0] = '\0';
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i], *equals = strchr(name, '=');
        const option *e = find(table, count, name, equals ? (size_t)(equals - name) : strlen(name));
        if (!e) refuse(message, "unknown option %s", name);
        if (e && e->type == TYPE_ASK) return e;
        if (!e || !take(e, argc, argv, &i, message)) return NULL;
    }
    return NULL;
}
