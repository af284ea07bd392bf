/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNDIALS_TYPES_H
#define STUB_SUNDIALS_TYPES_H
#include <stdint.h>
#include <sundials/sundials_config.h>
typedef double sunrealtype; /* realtype is removed */
typedef int64_t sunindextype;
typedef int SUNErrCode, SUNComm;
#define sunbooleantype int /* booleantype is removed */
#define SUNFALSE       0
#define SUNTRUE        1
#define SUN_COMM_NULL  0 /* a number, no pointer */
typedef struct stub_context *SUNContext;
#endif
