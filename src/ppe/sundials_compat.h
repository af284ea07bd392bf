/* SPDX-License-Identifier: BSD-3-Clause */
/* The only place that depends on the version of SUNDIALS: 6.x (Debian has 6.4.1) or 7.x. */
#ifndef MPS_PPE_SUNDIALS_COMPAT_H
#define MPS_PPE_SUNDIALS_COMPAT_H

#include "base.h"
#include <kinsol/kinsol.h>
#include <stddef.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>

#if SUNDIALS_VERSION_MAJOR < 6
#error "libmps needs SUNDIALS 6 or 7"
#endif
#ifndef SUNDIALS_DOUBLE_PRECISION
#error "libmps needs SUNDIALS in double precision"
#endif

/* Return value of a converged linear solver: SUNLS_SUCCESS until 6.x. */
#if SUNDIALS_VERSION_MAJOR >= 7
enum { MPS__SUNDIALS_SUCCESS = SUN_SUCCESS };
#else
enum { MPS__SUNDIALS_SUCCESS = SUNLS_SUCCESS };
#endif

/* Log an error. The usual ends of an iteration are no errors: the reason of the result states
 * them. */
static inline void mps__sundials_report(mps__context *log, int code, const char *function,
                                        const char *text)
{
    if (!log || code >= 0 || code == KIN_MAXITER_REACHED || code == KIN_MXNEWT_5X_EXCEEDED ||
        code == KIN_LINSOLV_NO_RECOVERY || code == KIN_LSETUP_FAIL || code == KIN_LSOLVE_FAIL)
        return;
    mps__log(log, MPS_LOG_WARNING, "SUNDIALS, %s, error %d: %s", function ? function : "?", code,
             text ? text : "?");
}

#if SUNDIALS_VERSION_MAJOR >= 7
static inline void mps__sundials_error(int line, const char *function, const char *file,
                                       const char *text, SUNErrCode code, void *log,
                                       SUNContext context)
{
    (void)line, (void)file, (void)context;
    mps__sundials_report(log, code, function, text);
}
#else
static inline void mps__sundials_error(int code, const char *module, const char *function,
                                       char *text, void *log)
{
    (void)module;
    mps__sundials_report(log, code, function, text);
}
#endif

/* A context without MPI that does not print, or NULL. */
static inline SUNContext mps__sundials_context(mps__context *log)
{
    SUNContext context = NULL;
#if SUNDIALS_VERSION_MAJOR >= 7
    if (SUNContext_Create(SUN_COMM_NULL, &context)) return NULL;
    SUNContext_ClearErrHandlers(context); /* the default handler writes to stderr */
    if (SUNContext_PushErrHandler(context, mps__sundials_error, log)) SUNContext_Free(&context);
#else
    (void)log; /* errors are those of KINSOL, which has its own handler */
    if (SUNContext_Create(NULL, &context)) return NULL;
#endif
    return context;
}

/* KINSOL's memory, without printing. NULL: out of memory. */
static inline void *mps__kinsol_create(SUNContext context, mps__context *log)
{
    void *kinsol = KINCreate(context);
#if SUNDIALS_VERSION_MAJOR < 7
    if (kinsol &&
        (KINSetErrFile(kinsol, NULL) || KINSetErrHandlerFn(kinsol, mps__sundials_error, log)))
        KINFree(&kinsol);
#else
    (void)log;
#endif
    return kinsol;
}

#endif
