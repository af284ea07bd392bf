/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNLINSOL_PCG_H
#define STUB_SUNLINSOL_PCG_H
#include <sundials/sundials_linearsolver.h>
SUNLinearSolver SUNLinSol_PCG(N_Vector y, int preconditioned, int iterations, SUNContext context);
SUNErrCode SUNLinSol_PCGSetPrecType(SUNLinearSolver s, int preconditioned);
SUNErrCode SUNLinSol_PCGSetMaxl(SUNLinearSolver s, int iterations);
#endif
