/* SPDX-License-Identifier: BSD-3-Clause */
/* sundials.gmres: restarted GMRES, for matrices that a model made unsymmetric. */
#include "builtin.h"
#include "krylov.h"
#include <stdlib.h>
#include <sunlinsol/sunlinsol_spgmr.h>

enum { CYCLE = 30 }; /* iterations between restarts = number of stored vectors */

/* Allocates the rows of the Hessenberg matrix, which SUNLinSolInitialize() would allocate
 * otherwise. If memory runs out there, it leaves invalid pointers, at which SUNLinSolFree() crashes
 * (SUNDIALS 6.4.1 to 7.5). SUNDIALS frees the rows with free(). */
static bool make_rows(SUNLinearSolverContent_SPGMR content)
{
    content->Hes = calloc(CYCLE + 1, sizeof *content->Hes);
    for (int k = 0; content->Hes && k <= CYCLE; k++) {
        content->Hes[k] = malloc(CYCLE * sizeof **content->Hes);
        if (!content->Hes[k]) return false;
    }
    return content->Hes != NULL;
}

static SUNLinearSolver make(N_Vector like, SUNContext context)
{
    SUNLinearSolver solver = SUNLinSol_SPGMR(like, SUN_PREC_NONE, CYCLE, context);
    if (solver && make_rows(solver->content)) return solver;
    if (solver) SUNLinSolFree(solver);
    return NULL;
}

static int run(SUNLinearSolver solver, bool preconditioned, int iterations, N_Vector x, N_Vector b,
               double delta)
{
    /* the driver preconditions inside the product */
    (void)preconditioned;
    int *cycle = &((SUNLinearSolverContent_SPGMR)solver->content)->maxl;
    /* Run whole cycles first; the driver calls again for the rest. The length must be restored: it
     * determines how much memory is freed. */
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
