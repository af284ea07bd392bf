/* SPDX-License-Identifier: BSD-3-Clause */
/* Distributions of peaks: published values, exact quantiles, the likelihood by brute force,
 * coverage of bands, the long term. */
#include "stats_fixture.h"

enum { SAMPLES = 200, PEAKS = 200 };

static mps_fit new_fit(int32_t kind, double location, double scale, double shape)
{
    mps_fit fit;
    assert_int_equal(mps_fit_init(&fit, sizeof fit), MPS_OK);
    fit.kind = kind;
    fit.state = MPS_FIT_LIKELIHOOD;
    fit.location = location;
    fit.scale = scale;
    fit.shape = shape;
    return fit;
}

static mps_status make_fit(const mps_stats_config *config, int32_t kind, int64_t n,
                           const double *peaks, double u, double number, mps_fit *fit)
{
    assert_int_equal(mps_fit_init(fit, sizeof *fit), MPS_OK);
    if (kind == MPS_FIT_WEIBULL) return mps_fit_weibull(config, n, peaks, u, number, fit);
    return mps_fit_pareto(config, n, peaks, u, number, fit);
}

/* Peak with the exceedance q. */
static double quantile(const mps_fit *fit, double q)
{
    const double l = -log(q), x = fit->shape;
    if (fit->kind == MPS_FIT_WEIBULL) return fit->location + fit->scale * pow(l, 1 / x);
    return fit->location + fit->scale * (x != 0 ? expm1(x * l) / x : l);
}

/* OrcaFlex 11.5e, as published in docs/orcaflex_verification.md of ANYtimeseries, prints
 * 59,019.1. */
static void published_values(void **state)
{
    (void)state;
    const mps_fit pareto = new_fit(MPS_FIT_PARETO, 40000, 5391.150, -0.07283);
    const mps_fit weibull = new_fit(MPS_FIT_WEIBULL, 1, 2, 0.9);
    ASSERT_NEAR(mps_fit_value(&pareto, 59), 59019.03, 0.005);
    ASSERT_NEAR(mps_fit_value(&weibull, 300), 14.842, 0.0005);
    ASSERT_NEAR(mps_fit_exceedance(&pareto, mps_fit_value(&pareto, 59)), 1.0 / 59, 1e-15);
    ASSERT_NEAR(mps_fit_exceedance(&weibull, mps_fit_value(&weibull, 300)), 1.0 / 300, 1e-15);
}

static void limits_of_values(void **state)
{
    (void)state;
    const mps_fit exponential = new_fit(MPS_FIT_PARETO, 1, 2, 0),
                  nearly = new_fit(MPS_FIT_PARETO, 1, 2, 1e-13),
                  bounded = new_fit(MPS_FIT_PARETO, 1, 2, -0.5);
    mps_fit none = exponential;
    ASSERT_NEAR(mps_fit_value(&exponential, 100), 1 + 2 * log(100), 1e-14);
    ASSERT_NEAR(mps_fit_value(&nearly, 100), 1 + 2 * log(100), 1e-10);
    ASSERT_NEAR(mps_fit_exceedance(&exponential, 5), exp(-2), 1e-15);
    ASSERT_NEAR(mps_fit_exceedance(&bounded, 6), 0, 0); /* ends at 5 */
    ASSERT_NEAR(mps_fit_exceedance(&bounded, 0.5), 1, 0);
    ASSERT_NEAR(mps_fit_value(&bounded, 1), 1, 0);
    assert_true(isnan(mps_fit_value(&bounded, 0.99)));
    none.state = MPS_FIT_FEW;
    assert_true(isnan(mps_fit_value(&none, 100)) && isnan(mps_fit_exceedance(&none, 2)));
    assert_true(isnan(mps_fit_value(NULL, 100)));
}

