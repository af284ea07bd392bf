/* SPDX-License-Identifier: BSD-3-Clause */
/* sundials.gmres: restarted GMRES, for matrices that a model made unsymmetric. */
#include "builtin.h"
#include "krylov.h"
#include <sunlinsol/sunlinsol_spgmr.h>

enum { CYCLE = 30 }; /* iterations between restarts = vectors kept */

static SUNLinearSolver make(N_Vector like, SUNContext context)
{
    return SUNLinSol_SPGMR(like, SUN_PREC_NONE, CYCLE, context);
}

static int run(SUNLinearSolver solver, bool preconditioned, int iterations, N_Vector x, N_Vector b, double delta)
{
    /* the driver preconditions inside the product */
    (void)preconditioned;
    int *cycle = &((SUNLinearSolverContent_SPGMR)solver->content)->maxl;
    /* whole cycles first; the driver comes back for the rest. The length must be restored: memory is freed by it */
    if (iterations < CYCLE) *cycle = iterations;
    SUNLinSol_SPGMRSetMaxRestarts(solver, iterations < CYCLE ? 0 : iterations / CYCLE - 1);
    int flag = SUNLinSolSolve(solver, NULL, x, b, delta);
    *cycle = CYCLE;
    return flag;
}

static const mps__krylov_kind kind = {false, CYCLE + 3, make, run};

static int create(const mps_allocator *allocator, void **self)
{
    return mps__krylov_create(&kind, allocator, self);
}

const mps_solver_ops mps__solver_gmres = {
    .struct_size = sizeof(mps_solver_ops),
    .api = MPS_PPE_API,
    .name = "sundials.gmres",
    .preconditioner = "jacobi",
    .symmetric = 0,
    .create = create,
    .solve = mps__krylov_solve,
    .destroy = mps__krylov_destroy,
    .help = "Generalised minimal residual (GMRES), for any matrix",
};
