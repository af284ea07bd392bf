/* SPDX-License-Identifier: BSD-3-Clause */
/* Driver of the iterative solvers. Each pass solves A d = b - A p from d = 0 and adds d to p. A
 * SUNDIALS solver stops on its recursive residual; passes are repeated until the true residual is
 * small in both norms. */
#include "krylov.h"
#include "cg.h"
#include "rows.h"
#include <math.h>

typedef struct krylov {
    const mps__krylov_kind *kind;
    mps__context *log; /* NULL: no log */
    mps__space space;
    SUNLinearSolver solver;
    N_Vector x, b, stop;
    double *start, *residual, *correction, *inner; /* [capacity] */
    void *workspace;      /* workspace of the run on a device; NULL: on the host */
    mps__component *sums; /* [sum_capacity] */
    int64_t sum_capacity;
    /* of the solve in progress */
    const mps_ppe_problem *problem;
    const mps_preconditioner_ops *pc;
    void *pc_self;
    int failure; /* failure in a callback, 0: none */
} krylov;

/* ---- callbacks of SUNDIALS: a non-zero value stops the solver ---- */

static int apply(krylov *k, const double *r, double *z)
{
    k->failure = k->pc->apply(k->pc_self, r, z);
    return k->failure ? -1 : 0;
}

/* z = A v, or A M^-1 v for methods that do not precondition themselves. */
static int times(void *data, N_Vector v, N_Vector z)
{
    krylov *k = data;
    const double *x = mps__vector_data(v);
    double *y = mps__vector_data(z);
    if (k->pc && !k->kind->symmetric) {
        if (apply(k, x, k->inner)) return -1;
        x = k->inner;
    }
    double curvature = mps__rows_multiply(k->problem, x, y);
    mps__space_remember(&k->space, x, y, curvature);
    if (!isfinite(curvature))
        k->failure = MPS_PPE_BREAKDOWN;
    else if (k->kind->symmetric && curvature <= 0)
        k->failure = mps__curvature_negative(k->problem, x, curvature) ? MPS_PPE_INDEFINITE
                                                                       : MPS_PPE_BREAKDOWN;
    return k->failure ? -1 : 0;
}

/* z = M^-1 r in conjugate gradients, which need r'z > 0. */
static int precondition(void *data, N_Vector vr, N_Vector vz, sunrealtype tolerance, int side)
{
    (void)tolerance, (void)side;
    krylov *k = data;
    const double *r = mps__vector_data(vr);
    double *z = mps__vector_data(vz);
    if (apply(k, r, z)) return -1;
    double dot = mps__vectors_dot(k->problem, r, z);
    mps__space_remember(&k->space, r, z, dot);
    if (!isfinite(dot))
        k->failure = MPS_PPE_NAN;
    else if (dot <= 0)
        k->failure = MPS_PPE_INDEFINITE;
    return k->failure ? -1 : 0;
}

/* ---- memory ---- */

static void drop_arrays(krylov *k)
{
    double **all[] = {&k->start, &k->residual, &k->correction, &k->inner};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        mps__release(&k->space.arrays, *all[i]);
        *all[i] = NULL;
    }
    mps__release(&k->space.arrays, k->workspace);
    k->workspace = NULL;
    k->space.capacity = 0;
}

/* Whether a problem is solved by conjugate gradients whose sums stay on a device. On many ranks the
 * host reduces the sums. */
static bool stays_on_device(const krylov *k, const mps_ppe_problem *problem)
{
    return k->kind->symmetric && mps__device_of(problem->parallel) && !problem->ranks;
}

/* Allocate the arrays of the solver and of all vectors, of this length. */
static bool make_arrays(krylov *k, int64_t capacity, bool stays)
{
    const mps_allocator *a = &k->space.arrays;
    drop_arrays(k);
    k->start = mps__take(a, capacity, sizeof *k->start);
    k->residual = mps__take(a, capacity, sizeof *k->residual);
    k->correction = mps__take(a, capacity, sizeof *k->correction);
    if (!k->kind->symmetric) k->inner = mps__take(a, capacity, sizeof *k->inner);
    mps__vector_point(k->x, k->correction);
    mps__vector_point(k->b, k->residual);
    if (!k->start || !k->residual || !k->correction || (!k->inner && !k->kind->symmetric))
        return false;
    if (stays && !(k->workspace = mps__take(a, 1, mps__cg_bytes()))) return false;
    return mps__space_grow(&k->space, capacity);
}

