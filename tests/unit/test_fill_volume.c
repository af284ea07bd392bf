/* SPDX-License-Identifier: BSD-3-Clause */
/* The volume of a fill in the log: built and requested. */
#include "sim.h"
#include "../every.h"
#include "tank_fixture.h"
#include <stdio.h>

static char logged[4096];

static void keep_log(void *user, int level, const char *text)
{
    (void)user, (void)level;
    strncat(logged, text, sizeof logged - strlen(logged) - 2);
    strcat(logged, "\n");
}

static mps_sim *logging(int32_t dim, double dp)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.log = keep_log;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    logged[0] = 0;
    return sim;
}

/* The built and requested volume that a fill logs; -1: no such line. */
static void last_fill(double *built, double *asked)
{
    const char *at = NULL, *next = logged;
    int dim[2];
    while ((next = strstr(next, "fill of phase 0: ")) != NULL) at = next++;
    *built = *asked = -1;
    if (at) sscanf(at, "fill of phase 0: %lf m%d of %lf m%d", built, &dim[0], asked, &dim[1]);
}

static int below(void *user, const double *x)
{
    return x[1] < *(const double *)user;
}

static int below_slope(void *user, const double *x)
{
    return x[1] < *(const double *)user + 0.3 * (x[0] - 0.4);
}

static double bowl(void *user, const double *x)
{
    (void)user;
    return 0.25 - hypot(x[0], x[1] - 0.25);
}

/* Liquid below a level on a row of the lattice: this row is not inside, and the log reports the
 * missing volume. */
static void volumes_are_told(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const double width = dim == 3 ? 0.3 : 1, lo[3] = {0, 0, 0}, hi[3] = {0.8, 0.2, 0.304};
        double level = 0.2, built, asked;
        mps_sim *sim = logging(dim, 0.02);
        add_tank(sim, 0.8, 0.5, 0.3);
        ASSERT_OK(sim, mps_fill_add(sim, 0, below, &level, NULL));
        last_fill(&built, &asked);
        ASSERT_NEAR(asked, 0.8 * 0.2 * width, 2e-3 * asked);
        ASSERT_NEAR(built, 0.8 * 0.18 * width, 1e-3 * asked);
        mps_sim_destroy(sim);
        sim = logging(dim, 0.02);
        add_tank(sim, 0.8, 0.5, 0.3);
        ASSERT_OK(sim, mps_fill_add(sim, 0, below_slope, &level, NULL));
        last_fill(&built, &asked);
        ASSERT_NEAR(asked, 0.8 * 0.2 * width, 4e-3 * asked);
        mps_sim_destroy(sim);
        sim = logging(dim, 0.016); /* the level is 12.5 rows above the floor */
        add_tank(sim, 0.8, 0.512, 0.304);
        ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
        last_fill(&built, &asked);
        const double volume = 0.8 * 0.2 * (dim == 3 ? 0.304 : 1);
        ASSERT_NEAR(asked, volume, 1e-3 * asked);
        ASSERT_NEAR(built, asked, 2e-3 * asked);
        mps_sim_destroy(sim);
    }
}

/* A level in a solid, mps_fill_level_add(): the segment of a circle. */
static void level_in_a_bowl(void **state)
{
    (void)state;
    const double lo[2] = {-0.3, 0}, hi[2] = {0.3, 0.2}, dp = 0.01, R = 0.25;
    mps_sim *sim = logging(2, dp);
    mps_solid solid;
    double built, asked;
    assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
    solid.distance = bowl;
    solid.lo[0] = -0.25;
    solid.hi[0] = 0.25;
    solid.hi[1] = 0.5;
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
    last_fill(&built, &asked);
    const double a = acos((R - 0.2) / R), segment = R * R * (a - sin(a) * cos(a));
    ASSERT_NEAR(asked, segment, 0.002 * segment);
    ASSERT_NEAR(built, asked, 0.51 * dp * dp);
    mps_sim_destroy(sim);
}

/* A bowl with next to nothing in it: less than half of a particle is refused, more is built. */
static void little_in_a_bowl(void **state)
{
    int refused = 0, filled = 0;
    (void)state;
    for (int k = 0; k < 40; k++) {
        const double lo[2] = {-0.3, 0}, hi[2] = {0.3, 0.0007 * k}, dp = 0.01;
        mps_sim *sim = logging(2, dp);
        mps_solid solid;
        double built, asked;
        assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
        solid.distance = bowl;
        solid.lo[0] = -0.25;
        solid.hi[0] = 0.25;
        solid.hi[1] = 0.5;
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        const mps_status status = mps_fill_level_add(sim, 0, lo, hi, NULL, NULL);
        if (status == MPS_OK) {
            last_fill(&built, &asked);
            ASSERT_NEAR(built, asked, 0.51 * dp * dp);
            filled++;
        } else {
            assert_int_equal(status, MPS_E_ARG);
            assert_non_null(strstr(mps_sim_error(sim), "nothing to fill"));
            assert_true(filled == 0);
            refused++;
        }
        mps_sim_destroy(sim);
    }
    assert_true(refused > 0 && filled > 30);
}

/* A tank 2 m wide with a bottom that has slopes of 45 degrees, 0.3 m high. */
static double trough(void *user, const double *x)
{
    const double wall = fmin(x[0], 2 - x[0]), slope = (wall + x[1] - 0.3) / sqrt(2);
    const double side = *(const int *)user == 3 ? fmin(x[2], 0.6 - x[2]) : INFINITY;
    return fmin(fmin(wall, fmin(x[1], 0.8 - x[1])), fmin(slope, side));
}

/* Of particles, and of half a spacing at walls: 0.45 m above the bottom, where its slopes have
 * ended, and 0.2 m, where they have not. */
static void level_over_slopes(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 10; k++) {
            if (!has_turn(k, dim, 3)) continue;
            const double dp = (dim == 3 ? 0.04 : 0.0125) + 0.0017 * (k / 2), y = k % 2 ? 0.2 : 0.45,
                         cell = dim == 3 ? dp * dp * dp : dp * dp, depth = dim == 3 ? 0.6 : 1;
            const double lo[3] = {0, 0, 0}, hi[3] = {2, y, 0.6};
            const double exact = depth * (2 * y - (k % 2 ? 0.3 * 0.3 - 0.1 * 0.1 : 0.3 * 0.3));
            mps_sim *sim = logging(dim, dp);
            mps_solid solid;
            double built, asked;
            assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
            solid.distance = trough;
            solid.user = &dim;
            solid.hi[0] = 2;
            solid.hi[1] = 0.8;
            solid.hi[2] = 0.6;
            ASSERT_OK(sim, mps_solid_add(sim, &solid));
            ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
            last_fill(&built, &asked);
            ASSERT_NEAR(asked, exact, (dim == 3 ? 0.004 : 0.0003) * exact);
            ASSERT_NEAR(built, asked, 0.51 * cell); /* the log has six digits */
            mps_sim_destroy(sim);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_are_told),
        cmocka_unit_test(level_in_a_bowl),
        cmocka_unit_test(little_in_a_bowl),
        cmocka_unit_test(level_over_slopes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
