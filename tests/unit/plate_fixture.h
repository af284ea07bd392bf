/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank with a thin plate, shared by the tests of plates. */
#ifndef PLATE_FIXTURE_H
#define PLATE_FIXTURE_H

#include "sim.h"
#include "tank_fixture.h"

static const double dp = 0.05;

/* A plate of `columns` across x from x = 0.5 on, from the floor up to `top`, right across the
 * tank. */
static inline void add_plate(mps_sim *sim, int columns, double bottom, double top)
{
    const double lo[3] = {0.5, bottom, 0}, hi[3] = {0.5 + (columns - 1) * dp, top, 0.3};
    ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
}

/* Tank 0.5 m long a side of the plate, 0.6 high, water up to 0.4. */
static inline mps_sim *divided(int dim, int columns)
{
    mps_sim *sim = new_sim(dim, dp);
    const double length = columns ? 1 + (columns - 1) * dp : 0.5;
    add_tank(sim, length, 0.6, 0.3);
    if (columns) add_plate(sim, columns, 0, 0.6);
    fill_depth(sim, length, 0.4, 0.3);
    return sim;
}

#endif
