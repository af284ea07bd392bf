/* SPDX-License-Identifier: BSD-3-Clause */
/* Common part of the iterative SUNDIALS solvers: correction passes until the true residual meets
 * both limits. */
#ifndef MPS_PPE_KRYLOV_H
#define MPS_PPE_KRYLOV_H

#include "builtin.h"
#include "vector.h"

/* Properties of one method. */
typedef struct mps__krylov_kind {
    /* 1: conjugate gradients: it preconditions itself, uses the stopping vector, needs positive
     * curvature */
    bool symmetric;
    int vectors; /* number of clones that `make` and the first run need */
    SUNLinearSolver (*make)(N_Vector like, SUNContext context);
    /* Solve for x from zero until the residual is at most delta or `iterations` are used. */
    int (*run)(SUNLinearSolver solver, bool preconditioned, int iterations, N_Vector x, N_Vector b,
               double delta);
} mps__krylov_kind;

int mps__krylov_create(const mps__krylov_kind *kind, const mps_allocator *allocator, void **self);
void mps__krylov_solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                       void *pc_self, double *p, mps_ppe_result *result);
/* Free device memory. */
void mps__krylov_release_device(void *self);
void mps__krylov_destroy(const mps_allocator *allocator, void *self);

#endif
