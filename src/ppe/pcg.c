/* SPDX-License-Identifier: BSD-3-Clause */
/* sundials.pcg: preconditioned conjugate gradients, the default solver. */
#include "builtin.h"
#include "krylov.h"
#include <sunlinsol/sunlinsol_pcg.h>

static SUNLinearSolver make(N_Vector like, SUNContext context)
{
    return SUNLinSol_PCG(like, SUN_PREC_NONE, 0, context);
}

static int run(SUNLinearSolver solver, bool preconditioned, int iterations, N_Vector x, N_Vector b,
               double delta)
{
    SUNLinSol_PCGSetPrecType(solver, preconditioned ? SUN_PREC_LEFT : SUN_PREC_NONE);
    SUNLinSol_PCGSetMaxl(solver, iterations);
    return SUNLinSolSolve(solver, NULL, x, b, delta);
}

static const mps__krylov_kind kind = {true, 4, make, run};

static int create(const mps_allocator *allocator, void **self)
{
    return mps__krylov_create(&kind, allocator, self);
}

const mps_solver_ops mps__solver_pcg = {
    .struct_size = sizeof(mps_solver_ops),
    .api = MPS_PPE_API,
    .name = "sundials.pcg",
    .preconditioner = "auxgrid",
    .symmetric = 1,
    .create = create,
    .solve = mps__krylov_solve,
    .destroy = mps__krylov_destroy,
    .help = "Preconditioned conjugate gradients, for symmetric matrices",
    .ranks = 1,
    .device = 1,
    .hint = 1,
    .release_device = mps__krylov_release_device,
};
