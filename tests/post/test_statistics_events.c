/* SPDX-License-Identifier: BSD-3-Clause */
/* Events of signals: triangles come back to a sample, edges of the definition, what is refused. */
#include "stats_fixture.h"

enum { TRIANGLES = 100 };
static const double DT = 0.01, GAP = 5, THRESHOLD = 10;

/* ---- a signal of triangles on a base of 0 ---- */

typedef struct triangle {
    double t, peak, rise, decay;
} triangle;

typedef struct signal {
    int64_t n;
    double *t, *p;
} signal;

static double height(const triangle *all, int count, double t)
{
    for (int k = 0; k < count; k++) {
        const double x = t - all[k].t;
        if (x > -all[k].rise && x <= 0) return all[k].peak * (1 + x / all[k].rise);
        if (x > 0 && x < all[k].decay) return all[k].peak * (1 - x / all[k].decay);
    }
    return 0;
}

static signal new_signal(int64_t n)
{
    signal s = {n, calloc((size_t)n + 1, sizeof *s.t), calloc((size_t)n + 1, sizeof *s.p)};
    assert_true(s.t && s.p);
    return s;
}

static void free_signal(signal *s)
{
    free(s->t);
    free(s->p);
}

static signal sample_triangles(const triangle *all, int count, double dt, double end)
{
    signal s = new_signal((int64_t)(end / dt + 1.5));
    for (int64_t k = 0; k < s.n; k++) {
        s.t[k] = (double)k * dt;
        s.p[k] = height(all, count, s.t[k]);
    }
    return s;
}

/* Corners on samples, or anywhere. */
static void make_triangles(triangle *all, bool on_samples, uint64_t seed)
{
    for (int k = 0; k < TRIANGLES; k++) {
        triangle *a = &all[k];
        a->peak = 20 + 480 * draw(&seed);
        a->rise = 0.2 + 0.6 * draw(&seed);
        a->decay = 0.2 + 1.2 * draw(&seed);
        a->t = GAP * (k + 1) + 0.5 * draw(&seed);
        if (!on_samples) continue;
        a->rise = DT * round(a->rise / DT);
        a->decay = DT * round(a->decay / DT);
        a->t = DT * round(a->t / DT);
    }
}

static mps_stats_config event_config(void)
{
    mps_stats_config config = new_config();
    config.threshold = THRESHOLD;
    config.window = 1;
    config.resamples = 20;
    return config;
}

static mps_impacts *find(const mps_stats_config *config, const signal *s)
{
    mps_impacts *impacts = NULL;
    ASSERT_DONE(mps_impacts_find(config, s->n, s->t, s->p, &impacts));
    return impacts;
}

static mps_impacts_info info_of(const mps_impacts *impacts)
{
    mps_impacts_info info;
    assert_int_equal(mps_impacts_info_init(&info, sizeof info), MPS_OK);
    assert_int_equal(mps_impacts_info_get(impacts, &info), MPS_OK);
    return info;
}

static mps_impact event_of(const mps_impacts *impacts, int64_t index)
{
    mps_impact event;
    assert_int_equal(mps_impact_init(&event, sizeof event), MPS_OK);
    assert_int_equal(mps_impacts_get(impacts, index, &event), MPS_OK);
    return event;
}

/* Where corners are on samples, all exactly. Elsewhere times to a sample: rise and decay are differences of times over 1 - s. */
static void check_triangle(const triangle *a, const mps_impact *e, bool on_samples)
{
    const double slope = a->peak / fmin(a->rise, a->decay), sample = on_samples ? 1e-9 : DT;
    const double share = 1 - THRESHOLD / a->peak, length = share * (a->rise + a->decay);
    ASSERT_NEAR(e->t, a->t, sample);
    ASSERT_NEAR(e->peak, a->peak, slope * sample);
    ASSERT_NEAR(e->rise, a->rise, sample / 0.5);
    ASSERT_NEAR(e->decay, a->decay, sample / 0.5);
    ASSERT_NEAR(e->begin, a->t - share * a->rise, sample);
    ASSERT_NEAR(e->end, a->t + share * a->decay, sample);
    ASSERT_NEAR(e->duration, length, sample);
    ASSERT_NEAR(e->impulse, 0.5 * (a->peak + THRESHOLD) * length, sample * a->peak);
    ASSERT_NEAR(e->skewness, e->decay / e->rise, 0);
}

