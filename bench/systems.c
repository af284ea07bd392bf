/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure equations of real steps: written by a plug-in solver, solved again from the file by any pair of solver and preconditioner. */
#include "../src/core/base/parallel.h"
#include "../src/ppe/builtin.h"
#include "bench.h"
#include <math.h>
#ifdef MPS_BENCH_HYPRE
#include <mps/hypre.h>
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct header {
    char magic[8];
    int32_t dim, components;
    int64_t n, entries;
    double dp;
} header;

static const char magic[8] = "mpsppe2";
static const char *record_file;

_Noreturn void bench_fail(const char *what, const char *why)
{
    fprintf(stderr, "mps_bench: %s: %s\n", what, why);
    exit(1);
}

/* ---- recording ---- */

typedef struct recorder {
    mps_allocator allocator;
    void *solver;
} recorder;

static int create(const mps_allocator *allocator, void **self)
{
    recorder *r = malloc(sizeof *r);
    if (!r) return MPS_PPE_NOMEM;
    r->allocator = *allocator;
    *self = r;
    return mps__solver_pcg.create(allocator, &r->solver);
}

static void put(FILE *f, const void *data, size_t size, int64_t count)
{
    if (fwrite(data, size, (size_t)count, f) != (size_t)count)
        bench_fail(record_file, "cannot be written");
}

static void write_system(const mps_ppe_problem *p, const double *guess)
{
    FILE *f = fopen(record_file, "wb");
    if (!f) bench_fail(record_file, "cannot be written");
    header h = {.dim = p->dim,
                .components = p->component ? p->components : 0,
                .n = p->n,
                .entries = p->row[p->n],
                .dp = p->dp};
    memcpy(h.magic, magic, sizeof magic);
    put(f, &h, sizeof h, 1);
    put(f, p->row, sizeof *p->row, p->n + 1);
    put(f, p->col, sizeof *p->col, h.entries);
    put(f, p->val, sizeof *p->val, h.entries);
    put(f, p->diagonal, sizeof *p->diagonal, p->n);
    put(f, p->rhs, sizeof *p->rhs, p->n);
    put(f, p->shift, sizeof *p->shift, p->n);
    put(f, p->weight, sizeof *p->weight, p->n);
    put(f, p->x, sizeof *p->x, p->n * p->dim);
    put(f, guess, sizeof *guess, p->n);
    if (h.components) put(f, p->component, sizeof *p->component, p->n);
    fclose(f);
}

static void solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                  void *pc_self, double *p, mps_ppe_result *result)
{
    recorder *r = self;
    write_system(problem, p);
    mps__solver_pcg.solve(r->solver, problem, pc, pc_self, p, result);
}

static void destroy(const mps_allocator *allocator, void *self)
{
    recorder *r = self;
    mps__solver_pcg.destroy(allocator, r->solver);
    free(r);
}

void bench_record(mps_sim *sim, const char *file)
{
    mps_solver_ops ops = mps__solver_pcg;
    ops.name = "bench.record";
    ops.create = create;
    ops.solve = solve;
    ops.destroy = destroy;
    record_file = file;
    if (mps_solver_register(sim, &ops) < 0 || mps_solver_use(sim, ops.name, NULL) < 0)
        bench_fail("recorder", mps_sim_error(sim));
}

/* ---- solving again ---- */

static void *get(FILE *f, const char *file, size_t size, int64_t count)
{
    void *data = malloc(size * (size_t)(count > 0 ? count : 1));
    if (!data) bench_fail(file, "no memory");
    if (fread(data, size, (size_t)count, f) != (size_t)count) bench_fail(file, "is too short");
    return data;
}

static double *read_system(const char *file, mps_ppe_problem *p)
{
    FILE *f = fopen(file, "rb");
    header h;
    if (!f) bench_fail(file, "cannot be read");
    if (fread(&h, sizeof h, 1, f) != 1 || memcmp(h.magic, magic, sizeof magic) != 0)
        bench_fail(file, "is no recorded equation");
    *p = (mps_ppe_problem){
        .struct_size = sizeof *p, .dim = h.dim, .n = h.n, .dp = h.dp, .components = h.components};
    p->row = get(f, file, sizeof *p->row, h.n + 1);
    p->col = get(f, file, sizeof *p->col, h.entries);
    p->val = get(f, file, sizeof *p->val, h.entries);
    p->diagonal = get(f, file, sizeof *p->diagonal, h.n);
    p->rhs = get(f, file, sizeof *p->rhs, h.n);
    p->shift = get(f, file, sizeof *p->shift, h.n);
    p->weight = get(f, file, sizeof *p->weight, h.n);
    p->x = get(f, file, sizeof *p->x, h.n * h.dim);
    double *guess = get(f, file, sizeof *guess, h.n);
    if (h.components) p->component = get(f, file, sizeof *p->component, h.n);
    fclose(f);
    return guess;
}

