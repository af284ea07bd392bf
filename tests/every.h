/* SPDX-License-Identifier: BSD-3-Clause */
/* Selection from many similar cases of a test. Sanitizers are three to ten times slower: with them
 * a test runs some of its cases, in all other builds all. MPS_TEST_ALL in the environment selects
 * all. */
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

/* Whether case `number` of series `series` is selected, if one of `each` is. Series start at
 * different cases, so that each common case is selected in one of them. MPS_TEST_TURN in the
 * environment, a number of the commit, makes successive commits select others. */
static inline bool has_turn(int64_t number, int64_t series, int64_t each)
{
    const char *turn = getenv("MPS_TEST_TURN");
    return (number + series + (turn ? strtol(turn, NULL, 10) : 0)) % every(each) == 0;
}

#endif
