/* SPDX-License-Identifier: BSD-3-Clause */
/** @file parallel.h  Multi-threaded loops: the parallel-for of the library or of the application,
 *  and sums that do not depend on the number of threads.
 *
 *  A handle runs all its loops with one mps_parallel. By default it is that of the library: the
 *  handle owns threads, created by the first loop that needs them and joined by mps_sim_destroy().
 *  An application with its own threads sets mps_config.parallel; then the library starts none.
 *  Plug-ins get the mps_parallel of the handle with a stencil or a pressure equation, and run loops
 *  with the functions below.
 *
 *  The threads of the library block all signals. An idle thread spins for at most 50 microseconds
 *  and then sleeps. After fork() only the parent may use or destroy a handle with more than one
 *  thread: the child does not have these threads. */
#ifndef MPS_PARALLEL_H
#define MPS_PARALLEL_H

#include <mps/types.h>

#include <math.h>

MPS_BEGIN_DECLS

/** Process one part of a parallel loop. @param part 0..parts-1 */
typedef void (*mps_part_fn)(void *argument, int32_t part);

/** Process rows begin..end-1 of a loop over rows. */
typedef void (*mps_range_fn)(void *argument, int64_t begin, int64_t end);

/** Rows begin..end-1 of a sum: adds to the sums and raises the maxima in `values`. */
typedef void (*mps_reduce_fn)(void *argument, int64_t begin, int64_t end, double *values);

/** A parallel-for. */
typedef struct mps_parallel {
    /** Set by mps_parallel_init(). */
    uint32_t struct_size;
    /** Number of threads that `run` uses: loops over rows are split into this number of parts.
     *  Below 2: loops run in the calling thread. */
    int32_t threads;
    /** Call body(argument, part) for part = 0..parts-1, each once, in any order, possibly
     *  concurrently. Return when all parts have returned. Memory written before the call is visible
     *  to all parts, memory written by a part is visible after the call. Nested calls from a body
     *  must work, e.g. by calling all parts sequentially. NULL in mps_config and
     *  mps_neighbours_parallel_set(): threads of the library; elsewhere: loops run in the calling
     *  thread. */
    void (*run)(void *user, int32_t parts, mps_part_fn body, void *argument);
    /** First argument of `run`. */
    void *user;
} mps_parallel;

/** Set every entry to its default: one thread, no `run`.
 *  @param size sizeof(mps_parallel) of the caller's headers */
MPS_API mps_status mps_parallel_init(mps_parallel *parallel, size_t size);

enum {
    /** Number of partial sums of mps_parallel_reduce(), for any number of threads. */
    MPS_PARALLEL_PARTS = 64,
    /** Maximum number of sums and maxima of one loop. */
    MPS_PARALLEL_VALUES = 16,
    /** Minimum number of rows of a range in mps_parallel_rows(). */
    MPS_PARALLEL_LEAST = 128,
    /** Ranges per thread in mps_parallel_rows(): other threads take over ranges of a delayed
     *  thread. */
    MPS_PARALLEL_RANGES = 8
};

/** Call body(argument, part) for part = 0..parts-1, on the threads of `p`.
 *  @param p NULL: in the calling thread */
static inline void mps_parallel_run(const mps_parallel *p, int32_t parts, mps_part_fn body,
                                    void *argument)
{
    if (p && p->run && p->threads > 1 && parts > 1)
        p->run(p->user, parts, body, argument);
    else
        for (int32_t part = 0; part < parts; part++) body(argument, part);
}

/** Argument of mps_parallel_rows_part(). */
typedef struct mps_parallel_rows_job {
    /** Rows of all parts. */
    int64_t n;
    /** Number of parts. */
    int32_t parts;
    /** Function to call. */
    mps_range_fn body;
    /** Its first argument. */
    void *argument;
} mps_parallel_rows_job;

/** One part of mps_parallel_rows(). */
static inline void mps_parallel_rows_part(void *argument, int32_t part)
{
    const mps_parallel_rows_job *job = (const mps_parallel_rows_job *)argument;
    job->body(job->argument, job->n * part / job->parts, job->n * (part + 1) / job->parts);
}

/** Split rows 0..n-1 into MPS_PARALLEL_RANGES equal ranges per thread, or fewer so that a range has
 *  at least `least` rows. The result of a row must not depend on its range.
 *  @param p NULL: one range, in the calling thread
 *  @param least > 0 */