static void triangles(void **state)
{
    (void)state;
    const mps_stats_config config = event_config();
    for (int c = 0; c < 2; c++) {
        triangle all[TRIANGLES];
        make_triangles(all, c == 0, 3);
        signal s = sample_triangles(all, TRIANGLES, DT, GAP * (TRIANGLES + 1));
        mps_impacts *impacts = find(&config, &s);
        const mps_impacts_info info = info_of(impacts);
        assert_int_equal(info.events, TRIANGLES);
        assert_int_equal(info.cut, 0);
        ASSERT_NEAR(info.rate, TRIANGLES / (GAP * (TRIANGLES + 1)), 1e-9);
        for (int k = 0; k < TRIANGLES; k++) {
            const mps_impact e = event_of(impacts, k);
            check_triangle(&all[k], &e, c == 0);
        }
        mps_impacts_destroy(impacts);
        free_signal(&s);
    }
}

/* The same straight lines with other samples between the corners: the same events. */
static void finer_samples(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    triangle all[TRIANGLES];
    make_triangles(all, true, 4);
    signal s = sample_triangles(all, TRIANGLES, DT, GAP * (TRIANGLES + 1));
    mps_impacts *given = find(&config, &s);
    config.rate = 4 / DT;
    mps_impacts *finer = find(&config, &s);
    assert_int_equal(info_of(finer).samples, 4 * (s.n - 1) + 1);
    assert_int_equal(info_of(finer).events, TRIANGLES);
    for (int k = 0; k < TRIANGLES; k++) {
        const mps_impact a = event_of(given, k), b = event_of(finer, k);
        ASSERT_NEAR(b.begin, a.begin, 1e-9);
        ASSERT_NEAR(b.impulse, a.impulse, 1e-7 * a.impulse);
        ASSERT_NEAR(b.peak, a.peak, 1e-7);
        ASSERT_NEAR(b.rise, a.rise, 1e-9);
    }
    mps_impacts_destroy(given);
    mps_impacts_destroy(finer);
    free_signal(&s);
}

static void ranks(void **state)
{
    (void)state;
    const mps_stats_config config = event_config();
    triangle all[TRIANGLES];
    make_triangles(all, true, 5);
    for (int k = 50; k < 53; k++) all[k].peak = 600, all[k].rise = all[k].decay = 0.5;
    signal s = sample_triangles(all, TRIANGLES, DT, GAP * (TRIANGLES + 1));
    mps_impacts *impacts = find(&config, &s);
    mps_exceedance before = {.struct_size = sizeof before}, point = before;
    mps_impact e = {.struct_size = sizeof e};
    for (int k = 0; k < TRIANGLES; k++) {
        assert_int_equal(mps_impacts_exceedance(impacts, k, &point), MPS_OK);
        assert_int_equal(mps_impacts_highest(impacts, k, &e), MPS_OK);
        ASSERT_NEAR(point.peak, e.peak, 0);
        ASSERT_NEAR(point.share, (k + 1) / (TRIANGLES + 1.0), 1e-15);
        assert_true(point.band[0] < point.share && point.share < point.band[1]);
        if (k < 3) ASSERT_NEAR(e.t, all[50 + k].t, DT);
        if (k > 0) assert_true(point.peak <= before.peak && point.band[0] > before.band[0]);
        before = point;
    }
    /* of the largest of N, 1 - (1 - q)^(1/N) */
    assert_int_equal(mps_impacts_exceedance(impacts, 0, &point), MPS_OK);
    ASSERT_NEAR(point.band[0], 1 - pow(0.95, 1.0 / TRIANGLES), 1e-14);
    ASSERT_NEAR(point.band[1], 1 - pow(0.05, 1.0 / TRIANGLES), 1e-14);
    assert_int_equal(mps_impacts_exceedance(impacts, TRIANGLES, &point), MPS_E_ARG);
    assert_int_equal(mps_impacts_highest(impacts, -1, &e), MPS_E_ARG);
    assert_int_equal(mps_impacts_get(impacts, TRIANGLES, &e), MPS_E_ARG);
    mps_impacts_destroy(impacts);
    free_signal(&s);
}

