/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure datum of a closed tank: none, by a layer of gas, by the lid; and the messages. */
#include "phase_fixture.h"
#include <stdio.h>

static char logged[400];
static int times_told;

static void listen(void *user, int level, const char *text)
{
    (void)user;
    if (level != MPS_LOG_INFO || !strstr(text, "level")) return;
    times_told++;
    snprintf(logged, sizeof logged, "%s", text);
}

enum { ROWS = 8 };
static const double dp = 0.05, side = 0.4;

/* A closed tank full of water, at rest or rotated by an angle about its corner. Scheme imps. */
static mps_sim *full_tank(int dim, double angle)
{
    mps_config config;
    mps_sim *sim = NULL;
    const double lo[3] = {0}, hi[3] = {side, side, side};
    times_told = 0;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.log = listen;
    config.gravity[0] = -9.81 * sin(angle);
    config.gravity[1] = -9.81 * cos(angle);
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, side, side, side);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_model_register(sim, &spy_after));
    ASSERT_OK(sim, mps_model_use(sim, "after.spy"));
    return sim;
}

/* Mean of p over walls and fluid in the equation; p + rho g y, which is constant in a fluid at
 * rest, is written to `level`. */
static double mean_pressure(mps_sim *sim, int dim, double *level)
{
    const int32_t *kinds;
    double sum = 0, count = 0, low = INFINITY, high = -INFINITY;
    mps_lease p = {.struct_size = sizeof p}, x = {.struct_size = sizeof x};
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < p.count; i++) {
        if (kinds[i] == MPS_DUMMY) continue;
        const double head = p.data[i] + 9810 * x.data[i * dim + 1];
        low = fmin(low, head);
        high = fmax(high, head);
        sum += p.data[i];
        count++;
    }
    *level = 0.5 * (low + high);
    assert_true(high - low < 0.02 * 9810 * side);
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    return sum / count;
}

/* Without a reference the mean is 0, and this is logged once; the model of the lid subtracts the
 * pressure at the lid, and the flow is the same within rounding. */
static void gauge_by_lid(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        double *u[2], *x[2], level;
        for (int lid = 0; lid < 2; lid++) {
            mps_sim *sim = full_tank(dim, 0);
            if (lid) ASSERT_OK(sim, mps_model_use(sim, "reference.lid"));
            for (int k = 0; k < 5; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
            const double mean = mean_pressure(sim, dim, &level);
            if (lid) {
                ASSERT_NEAR(level, 9810 * side, 0.01 * 9810 * side); /* p = 0 at the lid */
            } else {
                ASSERT_NEAR(mean, 0, 1e-6);
            }
            assert_int_equal(times_told, 1);
            assert_int_equal(spy.level_free, 1);
            u[lid] = field_by_id(sim, "velocity");
            x[lid] = field_by_id(sim, "position");
            if (lid)
                for (int64_t i = 0; i < mps_particles_count(sim, -1) * dim; i++) {
                    ASSERT_NEAR(u[1][i], u[0][i], 1e-6);
                    ASSERT_NEAR(x[1][i], x[0][i], 1e-9);
                }
            mps_sim_destroy(sim);
        }
        for (int lid = 0; lid < 2; lid++) {
            free(u[lid]);
            free(x[lid]);
        }
    }
}

/* The level of a fluid at rest follows the highest corner of a rotated tank without jumps. */
static void gauge_of_turned_tanks(void **state)
{
    (void)state;
    double before = 0;
    for (int degrees = -40; degrees <= 40; degrees += 2) {
        const double angle = degrees * 3.14159265358979323846 / 180;
        const int32_t *kinds;
        mps_lease p = {.struct_size = sizeof p}, x = {.struct_size = sizeof x};
        mps_sim *sim = full_tank(2, angle);
        ASSERT_OK(sim, mps_model_use(sim, "reference.lid"));
        ASSERT_OK(sim, mps_step(sim, 1e-4, NULL));
        ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
        ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
        double top = -INFINITY, head = 0, count = 0;
        for (int64_t i = 0; i < p.count; i++) {
            const double height = x.data[2 * i] * sin(angle) + x.data[2 * i + 1] * cos(angle);
            if (kinds[i] == MPS_WALL) top = fmax(top, height);
            if (kinds[i] != MPS_FLUID) continue;
            head += p.data[i] / 9810 + height;
            count++;
        }
        const double level = head / count -
                             top; /* height at which p = 0, above the highest wall particle */
        ASSERT_NEAR(level, 0, 0.75 * dp);
        if (degrees > -40) ASSERT_NEAR(level, before, 0.2 * dp);
        before = level;
        ASSERT_OK(sim, mps_lease_end(sim, &p));
        ASSERT_OK(sim, mps_lease_end(sim, &x));
        mps_sim_destroy(sim);
    }
}

