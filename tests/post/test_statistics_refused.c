/* SPDX-License-Identifier: BSD-3-Clause */
/* Arguments that functions of statistics refuse: the status, the text, and unchanged outputs. */
#include "stats_fixture.h"

enum { SAMPLES = 400 };
static double t[SAMPLES], p[SAMPLES];

/* Ten peaks, of 1 to 10 Pa. */
static mps_impacts *ten_impacts(void)
{
    mps_impacts *out = NULL;
    mps_stats_config config = new_config();
    config.threshold = 0.5;
    config.window = 0;
    for (int k = 0; k < SAMPLES; k++) {
        t[k] = k;
        p[k] = k % 40 == 20 ? 1 + k / 40 : 0;
    }
    ASSERT_DONE(mps_impacts_find(&config, SAMPLES, t, p, &out));
    return out;
}

/* Never initialised. */
static void configs(void **state)
{
    const mps_stats_config none = {.struct_size = 0};
    const double values[3] = {1, 2, 3}, *const cells[1] = {values};
    double mean[3], value;
    mps_harmonics h;
    mps_comparison compared;
    mps_convergence converged;
    mps_repeat repeat;
    mps_table *table;
    mps_condition condition;
    mps_series s = {.struct_size = sizeof s, .n = SAMPLES, .t = t, .p = p};
    (void)state;
    mps_harmonics_init(&h, sizeof h);
    mps_comparison_init(&compared, sizeof compared);
    mps_convergence_init(&converged, sizeof converged);
    mps_repeat_init(&repeat, sizeof repeat);
    mps_condition_init(&condition, sizeof condition);
    assert_int_equal(mps_harmonics_find(&none, SAMPLES, t, p, &h), MPS_E_ARG);
    assert_int_equal(mps_series_compare(&none, &s, &s, &compared), MPS_E_ARG);
    assert_int_equal(mps_converge(&none, values, values, &converged), MPS_E_ARG);
    assert_int_equal(mps_repeat_find(&none, 3, values, &repeat), MPS_E_ARG);
    assert_int_equal(mps_repeat_peaks(&none, 1, NULL, 0, &repeat), MPS_E_ARG);
    assert_int_equal(mps_panel_mean(&none, 1, 3, cells, mean), MPS_E_ARG);
    assert_int_equal(mps_long_term_exceedance(&none, 1, &condition, 1, &value, NULL), MPS_E_ARG);
    assert_int_equal(mps_long_term_value(&none, 1, &condition, 1, &value), MPS_E_ARG);
    assert_int_equal(mps_table_read(&none, "a.csv", 0, NULL, &table), MPS_E_ARG);
    assert_null(table);
}

/* An error text needs a buffer. */
static void places_of_texts(void **state)
{
    const double spacing[3] = {1, 2, 3}, value[3] = {1, INFINITY, 3};
    char text[40] = "as before";
    mps_stats_config config = new_config();
    mps_convergence c;
    (void)state;
    mps_convergence_init(&c, sizeof c);
    config.error = NULL;
    assert_int_equal(mps_converge(&config, spacing, value, &c), MPS_E_ARG);
    config.error = text;
    config.error_size = 0;
    assert_int_equal(mps_converge(&config, spacing, value, &c), MPS_E_ARG);
    assert_string_equal(text, "as before");
    config.error_size = sizeof text;
    assert_int_equal(mps_converge(&config, spacing, value, &c), MPS_E_ARG);
    assert_string_equal(text, "value[1] is inf: must be finite");
    assert_int_equal(mps_convergence_init(&c, 5000), MPS_E_ARG); /* no struct is so large */
}