/* (i + 1/2)/1000 of s = 1, x = 0.1. */
static void moments_of_quantiles(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    const mps_fit known = new_fit(MPS_FIT_PARETO, 0, 1, 0.1);
    double peaks[1000];
    mps_fit fit;
    for (int i = 0; i < 1000; i++) peaks[(i * 7) % 1000] = quantile(&known, 1 - (i + 0.5) / 1000);
    ASSERT_DONE(make_fit(&config, MPS_FIT_PARETO, 1000, peaks, 0, 0, &fit));
    ASSERT_NEAR(fit.moments_shape, 0.09975, 5e-6);
    ASSERT_NEAR(fit.moments_scale, 0.99950, 5e-6);
    assert_int_equal(fit.state, MPS_FIT_LIKELIHOOD);
    assert_int_equal(fit.count, 1000);
    assert_int_equal(fit.resamples, config.resamples);
    assert_true(isnan(fit.value)); /* number is 0 */
}

static double likelihood(const mps_fit *f, int n, const double *peaks, double scale, double shape)
{
    double sum = 0;
    for (int k = 0; k < n; k++) {
        const double y = (peaks[k] - f->location) / scale;
        if (f->kind == MPS_FIT_WEIBULL)
            sum += log(shape / scale) + (shape - 1) * log(y) - pow(y, shape);
        else
            sum -= log(scale) + (1 + 1 / shape) * log(1 + shape * y);
    }
    return sum;
}

/* No pair of parameters near the fit has a larger likelihood, in steps down to a millionth; and the
 * likelihood is that of the fit. */
static void largest_likelihood(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    config.resamples = 0;
    const mps_fit known[] = {
        new_fit(MPS_FIT_WEIBULL, 3, 2e4, 0.8), new_fit(MPS_FIT_WEIBULL, 0, 1e-3, 1),
        new_fit(MPS_FIT_WEIBULL, -5, 7, 3.5),  new_fit(MPS_FIT_PARETO, 100, 5e3, 0.4),
        new_fit(MPS_FIT_PARETO, 0, 1e-4, -.3), new_fit(MPS_FIT_PARETO, -2, 3, 0.01)};
    for (size_t c = 0; c < sizeof known / sizeof known[0]; c++) {
        uint64_t seed = 11 + c;
        double peaks[PEAKS];
        mps_fit fit;
        for (int k = 0; k < PEAKS; k++) peaks[k] = quantile(&known[c], draw(&seed));
        ASSERT_DONE(make_fit(&config, known[c].kind, PEAKS, peaks, known[c].location, 0, &fit));
        const double best = likelihood(&fit, PEAKS, peaks, fit.scale, fit.shape);
        ASSERT_NEAR(fit.log_likelihood, best, 1e-9 * fabs(best));
        for (double step = 0.3; step > 1e-6; step *= 0.5)
            for (int a = -1; a <= 1; a++)
                for (int b = -1; b <= 1; b++) {
                    const double other = likelihood(&fit, PEAKS, peaks, fit.scale * (1 + a * step),
                                                    fit.shape + b * step * 0.3);
                    if (other > best + 1e-11 * fabs(best))
                        fail_msg("set %zu: %g is likelier by %g at %d, %d times %g", c, other,
                                 other - best, a, b, step);
                }
    }
}

/* Exact quantiles of many peaks: the fit tends to the parameters, from heavy tails to bounded ones,
 * through x = 0. */
static void quantiles_come_back(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    enum { MANY = 20000 };
    double *peaks = malloc(MANY * sizeof *peaks);
    assert_non_null(peaks);
    config.resamples = 0;
    for (int c = 0; c <= 12; c++) {
        const bool weibull = c % 2;
        const mps_fit known = weibull ? new_fit(MPS_FIT_WEIBULL, 10, 4, 0.5 + 0.25 * c)
                                      : new_fit(MPS_FIT_PARETO, 10, 4, -0.3 + 0.05 * c);
        mps_fit fit;
        for (int i = 0; i < MANY; i++) peaks[i] = quantile(&known, (i + 0.5) / MANY);
        ASSERT_DONE(make_fit(&config, known.kind, MANY, peaks, 10, 0, &fit));
        assert_int_equal(fit.state, MPS_FIT_LIKELIHOOD);
        ASSERT_NEAR(fit.scale, known.scale, 0.002 * known.scale);
        ASSERT_NEAR(fit.shape, known.shape, 0.003);
    }
    free(peaks);
}

