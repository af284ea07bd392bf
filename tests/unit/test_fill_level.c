/* SPDX-License-Identifier: BSD-3-Clause */
/* Fills and baffles that do not match the lattice, and depths between its rows. */
#include "sim.h"
#include "../every.h"
#include "tank_fixture.h"
#include <stdio.h>

static char logged[512];

static void keep_log(void *user, int level, const char *text)
{
    (void)user;
    if (level == MPS_LOG_INFO) snprintf(logged, sizeof logged, "%s", text);
}

/* A tank of 0.4 x 0.3 x 0.1 m that logs. */
static mps_sim *logging(int32_t dim, double dp)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.log = keep_log;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 0.4, 0.3, 0.1);
    logged[0] = 0;
    return sim;
}

static void rounding_is_told(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const double lo[3] = {0, 0, 0}, hi[3] = {0.4, 0.093, 0.1}, from[3] = {0.1987, 0, 0},
                     to[3] = {0.2413, 0.0874, 0.1};
        double built[6];
        mps_sim *sim = logging(dim, 0.01);
        ASSERT_OK(sim, mps_baffle_add(sim, "wall", from, to, built));
        if (!strstr(logged, "baffle \"wall\": 0 .. 0.0874 m in y became 0 .. 0.08 m"))
            fail_msg("\"%s\"", logged);
        const double wanted[2][6] = {{0.2, 0, 0.24, 0.08}, {0.2, 0, 0, 0.24, 0.08, 0.1}};
        for (int d = 0; d < 2 * dim; d++) ASSERT_NEAR(built[d], wanted[dim - 2][d], 1e-12);
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, built));
        if (!strstr(logged, "fill: 0 .. 0.093 m in y became 0 .. 0.09 m"))
            fail_msg("\"%s\"", logged);
        ASSERT_NEAR(built[dim + 1], 0.09, 1e-12);
        mps_sim_destroy(sim);
        sim = logging(dim, 0.01);
        const double even[3] = {0.4, 0.09, 0.1};
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, even, NULL, built));
        if (strstr(logged, "became") || !strstr(logged, "requested, +0 %"))
            fail_msg("\"%s\"", logged);
        mps_sim_destroy(sim);
    }
}

/* The upper row has its fraction of points, and a further fill uses the remaining ones. */
static void share_of_a_row(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double share = 0.1; share < 1; share += 0.2) {
            const double dp = 0.005, lo[3] = {0, 0, 0}, hi[3] = {0.4, (18 + share) * dp, 0.1};
            const double row = dim == 2 ? 79 : 79 * 19;
            double built[6];
            int64_t added, rest;
            mps_sim *sim = logging(dim, dp);
            ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, &added, built));
            ASSERT_NEAR((double)added, (18 + share) * row, 0.5 + 1e-6);
            ASSERT_NEAR(built[dim + 1], (double)added / row * dp, 1e-12);
            const double up[3] = {0.4, 19 * dp, 0.1};
            ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, up, &rest, NULL));
            assert_int_equal(added + rest, (int64_t)(19 * row));
            mps_sim_destroy(sim);
        }
}

/* Levels at rows, and above the last row of the tank. */
static void whole_rows(void **state)
{
    (void)state;
    const double lo[2] = {0, 0};
    const struct {
        double level, built;
        int64_t rows;
    } list[] = {{0.09, 0.09, 9}, {0.3, 0.3, 29}, {0.297, 0, 0}, {0.4, 0.3, 29}};
    for (int k = 0; k < 4; k++) {
        const double hi[2] = {0.4, list[k].level};
        double built[4];
        int64_t added;
        mps_sim *sim = logging(2, 0.01);
        if (list[k].rows == 0) { /* the points of the row are the tank's lid */
            ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, &added, built));
            assert_int_equal(added, 39 * 29);
        } else {
            ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, &added, built));
            assert_int_equal(added, 39 * list[k].rows);
            ASSERT_NEAR(built[3], list[k].built, 1e-12);
        }
        mps_sim_destroy(sim);
    }
}

static void refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.01);
    const double lo[2] = {0, 0}, hi[2] = {0.4, 0.093}, nan[2] = {0.4, NAN}, below[2] = {0.4, -0.1};
    ASSERT_REFUSED(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL), MPS_E_STATE, "no lattice");
    add_tank(sim, 0.4, 0.3, 0);
    ASSERT_REFUSED(sim, mps_fill_level_add(sim, 0, lo, nan, NULL, NULL), MPS_E_ARG, "finite");
    ASSERT_REFUSED(sim, mps_fill_level_add(sim, 0, lo, below, NULL, NULL), MPS_E_ARG, "inverted");
    ASSERT_REFUSED(sim, mps_fill_level_add(sim, 0, NULL, hi, NULL, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_fill_level_add(sim, 1, lo, hi, NULL, NULL), MPS_E_ARG,
                   "phase 1 is not defined");
    assert_int_equal(mps_fill_level_add(NULL, 0, lo, hi, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_particles_count(sim, MPS_FLUID), 0);
    mps_sim_destroy(sim);
}

/* ---- at rest ---- */

enum { GAUGE, FLOOR, WALL, PROBES };

/* Means over the last half of a second, as levels. */
typedef struct means {
    int32_t id[PROBES];
    double sum[PROBES], time;
} means;

static int measure(void *user, mps_sim *sim, const mps_step_info *info)
{
    means *m = user;
    if (info->t < 1.5) return 0;
    m->time += info->dt;
    for (int k = 0; k < PROBES; k++) {
        double value;
        ASSERT_OK(sim, mps_probe_read(sim, m->id[k], &value));
        m->sum[k] += info->dt * value / (k == GAUGE ? 1 : 9810);
    }
    return 0;
}

/* A depth of 93 mm is 93 mm within 1 % at gauge, floor and wall after 2 s at rest, with 7 rows and
 * more. For 4.65 rows the upper row settles to .1 dp: over 84 spacings and widths of tanks
 * incomplete rows settle .02 dp too low, with a deviation of .05 dp. */
static void level_at_rest(void **state)
{
    static const double spacing[] = {0.00775, 0.0093, 0.01, 0.0133, 0.02};
    (void)state;
    for (size_t s = 0; s < sizeof spacing / sizeof spacing[0]; s++) {
        if (!has_turn((int64_t)s, 0, 4)) continue; /* the finest and the coarsest */
        const double depth = 0.093, lo[2] = {0, 0}, hi[2] = {0.6, depth},
                     place[PROBES][2] = {{0.2, 0}, {0.3, 0}, {0, 0.02}};
        means m = {.time = 0};
        mps_sim *sim = new_sim(2, spacing[s]);
        add_tank(sim, 0.6, 0.2, 0);
        ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
        for (int k = 0; k < PROBES; k++) {
            mps_probe p;
            assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
            p.type = k == GAUGE ? MPS_PROBE_GAUGE : MPS_PROBE_WALL_PRESSURE;
            memcpy(p.at, place[k], sizeof place[k]);
            ASSERT_OK(sim, mps_probe_add(sim, &p, &m.id[k]));
        }
        assert_true(mps_run(sim, 2, measure, &m) >= 0);
        for (int k = 0; k < PROBES; k++)
            ASSERT_NEAR(m.sum[k] / m.time + place[k][1], depth,
                        spacing[s] < 0.015 ? 0.01 * depth : 0.1 * spacing[s]);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounding_is_told), cmocka_unit_test(share_of_a_row),
        cmocka_unit_test(whole_rows),       cmocka_unit_test(refusals),
        cmocka_unit_test(level_at_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
