/* SPDX-License-Identifier: BSD-3-Clause */
/* Values that wait at a device. */
#include "host.h"
#include <math.h>
#include <string.h>

static void *place(mps__host *h, int32_t sums, int32_t maxima, mps__then then, mps__joins joins)
{
    mps__laters *l = &h->laters;
    if (l->count == MPS__LATERS) mps__host_settle(h);
    const size_t bytes = (size_t)sums * sizeof(mps_exact) + (size_t)maxima * sizeof(double);
    l->list[l->count++] = (mps__later){then, joins, sums, maxima, l->used};
    l->used += bytes;
    return (char *)mps__twins_results(&h->twins) + l->used - bytes;
}

void *mps__laters_place(mps__host *h, int32_t sums, int32_t maxima, mps__then then)
{
    return place(h, sums, maxima, then, (mps__joins){NULL, NULL, 0});
}

void *mps__laters_join(mps__host *h, int32_t sums, mps__joins joins)
{
    return place(h, sums, 0, (mps__then){NULL, NULL}, joins);
}

void mps__host_do_later(mps__host *h, mps__then then)
{
    if (h->laters.count > 0)
        mps__laters_place(h, 0, 0, then);
    else
        then.run(then.owner, NULL);
}

/* What was to be done with one of them. */
static void run_then(const mps__later *k, const char *all)
{
    double values[MPS_PARALLEL_VALUES];
    mps_exact sum[MPS_PARALLEL_VALUES];
    memcpy(sum, all + k->at, (size_t)k->sums * sizeof *sum);
    if (k->joins.run) {
        k->joins.run(k->joins.owner, k->joins.number, sum);
        return;
    }
    for (int32_t m = 0; m < k->sums; m++) values[m] = mps_exact_value(&sum[m]);
    if (k->maxima > 0) memcpy(values, all + k->at, (size_t)k->maxima * sizeof *values);
    k->then.run(k->then.owner, values);
}

void mps__host_settle_with(mps__host *h, const void *array, void *out, size_t bytes)
{
    mps__laters *l = &h->laters;
    mps__device *d = &h->twins.device;
    char all[MPS__LATER_ROOM + sizeof(double)];
    char *there = h->twins.open ? mps__twins_results(&h->twins) : NULL;
    const size_t begin = l->used;
    if (bytes > 0) mps__device_copy(d, there + begin, array, bytes);
    if (begin + bytes > 0) mps__device_download(d, all, there, begin + bytes);
    for (int32_t k = 0; k < l->count && !d->failed; k++) run_then(&l->list[k], all);
    if (bytes > 0 && !d->failed) memcpy(out, all + begin, bytes);
    l->count = 0;
    l->used = 0;
}

void mps__host_settle(mps__host *h)
{
    if (h->laters.count > 0) mps__host_settle_with(h, NULL, NULL, 0);
}
