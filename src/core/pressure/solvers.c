/* SPDX-License-Identifier: BSD-3-Clause */
/* Registry of pressure solvers and preconditioners, and the solution with the selected pair. */
#include "solvers.h"
#include "loop.h"
#include "ppe/builtin.h"
#include <math.h>
#include <string.h>

static const mps_solver_limits default_limits = {
    .struct_size = sizeof(mps_solver_limits),
    .max_iterations = 2000,
    .tolerance = 1e-6,
    .divergence = 1e-4,
};

/* ---- names ---- */

static int find(char (*names)[MPS__NAME_SIZE], int count, const char *name)
{
    for (int k = 0; k < count; k++)
        if (strcmp(names[k], name) == 0) return k;
    return -1;
}

/* MPS_E_NAME with the nearest known name; `extra` is a name that is in no table, or NULL. */
static mps_status unknown(mps__context *c, const char *what, char (*names)[MPS__NAME_SIZE],
                          int count, const char *extra, const char *name)
{
    const char *list[MPS__SOLVERS_KNOWN + 1];
    char hint[MPS__HINT_SIZE];
    for (int k = 0; k < count; k++) list[k] = names[k];
    if (extra) list[count++] = extra;
    return mps__fail(c, MPS_E_NAME, "no %s is called '%.60s'; %s", what, name,
                     mps__hint(hint, '\'', name, list, count));
}

static mps_status check_new_name(mps__context *c, const char *what, char (*names)[MPS__NAME_SIZE],
                                 int count, const char *name)
{
    MPS__CHECK(c, name && name[0], "a %s needs a name", what);
    MPS__CHECK(c, strnlen(name, MPS__NAME_SIZE) < MPS__NAME_SIZE,
               "the name '%.60s...' of a %s is too long; at most %d characters", name, what,
               MPS__NAME_SIZE - 1);
    MPS__CHECK(c, find(names, count, name) < 0, "a %s called '%s' is registered already", what,
               name);
    MPS__CHECK(c, count < MPS__SOLVERS_KNOWN, "cannot register %s '%s': all %d places are taken",
               what, name, MPS__SOLVERS_KNOWN);
    return MPS_OK;
}

static mps_status check_api(mps__context *c, const char *what, uint32_t api)
{
    if (api == MPS_PPE_API) return MPS_OK;
    return mps__fail(c, MPS_E_VERSION, "the %s table has api %u; this library knows %u", what, api,
                     MPS_PPE_API);
}

/* ---- registration ---- */

mps_status mps__solvers_register(mps__solvers *s, const mps_solver_ops *ops)
{
    mps__context *c = s->context;
    mps_solver_ops copy = {0};
    MPS__TRY(mps__struct_in(c, "mps_solver_ops", &copy, sizeof copy, ops));
    MPS__TRY(check_api(c, "solver", copy.api));
    MPS__TRY(check_new_name(c, "solver", s->solver_name, s->solvers, copy.name));
    MPS__CHECK(c, copy.create && copy.solve && copy.destroy,
               "solver '%s' lacks create, solve or destroy", copy.name);
    int k = s->solvers;
    if (copy.preconditioner &&
        !mps__name_copy(s->default_name[k], MPS__NAME_SIZE, copy.preconditioner))
        return mps__fail(c, MPS_E_ARG,
                         "the default preconditioner of solver '%s' has an empty or too long name",
                         copy.name);
    mps__name_copy(s->solver_name[k], MPS__NAME_SIZE, copy.name);
    copy.struct_size = sizeof copy;
    copy.name = s->solver_name[k];
    if (copy.preconditioner) copy.preconditioner = s->default_name[k];
    s->solver[k] = copy;
    s->solvers++;
    return MPS_OK;
}

/* The fallback must solve what the preconditioner was selected for. The name becomes that of the
 * registry. */
static mps_status check_fallback(mps__solvers *s, mps_preconditioner_ops *pc)
{
    const int k = find(s->preconditioner_name, s->preconditioners, pc->fallback);
    if (k < 0)
        return unknown(s->context, "preconditioner", s->preconditioner_name, s->preconditioners,
                       NULL, pc->fallback);
    const mps_preconditioner_ops *other = &s->preconditioner[k];
    MPS__CHECK(s->context,
               (other->symmetric || !pc->symmetric) && (other->ranks || !pc->ranks) &&
                   (other->device || !pc->device) && !(other->reach > pc->reach),
               "the fallback '%s' of preconditioner '%s' needs its 'symmetric', 'ranks' and "
               "'device', and at most its 'reach' of %g",
               other->name, pc->name, pc->reach);
    pc->fallback = other->name;
    return MPS_OK;
}

