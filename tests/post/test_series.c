/* SPDX-License-Identifier: BSD-3-Clause */
/* Harmonics, comparison of series, order of convergence, repeats. */
#include "stats_fixture.h"

static const double PI = 3.14159265358979323846;

enum { N = 1000 };

/* ---- harmonics ---- */

static mps_harmonics new_harmonics(int32_t count, double omega)
{
    mps_harmonics h;
    assert_int_equal(mps_harmonics_init(&h, sizeof h), MPS_OK);
    assert_int_equal(h.count, 1);
    h.count = count;
    h.omega = omega;
    return h;
}

/* A sum of harmonics at irregular times is recovered, and also the residual. */
static void harmonics_come_back(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    const double omega = 6.469, amplitude[] = {20, 3, 0, 0.5}, phase[] = {1, -2, 0, 3};
    double t[N], p[N];
    uint64_t seed = 1;
    mps_harmonics h = new_harmonics(4, omega);
    for (int k = 0; k < N; k++) {
        t[k] = 100 + 0.01 * (k + draw(&seed));
        p[k] = -7;
        for (int i = 0; i < 4; i++) p[k] += amplitude[i] * sin((i + 1) * omega * t[k] + phase[i]);
    }
    p[17] = NAN;
    ASSERT_DONE(mps_harmonics_find(&config, N, t, p, &h));
    ASSERT_NEAR(h.mean, -7, 1e-10);
    for (int i = 0; i < 4; i++) ASSERT_NEAR(h.amplitude[i], amplitude[i], 1e-10);
    for (int i = 0; i < 4; i++)
        if (amplitude[i] > 0) ASSERT_NEAR(h.phase[i], phase[i], 1e-9);
    ASSERT_NEAR(h.rest, 0, 1e-9);
    for (int k = 0; k < N; k++) p[k] += 0.2 * sin(5 * PI * t[k]); /* not one of them */
    ASSERT_DONE(mps_harmonics_find(&config, N, t, p, &h));
    ASSERT_NEAR(h.rest, 0.2 / sqrt(2), 0.01);
    /* only the second half has another mean */
    for (int k = 0; k < N; k++) p[k] = sin(omega * t[k]) + (t[k] > 105 ? 4 : 0);
    h = new_harmonics(MPS_HARMONICS, omega);
    config.from = 105.02;
    ASSERT_DONE(mps_harmonics_find(&config, N, t, p, &h));
    ASSERT_NEAR(h.mean, 4, 1e-9);
    ASSERT_NEAR(h.amplitude[0], 1, 1e-9);
}

static void harmonics_refused(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    double t[N], p[N];
    for (int k = 0; k < N; k++) t[k] = 0.01 * k, p[k] = sin(t[k]);
    mps_harmonics h = new_harmonics(0, 1);
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, &h), MPS_E_ARG, "count is 0");
    h = new_harmonics(17, 1);
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, &h), MPS_E_ARG, "count is 17");
    h = new_harmonics(1, 0);
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, &h), MPS_E_ARG, "omega is 0");
    h = new_harmonics(1, 0.6);
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, &h), MPS_E_ARG, "must be one period, 10.47");
    h = new_harmonics(3, 1000);
    ASSERT_SAYS(mps_harmonics_find(&config, 6, t, p, &h), MPS_E_ARG, "6 samples are used");
    h = new_harmonics(1, 200 * PI); /* one sample a period */
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, &h), MPS_E_ARG, "too far apart");
    ASSERT_NEAR(h.amplitude[0], 0, 0);
    t[5] = t[4];
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, &h), MPS_E_ARG, "t[5] is");
    ASSERT_SAYS(mps_harmonics_find(&config, N, t, p, NULL), MPS_E_ARG, "mps_harmonics_init()");
}

/* ---- comparison ---- */

static mps_series series_of(int64_t n, const double *t, const double *p)
{
    return (mps_series){.struct_size = sizeof(mps_series), .n = n, .t = t, .p = p};
}

