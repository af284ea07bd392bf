/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank with gas.pocket, and a slug of liquid in it. The liquid is viscous: a slug that gas
 * decelerates is unstable. */
#ifndef POCKET_FIXTURE_H
#define POCKET_FIXTURE_H

#include "../unit/tank_fixture.h"

static const double DP = 0.01, RHO = 1000, AMBIENT = 1e5, EXPONENT = 1.4;

static inline mps_sim *begin(int dim, double gravity, double viscosity)
{
    mps_config config;
    mps_phase water;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = DP;
    config.gravity[1] = -gravity;
    config.velocity_scale = sqrt(9.81 * DP);
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    ASSERT_OK(sim, mps_model_use(sim, "gas.pocket"));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "ambient", AMBIENT));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "exponent", EXPONENT));
    if (viscosity > 0) { /* walls slip */
        ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "slip", 1));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "mirror", 1));
    }
    assert_int_equal(mps_phase_init(&water, sizeof water), MPS_OK);
    water.density = RHO;
    water.viscosity = viscosity;
    ASSERT_OK(sim, mps_phase_set(sim, 0, &water));
    return sim;
}

/* Columns of particles, rows below the slug, in it and above; the gas is half a row less high. */
static inline void add_slug(mps_sim *sim, int columns, int below, int rows, int above, double speed)
{
    mps_lease u = {.struct_size = sizeof u}, kind = u;
    add_tank(sim, columns * DP, (below + rows + above) * DP, 0);
    const double lo[2] = {0, (below - 0.1) * DP}, hi[2] = {columns * DP, (below + rows - 0.9) * DP};
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    ASSERT_OK(sim, mps_lease_begin(sim, "kind", MPS_READ, &kind));
    for (int64_t i = 0; i < u.count; i++)
        if (kind.integers[i] == MPS_FLUID) u.data[2 * i + 1] = -speed;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_end(sim, &kind));
}

#endif
