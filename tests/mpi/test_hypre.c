/* SPDX-License-Identifier: BSD-3-Clause */
/* hypre.boomeramg on the ranks of MPI: the pressures of sundials.pcg on the same ranks, a rank
 * without memory, and communicators that are refused. */
#include "ppe/builtin.h"
#include <math.h>
#include <mps/hypre.h>
#include <mps/mpi.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int32_t rank, ranks;
static int wrong;

static void expect(int met, const char *what, const char *text)
{
    if (met) return;
    wrong = 1;
    printf("rank %d: not so: %s: %s\n", (int)rank, what, text);
}

/* ---- both solvers on each equation ---- */

static MPI_Comm world;
static int32_t iterations[2]; /* of hypre.boomeramg and sundials.pcg, all steps */
static double worst;          /* largest relative difference of the two solutions */
static int64_t least_rows;    /* of a rank */

static int64_t left = -1; /* allocations of this rank until one fails; -1: none does */

static void *take(void *user, size_t size)
{
    (void)user;
    if (left == 0) return NULL;
    if (left > 0) left--;
    return malloc(size);
}

static void release(void *user, void *block)
{
    (void)user;
    free(block);
}

static int create_nothing(const mps_allocator *allocator, void **self)
{
    (void)allocator, (void)self;
    return 0;
}

static void destroy_nothing(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
}

/* From zero, as sharp as it gets. */
static void solve_one(const mps_solver_ops *ops, const mps_ppe_problem *problem,
                      const mps_preconditioner_ops *pc, void *pc_self, double *p,
                      mps_ppe_result *result)
{
    const mps_allocator allocator = {.alloc = take, .release = release};
    mps_ppe_problem sharp = *problem;
    void *self = ops->user;
    sharp.tolerance = 1e-11;
    memset(p, 0, (size_t)problem->n * sizeof *p);
    expect(ops->create(&allocator, &self) == 0, "state", ops->name);
    ops->solve(self, &sharp, pc, pc_self, p, result);
    ops->destroy(&allocator, self);
    expect(result->reason == MPS_PPE_CONVERGED, "converged", ops->name);
    expect(result->residual <= 1e-11, "residual", ops->name);
}

static void compare(const double *q, const double *p, int64_t n)
{
    double sums[2] = {0};
    int64_t rows = n;
    for (int64_t i = 0; i < n; i++) {
        sums[0] += (q[i] - p[i]) * (q[i] - p[i]);
        sums[1] += p[i] * p[i];
    }
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, world);
    MPI_Allreduce(MPI_IN_PLACE, &rows, 1, MPI_INT64_T, MPI_MIN, world);
    worst = fmax(worst, sqrt(sums[0] / sums[1]));
    if (rows < least_rows) least_rows = rows;
}

/* Keeps the solution of sundials.pcg, with the preconditioner of the handle. */
static void solve_both(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                       void *pc_self, double *p, mps_ppe_result *result)
{
    const int64_t columns = problem->n + (problem->ranks ? problem->ranks->ghosts : 0);
    double *q = calloc((size_t)columns + 1, sizeof *q);
    (void)self;
    mps_hypre_settings settings;
    mps_solver_ops hypre;
    mps_hypre_settings_init(&settings, sizeof settings);
    settings.comm = &world;
    expect(mps_hypre_solver(&settings, &hypre) == MPS_OK, "table", "");
    expect(hypre.ranks == 1, "the table is for many ranks", "");
    solve_one(&hypre, problem, NULL, NULL, q, result);
    iterations[0] += result->iterations;
    solve_one(&mps__solver_pcg, problem, pc, pc_self, p, result);
    iterations[1] += result->iterations;
    compare(q, p, problem->n);
    free(q);
}

/* The k-th allocation of the last rank, and all later ones, fail: all ranks run out of memory.
 * @return the reason */
static int32_t solve_poor(const mps_solver_ops *ops, const mps_ppe_problem *problem, double *p,
                          int64_t k)
{
    const mps_allocator allocator = {.alloc = take, .release = release};
    mps_ppe_result result = {.struct_size = sizeof result};
    int32_t reasons[2];
    void *self = ops->user;
    memset(p, 0, (size_t)problem->n * sizeof *p);
    expect(ops->create(&allocator, &self) == 0, "state", ops->name);
    left = rank == ranks - 1 ? k : -1;
    ops->solve(self, problem, NULL, NULL, p, &result);
    left = -1;
    ops->destroy(&allocator, self);
    reasons[0] = result.reason;
    reasons[1] = -result.reason;
    MPI_Allreduce(MPI_IN_PLACE, reasons, 2, MPI_INT32_T, MPI_MAX, world);
    expect(reasons[0] == -reasons[1], "all ranks have one reason", "");
    return result.reason;
}

