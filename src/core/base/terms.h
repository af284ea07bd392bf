/* SPDX-License-Identifier: BSD-3-Clause */
/* Several exact sums over rows: terms are buffered in blocks, which are faster to add than single
 * terms. */
#ifndef MPS_CORE_TERMS_H
#define MPS_CORE_TERMS_H

#include <mps/exact.h>

enum { MPS__TERMS_BLOCK = 128 };

typedef struct mps__terms {
    mps_exact *sums; /* [count] */
    int32_t count;   /* MPS_PARALLEL_VALUES at most */
    int32_t rows;    /* buffered */
    double term[MPS_PARALLEL_VALUES][MPS__TERMS_BLOCK];
} mps__terms;

static inline void mps__terms_begin(mps__terms *t, mps_exact *sums, int32_t count)
{
    t->sums = sums;
    t->count = count;
    t->rows = 0;
}

/* Add the buffered terms. Call it after the last row. */
static inline void mps__terms_end(mps__terms *t)
{
    for (int32_t k = 0; k < t->count; k++) mps_exact_add(&t->sums[k], t->rows, t->term[k]);
    t->rows = 0;
}

/* Add the terms of a row, [count]. */
static inline void mps__terms_add(mps__terms *t, const double *own)
{
    for (int32_t k = 0; k < t->count; k++) t->term[k][t->rows] = own[k];
    if (++t->rows == MPS__TERMS_BLOCK) mps__terms_end(t);
}

#endif
