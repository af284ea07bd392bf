/* SPDX-License-Identifier: BSD-3-Clause */
/* Compares two series over their common time. They are linear between samples, so integrals over
 * the samples of both are exact. */
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GRID = 4096 }; /* equidistant samples, to search for a shift */

/* The finite samples of a series, and the position of the last search. */
typedef struct lines {
    int64_t n, at;
    double *t, *p;
} lines;

mps_status mps_comparison_init(mps_comparison *c, size_t size)
{
    return mps__stats_init(c, size, NULL, sizeof *c);
}

/* Value at a time within the samples; times of successive calls increase. */
static double value_at(lines *s, double t)
{
    while (s->at + 2 < s->n && s->t[s->at + 1] <= t) s->at++;
    const double f = (t - s->t[s->at]) / (s->t[s->at + 1] - s->t[s->at]);
    return s->p[s->at] + fmin(fmax(f, 0), 1) * (s->p[s->at + 1] - s->p[s->at]);
}

/* @param least  finite samples required */
static mps_status take(const mps_stats_config *config, const char *name, const mps_series *from,
                       int least, lines *s)
{
    MPS__STATS_CHECK(config, mps__stats_known(from, sizeof *from),
                     "%s: NULL, or struct_size is not set", name);
    MPS__STATS_TRY(mps__stats_series(config, name, from->n, from->t, from->p));
    if ((uint64_t)from->n > SIZE_MAX / 64) return mps__stats_no_memory(config);
    s->t = malloc((2 * (size_t)from->n + 1) * sizeof *s->t);
    if (!s->t) return mps__stats_no_memory(config);
    s->p = s->t + from->n;
    for (int64_t k = 0; k < from->n; k++) {
        if (isnan(from->p[k])) continue;
        s->t[s->n] = from->t[k];
        s->p[s->n++] = from->p[k];
    }
    MPS__STATS_CHECK(config, s->n >= least, "%s has %lld known values: %d are needed", name,
                     (long long)s->n, least);
    return MPS_OK;
}

/* ---- differences ---- */

static void note_value(double t, double p, int which, mps_comparison *c)
{
    if (!(p <= c->peak[which])) {
        c->peak[which] = p;
        c->t_peak[which] = t;
    }
    if (!(p >= c->trough[which])) {
        c->trough[which] = p;
        c->t_trough[which] = t;
    }
}

/* Integral of the square of a linear function from a to b over the unit length. */
static double square(double a, double b)
{
    return (a * a + a * b + b * b) / 3;
}

/* The next sample time of either series after t, at most the end. */
static double next_time(const lines *a, const lines *b, double t, double end)
{
    double next = end;
    for (int64_t k = a->at; k < a->n && k <= a->at + 1; k++)
        if (a->t[k] > t) next = fmin(next, a->t[k]);
    for (int64_t k = b->at; k < b->n && k <= b->at + 1; k++)
        if (b->t[k] > t) next = fmin(next, b->t[k]);
    return next;
}

static void find_differences(lines *a, lines *b, mps_comparison *c)
{
    const double length = c->t_last - c->t_first;
    double t = c->t_first, before[2] = {value_at(a, t), value_at(b, t)}, sum[2] = {0};
    c->peak[0] = c->peak[1] = c->trough[0] = c->trough[1] = c->largest = NAN;
    double squares = 0, squares_first = 0;
    for (bool more = true; more;) {
        const double to = next_time(a, b, t, c->t_last);
        const double now[2] = {value_at(a, to), value_at(b, to)}, dt = (to - t) / length;
        const double d0 = before[1] - before[0], d1 = now[1] - now[0];
        squares += dt * square(d0, d1);
        squares_first += dt * square(before[0], now[0]);
        for (int k = 0; k < 2; k++) {
            note_value(t, before[k], k, c);
            note_value(to, now[k], k, c);
            sum[k] += 0.5 * dt * (before[k] + now[k]);
            before[k] = now[k];
        }
        if (!(fabs(d0) <= fabs(c->largest))) c->largest = d0, c->t_largest = t;
        if (!(fabs(d1) <= fabs(c->largest))) c->largest = d1, c->t_largest = to;
        more = to < c->t_last;
        t = to;
    }
    c->mean = sum[1] - sum[0];
    c->rms = sqrt(squares);
    c->rms_first = sqrt(fmax(0, squares_first - sum[0] * sum[0]));
}

/* ---- shift ---- */

