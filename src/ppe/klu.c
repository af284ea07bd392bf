/* SPDX-License-Identifier: BSD-3-Clause */
/* sundials.klu: sparse direct solution, the reference for the iterative solvers; memory and time
 * grow fast in 3-D. */
#include "builtin.h"
#include "rows.h"
#include "sundials_compat.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { REFINEMENTS = 4, ORDER_AMD = 0 };

typedef struct klu {
    mps_allocator allocator;
    SUNContext context;
} klu;

/* Data of one solution; the pattern changes every step, so that nothing is kept. */
typedef struct job {
    const mps_ppe_problem *problem;
    double *residual, *correction, *start;
    mps__component *sums;
    int32_t *datum; /* [components] the unknown that is fixed at 0 */
    SUNMatrix matrix;
    N_Vector x, b;
    SUNLinearSolver solver;
} job;

static int create(const mps_allocator *allocator, void **self)
{
    klu *k = mps__take(allocator, 1, sizeof *k);
    if (!k) return MPS_PPE_NOMEM;
    k->allocator = *allocator;
    k->context = mps__sundials_context(*self);
    if (!k->context) {
        mps__release(allocator, k);
        return MPS_PPE_NOMEM;
    }
    *self = k;
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    klu *k = self;
    if (!k) return;
    SUNContext_Free(&k->context);
    mps__release(allocator, k);
}

static void close_job(const klu *k, job *j)
{
    if (j->solver) SUNLinSolFree(j->solver);
    if (j->matrix) SUNMatDestroy(j->matrix);
    if (j->x) N_VDestroy(j->x);
    if (j->b) N_VDestroy(j->b);
    mps__release(&k->allocator, j->residual);
    mps__release(&k->allocator, j->correction);
    mps__release(&k->allocator, j->start);
    mps__release(&k->allocator, j->sums);
    mps__release(&k->allocator, j->datum);
}

static bool open_job(const klu *k, job *j, const mps_ppe_problem *problem)
{
    const mps_allocator *a = &k->allocator;
    sunindextype n = (sunindextype)problem->n;
    j->problem = problem;
    j->residual = mps__take(a, n, sizeof(double));
    j->correction = mps__take(a, n, sizeof(double));
    j->start = mps__take(a, n, sizeof(double));
    j->sums = mps__take(a, problem->components, sizeof *j->sums);
    j->datum = mps__take(a, problem->components, sizeof(int32_t));
    if (!j->residual || !j->correction || !j->start || !j->sums || !j->datum) return false;
    j->matrix = SUNSparseMatrix(n, n, (sunindextype)problem->row[n] + n, CSR_MAT, k->context);
    j->x = N_VMake_Serial(n, j->correction, k->context);
    j->b = N_VMake_Serial(n, j->residual, k->context);
    return j->matrix && j->x && j->b;
}

/* Choose the first unknown of each singular component. */
static void choose_datums(const job *j)
{
    const mps_ppe_problem *problem = j->problem;
    if (!problem->component) return;
    for (int32_t c = 0; c < problem->components; c++) j->datum[c] = -1;
    for (int64_t i = problem->n - 1; i >= 0; i--)
        if (problem->component[i] >= 0) j->datum[problem->component[i]] = (int32_t)i;
}

static bool is_datum(const job *j, int64_t i)
{
    const int32_t *component = j->problem->component;
    return component && component[i] >= 0 && j->datum[component[i]] == i;
}

/* Rows and columns of fixed unknowns become those of the unit matrix (scaled): the removed equation
 * is the sum of the component's others, and subtracting the mean removes the effect of p = 0. */