static mps_comparison compare(const mps_stats_config *config, const mps_series *a,
                              const mps_series *b)
{
    mps_comparison c;
    assert_int_equal(mps_comparison_init(&c, sizeof c), MPS_OK);
    ASSERT_DONE(mps_series_compare(config, a, b, &c));
    return c;
}

/* Straight lines at different times: all integrals by hand. */
static void straight_lines(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    const double ta[] = {0, 1, 4}, a[] = {0, 2, 2}, tb[] = {-1, 2, 3, 9}, b[] = {0, 3, NAN, 3};
    const mps_series first = series_of(3, ta, a), second = series_of(4, tb, b);
    const mps_comparison c = compare(&config, &first, &second);
    /* b - a: 1 at 0, 0 at 1, 1 at 2, 1 to 4 */
    ASSERT_NEAR(c.t_first, 0, 0);
    ASSERT_NEAR(c.t_last, 4, 0);
    ASSERT_NEAR(c.mean, 3.0 / 4, 1e-14);
    ASSERT_NEAR(c.rms, sqrt((1.0 / 3 + 1.0 / 3 + 2) / 4), 1e-14);
    ASSERT_NEAR(c.rms_first, sqrt((4.0 / 3 + 12) / 4 - 1.75 * 1.75), 1e-14);
    ASSERT_NEAR(c.largest, 1, 1e-14);
    ASSERT_NEAR(c.t_largest, 0, 0);
    ASSERT_NEAR(c.peak[0], 2, 0);
    ASSERT_NEAR(c.t_peak[0], 1, 0);
    ASSERT_NEAR(c.peak[1], 3, 0);
    ASSERT_NEAR(c.t_peak[1], 2, 0);
    ASSERT_NEAR(c.trough[1], 1, 1e-14);
    ASSERT_NEAR(c.t_trough[1], 0, 0);
}

/* Waves with a time shift: the shift is recovered in both directions, within a fraction of the
 * grid. */
static void shifts(void **state)
{
    (void)state;
    const double shift[] = {0, 0.123, -0.31, 0.48};
    for (int c = 0; c < 8; c++) {
        mps_stats_config config = new_config();
        double t[N], a[N], b[N];
        const double later = shift[c % 4], period = 1;
        if (c < 4) config.period = period;
        for (int k = 0; k < N; k++) {
            t[k] = 0.01 * k;
            const double x = t[k] - later, grow = c < 4 ? 1 : 1 + t[k] / 10,
                         grow_later = c < 4 ? 1 : 1 + x / 10;
            a[k] = 3 + grow * (sin(2 * PI * t[k]) + 0.3 * sin(4 * PI * t[k]));
            b[k] = 9 + 5 * grow_later * (sin(2 * PI * x) + 0.3 * sin(4 * PI * x));
        }
        const mps_series first = series_of(N, t, a), second = series_of(N, t, b);
        const mps_comparison d = compare(&config, &first, &second);
        ASSERT_NEAR(d.shift, later, 1e-3);
        assert_true(d.correlation > 0.999);
        if (c < 4)
            ASSERT_NEAR(d.phase, 2 * PI * later, 7e-3);
        else
            assert_true(isnan(d.phase));
    }
}

static void no_shift(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    double t[N], a[N], b[N];
    for (int k = 0; k < N; k++) t[k] = 0.01 * k, a[k] = 1e5, b[k] = sin(t[k]);
    const mps_series first = series_of(N, t, a), second = series_of(N, t, b);
    mps_comparison c = compare(&config, &first, &second);
    assert_true(isnan(c.shift) && isnan(c.correlation));
    ASSERT_NEAR(c.rms_first, 0, 1e-3);
    c = compare(&config, &second, &second);
    ASSERT_NEAR(c.shift, 0, 0);
    ASSERT_NEAR(c.rms, 0, 0);
    ASSERT_NEAR(c.correlation, 1, 1e-12);
    /* the largest correlation is further away than what is tried */
    for (int k = 0; k < N; k++) a[k] = exp(-pow(t[k] - 4, 2)), b[k] = exp(-pow(t[k] - 5, 2));
    config.shift_most = 0.5;
    c = compare(&config, &first, &second);
    assert_true(isnan(c.shift));
    config.shift_most = 1.5;
    c = compare(&config, &first, &second);
    ASSERT_NEAR(c.shift, 1, 1e-3);
}

