/* SPDX-License-Identifier: BSD-3-Clause */
/* Connected sets of particles, e.g. a droplet, merged from the parts on each rank. */
#ifndef MPS_CORE_SETS_H
#define MPS_CORE_SETS_H

#include "ghosts.h"
#include <mps/exact.h>

/* A set, or the part of it on one rank. */
typedef struct mps__set {
    int64_t label; /* least id of its particles */
    int64_t rows;
    int32_t flags;  /* bits; a set has the union of those of its parts */
    int32_t number; /* of a set: its index in the order of labels */
    mps_exact sum;
} mps__set;

typedef struct mps__sets {
    mps__context *context;
    int64_t count, parts, pairs, list_capacity, part_capacity, pair_capacity, set_capacity;
    mps__set *list; /* [count] the sets of all ranks, by label */
    mps__set *part; /* [parts] of this rank before the merge, then of all ranks, by label */
    int32_t *set;   /* [parts] index of the set of each part */
    int64_t (*pair)[2];
} mps__sets;

void mps__sets_begin(mps__sets *s, mps__context *context);
void mps__sets_free(mps__sets *s);
/* Add a part of this rank. */
mps_status mps__sets_add(mps__sets *s, const mps__set *part);
/* Declare that the parts with these labels, on this and another rank, belong to one set. */
mps_status mps__sets_join(mps__sets *s, int64_t a, int64_t b);
/* Merge the parts of all ranks. */
mps_status mps__sets_merge(mps__sets *s, mps__ranks *r);
/* The set of a part, by the part's label. */
const mps__set *mps__sets_find(const mps__sets *s, int64_t label);

#endif