static void fill_matrix(const job *j)
{
    const mps_ppe_problem *problem = j->problem;
    sunindextype *row = SUNSparseMatrix_IndexPointers(j->matrix),
                 *col = SUNSparseMatrix_IndexValues(j->matrix);
    double *val = SUNSparseMatrix_Data(j->matrix);
    sunindextype at = 0;
    for (int64_t i = 0; i < problem->n; i++) {
        const double d = problem->diagonal[i];
        row[i] = at;
        col[at] = i; /* columns need not be sorted */
        val[at++] = is_datum(j, i) && !(d > 0) ? 1 : d;
        if (is_datum(j, i)) continue;
        for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
            if (is_datum(j, problem->col[k])) continue;
            col[at] = problem->col[k];
            val[at++] = (double)problem->val[k];
        }
    }
    row[problem->n] = at;
}

/* Reason of a failed call of KLU. */
static int failure(const job *j)
{
    return SUNLinSol_KLUGetCommon(j->solver)->status == KLU_OUT_OF_MEMORY ? MPS_PPE_NOMEM
                                                                          : MPS_PPE_BREAKDOWN;
}

static int factorise(const klu *k, job *j, mps_ppe_result *result)
{
    double t = mps__seconds();
    choose_datums(j);
    fill_matrix(j);
    j->solver = SUNLinSol_KLU(j->x, j->matrix, k->context);
    if (!j->solver) return MPS_PPE_NOMEM;
    SUNLinSol_KLUSetOrdering(j->solver, ORDER_AMD); /* the pattern is symmetric */
    int flag = SUNLinSolSetup(j->solver, j->matrix);
    result->setup_seconds = mps__seconds() - t;
    return flag ? failure(j) : 0;
}

/* Add the solution of A d = b - A p to p; repeat while the rounding of a 1000:1 matrix leaves a
 * residual. */
static int refine(job *j, double *p, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = j->problem;
    for (int k = 0; k < REFINEMENTS; k++) {
        for (int64_t i = 0; i < problem->n; i++)
            if (is_datum(j, i)) j->residual[i] = 0;
        if (SUNLinSolSolve(j->solver, j->matrix, j->x, j->b, 0)) return failure(j);
        for (int64_t i = 0; i < problem->n; i++) p[i] += j->correction[i];
        mps__components_center(problem, p, j->sums);
        mps_ppe_check(problem, p, j->residual, result);
        if (!isfinite(result->residual)) return MPS_PPE_BREAKDOWN;
        if (mps__result_excess(problem, result) <= 1) return MPS_PPE_CONVERGED;
    }
    return MPS_PPE_MAX_ITERATIONS;
}

static int attempt(const klu *k, job *j, double *p, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = j->problem;
    size_t bytes = (size_t)problem->n * sizeof *p;
    memcpy(j->start, p, bytes);
    memset(p, 0, bytes); /* a direct solver does not use a guess */
    mps_ppe_check(problem, p, j->residual, result);
    int reason = isfinite(result->residual) ? 0 : MPS_PPE_NAN;
    if (!reason && result->residual == 0) return MPS_PPE_CONVERGED;
    if (!reason) reason = factorise(k, j, result);
    if (!reason) reason = refine(j, p, result);
    if (reason == MPS_PPE_CONVERGED || reason == MPS_PPE_MAX_ITERATIONS) return reason;
    memcpy(p, j->start, bytes);
    mps_ppe_check(problem, p, j->residual, result);
    return reason;
}

static void solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                  void *pc_self, double *p, mps_ppe_result *result)
{
    (void)pc, (void)pc_self;
    const klu *k = self;
    job j = {0};
    mps__result_begin(result);
    mps__guess_clean(problem, p);
    if (open_job(k, &j, problem)) result->reason = attempt(k, &j, p, result);
    close_job(k, &j);
}

const mps_solver_ops mps__solver_klu = {
    .struct_size = sizeof(mps_solver_ops),
    .api = MPS_PPE_API,
    .name = "sundials.klu",
    .preconditioner = NULL,
    .symmetric = 0,
    .create = create,
    .solve = solve,
    .destroy = destroy,
    .help = "Sparse LU factorisation (direct), for small systems and checks",
};
