/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of keys, and the JSON Schema of case files, made from the table. */
#include "keys.h"
#include "out.h"
#include "units.h"
#include <mps/case.h>
#include <stdio.h>
#include <string.h>

/* ---- the list -------------------------------------------------------------------------------- */

static const char *shape_name(key_shape shape)
{
    static const char *const names[] = {[SHAPE_MAP] = "map",
                                        [SHAPE_MAPS] = "map, or list of maps",
                                        [SHAPE_NAMES] = "map of names",
                                        [SHAPE_FILLS] = "list",
                                        [SHAPE_NUMBERS] = "number",
                                        [SHAPE_POINTS] = "points",
                                        [SHAPE_TEXT] = "text",
                                        [SHAPE_TEXTS] = "text, or list of texts",
                                        [SHAPE_WORD] = "word",
                                        [SHAPE_FLAG] = "yes or no",
                                        [SHAPE_FILE] = "file",
                                        [SHAPE_UNIT] = "unit",
                                        [SHAPE_PATHS] = "map of paths"};
    return names[shape];
}

/* "length", "2 or 3 lengths" ... without the article of a kind. */
static void kind_of(const mps__key *key, char *kind, size_t size)
{
    char name[48];
    mps__kinds_name(key->units, name, sizeof name);
    const char *word = strncmp(name, "an ", 3) == 0  ? name + 3
                       : strncmp(name, "a ", 2) == 0 ? name + 2
                                                     : name;
    if (key->shape == SHAPE_MAPS && key->words)
        snprintf(kind, size, "text, map, or list of these");
    else if (key->shape != SHAPE_NUMBERS)
        snprintf(kind, size, "%s", shape_name(key->shape));
    else if (key->few == COUNT_DIM)
        snprintf(kind, size, "%s, 2 or 3", word);
    else if (key->few != key->many)
        snprintf(kind, size, "%s, %d to %d", word, (int)key->few, (int)key->many);
    else if (key->many > 1)
        snprintf(kind, size, "%s, %d", word, (int)key->many);
    else
        snprintf(kind, size, "%s%s", key->whole ? "whole " : "", word);
}

mps_status mps_case_key_get(int32_t index, mps_case_key *key)
{
    if (!key || key->struct_size != sizeof *key || index < 0 || index >= mps__keys_count - 1)
        return MPS_E_ARG;
    const mps__key *k = &mps__keys[index + 1];
    *key = (mps_case_key){.struct_size = sizeof *key,
                          .required = k->required,
                          .path = k->path,
                          .range = k->words && k->shape != SHAPE_MAPS ? k->words : k->range,
                          .otherwise = k->otherwise,
                          .example = k->example,
                          .help = k->help};
    kind_of(k, key->kind, sizeof key->kind);
    if (k->units == UNIT_ANY)
        snprintf(key->units, sizeof key->units, "any");
    else
        mps__kinds_units(k->units, key->units, sizeof key->units);
    return MPS_OK;
}

/* ---- the schema ------------------------------------------------------------------------------ */

#define NUMBER "[+-]?([0-9]+\\\\.?[0-9]*|\\\\.[0-9]+)([eE][+-]?[0-9]+)?"
#define ZERO   "[+-]?0(\\\\.0*)?"
#define NAME   "^[A-Za-z_][A-Za-z0-9_-]{0,30}$"

static void put_key(mps__out *o, const mps__key *key, bool strict);

/* Write a JSON string. */
static void put_string(mps__out *o, const char *text, size_t length)
{
    mps__out_put(o, "\"");
    for (size_t i = 0; i < length; i++)
        mps__out_put(o, text[i] == '"' || text[i] == '\\' ? "\\%c" : "%c", text[i]);
    mps__out_put(o, "\"");
}

/* Write units of kinds as alternatives of a pattern. */
static void put_units(mps__out *o, uint64_t kinds)
{
    const mps__unit *u;
    const char *bar = "";
    mps__out_put(o, "(");
    for (int32_t k = 0; (u = mps__unit_get(k)) != NULL; k++) {
        if (!(u->kinds & kinds)) continue;
        mps__out_put(o, "%s%s", bar, u->name);
        bar = "|";
    }
    mps__out_put(o, ")");
}

/* Write a bound of a range without a unit, for JSON numbers. */
static void put_bounds(mps__out *o, const char *range)
{
    double low, high;
    char rest[2];
    if (sscanf(range, "%lf .. %lf%1s", &low, &high, rest) == 2)
        mps__out_put(o, ",\"minimum\":%g,\"maximum\":%g", low, high);
    for (const char *at = range; at && (*at == '>' || *at == '<'); at = strchr(at, ',')) {
        const bool closed = at[1] == '=';
        if (sscanf(at + 1 + closed, "%lf", &low) != 1) return;
        mps__out_put(o, ",\"%s\":%g",
                     *at == '>' ? closed ? "minimum" : "exclusiveMinimum"
                     : closed   ? "maximum"
                                : "exclusiveMaximum",
                     low);
        at += strcspn(at, ",");
        if (!*at) return;
        at++;
        while (*at == ' ') at++;
        at--;
    }
}