/* ---- edges of the definition ---- */

/* Events and cut events of a few samples, one a second. */
static void check_counts(const mps_stats_config *config, int n, const double *p, int events,
                         int cut)
{
    double t[64];
    mps_impacts *impacts = NULL;
    for (int k = 0; k < n; k++) t[k] = k;
    ASSERT_DONE(mps_impacts_find(config, n, t, p, &impacts));
    assert_int_equal(info_of(impacts).events, events);
    assert_int_equal(info_of(impacts).cut, cut);
    mps_impacts_destroy(impacts);
}

static void windows(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    /* below 10 from 3.5 to 6.5: crossings lie half way */
    const double two[] = {0, 0, 0, 20, 0, 0, 0, 20, 0, 0};
    config.window = 2.5;
    check_counts(&config, 10, two, 2, 0);
    config.window = 3;
    check_counts(&config, 10, two, 1, 1); /* 2.5 s before the first; then 3 s */
    config.window = 3.01;
    check_counts(&config, 10, two, 0, 1);
    config.window = 0;
    check_counts(&config, 10, two, 2, 0);
    const double dips[] = {0, 0, 0, 0, 20, 9, 30, 9, 20, 0, 0, 0, 0};
    config.window = 1;
    check_counts(&config, 13, dips, 1, 0);
    const double at_end[] = {0, 0, 0, 20, 0, 0, 0, 20};
    check_counts(&config, 8, at_end, 1, 1);
    const double at_start[] = {20, 0, 0, 0, 20, 0};
    check_counts(&config, 6, at_start, 1, 1);
}

/* Two events in one window have the higher peak, and the impulse of what is above u. */
static void one_peak_an_event(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    const double t[] = {0, 1, 2, 3, 4, 5, 6, 7}, p[] = {0, 0, 20, 0, 40, 0, 0, 0};
    signal s = {8, (double *)t, (double *)p};
    config.window = 1.5;
    mps_impacts *impacts = find(&config, &s);
    const mps_impact e = event_of(impacts, 0);
    assert_int_equal(info_of(impacts).events, 1);
    ASSERT_NEAR(e.t, 4, 1e-12);
    ASSERT_NEAR(e.peak, 40, 1e-12);
    ASSERT_NEAR(e.begin, 1.5, 1e-12);
    ASSERT_NEAR(e.end, 4.75, 1e-12);
    ASSERT_NEAR(e.impulse, 2 * 0.5 * 15 + 2 * 0.75 * 25, 1e-12);
    mps_impacts_destroy(impacts);
}

static void edge_signals(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    const double none[] = {0}, high[] = {20, 21, 22, 21}, nans[] = {NAN, NAN},
                 same[] = {5, 5, 5, 5}, equal[] = {0, 0, 0, 10, 0};
    check_counts(&config, 0, NULL, 0, 0);
    check_counts(&config, 1, none, 0, 0);
    check_counts(&config, 1, high, 0, 1);
    check_counts(&config, 4, high, 0, 1);
    check_counts(&config, 2, nans, 0, 0);
    check_counts(&config, 4, same, 0, 0);
    check_counts(&config, 5, equal, 1, 0); /* at the threshold counts */
    config.rate = 3;
    config.high_pass = 0.1;
    config.threshold = NAN;
    check_counts(&config, 0, NULL, 0, 0);
    check_counts(&config, 1, none, 0, 1); /* u is its mean, and it is not below */
    check_counts(&config, 2, nans, 0, 0);
}

static void missing_values(void **state)
{
    (void)state;
    const mps_stats_config config = event_config();
    const double t[] = {0, 1, 2, 3, 4, 5, 6, 7};
    const double p[] = {NAN, 0, 0, NAN, 20, NAN, 0, 0};
    signal s = {8, (double *)t, (double *)p};
    mps_impacts *impacts = find(&config, &s);
    const mps_impacts_info info = info_of(impacts);
    const mps_impact e = event_of(impacts, 0);
    assert_int_equal(info.samples, 5);
    assert_int_equal(info.missing, 3);
    ASSERT_NEAR(info.t_first, 1, 0);
    ASSERT_NEAR(e.begin, 3, 1e-12); /* half way from 2 to 4 */
    mps_impacts_destroy(impacts);
}

