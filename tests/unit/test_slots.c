/* SPDX-License-Identifier: BSD-3-Clause */
/* Slots that are too narrow for a particle: the log contains their position and width. */
#include "sim.h"
#include "tank_fixture.h"
#include <stdio.h>

static char logged[4096];

static void keep_warnings(void *user, int level, const char *text)
{
    (void)user;
    if (level < MPS_LOG_WARNING || !strstr(text, "slot")) return;
    strncat(logged, text, sizeof logged - strlen(logged) - 2);
    strcat(logged, "\n");
}

static mps_sim *tank(int32_t dim)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = 0.02;
    config.log = keep_warnings;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    logged[0] = 0;
    add_tank(sim, 0.6, 0.4, 0.2);
    return sim;
}

/* Warnings of the first fill; a second one logs nothing. */
static int warnings(mps_sim *sim)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.2, 0.2}, all[3] = {0.6, 0.4, 0.2};
    int count = 0;
    ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
    for (const char *at = logged; (at = strchr(at, '\n')) != NULL; at++) count++;
    const size_t length = strlen(logged);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, all, NULL, NULL));
    assert_int_equal(strlen(logged), length);
    mps_sim_destroy(sim);
    return count;
}

/* A box `gap` from the wall x0. */
static int beside_wall(int32_t dim, double gap)
{
    mps_sim *sim = tank(dim);
    const double lo[3] = {gap, 0.1, 0}, hi[3] = {gap + 0.12, 0.3, 0.2};
    ASSERT_OK(sim, mps_baffle_add(sim, "block", lo, hi, NULL));
    return warnings(sim);
}

static void block_and_wall(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        assert_int_equal(beside_wall(dim, 0.04), 0);
        assert_int_equal(beside_wall(dim, 0), 0);
        assert_int_equal(beside_wall(dim, 0.02), 1);
        if (!strstr(logged, "between \"tank.x0\" and \"block\" is 0.02 m wide, 1 dp, at (0.01, "))
            fail_msg("%s", logged);
        if (!strstr(logged, "dp of at most 0.01 m")) fail_msg("%s", logged);
    }
}

/* A plate `gap` from the wall x0. */
static int plate_beside_wall(int32_t dim, double gap)
{
    mps_sim *sim = tank(dim);
    const double corner[3] = {gap, 0, 0}, up[3] = {0, 0.16, 0}, across[3] = {0, 0, 0.2};
    ASSERT_OK(sim, mps_plate_add(sim, "plate", corner, up, dim == 3 ? across : NULL));
    return warnings(sim);
}

static void plate_and_wall(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        assert_int_equal(plate_beside_wall(dim, 0.3), 0);
        assert_int_equal(plate_beside_wall(dim, 0.04), 0);
        assert_int_equal(plate_beside_wall(dim, 0.035), 0); /* off the lattice, one row fits */
        assert_int_equal(plate_beside_wall(dim, 0.02), 1);
        if (!strstr(logged, "between \"tank.x0\" and \"plate\" is 0.02 m wide"))
            fail_msg("%s", logged);
        assert_int_equal(plate_beside_wall(dim, 0.03), 1);
    }
}

/* A baffle that ends one spacing above the floor reaches it. */
static void under_a_plate(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int rows = 1; rows <= 2; rows++) {
            mps_sim *sim = tank(dim);
            const double lo[3] = {0.3, rows * 0.02, 0}, hi[3] = {0.3, 0.2, 0.2};
            ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
            assert_int_equal(warnings(sim), rows == 1);
            if (rows == 1 && !strstr(logged, "between \"baffle\" and the wall at (0.3, 0, "))
                fail_msg("%s", logged);
        }
}

/* Two blocks as one solid, with a slot of a given width between. */
static double two_blocks(void *user, const double *x)
{
    const double half = 0.5 * *(const double *)user, from = fabs(x[0] - 0.3),
                 out = fmax(fmax(half - from, from - half - 0.1), fabs(x[1] - 0.2) - 0.1);
    return out;
}

static void in_a_solid(void **state)
{
    (void)state;
    static const double width[] = {0.02, 0.024, 0.04};
    for (int k = 0; k < 3; k++) {
        double slot = width[k];
        mps_sim *sim = tank(2);
        mps_solid solid;
        assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
        solid.name = "blocks";
        solid.distance = two_blocks;
        solid.user = &slot;
        solid.lo[0] = 0.1;
        solid.hi[0] = 0.5;
        solid.lo[1] = 0.05;
        solid.hi[1] = 0.35;
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        assert_int_equal(warnings(sim), k == 0); /* a row of the lattice is in the middle */
        if (k == 0 &&
            !strstr(logged, "between \"blocks\" and \"blocks\" is 0.02 m wide, 1 dp, at (0.3, "))
            fail_msg("%s", logged);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(block_and_wall),
        cmocka_unit_test(plate_and_wall),
        cmocka_unit_test(under_a_plate),
        cmocka_unit_test(in_a_solid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
