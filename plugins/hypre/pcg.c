/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients around BoomerAMG. Each pass solves A d = b - A p from d = 0 and adds d to p;
 * passes are repeated until the true residual is small in both norms. On many ranks each sums its
 * rows, and the sums of the ranks are reduced exactly: all ranks have the same bytes and take the
 * same branches. */
#include "amg.h"
#include <math.h>
#include <string.h>
#include <time.h>

enum { IDLE_PASSES = 4, ARRAYS = 6 };
static const double DEEPEST = 1e-10; /* residual reduction of one pass */

/* A singular component. */
typedef struct component {
    double sum, rows; /* of this rank, then of all */
    mps_exact exact;
} component;

typedef struct pcg {
    mps__amg amg;
    mps_hypre_settings settings;
    double *block; /* [ARRAYS * capacity] memory of the arrays below */
    double *start, *residual, *d, *z, *direction, *image;
    component *sums; /* [sum_capacity] */
    int64_t capacity, sum_capacity;
    /* of the solve in progress */
    const mps_ppe_problem *problem;
    double norm_limit;
} pcg;

/* ---- small parts ---- */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Sum and maximum over the ranks, in one message; the sum is NaN after a failure. */
static void total(const mps_ppe_problem *problem, double *sum, double *most)
{
    mps_exact exact;
    if (!problem->ranks) return;
    mps_exact_begin(&exact);
    mps_exact_add(&exact, 1, sum);
    const mps_exact_values values = {.sums = 1, .maxima = 1, .sum = &exact, .maximum = most};
    *sum = mps_ppe_total(problem, &values) ? NAN : mps_exact_value(&exact);
}

int mps__hypre_worst(const mps_ppe_problem *problem, int reason)
{
    double none = 0, most = reason;
    total(problem, &none, &most);
    return none == 0 ? (int)most : MPS_PPE_BREAKDOWN;
}

static double dot_on_rank(const double *x, const double *y, int64_t n)
{
    double s = 0;
    for (int64_t i = 0; i < n; i++) s += x[i] * y[i];
    return s;
}

/* Zero a first guess that contains NaN or infinity. */
static void clean(const mps_ppe_problem *problem, double *p)
{
    double sum = 0; /* NaN if an entry is not finite */
    for (int64_t i = 0; i < problem->n; i++) sum += 0.0 * p[i];
    if (mps__hypre_worst(problem, sum != 0)) memset(p, 0, (size_t)problem->n * sizeof *p);
}

static void join(void *into, const void *from)
{
    component *a = into;
    const component *b = from;
    mps_exact_join(&a->exact, &b->exact);
    a->rows += b->rows;
}

/* Replace the sums of this rank by those of all ranks. */
static void join_components(const mps_ppe_problem *problem, component *sums)
{
    if (!problem->ranks) return;
    for (int32_t c = 0; c < problem->components; c++)
        mps_exact_add(&sums[c].exact, 1, &sums[c].sum);
    const int failed = mps_ppe_reduce(problem, problem->components, sizeof *sums, sums, join);
    for (int32_t c = 0; c < problem->components; c++)
        sums[c].sum = failed ? NAN : mps_exact_value(&sums[c].exact);
}

/* Subtract the mean of p over each singular component. */
static void center(const pcg *s, double *p)
{
    const mps_ppe_problem *problem = s->problem;
    const int32_t components = problem->component ? problem->components : 0;
    if (components < 1) return;
    /* including the bytes between members */
    memset(s->sums, 0, (size_t)components * sizeof *s->sums);
    for (int64_t i = 0; i < problem->n; i++) {
        const int32_t c = problem->component[i];
        if (c < 0) continue;
        s->sums[c].sum += p[i];
        s->sums[c].rows += 1;
    }
    join_components(problem, s->sums);
    for (int64_t i = 0; i < problem->n; i++) {
        const int32_t c = problem->component[i];
        if (c >= 0) p[i] -= s->sums[c].sum / s->sums[c].rows;
    }
}

/* image = A direction. @return their product */
static double multiply(const pcg *s)
{
    const mps_ppe_problem *problem = s->problem;
    double curvature = 0, none = 0;
    if (mps_ppe_halo(problem, s->direction)) return NAN;
    for (int64_t i = 0; i < problem->n; i++) {
        double sum = problem->diagonal[i] * s->direction[i];
        for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++)
            sum += (double)problem->val[k] * s->direction[problem->col[k]];
        s->image[i] = sum;
        curvature += sum * s->direction[i];
    }
    total(problem, &curvature, &none);
    return curvature;
}

