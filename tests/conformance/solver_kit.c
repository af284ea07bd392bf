/* SPDX-License-Identifier: BSD-3-Clause */
/* The checks of the solver kit; each builds its system, runs the pair and reports errors. */
#include "solver_kit.h"
#include "solver_ranks.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct pair {
    const mps_solver_ops *solver;
    const mps_preconditioner_ops *pc;
    int failures;
} pair;

#define EXPECT(k, condition, ...) expect((k), (condition), #condition, __LINE__, __VA_ARGS__)

__attribute__((format(printf, 5, 6))) static bool expect(pair *k, bool met, const char *condition,
                                                         int line, const char *format, ...)
{
    if (met) return true;
    k->failures++;
    va_list list;
    va_start(list, format);
    fprintf(stderr, "solver_kit.c:%d: %s + %s: %s is false: ", line,
            k->solver ? k->solver->name : "(alone)", k->pc ? k->pc->name : "none", condition);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    return false;
}

static bool all_finite(const double *p, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!isfinite(p[i])) return false;
    return true;
}

double kit_difference(const double *a, const double *b, int64_t n)
{
    double d = 0, s = 0;
    for (int64_t i = 0; i < n; i++) {
        d += (a[i] - b[i]) * (a[i] - b[i]);
        s += b[i] * b[i];
    }
    return s > 0 ? sqrt(d / s) : sqrt(d);
}

int kit_solve(const mps_solver_ops *solver, const mps_preconditioner_ops *pc, kit_memory *memory,
              const mps_ppe_problem *problem, double *p, mps_ppe_result *result)
{
    void *self = solver->user, *pc_self = pc ? pc->user : NULL;
    *result = (mps_ppe_result){.struct_size = sizeof *result, .reason = MPS_PPE_NOMEM};
    if (solver->create(&memory->allocator, &self)) return MPS_PPE_NOMEM;
    if (!pc || !pc->create(&memory->allocator, &pc_self)) {
        solver->solve(self, problem, pc, pc_self, p, result);
        if (pc) pc->destroy(&memory->allocator, pc_self);
    }
    solver->destroy(&memory->allocator, self);
    return result->reason;
}

/* True residual and divergence of p, written apart from the library. */
static void measure(const mps_ppe_problem *problem, const double *p, mps_ppe_result *result)
{
    double r2 = 0, b2 = 0;
    result->divergence = 0;
    for (int64_t i = 0; i < problem->n; i++) {
        double r = problem->rhs[i] - problem->diagonal[i] * p[i];
        for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++)
            r -= (double)problem->val[k] * p[problem->col[k]];
        r2 += r * r;
        b2 += problem->rhs[i] * problem->rhs[i];
        result->divergence = fmax(result->divergence, fabs(r * problem->weight[i]));
    }
    result->residual = sqrt(r2) / (b2 > 0 ? sqrt(b2) : 1);
}

/* Largest |mean| of p over the singular components, relative to the largest |p|. */
static double drift(const mps_ppe_problem *problem, const double *p)
{
    double worst = 0, largest = 1e-300;
    for (int32_t c = 0; problem->component && c < problem->components; c++) {
        double sum = 0, count = 0;
        for (int64_t i = 0; i < problem->n; i++) {
            if (problem->component[i] != c) continue;
            sum += p[i];
            count += 1;
            largest = fmax(largest, fabs(p[i]));
        }
        worst = fmax(worst, fabs(sum / count));
    }
    return worst / largest;
}