/* A change of units changes scale and values by its factor, and nothing else. */
static void units(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    uint64_t seed = 5;
    double peaks[100], other[100];
    mps_fit a, b;
    config.resamples = 50;
    for (int k = 0; k < 100; k++) {
        peaks[k] = 2 - 3 * log(draw(&seed));
        other[k] = 1e6 * peaks[k];
    }
    for (int32_t kind = MPS_FIT_WEIBULL; kind <= MPS_FIT_PARETO; kind++) {
        ASSERT_DONE(make_fit(&config, kind, 100, peaks, 2, 1000, &a));
        ASSERT_DONE(make_fit(&config, kind, 100, other, 2e6, 1000, &b));
        ASSERT_NEAR(b.shape, a.shape, 1e-9);
        ASSERT_NEAR(b.scale / 1e6, a.scale, 1e-9 * a.scale);
        ASSERT_NEAR(b.value_band[1] / 1e6, a.value_band[1], 1e-8 * a.value_band[1]);
    }
}

typedef struct coverage {
    int scale, shape, value;
} coverage;

static bool inside(double value, const double band[2])
{
    return value >= band[0] && value <= band[1];
}

static coverage count_coverage(const mps_stats_config *config, const mps_fit *known, int peaks,
                               double number)
{
    coverage c = {0};
    double *peak = malloc((size_t)peaks * sizeof *peak);
    assert_non_null(peak);
    for (int s = 0; s < SAMPLES; s++) {
        uint64_t seed = 1000003 * (uint64_t)(s + 1);
        mps_fit fit;
        for (int k = 0; k < peaks; k++) peak[k] = quantile(known, draw(&seed));
        ASSERT_DONE(make_fit(config, known->kind, peaks, peak, known->location, number, &fit));
        c.scale += inside(known->scale, fit.scale_band);
        c.shape += inside(known->shape, fit.shape_band);
        c.value += inside(mps_fit_value(known, number), fit.value_band);
    }
    free(peak);
    return c;
}

/* A band of 90 % contains the true value in 80 to 97 % of the samples, down to the least number of
 * peaks. */
static void coverage_of_bands(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    static const struct {
        int32_t kind;
        double shape;
        int peaks;
    } set[] = {{MPS_FIT_WEIBULL, 0.9, 30},
               {MPS_FIT_WEIBULL, 0.9, PEAKS},
               {MPS_FIT_PARETO, 0.1, 30},
               {MPS_FIT_PARETO, 0.1, PEAKS},
               {MPS_FIT_PARETO, -0.1, 60}};
    config.resamples = 300;
    for (size_t c = 0; c < sizeof set / sizeof set[0]; c++) {
        const mps_fit known = new_fit(set[c].kind, 1000, 5000, set[c].shape);
        const coverage got = count_coverage(&config, &known, set[c].peaks, set[c].peaks);
        const int least = SAMPLES * 80 / 100, most = SAMPLES * 97 / 100;
        print_message("set %zu: %d, %d and %d of %d bands hold scale, shape and value\n", c,
                      got.scale, got.shape, got.value, SAMPLES);
        assert_in_range(got.scale, least, most);
        assert_in_range(got.shape, least, most);
        assert_in_range(got.value, least, most);
    }
}

static void same_bytes(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    uint64_t seed = 9;
    double peaks[60];
    mps_fit a, b, c;
    for (int k = 0; k < 60; k++) peaks[k] = -log(draw(&seed));
    ASSERT_DONE(make_fit(&config, MPS_FIT_PARETO, 60, peaks, 0, 500, &a));
    ASSERT_DONE(make_fit(&config, MPS_FIT_PARETO, 60, peaks, 0, 500, &b));
    config.seed = 2;
    ASSERT_DONE(make_fit(&config, MPS_FIT_PARETO, 60, peaks, 0, 500, &c));
    assert_memory_equal(&a, &b, sizeof a);
    assert_true(a.value == c.value && a.value_band[1] != c.value_band[1]);
    assert_true(a.value_band[0] < a.value && a.value < a.value_band[1]);
}

/* ---- what is no fit, and what is refused ---- */

