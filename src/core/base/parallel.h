/* SPDX-License-Identifier: BSD-3-Clause */
/* Threads of a handle or of the application; helpers of the loops of the core. */
#ifndef MPS_CORE_PARALLEL_H
#define MPS_CORE_PARALLEL_H

#include "base.h"
#include <mps/parallel.h>

enum { MPS__THREADS_MOST = 1024 };

/* Parallel-for of a handle. Its address must not change: `parallel.user` points to the pool, and
 * all loops point to `parallel`. */
typedef struct mps__pool {
    mps_parallel parallel; /* passed to loops */
    mps__context *context;
    bool own;               /* threads of `crew`, not of the application */
    bool tried;             /* the crew exists, or could not be created */
    struct mps__crew *crew; /* threads and their shared state; NULL: not created yet */
} mps__pool;

/* Initialise a pool of one thread. Memory and threads are created when a loop needs them. */
void mps__pool_init(mps__pool *p, mps__context *context);
/* Use the application's parallel-for; if host->run is NULL use threads of the pool, host->threads
 * of them if that is above 1. */
mps_status mps__pool_set(mps__pool *p, const mps_parallel *host, const char *what);
/* Set the number of threads; the pool joins its threads and creates them again when needed. */
void mps__pool_resize(mps__pool *p, int32_t threads);
/* Join the threads. The pool remains usable. */
void mps__pool_free(mps__pool *p);

/* Rows per range of very cheap loops: fewer are not worth a second thread. */
enum { MPS__ROWS_CHEAP = 4096 };

/* Numbers to be set to zero. */
typedef struct mps__block {
    double *values;
    int64_t count;
} mps__block;
void mps__parallel_zero(const mps_parallel *p, const mps__block *blocks, int32_t count);
void mps__parallel_copy(const mps_parallel *p, void *to, const void *from, size_t bytes);

#endif
