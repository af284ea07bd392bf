/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNLINSOL_KLU_H
#define STUB_SUNLINSOL_KLU_H
#include <sundials/sundials_linearsolver.h>
#define KLU_OUT_OF_MEMORY (-2)
typedef struct stub_klu {
    int status;
} sun_klu_common;
SUNLinearSolver SUNLinSol_KLU(N_Vector y, SUNMatrix a, SUNContext context);
SUNErrCode SUNLinSol_KLUSetOrdering(SUNLinearSolver s, int ordering);
sun_klu_common *SUNLinSol_KLUGetCommon(SUNLinearSolver s);
#endif
