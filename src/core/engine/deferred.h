/* SPDX-License-Identifier: BSD-3-Clause */
/* Deferred reductions: sums and maxima of loops whose values are not needed yet. A device keeps
 * them until one copy transfers all, with sums rounded on the device; the callbacks then run in the
 * order of the loops. On the host they run at once. */
#ifndef MPS_CORE_DEFERRED_H
#define MPS_CORE_DEFERRED_H

#include "reaction.h"
#include <mps/parallel.h>

/* Limits: loops, and sums or maxima of all loops. */
enum { MPS__DEFERRED = 48, MPS__DEFERRED_VALUES = MPS__DEFERRED * MPS_PARALLEL_VALUES };

/* Device buffer of the results; `value`: maxima, then rounded sums, then one further number for the
 * host. */
typedef struct mps__results {
    mps_exact sum[MPS__DEFERRED_VALUES];
    mps_exact reaction[MPS__REACTIONS][6]; /* as mps__reactions.sum; valid if reactions.on_device */
    mps_exact reported[MPS__REACTIONS][6]; /* of the verb in progress */
    double value[2 * MPS__DEFERRED_VALUES + 1];
} mps__results;

/* Callback for the values; a maximum over no row is -INFINITY. */
typedef struct mps__then {
    void (*run)(void *owner, const double *values);
    void *owner;
} mps__then;

typedef struct mps__deferred {
    mps__then then;
    int32_t sums, maxima; /* one of them is 0 */
    int32_t at;           /* offset of the first one in those of all loops */
} mps__deferred;

typedef struct mps__deferred_list {
    int32_t count, sums, maxima;
    mps__deferred list[MPS__DEFERRED];
} mps__deferred_list;

#endif
