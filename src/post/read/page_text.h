/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts of a page: escaping, and rounded numbers. */
#ifndef MPS_POST_PAGE_TEXT_H
#define MPS_POST_PAGE_TEXT_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TEXT_NUMBER = 48 };

/* Each text of a page that does not come from this library (names, titles, units, messages, texts
 * of files) must pass one of these two. Control characters and bytes that are not UTF-8 become
 * U+FFFD in both. */

/* Write a text for HTML or SVG, also in an attribute. */
void mps__html(FILE *out, const char *text);
/* Write a JSON string with its quotes, safe within <script>. */
void mps__json(FILE *out, const char *text);
/* "12,437". */
const char *mps__whole(char out[TEXT_NUMBER], int64_t value);
/* Three digits: "0.0123", "5,400", "1.2e-07"; "-" for NAN. */
const char *mps__rounded(char out[TEXT_NUMBER], double value);
/* Three digits and a unit with a prefix: "14.0 kPa", "65 mm", "2.3 J/m". */
const char *mps__quantity(char out[TEXT_NUMBER], double value, const char *unit);
/* "2 h 5 min", "3.2 s". */
const char *mps__duration(char out[TEXT_NUMBER], double seconds);

#endif