/* Requirements on every result, converged or not. */
static void check_honest(pair *k, const mps_ppe_problem *problem, const double *p,
                         const mps_ppe_result *result, const char *name)
{
    EXPECT(k, result->struct_size == sizeof *result,
           "%s: the solver changed result.struct_size to %u", name, result->struct_size);
    mps_ppe_result truth = {.struct_size = sizeof truth};
    if (!EXPECT(k, all_finite(p, problem->n), "%s: p is not finite, reason %d", name,
                result->reason))
        return;
    measure(problem, p, &truth);
    EXPECT(k, result->iterations >= 0 && result->iterations <= problem->max_iterations,
           "%s: %d iterations", name, result->iterations);
    if (result->reason != MPS_PPE_CONVERGED && result->reason != MPS_PPE_MAX_ITERATIONS) return;
    EXPECT(k, fabs(result->residual - truth.residual) <= 0.01 * truth.residual + 1e-14,
           "%s: residual %g, truly %g", name, result->residual, truth.residual);
    EXPECT(k, fabs(result->divergence - truth.divergence) <= 0.01 * truth.divergence + 1e-14,
           "%s: divergence %g, truly %g", name, result->divergence, truth.divergence);
    EXPECT(k, drift(problem, p) < 1e-12, "%s: a singular component has the mean %g", name,
           drift(problem, p));
    if (result->reason != MPS_PPE_CONVERGED) return;
    EXPECT(k, truth.residual <= 1.01 * problem->tolerance, "%s: residual %g above %g", name,
           truth.residual, problem->tolerance);
    if (problem->divergence > 0)
        EXPECT(k, truth.divergence <= 1.01 * problem->divergence, "%s: divergence %g above %g",
               name, truth.divergence, problem->divergence);
}

/* Solve from `guess` (NULL: zero) and check the general requirements. @return p, to be freed */
static double *solve(pair *k, const mps_ppe_problem *problem, const double *guess,
                     mps_ppe_result *result, const char *name)
{
    kit_memory memory;
    kit_memory_init(&memory);
    double *p = calloc((size_t)problem->n, sizeof *p);
    if (guess) memcpy(p, guess, (size_t)problem->n * sizeof *p);
    kit_solve(k->solver, k->pc, &memory, problem, p, result);
    check_honest(k, problem, p, result, name);
    EXPECT(k, memory.live == 0, "%s: %lld blocks leaked", name, (long long)memory.live);
    return p;
}

static void check_solution(pair *k, kit_system *s, double error, const char *name)
{
    mps_ppe_result result = {.struct_size = sizeof result};
    double *p = solve(k, &s->problem, NULL, &result, name);
    double d = kit_difference(p, s->exact, s->problem.n);
    EXPECT(k, result.reason == MPS_PPE_CONVERGED, "%s: reason %d, residual %g", name, result.reason,
           result.residual);
    EXPECT(k, d < error, "%s: solution off by %g", name, d);
    free(p);
}

/* ---- the checks ---- */

static void check_small(pair *k)
{
    static const double one[1] = {4}, tridiagonal[9] = {2, -1, 0, -1, 2, -1, 0, -1, 2},
                        exact[3] = {1, 2, -3};
    kit_system *s = kit_dense_system(1, one, exact);
    check_solution(k, s, 1e-12, "1 unknown");
    kit_system_free(s);
    s = kit_dense_system(3, tridiagonal, exact);
    check_solution(k, s, 1e-9, "3 unknowns");
    kit_system_free(s);
}

static const struct {
    const char *name;
    kit_lattice lattice;
} lattices[] = {
    {"2-D open", {2, 30, 24, 1, 1, 1, 3.1, 1, 0}},
    {"2-D two phases 1000:1", {2, 30, 24, 1, 1, 1, 3.1, 1000, 0}},
    {"3-D open", {3, 9, 8, 9, 1, 1, 2.1, 1, 0}},
    {"2-D compressible", {2, 30, 24, 1, 1, 0, 3.1, 1, 0.01}},
    {"2-D closed (one singular component)", {2, 30, 24, 1, 1, 0, 3.1, 1, 0}},
    {"2-D two singular components", {2, 20, 16, 1, 2, 0, 3.1, 1, 0}},
    {"2-D one open and two singular components", {2, 16, 12, 1, 3, 1, 3.1, 1, 0}},
    {"3-D closed", {3, 8, 8, 8, 1, 0, 2.1, 1, 0}},
    {"lone particles (empty rows)", {2, 1, 1, 1, 3, 0, 2.1, 1, 0}},
};

