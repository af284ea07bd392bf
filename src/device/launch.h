/* SPDX-License-Identifier: BSD-3-Clause */
/* Arguments of kernels, for engines and kernels. Numbers have 8 bytes, so that all compilers agree
 * on the layout.
 *
 * A kernel of a loop gets mps__launch, then the view (loops of models only), then the fields: one
 * struct without gaps. An engine finds it by the name of the loop and runs it in groups of
 * MPS__LAUNCH_GROUP threads: the kernel of "gas.c:shrink_rows" in 3-D is mpsk_gas__shrink_rows_3,
 * or mpsk_gas__shrink_rows if it is the same for both dimensions. */
#ifndef MPS_DEVICE_LAUNCH_H
#define MPS_DEVICE_LAUNCH_H

#include <mps/exact.h>

/* Kernels for NVIDIA take arguments of more bytes by the address of a copy in device memory.
 * Kernels for OpenCL always do. */
enum { MPS__LAUNCH_BY_VALUE = 4096 };

typedef struct mps__launch {
    int64_t n;             /* rows; threads beyond do nothing */
    int64_t count;         /* number of values of a row: sums, then maxima */
    double first;          /* initial value of MPS_SUMS() */
    double *terms;         /* [count * n] out: value k of row i is terms[k * n + i] */
    const int64_t *cancel; /* that of the launch */
    const uint8_t *mask;   /* that of the launch */
} mps__launch;

/* Threads in a group. */
enum { MPS__LAUNCH_GROUP = 128 };

/* Terms of rows are reduced to sums or maxima in two launches: `parts` groups of threads reduce the
 * terms of each value, then one group reduces their results. */

typedef struct mps__launch_join {
    int64_t n;             /* terms of a value, or results of groups */
    int64_t parts;         /* groups of a value */
    const double *terms;   /* [values * n] of mpsk_sums__add, mpsk_sums__raise */
    mps_exact *sums;       /* [values * n] of mpsk_sums__join */
    void *out;             /* [values * parts] sums, or maxima */
    const int64_t *cancel; /* that of the launch */
} mps__launch_join;

#endif
