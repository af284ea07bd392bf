/* SPDX-License-Identifier: BSD-3-Clause */
/* Tests of which a sanitizer has one of several (every.h); include it after cmocka.h. */
#ifndef TESTS_TURNS_H
#define TESTS_TURNS_H

#include "every.h"

static inline void is_skipped(void **state)
{
    (void)state;
    skip();
}

/* Skip those tests that have no turn, if one of `each` has. */
static inline void take_turns(struct CMUnitTest *tests, size_t count, int64_t each)
{
    for (size_t k = 0; k < count; k++)
        if (!has_turn((int64_t)k, 0, each)) tests[k].test_func = is_skipped;
}

#endif