/* Densities of 1000:1 are beyond an iterative solver without its preconditioner. */
static bool too_hard(const pair *k, const kit_lattice *lattice)
{
    return lattice->contrast > 1 && k->solver->preconditioner && !k->pc;
}

static void check_lattices(pair *k)
{
    for (size_t i = 0; i < sizeof lattices / sizeof lattices[0]; i++) {
        if (too_hard(k, &lattices[i].lattice)) continue;
        kit_system *s = kit_lattice_system(&lattices[i].lattice);
        s->problem.tolerance = 1e-11;
        check_solution(k, s, 1e-7, lattices[i].name);
        kit_system_free(s);
    }
}

/* A loose norm with a tight divergence must reach the divergence. */
static void check_divergence(pair *k)
{
    if (too_hard(k, &lattices[1].lattice)) return;
    kit_system *s = kit_lattice_system(&lattices[1].lattice);
    mps_ppe_result result = {.struct_size = sizeof result};
    s->problem.tolerance = 0.1;
    s->problem.divergence = 1e-10;
    double *p = solve(k, &s->problem, NULL, &result, "divergence limit");
    EXPECT(k, result.reason == MPS_PPE_CONVERGED, "reason %d, divergence %g", result.reason,
           result.divergence);
    EXPECT(k, result.divergence <= s->problem.divergence, "divergence %g", result.divergence);
    free(p);
    kit_system_free(s);
}

static void check_zero_rhs(pair *k)
{
    for (int i = 0; i < 5; i += 4) { /* open and closed */
        kit_system *s = kit_lattice_system(&lattices[i].lattice);
        mps_ppe_result result = {.struct_size = sizeof result};
        memset(s->rhs, 0, (size_t)s->problem.n * sizeof *s->rhs);
        double *p = solve(k, &s->problem, s->exact, &result, "zero right side"), largest = 0;
        for (int64_t n = 0; n < s->problem.n; n++) largest = fmax(largest, fabs(p[n]));
        EXPECT(k, result.reason == MPS_PPE_CONVERGED && largest == 0, "reason %d, largest p %g",
               result.reason, largest);
        free(p);
        kit_system_free(s);
    }
}

static void check_warm_start(pair *k)
{
    for (int i = 0; i < 5; i += 4) {
        kit_system *s = kit_lattice_system(&lattices[i].lattice);
        mps_ppe_result result = {.struct_size = sizeof result};
        /* the pressure level of a closed tank is arbitrary: it must not need iterations */
        for (int64_t n = 0; i && n < s->problem.n; n++) s->exact[n] += 5000;
        double *p = solve(k, &s->problem, s->exact, &result, "warm start");
        EXPECT(k, result.reason == MPS_PPE_CONVERGED && result.iterations <= 1,
               "reason %d, %d iterations", result.reason, result.iterations);
        free(p);
        kit_system_free(s);
    }
}

/* The solver's answer to a spoiled system: the reason wanted, and p finite (seen by solve()). */
static void check_nan(pair *k)
{
    static const float bad[] = {NAN, INFINITY};
    static const char *const name[] = {"guess", "matrix", "diagonal", "rhs"};
    for (int which = 0; which < 8; which++) {
        kit_system *s = kit_lattice_system(&lattices[0].lattice);
        mps_ppe_result result = {.struct_size = sizeof result};
        double *where[] = {&s->exact[7], NULL, &s->diagonal[100], &s->rhs[50]};
        if (where[which % 4])
            *where[which % 4] = (double)bad[which / 4];
        else
            s->val[s->row[100] + 3] = bad[which / 4];
        double *p = solve(k, &s->problem, s->exact, &result, "NaN");
        int wanted = which % 4 == 0 ? MPS_PPE_CONVERGED
                                    : MPS_PPE_NAN; /* a bad guess is simply not used */
        EXPECT(k, result.reason == wanted, "%g in %s: reason %d", (double)bad[which / 4],
               name[which % 4], result.reason);
        free(p);
        kit_system_free(s);
    }
}

