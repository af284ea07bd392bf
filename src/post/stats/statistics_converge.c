/* SPDX-License-Identifier: BSD-3-Clause */
/* Several runs of one case: three spacings, repeats. */
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

mps_status mps_convergence_init(mps_convergence *c, size_t size)
{
    return mps__stats_init(c, size, NULL, sizeof *c);
}

mps_status mps_repeat_init(mps_repeat *r, size_t size)
{
    return mps__stats_init(r, size, NULL, sizeof *r);
}

/* ---- three spacings ---- */

/* (f3 - f2)/(f2 - f1) of f = limit + C h^order; grows with the order. */
static double ratio_of(const double *spacing, double order)
{
    const double a = log(spacing[1] / spacing[0]), b = log(spacing[2] / spacing[1]);
    if (order == 0) return b / a;
    return exp(order * a) * expm1(order * b) / expm1(order * a);
}

/* NAN: negative. */
static double find_order(const double *spacing, double ratio)
{
    double low = 0, high = 1;
    if (!(ratio > ratio_of(spacing, 0))) return NAN;
    if (isinf(ratio)) return INFINITY;
    while (ratio_of(spacing, high) < ratio) high *= 2;
    for (int k = 0; k < 100; k++) {
        const double middle = 0.5 * (low + high);
        if (ratio_of(spacing, middle) < ratio)
            low = middle;
        else
            high = middle;
    }
    return high;
}

static double largest_difference(const double *f)
{
    return fmax(fmax(f[0], f[1]), f[2]) - fmin(fmin(f[0], f[1]), f[2]);
}

/* The limit from the finest value and each of the others; of two different limits the one further
 * away. */
static double find_limit(const double *h, const double *f, double order)
{
    const double by_second = (f[0] - f[1]) / expm1(order * log(h[1] / h[0]));
    const double by_third = (f[0] - f[2]) / expm1(order * log(h[2] / h[0]));
    return f[0] + (fabs(by_second) > fabs(by_third) ? by_second : by_third);
}

static mps_convergence find_convergence(const mps_stats_config *config, const double *h,
                                        const double *f)
{
    const double fine = f[1] - f[0], coarse = f[2] - f[1];
    mps_convergence out = {.struct_size = sizeof out, .order = NAN, .limit = NAN};
    out.band = config->safety_poor * largest_difference(f);
    if (fine == 0 && coarse == 0) {
        out.kind = MPS_CONVERGE_SAME;
        out.limit = f[0];
        return out;
    }
    if ((fine < 0 && coarse > 0) || (fine > 0 && coarse < 0)) {
        out.kind = MPS_CONVERGE_OSCILLATING;
        return out;
    }
    out.order = find_order(h, fine != 0 ? coarse / fine : INFINITY);
    out.kind = MPS_CONVERGE_SLOW;
    if (!(out.order >= config->order_least)) return out;
    out.kind = MPS_CONVERGE_MONOTONE;
    out.limit = find_limit(h, f, fmin(out.order, config->order_most));
    out.band = config->safety * fabs(out.limit - f[0]);
    return out;
}

mps_status mps_converge(const mps_stats_config *config, const double *spacing, const double *value,
                        mps_convergence *c)
{
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, spacing && value, "%s is NULL", spacing ? "value" : "spacing");
    MPS__STATS_CHECK(config, mps__stats_known(c, sizeof *c), "call mps_convergence_init() first");
    for (int k = 0; k < 3; k++) {
        MPS__STATS_CHECK(config, spacing[k] > 0 && isfinite(spacing[k]),
                         "spacing[%d] is %g: must be > 0", k, spacing[k]);
        MPS__STATS_CHECK(config, k == 0 || spacing[k] > spacing[k - 1],
                         "spacing[%d] is %g: must be larger than the one before it, %g", k,
                         spacing[k], spacing[k - 1]);
        MPS__STATS_CHECK(config, isfinite(value[k]), "value[%d] is %g: must be finite", k,
                         value[k]);
    }
    const mps_convergence out = find_convergence(config, spacing, value);
    mps__stats_out(c, &out, sizeof out);
    return MPS_OK;
}