static void series(void **state)
{
    const double values[3] = {1, 2, 3}, zero[3] = {0, 1, 2}, far[3] = {1, 2, INFINITY};
    const double *const one[1] = {values}, *const none[1] = {NULL};
    static const char *const names[1] = {NULL};
    double mean[3];
    mps_stats_config config = new_config();
    mps_harmonics h;
    mps_convergence c;
    mps_repeat r;
    mps_table *table;
    (void)state;
    mps_harmonics_init(&h, sizeof h);
    h.omega = INFINITY;
    ASSERT_SAYS(mps_harmonics_find(&config, SAMPLES, t, p, &h), MPS_E_ARG, "omega is inf");
    mps_convergence_init(&c, sizeof c);
    ASSERT_SAYS(mps_converge(&config, zero, values, &c), MPS_E_ARG, "spacing[0] is 0");
    ASSERT_SAYS(mps_converge(&config, far, values, &c), MPS_E_ARG, "spacing[2] is inf");
    mps_repeat_init(&r, sizeof r);
    ASSERT_SAYS(mps_repeat_find(&config, 3, NULL, &r), MPS_E_ARG, "must be >= 1");
    ASSERT_SAYS(mps_panel_mean(&config, 1, 3, NULL, mean), MPS_E_ARG, "p is NULL");
    ASSERT_SAYS(mps_panel_mean(&config, 1, 3, one, NULL), MPS_E_ARG, "mean is NULL");
    ASSERT_SAYS(mps_panel_mean(&config, 1, 3, none, mean), MPS_E_ARG, "p[0] is NULL");
    ASSERT_DONE(mps_panel_mean(&config, 1, 0, none, mean));
    ASSERT_SAYS(mps_table_read(&config, "a.csv", 1, NULL, &table), MPS_E_ARG, "count is 1");
    ASSERT_SAYS(mps_table_read(&config, "a.csv", 1, names, &table), MPS_E_ARG, "names[0] is NULL");
}

static void results(void **state)
{
    mps_impacts *impacts = ten_impacts();
    mps_impacts_info info = {.struct_size = sizeof info}, other_info = {.struct_size = 1};
    mps_impact one = {.struct_size = sizeof one}, other = {.struct_size = 1};
    mps_exceedance point = {.struct_size = sizeof point}, other_point = {.struct_size = 1};
    mps_fit fit = {.struct_size = sizeof fit}, other_fit = {.struct_size = 1};
    (void)state;
    assert_int_equal(mps_impacts_info_get(NULL, &info), MPS_E_ARG);
    assert_int_equal(mps_impacts_info_get(impacts, &other_info), MPS_E_ARG);
    assert_int_equal(mps_impacts_get(NULL, 0, &one), MPS_E_ARG);
    assert_int_equal(mps_impacts_get(impacts, 0, &other), MPS_E_ARG);
    assert_int_equal(mps_impacts_exceedance(NULL, 0, &point), MPS_E_ARG);
    assert_int_equal(mps_impacts_exceedance(impacts, 0, &other_point), MPS_E_ARG);
    assert_int_equal(mps_impacts_fit_get(NULL, 0, &fit), MPS_E_ARG);
    assert_int_equal(mps_impacts_fit_get(impacts, 0, &other_fit), MPS_E_ARG);
    assert_int_equal(mps_impacts_fit_get(impacts, 2, &fit), MPS_E_ARG);
    assert_int_equal(mps_impacts_highest(NULL, 0, &one), MPS_E_ARG);
    for (int64_t k = -1; k <= 10; k += 11) { /* in addition to the ten */
        assert_int_equal(mps_impacts_get(impacts, k, &one), MPS_E_ARG);
        assert_int_equal(mps_impacts_highest(impacts, k, &one), MPS_E_ARG);
        assert_int_equal(mps_impacts_exceedance(impacts, k, &point), MPS_E_ARG);
    }
    assert_int_equal(mps_impacts_highest(impacts, 9, &one), MPS_OK);
    ASSERT_NEAR(one.peak, 1, 1e-12);
    mps_impacts_destroy(impacts);
}

static void texts(void **state)
{
    static const char *const names[1] = {"P1"}, *const no_names[1] = {NULL};
    mps_impacts *impacts = ten_impacts();
    const mps_impacts *const all[1] = {impacts}, *const none[1] = {NULL};
    char text[100];
    (void)state;
    assert_int_equal(mps_stats_csv_write(-1, names, all, text, sizeof text), 0);
    assert_int_equal(mps_stats_csv_write(1, NULL, all, text, sizeof text), 0);
    assert_int_equal(mps_stats_csv_write(1, names, NULL, text, sizeof text), 0);
    assert_int_equal(mps_stats_csv_write(1, no_names, all, text, sizeof text), 0);
    assert_int_equal(mps_stats_csv_write(1, names, none, text, sizeof text), 0);
    assert_int_equal(mps_stats_csv_write(1, names, all, NULL, sizeof text), 0);
    assert_true(mps_stats_csv_write(1, names, all, NULL, 0) > sizeof text);
    assert_int_equal(mps_stats_json_write(1, no_names, all, 3, text, sizeof text), 0);
    assert_int_equal(mps_stats_json_write(1, names, all, 3, NULL, sizeof text), 0);
    assert_int_equal(mps_stats_json_write(1, names, all, -1, text, sizeof text), 0);
    /* a larger number gives all */
    assert_int_equal(mps_stats_json_write(1, names, all, 10, NULL, 0),
                     mps_stats_json_write(1, names, all, 1000, NULL, 0));
    mps_impacts_destroy(impacts);
}

