/* SPDX-License-Identifier: BSD-3-Clause */
/* sundials.bicgstab: stabilised bi-conjugate gradients, for matrices that a model made
 * unsymmetric. */
#include "builtin.h"
#include "krylov.h"
#include <sunlinsol/sunlinsol_spbcgs.h>

static SUNLinearSolver make(N_Vector like, SUNContext context)
{
    return SUNLinSol_SPBCGS(like, SUN_PREC_NONE, 0, context);
}

static int run(SUNLinearSolver solver, bool preconditioned, int iterations, N_Vector x, N_Vector b,
               double delta)
{
    /* the driver preconditions inside the product: with SUN_PREC_RIGHT an interrupted run would
     * return M x instead of x */
    (void)preconditioned;
    SUNLinSol_SPBCGSSetMaxl(solver, iterations);
    return SUNLinSolSolve(solver, NULL, x, b, delta);
}

static const mps__krylov_kind kind = {false, 7, make, run};

static int create(const mps_allocator *allocator, void **self)
{
    return mps__krylov_create(&kind, allocator, self);
}

const mps_solver_ops mps__solver_bicgstab = {
    .struct_size = sizeof(mps_solver_ops),
    .api = MPS_PPE_API,
    .name = "sundials.bicgstab",
    .preconditioner = "jacobi",
    .symmetric = 0,
    .create = create,
    .solve = mps__krylov_solve,
    .destroy = mps__krylov_destroy,
    .help = "Stabilised bi-conjugate gradients (BiCGSTAB), for any matrix",
};
