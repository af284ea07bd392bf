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

static double sum_in_order(const double *partial, int64_t count)
{
    double s = 0;
    for (int64_t b = 0; b < count; b++) s += partial[b];
    return s;
}

static int64_t block_end(int64_t block, int64_t n)
{
    int64_t end = (block + 1) * MPS__BLOCK;
    return end < n ? end : n;
}

double mps__blocked_dot(const double *x, const double *y, int64_t n, int threads, double *partial)
{
    (void)threads; /* unused without OpenMP */
    int64_t blocks = mps__blocks(n);
#pragma omp parallel for schedule(static) num_threads(mps__team(n, threads))
    for (int64_t b = 0; b < blocks; b++) {
        int64_t lo = b * MPS__BLOCK;
        partial[b] = mps__block_dot(x + lo, y + lo, block_end(b, n) - lo);
    }
    return sum_in_order(partial, blocks);
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

double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y, double *partial)
{
    int64_t n = problem->n, blocks = mps__blocks(n);
    const int64_t *row = problem->row;
    const int32_t *col = problem->col;
    const float *val = problem->val;
#pragma omp parallel for schedule(static) num_threads(mps__team(n, problem->threads))
    for (int64_t b = 0; b < blocks; b++) {
        int64_t lo = b * MPS__BLOCK, hi = block_end(b, n);
        for (int64_t i = lo; i < hi; i++) {
            y[i] = problem->diagonal[i] * x[i] + row_dot(val + row[i], col + row[i], row[i + 1] - row[i], x);
        }
        partial[b] = mps__block_dot(x + lo, y + lo, hi - lo);
    }
    return sum_in_order(partial, blocks);
}

bool mps__rows_nonnegative(const mps_ppe_problem *problem)
{
    int negative = 0;
#pragma omp parallel for schedule(static) num_threads(mps__team(problem->n, problem->threads)) reduction(| : negative)
    for (int64_t i = 0; i < problem->n; i++) negative |= problem->diagonal[i] < 0;
    return !negative;
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

bool mps__guess_begin(const mps_ppe_problem *problem, double *p, double *residual, double *sums, mps_ppe_result *result)
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