/* Whether a negative curvature exceeds the rounding of a direction of zero curvature. */
static bool negative(const pcg *s, double curvature)
{
    double scale = 0, none = 0;
    for (int64_t i = 0; i < s->problem->n; i++)
        scale += s->problem->diagonal[i] * s->direction[i] * s->direction[i];
    total(s->problem, &scale, &none);
    return -curvature > 1e-12 * scale;
}

/* How far a residual is above the requested limits; at most 1: both are met. */
static double excess(const pcg *s, const double *r)
{
    const mps_ppe_problem *problem = s->problem;
    double largest = 0, squares = dot_on_rank(r, r, problem->n);
    if (problem->divergence > 0)
        for (int64_t i = 0; i < problem->n; i++)
            largest = fmax(largest, fabs(r[i] * problem->weight[i]) / problem->divergence);
    total(problem, &squares, &largest);
    /* other ranks failed: do not call hypre again */
    if (problem->ranks && isnan(squares)) return NAN;
    return fmax(largest, sqrt(squares) / s->norm_limit);
}

static double result_excess(const mps_ppe_problem *problem, const mps_ppe_result *result)
{
    const double norm = result->residual / problem->tolerance;
    return problem->divergence > 0 ? fmax(norm, result->divergence / problem->divergence) : norm;
}

/* ---- memory ---- */

static bool reserve(pcg *s, const mps_ppe_problem *problem)
{
    const mps_allocator *allocator = &s->amg.allocator;
    const int64_t components = problem->component ? problem->components : 0,
                  columns = mps__hypre_columns(problem);
    if (components > s->sum_capacity) {
        mps__hypre_release(allocator, s->sums);
        s->sums = mps__hypre_take(allocator, components, sizeof *s->sums);
        s->sum_capacity = s->sums ? components : 0;
        if (!s->sums) return false;
    }
    if (s->block && columns <= s->capacity) return true;
    mps__hypre_release(allocator, s->block);
    s->capacity = columns + columns / 8;
    s->block = mps__hypre_take(allocator, ARRAYS * s->capacity, sizeof *s->block);
    double **arrays[ARRAYS] = {&s->start, &s->residual, &s->d, &s->z, &s->direction, &s->image};
    for (int k = 0; k < ARRAYS; k++) *arrays[k] = s->block ? s->block + k * s->capacity : NULL;
    if (!s->block) s->capacity = 0;
    return s->block;
}

/* ---- solution ---- */

/* z = M^-1 r, projected onto the range of A. @return r'z in *product */
static int precondition(pcg *s, double *product)
{
    double reason = mps__amg_apply(&s->amg, s->residual, s->z);
    center(s, s->z);
    *product = dot_on_rank(s->residual, s->z, s->problem->n);
    total(s->problem, product, &reason);
    if (reason > 0) return (int)reason;
    return !isfinite(*product) ? MPS_PPE_NAN : *product <= 0 ? MPS_PPE_INDEFINITE : 0;
}

/* One step along the direction. */
static int advance(pcg *s, double product)
{
    const double curvature = multiply(s), step = product / curvature;
    if (!isfinite(curvature)) return MPS_PPE_BREAKDOWN;
    if (curvature <= 0) return negative(s, curvature) ? MPS_PPE_INDEFINITE : MPS_PPE_BREAKDOWN;
    for (int64_t i = 0; i < s->problem->n; i++) {
        s->d[i] += step * s->direction[i];
        s->residual[i] -= step * s->image[i];
    }
    return 0;
}

/* Solve A d = residual until the recursive residual is below the limit or after `most`
 * iterations. */
static int descend(pcg *s, double limit, int32_t most, int32_t *iterations)
{
    double product = 0, before;
    const int64_t n = s->problem->n;
    memset(s->d, 0, (size_t)n * sizeof *s->d);
    for (int32_t k = 0; k < most && excess(s, s->residual) > limit; k++) {
        before = product;
        int reason = precondition(s, &product);
        if (reason) return reason;
        const double beta = k ? product / before : 0;
        for (int64_t i = 0; i < n; i++)
            s->direction[i] = s->z[i] + (k ? beta * s->direction[i] : 0);
        reason = advance(s, product);
        if (reason) return reason;
        ++*iterations;
    }
    return 0;
}

static int pass(pcg *s, double *p, double share, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = s->problem;
    center(s, s->residual); /* remove the part in the null space, which rounding leaves */
    const double limit = fmax(share, DEEPEST * excess(s, s->residual));
    const int failure = descend(s, limit, problem->max_iterations - result->iterations,
                                &result->iterations);
    clean(problem, s->d);
    for (int64_t i = 0; i < problem->n; i++) p[i] += s->d[i];
    center(s, p);
    mps_ppe_check(problem, p, s->residual, result);
    return failure;
}