static void runs(void **state)
{
    mps_impacts *impacts = ten_impacts();
    const mps_impacts *const all[2] = {impacts, impacts};
    mps_stats_config config = new_config();
    mps_repeat r = {.struct_size = sizeof r}, other = {.struct_size = 1};
    (void)state;
    ASSERT_SAYS(mps_repeat_peaks(&config, 1, NULL, 0, &r), MPS_E_ARG, "runs is 1");
    ASSERT_SAYS(mps_repeat_peaks(&config, 1, all, 0, &other), MPS_E_ARG, "mps_repeat_init()");
    ASSERT_SAYS(mps_repeat_peaks(&config, 1, all, -1, &r), MPS_E_ARG,
                "index is -1: must be 0 .. 9");
    ASSERT_SAYS(mps_repeat_peaks(&config, 1, all, 10, &r), MPS_E_ARG, "must be 0 .. 9");
    ASSERT_DONE(mps_repeat_peaks(&config, 2, all, 3, &r));
    assert_int_equal(r.count, 2);
    ASSERT_NEAR(r.mean, 4, 1e-12);
    mps_impacts_destroy(impacts);
}

static void distributions(void **state)
{
    static const double peaks[5] = {1, 2, 3, 4, 5};
    mps_stats_config config = new_config();
    mps_fit fit = {.struct_size = sizeof fit};
    mps_condition c;
    double share, value;
    (void)state;
    config.least_events = 2;
    config.resamples = 0;
    ASSERT_SAYS(mps_fit_weibull(&config, 5, peaks, 0, INFINITY, &fit), MPS_E_ARG, "number is inf");
    ASSERT_DONE(mps_fit_weibull(&config, 5, peaks, 0, 10, &fit));
    assert_true(isnan(mps_fit_exceedance(&fit, NAN)));
    mps_condition_init(&c, sizeof c);
    c.share = c.rate = 1;
    c.fit = &fit;
    ASSERT_DONE(mps_long_term_value(&config, 1, &c, 10, &value));
    ASSERT_SAYS(mps_long_term_value(&config, 1, &c, 10, NULL), MPS_E_ARG, "value not NULL");
    ASSERT_SAYS(mps_long_term_value(&config, 1, &c, INFINITY, &value), MPS_E_ARG, "time is inf");
    ASSERT_SAYS(mps_long_term_value(&config, 1, NULL, 10, &value), MPS_E_ARG, "count is 1");
    ASSERT_SAYS(mps_long_term_exceedance(&config, 1, &c, 1, NULL, NULL), MPS_E_ARG, "not NULL");
    ASSERT_SAYS(mps_long_term_exceedance(&config, 1, &c, NAN, &share, NULL), MPS_E_ARG, "P is nan");
    c.share = 1.5;
    ASSERT_SAYS(mps_long_term_value(&config, 1, &c, 10, &value), MPS_E_ARG, "share is 1.5");
    c.share = 1;
    c.rate = INFINITY;
    ASSERT_SAYS(mps_long_term_value(&config, 1, &c, 10, &value), MPS_E_ARG, "rate is inf");
    c.rate = -1;
    ASSERT_SAYS(mps_long_term_value(&config, 1, &c, 10, &value), MPS_E_ARG, "rate is -1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(configs),      cmocka_unit_test(places_of_texts), cmocka_unit_test(series),
        cmocka_unit_test(results),      cmocka_unit_test(texts),           cmocka_unit_test(runs),
        cmocka_unit_test(distributions)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
