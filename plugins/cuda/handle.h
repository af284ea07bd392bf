/* SPDX-License-Identifier: BSD-3-Clause */
/* GPU state of a handle: a stream, memory, the kernels used so far. Calls come from one thread at a
 * time. */
#ifndef MPS_CUDA_HANDLE_H
#define MPS_CUDA_HANDLE_H

#include "driver.h"
#include "launch.h"
#include <mps/cuda.h>

enum { CUDA_KERNELS = 1024, CUDA_NAME = 96 };

/* A buffer on the GPU. Released buffers are reused: allocation by the driver is slow and waits for
 * the GPU. */
typedef struct cuda_block {
    cuda_address begin;
    size_t bytes;
    bool used;
} cuda_block;

typedef struct cuda_kernel {
    char name[CUDA_NAME]; /* empty: none */
    cuda_handle kernel;
} cuda_kernel;

typedef struct cuda {
    mps_device_ops ops;
    int number;
    bool *ended;   /* NULL, or set when the handle is destroyed */
    cuda_gpu *gpu; /* NULL: not initialised */
    const cuda_driver *driver;
    cuda_handle stream;
    cuda_block *block;
    size_t blocks, block_capacity;
    cuda_block terms, results, arguments; /* of sums and maxima; of kernels with large arguments */
    cuda_kernel kernel[CUDA_KERNELS];     /* hash table by name */
    cuda_text text;                       /* text of the last failure */
} cuda;

/* ---- functions of the table that need memory only (memory.c) ---- */
int cuda_begin(void *self);
void cuda_end(void *self);
void *cuda_take(void *self, uint64_t bytes);
void cuda_free(void *self, void *block);
int cuda_upload(void *self, void *to, const void *from, uint64_t bytes);
int cuda_download(void *self, void *to, const void *from, uint64_t bytes);
int cuda_clear(void *self, void *to, uint64_t bytes);
int cuda_copy(void *self, void *to, const void *from, uint64_t bytes);
int cuda_wait(void *self);
/* ---- functions of the table that run loops (launch.c) ---- */
int cuda_rows(void *self, const mps_launch *launch);
int cuda_values(void *self, const mps_launch *launch, mps_exact *sum, double *maximum);
int cuda_reduce_async(void *self, const mps_launch *launch, void *to);

/* Make the GPU's context current in this thread, until cuda_exit(). @return 0, or 1 with the
 * text */
int cuda_enter(cuda *c);
void cuda_exit(cuda *c);
/* Grow a buffer of the handle to at least `bytes`; its values are lost. @return 0, or 1 with the
 * text. Call it inside the context. */
int cuda_fit(cuda *c, cuda_block *block, size_t bytes);

#endif
