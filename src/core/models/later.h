/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums and maxima of loops that nothing waits for yet. On a device they stay there until all of them come in one copy, the sums rounded there, and
 * what was to be done with each is done in the order of the loops; on the host it is done at once. */
#ifndef MPS_CORE_LATER_H
#define MPS_CORE_LATER_H

#include "reaction.h"
#include <mps/parallel.h>

/* So many loops, and so many sums or maxima of all of them. */
enum { MPS__LATERS = 48, MPS__LATER_VALUES = MPS__LATERS * MPS_PARALLEL_VALUES };

/* What a device has of them; `value`: maxima, then rounded sums, then a number that the host wants too. */
typedef struct mps__results {
    mps_exact sum[MPS__LATER_VALUES];
    mps_exact reaction[MPS__REACTIONS][6]; /* as mps__reactions.sum; where reactions.there */
    mps_exact reported[MPS__REACTIONS][6]; /* of the verb in progress */
    double value[2 * MPS__LATER_VALUES + 1];
} mps__results;

/* What is done with the values; a maximum is -INFINITY where no row has one. */
typedef struct mps__then {
    void (*run)(void *owner, const double *values);
    void *owner;
} mps__then;

typedef struct mps__later {
    mps__then then;
    int32_t sums, maxima; /* one of them is 0 */
    int32_t at;           /* of the first among those of all */
} mps__later;

typedef struct mps__laters {
    int32_t count, sums, maxima;
    mps__later list[MPS__LATERS];
} mps__laters;

#endif