static void check_indefinite(pair *k)
{
    bool strict = k->solver->symmetric;
    for (int which = 0; which < 2; which++) {
        kit_system *s = kit_lattice_system(&lattices[0].lattice);
        mps_ppe_result result = {.struct_size = sizeof result};
        for (int64_t i = 0; i < s->problem.n; i++) {
            if (which == 0)
                s->diagonal[i] *= 0.6; /* negative curvature, positive diagonal */
            else if (i == 77)
                s->diagonal[i] = -s->diagonal[i];
        }
        double *p = solve(k, &s->problem, NULL, &result, "indefinite");
        if (strict)
            EXPECT(k, result.reason == MPS_PPE_INDEFINITE, "%s: reason %d",
                   which ? "negative diagonal" : "small diagonal", result.reason);
        free(p);
        kit_system_free(s);
    }
}

static void check_max_iterations(pair *k)
{
    kit_system *s = kit_lattice_system(&lattices[1].lattice);
    mps_ppe_result result = {.struct_size = sizeof result};
    for (int limit = 1; limit < 40; limit += 12) {
        s->problem.max_iterations = limit;
        double *p = solve(k, &s->problem, NULL, &result, "few iterations");
        bool direct = result.reason == MPS_PPE_CONVERGED && result.iterations == 0;
        EXPECT(k, direct || result.reason == MPS_PPE_MAX_ITERATIONS || limit > 1, "reason %d",
               result.reason);
        EXPECT(k, result.residual <= 1.0000001, "worse than the guess: residual %g",
               result.residual);
        free(p);
    }
    kit_system_free(s);
}

/* What cannot be reached ends as "not converged" with the best p, not as a failure. */
static void check_unreachable(pair *k)
{
    static const kit_lattice lattice = {2, 40, 30, 1, 1, 0, 3.1, 1, 0};
    kit_system *s = kit_lattice_system(&lattice);
    mps_ppe_result result = {.struct_size = sizeof result};
    s->problem.tolerance = 1e-18;
    double *p = solve(k, &s->problem, NULL, &result, "tolerance below rounding");
    EXPECT(k, result.reason == MPS_PPE_MAX_ITERATIONS && result.residual < 1e-10,
           "reason %d, residual %g", result.reason, result.residual);
    free(p);
    /* a right side with a part in the null space: the rest is solved */
    double push = 0;
    for (int64_t i = 0; i < s->problem.n; i++) push = fmax(push, 1e-3 * fabs(s->rhs[i]));
    for (int64_t i = 0; i < s->problem.n; i++) s->rhs[i] += push;
    s->problem.tolerance = 1e-8;
    p = solve(k, &s->problem, NULL, &result, "inconsistent right side");
    EXPECT(k, result.reason == MPS_PPE_MAX_ITERATIONS && result.residual < 0.9,
           "reason %d, residual %g", result.reason, result.residual);
    free(p);
    kit_system_free(s);
}

static void check_threads(pair *k)
{
    static const kit_lattice lattice = {2, 110, 90, 1, 1, 1, 2.1, 10, 0};
    kit_system *s = kit_lattice_system(&lattice);
    mps_ppe_result one = {.struct_size = sizeof one}, two = {.struct_size = sizeof two};
    s->problem.tolerance = 1e-4;
    double *p = solve(k, &s->problem, NULL, &one, "one thread");
    for (int threads = 2; threads <= 3; threads++) {
        const mps_parallel parallel = kit_parallel(threads);
        s->problem.parallel = &parallel;
        double *q = solve(k, &s->problem, NULL, &two, "more threads");
        EXPECT(k, memcmp(p, q, (size_t)s->problem.n * sizeof *p) == 0, "%d threads differ by %g",
               threads, kit_difference(q, p, s->problem.n));
        EXPECT(k, one.iterations == two.iterations && one.residual == two.residual,
               "%d threads: %d iterations, one: %d", threads, two.iterations, one.iterations);
        free(q);
    }
    free(p);
    kit_system_free(s);
}

