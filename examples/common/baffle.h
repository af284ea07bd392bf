/* SPDX-License-Identifier: BSD-3-Clause */
/* A vertical baffle across a tank. */
#ifndef MPS_EXAMPLES_BAFFLE_H
#define MPS_EXAMPLES_BAFFLE_H

#include "run.h"

/* A baffle as it is described [m]; in 3-D it reaches from wall to wall. */
typedef struct baffle {
    double middle, thickness; /* along x */
    double bottom, top;       /* along y */
} baffle;

/* Add it in whole columns of the lattice, as near to its place as they are: options.layers of them, or as its thickness says. */
void baffle_add(run *r, const baffle *b, double width);

#endif
