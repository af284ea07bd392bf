/* SPDX-License-Identifier: BSD-3-Clause */
/* How much of many things alike a test does. Sanitizers make it three to ten times slower: there it does some of them, in all other builds all.
 * MPS_TEST_ALL in the environment asks for all there too. */
#ifndef TESTS_EVERY_H
#define TESTS_EVERY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/* So many things alike of which a sanitizer has one. @return each, or 1 for all */
static inline int64_t every(int64_t each)
{
#if defined(__SANITIZE_ADDRESS__)
    return getenv("MPS_TEST_ALL") ? 1 : each;
#else
    return each > 0;
#endif
}

/* Whether the number-th thing of the series-th series has its turn, if one of `each` has. Series begin at different ones, so that what they
 * have in common comes in one of them. */
static inline bool has_turn(int64_t number, int64_t series, int64_t each)
{
    return (number + series) % every(each) == 0;
}

#endif