static void free_system(mps_ppe_problem *p, double *guess)
{
    const void *all[] = {p->row,   p->col,    p->val, p->diagonal,  p->rhs,
                         p->shift, p->weight, p->x,   p->component, guess};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) free((void *)(uintptr_t)all[k]);
}

/* The table of hypre.boomeramg, or NULL for other names and where it was not built. */
static const mps_solver_ops *hypre_solver(const char *name)
{
    if (strncmp(name, "hypre.", 6) != 0) return NULL;
#ifdef MPS_BENCH_HYPRE
    static mps_solver_ops ops;
    if (mps_hypre_solver(NULL, &ops) < 0) bench_fail(name, "hypre does not start");
    return &ops;
#else
    return NULL;
#endif
}

void bench_plugin(mps_sim *sim, const char *pair)
{
    const mps_solver_ops *ops = hypre_solver(pair);
    if (ops && mps_solver_register(sim, ops) < 0) bench_fail(pair, mps_sim_error(sim));
}

static const mps_solver_ops *find_solver(const char *name, size_t length)
{
    const mps_solver_ops *plugin = hypre_solver(name);
    if (plugin && strlen(plugin->name) == length && strncmp(plugin->name, name, length) == 0)
        return plugin;
    for (int k = 0; mps__builtin_solvers[k]; k++)
        if (strlen(mps__builtin_solvers[k]->name) == length &&
            strncmp(mps__builtin_solvers[k]->name, name, length) == 0)
            return mps__builtin_solvers[k];
    bench_fail(name, "no such solver");
}

static const mps_preconditioner_ops *find_preconditioner(const char *name)
{
    if (!name || strcmp(name, "none") == 0) return NULL;
    for (int k = 0; mps__builtin_preconditioners[k]; k++)
        if (strcmp(mps__builtin_preconditioners[k]->name, name) == 0)
            return mps__builtin_preconditioners[k];
    bench_fail(name, "no such preconditioner");
}

int bench_replay(const char *file, const char *pair, int32_t threads, double tolerance, int repeats)
{
    const char *slash = strchr(pair, '/');
    const mps_solver_ops *ops = find_solver(pair, slash ? (size_t)(slash - pair) : strlen(pair));
    const mps_preconditioner_ops *pc = find_preconditioner(slash ? slash + 1 : ops->preconditioner);
    bench_memory memory;
    mps_allocator allocator = bench_allocator(&memory);
    mps_ppe_problem problem;
    mps_ppe_result result = {.struct_size = sizeof result};
    double *guess = read_system(file, &problem), *p = malloc((size_t)problem.n * sizeof *p),
           least = INFINITY, setup = INFINITY, cpu = INFINITY;
    void *self = ops->user, *pc_self = pc ? pc->user : NULL;
    mps__context context = {.allocator = allocator};
    mps__pool pool;
    mps__pool_init(&pool, &context);
    mps__pool_resize(&pool, threads);
    problem.parallel = &pool.parallel;
    problem.tolerance = tolerance;
    problem.max_iterations = 2000;
    if (!p || ops->create(&allocator, &self) || (pc && pc->create(&allocator, &pc_self)))
        bench_fail(file, "no memory");
    for (int k = 0; k < repeats; k++) {
        memcpy(p, guess, (size_t)problem.n * sizeof *p);
        const double t = bench_wall(), before = bench_cpu();
        ops->solve(self, &problem, pc, pc_self, p, &result);
        least = fmin(least, bench_wall() - t);
        cpu = fmin(cpu, bench_cpu() - before);
        setup = fmin(setup, result.setup_seconds);
    }
    printf("%-24s %-24s %d thr %8lld unknowns %4d it  setup %.3f solve %.3f s/M  total %.3f ms  "
           "cpu %.3f s/M  residual %.1e  %4.0f "
           "B/unknown  reason %d\n",
           file, pair, threads, (long long)problem.n, result.iterations,
           1e6 * setup / (double)problem.n, 1e6 * (least - setup) / (double)problem.n, 1e3 * least,
           1e6 * cpu / (double)problem.n, result.residual, (double)memory.peak / (double)problem.n,
           result.reason);
    ops->destroy(&allocator, self);
    if (pc) pc->destroy(&allocator, pc_self);
    mps__pool_free(&pool);
    free(p);
    free_system(&problem, guess);
    return result.reason;
}