static void no_fit(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    double peaks[60];
    mps_fit fit;
    for (int k = 0; k < 60; k++) peaks[k] = 5 + k;
    for (int32_t kind = MPS_FIT_WEIBULL; kind <= MPS_FIT_PARETO; kind++) {
        ASSERT_DONE(make_fit(&config, kind, 0, NULL, 0, 1, &fit));
        assert_int_equal(fit.state, MPS_FIT_FEW);
        ASSERT_DONE(make_fit(&config, kind, 29, peaks, 0, 1, &fit));
        assert_int_equal(fit.state, MPS_FIT_FEW);
        assert_true(isnan(fit.scale) && isnan(fit.value) && isnan(fit.scale_band[0]));
        ASSERT_DONE(make_fit(&config, kind, 30, peaks, 5, 1, &fit)); /* one equals u */
        assert_int_equal(fit.state, MPS_FIT_FEW);
        assert_int_equal(fit.count, 29);
        ASSERT_DONE(make_fit(&config, kind, 31, peaks, 5, 1, &fit));
        assert_int_equal(fit.state, kind == MPS_FIT_WEIBULL ? MPS_FIT_LIKELIHOOD : fit.state);
        assert_true(fit.state >= MPS_FIT_LIKELIHOOD);
    }
    for (int k = 0; k < 60; k++) peaks[k] = 5;
    for (int32_t kind = MPS_FIT_WEIBULL; kind <= MPS_FIT_PARETO; kind++) {
        ASSERT_DONE(make_fit(&config, kind, 60, peaks, 1, 1, &fit));
        assert_int_equal(fit.state, MPS_FIT_SAME);
        assert_true(isnan(fit.shape));
    }
}

/* All peaks near the largest: the likelihood grows without bound as x falls to -infinity. */
static void no_largest_likelihood(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    double peaks[40];
    mps_fit fit;
    config.resamples = 20;
    for (int k = 0; k < 40; k++) peaks[k] = 10 - pow((k + 1) / 41.0, 3);
    ASSERT_DONE(make_fit(&config, MPS_FIT_PARETO, 40, peaks, 0, 100, &fit));
    assert_int_equal(fit.state, MPS_FIT_MOMENTS);
    assert_true(fit.scale == fit.moments_scale && fit.shape == fit.moments_shape);
    assert_true(fit.shape < -1 && isfinite(fit.value));
}

static void refused(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    double peaks[3] = {1, 2, 3};
    mps_fit fit = {.struct_size = 8};
    ASSERT_SAYS(mps_fit_pareto(&config, 3, peaks, 0, 1, &fit), MPS_E_ARG, "mps_fit_init()");
    ASSERT_SAYS(mps_fit_pareto(&config, 3, peaks, 0, 1, NULL), MPS_E_ARG, "mps_fit_init()");
    ASSERT_SAYS(make_fit(&config, 0, -1, peaks, 0, 1, &fit), MPS_E_ARG, "count is -1");
    ASSERT_SAYS(make_fit(&config, 0, 3, NULL, 0, 1, &fit), MPS_E_ARG, "peaks is NULL");
    ASSERT_SAYS(make_fit(&config, 0, 3, peaks, NAN, 1, &fit), MPS_E_ARG, "u is");
    ASSERT_SAYS(make_fit(&config, 0, 3, peaks, 0, -1, &fit), MPS_E_ARG, "number is -1");
    ASSERT_SAYS(make_fit(&config, 0, 3, peaks, 1.5, 1, &fit), MPS_E_ARG, "peaks[0] is 1");
    peaks[2] = INFINITY;
    ASSERT_SAYS(make_fit(&config, 1, 3, peaks, 0, 1, &fit), MPS_E_ARG, "peaks[2] is inf");
    config.confidence = 1;
    ASSERT_SAYS(make_fit(&config, 1, 2, peaks, 0, 1, &fit), MPS_E_ARG, "'confidence' is 1");
    assert_int_equal(mps_fit_pareto(NULL, 3, peaks, 0, 1, &fit), MPS_E_ARG);
}

/* ---- the long term ---- */

