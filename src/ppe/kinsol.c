/* SPDX-License-Identifier: BSD-3-Clause */
/* sundials.kinsol: Newton's method with inner conjugate gradients, for a gas whose rows are
 * nonlinear; a linear problem takes one step.
 *      F(p) = A p + gas (f(p) - p) - b,   J = A + gas (f'(p) - 1).
 * J is an M-matrix and F is concave, so the first full step gives p below the solution, and the
 * following steps increase it to the solution from any guess (monotone convergence of Newton's
 * method). No line search and no bound on p are needed, because mps_ppe_law() is finite everywhere.
 *
 * All norms are excesses over the limits: the scaling vector of F is the stopping vector
 * (vector.h), so that KINSOL and its linear solver both stop at 1, and a step is not solved deeper
 * than needed. */
#include "builtin.h"
#include "rows.h"
#include <kinsol/kinsol.h>
#include <math.h>
#include <string.h>
#include <sunlinsol/sunlinsol_pcg.h>
#include "vector.h"

enum { CLONES = 9, MOST_STEPS = 60 }; /* KINSOL clones 5 vectors, conjugate gradients 4 */
static const double DEEPEST = 1e-10;  /* residual reduction of one linear solution */

typedef struct newton {
    mps__context *log; /* NULL: no log */
    mps__space space;
    void *kinsol;
    SUNLinearSolver solver;
    N_Vector p, one, stop;
    double *start, *residual, *inner, *slope, *ones; /* [capacity] */
    /* diagonal and row sums of J at the first guess, for the preconditioner */
    double *diagonal, *shift;
    mps__component *sums; /* [sum_capacity] */
    int64_t sum_capacity;
    /* of the solve in progress */
    const mps_ppe_problem *problem;
    mps_ppe_problem first; /* the linear problem of the first step */
    const mps_preconditioner_ops *pc;
    void *pc_self;
    int failure; /* failure in a callback, 0: none */
    bool pc_ready;
    double setup_seconds;
} newton;

/* ---- callbacks of SUNDIALS: a negative value stops the solver ---- */

static int residual(N_Vector vp, N_Vector vf, void *data)
{
    newton *k = data;
    double *f = mps__vector_data(vf);
    mps_ppe_result unused = {.struct_size = sizeof unused};
    mps__vector_written(vf);
    mps_ppe_check(k->problem, mps__vector_data(vp), f, &unused);
    for (int64_t i = 0; i < k->space.n; i++) f[i] = -f[i];
    /* remove the part in the null space, which rounding leaves */
    mps__components_center(k->problem, f, k->sums);
    return 0;
}

/* gas (f' - 1), the diagonal of J minus that of A. */
static void set_slope(newton *k, const double *p)
{
    for (int64_t i = 0; i < k->space.n; i++) {
        double slope;
        mps_ppe_law(k->problem->law[i], p[i], &slope);
        k->slope[i] = k->problem->gas[i] * (slope - 1);
    }
}

static int times(N_Vector vx, N_Vector vy, N_Vector vp, sunbooleantype *changed, void *data)
{
    (void)vp, (void)changed;
    newton *k = data;
    const double *x = mps__vector_data(vx);
    double *y = mps__vector_data(vy), curvature = mps__rows_multiply(k->problem, x, y);
    mps__vector_written(vy);
    if (k->problem->law) {
        for (int64_t i = 0; i < k->space.n; i++) y[i] += k->slope[i] * x[i];
        curvature = mps__vectors_dot(k->problem, x, y);
    }
    mps__space_remember(&k->space, x, y, curvature);
    if (!isfinite(curvature))
        k->failure = MPS_PPE_BREAKDOWN;
    else if (curvature <= 0)
        k->failure = mps__curvature_negative(k->problem, x, curvature) ? MPS_PPE_INDEFINITE
                                                                       : MPS_PPE_BREAKDOWN;
    return k->failure ? -1 : 0;
}

/* Before each step: remaining iterations, slopes at p, and once the set-up of the
 * preconditioner. */
static int begin_step(N_Vector vp, N_Vector scale, N_Vector f, N_Vector f_scale, void *data)
{
    (void)scale, (void)f, (void)f_scale;
    newton *k = data;
    long used = 0;
    KINGetNumLinIters(k->kinsol, &used);
    if (used >= k->problem->max_iterations) return -1;
    SUNLinSol_PCGSetMaxl(k->solver, k->problem->max_iterations - (int)used);
    if (k->problem->law) set_slope(k, mps__vector_data(vp));
    if (!k->pc || k->pc_ready) return 0;
    const double t = mps__seconds();
    k->failure = k->pc->setup(k->pc_self, &k->first);
    k->setup_seconds += mps__seconds() - t;
    k->pc_ready = !k->failure;
    return k->failure ? -1 : 0;
}