mps_status mps__solvers_register_preconditioner(mps__solvers *s, const mps_preconditioner_ops *ops)
{
    mps__context *c = s->context;
    mps_preconditioner_ops copy = {0};
    MPS__TRY(mps__struct_in(c, "mps_preconditioner_ops", &copy, sizeof copy, ops));
    MPS__TRY(check_api(c, "preconditioner", copy.api));
    MPS__TRY(
        check_new_name(c, "preconditioner", s->preconditioner_name, s->preconditioners, copy.name));
    MPS__CHECK(c, strcmp(copy.name, "none") != 0, "a preconditioner cannot be called 'none'");
    MPS__CHECK(c, copy.create && copy.setup && copy.apply && copy.destroy,
               "preconditioner '%s' lacks create, setup, apply or destroy", copy.name);
    if (copy.fallback) MPS__TRY(check_fallback(s, &copy));
    int k = s->preconditioners;
    mps__name_copy(s->preconditioner_name[k], MPS__NAME_SIZE, copy.name);
    copy.struct_size = sizeof copy;
    copy.name = s->preconditioner_name[k];
    s->preconditioner[k] = copy;
    s->preconditioners++;
    return MPS_OK;
}

/* ---- choice ---- */

static mps_status choose(mps__solvers *s, const char *solver, const char *preconditioner,
                         const mps_solver_ops **ops, const mps_preconditioner_ops **pc)
{
    mps__context *c = s->context;
    MPS__CHECK(c, solver, "solver is NULL; give a name");
    int k = find(s->solver_name, s->solvers, solver);
    if (k < 0) return unknown(c, "solver", s->solver_name, s->solvers, NULL, solver);
    *ops = &s->solver[k];
    *pc = NULL;
    const char *name = preconditioner ? preconditioner : (*ops)->preconditioner;
    if (!name || strcmp(name, "none") == 0) return MPS_OK;
    k = find(s->preconditioner_name, s->preconditioners, name);
    if (k < 0)
        return unknown(c, "preconditioner", s->preconditioner_name, s->preconditioners, "none",
                       name);
    *pc = &s->preconditioner[k];
    MPS__CHECK(c, (*ops)->preconditioner,
               "solver '%s' uses no preconditioner; give NULL or \"none\" instead of '%s'", solver,
               name);
    MPS__CHECK(c, !(*ops)->symmetric || (*pc)->symmetric,
               "solver '%s' needs a symmetric preconditioner; '%s' is not", solver, name);
    return MPS_OK;
}

static void discard(mps__solvers *s)
{
    const mps_allocator *allocator = &s->context->allocator;
    if (s->fallback_made) s->fallback->destroy(allocator, s->fallback_self);
    s->fallback_made = false;
    if (s->use) s->use->destroy(allocator, s->use_self);
    if (s->pc) s->pc->destroy(allocator, s->pc_self);
    s->use = NULL;
    s->pc = s->fallback = NULL;
    s->use_self = s->pc_self = NULL;
}

mps_status mps__solvers_use(mps__solvers *s, const char *solver, const char *preconditioner)
{
    const mps_solver_ops *ops = NULL;
    const mps_preconditioner_ops *pc = NULL;
    const mps_status status = choose(s, solver, preconditioner, &ops, &pc);
    if (status < 0 || !ops) return status;
    void *self = ops->user, *pc_self = pc ? pc->user : NULL;
    if (ops->create(&s->context->allocator, &self))
        return mps__fail(s->context, MPS_E_NOMEM, "no memory for solver '%s'", ops->name);
    if (pc && pc->create(&s->context->allocator, &pc_self)) {
        ops->destroy(&s->context->allocator, self);
        return mps__fail(s->context, MPS_E_NOMEM, "no memory for preconditioner '%s'", pc->name);
    }
    discard(s);
    s->use = ops;
    s->pc = pc;
    if (pc && pc->fallback)
        s->fallback =
            &s->preconditioner[find(s->preconditioner_name, s->preconditioners, pc->fallback)];
    s->use_self = self;
    s->pc_self = pc_self;
    return MPS_OK;
}

mps_status mps__solvers_init(mps__solvers *s, mps__context *context)
{
    *s = (mps__solvers){.context = context, .limits = default_limits};
    for (int k = 0; mps__builtin_solvers[k]; k++) {
        mps_solver_ops ops = *mps__builtin_solvers[k];
        ops.user = context;
        MPS__TRY(mps__solvers_register(s, &ops));
    }
    s->built_in_solvers = s->solvers;
    for (int k = 0; mps__builtin_preconditioners[k]; k++)
        MPS__TRY(mps__solvers_register_preconditioner(s, mps__builtin_preconditioners[k]));
    s->built_in_preconditioners = s->preconditioners;
    return mps__solvers_use(s, s->solver_name[0], NULL);
}

