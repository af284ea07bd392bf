/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients on a device: the operations of krylov.c and of SUNLinSol_PCG, as krylov.c
 * uses it, in the same order, so with the same bytes. Their numbers stay on the device; the host
 * waits once every MPS__CG_AT_ONCE iterations and once before the set-up of a preconditioner. */
#ifndef MPS_PPE_CG_H
#define MPS_PPE_CG_H

#include "builtin.h"
#include "vectors.h"

enum { MPS__CG_AT_ONCE = 8, MPS__CG_ARRAYS = 3 };

/* One solution; arrays [n] and `workspace` are on the device of the problem's parallel-for. */
typedef struct mps__cg {
    const mps_ppe_problem *problem;
    const mps_preconditioner_ops *pc; /* NULL: none */
    void *pc_self;
    void *workspace;               /* [mps__cg_bytes()] bytes */
    double *p;                     /* first guess and solution */
    double *start;                 /* workspace: the first guess */
    double *x, *r;                 /* correction and residual */
    double *array[MPS__CG_ARRAYS]; /* workspace */
} mps__cg;

size_t mps__cg_bytes(void);
/* Solve A p = rhs, to the limits of the problem. Returns a reason; `result` has the numbers. */
int mps__cg_solve(const mps__cg *c, mps_ppe_result *result);

#endif
