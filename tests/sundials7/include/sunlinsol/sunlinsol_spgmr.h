/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNLINSOL_SPGMR_H
#define STUB_SUNLINSOL_SPGMR_H
#include <sundials/sundials_linearsolver.h>
typedef struct stub_spgmr {
    int maxl;
    sunrealtype **Hes;
} * SUNLinearSolverContent_SPGMR;
SUNLinearSolver SUNLinSol_SPGMR(N_Vector y, int preconditioned, int vectors, SUNContext context);
SUNErrCode SUNLinSol_SPGMRSetMaxRestarts(SUNLinearSolver s, int restarts);
#endif
