/* SPDX-License-Identifier: BSD-3-Clause */
/* A strict reader of JSON (RFC 8259). It reports each allocation that fails; jansson 2.14 does not,
 * and returns a text without some of its characters. */
#ifndef MPS_TEXT_JSON_H
#define MPS_TEXT_JSON_H

#include <stdbool.h>
#include <stddef.h>

typedef enum json_type {
    JSON_NULL,
    JSON_FALSE,
    JSON_TRUE,
    JSON_NUMBER,
    JSON_TEXT,
    JSON_LIST,
    JSON_OBJECT
} json_type;

/* A value; in a list or an object it has a next one. */
typedef struct json_value json_value;
struct json_value {
    json_type type;
    double number;
    char *text; /* UTF-8, of JSON_TEXT */
    char *key;  /* of members of an object */
    json_value *first, *next;
    size_t count; /* of a list or an object */
};

/* Where and why a text is no valid JSON. */
typedef struct json_error {
    int line;
    const char *why; /* NULL: memory is exhausted */
} json_error;

/* Read a 0-terminated text. @return NULL with an error */
json_value *mps__json_read(const char *text, json_error *error);
void mps__json_free(json_value *value);

/* All of these accept NULL for a missing value. */
const json_value *mps__json_get(const json_value *object, const char *key);
const json_value *mps__json_at(const json_value *list, size_t index);
size_t mps__json_count(const json_value *list);
/* A number; NAN: the value is no number. */
double mps__json_number(const json_value *value);
/* A text; NULL: the value is no text. */
const char *mps__json_text(const json_value *value);
/* The text of a member of an object; "": there is none. */
const char *mps__json_member(const json_value *object, const char *key);
bool mps__json_true(const json_value *value);

#endif