static mps_condition new_condition(double share, double rate, const mps_fit *fit)
{
    mps_condition c;
    assert_int_equal(mps_condition_init(&c, sizeof c), MPS_OK);
    c.share = share;
    c.rate = rate;
    c.fit = fit;
    return c;
}

static void long_term(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    const mps_fit mild = new_fit(MPS_FIT_WEIBULL, 1, 2, 0.9),
                  rough = new_fit(MPS_FIT_PARETO, 3, 4, 0.1);
    const mps_condition all[] = {new_condition(0.7, 0.01, &mild), new_condition(0.2, 0.05, &rough),
                                 new_condition(0.1, 0, NULL)};
    const double R = 0.7 * 0.01 + 0.2 * 0.05;
    double share, rate, value;
    ASSERT_DONE(mps_long_term_exceedance(&config, 3, all, 9, &share, &rate));
    ASSERT_NEAR(rate, R, 1e-15);
    ASSERT_NEAR(share, 0.007 / R * exp(-pow(8 / 2.0, 0.9)) + 0.01 / R * pow(1 + 0.1 * 6 / 4, -10),
                1e-14);
    ASSERT_DONE(mps_long_term_value(&config, 3, all, 1e6, &value));
    ASSERT_DONE(mps_long_term_exceedance(&config, 3, all, value, &share, NULL));
    ASSERT_NEAR(share * R * 1e6, 1, 1e-9);
    ASSERT_DONE(mps_long_term_value(&config, 3, all, 1 / R * 0.99, &value));
    assert_true(isnan(value));
    /* one condition alone: its own value */
    ASSERT_DONE(mps_long_term_value(&config, 1, &all[1], 1e5, &value));
    ASSERT_NEAR(value, mps_fit_value(&rough, 1e5 * 0.2 * 0.05), 1e-9);
}

static void long_term_refused(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    const mps_fit fit = new_fit(MPS_FIT_WEIBULL, 1, 2, 0.9);
    double value, share;
    mps_condition two[2] = {new_condition(0.7, 0.01, &fit), new_condition(0.4, 0.01, &fit)};
    ASSERT_SAYS(mps_long_term_value(&config, 2, two, 1, &value), MPS_E_ARG, "sum to 1.1");
    two[1].share = -0.1;
    ASSERT_SAYS(mps_long_term_value(&config, 2, two, 1, &value), MPS_E_ARG, "[1].share is -0.1");
    two[1].share = 0.1;
    two[1].rate = NAN;
    ASSERT_SAYS(mps_long_term_value(&config, 2, two, 1, &value), MPS_E_ARG, "[1].rate is");
    two[1].rate = 1;
    two[1].fit = NULL;
    ASSERT_SAYS(mps_long_term_value(&config, 2, two, 1, &value), MPS_E_ARG, "[1].fit");
    two[1].struct_size = 4;
    ASSERT_SAYS(mps_long_term_value(&config, 2, two, 1, &value), MPS_E_ARG, "[1]: call");
    ASSERT_SAYS(mps_long_term_value(&config, 0, two, 1, &value), MPS_E_ARG, "count is 0");
    ASSERT_SAYS(mps_long_term_value(&config, 1, two, 0, &value), MPS_E_ARG, "time is 0");
    ASSERT_SAYS(mps_long_term_exceedance(&config, 1, two, NAN, &share, NULL), MPS_E_ARG, "P is");
    two[0].rate = 0;
    ASSERT_SAYS(mps_long_term_value(&config, 1, two, 1, &value), MPS_E_ARG, "no condition");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_values),
        cmocka_unit_test(limits_of_values),
        cmocka_unit_test(moments_of_quantiles),
        cmocka_unit_test(largest_likelihood),
        cmocka_unit_test(quantiles_come_back),
        cmocka_unit_test(units),
        cmocka_unit_test(coverage_of_bands),
        cmocka_unit_test(same_bytes),
        cmocka_unit_test(no_fit),
        cmocka_unit_test(no_largest_likelihood),
        cmocka_unit_test(refused),
        cmocka_unit_test(long_term),
        cmocka_unit_test(long_term_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
