/* SPDX-License-Identifier: BSD-3-Clause */
/* Arguments of kernels, for an engine and for the kernels. Numbers are of 8 bytes, so that all compilers agree where they stand.
 *
 * A kernel of a loop gets mps__launch, then the view (loops of models alone), then the fields: one struct without gaps. Engines find it by the name of
 * the loop, and runs it in groups of MPS__LAUNCH_GROUP threads: that of "gas.c:shrink_rows" in 3-D is mpsk_gas__shrink_rows_3, or mpsk_gas__shrink_rows if it is the same for both dimensions. */
#ifndef MPS_DEVICE_LAUNCH_H
#define MPS_DEVICE_LAUNCH_H

#include <mps/exact.h>

/* Kernels for NVIDIA take more bytes than these by address: that of a copy in the memory of the device. Those for OpenCL always do. */
enum { MPS__LAUNCH_BY_VALUE = 4096 };

typedef struct mps__launch {
    int64_t n;             /* rows; threads beyond do nothing */
    int64_t count;         /* of values of a row: sums, then maxima */
    double first;          /* what the values of MPS_SUMS() begin with */
    double *terms;         /* [count * n] out: value k of row i is terms[k * n + i] */
    const int64_t *unless; /* that of the launch */
    const uint8_t *skip;   /* likewise */
} mps__launch;

/* Threads of a group. */
enum { MPS__LAUNCH_GROUP = 128 };

/* The terms of rows become sums (or maxima) in two launches: `parts` groups of threads join the terms of each value, then one group their results. */

typedef struct mps__launch_join {
    int64_t n;             /* terms of a value, or results of groups */
    int64_t parts;         /* groups of a value */
    const double *terms;   /* [values * n] of mpsk_sums__add, mpsk_sums__raise */
    mps_exact *sums;       /* [values * n] of mpsk_sums__join */
    void *out;             /* [values * parts] sums, or maxima */
    const int64_t *unless; /* that of the launch */
} mps__launch_join;

#endif