void mps__solvers_free(mps__solvers *s)
{
    if (s->context) discard(s); /* else nothing was allocated */
}

/* ---- limits ---- */

mps_status mps_solver_limits_init(mps_solver_limits *limits, size_t size)
{
    return mps__struct_init("mps_solver_limits", limits, size, &default_limits,
                            sizeof default_limits);
}

mps_status mps__solvers_set_limits(mps__solvers *s, const mps_solver_limits *limits)
{
    mps__context *c = s->context;
    mps_solver_limits copy = default_limits;
    MPS__TRY(mps__struct_in(c, "mps_solver_limits", &copy, sizeof copy, limits));
    if (copy.max_iterations == 0) copy.max_iterations = default_limits.max_iterations;
    if (copy.tolerance == 0) copy.tolerance = default_limits.tolerance;
    MPS__CHECK(c, copy.max_iterations > 0,
               "max_iterations is %d; allowed: at least 1, or 0 for the default",
               copy.max_iterations);
    MPS__CHECK(c, copy.tolerance > 0 && copy.tolerance < 1,
               "tolerance is %g; allowed: between 0 and 1, or 0 for the default", copy.tolerance);
    MPS__CHECK(c, copy.divergence >= 0 && isfinite(copy.divergence),
               "divergence is %g; allowed: at least 0, finite", copy.divergence);
    copy.struct_size = sizeof copy;
    s->limits = copy;
    return MPS_OK;
}

/* ---- solution ---- */

static const char *reason_text(int32_t reason)
{
    static const char *const texts[] = {
        "converged",
        "did not converge",
        "met a direction of negative curvature (matrix or preconditioner is not positive definite)",
        "met NaN or infinity",
        "broke down",
        "ran out of memory",
    };
    bool known = reason >= 0 && reason < (int32_t)(sizeof texts / sizeof texts[0]);
    return known ? texts[reason] : "gave an unknown reason";
}

static mps_status status_of(int32_t reason)
{
    switch (reason) {
    case MPS_PPE_CONVERGED:
        return MPS_OK;
    case MPS_PPE_MAX_ITERATIONS:
        return MPS_W_NOT_CONVERGED;
    case MPS_PPE_NOMEM:
        return MPS_E_NOMEM;
    default:
        return MPS_E_SOLVER;
    }
}

/* The residual that a plug-in reports is verified. */
static mps_status verify(mps__solvers *s, const mps_ppe_problem *problem, const double *p,
                         mps_ppe_result *result)
{
    const mps_allocator *device = problem->device;
    double *work = device ? device->alloc(device->user, (size_t)(problem->n + 1) * sizeof *work)
                          : mps__alloc(s->context, problem->n, sizeof *work);
    if (!work) return MPS_E_NOMEM;
    mps_ppe_check(problem, p, work, result);
    if (device)
        device->release(device->user, work);
    else
        mps__free(s->context, work);
    if (result->residual <= 10 * problem->tolerance) return MPS_OK;
    result->reason = MPS_PPE_MAX_ITERATIONS;
    return MPS_W_NOT_CONVERGED;
}

/* Wrapper of the selected preconditioner: skips the set-up if that of a nearly equal matrix is
 * available. */
static int setup_unless_ready(void *self, const mps_ppe_problem *problem)
{
    mps__solvers *s = self;
    int reason = MPS_PPE_CONVERGED;
    if (!(s->again && s->ready)) reason = s->pc->setup(s->pc_self, problem);
    s->ready = reason == MPS_PPE_CONVERGED;
    return reason;
}

static int apply_in_use(void *self, const double *r, double *z)
{
    const mps__solvers *s = self;
    return s->pc->apply(s->pc_self, r, z);
}

/* One solution. The numbers that a plug-in reports are clamped to their ranges. */
static void run_solver(const mps__solvers *s, const mps_ppe_problem *problem,
                       const mps_preconditioner_ops *pc, void *pc_self, double *p,
                       mps_ppe_result *result)
{
    const int32_t most = problem->max_iterations;
    s->use->solve(s->use_self, problem, pc, pc_self, p, result);
    result->struct_size = sizeof *result;
    if (result->iterations < 0) result->iterations = 0;
    if (result->iterations > most) result->iterations = most;
    if (!(result->setup_seconds >= 0) || isinf(result->setup_seconds)) result->setup_seconds = 0;
}