/* One state for systems of varying size gives the same bytes as a new state. */
static void check_reuse(pair *k)
{
    static const int order[] = {4, 0, 2, 6, 0};
    kit_memory memory;
    kit_memory_init(&memory);
    void *self = k->solver->user, *pc_self = k->pc ? k->pc->user : NULL;
    bool made = !k->solver->create(&memory.allocator, &self) &&
                (!k->pc || !k->pc->create(&memory.allocator, &pc_self));
    for (size_t i = 0; made && i < sizeof order / sizeof order[0]; i++) {
        kit_system *s = kit_lattice_system(&lattices[order[i]].lattice);
        mps_ppe_result result = {.struct_size = sizeof result};
        double *p = calloc((size_t)s->problem.n, sizeof *p),
               *fresh = solve(k, &s->problem, NULL, &result, "fresh");
        k->solver->solve(self, &s->problem, k->pc, pc_self, p, &result);
        EXPECT(k, memcmp(p, fresh, (size_t)s->problem.n * sizeof *p) == 0,
               "a used state differs by %g", kit_difference(p, fresh, s->problem.n));
        free(p);
        free(fresh);
        kit_system_free(s);
    }
    if (self) k->solver->destroy(&memory.allocator, self);
    if (pc_self) k->pc->destroy(&memory.allocator, pc_self);
    EXPECT(k, made && memory.live == 0, "%lld blocks leaked", (long long)memory.live);
}

static void check_memory(pair *k)
{
    kit_system *s = kit_lattice_system(&lattices[5].lattice);
    double *p = calloc((size_t)s->problem.n, sizeof *p);
    int reason = MPS_PPE_NOMEM;
    for (int64_t fail_at = 1; reason == MPS_PPE_NOMEM && fail_at < 1000; fail_at++) {
        kit_memory memory;
        mps_ppe_result result = {.struct_size = sizeof result};
        kit_memory_init(&memory);
        memory.fail_at = fail_at;
        reason = kit_solve(k->solver, k->pc, &memory, &s->problem, p, &result);
        EXPECT(k, memory.live == 0, "allocation %lld failed: %lld blocks leaked",
               (long long)fail_at, (long long)memory.live);
        EXPECT(k, all_finite(p, s->problem.n), "allocation %lld failed: p is not finite",
               (long long)fail_at);
        EXPECT(k, reason == MPS_PPE_NOMEM || memory.count < fail_at,
               "allocation %lld failed: reason %d", (long long)fail_at, reason);
    }
    EXPECT(k, reason == MPS_PPE_CONVERGED, "reason %d in the end", reason);
    free(p);
    kit_system_free(s);
}

static void check_ranks(pair *k)
{
    char text[KIT_RANKS_TEXT] = "";
    const bool failed = kit_ranks_failed(k->solver, k->pc, text);
    EXPECT(k, !failed, "%s", text);
}

static bool table_complete(pair *k)
{
    const mps_solver_ops *s = k->solver;
    const mps_preconditioner_ops *pc = k->pc;
    EXPECT(k, s->struct_size >= sizeof *s && s->api == MPS_PPE_API && s->name,
           "solver table: struct_size %u, api %u", s->struct_size, s->api);
    EXPECT(k, s->create && s->solve && s->destroy, "an entry is NULL");
    if (pc)
        EXPECT(k, pc->create && pc->setup && pc->apply && pc->destroy,
               "an entry of the preconditioner is NULL");
    return k->failures == 0;
}

