/* SPDX-License-Identifier: BSD-3-Clause */
/* The threads of a handle, or its host's; what loops of the core share. */
#ifndef MPS_CORE_PARALLEL_H
#define MPS_CORE_PARALLEL_H

#include "base.h"
#include <mps/parallel.h>

enum { MPS__THREADS_MOST = 1024 };

/* The parallel-for that a handle uses. Its address must stay the same: `parallel.user` is the pool
 * itself, and all loops have a pointer to `parallel`. */
typedef struct mps__pool {
    mps_parallel parallel; /* what loops are given */
    mps__context *context;
    bool own;               /* the threads are those of `crew`, not a host's */
    bool tried;             /* there is a crew, or none could be had */
    struct mps__crew *crew; /* threads and what they share; NULL: none yet */
} mps__pool;

/* A pool of one thread. Nothing is allocated and no thread is made before a loop needs it. */
void mps__pool_init(mps__pool *p, mps__context *context);
/* Use the host's parallel-for, or threads of the pool's own where host->run is NULL; host->threads of them if that is above 1. */
mps_status mps__pool_set(mps__pool *p, const mps_parallel *host, const char *what);
/* Another number of threads; those of the pool are joined, and made again when they are needed. */
void mps__pool_resize(mps__pool *p, int32_t threads);
/* Join the threads. The pool may be used again. */
void mps__pool_free(mps__pool *p);

/* Rows of loops that do next to nothing a row: fewer are not worth a second thread. */
enum { MPS__ROWS_CHEAP = 4096 };

/* Numbers that are set to zero together. */
typedef struct mps__block {
    double *values;
    int64_t count;
} mps__block;
void mps__parallel_zero(const mps_parallel *p, const mps__block *blocks, int32_t count);
void mps__parallel_copy(const mps_parallel *p, void *to, const void *from, size_t bytes);

#endif
