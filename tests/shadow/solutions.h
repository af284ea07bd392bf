/* SPDX-License-Identifier: BSD-3-Clause */
/* Equations solved on the host and on a device, with the same bytes, numbers and messages. Also
 * link conformance/solver_systems.c. */
#ifndef SHADOW_SOLUTIONS_H
#define SHADOW_SOLUTIONS_H

#include "device_memory.h"
#include "sim.h"
#include "solver_kit.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Results of a solution. */
typedef struct answer {
    mps_status status;
    mps_ppe_result result;
    char error[1024], log[1024];
    double *p;
} answer;

static inline void keep_log(void *user, int level, const char *text)
{
    char *log = user;
    (void)level;
    snprintf(log + strlen(log), 1024 - strlen(log), "%s;", text);
}

/* Solve with the pair in use, from p = first. */
static inline void solve(mps_sim *sim, mps__device *d, const mps_ppe_problem *problem, double first,
                         answer *a)
{
    mps__solvers *s = &sim->world.solvers;
    *a = (answer){.p = malloc((size_t)(problem->n + 1) * sizeof(double))};
    assert_non_null(a->p);
    for (int64_t i = 0; i < problem->n; i++) a->p[i] = first;
    sim->context.log = keep_log;
    sim->context.log_user = a->log;
    s->device = d;
    if (d) mps__device_begin(d);
    a->status = mps__solvers_solve(s, problem, a->p, &a->result);
    if (a->status != MPS_OK) snprintf(a->error, sizeof a->error, "%s", mps_sim_error(sim));
    a->result.setup_seconds = 0;
    s->device = NULL;
    sim->context.log = NULL;
}

/* One of the systems below, and how it ends. */
typedef struct solution {
    const char *what;
    int32_t reason;
    int32_t most;     /* iterations */
    double first;     /* guess */
    double tolerance; /* of the residual */
    void (*spoil)(kit_system *system);
} solution;

static inline void with_nan(kit_system *s)
{
    s->rhs[s->problem.n / 2] = NAN;
}

static inline void with_infinity(kit_system *s)
{
    s->rhs[3] = INFINITY;
}

static inline void with_zeros(kit_system *s)
{
    memset(s->rhs, 0, (size_t)s->problem.n * sizeof *s->rhs);
}

/* Not positive definite, though no row has a negative diagonal. */
static inline void with_curvature(kit_system *s)
{
    for (int64_t i = 0; i < s->problem.n; i++) s->diagonal[i] *= 0.3;
}

static inline void with_negative_row(kit_system *s)
{
    s->diagonal[5] = -s->diagonal[5];
}

static inline void with_infinite_row(kit_system *s)
{
    s->diagonal[7] = INFINITY;
}

/* Curvatures overflow. */
static inline void with_large_numbers(kit_system *s)
{
    for (int64_t i = 0; i < s->problem.n; i++) {
        s->diagonal[i] = 1e300;
        s->rhs[i] = 1e-3 * (double)(i + 1);
    }
    memset(s->val, 0, (size_t)s->row[s->problem.n] * sizeof *s->val);
    s->rhs[0] = 1e150;
}

/* An entry is not a number: the matrix, not the right side. */
static inline void with_nan_entry(kit_system *s)
{
    s->val[s->row[s->problem.n / 3]] = NAN;
}

static inline void without_weights(kit_system *s)
{
    s->problem.weight = NULL;
}

static inline void same_answers(const char *what, const char *preconditioner, const answer *host,
                                const answer *on_device, int64_t n)
{
    /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bytes count */
    if (memcmp(&host->result, &on_device->result, sizeof host->result) != 0)
        fail_msg("%s, %s: host reason %d, %d iterations, residual %.17g, divergence %.17g; device "
                 "%d, %d, %.17g, %.17g",
                 what, preconditioner, (int)host->result.reason, (int)host->result.iterations,
                 host->result.residual, host->result.divergence, (int)on_device->result.reason,
                 (int)on_device->result.iterations, on_device->result.residual,
                 on_device->result.divergence);
    assert_int_equal(host->status, on_device->status);
    assert_string_equal(host->error, on_device->error);
    assert_string_equal(host->log, on_device->log);
    if (memcmp(host->p, on_device->p, (size_t)n * sizeof *host->p) != 0)
        fail_msg("%s, %s: pressures differ", what, preconditioner);
}