/* Crests of a wave that in the series are .1 s later and .01 higher: only values at the points are
 * used. */
static void points_of_a_wave(void **state)
{
    enum { POINTS = 9 };
    double t[N], p[N], tp[POINTS + 1], pp[POINTS + 1];
    mps_comparison c;
    (void)state;
    mps_stats_config config = new_config();
    for (int k = 0; k < N; k++) {
        t[k] = 0.01 * k;
        p[k] = sin(2 * PI * (t[k] - 0.1)) + 0.3 * sin(PI * (t[k] - 0.1)) + 0.01;
    }
    for (int k = 0; k < POINTS; k++) {
        tp[k] = 0.3 + 0.97 * k;
        pp[k] = sin(2 * PI * tp[k]) + 0.3 * sin(PI * tp[k]);
    }
    tp[POINTS] = 20; /* after the series: ignored */
    pp[POINTS] = 5;
    const mps_series points = series_of(POINTS + 1, tp, pp), series = series_of(N, t, p);
    config.period = 1;
    assert_int_equal(mps_comparison_init(&c, sizeof c), MPS_OK);
    ASSERT_DONE(mps_points_compare(&config, &points, &series, &c));
    assert_int_equal(c.points, POINTS);
    ASSERT_NEAR(c.t_last, tp[POINTS - 1], 0);
    ASSERT_NEAR(c.shift, 0.1, 2e-3);
    ASSERT_NEAR(c.correlation, 1, 1e-3);
    ASSERT_NEAR(c.phase, 0.2 * PI, 2e-2);
    double squares = 0;
    for (int k = 0; k < POINTS; k++) {
        const double at = tp[k] - 0.1, d = sin(2 * PI * at) + 0.3 * sin(PI * at) + 0.01 - pp[k];
        squares += d * d / POINTS;
    }
    ASSERT_NEAR(c.rms, sqrt(squares), 1e-3);
    const mps_series one = series_of(1, tp, pp), late = series_of(1, tp + POINTS, pp);
    ASSERT_DONE(mps_points_compare(&config, &one, &series, &c));
    assert_true(c.points == 1 && isnan(c.shift) && isnan(c.correlation));
    ASSERT_SAYS(mps_points_compare(&config, &late, &series, &c), MPS_E_ARG, "no common time");
}

static void comparison_refused(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    double t[] = {0, 1, 2}, late[] = {2, 3, 4}, p[] = {0, 1, 2}, nans[] = {NAN, 1, NAN};
    mps_series a = series_of(3, t, p), b = series_of(3, late, p);
    mps_comparison c = {.struct_size = 4};
    ASSERT_SAYS(mps_series_compare(&config, &a, &b, &c), MPS_E_ARG, "mps_comparison_init()");
    c.struct_size = sizeof c;
    ASSERT_SAYS(mps_series_compare(&config, &a, &b, &c), MPS_E_ARG, "no common time");
    b = series_of(3, t, nans);
    ASSERT_SAYS(mps_series_compare(&config, &a, &b, &c), MPS_E_ARG, "second. has 1 known");
    a.struct_size = 0;
    ASSERT_SAYS(mps_series_compare(&config, &a, &b, &c), MPS_E_ARG, "first.: NULL");
    ASSERT_SAYS(mps_series_compare(&config, NULL, &b, &c), MPS_E_ARG, "first.");
    a = series_of(3, t, p);
    t[2] = 1;
    ASSERT_SAYS(mps_series_compare(&config, &a, &b, &c), MPS_E_ARG, "first.t[2]");
}

/* ---- three spacings ---- */

static mps_convergence converge(const mps_stats_config *config, const double *h, const double *f)
{
    mps_convergence c;
    assert_int_equal(mps_convergence_init(&c, sizeof c), MPS_OK);
    ASSERT_DONE(mps_converge(config, h, f, &c));
    return c;
}

