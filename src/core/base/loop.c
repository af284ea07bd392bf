/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops of the library on the threads of a handle: they run only here. */
#include "loop.h"
#include "device.h"

/* A loop, or sums and maxima, passed to the parallel-for. */
typedef struct job {
    const mps__loop *loop;
    const mps__values *values;
    int32_t dim;
    const void *fields;
} job;

static void run_rows(void *argument, int64_t begin, int64_t end)
{
    const job *k = argument;
    k->loop->run(k->dim, k->fields, begin, end);
}

static void run_values(void *argument, int64_t begin, int64_t end, mps_exact *sum, double *maximum)
{
    const job *k = argument;
    k->values->run(k->dim, k->fields, begin, end, sum, maximum);
}

/* ---- on a device ---- */

static void launch_rows(const void *host, int64_t begin, int64_t end, mps_exact *sum,
                        double *maximum)
{
    const job *k = host;
    (void)sum, (void)maximum;
    k->loop->run(k->dim, k->fields, begin, end);
}

static void launch_values(const void *host, int64_t begin, int64_t end, mps_exact *sum,
                          double *maximum)
{
    const job *k = host;
    k->values->run(k->dim, k->fields, begin, end, sum, maximum);
}

/* ---- loops ---- */

static void run_loop(const mps_parallel *p, const job *k, int64_t n, int64_t least)
{
    mps__device *d = mps__device_of(p);
    mps_launch l = {.file = k->loop->file,
                    .name = k->loop->name,
                    .dim = k->dim,
                    .n = n,
                    .fields = k->fields,
                    .bytes = k->loop->bytes,
                    .run = launch_rows,
                    .host = k};
    if (d)
        mps__device_launch(d, &l, NULL, NULL);
    else
        mps_parallel_rows_least(p, n, least, run_rows, (void *)k);
}

void mps__loop_run(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n,
                   const void *fields)
{
    run_loop(p, &(job){.loop = loop, .dim = dim, .fields = fields}, n, MPS_PARALLEL_LEAST);
}

void mps__loop_run_long(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n,
                        const void *fields)
{
    run_loop(p, &(job){.loop = loop, .dim = dim, .fields = fields}, n, 1);
}

void mps__loop_run_cheap(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n,
                         const void *fields)
{
    run_loop(p, &(job){.loop = loop, .dim = dim, .fields = fields}, n, MPS__ROWS_CHEAP);
}

static mps_launch launch_of(const job *k, int64_t n)
{
    return (mps_launch){.file = k->values->file,
                        .name = k->values->name,
                        .dim = k->dim,
                        .n = n,
                        .fields = k->fields,
                        .bytes = k->values->bytes,
                        .sums = k->values->sums,
                        .maxima = k->values->maxima,
                        .run = launch_values,
                        .host = k};
}

void mps__group_run(mps__device *d, const mps__loop *group, const void *fields)
{
    run_loop(&d->parallel, &(job){.loop = group, .dim = 2, .fields = fields}, MPS__TOGETHER, 1);
}

void mps__values_run(const mps_parallel *p, const mps__values *values, int32_t dim, int64_t n,
                     const void *fields, mps_exact *sum, double *maximum)
{
    job k = {.values = values, .dim = dim, .fields = fields};
    const mps_exact_values wanted = {values->sums, values->maxima, sum, maximum};
    mps__device *d = mps__device_of(p);
    mps_launch l = launch_of(&k, n);
    if (d)
        mps__device_launch(d, &l, sum, maximum);
    else
        mps_exact_rows(p, n, MPS_PARALLEL_LEAST, run_values, &k, &wanted);
}

void mps__values_reduce_async(mps__device *d, const mps__values *values, int32_t dim, int64_t n,
                              const void *fields, void *to)
{
    const job k = {.values = values, .dim = dim, .fields = fields};
    mps_launch l = launch_of(&k, n);
    mps__device_reduce_async(d, &l, to);
}

int64_t mps__first_run(const mps_parallel *p, const mps__values *first, int64_t n,
                       const void *fields)
{
    double largest = -(double)n;
    mps__values_run(p, first, MPS__ANY_DIM, n, fields, NULL, &largest);
    return (int64_t)-largest;
}
