/* SPDX-License-Identifier: BSD-3-Clause */
/* A solver of the frozen version: Gauss-Seidel to convergence, checked by mps_ppe_check(). */
#include <mps/ppe.h>
#include <stdlib.h>

int frozen_solver_calls;

static int create(const mps_allocator *allocator, void **self)
{
    (void)self;
    return !allocator->alloc || !allocator->release;
}

static void sweep(const mps_ppe_problem *a, double *p)
{
    for (int64_t i = 0; i < a->n; i++) {
        double sum = a->rhs[i];
        for (int64_t k = a->row[i]; k < a->row[i + 1]; k++) sum -= (double)a->val[k] * p[a->col[k]];
        p[i] = sum / a->diagonal[i];
    }
}

static void solve(void *self, const mps_ppe_problem *a, const mps_preconditioner_ops *pc, void *pc_self, double *p, mps_ppe_result *result)
{
    (void)self;
    (void)pc;
    (void)pc_self;
    double *work = calloc((size_t)a->n, sizeof *work);
    *result = (mps_ppe_result){.struct_size = sizeof *result, .reason = MPS_PPE_MAX_ITERATIONS};
    if (!work || a->struct_size < sizeof *a || a->dim != 2 || a->dp != 0.05 || a->max_iterations != 2000 || a->tolerance < 1e-7) {
        result->reason = work ? MPS_PPE_BREAKDOWN : MPS_PPE_NOMEM;
        free(work);
        return;
    }
    for (int k = 1; k <= a->max_iterations && result->reason != MPS_PPE_CONVERGED; k++) {
        sweep(a, p);
        mps_ppe_check(a, p, work, result);
        result->iterations = k;
        const int near = result->residual <= a->tolerance && (a->divergence == 0 || result->divergence <= a->divergence);
        result->reason = near ? MPS_PPE_CONVERGED : MPS_PPE_MAX_ITERATIONS;
    }
    frozen_solver_calls++;
    free(work);
}

static void destroy(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
}

const mps_solver_ops frozen_solver = {
    .struct_size = sizeof frozen_solver, .api = MPS_PPE_API, .name = "frozen.jacobi", .create = create, .solve = solve, .destroy = destroy};