/* An open tank has a free surface: the model of the lid changes no byte, and no message is
 * logged. */
static void lid_of_open_tank(void **state)
{
    (void)state;
    double *p[2];
    for (int lid = 0; lid < 2; lid++) {
        mps_sim *sim = new_sim(2, dp);
        add_tank(sim, side, side, 0);
        fill_depth(sim, side, 0.25, 0);
        ASSERT_OK(sim, mps_model_register(sim, &spy_after));
        ASSERT_OK(sim, mps_model_use(sim, "after.spy"));
        if (lid) ASSERT_OK(sim, mps_model_use(sim, "reference.lid"));
        for (int k = 0; k < 5; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
        assert_int_equal(spy.level_free, 0);
        p[lid] = field_by_id(sim, "pressure");
        if (lid)
            assert_memory_equal(p[0], p[1], (size_t)mps_particles_count(sim, -1) * sizeof *p[0]);
        mps_sim_destroy(sim);
    }
    free(p[0]);
    free(p[1]);
}

/* A compressible phase is a pressure datum. */
static void lid_beside_gas(void **state)
{
    (void)state;
    mps_sim *sim = full_tank(2, 0);
    ASSERT_OK(sim, mps_model_use(sim, "reference.lid"));
    ASSERT_OK(sim, mps_model_use(sim, "gas.compressible"));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "phase", 0));
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    assert_int_equal(spy.level_free, 0);
    assert_int_equal(times_told, 0);
    mps_sim_destroy(sim);
}

/* p = 0 in the uppermost layer of the phase only. */
static void layer_of_gas(void **state)
{
    (void)state;
    mps_sim *sim = full_tank(2, 0);
    ASSERT_OK(sim, mps_model_use(sim, "reference.gas"));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, "phase 1 has no fluid particle");
    ASSERT_OK(sim, mps_model_set(sim, "reference", "phase", 0));
    for (int layers = 1; layers <= 2; layers++) {
        ASSERT_OK(sim, mps_model_set(sim, "reference", "layer", layers - 0.25));
        ASSERT_OK(sim, mps_step(sim, 1e-6, NULL));
        assert_int_equal(spy.level_free, 0);
        const int32_t *kinds;
        int zero = 0;
        mps_lease p = {.struct_size = sizeof p}, x = {.struct_size = sizeof x};
        ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
        ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
        for (int64_t i = 0; i < p.count; i++) {
            if (kinds[i] != MPS_FLUID) continue;
            const int upper = x.data[2 * i + 1] > side - (layers + 0.5) * dp;
            assert_int_equal(p.data[i] == 0, upper);
            zero += upper;
        }
        assert_int_equal(zero, layers * (ROWS - 1));
        ASSERT_OK(sim, mps_lease_end(sim, &p));
        ASSERT_OK(sim, mps_lease_end(sim, &x));
    }
    mps_sim_destroy(sim);
}

/* Without gravity nothing is uppermost. */
static void weightless(void **state)
{
    (void)state;
    static const char *const models[] = {"reference.gas", "reference.lid"};
    for (int m = 0; m < 2; m++) {
        const double lo[2] = {0}, hi[2] = {side, side};
        mps_sim *sim = bare_sim(2, dp, 3.1, 1e-3);
        ASSERT_OK(sim, mps_preset_use(sim, "imps"));
        add_tank(sim, side, side, 0);
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
        ASSERT_OK(sim, mps_model_use(sim, models[m]));
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "without gravity");
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gauge_by_lid),     cmocka_unit_test(gauge_of_turned_tanks),
        cmocka_unit_test(lid_of_open_tank), cmocka_unit_test(lid_beside_gas),
        cmocka_unit_test(layer_of_gas),     cmocka_unit_test(weightless)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