/* A parabola through unequal samples may rise far above them. */
static void parabola_is_bounded(void **state)
{
    (void)state;
    const mps_stats_config config = event_config();
    const double t[] = {0, 2, 2.001, 3, 4, 5}, p[] = {0, 0, 100, 99.9, 0, 0};
    signal s = {6, (double *)t, (double *)p};
    mps_impacts *impacts = find(&config, &s);
    const mps_impact e = event_of(impacts, 0);
    ASSERT_NEAR(e.peak, 112.5, 1e-9); /* the parabola alone: 25,000 */
    mps_impacts_destroy(impacts);
    const double even[] = {0, 1, 2, 3, 4, 5}, smooth[] = {0, 0, 12, 16, 12, 0};
    s = (signal){6, (double *)even, (double *)smooth};
    impacts = find(&config, &s);
    ASSERT_NEAR(event_of(impacts, 0).peak, 16, 1e-12);
    ASSERT_NEAR(event_of(impacts, 0).t, 3, 1e-12);
    mps_impacts_destroy(impacts);
}

/* Exact for straight lines: a step decays as e^(-w t); a constant is nothing. */
static void high_pass(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    const double w = 2 * 3.14159265358979323846 * 0.05;
    signal s = new_signal(2001);
    for (int64_t k = 0; k < s.n; k++) {
        s.t[k] = 0.01 * (double)k;
        s.p[k] = s.t[k] < 4.995 ? 1000 : 1100;
    }
    config.high_pass = 0.05;
    mps_impacts *impacts = find(&config, &s);
    const mps_impact e = event_of(impacts, 0);
    assert_int_equal(info_of(impacts).events, 1);
    /* rises within a sample, so it loses w dt/2 */
    ASSERT_NEAR(e.peak, 100 * (1 - 0.5 * w * 0.01), 0.01);
    ASSERT_NEAR(e.end, 5 + log(10) / w, 0.01);
    mps_impacts_destroy(impacts);
    free_signal(&s);
}

static void limits_of_time(void **state)
{
    (void)state;
    mps_stats_config config = event_config();
    triangle all[TRIANGLES];
    make_triangles(all, true, 6);
    signal s = sample_triangles(all, TRIANGLES, DT, GAP * (TRIANGLES + 1));
    config.from = all[9].t + 2;
    config.until = all[29].t + 2;
    mps_impacts *impacts = find(&config, &s);
    assert_int_equal(info_of(impacts).events, 20);
    ASSERT_NEAR(event_of(impacts, 0).t, all[10].t, DT);
    mps_impacts_destroy(impacts);
    free_signal(&s);
}

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
    assert_int_equal(mps_stats_config_init(NULL, sizeof config), MPS_E_ARG);
    assert_int_equal(mps_stats_config_init(&config, sizeof config - 1), MPS_E_ARG);
    config = event_config();
    config.struct_size = 3;
    assert_int_equal(mps_impacts_find(&config, 0, NULL, NULL, &impacts), MPS_E_ARG);
    assert_int_equal(mps_impacts_find(NULL, 0, NULL, NULL, &impacts), MPS_E_ARG);
}

/* A program of a newer version has a longer config: good, as long as it uses none of the new entries. */
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
        cmocka_unit_test(triangles),
        cmocka_unit_test(finer_samples),
        cmocka_unit_test(ranks),
        cmocka_unit_test(windows),
        cmocka_unit_test(one_peak_an_event),
        cmocka_unit_test(edge_signals),
        cmocka_unit_test(missing_values),
        cmocka_unit_test(parabola_is_bounded),
        cmocka_unit_test(high_pass),
        cmocka_unit_test(limits_of_time),
        cmocka_unit_test(scales),
        cmocka_unit_test(dependence),
        cmocka_unit_test(thresholds),
        cmocka_unit_test(panels),
        cmocka_unit_test(refused),
        cmocka_unit_test(constants_refused),
        cmocka_unit_test(newer_structs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
