/* SPDX-License-Identifier: BSD-3-Clause */
/* jacobi: the inverse of the diagonal. */
#include "builtin.h"
#include "kernels.h"
#include <math.h>

typedef struct jacobi {
    mps_allocator allocator;
    double *inverse; /* [capacity] */
    int64_t n, capacity;
    const mps_parallel *parallel;
} jacobi;

static int create(const mps_allocator *allocator, void **self)
{
    jacobi *j = mps__take(allocator, 1, sizeof *j);
    if (!j) return MPS_PPE_NOMEM;
    *j = (jacobi){.allocator = *allocator};
    *self = j;
    return 0;
}

static bool reserve(jacobi *j, int64_t n)
{
    if (n <= j->capacity) return true;
    mps__give(&j->allocator, j->inverse);
    j->capacity = n + n / 8;
    j->inverse = mps__take(&j->allocator, j->capacity, sizeof *j->inverse);
    if (!j->inverse) j->capacity = 0;
    return j->inverse;
}

static int setup(void *self, const mps_ppe_problem *problem)
{
    jacobi *j = self;
    if (!reserve(j, problem->n)) return MPS_PPE_NOMEM;
    j->n = problem->n;
    j->parallel = problem->parallel;
    bool poison = false, negative = false;
    for (int64_t i = 0; i < problem->n; i++) {
        const double d = problem->diagonal[i];
        poison = poison || !isfinite(d);
        negative = negative || d < 0;
        /* an empty row is a particle without neighbours, its residual is 0 */
        j->inverse[i] = d > 0 ? 1 / d : 1;
    }
    if (mps__on_any_rank(problem, poison)) return MPS_PPE_NAN;
    return mps__on_any_rank(problem, negative) ? MPS_PPE_INDEFINITE : 0;
}

typedef struct operands {
    const double *inverse, *r;
    double *z;
} operands;

static void apply_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *inverse = o->inverse, *r = o->r;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = inverse[i] * r[i];
}

static int apply(void *self, const double *r, double *z)
{
    const jacobi *j = self;
    mps_parallel_rows_least(j->parallel, j->n, MPS__TEAM_LEAST / 2, apply_rows,
                            &(operands){j->inverse, r, z});
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    jacobi *j = self;
    if (!j) return;
    mps__give(allocator, j->inverse);
    mps__give(allocator, j);
}

const mps_preconditioner_ops mps__preconditioner_jacobi = {
    .struct_size = sizeof(mps_preconditioner_ops),
    .api = MPS_PPE_API,
    .name = "jacobi",
    .symmetric = 1,
    .create = create,
    .setup = setup,
    .apply = apply,
    .destroy = destroy,
    .help = "Diagonal scaling",
    .ranks = 1,
};