static inline void mps_parallel_rows_least(const mps_parallel *p, int64_t n, int64_t least,
                                           mps_range_fn body, void *argument)
{
    const int64_t threads = p && p->run ? p->threads : 1,
                  most = threads > 1 ? threads * MPS_PARALLEL_RANGES : 1,
                  parts = n / least < most ? n / least : most;
    if (parts > 1) {
        mps_parallel_rows_job job = {n, (int32_t)parts, body, argument};
        mps_parallel_run(p, job.parts, mps_parallel_rows_part, &job);
    } else if (n > 0) {
        body(argument, 0, n);
    }
}

/** mps_parallel_rows_least() with at least MPS_PARALLEL_LEAST rows per range. */
static inline void mps_parallel_rows(const mps_parallel *p, int64_t n, mps_range_fn body,
                                     void *argument)
{
    mps_parallel_rows_least(p, n, MPS_PARALLEL_LEAST, body, argument);
}

/** Sums and maxima of mps_parallel_reduce(). */
typedef struct mps_parallel_values {
    /** value[0..sums-1] are sums; out. They start at 0. */
    int32_t sums;
    /** value[sums..sums+maxima-1] are maxima; in: lower bounds; out. NaN is ignored. */
    int32_t maxima;
    /** [sums + maxima], at most MPS_PARALLEL_VALUES. */
    double *value;
} mps_parallel_values;

/** Argument of mps_parallel_reduce_part(). */
typedef struct mps_parallel_reduce_job {
    /** Rows of all parts. */
    int64_t n;
    /** Number of sums and maxima, and initial maxima. */
    const mps_parallel_values *values;
    /** Function to call. */
    mps_reduce_fn body;
    /** Its first argument. */
    void *argument;
    /** Values of each part. */
    double part[MPS_PARALLEL_PARTS][MPS_PARALLEL_VALUES];
} mps_parallel_reduce_job;

/** One part of mps_parallel_reduce(). */
static inline void mps_parallel_reduce_part(void *argument, int32_t part)
{
    mps_parallel_reduce_job *job = (mps_parallel_reduce_job *)argument;
    const int32_t sums = job->values->sums, count = sums + job->values->maxima;
    double own[MPS_PARALLEL_VALUES]; /* no false sharing of cache lines while threads sum */
    for (int32_t k = 0; k < count; k++) own[k] = k < sums ? 0.0 : job->values->value[k];
    job->body(job->argument, job->n * part / MPS_PARALLEL_PARTS,
              job->n * (part + 1) / MPS_PARALLEL_PARTS, own);
    for (int32_t k = 0; k < count; k++) job->part[part][k] = own[k];
}

/** Sums and maxima over rows 0..n-1 in one loop. Rows are summed in MPS_PARALLEL_PARTS fixed ranges
 *  and the partial sums in order: the result has the same bytes for any number of threads, but
 *  depends on the order of the rows; results of mps_exact_rows() do not.
 *  @param body adds rows to the sums, raises the maxima; may be called with begin = end */
static inline void mps_parallel_reduce(const mps_parallel *p, int64_t n, mps_reduce_fn body,
                                       void *argument, const mps_parallel_values *values)
{
    mps_parallel_reduce_job job;
    const int32_t sums = values->sums, count = sums + values->maxima;
    job.n = n;
    job.values = values;
    job.body = body;
    job.argument = argument;
    mps_parallel_run(n < 2 * MPS_PARALLEL_LEAST ? NULL : p, MPS_PARALLEL_PARTS,
                     mps_parallel_reduce_part, &job);
    for (int32_t k = 0; k < sums; k++) values->value[k] = 0.0;
    for (int32_t part = 0; part < MPS_PARALLEL_PARTS; part++)
        for (int32_t k = 0; k < count; k++) {
            if (k < sums)
                values->value[k] += job.part[part][k];
            else if (job.part[part][k] > values->value[k])
                values->value[k] = job.part[part][k];
        }
}

/** `count` sums over rows 0..n-1, as mps_parallel_reduce(). @param sums [count] out */
static inline void mps_parallel_sum(const mps_parallel *p, int64_t n, int32_t count,
                                    mps_reduce_fn body, void *argument, double *sums)
{
    const mps_parallel_values values = {count, 0, sums};
    mps_parallel_reduce(p, n, body, argument, &values);
}

/** `count` maxima over rows 0..n-1. @param maxima [count] in: lower bounds, e.g. -INFINITY; out */
static inline void mps_parallel_max(const mps_parallel *p, int64_t n, int32_t count,
                                    mps_reduce_fn body, void *argument, double *maxima)
{
    const mps_parallel_values values = {0, count, maxima};
    mps_parallel_reduce(p, n, body, argument, &values);
}

MPS_END_DECLS

#endif
