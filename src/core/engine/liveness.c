/* SPDX-License-Identifier: BSD-3-Clause */
/* Liveness analysis of channels in a step, from the uses of its calls, and the memory plan. */
#include "plan.h"
#include <string.h>

enum { WORDS = (MPS__CALLS + 63) / 64 };

/* Live range of a channel, one bit per call: set while it holds values that are read later. */
typedef struct life {
    uint64_t call[WORDS];
} life;

static void live_from(life *l, int32_t first, int32_t last)
{
    for (int32_t k = first; k <= last; k++) l->call[k / 64] |= UINT64_C(1) << k % 64;
}

static bool meet(const life *a, const life *b)
{
    bool together = false;
    for (int w = 0; w < WORDS; w++) together = together || a->call[w] & b->call[w];
    return together;
}

/* Access of a call to a channel, as declared. From MPS_FORCE on pair flux channels are read without
 * a declared use. */
static int32_t access_of(const mps__call *call, int32_t channel, bool in_flux)
{
    int32_t access = in_flux && call->hook >= MPS_FORCE ? MPS_USE_READ : 0;
    for (int32_t u = 0; u < call->use_count; u++)
        if (call->channel[u] == channel) access |= call->uses[u].access;
    return access;
}

/* Live range of a channel of the arena. A pass with MPS__USE_BEGIN ends the previous range; the
 * range of a model's channel begins with its first use. */
static life life_of(mps__plan *p, int32_t channel, bool in_flux)
{
    life l = {{0}};
    int32_t first = -1, last = -1;
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++) {
        const int32_t access = access_of(&p->call[k], channel, in_flux);
        if (!access) continue;
        if (first >= 0 && access & MPS__USE_BEGIN) {
            live_from(&l, first, last);
            first = -1;
        }
        if (first < 0) first = k;
        last = k;
    }
    if (first < 0) return l;
    live_from(&l, first, last);
    if (channel >= MPS__OWN_CHANNELS) p->call[first].begins |= UINT64_C(1) << channel;
    return l;
}

/* Whether bytes from..from+size-1 of a particle are free for the channel: no channel placed there
 * is live at the same time. */
static bool is_free(const mps__channels *c, const life *ranges, int32_t channel, int64_t from)
{
    const int64_t end = from + (int64_t)mps__channel_element(&c->list[channel]);
    for (int32_t k = 0; k < c->count; k++) {
        const mps__channel *a = &c->list[k];
        if (a->offset < 0 || !meet(&ranges[k], &ranges[channel])) continue;
        if (a->offset < end && from < a->offset + (int64_t)mps__channel_element(a)) return false;
    }
    return true;
}

/* Lowest free offset: 0, or the end of another channel. */
static int64_t find_place(const mps__channels *c, const life *ranges, int32_t channel)
{
    int64_t found = is_free(c, ranges, channel, 0) ? 0 : INT64_MAX;
    for (int32_t k = 0; k < c->count; k++) {
        const mps__channel *a = &c->list[k];
        const int64_t behind = a->offset + (int64_t)mps__channel_element(a);
        if (a->offset >= 0 && behind < found && is_free(c, ranges, channel, behind)) found = behind;
    }
    return found;
}

static int32_t calls_of(const life *l)
{
    int32_t calls = 0;
    for (int k = 0; k < MPS__CALLS; k++) calls += l->call[k / 64] >> k % 64 & 1;
    return calls;
}

/* Next channel to place: the longest live range first, then the largest; four-byte numbers last, so
 * that all others are aligned. -1: all are placed. */
static int32_t find_next(const mps__channels *c, const life *ranges)
{
    int64_t most = 0;
    int32_t found = -1;
    for (int32_t k = 0; k < c->count; k++) {
        const mps__channel *a = &c->list[k];
        if (a->where != MPS__IN_ARENA || mps__channel_is_scalar(a) || a->offset >= 0) continue;
        const int64_t bytes = (int64_t)mps__channel_element(a), calls = calls_of(&ranges[k]),
                      weight = calls == 0 ? 0 : (bytes % 8 == 0) * 1000000 + calls * 1000 + bytes;
        if (weight <= most) continue;
        most = weight;
        found = k;
    }
    return found;
}

void mps__liveness_make(mps__plan *p, mps__channels *c)
{
    life ranges[MPS__CHANNELS] = {{{0}}};
    int32_t flux[MPS__FLUX_CHANNELS], next;
    mps__flux_channels(c, flux);
    for (int32_t k = 0; k < c->count; k++) {
        bool in_flux = false;
        for (int f = 0; f < MPS__FLUX_CHANNELS; f++) in_flux = in_flux || flux[f] == k;
        c->list[k].offset = -1;
        if (c->list[k].where == MPS__IN_ARENA) ranges[k] = life_of(p, k, in_flux);
    }
    c->stride = 0;
    while ((next = find_next(c, ranges)) >= 0) {
        const int64_t place = find_place(c, ranges, next),
                      end = place + (int64_t)mps__channel_element(&c->list[next]);
        c->list[next].offset = place;
        c->stride = end > c->stride ? end : c->stride;
    }
}
