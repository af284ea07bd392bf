/* SPDX-License-Identifier: BSD-3-Clause */
/* A config with a text buffer, and comparisons of the tests of statistics. */
#ifndef STATS_FIXTURE_H
#define STATS_FIXTURE_H

#include <math.h>
#include <mps/stats.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static char stats_error[512];

static inline mps_stats_config new_config(void)
{
    mps_stats_config config;
    assert_int_equal(mps_stats_config_init(&config, sizeof config), MPS_OK);
    config.error = stats_error;
    config.error_size = sizeof stats_error;
    stats_error[0] = '\0';
    return config;
}

#define ASSERT_DONE(call)                                                                      \
    do {                                                                                       \
        const mps_status got_ = (call);                                                        \
        if (got_ != MPS_OK) fail_msg("%s: %s: %s", #call, mps_status_name(got_), stats_error); \
    } while (0)

#define ASSERT_SAYS(call, wanted, word)                                      \
    do {                                                                     \
        stats_error[0] = '\0';                                               \
        assert_int_equal((call), (wanted));                                  \
        if (!strstr(stats_error, (word)))                                    \
            fail_msg("\"%s\" does not mention \"%s\"", stats_error, (word)); \
    } while (0)

#define ASSERT_NEAR(a, b, tolerance)                                                              \
    do {                                                                                          \
        const double a_ = (a), b_ = (b), t_ = (tolerance);                                        \
        if (!(fabs(a_ - b_) <= t_)) fail_msg("%s is %.17g, not %.17g within %g", #a, a_, b_, t_); \
    } while (0)

/* 0 < .. < 1, from Knuth's generator: another one than the library's. */
static inline double draw(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return ((double)(*seed >> 12) + 0.5) / 4503599627370496.0;
}

#endif