/* Both sides, twice: the second time nothing is new. */
static inline void compare_solution(mps_sim *sim, const kit_lattice *lattice, const solution *c,
                                    const char *preconditioner)
{
    mps__device *d = &sim->world.runner.memory.device;
    kit_system *s = kit_lattice_system(lattice);
    mps_solver_limits limits = {.struct_size = sizeof limits,
                                .max_iterations = c->most,
                                .tolerance = c->tolerance,
                                .divergence = 1e-4};
    assert_non_null(s);
    assert_non_null(d);
    if (c->spoil) c->spoil(s);
    assert_int_equal(mps__solvers_set_limits(&sim->world.solvers, &limits), MPS_OK);
    for (int k = 0; k < 2; k++) {
        answer host, on_device;
        solve(sim, NULL, &s->problem, c->first, &host);
        solve(sim, d, &s->problem, c->first, &on_device);
        assert_true(d->info.launches > 0 && !d->cancel);
        same_answers(c->what, preconditioner, &host, &on_device, s->problem.n);
        if (c->reason >= 0 && host.result.reason != c->reason)
            fail_msg("%s, %s: reason %d, not %d: %s", c->what, preconditioner,
                     (int)host.result.reason, (int)c->reason, host.error);
        free(host.p);
        free(on_device.p);
    }
    kit_system_free(s);
}

/* All of them with each preconditioner, in 2-D and 3-D. The device is attached. `part` > 1: boxes
 * of that part of their sides, for a device that takes long; then some end otherwise. */
static inline void compare_solutions(mps_sim *sim, int part)
{
    static const kit_lattice lattices[] = {
        {.dim = 2, .nx = 60, .ny = 40, .nz = 1, .boxes = 1, .open = 1, .re = 3.1, .contrast = 1},
        {.dim = 2, .nx = 30, .ny = 40, .nz = 1, .boxes = 1, .open = 1, .re = 3.1, .contrast = 800},
        {.dim = 3, .nx = 16, .ny = 14, .nz = 12, .boxes = 1, .open = 1, .re = 2.1, .contrast = 1}};
    static const char *const preconditioner[] = {"none", "jacobi", "auxgrid"};
    static const solution cases[] = {
        {"converged", MPS_PPE_CONVERGED, 2000, 0, 1e-6, NULL},
        {"deep", -1, 2000, 0, 1e-13, NULL},
        {"without weights", MPS_PPE_CONVERGED, 2000, 0, 1e-6, without_weights},
        {"from a guess", MPS_PPE_CONVERGED, 2000, 300, 1e-6, NULL},
        {"from NaN", MPS_PPE_CONVERGED, 2000, NAN, 1e-6, NULL},
        {"1 iteration", MPS_PPE_MAX_ITERATIONS, 1, 0, 1e-6, NULL},
        {"3 iterations", MPS_PPE_MAX_ITERATIONS, 3, 0, 1e-9, NULL},
        {"8 iterations", MPS_PPE_MAX_ITERATIONS, 8, 0, 1e-12, NULL},
        {"9 iterations", MPS_PPE_MAX_ITERATIONS, 9, 0, 1e-12, NULL},
        {"16 iterations", MPS_PPE_MAX_ITERATIONS, 16, 0, 1e-14, NULL},
        {"NaN", MPS_PPE_NAN, 2000, 0, 1e-6, with_nan},
        {"infinity", MPS_PPE_NAN, 2000, 0, 1e-6, with_infinity},
        {"NaN in the matrix", MPS_PPE_NAN, 2000, 0, 1e-6, with_nan_entry},
        {"zeros", MPS_PPE_CONVERGED, 2000, 0, 1e-6, with_zeros},
        {"zeros from a guess", MPS_PPE_CONVERGED, 2000, 5, 1e-6, with_zeros},
        {"wide tolerance", MPS_PPE_CONVERGED, 2000, 0, 0.9, without_weights},
        {"negative curvature", MPS_PPE_INDEFINITE, 2000, 0, 1e-6, with_curvature},
        {"negative row", MPS_PPE_INDEFINITE, 2000, 0, 1e-6, with_negative_row},
        {"infinite row", MPS_PPE_NAN, 2000, 0, 1e-6, with_infinite_row},
        {"large numbers", -1, 2000, 0, 1e-6, with_large_numbers}};
    for (size_t l = 0; l < sizeof lattices / sizeof lattices[0]; l++)
        for (int k = 0; k < 3; k++) {
            assert_int_equal(mps_solver_use(sim, "sundials.pcg", preconditioner[k]), MPS_OK);
            for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
                kit_lattice lattice = lattices[l];
                solution s = cases[c];
                lattice.nx /= part;
                lattice.ny /= part;
                if (lattice.dim == 3) lattice.nz /= part;
                if (part > 1) s.reason = -1;
                compare_solution(sim, &lattice, &s, preconditioner[k]);
            }
        }
}

#endif
