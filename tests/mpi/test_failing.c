/* SPDX-License-Identifier: BSD-3-Clause */
/* Behaviour of all ranks when one of them fails, stops, does not respond or dies.
 * usage: test_failing [kill]      kill: rank 1 dies in a step, and mpirun must end the others */
#include <mps/model.h>
#include <mps/mpi.h>
#include <mps/mps.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 6, TEXT = 512 };

static int32_t rank, ranks;
static int wrong;

static void expect(int met, const char *what, const char *text)
{
    if (met) return;
    wrong = 1;
    printf("rank %d: not so: %s: %s\n", (int)rank, what, text);
}

/* All ranks, the failing one too, have the same text. */
static void expect_alike(const char *what, const char *text, const char *part)
{
    expect(strstr(text, part) != NULL, what, text);
}

/* ---- a model that fails on rank 1 in the last step ---- */

static int steps;

static int fail_late(mps_stage *s)
{
    return rank == 1 && steps == STEPS ? mps_stage_fail(s, "no more water") : 0;
}

static const mps_verb verbs[] = {{.hook = MPS_FORCE, .run = fail_late}};
static const mps_model_ops failing = {.struct_size = sizeof(mps_model_ops),
                                      .api = MPS_MODEL_API,
                                      .name = "test.failing",
                                      .help = "Fails on rank 1",
                                      .verb_count = 1,
                                      .verbs = verbs};

static int64_t left = -1; /* allocations of rank 1 until one fails; -1: none does */

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

static mps_sim *open_dam(const mps_model_ops *model)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.3, 0.26, 0};
    mps_sim *sim = NULL;
    mps_config config;
    mps_tank tank;
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    config.allocator = (mps_allocator){.alloc = take, .release = release};
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.6;
    tank.size[1] = 0.45;
    mps_status status = mps_sim_create(&config, &sim);
    if (status == MPS_OK) status = mps_mpi_attach(sim, MPI_COMM_WORLD);
    if (status == MPS_OK) status = mps_preset_use(sim, "imps");
    if (status == MPS_OK) status = mps_solver_use(sim, "sundials.pcg", "jacobi");
    if (status == MPS_OK && model) status = mps_model_register(sim, model);
    if (status == MPS_OK && model) status = mps_model_use(sim, model->name);
    if (status == MPS_OK) status = mps_tank_add(sim, &tank, NULL);
    if (status == MPS_OK) status = mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
    expect(status == MPS_OK, "dam", mps_sim_error(sim));
    return sim;
}

static void check_model(void)
{
    mps_sim *sim = open_dam(&failing);
    mps_status status = MPS_OK;
    for (steps = 1; steps <= STEPS && status >= 0; steps++) status = mps_step(sim, 1, NULL);
    expect(steps == STEPS + 1, "the last step fails", "");
    expect(status == MPS_E_PLUGIN || (rank != 1 && status == MPS_E_RANKS), "status",
           mps_status_name(status));
    expect_alike("text of the model", mps_sim_error(sim), "no more water");
    if (rank != 1) expect_alike("which rank", mps_sim_error(sim), "rank 1 of");
    expect(mps_step(sim, 1, NULL) < 0, "no step after a failure", "");
    mps_sim_destroy(sim);
}

/* ---- a callback of a motion that fails on rank 1 ---- */

static int stop_moving(void *user, double t, mps_motion_state *state)
{
    (void)user, (void)state;
    return rank == 1 && t > 0.005;
}

static void check_motion(void)
{
    mps_sim *sim = open_dam(NULL);
    expect(mps_motion_callback_set(sim, stop_moving, NULL) == MPS_OK, "motion", mps_sim_error(sim));
    const mps_status status = mps_run(sim, 1, NULL, NULL);
    expect(status < 0, "a callback fails", mps_status_name(status));
    if (rank != 1) expect_alike("which rank", mps_sim_error(sim), "rank 1 of");
    mps_sim_destroy(sim);
}

/* ---- a monitor of rank 1 stops all, and they go on ---- */

static int stop_third(void *user, mps_sim *sim, const mps_step_info *info)
{
    (void)user, (void)sim;
    return rank == 1 && info->step == 3;
}

