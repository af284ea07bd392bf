/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory, blocked reductions, row products and the null space: what all solvers share. */
#define _POSIX_C_SOURCE 200809L
#include "kernels.h"
#include <math.h>
#include <string.h>
#include <time.h>

void *mps__take(const mps_allocator *allocator, int64_t count, size_t size)
{
    if (count < 1) count = 1;
    if ((uint64_t)count > SIZE_MAX / size) return NULL;
    return allocator->alloc(allocator->user, (size_t)count * size);
}

void mps__give(const mps_allocator *allocator, void *block)
{
    if (block) allocator->release(allocator->user, block);
}

double mps__block_dot(const double *x, const double *y, int64_t count)
{
    /* eight sums hide the latency of the addition; their order is fixed */
    double s[8] = {0};
    int64_t i = 0;
    for (; i + 8 <= count; i += 8)
        for (int k = 0; k < 8; k++) s[k] += x[i + k] * y[i + k];
    for (; i < count; i++) s[0] += x[i] * y[i];
    return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
}

double mps__sum_blocks(const double *partial, int64_t count)
{
    double s = 0;
    for (int64_t b = 0; b < count; b++) s += partial[b];
    return s;
}

typedef struct dot {
    const double *x, *y;
    int64_t n;
    double *partial;
} dot;

static void dot_blocks(void *argument, int64_t begin, int64_t end)
{
    const dot *d = argument;
    for (int64_t b = begin; b < end; b++) {
        const int64_t lo = b * MPS__BLOCK;
        d->partial[b] = mps__block_dot(d->x + lo, d->y + lo, mps__block_end(b, d->n) - lo);
    }
}

double mps__blocked_dot(const mps_parallel *p, const double *x, const double *y, int64_t n,
                        double *partial)
{
    mps_parallel_rows_least(mps__team(p, n), mps__blocks(n), 1, dot_blocks,
                            &(dot){x, y, n, partial});
    return mps__sum_blocks(partial, mps__blocks(n));
}

/* Four sums: one would wait for each addition. */
static double row_dot(const float *val, const int32_t *col, int64_t count, const double *x)
{
    double s[4] = {0};
    int64_t k = 0;
    for (; k + 4 <= count; k += 4)
        for (int a = 0; a < 4; a++) s[a] += (double)val[k + a] * x[col[k + a]];
    for (; k < count; k++) s[0] += (double)val[k] * x[col[k]];
    return (s[0] + s[2]) + (s[1] + s[3]);
}

typedef struct multiply {
    const mps_ppe_problem *problem;
    const double *x;
    double *y, *partial;
} multiply;

static void multiply_blocks(void *argument, int64_t begin, int64_t end)
{
    const multiply *m = argument;
    const mps_ppe_problem *problem = m->problem;
    const int64_t *row = problem->row;
    const int32_t *col = problem->col;
    const float *val = problem->val;
    const double *x = m->x, *diagonal = problem->diagonal;
    double *y = m->y;
    for (int64_t b = begin; b < end; b++) {
        const int64_t lo = b * MPS__BLOCK, hi = mps__block_end(b, problem->n);
        for (int64_t i = lo; i < hi; i++) {
            y[i] = diagonal[i] * x[i] + row_dot(val + row[i], col + row[i], row[i + 1] - row[i], x);
        }
        m->partial[b] = mps__block_dot(x + lo, y + lo, hi - lo);
    }
}

double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y,
                          double *partial)
{
    const int64_t n = problem->n, blocks = mps__blocks(n);
    mps_parallel_rows_least(mps__team(problem->parallel, n), blocks, 1, multiply_blocks,
                            &(multiply){problem, x, y, partial});
    return mps__sum_blocks(partial, blocks);
}

/* Largest negative of a diagonal entry. */
static void negative_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const mps_ppe_problem *problem = argument;
    double most = values[0];
    for (int64_t i = begin; i < end; i++)
        most = -problem->diagonal[i] > most ? -problem->diagonal[i] : most;
    values[0] = most;
}

bool mps__rows_nonnegative(const mps_ppe_problem *problem)
{
    double most = 0;
    mps_parallel_max(mps__team(problem->parallel, problem->n), problem->n, 1, negative_rows,
                     (mps_ppe_problem *)problem, &most);
    return !(most > 0);
}

void mps__guess_clean(double *p, int64_t n)
{
    double sum = 0; /* NaN as soon as one entry is not finite */
    for (int64_t i = 0; i < n; i++) sum += 0.0 * p[i];
    if (sum != 0) memset(p, 0, (size_t)n * sizeof *p);
}

void mps__components_center(const mps_ppe_problem *problem, double *p, double *sums)
{
    int32_t components = problem->component ? problem->components : 0;
    if (components < 1) return;
    double *counts = sums + components;
    memset(sums, 0, 2 * (size_t)components * sizeof *sums);
    for (int64_t i = 0; i < problem->n; i++) {
        int32_t c = problem->component[i];
        if (c < 0) continue;
        sums[c] += p[i];
        counts[c] += 1;
    }
    for (int64_t i = 0; i < problem->n; i++) {
        int32_t c = problem->component[i];
        if (c >= 0) p[i] -= sums[c] / counts[c];
    }
}

bool mps__guess_begin(const mps_ppe_problem *problem, double *p, double *residual, double *sums,
                      mps_ppe_result *result)
{
    mps__components_center(problem, p, sums);
    mps_ppe_check(problem, p, residual, result);
    if (isfinite(result->residual)) return true;
    memset(p, 0, (size_t)problem->n * sizeof *p);
    mps_ppe_check(problem, p, residual, result);
    return isfinite(result->residual);
}

bool mps__curvature_negative(const mps_ppe_problem *problem, const double *x, double curvature)
{
    double scale = 0;
    for (int64_t i = 0; i < problem->n; i++) scale += problem->diagonal[i] * x[i] * x[i];
    return -curvature > 1e-12 * scale;
}

void mps__result_begin(mps_ppe_result *result)
{
    result->reason = MPS_PPE_NOMEM;
    result->iterations = 0;
    result->residual = result->divergence = INFINITY;
    result->setup_seconds = 0;
}

double mps__result_excess(const mps_ppe_problem *problem, const mps_ppe_result *result)
{
    double norm = result->residual == 0 ? 0 : result->residual / problem->tolerance;
    double divergence = problem->divergence > 0 ? result->divergence / problem->divergence : 0;
    return norm >= divergence ? norm : divergence;
}

double mps__seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
