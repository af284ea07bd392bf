/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 2: pairs of particles. Cells hold sorted keys, not a grid array, so that the size of the domain costs nothing. */
#ifndef MPS_CORE_NEIGHBOURS_H
#define MPS_CORE_NEIGHBOURS_H

#include "base.h"
#include "screens.h"
#include <mps/operators.h>

/* Rows: near pairs in begin[i]..middle[i], the others up to end[i]; ascending columns in each part, so that sums
 * do not depend on how the list was found. */
struct mps_neighbours {
    mps__context *context;
    mps__context own; /* context of a list that stands alone */
    int32_t dim, threads;
    double dp, skin, re_near, re_far;
    int64_t n, capacity, pair_capacity, candidate_capacity, weight_capacity;
    const double *x;
    int64_t *begin, *middle, *end; /* [n] */
    int32_t *col;                  /* pairs within re_far at the present positions */
    double *w_r2;                  /* NULL, or room for a weight beside each entry of col */
    int64_t *candidate_row;        /* [n+1] pairs within re_far + skin at the last search */
    int32_t *candidate;
    double *searched;            /* [n*dim] positions at the last search */
    uint64_t *key;               /* [2 n] cell keys and scratch of the sort */
    int32_t *order;              /* [2 n] */
    bool valid;                  /* candidates belong to the present order */
    const mps__screens *screens; /* NULL, or what hides particles from each other; its seers are up to date */
};

mps_status mps__neighbours_init(mps_neighbours *l, mps__context *context, int32_t dim, double dp);
void mps__neighbours_free(mps_neighbours *l);

/* True if no particle moved by more than half the skin since the last search. */
bool mps__neighbours_fresh(const mps_neighbours *l, int64_t n, const double *x, double re_far);
/* Order of particles by cell, [n] in l->order; for sorting the store before a search. */
mps_status mps__neighbours_order(mps_neighbours *l, int64_t n, const double *x, double re_far);
/* Search candidates; positions must be finite and are borrowed. */
mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near, double re_far);
/* Exact rows at the present positions from the candidates. */
mps_status mps__neighbours_rows(mps_neighbours *l, const double *x);
/* Make room for l->w_r2. */
mps_status mps__neighbours_weights(mps_neighbours *l);

#endif
