/* SPDX-License-Identifier: BSD-3-Clause */
/* The one place that knows which SUNDIALS this is: 6.x (Debian has 6.4.1) or 7.x. */
#ifndef MPS_PPE_SUNDIALS_COMPAT_H
#define MPS_PPE_SUNDIALS_COMPAT_H

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

/* What a linear solver returns when it has converged: SUNLS_SUCCESS until 6.x. */
#if SUNDIALS_VERSION_MAJOR >= 7
enum { MPS__SUNDIALS_SUCCESS = SUN_SUCCESS };
#else
enum { MPS__SUNDIALS_SUCCESS = SUNLS_SUCCESS };
#endif

/* A context without MPI that never prints, or NULL. */
static inline SUNContext mps__sundials_context(void)
{
    SUNContext context = NULL;
#if SUNDIALS_VERSION_MAJOR >= 7
    if (SUNContext_Create(SUN_COMM_NULL, &context)) return NULL;
    SUNContext_ClearErrHandlers(context); /* the default handler writes to stderr */
#else
    if (SUNContext_Create(NULL, &context)) return NULL;
#endif
    return context;
}

/* KINSOL's memory; it never prints either. NULL when memory is out. */
static inline void *mps__kinsol_create(SUNContext context)
{
    void *kinsol = KINCreate(context);
#if SUNDIALS_VERSION_MAJOR < 7
    if (kinsol && KINSetErrFile(kinsol, NULL)) KINFree(&kinsol);
#endif
    return kinsol;
}

#endif
