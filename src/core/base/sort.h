/* SPDX-License-Identifier: BSD-3-Clause */
/* Sorting on a device. */
#ifndef MPS_CORE_SORT_H
#define MPS_CORE_SORT_H

#include "parallel.h"

/* Keys and what they belong to; both arrays go from one half of their room to the other. Where keys are equal the lower id comes first, so that there
 * is one order only. */
typedef struct mps__sorting {
    int64_t n, run;    /* all; of so many that are in order each */
    const int64_t *id; /* of what `order` names; NULL: the numbers in `order` */
    const uint64_t *key;
    const int32_t *order;
    uint64_t *new_key; /* the other halves */
    int32_t *new_order;
} mps__sorting;

/* Put all in order, which is in `key` and `order` then. */
void mps__merge_sort(const mps_parallel *p, mps__sorting *s);

#endif
