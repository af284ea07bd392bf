/* SPDX-License-Identifier: BSD-3-Clause */
/* Complete signals: scales, dependence, default threshold, panels; arguments, constants and structs
 * that are refused. */
#include "event_fixture.h"

/* ---- the signal as a whole ---- */

static void scales(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    triangle all[TRIANGLES];
    make_triangles(all, true, 7);
    signal s = sample_triangles(all, TRIANGLES, DT, GAP * (TRIANGLES + 1));
    config.length_scale = 40;
    config.density_ratio = 0.45;
    config.crossing_time = 0.5;
    mps_impacts *impacts = find(&config, &s);
    mps_impacts_info info = info_of(impacts);
    mps_fit fit;
    int unresolved = 0;
    for (int k = 0; k < TRIANGLES; k++) {
        const mps_impact e = event_of(impacts, k);
        unresolved += e.rise < 0.5 || e.decay < 0.5;
        assert_int_equal(e.unresolved, e.rise < 0.5 || e.decay < 0.5);
    }
    assert_true(unresolved > 0 && unresolved < TRIANGLES);
    assert_int_equal(info.unresolved, unresolved);
    ASSERT_NEAR(info.pressure_scale, 18, 1e-12);
    ASSERT_NEAR(info.time_scale, sqrt(40), 1e-12);
    ASSERT_NEAR(info.exposure, 10800 / sqrt(40), 1e-9);
    ASSERT_NEAR(info.exposure_events, info.rate * 10800 / sqrt(40), 1e-9);
    assert_int_equal(info.long_exposure, 1); /* 1708 s of 3 x 505 s */
    assert_int_equal(mps_fit_init(&fit, sizeof fit), MPS_OK);
    assert_int_equal(mps_impacts_fit_get(impacts, MPS_FIT_PARETO, &fit), MPS_OK);
    ASSERT_NEAR(fit.number, info.exposure_events, 0);
    ASSERT_NEAR(fit.value, mps_fit_value(&fit, info.exposure_events), 0);
    ASSERT_NEAR(fit.location, THRESHOLD, 0);
    assert_int_equal(mps_impacts_fit_get(impacts, 2, &fit), MPS_E_ARG);
    mps_impacts_destroy(impacts);
    config.exposure = 9000;
    impacts = find(&config, &s);
    info = info_of(impacts);
    assert_int_equal(info.long_exposure, 0);
    mps_impacts_destroy(impacts);
    free_signal(&s);
}

static void dependence(void **state)
{
    (void)state;
    const mps_stats_config config = event_config();
    for (int c = 0; c < 2; c++) {
        triangle all[TRIANGLES];
        double mean = 0, both = 0, square = 0;
        make_triangles(all, true, 8);
        for (int k = 0; k < TRIANGLES; k++) {
            if (c) all[k].peak = 100 + 50 * sin(0.3 * k);
            mean += all[k].peak / TRIANGLES;
        }
        for (int k = 0; k < TRIANGLES; k++) {
            square += pow(all[k].peak - mean, 2);
            if (k) both += (all[k].peak - mean) * (all[k - 1].peak - mean);
        }
        signal s = sample_triangles(all, TRIANGLES, DT, GAP * (TRIANGLES + 1));
        mps_impacts *impacts = find(&config, &s);
        const mps_impacts_info info = info_of(impacts);
        ASSERT_NEAR(info.correlation, both / square, 1e-9);
        ASSERT_NEAR(info.correlation_limit, 0.2, 1e-15);
        assert_int_equal(info.dependent, c);
        mps_impacts_destroy(impacts);
        free_signal(&s);
    }
}

