/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNDIALS_MATRIX_H
#define STUB_SUNDIALS_MATRIX_H
#include <sundials/sundials_context.h>
typedef struct stub_matrix *SUNMatrix;
void SUNMatDestroy(SUNMatrix a);
#endif