static void solve_poorly(void *self, const mps_ppe_problem *problem,
                         const mps_preconditioner_ops *pc, void *pc_self, double *p,
                         mps_ppe_result *result)
{
    (void)self, (void)pc, (void)pc_self;
    int64_t k = 0;
    mps_hypre_settings settings;
    mps_solver_ops hypre;
    mps_hypre_settings_init(&settings, sizeof settings);
    settings.comm = &world;
    expect(mps_hypre_solver(&settings, &hypre) == MPS_OK, "table", "");
    while (k < 100 && solve_poor(&hypre, problem, p, k) == MPS_PPE_NOMEM) k++;
    expect(k >= 5 && k < 100, "allocations of a solver", "");
    solve_one(&hypre, problem, NULL, NULL, p, result);
}

typedef void (*solve_fn)(void *self, const mps_ppe_problem *problem,
                         const mps_preconditioner_ops *pc, void *pc_self, double *p,
                         mps_ppe_result *result);

static mps_status use_solver(mps_sim *sim, solve_fn solve)
{
    const mps_solver_ops ops = {.struct_size = sizeof ops,
                                .api = MPS_PPE_API,
                                .name = "test.ranks",
                                .preconditioner = "auxgrid",
                                .symmetric = 1,
                                .create = create_nothing,
                                .solve = solve,
                                .destroy = destroy_nothing,
                                .ranks = 1};
    const mps_status status = mps_solver_register(sim, &ops);
    return status < 0 ? status : mps_solver_use(sim, ops.name, "auxgrid");
}

/* ---- scenes ---- */

typedef struct scene {
    const char *name;
    int32_t dim, steps;
    double dp, water[3];
    int air;   /* fills the rest: no row has a pressure datum */
    int empty; /* with 2 ranks and more, one has no row */
} scene;

static const scene scenes[] = {{"water, 2-D", 2, 8, 0.01, {0.2, 0.2, 0}, 0, 0},
                               {"water and air, 2-D", 2, 8, 0.01, {0.2, 0.2, 0}, 1, 0},
                               {"water, 3-D", 3, 4, 0.025, {0.2, 0.2, 0.2}, 0, 0},
                               {"water and air, 3-D", 3, 4, 0.025, {0.2, 0.2, 0.2}, 1, 0},
                               {"little water, 2-D", 2, 4, 0.01, {0.05, 0.05, 0}, 0, 1}};

static mps_sim *open_tank(const scene *s)
{
    const double lo[3] = {0}, all[3] = {0.4, 0.4, 0.2};
    mps_config config;
    mps_tank tank;
    mps_phase gas;
    mps_sim *sim = NULL;
    mps_config_init(&config, sizeof config);
    config.dim = s->dim;
    config.dp = s->dp;
    mps_phase_init(&gas, sizeof gas);
    gas.density = 1.29;
    gas.viscosity = 1.8e-5;
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, all, sizeof all);
    mps_status status = mps_sim_create(&config, &sim);
    if (status == MPS_OK) status = mps_mpi_attach(sim, world);
    if (status == MPS_OK && s->air) status = mps_preset_use(sim, "mmps");
    if (status == MPS_OK && s->air) status = mps_phase_set(sim, 1, &gas);
    if (status == MPS_OK) status = mps_tank_add(sim, &tank, NULL);
    if (status == MPS_OK) status = mps_fill_box_add(sim, 0, lo, s->water, NULL, NULL);
    if (status == MPS_OK && s->air) status = mps_fill_box_add(sim, 1, lo, all, NULL, NULL);
    expect(status == MPS_OK, s->name, mps_sim_error(sim));
    return sim;
}