/* Arrays are in the memory space of the loops over them. */
static void settle(krylov *k, const mps_parallel *parallel)
{
    mps__device *d = mps__device_of(parallel);
    const mps_allocator wanted = d ? d->memory : k->space.allocator;
    if (wanted.alloc == k->space.arrays.alloc && wanted.user == k->space.arrays.user) return;
    drop_arrays(k);
    mps__space_release_device(&k->space, &wanted);
}

void mps__krylov_release_device(void *self)
{
    settle(self, NULL);
}

/* Make all objects that SUNDIALS allocates, once, before the first step. */
static bool make_solver(krylov *k)
{
    k->space.context = mps__sundials_context(k->log);
    if (!k->space.context) return false;
    k->x = mps__vector_wrap(&k->space, NULL);
    k->b = mps__vector_wrap(&k->space, NULL);
    k->stop = mps__vector_stop(&k->space);
    if (!k->x || !k->b || !k->stop) return false;
    if (!mps__space_reserve(&k->space, k->kind->vectors)) return false;
    k->solver = k->kind->make(k->x, k->space.context);
    if (!k->solver || SUNLinSolSetATimes(k->solver, k, times)) return false;
    if (!k->kind->symmetric) return !SUNLinSolInitialize(k->solver);
    return !SUNLinSolSetPreconditioner(k->solver, k, NULL, precondition) &&
           !SUNLinSolSetScalingVectors(k->solver, k->stop, NULL) && !SUNLinSolInitialize(k->solver);
}

static bool make_sums(krylov *k, int64_t components)
{
    if (components <= k->sum_capacity) return true;
    mps__component *larger = mps__take(&k->space.allocator, components, sizeof *larger);
    if (!larger) return false;
    mps__release(&k->space.allocator, k->sums);
    k->sums = larger;
    k->sum_capacity = components;
    return true;
}

/* Workspace for a problem, reused by the next one. */
static bool prepare(krylov *k, const mps_ppe_problem *problem)
{
    settle(k, problem->parallel);
    k->space.n = problem->n;
    k->space.parallel = problem->parallel;
    k->space.weight = problem->divergence > 0 ? problem->weight : NULL;
    if (problem->component && !make_sums(k, problem->components)) return false;
    const int64_t columns = mps__columns(problem);
    k->space.problem = problem;
    return (k->start && columns <= k->space.capacity) ||
           make_arrays(k, columns + columns / 32 + 1, stays_on_device(k, problem));
}

/* ---- solution ---- */

/* @return iterations used */
static int run_sundials(krylov *k, int iterations, double delta)
{
    SUNLinSolSetZeroGuess(k->solver, SUNTRUE);
    const int flag = k->kind->run(k->solver, k->pc != NULL, iterations, k->x, k->b, delta);
    const bool stopped = flag == MPS__SUNDIALS_SUCCESS || flag == SUNLS_RES_REDUCED ||
                         flag == SUNLS_CONV_FAIL;
    if (!stopped && !k->failure) k->failure = MPS_PPE_BREAKDOWN;
    return SUNLinSolNumIters(k->solver);
}

/* One run of the method on A d = residual; adds d to p. */
static void run(krylov *k, double *p, double delta, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = k->problem;
    double *d = k->correction;
    mps__vectors_clear(problem->parallel, problem->n, d);
    /* remove the part in the null space, which rounding leaves */
    mps__components_center(problem, k->residual, k->sums);
    k->failure = 0;
    const int left = problem->max_iterations - result->iterations;
    result->iterations += run_sundials(k, left, delta);
    if (k->pc && !k->kind->symmetric) {
        int reason = k->pc->apply(k->pc_self, d, k->inner);
        if (reason) k->failure = reason;
        d = k->inner;
    }
    mps__guess_clean(problem, d);
    mps__vectors_sum(problem->parallel, problem->n, (double[]){1, 1}, p, d, p);
    mps__components_center(problem, p, k->sums);
    mps_ppe_check(problem, p, k->residual, result);
}

/* Residual limit of the next run. Conjugate gradients measure the excess itself, the other methods
 * the 2-norm. If the first limit has been too loose, the next one is lower by a factor. */
