/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 2: the order of particles by their cells. */
#include "neighbours.h"
#include <string.h>

/* Stable least-significant-digit radix sort of (key, order); only digits that differ are passed over. */
void mps__sort_keys(uint64_t *key, int32_t *order, int64_t n)
{
    uint64_t *k0 = key, *k1 = key + n;
    int32_t *o0 = order, *o1 = order + n;
    uint64_t differ = 0;
    for (int64_t i = 1; i < n; i++) differ |= k0[i] ^ k0[0];
    for (int shift = 0; shift < 64; shift += 8) {
        if (!((differ >> shift) & 255)) continue;
        int64_t count[257] = {0};
        for (int64_t i = 0; i < n; i++) count[((k0[i] >> shift) & 255) + 1]++;
        for (int b = 0; b < 256; b++) count[b + 1] += count[b];
        for (int64_t i = 0; i < n; i++) {
            int64_t to = count[(k0[i] >> shift) & 255]++;
            k1[to] = k0[i];
            o1[to] = o0[i];
        }
        uint64_t *k = k0;
        int32_t *o = o0;
        k0 = k1, k1 = k;
        o0 = o1, o1 = o;
    }
    if (k0 != key) {
        memcpy(key, k0, (size_t)n * sizeof *key);
        memcpy(order, o0, (size_t)n * sizeof *order);
    }
}

void mps__neighbours_sorted(mps_neighbours *l, int64_t n)
{
    for (int64_t i = 0; i < n; i++) l->order[i] = (int32_t)i;
    l->sorted = true;
}
