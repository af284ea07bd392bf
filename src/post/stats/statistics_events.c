/* SPDX-License-Identifier: BSD-3-Clause */
/* From a signal to events: what lies between two samples is the straight line. */
#include "grow.h"
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the signal ---- */

static mps_status allocate(const mps_stats_config *config, int64_t n, mps__signal *out)
{
    if ((uint64_t)n > SIZE_MAX / 64) return mps__stats_no_memory(config);
    out->t = malloc((2 * (size_t)n + 1) * sizeof *out->t);
    if (!out->t) return mps__stats_no_memory(config);
    out->p = out->t + n;
    return MPS_OK;
}

static mps_status copy_known(const mps_stats_config *config, int64_t n, const double *t,
                             const double *p, mps__signal *out)
{
    MPS__STATS_TRY(allocate(config, n, out));
    for (int64_t k = 0; k < n; k++) {
        if (t[k] < config->from || t[k] > config->until) continue;
        if (isnan(p[k])) {
            out->missing++;
            continue;
        }
        out->t[out->n] = t[k];
        out->p[out->n++] = p[k];
    }
    return MPS_OK;
}

/* Equidistant samples from the first one on. */
static mps_status resample(const mps_stats_config *config, mps__signal *s)
{
    const double most = 1e12, span = (s->t[s->n - 1] - s->t[0]) * config->rate;
    MPS__STATS_CHECK(config, span < most, "'rate' is %g: gives %g samples, at most %g are allowed",
                     config->rate, span, most);
    mps__signal out = {.n = (int64_t)(span + 1e-9) + 1, .missing = s->missing};
    MPS__STATS_TRY(allocate(config, out.n, &out));
    for (int64_t k = 0, at = 0; k < out.n; k++) {
        const double t = s->t[0] + (double)k / config->rate;
        while (at + 2 < s->n && s->t[at + 1] <= t) at++;
        double f = (t - s->t[at]) / (s->t[at + 1] - s->t[at]);
        if (f > 1) f = 1; /* rounding at the last sample */
        out.t[k] = t;
        out.p[k] = s->p[at] + f * (s->p[at + 1] - s->p[at]);
    }
    free(s->t);
    *s = out;
    return MPS_OK;
}

/* y' = p' - w y with y = 0 at the start, exact for a signal that is linear between samples. */
static void high_pass(double frequency, mps__signal *s)
{
    const double w = 2 * 3.14159265358979323846 * frequency;
    double y = 0, before = s->n > 0 ? s->p[0] : 0;
    for (int64_t k = 0; k < s->n; k++) {
        const double p = s->p[k], x = k > 0 ? w * (s->t[k] - s->t[k - 1]) : 0;
        const double gain = x > 0 ? -expm1(-x) / x : 1;
        y = y * exp(-x) + (p - before) * gain;
        before = p;
        s->p[k] = y;
    }
}

mps_status mps__signal_make(const mps_stats_config *config, int64_t n, const double *t,
                            const double *p, mps__signal *out)
{
    *out = (mps__signal){0};
    MPS__STATS_TRY(mps__stats_series(config, "", n, t, p));
    mps_status status = copy_known(config, n, t, p, out);
    if (status == MPS_OK && config->rate > 0 && out->n > 1) status = resample(config, out);
    if (status == MPS_OK && config->high_pass > 0) high_pass(config->high_pass, out);
    if (status == MPS_OK) return MPS_OK;
    free(out->t);
    *out = (mps__signal){0};
    return status;
}

double mps__signal_threshold(const mps_stats_config *config, const mps__signal *s)
{
    double mean = 0, square = 0;
    if (!isnan(config->threshold)) return config->threshold;
    for (int64_t k = 0; k < s->n; k++) mean += s->p[k] / (double)s->n;
    for (int64_t k = 0; k < s->n; k++) square += (s->p[k] - mean) * (s->p[k] - mean) / (double)s->n;
    return s->n > 0 ? mean + config->deviations * sqrt(square) : NAN;
}

/* ---- one event ---- */

/* Time at which the line between samples k - 1 and k has this value; one sample is below it, the
 * other is not. */
static double crossing(const mps__signal *s, int64_t k, double value)
{
    const double a = s->p[k - 1], b = s->p[k];
    return s->t[k - 1] + (value - a) / (b - a) * (s->t[k] - s->t[k - 1]);
}

/* A peak adjacent to sample k in the direction d = -1 or 1, below the lines through the two samples
 * on each side of it: exact for a triangle, and no higher than the sample after a step. False: too
 * few samples. */
static bool find_tent(const mps__signal *s, int64_t k, int d, double *rise, double *x)
{
    const int64_t behind = k - d, next = k + d, far = k + 2 * d;
    if (far < 0 || far >= s->n) return false;
    const double *t = s->t, *p = s->p;
    const double up = (p[k] - p[behind]) / fabs(t[k] - t[behind]), gap = fabs(t[next] - t[k]);
    const double down = (p[next] - p[far]) / fabs(t[far] - t[next]);
    const double place = up + down > 0 ? (p[next] - p[k] + down * gap) / (up + down) : 0;
    *x = d * fmax(0, place);
    *rise = up * fmax(0, place);
    return true;
}

/* Vertex of the parabola through a largest sample and its neighbours, limited by a triangle. For
 * equidistant samples the vertex is above the sample by at most an eighth of the larger step down;
 * the same bound is applied to others, where a parabola may overshoot its samples. */
