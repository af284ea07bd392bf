/* SPDX-License-Identifier: BSD-3-Clause */
/* Events of signals: triangles are recovered, limits of the definition. */
#include "event_fixture.h"

/* If corners are on samples, all values are exact. Otherwise times are exact to one sample: rise
 * and decay are differences of times over 1 - s. */
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
    /* below 10 from 3.5 to 6.5: crossings are at half distance */
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
