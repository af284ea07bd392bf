/* SPDX-License-Identifier: BSD-3-Clause */
/* Characters of UTF-8, and how a text of XML, HTML or JSON has them. */
#ifndef MPS_TEXT_ESCAPE_H
#define MPS_TEXT_ESCAPE_H

#include <stddef.h>
#include <stdio.h>

/* Bytes of the character of UTF-8 at `text`; 0: there is none, as at a byte of Latin-1. */
size_t mps__character(const char *text);

/* The functions below put into `out` what replaces the first character of `text`, which is not
 * empty, and return the bytes of `text` that this character has, 1 or more. Bytes that are no
 * UTF-8, as of the name of a file, become U+FFFD. */
typedef size_t mps__escape(const char *text, char out[8]);

/* The character itself. Control characters except tab and line feed, and characters that change
 * the direction or the line of a text, become U+FFFD; CR in front of LF is removed. */
size_t mps__shown_character(const char *text, char out[8]);
/* A character that is shown, of XML, HTML or SVG, also in an attribute. */
size_t mps__xml_character(const char *text, char out[8]);
/* A character of a string of JSON; '<' is escaped too, so that no "</script>" ends an element of
 * a page. */
size_t mps__json_character(const char *text, char out[8]);

/* A word of a command line as a shell reads it: in double quotes if other characters than letters,
 * digits and _ . , : / + = @ % - are in it, with a backslash before those that have a meaning
 * there.
 * @param out  at most size-1 bytes of the word and a 0
 * @return bytes of the whole word, as snprintf() */
size_t mps__shell_word(const char *word, char *out, size_t size);

/* Write all characters of a text. */
void mps__put_escaped(FILE *out, const char *text, mps__escape *escape);

#endif
