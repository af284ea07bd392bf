/* SPDX-License-Identifier: BSD-3-Clause */
/* Minimum and maximum density of the fluid of each phase. No call of a step changes densities, so a
 * rank recomputes them only after its particles changed, and the ranks reduce them once a step. */
#ifndef MPS_CORE_DENSITIES_H
#define MPS_CORE_DENSITIES_H

#include "ghosts.h"

typedef struct mps__densities {
    double least[MPS__PHASES], greatest[MPS__PHASES]; /* of all ranks; 0: no fluid of that phase */
    double most[2 * MPS__PHASES]; /* of this rank: -least, greatest; -INFINITY without fluid */
    /* of the particles when this rank computed `most`: versions of three fields; -1: never */
    int64_t versions, generation;
    bool agreed; /* the values are reduced over all ranks */
} mps__densities;

/* Compute the values of all ranks (collective). */
void mps__densities_find(mps__densities *d, const mps__particles *s, const mps__ghosts *g);

#endif