static int passes(pcg *s, double *p, mps_ppe_result *result)
{
    double best = result_excess(s->problem, result);
    bool first = true;
    for (int idle = 0; idle < IDLE_PASSES; first = false) {
        if (result->iterations >= s->problem->max_iterations) return MPS_PPE_MAX_ITERATIONS;
        const int failure = pass(s, p, first ? 1 : 0.5, result);
        const double now = result_excess(s->problem, result);
        if (now <= 1) return MPS_PPE_CONVERGED;
        const bool progress = now < 0.9 * best;
        /* a recurrence that broke down, or reached the level of rounding, may restart from its last
         * result */
        if (failure && (failure != MPS_PPE_BREAKDOWN || (first && !progress))) return failure;
        idle = progress ? 0 : idle + 1;
        best = fmin(best, now);
    }
    return MPS_PPE_MAX_ITERATIONS;
}

/* First guess and its residual; false: the residual of zero is not finite either. */
static bool begin(const pcg *s, double *p, mps_ppe_result *result)
{
    center(s, p);
    mps_ppe_check(s->problem, p, s->residual, result);
    if (isfinite(result->residual)) return true;
    memset(p, 0, (size_t)s->problem->n * sizeof *p);
    mps_ppe_check(s->problem, p, s->residual, result);
    return isfinite(result->residual);
}

static int setup(pcg *s, mps_ppe_result *result)
{
    const double t = seconds();
    int reason = 0;
    for (int64_t i = 0; i < s->problem->n; i++)
        if (s->problem->diagonal[i] < 0) reason = MPS_PPE_INDEFINITE;
    reason = mps__hypre_worst(s->problem, reason);
    if (reason) return reason;
    reason = mps__amg_setup(&s->amg, s->problem, &s->settings, s->direction);
    result->setup_seconds = seconds() - t;
    return reason;
}

static int attempt(pcg *s, double *p, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = s->problem;
    const size_t bytes = (size_t)problem->n * sizeof *p;
    double squares = dot_on_rank(problem->rhs, problem->rhs, problem->n), none = 0;
    total(problem, &squares, &none);
    const double norm = sqrt(squares);
    if (norm == 0) memset(p, 0, bytes);
    if (!begin(s, p, result)) return MPS_PPE_NAN;
    const double guessed = result_excess(problem, result);
    if (guessed <= 1) return MPS_PPE_CONVERGED;
    memcpy(s->start, p, bytes);
    int reason = setup(s, result);
    if (reason) return reason;
    s->norm_limit = problem->tolerance * (norm > 0 ? norm : 1);
    reason = passes(s, p, result);
    const bool failed = reason != MPS_PPE_CONVERGED && reason != MPS_PPE_MAX_ITERATIONS;
    if (failed || !(result_excess(problem, result) <= guessed)) {
        memcpy(p, s->start, bytes);
        mps_ppe_check(problem, p, s->residual, result);
    }
    return reason;
}

/* ---- verbs ---- */

/* *self holds the settings on entry, NULL for the defaults. */
int mps__hypre_create(const mps_allocator *allocator, void **self)
{
    const mps_hypre_settings *settings = *self;
    pcg *s = mps__hypre_take(allocator, 1, sizeof *s);
    *self = s;
    if (!s) return MPS_PPE_NOMEM;
    *s = (pcg){.amg = {.allocator = *allocator, .comm = mps__hypre_comm(settings)},
               .settings = settings ? *settings : mps__hypre_defaults};
    return 0;
}

void mps__hypre_solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                      void *pc_self, double *p, mps_ppe_result *result)
{
    (void)pc, (void)pc_self;
    pcg *s = self;
    result->reason = MPS_PPE_NOMEM;
    result->iterations = 0;
    result->residual = result->divergence = INFINITY;
    result->setup_seconds = 0;
    const mps_ppe_ranks *ranks = problem->ranks;
    const bool here = mps__hypre_place(s->amg.comm, ranks ? ranks->rank : 0,
                                       ranks ? ranks->ranks : 1);
    clean(problem, p);
    s->problem = problem;
    result->reason = !here ? MPS_PPE_BREAKDOWN : reserve(s, problem) ? 0 : MPS_PPE_NOMEM;
    result->reason = mps__hypre_worst(problem, result->reason);
    if (!result->reason) result->reason = attempt(s, p, result);
}

void mps__hypre_destroy(const mps_allocator *allocator, void *self)
{
    pcg *s = self;
    if (!s) return;
    mps__amg_release(&s->amg);
    mps__hypre_release(allocator, s->block);
    mps__hypre_release(allocator, s->sums);
    mps__hypre_release(allocator, s);
}