static void thresholds(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    const double t[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, p[] = {0, 0, 0, 0, 10, 0, 0, 0, 0, 0};
    signal s = {10, (double *)t, (double *)p};
    config.threshold = NAN;
    mps_impacts *impacts = find(&config, &s);
    ASSERT_NEAR(info_of(impacts).threshold, 1 + 2 * 3, 1e-12);
    assert_int_equal(info_of(impacts).events, 1);
    mps_impacts_destroy(impacts);
    config.window = NAN;
    config.period = 4;
    impacts = find(&config, &s);
    ASSERT_NEAR(info_of(impacts).window, 0.8, 1e-15);
    mps_impacts_destroy(impacts);
}

static void panels(void **state)
{
    (void)state;
    const mps_stats_config config = event_config();
    const double a[] = {1, 2, NAN}, b[] = {3, 5, 7};
    const double *const cells[] = {a, b}, *const holes[] = {a, NULL};
    double mean[3];
    ASSERT_DONE(mps_panel_mean(&config, 2, 3, cells, mean));
    ASSERT_NEAR(mean[0], 2, 0);
    ASSERT_NEAR(mean[1], 3.5, 0);
    assert_true(isnan(mean[2]));
    ASSERT_SAYS(mps_panel_mean(&config, 0, 3, cells, mean), MPS_E_ARG, "cells is 0");
    ASSERT_SAYS(mps_panel_mean(&config, 2, -3, cells, mean), MPS_E_ARG, "n is -3");
    ASSERT_SAYS(mps_panel_mean(&config, 2, 3, holes, mean), MPS_E_ARG, "p[1] is NULL");
    ASSERT_SAYS(mps_panel_mean(&config, 2, 3, cells, NULL), MPS_E_ARG, "mean is NULL");
}

/* ---- what is refused ---- */

static void refused(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    double t[] = {0, 1, 1, 3}, p[] = {0, 1, 2, 3};
    mps_impacts *impacts = (mps_impacts *)t;
    ASSERT_SAYS(mps_impacts_find(&config, 4, t, p, &impacts), MPS_E_ARG,
                "t[2] is 1: must be larger");
    assert_null(impacts);
    t[2] = NAN;
    ASSERT_SAYS(mps_impacts_find(&config, 4, t, p, &impacts), MPS_E_ARG, "t[2] is");
    t[2] = 2;
    p[3] = -INFINITY;
    ASSERT_SAYS(mps_impacts_find(&config, 4, t, p, &impacts), MPS_E_ARG, "p[3] is -inf");
    ASSERT_SAYS(mps_impacts_find(&config, -1, t, p, &impacts), MPS_E_ARG, "n is -1");
    ASSERT_SAYS(mps_impacts_find(&config, 1, NULL, p, &impacts), MPS_E_ARG, "t is NULL");
    ASSERT_SAYS(mps_impacts_find(&config, 1, t, NULL, &impacts), MPS_E_ARG, "p is NULL");
    ASSERT_SAYS(mps_impacts_find(&config, 1, t, p, NULL), MPS_E_ARG, "impacts is NULL");
    config.window = NAN;
    ASSERT_SAYS(mps_impacts_find(&config, 3, t, p, &impacts), MPS_E_ARG, "'window' and 'period'");
    config.window = 1;
    config.rate = 1e13;
    ASSERT_SAYS(mps_impacts_find(&config, 3, t, p, &impacts), MPS_E_ARG, "'rate' is 1e+13");
}

#define SPOIL(member, value)                                                              \
    do {                                                                                  \
        mps_stats_config bad = event_config();                                            \
        bad.member = (value);                                                             \
        ASSERT_SAYS(mps_impacts_find(&bad, 0, NULL, NULL, &impacts), MPS_E_ARG, #member); \
    } while (0)

static void constants_refused(void **state)
{
    (void)state;
    mps_impacts *impacts;
    mps_stats_config config;
    SPOIL(resamples, -1);
    SPOIL(resamples, 1000001);
    SPOIL(least_events, 1);
    SPOIL(from, NAN);
    SPOIL(until, -INFINITY);
    SPOIL(reserved, 1);
    SPOIL(rate, -1);
    SPOIL(high_pass, NAN);
    SPOIL(threshold, INFINITY);
    SPOIL(deviations, NAN);
    SPOIL(window, -1);
    SPOIL(window_share, -1);
    SPOIL(period, 0);
    SPOIL(share, 0);
    SPOIL(share, 1);
    SPOIL(crossing_time, -1);
    SPOIL(confidence, 0);
    SPOIL(exposure, 0);
    SPOIL(exposure_ratio, 0);
    SPOIL(dependence, 0);
    SPOIL(length_scale, 0);
    SPOIL(density_ratio, NAN);
    SPOIL(shift_most, 0);
    SPOIL(order_least, 0);
    SPOIL(order_least, 3);
    SPOIL(order_most, INFINITY);
    SPOIL(safety, 0);
    SPOIL(safety_poor, -1);
    mps_exceedance point;
    mps_repeat repeat;
    assert_int_equal(mps_exceedance_init(&point, sizeof point), MPS_OK);
    assert_int_equal(mps_exceedance_init(&point, 8), MPS_E_ARG);
    assert_int_equal(mps_repeat_init(&repeat, sizeof repeat), MPS_OK);
    assert_int_equal(mps_repeat_init(NULL, sizeof repeat), MPS_E_ARG);
    assert_int_equal(mps_stats_config_init(NULL, sizeof config), MPS_E_ARG);
    assert_int_equal(mps_stats_config_init(&config, sizeof config - 1), MPS_E_ARG);
    config = event_config();
    config.struct_size = 3;
    assert_int_equal(mps_impacts_find(&config, 0, NULL, NULL, &impacts), MPS_E_ARG);
    assert_int_equal(mps_impacts_find(NULL, 0, NULL, NULL, &impacts), MPS_E_ARG);
}

/* A program of a newer version has a longer config: good, as long as it uses none of the new
 * entries. */
static void newer_structs(void **state)
{
    (void)state;
    struct {
        mps_stats_config config;
        double more;
    } newer;
    mps_impacts *impacts = NULL;
    assert_int_equal(mps_stats_config_init(&newer.config, sizeof newer), MPS_OK);
    newer.config.window = 1;
    newer.config.error = stats_error;
    newer.config.error_size = sizeof stats_error;
    ASSERT_DONE(mps_impacts_find(&newer.config, 0, NULL, NULL, &impacts));
    struct {
        mps_impacts_info info;
        double more;
    } info;
    assert_int_equal(mps_impacts_info_init(&info.info, sizeof info), MPS_OK);
    info.more = 7;
    assert_int_equal(mps_impacts_info_get(impacts, &info.info), MPS_OK);
    assert_true(info.more == 7 && info.info.struct_size == sizeof info);
    assert_true(isnan(info.info.t_first) && info.info.rate == 0);
    info.info.struct_size = 8;
    assert_int_equal(mps_impacts_info_get(impacts, &info.info), MPS_E_ARG);
    mps_impacts_destroy(impacts);
    newer.more = 1;
    ASSERT_SAYS(mps_impacts_find(&newer.config, 0, NULL, NULL, &impacts), MPS_E_VERSION, "newer");
    mps_impacts_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scales),        cmocka_unit_test(dependence),
        cmocka_unit_test(thresholds),    cmocka_unit_test(panels),
        cmocka_unit_test(refused),       cmocka_unit_test(constants_refused),
        cmocka_unit_test(newer_structs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
