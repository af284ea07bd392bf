/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums and maxima of loops that nothing waits for yet. On a device they stay there until all of them come in one copy, and what was to be done with
 * each is done in the order of the loops; on the host it is done at once. */
#ifndef MPS_CORE_LATER_H
#define MPS_CORE_LATER_H

#include <mps/parallel.h>
#include <mps/exact.h>
#include <stddef.h>

enum { MPS__LATERS = 48, MPS__LATER_ROOM = MPS__LATERS * 16 * (int)sizeof(mps_exact) };

/* What is done with the values; a maximum is -INFINITY where no row has one. */
typedef struct mps__then {
    void (*run)(void *owner, const double *values);
    void *owner;
} mps__then;

/* The same of sums that are to be joined with others. */
typedef struct mps__joins {
    void (*run)(void *owner, int32_t number, const mps_exact *sums); /* NULL: there are values */
    void *owner;
    int32_t number;
} mps__joins;

typedef struct mps__later {
    mps__then then;
    mps__joins joins;
    int32_t sums, maxima;
    size_t at; /* of its values among those of all */
} mps__later;

typedef struct mps__laters {
    int32_t count;
    size_t used; /* bytes */
    mps__later list[MPS__LATERS];
} mps__laters;

#endif
