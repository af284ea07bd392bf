/* SPDX-License-Identifier: BSD-3-Clause */
/* Deferred reductions on a device. */
#include "runner.h"
#include "loop.h"
#include <string.h>

static mps__results *results_of(const mps__runner *h)
{
    return h->memory.open ? mps__memory_results(&h->memory) : NULL;
}

/* Add a deferred reduction; sums or maxima, or neither. */
static mps__deferred *add(mps__runner *h, int32_t sums, int32_t maxima, mps__then then)
{
    mps__deferred_list *l = &h->deferred;
    if (l->count == MPS__DEFERRED || l->sums + sums > MPS__DEFERRED_VALUES ||
        l->maxima + maxima > MPS__DEFERRED_VALUES)
        mps__runner_flush(h);
    mps__deferred *k = &l->list[l->count++];
    *k = (mps__deferred){then, sums, maxima, sums > 0 ? l->sums : l->maxima};
    l->sums += sums;
    l->maxima += maxima;
    return k;
}

mps_exact *mps__deferred_sums(mps__runner *h, int32_t count, mps__then then)
{
    const mps__deferred *k = add(h, count, 0, then);
    return results_of(h)->sum + k->at;
}

double *mps__deferred_maxima(mps__runner *h, int32_t count, mps__then then)
{
    const mps__deferred *k = add(h, 0, count, then);
    return results_of(h)->value + k->at;
}

void mps__runner_defer(mps__runner *h, mps__then then)
{
    if (h->deferred.count > 0)
        add(h, 0, 0, then);
    else
        then.run(then.owner, NULL);
}

typedef struct rounding {
    const mps_exact *sum;
    double *value;
} rounding;

MPS_ROW void round_row(const rounding *f, int64_t i)
{
    f->value[i] = mps_exact_value(&f->sum[i]);
}
MPS__LOOP_ANY(round_rows, round_row, rounding)

/* Copy all values to the host at once, followed by `bytes` of a device array. */
static void fetch_rounded(mps__runner *h, const void *array, size_t bytes, double *value)
{
    const mps__deferred_list *l = &h->deferred;
    mps__device *d = &h->memory.device;
    mps__results *on_device = results_of(h);
    const size_t values = (size_t)l->maxima + (size_t)l->sums;
    mps__loop_run(&d->parallel, &round_rows, MPS__ANY_DIM, l->sums,
                  &(rounding){on_device->sum, on_device->value + l->maxima});
    if (bytes > 0) mps__device_copy(d, on_device->value + values, array, bytes);
    mps__device_download(d, value, on_device->value, values * sizeof *value + bytes);
}

/* Copy and reduce over all ranks: sums are rounded after the reduction. */
static void fetch_joined(mps__runner *h, const void *array, size_t bytes, double *value)
{
    const mps__deferred_list *l = &h->deferred;
    mps__device *d = &h->memory.device;
    mps__results *on_device = results_of(h);
    mps_exact sum[MPS__DEFERRED_VALUES] = {{{0}, 0, 0}};
    /* defined values if the device fails */
    memset(value, 0, (size_t)l->maxima * sizeof *value + bytes);
    if (bytes > 0) mps__device_copy(d, on_device->value + l->maxima, array, bytes);
    mps__device_download(d, sum, on_device->sum, (size_t)l->sums * sizeof *sum);
    mps__device_download(d, value, on_device->value, (size_t)l->maxima * sizeof *value + bytes);
    if (bytes > 0) memmove(value + l->maxima + l->sums, value + l->maxima, bytes);
    if (l->maxima > 0) mps__ranks_max(h->ghosts->ranks, l->maxima, value);
    if (l->sums > 0) mps__ranks_sum(h->ghosts->ranks, l->sums, sum);
    for (int32_t k = 0; k < l->sums; k++) value[l->maxima + k] = mps_exact_value(&sum[k]);
}

void mps__runner_flush_with(mps__runner *h, const void *array, void *out, size_t bytes)
{
    mps__deferred_list *l = &h->deferred;
    const bool failed = h->memory.device.failed;
    double value[2 * MPS__DEFERRED_VALUES + 1];
    const double *sum = value + l->maxima;
    if (l->maxima + l->sums > 0 || bytes > 0)
        (mps__ranks_many(h->ghosts->ranks) ? fetch_joined : fetch_rounded)(h, array, bytes, value);
    for (int32_t k = 0; k < l->count && !failed && !h->memory.device.failed; k++) {
        const mps__deferred *own = &l->list[k];
        own->then.run(own->then.owner, own->sums > 0 ? sum + own->at : value + own->at);
    }
    if (bytes > 0 && !h->memory.device.failed) memcpy(out, sum + l->sums, bytes);
    l->count = l->sums = l->maxima = 0;
}

void mps__runner_flush(mps__runner *h)
{
    if (h->deferred.count > 0) mps__runner_flush_with(h, NULL, NULL, 0);
}
