/* SPDX-License-Identifier: BSD-3-Clause */
/* Lattice points beside solids, moved such that fluid between wall and lattice has uniform
 * density. */
#ifndef MPS_CORE_PACKING_H
#define MPS_CORE_PACKING_H

#include "solid.h"

typedef struct mps__packing {
    mps__context *context;
    int64_t n[3];    /* points of the lattice */
    int32_t *number; /* [n0*n1*n2] 1 + index of a moved point, 0: not moved */
    double *x;       /* [3*count] */
    int64_t count, capacity;
} mps__packing;

/* Depends only on the solids and the lattice, so that successive fills match. Does nothing without
 * solids. */
mps_status mps__packing_make(mps__packing *p, mps_sim *sim);
void mps__packing_free(mps__packing *p);
/* Write the position of lattice point k to X if it is moved. */
void mps__packing_place(const mps__packing *p, const int64_t k[3], double *X);

#endif
