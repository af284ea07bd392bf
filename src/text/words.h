/* SPDX-License-Identifier: BSD-3-Clause */
/* How similar two words are, for the question "did you mean '...'?". */
#ifndef MPS_TEXT_WORDS_H
#define MPS_TEXT_WORDS_H

#include <stddef.h>

/* Edit distance of two words: the least number of letters to insert, delete or replace, or of
 * adjacent letters to exchange (optimal string alignment). If a word has more than 64 bytes: the
 * length of the longer word. */
size_t mps__word_distance(const char *a, const char *b);

#endif