/* Pearson's correlation of a[k] with b[k + lag], where both exist. */
static double correlate(const double *a, const double *b, int lag)
{
    const int from = lag < 0 ? -lag : 0, to = lag > 0 ? GRID - lag : GRID;
    const double n = to - from;
    double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
    for (int k = from; k < to; k++) {
        const double x = a[k], y = b[k + lag];
        sa += x;
        sb += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    const double va = aa - sa * sa / n, vb = bb - sb * sb / n;
    if (!(va > 1e-12 * aa) || !(vb > 1e-12 * bb)) return NAN;
    return (ab - sa * sb / n) / sqrt(va * vb);
}

/* Lag of the largest correlation, interpolated on the grid; of equal ones the smaller lag. NAN:
 * none within `most`. */
static double best_lag(const double *a, const double *b, int most, double *correlation)
{
    int best = 0;
    double r = correlate(a, b, 0);
    for (int k = 1; k <= most; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double other = correlate(a, b, sign * k);
            if (other > r + 1e-9) best = sign * k, r = other;
        }
    const double left = correlate(a, b, best - 1), right = correlate(a, b, best + 1);
    *correlation = NAN;
    if (!(r >= left - 1e-9 && r >= right - 1e-9)) return NAN;
    *correlation = r;
    const double curvature = left + right - 2 * r;
    return curvature < 0 ? best + 0.5 * (left - right) / curvature : best;
}

/* Subtract the mean, so that sums of squares do not lose digits. */
static void fill_grid(lines *s, double t_first, double step, double *out)
{
    double mean = 0;
    s->at = 0;
    for (int k = 0; k < GRID; k++) {
        out[k] = value_at(s, t_first + k * step);
        mean += out[k] / GRID;
    }
    for (int k = 0; k < GRID; k++) out[k] -= mean;
}

static mps_status find_shift(const mps_stats_config *config, lines *a, lines *b, mps_comparison *c)
{
    const double length = c->t_last - c->t_first, step = length / (GRID - 1);
    double most = config->shift_most;
    if (isnan(most)) most = isnan(config->period) ? 0.25 * length : 0.5 * config->period;
    const double lags = fmin(most / step, 0.5 * GRID);
    double *grid = malloc(2 * GRID * sizeof *grid);
    if (!grid) return mps__stats_no_memory(config);
    fill_grid(a, c->t_first, step, grid);
    fill_grid(b, c->t_first, step, grid + GRID);
    c->shift = step * best_lag(grid, grid + GRID, (int)ceil(lags), &c->correlation);
    c->phase = 2 * 3.14159265358979323846 * c->shift / config->period;
    free(grid);
    return MPS_OK;
}

static mps_status compare(const mps_stats_config *config, lines *a, lines *b, mps_comparison *c)
{
    c->t_first = fmax(fmax(a->t[0], b->t[0]), config->from);
    c->t_last = fmin(fmin(a->t[a->n - 1], b->t[b->n - 1]), config->until);
    MPS__STATS_CHECK(config, c->t_first < c->t_last,
                     "no common time: first is from %.9g to %.9g s, second from %.9g to %.9g s",
                     a->t[0], a->t[a->n - 1], b->t[0], b->t[b->n - 1]);
    for (int64_t k = 0; k < a->n; k++) c->points += a->t[k] >= c->t_first && a->t[k] <= c->t_last;
    find_differences(a, b, c);
    return find_shift(config, a, b, c);
}

mps_status mps_series_compare(const mps_stats_config *config, const mps_series *first,
                              const mps_series *second, mps_comparison *c)
{
    lines a = {0}, b = {0};
    mps_comparison out = {.struct_size = sizeof out};
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, mps__stats_known(c, sizeof *c), "call mps_comparison_init() first");
    mps_status status = take(config, "first.", first, 2, &a);
    if (status == MPS_OK) status = take(config, "second.", second, 2, &b);
    if (status == MPS_OK) status = compare(config, &a, &b, &out);
    free(a.t);
    free(b.t);
    if (status == MPS_OK) mps__stats_out(c, &out, sizeof out);
    return status;
}

/* ---- points ---- */

/* Search of points: steps to each side of the largest shift. */
enum { LAGS = 400, POINTS_LEAST = 5 };

/* Pearson's correlation of the points with the lines `shift` later; NAN: fewer than `least` points
 * are in the time of the lines. */
