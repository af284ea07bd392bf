/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients on a device: the operations of SUNLinSol_PCG as krylov.c uses it, in its order, so the same bytes. Its numbers stay on the
 * device, and the host waits once in MPS__CG_AT_ONCE iterations. */
#ifndef MPS_PPE_CG_H
#define MPS_PPE_CG_H

#include "vectors.h"

enum { MPS__CG_AT_ONCE = 8, MPS__CG_ARRAYS = 3 };

/* One run; arrays [n] and `room` are on the device of the problem's parallel-for. */
typedef struct mps__cg {
    const mps_ppe_problem *problem;
    const mps_preconditioner_ops *pc; /* NULL: none */
    void *pc_self;
    void *room;                    /* [mps__cg_room()] bytes */
    double *x;                     /* out: the solution */
    double *r;                     /* right side; out: what is left of it */
    double *array[MPS__CG_ARRAYS]; /* scratch */
    const double *weight;          /* NULL: divergence not asked */
    double norm_limit, divergence_limit;
    double delta; /* it stops where the residual is at most that many times above its limits */
    int32_t most; /* iterations, > 0 */
    int32_t used; /* out: iterations */
} mps__cg;

size_t mps__cg_room(void);
/* Solve A x = r from x = 0, which the array must hold. Returns 0, or the reason that stopped it before its time. */
int mps__cg_run(mps__cg *c);

#endif
