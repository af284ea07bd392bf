/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_KINSOL_H
#define STUB_KINSOL_H
#include <sundials/sundials_linearsolver.h>
/* KINSetErrFile and KINSetErrHandlerFn are removed: errors go to the handlers of the context */
enum { KIN_NONE = 0, KIN_ETACHOICE1 = 1, KIN_ETACHOICE2 = 2, KIN_ETACONSTANT = 3 };
enum {
    KIN_MEM_FAIL = -4,
    KIN_MAXITER_REACHED = -6,
    KIN_MXNEWT_5X_EXCEEDED = -7,
    KIN_LINSOLV_NO_RECOVERY = -9,
    KIN_LSETUP_FAIL = -11,
    KIN_LSOLVE_FAIL = -12
};
typedef int (*KINSysFn)(N_Vector u, N_Vector f, void *user);
typedef int (*KINLsJacTimesVecFn)(N_Vector v, N_Vector jv, N_Vector u, sunbooleantype *changed,
                                  void *user);
typedef int (*KINLsPrecSetupFn)(N_Vector u, N_Vector u_scale, N_Vector f, N_Vector f_scale,
                                void *user);
typedef int (*KINLsPrecSolveFn)(N_Vector u, N_Vector u_scale, N_Vector f, N_Vector f_scale,
                                N_Vector v, void *user);
void *KINCreate(SUNContext context);
int KINInit(void *kinsol, KINSysFn fn, N_Vector like);
int KINSol(void *kinsol, N_Vector u, int strategy, N_Vector u_scale, N_Vector f_scale);
void KINFree(void **kinsol);
int KINSetUserData(void *kinsol, void *user);
int KINSetEtaForm(void *kinsol, int choice);
int KINSetEtaConstValue(void *kinsol, sunrealtype eta);
int KINSetFuncNormTol(void *kinsol, sunrealtype tolerance);
int KINSetScaledStepTol(void *kinsol, sunrealtype tolerance);
int KINSetMaxNewtonStep(void *kinsol, sunrealtype step);
int KINSetMaxSetupCalls(void *kinsol, long int calls);
int KINSetNumMaxIters(void *kinsol, long int iterations);
int KINSetLinearSolver(void *kinsol, SUNLinearSolver s, SUNMatrix a);
int KINSetPreconditioner(void *kinsol, KINLsPrecSetupFn setup, KINLsPrecSolveFn solve);
int KINSetJacTimesVecFn(void *kinsol, KINLsJacTimesVecFn fn);
int KINGetNumLinIters(void *kinsol, long int *iterations);
#endif