static double next_limit(const krylov *k, const mps_ppe_result *result, double norm, bool first)
{
    double excess = mps__result_excess(k->problem, result);
    double now = k->kind->symmetric ? excess : result->residual * norm;
    double wanted = first && !k->kind->symmetric ? k->space.norm_limit
                                                 : now / excess * (first ? 1 : 0.5);
    return mps__aim(wanted, now);
}

static int passes(krylov *k, double *p, double norm, mps_ppe_result *result)
{
    mps__progress progress = {.best = mps__result_excess(k->problem, result)};
    for (;;) {
        if (result->iterations >= k->problem->max_iterations) return MPS_PPE_MAX_ITERATIONS;
        run(k, p, next_limit(k, result, norm, progress.passes == 0), result);
        const int reason = mps__progress_after(&progress, mps__result_excess(k->problem, result),
                                               k->failure);
        if (reason >= 0) return reason;
    }
}

static int setup(krylov *k, mps_ppe_result *result)
{
    if (k->kind->symmetric && !mps__rows_nonnegative(k->problem)) return MPS_PPE_INDEFINITE;
    if (!k->pc) return 0;
    double t = mps__seconds();
    int reason = k->pc->setup(k->pc_self, k->problem);
    result->setup_seconds = mps__seconds() - t;
    return reason;
}

static int attempt(krylov *k, double *p, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = k->problem;
    double norm = sqrt(mps__vectors_dot(problem, problem->rhs, problem->rhs));
    if (norm == 0) mps__vectors_clear(problem->parallel, problem->n, p);
    if (!mps__guess_begin(k->problem, p, k->residual, k->sums, result)) return MPS_PPE_NAN;
    double excess = mps__result_excess(problem, result);
    if (excess <= 1) return MPS_PPE_CONVERGED;
    mps__vectors_copy(problem->parallel, problem->n, p, k->start);
    int reason = setup(k, result);
    if (reason) return reason;
    k->space.norm_limit = problem->tolerance * norm;
    k->space.divergence_limit = problem->divergence;
    reason = passes(k, p, norm, result);
    bool failed = reason != MPS_PPE_CONVERGED && reason != MPS_PPE_MAX_ITERATIONS;
    if (failed || !(mps__result_excess(problem, result) <= excess)) {
        mps__vectors_copy(problem->parallel, problem->n, k->start, p);
        mps_ppe_check(problem, p, k->residual, result);
    }
    return reason;
}

/* The whole solution on a device. */
static int attempt_device(krylov *k, double *p, mps_ppe_result *result)
{
    mps__cg c = {.problem = k->problem,
                 .pc = k->pc,
                 .pc_self = k->pc_self,
                 .workspace = k->workspace,
                 .p = p,
                 .start = k->start,
                 .x = k->correction,
                 .r = k->residual};
    mps__space_lend(&k->space, MPS__CG_ARRAYS, c.array);
    return mps__cg_solve(&c, result);
}

int mps__krylov_create(const mps__krylov_kind *kind, const mps_allocator *allocator, void **self)
{
    krylov *k = mps__take(allocator, 1, sizeof *k);
    if (!k) return MPS_PPE_NOMEM;
    *k = (krylov){
        .kind = kind, .log = *self, .space = {.allocator = *allocator, .arrays = *allocator}};
    if (make_solver(k)) {
        *self = k;
        return 0;
    }
    mps__krylov_destroy(allocator, k);
    return MPS_PPE_NOMEM;
}

void mps__krylov_solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                       void *pc_self, double *p, mps_ppe_result *result)
{
    krylov *k = self;
    mps__result_begin(result);
    if (!stays_on_device(k, problem)) mps__guess_clean(problem, p);
    if (!prepare(k, problem)) return;
    k->problem = problem;
    k->pc = pc;
    k->pc_self = pc_self;
    result->reason = k->workspace ? attempt_device(k, p, result) : attempt(k, p, result);
}

void mps__krylov_destroy(const mps_allocator *allocator, void *self)
{
    krylov *k = self;
    if (!k) return;
    if (k->solver) SUNLinSolFree(k->solver);
    mps__space_release(&k->space);
    if (k->x) N_VDestroy(k->x);
    if (k->b) N_VDestroy(k->b);
    if (k->stop) N_VDestroy(k->stop);
    drop_arrays(k);
    mps__release(allocator, k->sums);
    if (k->space.context) SUNContext_Free(&k->space.context);
    mps__release(allocator, k);
}
