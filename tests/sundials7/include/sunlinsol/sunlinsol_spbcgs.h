/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNLINSOL_SPBCGS_H
#define STUB_SUNLINSOL_SPBCGS_H
#include <sundials/sundials_linearsolver.h>
SUNLinearSolver SUNLinSol_SPBCGS(N_Vector y, int preconditioned, int iterations,
                                 SUNContext context);
SUNErrCode SUNLinSol_SPBCGSSetMaxl(SUNLinearSolver s, int iterations);
#endif