/* Create the state of the fallback, once. False: out of memory. */
static bool make_fallback(mps__solvers *s)
{
    void *self = s->fallback->user;
    if (s->fallback_made) return true;
    if (s->fallback->create(&s->context->allocator, &self)) return false;
    s->fallback_self = self;
    s->fallback_made = true;
    return true;
}

void mps__solvers_run(mps__solvers *s, const mps_ppe_problem *problem, double *p,
                      mps_ppe_result *result)
{
    const mps_preconditioner_ops *spare = s->fallback;
    mps_ppe_result second = {.struct_size = sizeof second};
    mps_preconditioner_ops pc;
    if (s->pc) {
        pc = *s->pc;
        pc.setup = setup_unless_ready;
        pc.apply = apply_in_use;
        pc.setup_async = pc.setup_async || (s->again && s->ready);
    }
    run_solver(s, problem, s->pc ? &pc : NULL, s->pc ? s : NULL, p, result);
    const bool failed = result->reason == MPS_PPE_INDEFINITE || result->reason == MPS_PPE_BREAKDOWN;
    if (!failed || !spare || !make_fallback(s)) return;
    run_solver(s, problem, spare, s->fallback_self, p, &second);
    mps__log(s->context, MPS_LOG_WARNING,
             "preconditioner '%s' %s after %d iterations; with '%s' the solver %s", s->pc->name,
             reason_text(result->reason), result->iterations, spare->name,
             reason_text(second.reason));
    second.iterations += result->iterations;
    second.setup_seconds += result->setup_seconds;
    *result = second;
}

mps_status mps__solvers_solve(mps__solvers *s, const mps_ppe_problem *problem, double *p,
                              mps_ppe_result *result)
{
    return mps__solvers_solve_series(s, problem, &(mps__effort){.looser = 1}, p, result);
}

/* Error or warning text of a solution. */
static mps_status report(const mps__solvers *s, const mps_ppe_problem *problem,
                         const mps_ppe_result *result, mps_status status)
{
    return mps__fail(s->context, status,
                     "solver '%s' with preconditioner '%s' %s: %d iterations of at most %d, "
                     "residual %.3g (wanted %.3g), "
                     "divergence %.3g (wanted %.3g), %lld unknowns",
                     s->use->name, s->pc ? s->pc->name : "none", reason_text(result->reason),
                     result->iterations, problem->max_iterations, result->residual,
                     problem->tolerance, result->divergence, problem->divergence,
                     (long long)(problem->ranks ? problem->ranks->rows : problem->n));
}

mps_status mps__solvers_solve_series(mps__solvers *s, const mps_ppe_problem *problem,
                                     const mps__effort *effort, double *p, mps_ppe_result *result)
{
    mps_ppe_problem *limited = &s->problem;
    *limited = *problem;
    limited->tolerance = effort->looser * s->limits.tolerance;
    limited->divergence = effort->looser * s->limits.divergence;
    s->again = effort->again;
    s->ready = s->ready && effort->again;
    s->sent = s->sent && effort->again;
    limited->max_iterations = s->limits.max_iterations;
    *result = (mps_ppe_result){.struct_size = sizeof *result};
    if ((problem->ranks ? problem->ranks->rows : problem->n) == 0) return MPS_OK;
    if (mps__solvers_on_device(s, limited))
        MPS__TRY(mps__solvers_solve_device(s, p, result));
    else
        mps__solvers_run(s, limited, p, result);
    if (s->hint.refused) return MPS_E_SOLVER;
    mps_status status = status_of(result->reason);
    /* before the reduction over all ranks: they are in another call */
    if (result->reason == MPS_PPE_NOMEM) return report(s, limited, result, status);
    /* a finite residual implies finite pressures */
    double poison = mps__device_of(problem->parallel) ? !isfinite(result->residual)
                                                      : !mps__finite(p, problem->n);
    mps_ppe_total(problem, &(mps_exact_values){.maxima = 1, .maximum = &poison});
    if (status >= 0 && poison > 0) {
        result->reason = MPS_PPE_NAN;
        status = MPS_E_SOLVER;
    }
    if (status == MPS_OK && s->use >= &s->solver[s->built_in_solvers]) {
        status = verify(s, limited, p, result);
        if (status != MPS_W_NOT_CONVERGED) return status;
    }
    return report(s, limited, result, status);
}

/* ---- for plug-ins ---- */

mps_status mps_ppe_result_init(mps_ppe_result *result, size_t size)
{
    static const mps_ppe_result zero = {.struct_size = sizeof zero};
    return mps__struct_init("mps_ppe_result", result, size, &zero, sizeof zero);
}

