/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNDIALS_LINEARSOLVER_H
#define STUB_SUNDIALS_LINEARSOLVER_H
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>
enum { SUN_PREC_NONE, SUN_PREC_LEFT, SUN_PREC_RIGHT, SUN_PREC_BOTH }; /* without PREC_NONE etc. */
#define SUNLS_RES_REDUCED 801
#define SUNLS_CONV_FAIL   802
typedef struct stub_solver {
    void *content;
} * SUNLinearSolver;
typedef int (*SUNATimesFn)(void *data, N_Vector v, N_Vector z);
typedef int (*SUNPSetupFn)(void *data);
typedef int (*SUNPSolveFn)(void *data, N_Vector r, N_Vector z, sunrealtype tolerance, int side);
SUNErrCode SUNLinSolSetATimes(SUNLinearSolver s, void *data, SUNATimesFn fn);
SUNErrCode SUNLinSolSetPreconditioner(SUNLinearSolver s, void *data, SUNPSetupFn setup,
                                      SUNPSolveFn solve);
SUNErrCode SUNLinSolSetScalingVectors(SUNLinearSolver s, N_Vector s1, N_Vector s2);
SUNErrCode SUNLinSolSetZeroGuess(SUNLinearSolver s, sunbooleantype on);
SUNErrCode SUNLinSolInitialize(SUNLinearSolver s);
int SUNLinSolSetup(SUNLinearSolver s, SUNMatrix a);
int SUNLinSolSolve(SUNLinearSolver s, SUNMatrix a, N_Vector x, N_Vector b, sunrealtype tolerance);
int SUNLinSolNumIters(SUNLinearSolver s);
SUNErrCode SUNLinSolFree(SUNLinearSolver s);
#endif
