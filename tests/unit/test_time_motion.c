/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps resolve the motion of the tank, and are not shorter than necessary. */
#include "tank_fixture.h"
#include <string.h>

static const double dp = 0.05;
static int warnings; /* that a fixed step is too long */

static void count_warnings(void *user, int level, const char *text)
{
    (void)user;
    if (level == MPS_LOG_WARNING && strstr(text, "misses parts of the tank's motion")) warnings++;
}

static mps_sim *pool(void)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = dp;
    config.log = count_warnings;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    return sim;
}

/* Take a step; its limit must be of this name, unless NULL. */
static double step_taken(mps_sim *sim, const char *limit)
{
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1, &info));
    assert_non_null(info.limit);
    if (limit) assert_string_equal(info.limit, limit);
    return info.dt;
}

enum { TABLE = 4096 };

static const int32_t along_x = MPS_MOVE_X;

/* Rows of A sin(w t) every h seconds. */
static void shake_by_table(mps_sim *sim, double amplitude, double omega, double h)
{
    static double t[TABLE], x[TABLE];
    for (int k = 0; k < TABLE; k++) {
        t[k] = k * h;
        x[k] = amplitude * sin(omega * t[k]);
    }
    ASSERT_OK(sim, mps_motion_table_set(sim, TABLE, t, 1, &along_x, x));
}

/* The longest of some steps. */
static double longest_step(mps_sim *sim, int steps)
{
    double most = 0;
    for (int k = 0; k < steps; k++) most = fmax(most, step_taken(sim, NULL));
    return most;
}

/* A motion faster than the other limits is resolved: by its period, or as well by its rows. */
static void fast_motions(void **state)
{
    (void)state;
    const double omega = 3000, period = 2 * acos(-1) / omega, amplitude = 9810 / (omega * omega);
    const mps_harmonic still = {MPS_MOVE_Y, 0, 0, 1e6, 0, 0},
                       two[2] = {{MPS_MOVE_X, 0, amplitude, omega, 0, 0}, still};
    mps_sim *sim = pool();
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, two));
    ASSERT_NEAR(step_taken(sim, "motion"), period / 20, 1e-12);
    ASSERT_NEAR(longest_step(sim, 20), period / 20, 1e-12);
    mps_sim_destroy(sim);
    const mps_harmonic grows = {MPS_MOVE_X, 0, 1e-4, 3, 0, 0.02};
    sim = pool();
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &grows));
    for (int k = 0; k < 20; k++) ASSERT_NEAR(step_taken(sim, "motion"), 1e-3, 1e-12);
    assert_true(longest_step(sim, 2) > 1.05e-3);
    mps_sim_destroy(sim);
    sim = pool();
    shake_by_table(sim, amplitude, omega, period / 200);
    const double most = longest_step(sim, 40);
    assert_true(most > period / 40 && most < period / 10);
    mps_sim_destroy(sim);
    sim = pool(); /* alternating rows: none is skipped except where three are in line, at 0 */
    shake_by_table(sim, amplitude, omega, period / 2.5);
    assert_true(longest_step(sim, 20) < 2.01 * period / 2.5);
    mps_sim_destroy(sim);
}

/* Slow motions do not shorten steps, however close their rows are; nor does a steady speed. */
static void slow_motions(void **state)
{
    (void)state;
    const double gravity = 0.06 * dp / sqrt(9.81 * dp);
    mps_sim *sim = pool();
    shake_by_table(sim, 0.01, 6, gravity / 7);
    for (int k = 0; k < 60; k++) step_taken(sim, NULL); /* the spline begins with a bend */
    ASSERT_NEAR(step_taken(sim, "gravity"), gravity, 1e-15);
    mps_sim_destroy(sim);
    static double t[TABLE], x[TABLE];
    for (int k = 0; k < TABLE; k++) x[k] = 0.1 * (t[k] = k * gravity / 7);
    sim = pool();
    ASSERT_OK(sim, mps_motion_table_set(sim, TABLE, t, 1, &along_x, x));
    for (int k = 0; k < 20; k++) ASSERT_NEAR(step_taken(sim, "gravity"), gravity, 1e-15);
    mps_sim_destroy(sim);
}

/* After a rest a short jolt is resolved from its first row, and only rows in line are skipped. */
static void jolt(void **state)
{
    (void)state;
    const double h = 2e-4, start = 0.0101;
    double t[12] = {0}, x[12] = {0}, now = 0;
    int met = 0;
    for (int k = 1; k < 12; k++) t[k] = k < 11 ? start + (k - 1) * h : 1;
    for (int k = 3; k < 9; k++) x[k] = k % 2 ? 1e-5 : -1e-5;
    mps_sim *sim = pool();
    ASSERT_OK(sim, mps_motion_table_set(sim, 12, t, 1, &along_x, x));
    for (int k = 0; k < 40 && now < t[10]; k++) {
        const double dt = step_taken(sim, NULL);
        if (now > start - 1e-12 && now < t[10]) assert_true(dt < 2.01 * h);
        now += dt;
        met += fabs(now - start) < 1e-12;
    }
    assert_int_equal(met, 1);
    assert_true(now >= t[10] - 1e-12);
    mps_sim_destroy(sim);
}

/* A fixed step is the choice of the user, and logged once for each motion. */
static void fixed_step(void **state)
{
    (void)state;
    const mps_harmonic fast = {MPS_MOVE_X, 0, 1e-4, 3000, 0, 0},
                       slow = {MPS_MOVE_X, 0, 1e-4, 3, 0, 0};
    mps_sim *sim = pool();
    mps_time_control c;
    assert_int_equal(mps_time_control_init(&c, sizeof c), MPS_OK);
    c.dt = 1e-3;
    warnings = 0;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &slow));
    ASSERT_NEAR(step_taken(sim, "fixed"), 1e-3, 1e-18);
    assert_int_equal(warnings, 0);
    for (int k = 1; k <= 2; k++) {
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &fast));
        for (int s = 0; s < 3; s++) step_taken(sim, NULL);
        assert_int_equal(warnings, k);
    }
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(fast_motions),
                                       cmocka_unit_test(slow_motions), cmocka_unit_test(jolt),
                                       cmocka_unit_test(fixed_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
