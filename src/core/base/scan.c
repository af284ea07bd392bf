/* SPDX-License-Identifier: BSD-3-Clause */
/* Prefix sums: sum the blocks, scan the block sums recursively, add to each block the sum of all
 * previous blocks. Integers: independent of the order of additions. */
#include "scan.h"

/* Numbers, and the sum of each block; not stored for a single block. */
typedef struct level {
    int64_t *value, *sum;
    int64_t n;
} level;

MPS_ROW void sum_row(const level *l, int64_t block)
{
    const int64_t begin = block * MPS__SCAN_BLOCK,
                  end = begin + MPS__SCAN_BLOCK < l->n ? begin + MPS__SCAN_BLOCK : l->n;
    int64_t sum = 0;
    for (int64_t i = begin; i < end; i++) l->value[i] = sum += l->value[i];
    if (l->n > MPS__SCAN_BLOCK) l->sum[block] = sum;
}
MPS__LOOP_ANY(sum_blocks, sum_row, level)

/* `sums` holds the scanned block sums. */
MPS_ROW void raise_row(const level *l, int64_t i)
{
    if (i >= MPS__SCAN_BLOCK) l->value[i] += l->sum[i / MPS__SCAN_BLOCK - 1];
}
MPS__LOOP_ANY(raise_rows, raise_row, level)

static int64_t blocks_of(int64_t n)
{
    return (n + MPS__SCAN_BLOCK - 1) / MPS__SCAN_BLOCK;
}

int64_t mps__scan_size(int64_t n)
{
    int64_t size = n;
    for (; n > MPS__SCAN_BLOCK; n = blocks_of(n)) size += blocks_of(n);
    return size;
}

void mps__scan(const mps_parallel *p, int64_t *values, int64_t n)
{
    enum { LEVELS = 10 }; /* 128^9 exceeds any number of rows */
    level list[LEVELS];
    int count = 0;
    for (int64_t *value = values; n > 0; n = n > MPS__SCAN_BLOCK ? blocks_of(n) : 0) {
        list[count++] = (level){value, value + n, n};
        mps__loop_run_long(p, &sum_blocks, MPS__ANY_DIM, blocks_of(n), &list[count - 1]);
        value += n;
    }
    for (int k = count - 2; k >= 0; k--)
        mps__loop_run_cheap(p, &raise_rows, MPS__ANY_DIM, list[k].n, &list[k]);
}