static double correlate_points(const lines *a, lines *b, double shift, int64_t least)
{
    double n = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    b->at = 0;
    for (int64_t k = 0; k < a->n; k++) {
        const double t = a->t[k] + shift;
        if (!(t >= b->t[0] && t <= b->t[b->n - 1])) continue;
        const double x = a->p[k], y = value_at(b, t), dx = x - ma, dy = y - mb;
        n++;
        ma += dx / n;
        mb += dy / n;
        aa += dx * (x - ma);
        bb += dy * (y - mb);
        ab += dx * (y - mb);
    }
    return n >= (double)least && aa > 0 && bb > 0 ? ab / sqrt(aa * bb) : NAN;
}

/* The largest correlation within the allowed shifts, excluding their ends. */
static void find_points_shift(const mps_stats_config *config, const lines *a, lines *b,
                              mps_comparison *c)
{
    double most = config->shift_most, r[2 * LAGS + 1];
    int best = LAGS;
    c->shift = c->correlation = c->phase = NAN;
    if (isnan(most))
        most = isnan(config->period) ? 0.25 * (c->t_last - c->t_first) : 0.5 * config->period;
    const double step = most / LAGS;
    if (a->n < POINTS_LEAST || !(step > 0)) return;
    for (int k = 0; k <= 2 * LAGS; k++)
        r[k] = correlate_points(a, b, (k - LAGS) * step, a->n > 6 ? a->n * 3 / 4 : POINTS_LEAST);
    for (int k = 1; k <= LAGS; k++)
        for (int sign = -1; sign <= 1; sign += 2)
            if (r[LAGS + sign * k] > r[best] + 1e-9 || isnan(r[best])) best = LAGS + sign * k;
    if (best == 0 || best == 2 * LAGS || !(r[best - 1] < INFINITY) || !(r[best + 1] < INFINITY))
        return;
    const double curvature = r[best - 1] + r[best + 1] - 2 * r[best];
    const double part = curvature < 0 ? 0.5 * (r[best - 1] - r[best + 1]) / curvature : 0;
    c->correlation = r[best];
    c->shift = step * (best - LAGS + part);
    c->phase = 2 * 3.14159265358979323846 * c->shift / config->period;
}

static void find_points(const lines *a, lines *b, mps_comparison *c)
{
    double sum = 0, squares = 0, squares_first = 0;
    c->peak[0] = c->peak[1] = c->trough[0] = c->trough[1] = c->largest = NAN;
    b->at = 0;
    for (int64_t k = 0; k < a->n; k++) {
        const double t = a->t[k], both[2] = {a->p[k], value_at(b, t)}, d = both[1] - both[0];
        for (int which = 0; which < 2; which++) note_value(t, both[which], which, c);
        sum += both[0];
        squares_first += both[0] * both[0];
        c->mean += d / (double)a->n;
        squares += d * d;
        if (!(fabs(d) <= fabs(c->largest))) c->largest = d, c->t_largest = t;
    }
    c->points = a->n;
    c->rms = sqrt(squares / (double)a->n);
    const double mean = sum / (double)a->n;
    c->rms_first = sqrt(fmax(0, squares_first / (double)a->n - mean * mean));
}

static mps_status compare_points(const mps_stats_config *config, lines *a, lines *b,
                                 mps_comparison *c)
{
    const double from = fmax(b->t[0], config->from), until = fmin(b->t[b->n - 1], config->until);
    const double first = a->t[0], last = a->t[a->n - 1];
    int64_t kept = 0;
    for (int64_t k = 0; k < a->n; k++) {
        if (!(a->t[k] >= from && a->t[k] <= until)) continue;
        a->t[kept] = a->t[k];
        a->p[kept++] = a->p[k];
    }
    a->n = kept;
    MPS__STATS_CHECK(config, kept > 0,
                     "no common time: the points are from %.9g to %.9g s, the series from %.9g to "
                     "%.9g s",
                     first, last, from, until);
    c->t_first = a->t[0];
    c->t_last = a->t[kept - 1];
    find_points(a, b, c);
    find_points_shift(config, a, b, c);
    return MPS_OK;
}

mps_status mps_points_compare(const mps_stats_config *config, const mps_series *points,
                              const mps_series *series, mps_comparison *c)
{
    lines a = {0}, b = {0};
    mps_comparison out = {.struct_size = sizeof out};
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, mps__stats_known(c, sizeof *c), "call mps_comparison_init() first");
    mps_status status = take(config, "points.", points, 1, &a);
    if (status == MPS_OK) status = take(config, "series.", series, 2, &b);
    if (status == MPS_OK) status = compare_points(config, &a, &b, &out);
    free(a.t);
    free(b.t);
    if (status == MPS_OK) mps__stats_out(c, &out, sizeof out);
    return status;
}