static void find_peak(const mps__signal *s, int64_t k, mps_impact *e)
{
    e->peak = s->p[k];
    e->t = s->t[k];
    if (k == 0 || k == s->n - 1) return;
    const double before = s->t[k] - s->t[k - 1], after = s->t[k + 1] - s->t[k];
    const double up = (s->p[k] - s->p[k - 1]) / before, down = (s->p[k] - s->p[k + 1]) / after;
    const double curvature = (up + down) / (before + after);
    if (!(curvature > 0)) return;
    /* p = P + slope x - curvature x^2 */
    const double slope = (up * after - down * before) / (before + after);
    const double most = fmax(s->p[k] - s->p[k - 1], s->p[k] - s->p[k + 1]) / 8;
    double rise = fmin(slope * slope / (4 * curvature), most), x = slope / (2 * curvature);
    double tent, place;
    if (find_tent(s, k, slope > 0 ? 1 : -1, &tent, &place) && tent < rise) {
        rise = tent;
        x = place;
    }
    e->peak += rise;
    e->t += x;
}

static void find_slopes(const mps_stats_config *config, const mps__signal *s, int64_t k,
                        mps_impact *e)
{
    const double value = fmin(config->share * e->peak, s->p[k]);
    int64_t rise = k, decay = k + 1;
    while (rise > 0 && !(s->p[rise - 1] < value)) rise--;
    while (decay < s->n && !(s->p[decay] < value)) decay++;
    e->rise = e->decay = NAN;
    if (!(e->peak > 0)) return; /* a fraction of it would be above it */
    if (rise > 0) e->rise = fmax(0, e->t - crossing(s, rise, value)) / (1 - config->share);
    if (decay < s->n) e->decay = fmax(0, crossing(s, decay, value) - e->t) / (1 - config->share);
    e->skewness = e->decay / e->rise;
    e->unresolved = e->rise < config->crossing_time || e->decay < config->crossing_time;
}

/* Integral over the part of the line between samples k - 1 and k that is at or above u. */
static double piece(const mps__signal *s, int64_t k, double u)
{
    const double a = s->p[k - 1], b = s->p[k], dt = s->t[k] - s->t[k - 1];
    if (a >= u && b >= u) return 0.5 * (a + b) * dt;
    if (a < u && b < u) return 0;
    const double above = fmax(a, b), share = (above - u) / fabs(b - a);
    return 0.5 * (above + u) * share * dt;
}

/* Describe an event with samples first .. last, inclusive, at or above u, between samples below
 * u. */
static mps_impact describe(const mps_stats_config *config, const mps__signal *s, double u,
                           int64_t first, int64_t last)
{
    mps_impact e = {.struct_size = sizeof e, .skewness = NAN};
    int64_t top = first;
    for (int64_t k = first; k <= last; k++)
        if (s->p[k] > s->p[top]) top = k;
    e.begin = crossing(s, first, u);
    e.end = crossing(s, last + 1, u);
    e.duration = e.end - e.begin;
    find_peak(s, top, &e);
    find_slopes(config, s, top, &e);
    for (int64_t k = first; k <= last + 1; k++) e.impulse += piece(s, k, u);
    return e;
}

/* ---- all events ---- */

/* The list of events, and the open one. */
typedef struct search {
    const mps_stats_config *config;
    const mps__signal *signal;
    double threshold;
    mps_impact *event;
    int64_t count, cut;
    bool open, whole; /* an event continues; its beginning is in the record */
    int64_t first, last;
} search;

/* The open event has ended. */
static mps_status close_event(search *f)
{
    if (!f->open) return MPS_OK;
    f->open = false;
    if (!f->whole || f->last == f->signal->n - 1) {
        f->cut++;
        return MPS_OK;
    }
    mps_impact *event = mps__grown(f->event, f->count, sizeof *event);
    if (!event) return mps__stats_no_memory(f->config);
    f->event = event;
    f->event[f->count++] = describe(f->config, f->signal, f->threshold, f->first, f->last);
    return MPS_OK;
}

/* Sample k is at or above the threshold, the one before it is below or missing. */
static mps_status cross_up(search *f, int64_t k, double window)
{
    const mps__signal *s = f->signal;
    const double u = f->threshold, up = k > 0 ? crossing(s, k, u) : s->t[0];
    const double down = f->open ? crossing(s, f->last + 1, u) : s->t[0];
    const bool apart = k > 0 && up - down >= window;
    if (f->open && !apart) return MPS_OK;
    MPS__STATS_TRY(close_event(f));
    f->open = true;
    f->whole = apart;
    f->first = k;
    return MPS_OK;
}

static mps_status search_all(search *f, double window)
{
    const mps__signal *s = f->signal;
    for (int64_t k = 0; k < s->n; k++) {
        if (s->p[k] < f->threshold) continue;
        if (k == 0 || s->p[k - 1] < f->threshold) MPS__STATS_TRY(cross_up(f, k, window));
        f->last = k;
    }
    return close_event(f);
}

mps_status mps__events_find(const mps_stats_config *config, const mps__signal *s, double threshold,
                            double window, mps_impact **events, int64_t *count, int64_t *cut)
{
    search f = {.config = config, .signal = s, .threshold = threshold};
    const mps_status status = search_all(&f, window);
    if (status != MPS_OK) {
        free(f.event);
        return status;
    }
    *events = f.event;
    *count = f.count;
    *cut = f.cut;
    return MPS_OK;
}
