/* SPDX-License-Identifier: BSD-3-Clause */
/* Simulations from texts of cases, for tests. */
#ifndef MPS_TEST_BUILD_KIT_H
#define MPS_TEST_BUILD_KIT_H

#include "case_kit.h"
#include "ship_motion.h"
#include <math.h>

static inline void same_number(double a, double b, double most)
{
    if (!(fabs(a - b) <= most)) fail_msg("%.17g, not %.17g", a, b);
}

typedef struct built {
    mps_case *c;
    build b;
} built;

/* Read and build, without columns. */
static inline mps_status built_try(built *t, const char *text, const char *const *sets)
{
    *t = (built){0};
    assert_true(kit_read(text, sets, &t->c) == MPS_OK || mps_case_message_count(t->c) > 0);
    t->b.c = t->c;
    if (mps__case_failed(t->c)) return MPS_E_ARG;
    mps__build_simulation(&t->b, NULL);
    return mps__case_failed(t->c) ? MPS_E_ARG : t->b.status;
}

static inline void built_make(built *t, const char *text, const char *const *sets)
{
    const mps_status status = built_try(t, text, sets);
    char *all = kit_messages(t->c);
    if (status != MPS_OK) fail_msg("%s", all);
    free(all);
}

static inline void built_free(built *t)
{
    mps_sim_destroy(t->b.sim);
    mps_case_destroy(t->c);
}

/* The text of a case must be refused, by reading or building, at a line with these words, "a|b". */
static inline void built_refused(const char *text, int32_t line, const char *words)
{
    built t;
    bool found = false;
    assert_int_not_equal(built_try(&t, text, NULL), MPS_OK);
    for (int32_t column = 1; column < 200 && !found; column++)
        found = kit_has(t.c, line, column, words);
    char *all = kit_messages(t.c);
    if (!found) fail_msg("line %d, %s; messages:\n%s", (int)line, words, all);
    free(all);
    built_free(&t);
}

#endif