static void check_monitor(void)
{
    int64_t step = 0;
    mps_sim *sim = open_dam(NULL);
    const mps_status status = mps_run(sim, 1, stop_third, NULL);
    expect(status == MPS_W_STOPPED, "a monitor stops all", mps_status_name(status));
    mps_sim_time(sim, NULL, &step);
    expect(step == 3, "all stop in its step", "");
    expect(mps_step(sim, 1, NULL) >= 0, "a step after that", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* ---- a rank that does not answer ---- */

/* Rank 1 begins the step after it has failed on rank 0. */
static void check_watchdog(void)
{
    char noticed = 1;
    setenv("MPS_MPI_WATCHDOG", "1", 1);
    mps_sim *sim = open_dam(NULL);
    if (rank == 1) MPI_Recv(&noticed, 1, MPI_CHAR, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    const mps_status status = mps_step(sim, 1, NULL);
    if (rank == 0) MPI_Send(&noticed, 1, MPI_CHAR, 1, 0, MPI_COMM_WORLD);
    expect(status == MPS_E_RANKS, "a rank that does not answer is noticed",
           mps_status_name(status));
    expect_alike("the text says how long", mps_sim_error(sim),
                 "no answer from other ranks for 1 s");
    mps_sim_destroy(sim);
    unsetenv("MPS_MPI_WATCHDOG");
}

/* ---- a rank without memory ---- */

/* The k-th allocation of rank 1, and all later ones, fail: all ranks fail, or none. @return whether
 * they do */
static int check_allocation(int64_t k)
{
    int failed, all;
    mps_sim *sim = open_dam(NULL);
    left = rank == 1 ? k : -1;
    mps_status status = MPS_OK;
    for (int s = 0; s < 8 && status >= 0; s++) status = mps_step(sim, 1, NULL);
    left = -1;
    failed = status < 0;
    MPI_Allreduce(&failed, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    expect(all == 0 || all == ranks, "all ranks fail, or none", mps_status_name(status));
    mps_sim_destroy(sim);
    return failed;
}

static void check_memory(void)
{
    int64_t k = 0;
    while (check_allocation(k)) k += 1 + k / 8;
    expect(k > 10, "allocations of a step", "");
}

/* ---- calls that are refused ---- */

static void check_wrong(void)
{
    mps_sim *sim = NULL;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    expect(mps_sim_create(&config, &sim) == MPS_OK, "handle", "");
    expect(mps_mpi_attach(NULL, MPI_COMM_WORLD) == MPS_E_ARG, "no handle", "");
    expect(mps_mpi_attach(sim, MPI_COMM_NULL) == MPS_E_PLUGIN, "no communicator", "");
    expect_alike("why", mps_sim_error(sim), "MPI_COMM_NULL");
    if (rank == 1) setenv("MPS_MPI_WATCHDOG", "soon", 1);
    expect(mps_mpi_attach(sim, MPI_COMM_WORLD) == MPS_E_PLUGIN, "environment", "");
    expect_alike("why", mps_sim_error(sim), rank == 1 ? "is 'soon'" : "another rank");
    unsetenv("MPS_MPI_WATCHDOG");
    expect(mps_mpi_attach(sim, MPI_COMM_WORLD) == MPS_OK, "attached", mps_sim_error(sim));
    expect(mps_mpi_attach(sim, MPI_COMM_WORLD) == MPS_E_STATE, "twice", "");
    mps_sim_destroy(sim);
}

static void check_over(void)
{
    mps_sim *sim = NULL;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    expect(mps_sim_create(&config, &sim) == MPS_OK, "handle", "");
    expect(mps_mpi_attach(sim, MPI_COMM_WORLD) == MPS_E_PLUGIN, "MPI has ended", "");
    expect_alike("why", mps_sim_error(sim), "MPI has ended already");
    mps_sim_destroy(sim);
}

/* ---- a rank that dies ---- */

static int die(void *user, mps_sim *sim, const mps_step_info *info)
{
    (void)user, (void)sim;
    if (rank != 1 || info->step < STEPS) return 0;
    printf("rank 1 dies\n");
    fflush(stdout);
    return raise(SIGKILL);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc > 1 && strcmp(argv[1], "kill") == 0) {
        mps_run(open_dam(NULL), 1e6, die, NULL);
        printf("rank %d lives on\n", (int)rank);
        return 1;
    }
    check_wrong();
    check_model();
    check_motion();
    check_monitor();
    check_watchdog();
    check_memory();
    MPI_Finalize();
    check_over();
    return wrong;
}
