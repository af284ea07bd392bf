/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory, reductions, matrix-vector products and the null space: shared by all solvers. */
#define _POSIX_C_SOURCE 200809L
#include "rows.h"
#include "loop.h"
#include <math.h>
#include <string.h>
#include <time.h>

void *mps__take(const mps_allocator *allocator, int64_t count, size_t size)
{
    if (count < 1) count = 1;
    if ((uint64_t)count > SIZE_MAX / size) return NULL;
    return allocator->alloc(allocator->user, (size_t)count * size);
}

void mps__release(const mps_allocator *allocator, void *block)
{
    if (block) allocator->release(allocator->user, block);
}

bool mps__on_any_rank(const mps_ppe_problem *problem, bool here)
{
    double any = here;
    mps_ppe_total(problem, &(mps_exact_values){.maxima = 1, .maximum = &any});
    return any > 0;
}

typedef struct product {
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *diagonal, *x;
    double *y;
} product;

/* Four partial sums: with a single one each addition would wait for the previous one. */
MPS_ROW double row_dot(const float *val, const int32_t *col, int64_t count, const double *x)
{
    double s[4] = {0};
    int64_t k = 0;
    for (; k + 4 <= count; k += 4)
        for (int a = 0; a < 4; a++) s[a] += (double)val[k + a] * x[col[k + a]];
    for (; k < count; k++) s[0] += (double)val[k] * x[col[k]];
    return (s[0] + s[2]) + (s[1] + s[3]);
}

MPS_ROW void multiply_row(const product *m, int64_t i, double *values)
{
    const int64_t first = m->row[i];
    m->y[i] = m->diagonal[i] * m->x[i] +
              row_dot(m->val + first, m->col + first, m->row[i + 1] - first, m->x);
    values[0] = m->x[i] * m->y[i];
}

/* In blocks: products are summed while they are in cache. */
static void multiply_range(const product *m, int64_t begin, int64_t end, mps_exact *sum,
                           double *none)
{
    double row[1];
    (void)none;
    for (int64_t lo = begin, hi; lo < end; lo = hi) {
        hi = lo + MPS__BLOCK < end ? lo + MPS__BLOCK : end;
        for (int64_t i = lo; i < hi; i++) multiply_row(m, i, row);
        mps_exact_add_products(sum, hi - lo, m->x + lo, m->y + lo);
    }
}
MPS__VALUES_BY(multiply_rows, multiply_row, multiply_range, product, 1, 0)

double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y)
{
    mps_exact sum = {{0}, 0, 0};
    if (mps_ppe_halo(problem, (double *)x)) return NAN;
    mps__values_run(
        mps__team(problem->parallel, problem->n), &multiply_rows, MPS__ANY_DIM, problem->n,
        &(product){problem->row, problem->col, problem->val, problem->diagonal, x, y}, &sum, NULL);
    mps_ppe_total(problem, &(mps_exact_values){.sums = 1, .sum = &sum});
    return mps_exact_value(&sum);
}

void mps__rows_multiply_async(const mps_ppe_problem *problem, const double *x, double *y,
                              mps__reduced *to)
{
    mps__values_reduce_async(
        mps__device_of(problem->parallel), &multiply_rows, MPS__ANY_DIM, problem->n,
        &(product){problem->row, problem->col, problem->val, problem->diagonal, x, y}, to);
}

bool mps__rows_nonnegative(const mps_ppe_problem *problem)
{
    return !(mps__vectors_largest(problem, problem->diagonal, -1, 0) > 0);
}

void mps__guess_clean(const mps_ppe_problem *problem, double *p)
{
    if (mps__vectors_poisoned(problem, p)) mps__vectors_clear(problem->parallel, problem->n, p);
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
    mps__vectors_clear(problem->parallel, problem->n, p);
    mps_ppe_check(problem, p, residual, result);
    return isfinite(result->residual);
}

typedef struct curvature {
    const double *diagonal, *x;
} curvature;

MPS_ROW void scale_row(const curvature *c, int64_t i, double *values)
{
    values[0] = c->diagonal[i] * c->x[i] * c->x[i];
}
MPS__VALUES_ANY(scale_rows, scale_row, curvature, 1, 0)

bool mps__curvature_negative(const mps_ppe_problem *problem, const double *x, double found)
{
    mps_exact scale = {{0}, 0, 0};
    double none[1];
    mps__values_run(mps__team(problem->parallel, problem->n), &scale_rows, MPS__ANY_DIM, problem->n,
                    &(curvature){problem->diagonal, x}, &scale, none);
    mps_ppe_total(problem, &(mps_exact_values){.sums = 1, .sum = &scale});
    return -found > 1e-12 * mps_exact_value(&scale);
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
    return mps__excess_of(result->residual, problem->tolerance, result->divergence,
                          problem->divergence);
}

int mps__progress_after(mps__progress *p, double excess, int failure)
{
    enum { IDLE_PASSES = 4 }; /* passes without progress before giving up */
    const bool first = p->passes++ == 0, better = excess < 0.9 * p->best;
    if (excess <= 1) return MPS_PPE_CONVERGED;
    /* a recurrence that broke down, or reached the level of rounding, may restart from its last
     * result */
    if (failure && (failure != MPS_PPE_BREAKDOWN || (first && !better))) return failure;
    p->idle = better ? 0 : p->idle + 1;
    if (excess < p->best) p->best = excess;
    return p->idle < IDLE_PASSES ? -1 : MPS_PPE_MAX_ITERATIONS;
}

double mps__seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
