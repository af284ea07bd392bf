/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNDIALS_CONTEXT_H
#define STUB_SUNDIALS_CONTEXT_H
#include <sundials/sundials_types.h>
enum {
    SUN_ERR_MALLOC_FAIL = -9988,
    SUN_SUCCESS = 0
}; /* SUNLS_SUCCESS, SUNLS_MEM_NULL and SUNLS_ILL_INPUT are removed */
typedef void (*SUNErrHandlerFn)(int line, const char *func, const char *file, const char *msg,
                                SUNErrCode code, void *user, SUNContext context);
SUNErrCode SUNContext_Create(SUNComm comm, SUNContext *context);
SUNErrCode SUNContext_Free(SUNContext *context);
SUNErrCode SUNContext_PushErrHandler(SUNContext context, SUNErrHandlerFn fn, void *user);
SUNErrCode SUNContext_ClearErrHandlers(SUNContext context);
#endif