/* Replace r by z = M^-1 r. */
static int precondition(N_Vector vp, N_Vector scale, N_Vector f, N_Vector f_scale, N_Vector vr,
                        void *data)
{
    (void)vp, (void)scale, (void)f, (void)f_scale;
    newton *k = data;
    double *z = mps__vector_data(vr);
    memcpy(k->inner, z, (size_t)k->space.n * sizeof *z);
    mps__vector_written(vr);
    k->failure = k->pc->apply(k->pc_self, k->inner, z);
    if (k->failure) return -1;
    const double dot = mps__vectors_dot(k->problem, k->inner, z);
    if (!isfinite(dot))
        k->failure = MPS_PPE_NAN;
    else if (dot <= 0)
        k->failure = MPS_PPE_INDEFINITE;
    return k->failure ? -1 : 0;
}

/* ---- memory ---- */

static void drop_arrays(newton *k)
{
    double **all[] = {&k->start, &k->residual, &k->inner, &k->slope,
                      &k->ones,  &k->diagonal, &k->shift};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        mps__release(&k->space.allocator, *all[i]);
        *all[i] = NULL;
    }
    k->space.capacity = 0;
}

/* Allocate the arrays of the solver and of all vectors, of this length. */
static bool make_arrays(newton *k, int64_t capacity)
{
    const mps_allocator *a = &k->space.allocator;
    drop_arrays(k);
    double **all[] = {&k->start, &k->residual, &k->inner, &k->slope,
                      &k->ones,  &k->diagonal, &k->shift};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        *all[i] = mps__take(a, capacity, sizeof(double));
        if (!*all[i]) return false;
    }
    for (int64_t i = 0; i < capacity; i++) k->ones[i] = 1;
    mps__vector_point(k->one, k->ones);
    return mps__space_grow(&k->space, capacity);
}

/* Make all objects that SUNDIALS allocates, once, before the first step. */
static bool make_solver(newton *k)
{
    k->space.context = mps__sundials_context(k->log);
    if (!k->space.context) return false;
    k->p = mps__vector_wrap(&k->space, NULL);
    k->one = mps__vector_wrap(&k->space, NULL);
    k->stop = mps__vector_stop(&k->space);
    if (!k->p || !k->one || !k->stop || !mps__space_reserve(&k->space, CLONES)) return false;
    k->solver = SUNLinSol_PCG(k->p, SUN_PREC_LEFT, 0, k->space.context);
    k->kinsol = mps__kinsol_create(k->space.context, k->log);
    return k->solver && k->kinsol && !KINInit(k->kinsol, residual, k->p) &&
           !KINSetUserData(k->kinsol, k) && !KINSetLinearSolver(k->kinsol, k->solver, NULL) &&
           !KINSetJacTimesVecFn(k->kinsol, times) &&
           !KINSetPreconditioner(k->kinsol, begin_step, precondition) &&
           !KINSetMaxSetupCalls(k->kinsol, 1) && !KINSetMaxNewtonStep(k->kinsol, 1e200) &&
           !KINSetFuncNormTol(k->kinsol, 1.0) && !KINSetScaledStepTol(k->kinsol, 1e-15) &&
           !KINSetNumMaxIters(k->kinsol, MOST_STEPS);
}

static bool make_sums(newton *k, int64_t components)
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
static bool prepare(newton *k, const mps_ppe_problem *problem)
{
    k->space.n = problem->n;
    k->space.problem = problem;
    k->space.parallel = problem->parallel;
    k->space.weight = problem->divergence > 0 ? problem->weight : NULL;
    if (problem->component && !make_sums(k, problem->components)) return false;
    return problem->n <= k->space.capacity || make_arrays(k, problem->n + problem->n / 8);
}

/* ---- solution ---- */

/* J at p as a linear problem, for the preconditioner. */
static void linearise(newton *k, const double *p)
{
    const mps_ppe_problem *problem = k->problem;
    k->first = *problem;
    if (!problem->law) return;
    set_slope(k, p);
    for (int64_t i = 0; i < problem->n; i++) {
        k->shift[i] = problem->shift[i] + k->slope[i];
        k->diagonal[i] = problem->diagonal[i] + k->slope[i];
    }
    k->first.diagonal = k->diagonal;
    k->first.shift = k->shift;
    k->first.gas = k->first.law = NULL;
}

/* Depth of the linear solution of each step: a linear problem at once to its limits, others after
 * Eisenstat and Walker 1996, choice 2. */
