/* SPDX-License-Identifier: BSD-3-Clause */
/* Sorting on a device. */
#ifndef MPS_CORE_SORT_H
#define MPS_CORE_SORT_H

#include "parallel.h"

/* Keys and their values; both arrays alternate between two halves of their buffers. Equal keys are
 * ordered by id, so that the order is unique. */
typedef struct mps__sorting {
    int64_t n, run;    /* total; length of the sorted runs */
    const int64_t *id; /* ids of what `order` refers to; NULL: the numbers in `order` */
    const uint64_t *key;
    const int32_t *order;
    uint64_t *new_key; /* the other halves */
    int32_t *new_order;
} mps__sorting;

/* Sort all; the result is in `key` and `order`. */
void mps__merge_sort(const mps_parallel *p, mps__sorting *s);

#endif
