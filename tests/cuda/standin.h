/* SPDX-License-Identifier: BSD-3-Clause */
/* A replacement of NVIDIA's driver for machines without a GPU: a library libcuda.so.1 that runs
 * kernels from rows.bc by OpenCL, e.g. pocl. */
#ifndef STANDIN_H
#define STANDIN_H

#include <stdbool.h>
#include <stdint.h>

/* Bitcode of the kernels; before the first call. */
void standin_kernels(const char *path);
/* The `visit`-th call from now on of a function, by its name in the driver, fails; visit 0:
 * none. */
void standin_fail(const char *function, int64_t visit);
/* How often a function was called since standin_fail(). */
int64_t standin_visits(const char *function);
/* Set the properties that the GPU reports from now on. */
void standin_facts(int count, int capability, int version);
/* Number of the GPU that was opened last. */
int standin_device(void);
/* Allocations, streams, contexts and modules that were not freed. */
int standin_open(void);

#endif
