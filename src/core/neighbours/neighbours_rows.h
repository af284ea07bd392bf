/* SPDX-License-Identifier: BSD-3-Clause */
/* Common parts of the search and of the rows at later positions. */
#ifndef MPS_CORE_NEIGHBOURS_ROWS_H
#define MPS_CORE_NEIGHBOURS_ROWS_H

#include "loop.h"
#include "neighbours.h"
#include <mps/stage.h>
#include <string.h>

/* Capacity of the stack buffer of a row; longer rows are an exception. */
enum { MPS__ROW = 1024 };

/* Squared distances that separate near pairs, other pairs in reach, and candidates out of reach. */
typedef struct mps__rings {
    double least, near2, far2;
} mps__rings;

mps__rings mps__rings_of(const mps_neighbours *l);

/* Sort columns in ascending order. */
void mps__sort_row(int32_t *row, int64_t n);

/* Numbers of near pairs, and of other pairs in reach. */
typedef struct mps__parted {
    int64_t near, far;
} mps__parted;

/* Partition candidates with squared distances r2 into `row`: near pairs, other pairs in reach, out
 * of reach; `far` and `out` are buffers of the last two. `from` may be `row`. Branch-free: each
 * candidate is written to all three and counted in one. */
MPS_ROW mps__parted mps__part_row(const mps__rings *g, const int32_t *from, const double *r2,
                                  int64_t count, int32_t *row, int32_t *far, int32_t *out)
{
    const double least = g->least, near2 = g->near2, far2 = g->far2;
    int64_t nears = 0, fars = 0, outs = 0;
    for (int64_t k = 0; k < count; k++) {
        const int32_t j = from[k];
        const bool within = (r2[k] < far2) & (r2[k] >= least), close = within & (r2[k] < near2);
        row[nears] = far[fars] = out[outs] = j;
        nears += close;
        fars += within & !close;
        outs += !within;
    }
    memcpy(row + nears, far, (size_t)fars * sizeof *row);
    memcpy(row + nears + fars, out, (size_t)outs * sizeof *row);
    return (mps__parted){nears, fars};
}

/* Part of a squared distance: 0 near, 1 other pairs in reach, 2 out of reach. */
MPS_ROW int mps__ring_of(const mps__rings *g, double r2)
{
    return r2 >= g->least && r2 < g->far2 ? r2 >= g->near2 : 2;
}

static inline int64_t mps__first_at_least(const uint64_t *key, int64_t n, uint64_t value)
{
    int64_t lo = 0;
    while (n > 0) {
        int64_t half = n / 2;
        if (key[lo + half] < value) {
            lo += half + 1;
            n -= half + 1;
        } else {
            n = half;
        }
    }
    return lo;
}

/* Ranges of n sorted indices that hold the cells around that of key `middle`: one range for each
 * row of three cells. */
MPS_ROW int mps__ranges_around(const int dim, const uint64_t *key, int64_t n, uint64_t middle,
                               int64_t range[9][2])
{
    const int bits = mps__cell_bits(dim), high = dim == 3;
    int count = 0;
    MPS__ROLLED
    for (int dz = -high; dz <= high; dz++) {
        MPS__ROLLED
        for (int dy = -1; dy <= 1; dy++) {
            int64_t step = (int64_t)dy * (INT64_C(1) << bits) +
                           (high ? (int64_t)dz * (INT64_C(1) << (2 * bits)) : 0);
            uint64_t cell = middle + (uint64_t)step;
            int64_t first = mps__first_at_least(key, n, cell - 1), last = first;
            while (last < n && key[last] <= cell + 1) last++;
            if (last > first) {
                range[count][0] = first;
                range[count++][1] = last;
            }
        }
    }
    return count;
}

/* Partition the rows that the search found too long for the stack buffer. */
mps_status mps__neighbours_part_long(mps_neighbours *l);
/* Allocate `count` entries; old contents are lost, new ones are not zeroed. Excess capacity is
 * freed: the first search has rows of all solids. */
mps_status mps__neighbours_fit(mps_neighbours *l, void **block, int64_t *capacity, int64_t count,
                               size_t size);

#endif
