/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef STUB_SUNDIALS_NVECTOR_H
#define STUB_SUNDIALS_NVECTOR_H
#include <sundials/sundials_context.h>
typedef enum { SUNDIALS_NVEC_SERIAL, SUNDIALS_NVEC_CUSTOM } N_Vector_ID;
typedef struct stub_vector *N_Vector;
typedef struct stub_vector_ops {
    N_Vector_ID (*nvgetvectorid)(N_Vector);
    N_Vector (*nvclone)(N_Vector);
    void (*nvdestroy)(N_Vector);
    sunrealtype *(*nvgetarraypointer)(N_Vector);
    sunindextype (*nvgetlength)(N_Vector);
    void (*nvlinearsum)(sunrealtype, N_Vector, sunrealtype, N_Vector, N_Vector);
    void (*nvconst)(sunrealtype, N_Vector);
    void (*nvprod)(N_Vector, N_Vector, N_Vector);
    void (*nvdiv)(N_Vector, N_Vector, N_Vector);
    void (*nvscale)(sunrealtype, N_Vector, N_Vector);
    void (*nvabs)(N_Vector, N_Vector);
    void (*nvinv)(N_Vector, N_Vector);
    sunrealtype (*nvdotprod)(N_Vector, N_Vector);
    sunrealtype (*nvmaxnorm)(N_Vector);
    sunrealtype (*nvmin)(N_Vector);
    sunrealtype (*nvwl2norm)(N_Vector, N_Vector);
} * N_Vector_Ops;
struct stub_vector {
    void *content;
    N_Vector_Ops ops;
    SUNContext sunctx;
};
N_Vector N_VNewEmpty(SUNContext context);
void N_VFreeEmpty(N_Vector v);
void N_VDestroy(N_Vector v);
#endif
