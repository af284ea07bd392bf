/* SPDX-License-Identifier: BSD-3-Clause */
/* The ranks that a handle runs on, behind the engine of its user. Alone, all calls return at once. */
#ifndef MPS_CORE_RANKS_H
#define MPS_CORE_RANKS_H

#include "base.h"
#include <mps/exact.h>
#include <mps/ranks.h>

typedef struct mps__ranks {
    mps__context *context;
    mps_ranks_ops ops;
    void *self;
    int32_t rank, count; /* 0, 1: alone */
    /* A call failed, here or on another rank. All later ones do nothing; mps__ranks_status() tells. */
    bool failed;
    int64_t rounds; /* exchanges, reductions and gathers */
    int64_t bytes;  /* that this rank sent with them */
    double seconds; /* in them */
} mps__ranks;

/* Values of this rank stay as they are where a call fails: callers look at mps__ranks_status() before they use them for good. */
void mps__ranks_init(mps__ranks *r, mps__context *context);
mps_status mps__ranks_set(mps__ranks *r, const mps_ranks_ops *ops);
void mps__ranks_free(mps__ranks *r);

static inline bool mps__ranks_many(const mps__ranks *r)
{
    return r->count > 1;
}

/* MPS_E_RANKS with the text of the rank that failed first. */
mps_status mps__ranks_status(mps__ranks *r);
/* A status of this rank alone: where it is a failure, all other ranks fail too. Returns it. */
mps_status mps__ranks_tell(mps__ranks *r, mps_status status);

/* A failure that all ranks know of and one of them has the text of: all get it. Those without have an empty text. Returns the status. */
mps_status mps__ranks_text(mps__ranks *r, mps_status status);
/* All ranks have come here, some perhaps with an error after which they can go on: all return the worst one, with one text. */
mps_status mps__ranks_agree(mps__ranks *r, mps_status status);

/* Combine values of all ranks. */
void mps__ranks_reduce(mps__ranks *r, int32_t count, size_t bytes, void *values,
                       mps_combine_fn combine);
/* Maxima over all ranks; a NaN does not count. */
void mps__ranks_max(mps__ranks *r, int32_t count, double *values);
/* Sums over all ranks. */
void mps__ranks_add(mps__ranks *r, int32_t count, int64_t *values);
/* Exact sums over all ranks. */
void mps__ranks_sum(mps__ranks *r, int32_t count, mps_exact *sums);
/* Collect blocks of all ranks; `bytes` [ranks]. */
void mps__ranks_gather(mps__ranks *r, const void *own, const int64_t *bytes, void *all);
/* Replace a list of this rank, in memory of its own, by the lists of all ranks one behind the other. Alone it stays. */
mps_status mps__ranks_collect(mps__ranks *r, void **list, int64_t *count, size_t size);
/* Blocks of all ranks, at rank 0 only. */
void mps__ranks_send_to_first(mps__ranks *r, const void *own, const int64_t *bytes, void *all);
/* A number of each rank, in their order: values [ranks]. */
void mps__ranks_gather_number(mps__ranks *r, int64_t own, int64_t *values);
/* Make a route; where that fails there is none. */
void mps__ranks_connect(mps__ranks *r, int32_t count, const int32_t *to, const int64_t *sent,
                        mps_route *route);
/* Exchange elements along a route. */
void mps__ranks_exchange(mps__ranks *r, const mps_route *route, size_t bytes, const void *out,
                         void *in);

#endif
