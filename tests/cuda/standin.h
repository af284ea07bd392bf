/* SPDX-License-Identifier: BSD-3-Clause */
/* A driver in place of NVIDIA's, for machines without a GPU: a library libcuda.so.1 whose kernels are run by OpenCL, such as pocl, from rows.bc. */
#ifndef STANDIN_H
#define STANDIN_H

#include <stdbool.h>
#include <stdint.h>

/* Bitcode of the kernels; before the first call. */
void standin_kernels(const char *path);
/* The `visit`-th call from now on of a function, by its name in the driver, fails; visit 0: none. */
void standin_fail(const char *function, int64_t visit);
/* How often a function was called since standin_fail(). */
int64_t standin_visits(const char *function);
/* What the GPU says of itself from now on. */
void standin_facts(int count, int capability, int version);
/* Number of the GPU that was opened last. */
int standin_device(void);
/* Rooms, streams, contexts and modules that were not given back. */
int standin_open(void);

#endif
