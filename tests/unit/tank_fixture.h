/* SPDX-License-Identifier: BSD-3-Clause */
/* A simulation with a tank, shared by the tests of geometry, motion, probes and frames. */
#ifndef TANK_FIXTURE_H
#define TANK_FIXTURE_H

#include <math.h>
#include "../tags.h"
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define ASSERT_OK(sim, call) ASSERT_STATUS(sim, call, MPS_OK)
#define ASSERT_STATUS(sim, call, wanted)                                       \
    do {                                                                       \
        mps_status got_ = (call);                                              \
        if (got_ != (wanted))                                                  \
            fail_msg("%s: %s instead of %s: %s", #call, mps_status_name(got_), \
                     mps_status_name(wanted), mps_sim_error(sim));             \
    } while (0)
/* A refusal whose text contains `word`. */
#define ASSERT_REFUSED(sim, call, wanted, word)                                     \
    do {                                                                            \
        ASSERT_STATUS(sim, call, wanted);                                           \
        if (!strstr(mps_sim_error(sim), (word)))                                    \
            fail_msg("\"%s\" does not mention \"%s\"", mps_sim_error(sim), (word)); \
    } while (0)
#define ASSERT_NEAR(a, b, tolerance)                                                            \
    do {                                                                                        \
        double a_ = (a), b_ = (b), t_ = (tolerance);                                            \
        if (!(fabs(a_ - b_) <= t_))                                                             \
            fail_msg("%s = %.17g, %s = %.17g differ by %g > %g", #a, a_, #b, b_, fabs(a_ - b_), \
                     t_);                                                                       \
    } while (0)

static inline mps_sim *new_sim(int32_t dim, double dp)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    return sim;
}

static inline void add_tank(mps_sim *sim, double sx, double sy, double sz)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = sx;
    tank.size[1] = sy;
    tank.size[2] = sz;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
}

/* Fill from the lower corner of the tank up to `depth`; returns the particles added. */
static inline int64_t fill_depth(mps_sim *sim, double sx, double depth, double sz)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {sx, depth, sz};
    int64_t added = 0;
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, &added, NULL));
    return added;
}

/* Air as phase 1 where a box has no other fluid. */
static inline void fill_air(mps_sim *sim, const double lo[3], const double hi[3])
{
    mps_phase air;
    assert_int_equal(mps_phase_init(&air, sizeof air), MPS_OK);
    air.density = 1.2;
    air.viscosity = 1.8e-5;
    ASSERT_OK(sim, mps_phase_set(sim, 1, &air));
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
}

/* Surge with an acceleration that increases smoothly to 4 g, without jumps. */
static inline int pull_away(void *user, double t, mps_motion_state *state)
{
    (void)user;
    const double a = 4 * 9.81, rise = 0.1, w = 3.14159265358979 / rise, q = fmin(t, rise),
                 after = t - q;
    const double rate = 0.5 * a * (q - sin(w * q) / w);
    state->accel[MPS_MOVE_X] = -0.5 * a * (1 - cos(w * q));
    state->rate[MPS_MOVE_X] = -(rate + a * after);
    state->value[MPS_MOVE_X] = -(0.5 * a * (0.5 * q * q - (1 - cos(w * q)) / (w * w)) +
                                 rate * after + 0.5 * a * after * after);
    return 0;
}

/* Number of active models of that name: 0 or 1. */
static inline int model_active(const mps_sim *sim, const char *name)
{
    int found = 0;
    for (int32_t k = 0; mps_model_name(sim, k); k++)
        found += strcmp(mps_model_name(sim, k), name) == 0;
    return found;
}

#endif
