/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks of a handle, over the user's message-passing functions. With one rank all calls return at
 * once. */
#ifndef MPS_CORE_RANKS_H
#define MPS_CORE_RANKS_H

#include "base.h"
#include <mps/exact.h>
#include <mps/ranks.h>

typedef struct mps__ranks {
    mps__context *context;
    mps_ranks_ops ops;
    void *self;
    int32_t rank, count; /* 0, 1 without ranks */
    /* A call failed, on this or another rank. All later calls do nothing; see
     * mps__ranks_status(). */
    bool failed;
    int64_t rounds; /* exchanges, reductions and collections */
    int64_t bytes;  /* sent by this rank in them */
    double seconds; /* in them */
} mps__ranks;

/* A failed call leaves values unchanged: callers check mps__ranks_status() before they use the
 * values. */
void mps__ranks_init(mps__ranks *r, mps__context *context);
mps_status mps__ranks_set(mps__ranks *r, const mps_ranks_ops *ops);
void mps__ranks_free(mps__ranks *r);

static inline bool mps__ranks_many(const mps__ranks *r)
{
    return r->count > 1;
}

/* MPS_E_RANKS with the error text of the rank that failed first. */
mps_status mps__ranks_status(mps__ranks *r);
/* Broadcast a status of this rank alone: if it is a failure, all other ranks fail too. Returns
 * it. */
mps_status mps__ranks_report(mps__ranks *r, mps_status status);

/* Broadcast the error text of a failure that all ranks know, from a rank that has the text. The
 * others must have an empty text. Returns the status. */
mps_status mps__ranks_text(mps__ranks *r, mps_status status);
/* Collective: all ranks return the worst status of all, with one text. An error must allow the rank
 * to continue. */
mps_status mps__ranks_agree(mps__ranks *r, mps_status status);

/* Combine values of all ranks. */
void mps__ranks_reduce(mps__ranks *r, int32_t count, size_t bytes, void *values,
                       mps_combine_fn combine);
/* Maxima over all ranks; NaN is ignored. */
void mps__ranks_max(mps__ranks *r, int32_t count, double *values);
/* Sums over all ranks. */
void mps__ranks_add(mps__ranks *r, int32_t count, int64_t *values);
/* Exact sums over all ranks. */
void mps__ranks_sum(mps__ranks *r, int32_t count, mps_exact *sums);
/* Collect blocks of all ranks on all ranks; `bytes` [ranks]. */
void mps__ranks_gather(mps__ranks *r, const void *own, const int64_t *bytes, void *all);
/* Replace an allocated list of this rank by the concatenated lists of all ranks. With one rank the
 * list stays. */
mps_status mps__ranks_collect(mps__ranks *r, void **list, int64_t *count, size_t size);
/* Collect blocks of all ranks on rank 0 only. */
void mps__ranks_send_to_first(mps__ranks *r, const void *own, const int64_t *bytes, void *all);
/* Collect a number of each rank, ordered by rank: values [ranks]. */
void mps__ranks_gather_number(mps__ranks *r, int64_t own, int64_t *values);
/* Create a route; none on failure. */
void mps__ranks_connect(mps__ranks *r, int32_t count, const int32_t *to, const int64_t *sent,
                        mps_route *route);
/* Exchange elements along a route. */
void mps__ranks_exchange(mps__ranks *r, const mps_route *route, size_t bytes, const void *out,
                         void *in);

#endif