static void put_numbers(mps__out *o, const mps__key *key)
{
    const bool bare = (key->units & UNIT_NONE) != 0, only = key->units == UNIT_NONE;
    const bool many = key->many != 1 || key->shape == SHAPE_POINTS;
    mps__out_put(o, "\"anyOf\":[{\"type\":\"string\",\"pattern\":\"^\\\\s*(");
    if (!only) {
        if (many) mps__out_put(o, "(" NUMBER "\\\\s*");
        if (many) put_units(o, key->units);
        if (many) mps__out_put(o, "?\\\\s+)*");
        mps__out_put(o, NUMBER "\\\\s*");
        put_units(o, key->units);
        mps__out_put(o, "|");
    }
    if (bare)
        mps__out_put(o, many ? NUMBER "(\\\\s+" NUMBER ")*" : NUMBER);
    else
        mps__out_put(o, many ? ZERO "(\\\\s+" ZERO ")*" : ZERO);
    mps__out_put(o, ")\\\\s*$\"}");
    if (bare && key->few == 1) {
        mps__out_put(o, ",{\"type\":\"%s\"", key->whole ? "integer" : "number");
        put_bounds(o, key->range);
        mps__out_put(o, "}");
    } else {
        mps__out_put(o, ",{\"const\":0}");
    }
    if (many) mps__out_put(o, ",{\"type\":\"array\",\"items\":{\"type\":[\"string\",\"number\"]}}");
    mps__out_put(o, "]");
}

static void put_words(mps__out *o, const char *words)
{
    const char *word;
    size_t length;
    mps__out_put(o, "\"enum\":[");
    for (int32_t i = 0; (length = mps__words_get(words, i, &word)) > 0; i++) {
        if (i > 0) mps__out_put(o, ",");
        put_string(o, word, length);
        if (length == 2 && memcmp(word, "no", 2) == 0) mps__out_put(o, ",false");
    }
    mps__out_put(o, "]");
}

/* Write the keys below a map: names of the table, or those of the user. */
static void put_properties(mps__out *o, const mps__key *parent, bool strict)
{
    const char *comma = "", *word;
    size_t length;
    const bool names = mps__key_names(parent);
    mps__out_put(o, names ? "\"patternProperties\":{" : "\"properties\":{");
    for (int32_t k = 1; k < mps__keys_count; k++) {
        const mps__key *key = &mps__keys[k];
        if (!mps__key_is_below(parent, key)) continue;
        const char *last = mps__key_last(key);
        for (int32_t i = 0; (length = mps__words_get(last, i, &word)) > 0; i++) {
            /* a key of motion.surge|sway is written with its parent, not below
             * motion.surge|sway|roll */
            mps__out_put(o, "%s", comma);
            if (*word == '*')
                mps__out_put(o, mps__key_dotted(parent) ? "\"^[a-z_]+\\\\.[a-z0-9_]+$\""
                                                        : "\"" NAME "\"");
            else
                put_string(o, word, length);
            mps__out_put(o, ":");
            put_key(o, key, strict);
            comma = ",";
        }
    }
    mps__out_put(o, "},\"additionalProperties\":false");
}

static void put_required(mps__out *o, const mps__key *parent)
{
    const char *comma = "";
    mps__out_put(o, ",\"required\":[");
    for (int32_t k = 1; k < mps__keys_count; k++) {
        if (!mps__keys[k].required || !mps__key_is_below(parent, &mps__keys[k])) continue;
        const char *last = mps__key_last(&mps__keys[k]);
        mps__out_put(o, "%s", comma);
        put_string(o, last, strlen(last));
        comma = ",";
    }
    mps__out_put(o, "]");
}

/* Write a further alternative: none of the keys. */
static void put_none(mps__out *o, const char *keys)
{
    const char *word, *comma = "";
    size_t length;
    mps__out_put(o, ",{\"not\":{\"anyOf\":[");
    for (int32_t i = 0; (length = mps__words_get(keys, i, &word)) > 0; i++) {
        mps__out_put(o, "%s{\"required\":[", comma);
        put_string(o, word, length);
        mps__out_put(o, "]}");
        comma = ",";
    }
    mps__out_put(o, "]}}");
}