static void set_forcing(newton *k, double excess)
{
    KINSetEtaForm(k->kinsol, k->problem->law ? KIN_ETACHOICE2 : KIN_ETACONSTANT);
    if (!k->problem->law) KINSetEtaConstValue(k->kinsol, fmin(fmax(0.5 / excess, DEEPEST), 0.5));
}

/* One run of KINSOL from p. */
static int run(newton *k, double *p, mps_ppe_result *result)
{
    long iterations = 0;
    k->failure = 0;
    mps__vector_point(k->p, p);
    SUNLinSol_PCGSetPrecType(k->solver, k->pc ? SUN_PREC_LEFT : SUN_PREC_NONE);
    const int flag = KINSol(k->kinsol, k->p, KIN_NONE, k->one, k->stop);
    KINGetNumLinIters(k->kinsol, &iterations);
    result->iterations = iterations < k->problem->max_iterations ? (int32_t)iterations
                                                                 : k->problem->max_iterations;
    result->setup_seconds = k->setup_seconds;
    mps__guess_clean(k->problem, p);
    mps__components_center(k->problem, p, k->sums);
    mps_ppe_check(k->problem, p, k->residual, result);
    if (mps__result_excess(k->problem, result) <= 1) return MPS_PPE_CONVERGED;
    if (flag == KIN_MEM_FAIL) return MPS_PPE_NOMEM;
    /* a recurrence that broke down at the level of rounding counts as an unfinished solution */
    return k->failure == MPS_PPE_BREAKDOWN || !k->failure ? MPS_PPE_MAX_ITERATIONS : k->failure;
}

static int attempt(newton *k, double *p, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = k->problem;
    const size_t bytes = (size_t)problem->n * sizeof *p;
    const double norm = sqrt(mps__vectors_dot(problem, problem->rhs, problem->rhs));
    if (norm == 0) memset(p, 0, bytes);
    if (!mps__guess_begin(k->problem, p, k->residual, k->sums, result)) return MPS_PPE_NAN;
    const double excess = mps__result_excess(problem, result);
    if (excess <= 1) return MPS_PPE_CONVERGED;
    if (!mps__rows_nonnegative(problem)) return MPS_PPE_INDEFINITE;
    memcpy(k->start, p, bytes);
    linearise(k, p);
    k->space.norm_limit = problem->tolerance * norm;
    k->space.divergence_limit = problem->divergence;
    k->pc_ready = false;
    k->setup_seconds = 0;
    set_forcing(k, excess);
    const int reason = run(k, p, result);
    const bool failed = reason != MPS_PPE_CONVERGED && reason != MPS_PPE_MAX_ITERATIONS;
    if (failed || !(mps__result_excess(problem, result) <= excess)) {
        memcpy(p, k->start, bytes);
        mps_ppe_check(problem, p, k->residual, result);
    }
    return reason;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    newton *k = self;
    if (!k) return;
    if (k->kinsol) KINFree(&k->kinsol);
    if (k->solver) SUNLinSolFree(k->solver);
    mps__space_release(&k->space);
    if (k->p) N_VDestroy(k->p);
    if (k->one) N_VDestroy(k->one);
    if (k->stop) N_VDestroy(k->stop);
    drop_arrays(k);
    mps__release(allocator, k->sums);
    if (k->space.context) SUNContext_Free(&k->space.context);
    mps__release(allocator, k);
}

static int create(const mps_allocator *allocator, void **self)
{
    newton *k = mps__take(allocator, 1, sizeof *k);
    if (!k) return MPS_PPE_NOMEM;
    *k = (newton){.log = *self, .space = {.allocator = *allocator, .arrays = *allocator}};
    if (make_solver(k)) {
        *self = k;
        return 0;
    }
    destroy(allocator, k);
    return MPS_PPE_NOMEM;
}

static void solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                  void *pc_self, double *p, mps_ppe_result *result)
{
    newton *k = self;
    mps__result_begin(result);
    mps__guess_clean(problem, p);
    if (!prepare(k, problem)) return;
    k->problem = problem;
    k->pc = pc;
    k->pc_self = pc_self;
    result->reason = attempt(k, p, result);
}

const mps_solver_ops mps__solver_kinsol = {
    .struct_size = sizeof(mps_solver_ops),
    .api = MPS_PPE_API,
    .name = "sundials.kinsol",
    .preconditioner = "auxgrid",
    .symmetric = 1,
    .create = create,
    .solve = solve,
    .destroy = destroy,
    .nonlinear = 1,
    .help = "Newton's method with conjugate gradients, for nonlinear rows (gas.isentropic) too",
};