static void check_scene(const scene *s)
{
    mps_sim *sim = open_tank(s);
    mps_status status = use_solver(sim, solve_both);
    worst = 0;
    iterations[0] = iterations[1] = 0;
    least_rows = INT64_MAX;
    for (int k = 0; k < s->steps && status == MPS_OK; k++) status = mps_step(sim, 2e-3, NULL);
    expect(status == MPS_OK, s->name, mps_sim_error(sim));
    expect(worst < 1e-9, s->name, "solutions differ");
    expect(!s->empty || ranks == 1 || least_rows == 0, s->name, "a rank has no row");
    if (rank == 0)
        printf("%s, %d ranks: solutions differ by %.1e; iterations a step: %.1f, sundials.pcg with "
               "auxgrid %.1f; at least %lld rows on a rank\n",
               s->name, (int)ranks, worst, (double)iterations[0] / s->steps,
               (double)iterations[1] / s->steps, (long long)least_rows);
    mps_sim_destroy(sim);
}

static void check_memory(const scene *s)
{
    mps_sim *sim = open_tank(s);
    mps_status status = use_solver(sim, solve_poorly);
    if (status == MPS_OK) status = mps_step(sim, 2e-3, NULL);
    expect(status == MPS_OK, "a rank without memory", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* Chosen by its name, without any other solver. */
static void check_name(void)
{
    mps_hypre_settings settings;
    mps_step_info info;
    mps_sim *sim = open_tank(&scenes[0]);
    mps_hypre_settings_init(&settings, sizeof settings);
    settings.comm = &world;
    mps_status status = mps_hypre_register(sim, &settings);
    if (status == MPS_OK) status = mps_solver_use(sim, "hypre.boomeramg", NULL);
    for (int k = 0; k < 4 && status == MPS_OK; k++) {
        mps_step_info_init(&info, sizeof info);
        status = mps_step(sim, 2e-3, &info);
        expect(info.ppe_iterations > 0, "iterations", "");
    }
    expect(status == MPS_OK, "steps", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* ---- communicators that are refused ---- */

static void refuse(const MPI_Comm *comm, mps_status expected, const char *part)
{
    char error[256] = "";
    mps_hypre_settings settings;
    mps_sim *sim = open_tank(&scenes[0]);
    mps_hypre_settings_init(&settings, sizeof settings);
    settings.error = error;
    settings.error_size = sizeof error;
    settings.comm = comm;
    const mps_status status = mps_hypre_register(sim, &settings);
    expect(status == expected, "refused", mps_status_name(status));
    expect(strstr(error, part) != NULL, part, error);
    mps_sim_destroy(sim);
}

/* A table that is registered without mps_hypre_register(): its first equation fails on all
 * ranks. */
static void check_other_ranks(const MPI_Comm *comm)
{
    mps_hypre_settings settings;
    mps_solver_ops ops;
    mps_sim *sim = open_tank(&scenes[0]);
    mps_hypre_settings_init(&settings, sizeof settings);
    settings.comm = comm;
    mps_status status = mps_hypre_solver(&settings, &ops);
    if (status == MPS_OK) status = mps_solver_register(sim, &ops);
    if (status == MPS_OK) status = mps_solver_use(sim, ops.name, NULL);
    expect(status == MPS_OK, "registered", mps_sim_error(sim));
    status = mps_step(sim, 2e-3, NULL);
    expect(status == MPS_E_SOLVER, "communicator of other ranks", mps_status_name(status));
    mps_sim_destroy(sim);
}

static void check_refused(void)
{
    const MPI_Comm none = MPI_COMM_NULL, own = MPI_COMM_SELF;
    MPI_Comm turned;
    refuse(&none, MPS_E_ARG, "comm is MPI_COMM_NULL");
    if (ranks == 1) return;
    refuse(NULL, MPS_E_STATE, "MPI_COMM_SELF has rank 0 of 1");
    refuse(&own, MPS_E_STATE, "comm has rank 0 of 1");
    check_other_ranks(&own);
    /* the first two ranks in reverse order */
    MPI_Comm_split(world, 0, rank < 2 ? 1 - rank : rank, &turned);
    check_other_ranks(&turned);
    MPI_Comm_free(&turned);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    world = MPI_COMM_WORLD;
    MPI_Comm_rank(world, &rank);
    MPI_Comm_size(world, &ranks);
    for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; k++) check_scene(&scenes[k]);
    for (int k = 0; k < 2; k++) check_memory(&scenes[k]);
    check_name();
    check_refused();
    MPI_Finalize();
    return wrong;
}