static void put_groups(mps__out *o, const mps__key *parent)
{
    const char *comma = "", *word;
    size_t length;
    mps__out_put(o, ",\"allOf\":[{}");
    for (int32_t k = 0; k < mps__key_groups_count; k++) {
        if (!mps__group_is_of(&mps__key_groups[k], parent)) continue;
        mps__out_put(o, ",{\"oneOf\":[");
        comma = "";
        for (int32_t i = 0; (length = mps__words_get(mps__key_groups[k].keys, i, &word)) > 0; i++) {
            mps__out_put(o, "%s{\"required\":[", comma);
            put_string(o, word, length);
            mps__out_put(o, "]}");
            comma = ",";
        }
        if (!mps__key_groups[k].required) put_none(o, mps__key_groups[k].keys);
        mps__out_put(o, "]}");
    }
    mps__out_put(o, "]");
    comma = "";
    mps__out_put(o, ",\"dependentRequired\":{");
    for (int32_t k = 0; k < mps__key_needs_count; k++) {
        if (!mps__group_is_of(&mps__key_needs[k], parent)) continue;
        length = mps__words_get(mps__key_needs[k].keys, 0, &word);
        mps__out_put(o, "%s", comma);
        put_string(o, word, length);
        mps__out_put(o, ":[\"%s\"]", word + length + 1);
        comma = ",";
    }
    mps__out_put(o, "}");
}

static void put_map(mps__out *o, const mps__key *key, bool strict)
{
    mps__out_put(o, "\"type\":\"object\",");
    put_properties(o, key, strict);
    if (!strict) return;
    put_required(o, key);
    put_groups(o, key);
}

static void put_kind(mps__out *o, const mps__key *key, bool strict)
{
    static const char *const text = "\"type\":[\"string\",\"number\"]";
    switch (key->shape) {
    case SHAPE_MAP:
        if (key->words) mps__out_put(o, "\"anyOf\":[{\"enum\":[\"%s\"]},{", key->words);
        put_map(o, key, strict);
        if (key->words) mps__out_put(o, "}]");
        break;
    case SHAPE_MAPS:
        mps__out_put(o, "\"anyOf\":[");
        if (key->words) mps__out_put(o, "{%s},{\"type\":\"array\",\"items\":{%s}},", text, text);
        mps__out_put(o, "{");
        put_map(o, key, strict);
        mps__out_put(o, "},{\"type\":\"array\",\"minItems\":1,\"items\":{");
        put_map(o, key, strict);
        mps__out_put(o, "}}]");
        break;
    case SHAPE_NAMES:
        mps__out_put(o, "\"type\":\"object\",");
        put_properties(o, key, strict);
        break;
    case SHAPE_FILLS:
        mps__out_put(o, "\"type\":\"array\",\"minItems\":1,\"items\":{\"type\":\"object\","
                        "\"minProperties\":1,\"maxProperties\":1,");
        put_properties(o, key, strict);
        mps__out_put(o, "}");
        break;
    case SHAPE_PATHS:
        mps__out_put(o, "\"type\":\"object\",\"minProperties\":1");
        break;
    case SHAPE_NUMBERS:
        put_numbers(o, key);
        break;
    case SHAPE_POINTS:
        mps__out_put(o, "\"type\":\"array\",\"minItems\":%d,\"maxItems\":%d,\"items\":{",
                     (int)key->few, (int)key->many);
        put_numbers(o, key);
        mps__out_put(o, "}");
        break;
    case SHAPE_TEXTS:
        mps__out_put(o, "\"anyOf\":[{%s},{\"type\":\"array\",\"items\":{%s}}]", text, text);
        break;
    case SHAPE_WORD:
        put_words(o, key->words);
        break;
    case SHAPE_FLAG:
        mps__out_put(o, "\"enum\":[true,false,\"yes\",\"no\",\"true\",\"false\"]");
        break;
    case SHAPE_UNIT:
        mps__out_put(o, "\"type\":\"string\",\"pattern\":\"^");
        put_units(o, key->units);
        mps__out_put(o, "$\"");
        break;
    default:
        mps__out_put(o, "%s", text);
    }
}

static void put_key(mps__out *o, const mps__key *key, bool strict)
{
    mps__out_put(o, "{\"description\":");
    put_string(o, key->help, strlen(key->help));
    mps__out_put(o, ",");
    put_kind(o, key, strict);
    mps__out_put(o, "}");
}

size_t mps_case_schema_write(char *buffer, size_t size)
{
    mps__out o = mps__out_begin(buffer, size);
    mps__out_put(&o, "{\"$schema\":\"https://json-schema.org/draft/2020-12/schema\","
                     "\"title\":\"case file of libmps\",\n"
                     "\"if\":{\"required\":[\"base\"]},\"then\":{\"$ref\":\"#/$defs/change\"},"
                     "\"else\":{\"$ref\":\"#/$defs/case\"},\n\"$defs\":{\"case\":");
    put_key(&o, &mps__keys[0], true);
    mps__out_put(&o, ",\n\"change\":");
    put_key(&o, &mps__keys[0], false);
    mps__out_put(&o, "}}\n");
    return o.length;
}
