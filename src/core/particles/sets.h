/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets of particles that are joined by pairs, e.g. a body of fluid, put together from the parts that each rank has of them. */
#ifndef MPS_CORE_SETS_H
#define MPS_CORE_SETS_H

#include "ghosts.h"
#include <mps/exact.h>

/* A set, or the part of it that a rank has. */
typedef struct mps__set {
    int64_t label; /* least id of its particles */
    int64_t rows;
    int32_t flags;  /* bits; a set has those of all its parts */
    int32_t number; /* of a set: its place in the order of labels */
    mps_exact sum;
} mps__set;

typedef struct mps__sets {
    mps__context *context;
    int64_t count, parts, pairs, list_capacity, part_capacity, pair_capacity, set_capacity;
    mps__set *list; /* [count] the sets of all ranks, by label */
    mps__set *part; /* [parts] of this rank until they are merged, then of all, by label */
    int32_t *set;   /* [parts] set of each part */
    int64_t (*pair)[2];
} mps__sets;

void mps__sets_begin(mps__sets *s, mps__context *context);
void mps__sets_free(mps__sets *s);
/* A part that this rank has. */
mps_status mps__sets_add(mps__sets *s, const mps__set *part);
/* Two parts with these labels, here and on another rank, belong to one set. */
mps_status mps__sets_join(mps__sets *s, int64_t a, int64_t b);
/* Put the parts of all ranks together. */
mps_status mps__sets_merge(mps__sets *s, mps__ranks *r);
/* The set of a part, by its label. */
const mps__set *mps__sets_find(const mps__sets *s, int64_t label);

#endif