static void orders(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    const double h[] = {2, 3, 5}, order[] = {0.6, 1, 1.5, 2, 0.3, 3.7};
    for (int k = 0; k < 6; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            double f[3];
            for (int i = 0; i < 3; i++) f[i] = 100 + sign * 0.4 * pow(h[i], order[k]);
            const mps_convergence c = converge(&config, h, f);
            ASSERT_NEAR(c.order, order[k], 1e-9);
            if (order[k] < 0.5) {
                assert_int_equal(c.kind, MPS_CONVERGE_SLOW);
                assert_true(isnan(c.limit));
                ASSERT_NEAR(c.band, 3 * fabs(f[2] - f[0]), 1e-12);
                continue;
            }
            assert_int_equal(c.kind, MPS_CONVERGE_MONOTONE);
            ASSERT_NEAR(c.band, 1.25 * fabs(c.limit - f[0]), 1e-12);
            if (order[k] <= 2) ASSERT_NEAR(c.limit, 100, 1e-9);
            /* an order of 3.7 is taken as 2, which is further from the limit */
            if (order[k] > 2) assert_true(c.band > 1.25 * fabs(100 - f[0]));
        }
}

static void other_kinds(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    const double h[] = {1, 2, 4}, up_down[] = {1, 3, 2}, same[] = {7, 7, 7}, away[] = {4, 2, 1.5},
                 flat[] = {4, 2, 2}, fine[] = {2, 2, 5};
    mps_convergence c = converge(&config, h, up_down);
    assert_int_equal(c.kind, MPS_CONVERGE_OSCILLATING);
    ASSERT_NEAR(c.band, 6, 0);
    assert_true(isnan(c.order) && isnan(c.limit));
    c = converge(&config, h, same);
    assert_int_equal(c.kind, MPS_CONVERGE_SAME);
    ASSERT_NEAR(c.band, 0, 0);
    ASSERT_NEAR(c.limit, 7, 0);
    c = converge(&config, h, away);
    assert_int_equal(c.kind, MPS_CONVERGE_SLOW);
    assert_true(isnan(c.order));
    ASSERT_NEAR(c.band, 7.5, 0);
    c = converge(&config, h, flat);
    assert_int_equal(c.kind, MPS_CONVERGE_SLOW);
    c = converge(&config, h, fine);
    assert_int_equal(c.kind, MPS_CONVERGE_MONOTONE);
    assert_true(isinf(c.order));
    ASSERT_NEAR(c.limit, 2 - 3.0 / 15, 1e-12); /* by the third, of order 2 */
}

static void spacings_refused(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    double h[] = {1, 2, 2}, f[] = {1, 2, 3};
    mps_convergence c = {.struct_size = sizeof c};
    ASSERT_SAYS(mps_converge(&config, h, f, &c), MPS_E_ARG, "spacing[2] is 2: must be larger");
    h[2] = INFINITY;
    ASSERT_SAYS(mps_converge(&config, h, f, &c), MPS_E_ARG, "spacing[2] is inf");
    h[2] = 3;
    f[1] = NAN;
    ASSERT_SAYS(mps_converge(&config, h, f, &c), MPS_E_ARG, "value[1]");
    ASSERT_SAYS(mps_converge(&config, NULL, f, &c), MPS_E_ARG, "spacing is NULL");
    ASSERT_SAYS(mps_converge(&config, h, NULL, &c), MPS_E_ARG, "value is NULL");
    c.struct_size = 1;
    ASSERT_SAYS(mps_converge(&config, h, f, &c), MPS_E_ARG, "mps_convergence_init()");
}

/* ---- repeats ---- */