/* ---- repeats ---- */

static mps_repeat find_repeat(const mps_stats_config *config, int32_t count, const double *value)
{
    mps_repeat r = {.struct_size = sizeof r,
                    .t = NAN,
                    .least = INFINITY,
                    .most = -INFINITY,
                    .deviation = NAN,
                    .mean_band = NAN,
                    .next_band = NAN};
    double sum = 0, square = 0;
    for (int32_t k = 0; k < count; k++) {
        if (isnan(value[k])) continue;
        r.count++;
        sum += value[k];
        r.least = fmin(r.least, value[k]);
        r.most = fmax(r.most, value[k]);
    }
    r.mean = sum / r.count;
    if (r.count < 2) return r;
    for (int32_t k = 0; k < count; k++)
        if (!isnan(value[k])) square += (value[k] - r.mean) * (value[k] - r.mean);
    const double t = mps__student(r.count - 1, config->confidence);
    r.deviation = sqrt(square / (r.count - 1));
    r.mean_band = t * r.deviation / sqrt(r.count);
    r.next_band = t * r.deviation * sqrt(1 + 1.0 / r.count);
    return r;
}

mps_status mps_repeat_find(const mps_stats_config *config, int32_t count, const double *value,
                           mps_repeat *r)
{
    int32_t known = 0;
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, count >= 1 && value, "count is %d: must be >= 1", (int)count);
    MPS__STATS_CHECK(config, mps__stats_known(r, sizeof *r), "call mps_repeat_init() first");
    for (int32_t k = 0; k < count; k++) {
        MPS__STATS_CHECK(config, !isinf(value[k]),
                         "value[%d] is %g: must be finite, or nan where there is none", (int)k,
                         value[k]);
        known += !isnan(value[k]);
    }
    MPS__STATS_CHECK(config, known > 0, "no run has a value");
    const mps_repeat out = find_repeat(config, count, value);
    mps__stats_out(r, &out, sizeof out);
    return MPS_OK;
}

/* The highest event within `window` of t, NULL: none. */
static const mps_impact *find_event(const mps_impacts *s, double t, double window)
{
    const mps_impact *best = NULL;
    for (int64_t k = 0; k < s->info.events; k++) {
        const mps_impact *e = &s->event[k];
        if (fabs(e->t - t) <= window && (!best || e->peak > best->peak)) best = e;
    }
    return best;
}

mps_status mps_repeat_peaks(const mps_stats_config *config, int32_t runs,
                            const mps_impacts *const *impacts, int64_t index, mps_repeat *r)
{
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, runs >= 1 && impacts, "runs is %d: must be >= 1", (int)runs);
    MPS__STATS_CHECK(config, mps__stats_known(r, sizeof *r), "call mps_repeat_init() first");
    for (int32_t k = 0; k < runs; k++)
        MPS__STATS_CHECK(config, impacts[k], "impacts[%d] is NULL", (int)k);
    MPS__STATS_CHECK(config, index >= 0 && index < impacts[0]->info.events,
                     "index is %lld: must be 0 .. %lld", (long long)index,
                     (long long)impacts[0]->info.events - 1);
    mps_impact first = {.struct_size = sizeof first};
    mps_impacts_get(impacts[0], index, &first);
    double *peak = malloc((size_t)runs * sizeof *peak), t = 0;
    if (!peak) return mps__stats_no_memory(config);
    for (int32_t k = 0; k < runs; k++) {
        const mps_impact *e = k == 0 ? &first
                                     : find_event(impacts[k], first.t, impacts[0]->info.window);
        peak[k] = e ? e->peak : NAN;
        t += e ? e->t : 0;
    }
    mps_repeat out = find_repeat(config, runs, peak);
    out.t = t / out.count;
    mps__stats_out(r, &out, sizeof out);
    free(peak);
    return MPS_OK;
}
