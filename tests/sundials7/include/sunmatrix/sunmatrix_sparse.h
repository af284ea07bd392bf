/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNMATRIX_SPARSE_H
#define STUB_SUNMATRIX_SPARSE_H
#include <sundials/sundials_matrix.h>
#define CSC_MAT 0
#define CSR_MAT 1
SUNMatrix SUNSparseMatrix(sunindextype m, sunindextype n, sunindextype entries, int type,
                          SUNContext context);
sunrealtype *SUNSparseMatrix_Data(SUNMatrix a);
sunindextype *SUNSparseMatrix_IndexValues(SUNMatrix a);
sunindextype *SUNSparseMatrix_IndexPointers(SUNMatrix a);
#endif