double mps_ppe_law(double law, double p, double *slope)
{
    static const double least = 0.01; /* of 1 + p/P, down to which the logarithm is used */
    if (!(law > 0)) {
        if (slope) *slope = 1;
        return p;
    }
    const double share = 1 + p / law, used = share < least ? least : share;
    if (slope) *slope = 1 / used;
    return law * (mps_log(used) + (share - used) / used);
}

/* Payload of one reduction message. */
typedef struct total {
    int32_t sums, maxima;
    mps_exact sum[4];
    double maximum[4];
} total;

static void add_total(void *into, const void *from)
{
    total *a = into;
    const total *b = from;
    for (int32_t k = 0; k < a->sums; k++) mps_exact_join(&a->sum[k], &b->sum[k]);
    for (int32_t k = 0; k < a->maxima; k++)
        if (b->maximum[k] > a->maximum[k]) a->maximum[k] = b->maximum[k];
}

int mps_ppe_total(const mps_ppe_problem *problem, const mps_exact_values *values)
{
    total t = {.sums = values->sums, .maxima = values->maxima};
    if (!problem->ranks) return 0;
    for (int32_t k = 0; k < t.sums; k++) t.sum[k] = values->sum[k];
    for (int32_t k = 0; k < t.maxima; k++) t.maximum[k] = values->maximum[k];
    const int failed = mps_ppe_reduce(problem, 1, sizeof t, &t, add_total);
    /* not t.sums: a rank that runs out of memory in its solver may be in another reduction */
    for (int32_t k = 0; k < values->sums; k++) values->sum[k] = t.sum[k];
    for (int32_t k = 0; k < values->maxima; k++) values->maximum[k] = t.maximum[k];
    return failed;
}

static bool has_law(const mps_ppe_problem *problem)
{
    return problem->struct_size >= sizeof *problem && problem->law;
}

/* Arguments of the check's row functions: those of the problem. */
typedef struct check {
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *diagonal, *rhs, *weight, *gas, *law; /* the last three NULL: none */
    const double *p;
    double *r;
} check;

/* Squares of the residual and of the right side. A NaN loses every comparison, so it has a maximum
 * of its own, POISON. */
enum { SQUARES, RHS_SQUARES, SUMS };
enum { LARGEST, POISON, MAXIMA };

MPS_ROW void check_row(const check *c, int64_t i, double *values)
{
    const double *p = c->p;
    double s = c->diagonal[i] * p[i], *maxima = values + SUMS;
    for (int64_t k = c->row[i]; k < c->row[i + 1]; k++) s += (double)c->val[k] * p[c->col[k]];
    if (c->law && c->law[i] > 0) s += c->gas[i] * (mps_ppe_law(c->law[i], p[i], NULL) - p[i]);
    const double r = c->rhs[i] - s, d = c->weight ? fabs(r * c->weight[i]) : 0;
    c->r[i] = r;
    values[SQUARES] = r * r;
    values[RHS_SQUARES] = c->rhs[i] * c->rhs[i];
    if (d > maxima[LARGEST]) maxima[LARGEST] = d;
    if (0 * d != 0) maxima[POISON] = 1;
}
MPS__VALUES_ANY(check_rows, check_row, check, SUMS, MAXIMA)

mps_status mps_ppe_check(const mps_ppe_problem *problem, const double *p, double *work,
                         mps_ppe_result *result)
{
    MPS__TRY(mps__struct_check(NULL, "mps_ppe_result", result));
    mps_exact sums[SUMS] = {{{0}, 0, 0}};
    double maxima[MAXIMA] = {0};
    const mps_exact_values values = {SUMS, MAXIMA, sums, maxima};
    const bool laws = has_law(problem);
    const check seen = {.row = problem->row,
                        .col = problem->col,
                        .val = problem->val,
                        .diagonal = problem->diagonal,
                        .rhs = problem->rhs,
                        .weight = problem->weight,
                        .gas = laws ? problem->gas : NULL,
                        .law = laws ? problem->law : NULL,
                        .p = p,
                        .r = work};
    if (mps_ppe_halo(problem, (double *)p)) return MPS_E_RANKS;
    mps__values_run(problem->parallel, &check_rows, problem->dim, problem->n, &seen, sums, maxima);
    if (mps_ppe_total(problem, &values)) return MPS_E_RANKS;
    const double squares = mps_exact_value(&sums[SQUARES]),
                 rhs_squares = mps_exact_value(&sums[RHS_SQUARES]);
    result->residual = sqrt(squares) / (rhs_squares > 0 ? sqrt(rhs_squares) : 1);
    result->divergence = maxima[POISON] > 0 ? NAN : maxima[LARGEST];
    return MPS_OK;
}
