/* SPDX-License-Identifier: BSD-3-Clause */
#include "peaks.h"
#include <math.h>

/* Lowest rise considered: fraction of the lowest kept peak, and of the highest so far while fewer
 * are kept. */
static const double SHARE_KEPT = 0.3, SHARE_HIGHEST = 0.1;
/* Time between frames, as a fraction of the time since the rise began; times about a peak in that
 * unit: three frames before it and two after. */
static const double SPACING = 0.2, BEFORE = 3.2, AFTER = 2.2;

void mps__peaks_init(peaks *p, int most, double start, double interval, double apart)
{
    *p = (peaks){.most = most < PEAKS_KEPT ? most : PEAKS_KEPT,
                 .start = start,
                 .interval = interval,
                 .apart = apart};
}

void mps__peaks_add(peaks *p, int column)
{
    if (p->signals == PEAKS_SIGNALS || p->most == 0) return;
    p->signal[p->signals++] = (peak_signal){
        .column = column, .low = {INFINITY, INFINITY}, .turn = -INFINITY};
    const int each = PEAKS_ALL / p->signals > 1 ? PEAKS_ALL / p->signals : 1;
    if (p->most > each) p->most = each;
}

/* Rise of the pressure within the last interval or two. */
static double rise_of(peak_signal *s, double t, double p, double interval)
{
    if (t >= s->turn) {
        s->low[1] = t < s->turn + interval ? s->low[0] : INFINITY;
        s->low[0] = p;
        s->turn = t + interval;
    }
    s->low[0] = fmin(s->low[0], p);
    return p - fmin(s->low[0], s->low[1]);
}

/* Insert the peak that has ended into the sorted list. The next rise begins at the present value,
 * so that the fall is not counted as one. */
static void keep(peaks *p, peak_signal *s, double value)
{
    s->low[0] = s->low[1] = value;
    int k = s->count < p->most ? s->count++ : p->most;
    p->changed = true;
    s->open = false;
    if (k == p->most && !(s->now.p > s->kept[--k].p)) return;
    for (; k > 0 && s->now.p > s->kept[k - 1].p; k--) s->kept[k] = s->kept[k - 1];
    s->kept[k] = s->now;
}

static double least_rise(const peaks *p, const peak_signal *s)
{
    double least = INFINITY;
    for (int k = 0; k < s->count; k++) least = fmin(least, s->kept[k].rise);
    return s->count == p->most ? fmax(SHARE_KEPT * least, SHARE_HIGHEST * s->highest)
                               : SHARE_HIGHEST * s->highest;
}

/* The interval of frames about a peak scales with its rise time, so that a slow peak takes no more
 * frames than a steep one. */
static void follow(peaks *p, peak_signal *s, double t, double value, double rise)
{
    const double apart = fmax(SPACING * (t - s->begin), p->apart);
    if (value > s->now.p) {
        s->now = (peak){value, rise, t - BEFORE * apart, t + AFTER * apart};
        s->highest = fmax(s->highest, rise);
    }
    if (t <= s->now.to && t - s->last >= apart) {
        s->last = t;
        p->due = true;
        p->changed = true; /* the first frames of a rise are removed once later ones exist */
    }
}

static void take(peaks *p, peak_signal *s, double t, double value)
{
    if (!isfinite(value)) return;
    const double rise = rise_of(s, t, value, p->interval);
    if (t < p->start) return;
    if (!s->open && rise > 0 && rise > least_rise(p, s)) {
        s->open = true;
        s->begin = t;
        s->last = -INFINITY;
        s->now = (peak){-INFINITY, 0, t, t};
    }
    if (!s->open) return;
    follow(p, s, t, value, rise);
    if (t > s->now.to && rise < 0.5 * s->now.rise) keep(p, s, value);
}

void mps__peaks_row(void *user, const double *row)
{
    peaks *p = user;
    for (int k = 0; k < p->signals; k++) take(p, &p->signal[k], row[0], row[p->signal[k].column]);
}

static bool is_about(const peak *one, double t)
{
    return t >= one->from && t <= one->to;
}

bool mps__peaks_wants(const peaks *p, double t)
{
    for (int k = 0; k < p->signals; k++) {
        const peak_signal *s = &p->signal[k];
        if (s->open && t >= s->now.from) return true;
        for (int i = 0; i < s->count; i++)
            if (is_about(&s->kept[i], t)) return true;
    }
    return false;
}
