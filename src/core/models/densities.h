/* SPDX-License-Identifier: BSD-3-Clause */
/* Least and greatest density of the fluid of each phase. No call of a step changes densities, so a rank looks at its particles only when these are
 * others, and ranks ask each other once in a step. */
#ifndef MPS_CORE_DENSITIES_H
#define MPS_CORE_DENSITIES_H

#include "ghosts.h"

typedef struct mps__densities {
    double least[MPS__PHASES], greatest[MPS__PHASES]; /* of all ranks; 0: no fluid of that phase */
    double most[2 * MPS__PHASES]; /* of this rank: -least, greatest; -INFINITY without fluid */
    int64_t changes, generation;  /* those of the particles when this rank looked; -1: never */
    bool agreed;                  /* the values of all ranks are there */
} mps__densities;

/* Find the values of all ranks, which all ask. */
void mps__densities_find(mps__densities *d, const mps__particles *s, const mps__ghosts *g);
/* The particles of this rank alone have the densities that they had, perhaps in another order;
 * `changes`: those of the particles before. */
void mps__densities_kept(mps__densities *d, const mps__particles *s, int64_t changes);

#endif