/* Returns the failures, which are already reported; reports a success otherwise. */
static int report(const pair *k, int checks)
{
    const char *const solver = k->solver ? k->solver->name : "", *const pc = k->pc && k->pc->name
                                                                                 ? k->pc->name
                                                                                 : "";
    if (k->failures == 0)
        printf("solver_kit: %s%s%s: passed; checks: %d\n", solver, solver[0] && pc[0] ? "/" : "",
               pc, checks);
    return k->failures;
}

int kit_check_solver(const mps_solver_ops *solver, const mps_preconditioner_ops *pc)
{
    static void (*const checks[])(pair *) = {
        check_small, check_lattices,   check_divergence,     check_zero_rhs,    check_warm_start,
        check_nan,   check_indefinite, check_max_iterations, check_unreachable, check_threads,
        check_reuse, check_memory,     check_ranks,
    };
    pair k = {solver, pc, 0};
    if (!table_complete(&k)) return k.failures;
    const int count = sizeof checks / sizeof checks[0];
    for (int i = 0; i < count; i++) checks[i](&k);
    return report(&k, count);
}

/* ---- a preconditioner alone ---- */

static double dot(const double *a, const double *b, int64_t n)
{
    double s = 0;
    for (int64_t i = 0; i < n; i++) s += a[i] * b[i];
    return s;
}

/* M^-1 of two vectors: linear, finite; symmetric and positive definite if its table says so. */
static void check_apply(pair *k, void *self, const kit_system *s, const char *name)
{
    int64_t n = s->problem.n;
    double *u = calloc(5 * (size_t)n, sizeof *u), *v = u + n, *mu = v + n, *mv = mu + n,
           *sum = mv + n;
    for (int64_t i = 0; i < n; i++) {
        u[i] = s->rhs[i];
        v[i] = sin((double)(i * i % 97)) * fabs(s->rhs[(i * 31) % n]);
    }
    int bad = k->pc->apply(self, u, mu) | k->pc->apply(self, v, mv);
    for (int64_t i = 0; i < n; i++) v[i] += 2 * u[i];
    bad |= k->pc->apply(self, v, sum);
    for (int64_t i = 0; i < n; i++) {
        v[i] -= 2 * u[i];
        sum[i] -= 2 * mu[i];
    }
    EXPECT(k, !bad && all_finite(mu, 4 * n - n), "%s: apply failed or is not finite", name);
    EXPECT(k, kit_difference(sum, mv, n) < 1e-9, "%s: not linear, off by %g", name,
           kit_difference(sum, mv, n));
    if (k->pc->symmetric) {
        double scale = sqrt(fabs(dot(u, mu, n) * dot(v, mv, n)));
        EXPECT(k, dot(u, mu, n) > 0 && dot(v, mv, n) > 0, "%s: not positive", name);
        EXPECT(k, fabs(dot(u, mv, n) - dot(v, mu, n)) < 1e-9 * scale,
               "%s: not symmetric: %g against %g", name, dot(u, mv, n), dot(v, mu, n));
    }
    free(u);
}

int kit_check_preconditioner(const mps_preconditioner_ops *pc)
{
    pair k = {NULL, pc, 0};
    kit_memory memory;
    kit_memory_init(&memory);
    void *self = pc->user;
    if (!EXPECT(&k, !pc->create(&memory.allocator, &self), "create failed")) return k.failures;
    for (size_t i = 0; i + 1 < sizeof lattices / sizeof lattices[0]; i++) {
        kit_system *s = kit_lattice_system(&lattices[i].lattice);
        int reason = pc->setup(self, &s->problem);
        if (EXPECT(&k, reason == 0, "%s: setup gave %d", lattices[i].name, reason))
            check_apply(&k, self, s, lattices[i].name);
        kit_system_free(s);
    }
    pc->destroy(&memory.allocator, self);
    EXPECT(&k, memory.live == 0, "%lld blocks leaked", (long long)memory.live);
    if (pc->name) check_ranks(&k);
    return report(&k, pc->name ? 2 : 1);
}
