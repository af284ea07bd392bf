/* SPDX-License-Identifier: BSD-3-Clause */
/* An OpenCL device, e.g. pocl: runs the kernels of rows.bc. After each loop it runs the host code
 * on a copy and compares all bytes. */
#ifndef OPENCL_H
#define OPENCL_H

#define CL_TARGET_OPENCL_VERSION 200
#include "sim.h"
#include <CL/cl.h>
#include <mps/device.h>

enum { OPENCL_BLOCKS = 512, OPENCL_KERNELS = 512, OPENCL_NAME = 80 };

/* Memory of the device. */
typedef struct opencl_block {
    char *begin;
    size_t bytes;
    char *before, *host; /* copies: before a loop, and after it on the host */
    size_t copied;       /* capacity of the copies [bytes] */
    bool seen;           /* an argument of the loop points into it */
} opencl_block;

typedef struct opencl_kernel {
    char name[OPENCL_NAME];
    cl_kernel kernel; /* NULL: no kernel, the host code runs instead */
    int64_t launches, different;
} opencl_kernel;

typedef struct opencl {
    mps_device_ops ops;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    opencl_block block[OPENCL_BLOCKS], arguments, terms, results;
    opencl_kernel kernel[OPENCL_KERNELS];
    int kernels;
    char difference[400]; /* the first one; empty: none */
    char failure[400];
} opencl;

/* Open the first device of a platform. `bitcode`: path of rows.bc. False: no device, `failure` is
 * the reason. */
bool opencl_open(opencl *o, const char *bitcode);
void opencl_close(opencl *o);
/* Steps of a simulation run on the device from now on. */
void opencl_attach(opencl *o, mps_sim *sim);
/* Whether a loop has a kernel. */
bool opencl_knows(opencl *o, const mps_launch *l);
/* Allocate `count` values of n rows; then reduce them to sums and maxima, as loops do. @return 0, 1
 * after a failure */
double *opencl_terms(opencl *o, int64_t count, int64_t n);
int opencl_join(opencl *o, int64_t n, int32_t sums, mps_exact *sum, int32_t maxima,
                double *maximum);

#endif
