/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory, reductions, row products and the null space: what all solvers share. */
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

void mps__reduce(const mps_ppe_problem *problem, mps_exact_fn body, void *argument,
                 const mps_exact_values *values)
{
    mps_exact_rows(mps__team(problem->parallel, problem->n), problem->n, MPS__BLOCK, body, argument,
                   values);
    mps_ppe_total(problem, values);
}

bool mps__on_any_rank(const mps_ppe_problem *problem, bool here)
{
    double any = here;
    mps_ppe_total(problem, &(mps_exact_values){.maxima = 1, .maximum = &any});
    return any > 0;
}

typedef struct dot {
    const double *x, *y;
} dot;

static void dot_rows(void *argument, int64_t begin, int64_t end, mps_exact *sum, double *none)
{
    const dot *d = argument;
    (void)none;
    mps_exact_add_products(sum, end - begin, d->x + begin, d->y + begin);
}

double mps__dot_product(const mps_ppe_problem *problem, const double *x, const double *y)
{
    mps_exact sum = {{0}, 0, 0};
    mps__reduce(problem, dot_rows, &(dot){x, y}, &(mps_exact_values){.sums = 1, .sum = &sum});
    return mps_exact_value(&sum);
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
    double *y;
} multiply;

/* Blocks: their products are summed while they are in cache. */
static void multiply_rows(void *argument, int64_t begin, int64_t end, mps_exact *sum, double *none)
{
    const multiply *m = argument;
    const mps_ppe_problem *problem = m->problem;
    const int64_t *row = problem->row;
    const int32_t *col = problem->col;
    const float *val = problem->val;
    const double *x = m->x, *diagonal = problem->diagonal;
    double *y = m->y;
    (void)none;
    for (int64_t lo = begin, hi; lo < end; lo = hi) {
        hi = lo + MPS__BLOCK < end ? lo + MPS__BLOCK : end;
        for (int64_t i = lo; i < hi; i++)
            y[i] = diagonal[i] * x[i] + row_dot(val + row[i], col + row[i], row[i + 1] - row[i], x);
        mps_exact_add_products(sum, hi - lo, x + lo, y + lo);
    }
}

double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y)
{
    mps_exact sum = {{0}, 0, 0};
    if (mps_ppe_share(problem, (double *)x)) return NAN;
    mps__reduce(problem, multiply_rows, &(multiply){problem, x, y},
                &(mps_exact_values){.sums = 1, .sum = &sum});
    return mps_exact_value(&sum);
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
    return !mps__on_any_rank(problem, most > 0);
}

void mps__guess_clean(const mps_ppe_problem *problem, double *p)
{
    double sum = 0; /* NaN as soon as one entry is not finite */
    for (int64_t i = 0; i < problem->n; i++) sum += 0.0 * p[i];
    if (mps__on_any_rank(problem, sum != 0)) memset(p, 0, (size_t)problem->n * sizeof *p);
}

static void join_components(void *into, const void *from)
{
    mps__component *a = into;
    const mps__component *b = from;
    mps_exact_join(&a->sum, &b->sum);
    a->rows += b->rows;
}

void mps__components_center(const mps_ppe_problem *problem, double *p, mps__component *sums)
{
    const int32_t components = problem->component ? problem->components : 0,
                  *component = problem->component;
    if (components < 1) return;
    memset(sums, 0, (size_t)components * sizeof *sums);
    for (int64_t i = 0, end; i < problem->n; i = end) {
        const int32_t c = component[i];
        for (end = i + 1; end < problem->n && component[end] == c;) end++;
        if (c < 0) continue;
        mps_exact_add(&sums[c].sum, end - i, p + i);
        sums[c].rows += (double)(end - i);
    }
    mps_ppe_reduce(problem, components, sizeof *sums, sums, join_components);
    for (int32_t c = 0; c < components; c++)
        sums[c].mean = mps_exact_value(&sums[c].sum) / sums[c].rows;
    for (int64_t i = 0; i < problem->n; i++)
        if (component[i] >= 0) p[i] -= sums[component[i]].mean;
}

bool mps__guess_begin(const mps_ppe_problem *problem, double *p, double *residual,
                      mps__component *sums, mps_ppe_result *result)
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
    mps_exact scale = {{0}, 0, 0};
    for (int64_t lo = 0, n; lo < problem->n; lo += n) {
        double part[MPS__BLOCK];
        n = problem->n - lo < MPS__BLOCK ? problem->n - lo : MPS__BLOCK;
        for (int64_t i = 0; i < n; i++) part[i] = problem->diagonal[lo + i] * x[lo + i];
        mps_exact_add_products(&scale, n, part, x + lo);
    }
    mps_ppe_total(problem, &(mps_exact_values){.sums = 1, .sum = &scale});
    return -curvature > 1e-12 * mps_exact_value(&scale);
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