/* Student's t of 95 % one-sided, as tables print it. */
static void students_t(void **state)
{
    (void)state;
    static const struct {
        int count;
        double t;
    } table[] = {{2, 6.313752}, {3, 2.919986}, {5, 2.131847}, {11, 1.812461}, {31, 1.697261}};
    const mps_stats_config config = new_config();
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        const int n = table[k].count;
        double value[31], mean = 0, square = 0;
        mps_repeat r = {.struct_size = sizeof r};
        for (int i = 0; i < n; i++) mean += (value[i] = (i * 7) % 11) / n;
        for (int i = 0; i < n; i++) square += pow(value[i] - mean, 2);
        const double s = sqrt(square / (n - 1));
        ASSERT_DONE(mps_repeat_find(&config, n, value, &r));
        ASSERT_NEAR(r.mean, mean, 1e-12);
        ASSERT_NEAR(r.deviation, s, 1e-12);
        ASSERT_NEAR(r.mean_band, table[k].t * s / sqrt(n), 1e-6 * s);
        ASSERT_NEAR(r.next_band, table[k].t * s * sqrt(1 + 1.0 / n), 2e-6 * s);
        ASSERT_NEAR(r.least, 0, 0);
    }
}

static void few_repeats(void **state)
{
    (void)state;
    const mps_stats_config config = new_config();
    double value[] = {NAN, 4, NAN};
    mps_repeat r = {.struct_size = sizeof r};
    ASSERT_DONE(mps_repeat_find(&config, 3, value, &r));
    assert_true(r.count == 1 && r.mean == 4 && r.least == 4 && r.most == 4);
    assert_true(isnan(r.deviation) && isnan(r.mean_band) && isnan(r.next_band) && isnan(r.t));
    ASSERT_SAYS(mps_repeat_find(&config, 1, value, &r), MPS_E_ARG, "no run has a value");
    ASSERT_SAYS(mps_repeat_find(&config, 0, value, &r), MPS_E_ARG, "count is 0");
    value[2] = INFINITY;
    ASSERT_SAYS(mps_repeat_find(&config, 3, value, &r), MPS_E_ARG, "value[2] is inf");
    r.struct_size = 2;
    ASSERT_SAYS(mps_repeat_find(&config, 3, value, &r), MPS_E_ARG, "mps_repeat_init()");
}

static void peaks_of_runs(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    const double p[3][8] = {
        {0, 0, 20, 0, 0, 30, 0, 0}, {0, 0, 24, 0, 0, 33, 0, 0}, {0, 0, 0, 0, 0, 36, 0, 0}};
    double t[8];
    mps_impacts *run[3];
    mps_repeat r = {.struct_size = sizeof r};
    config.threshold = 10;
    config.window = 1;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 8; i++)
            t[i] = i + 0.75 * k; /* the second is within the window, the third is not */
        ASSERT_DONE(mps_impacts_find(&config, 8, t, p[k], &run[k]));
    }
    const mps_impacts *const all[] = {run[0], run[1], run[2]}, *const hole[] = {run[0], NULL};
    ASSERT_DONE(mps_repeat_peaks(&config, 3, all, 0, &r));
    assert_true(r.count == 2 && r.mean == 22 && r.t == 2.375);
    ASSERT_DONE(mps_repeat_peaks(&config, 2, all, 1, &r));
    assert_true(r.count == 2 && r.mean == 31.5 && r.least == 30 && r.most == 33 && r.t == 5.375);
    ASSERT_SAYS(mps_repeat_peaks(&config, 3, all, 2, &r), MPS_E_ARG, "index is 2: must be 0 .. 1");
    ASSERT_SAYS(mps_repeat_peaks(&config, 0, all, 0, &r), MPS_E_ARG, "runs is 0");
    ASSERT_SAYS(mps_repeat_peaks(&config, 2, hole, 0, &r), MPS_E_ARG, "impacts[1] is NULL");
    for (int k = 0; k < 3; k++) mps_impacts_destroy(run[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(harmonics_come_back),
        cmocka_unit_test(harmonics_refused),
        cmocka_unit_test(straight_lines),
        cmocka_unit_test(shifts),
        cmocka_unit_test(no_shift),
        cmocka_unit_test(points_of_a_wave),
        cmocka_unit_test(comparison_refused),
        cmocka_unit_test(orders),
        cmocka_unit_test(other_kinds),
        cmocka_unit_test(spacings_refused),
        cmocka_unit_test(students_t),
        cmocka_unit_test(few_repeats),
        cmocka_unit_test(peaks_of_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
