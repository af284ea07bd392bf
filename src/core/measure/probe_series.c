/* SPDX-License-Identifier: BSD-3-Clause */
/* Moving averages and samples of a probe. The signal is linear between steps; both are exact for
 * it. */
#include "probe_series.h"
#include <math.h>
#include <string.h>

/* A sample is due if it is late by rounding only, in sampling intervals. */
static const double rounding = 1e-9;

/* Larger sample numbers are not exact; memory is exhausted long before. */
static const double most_samples = 9e15;

static double *row_at(const mps__series *s, int64_t k)
{
    return s->row + k * (1 + s->size);
}

static void add_between(const mps__series *s, int64_t k, double t, double weight, double *out)
{
    const double *a = row_at(s, k), *b = row_at(s, k + 1),
                 f = fmin(fmax((t - a[0]) / (b[0] - a[0]), 0), 1);
    for (int32_t v = 1; v <= s->size; v++) out[v - 1] += weight * (a[v] + f * (b[v] - a[v]));
}

/* The value at one time. */
static void value_at(const mps__series *s, double t, double *out)
{
    int64_t k = s->rows - 2;
    if (k < s->first) {
        memcpy(out, row_at(s, s->first) + 1, (size_t)s->size * sizeof *out);
        return;
    }
    while (k > s->first && row_at(s, k)[0] > t) k--;
    memset(out, 0, (size_t)s->size * sizeof *out);
    add_between(s, k, t, 1, out);
}

void mps__series_mean(const mps__series *s, double from, double to, double *out)
{
    double covered = 0;
    from = fmax(from, row_at(s, s->first)[0]);
    to = fmin(to, row_at(s, s->rows - 1)[0]);
    if (to <= from) {
        value_at(s, to, out);
        return;
    }
    memset(out, 0, (size_t)s->size * sizeof *out);
    for (int64_t k = s->first; k + 1 < s->rows; k++) {
        const double low = fmax(from, row_at(s, k)[0]), high = fmin(to, row_at(s, k + 1)[0]);
        if (high <= low) continue;
        add_between(s, k, 0.5 * (low + high), high - low, out);
        covered += high - low;
    }
    for (int32_t v = 0; v < s->size; v++) out[v] /= covered;
}

/* ---- recording ---- */

/* Drop rows older than the averaging interval. */
static void trim(mps__series *s, double oldest)
{
    while (s->first + 1 < s->rows && row_at(s, s->first + 1)[0] <= oldest) s->first++;
    if (s->first < s->rows - s->first) return;
    memmove(s->row, row_at(s, s->first),
            (size_t)((s->rows - s->first) * (1 + s->size)) * sizeof *s->row);
    s->rows -= s->first;
    s->first = 0;
}

static void push(mps__series *s, double t, const double *values)
{
    double *row = row_at(s, s->rows++);
    row[0] = t;
    memcpy(row + 1, values, (size_t)s->size * sizeof *row);
}

/* Number of the first sample after t, or at t if `inclusive`. */
static int64_t sample_number(double t, double rate, bool inclusive)
{
    return (int64_t)fmin(inclusive ? ceil(t * rate - rounding) : floor(t * rate + rounding) + 1,
                         most_samples);
}

/* Allocate two rows and `samples` samples. */
static mps_status reserve(mps__context *c, mps__series *s, int64_t samples)
{
    const int64_t width = 1 + s->size, total = s->count + samples;
    MPS__TRY(mps__grow(c, (void **)&s->row, &s->row_capacity, s->rows * width,
                       (s->rows + 2) * width, sizeof *s->row));
    MPS__TRY(mps__grow(c, (void **)&s->t, &s->t_capacity, s->count, total, sizeof *s->t));
    return mps__grow(c, (void **)&s->value, &s->value_capacity, s->count * s->size, total * s->size,
                     sizeof *s->value);
}

mps_status mps__series_take(mps__context *c, mps__series *s, const mps__window *window,
                            const mps__instant *now, const double *values)
{
    const double start = s->waits ? s->start : now->t;
    const int64_t next = s->step < 0 ? sample_number(start, window->rate, true) : s->next;
    const int64_t end = window->rate > 0 ? sample_number(now->t, window->rate, false) : next;
    MPS__TRY(reserve(c, s, end > next ? end - next : 0));
    if (s->waits && start < now->t) push(s, start, values);
    push(s, now->t, values);
    s->waits = false;
    s->step = now->step;
    for (s->next = next; s->next < end; s->next++) {
        const double t = (double)s->next / window->rate;
        s->t[s->count] = t;
        mps__series_mean(s, t - window->average, t, s->value + s->count++ * s->size);
    }
    trim(s, now->t - window->reach);
    return MPS_OK;
}

void mps__series_free(mps__context *c, mps__series *s)
{
    mps__free(c, s->row);
    mps__free(c, s->t);
    mps__free(c, s->value);
    *s = (mps__series){0};
}
