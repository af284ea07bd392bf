/* SPDX-License-Identifier: BSD-3-Clause */
/* hypre.boomeramg: the solver kit, the default solver on the same equations of real steps,
 * settings. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h needs those four before it */
#include <cmocka.h>
#include <math.h>
#include <mpi.h>
#include <mps/hypre.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/ppe/builtin.h"
#include "../conformance/solver_kit.h"

static mps_hypre_settings defaults(void)
{
    mps_hypre_settings settings;
    assert_int_equal(mps_hypre_settings_init(&settings, sizeof settings), MPS_OK);
    return settings;
}

static void test_kit(void **state)
{
    (void)state;
    mps_solver_ops ops;
    assert_int_equal(mps_hypre_solver(NULL, &ops), MPS_OK);
    assert_int_equal(kit_check_solver(&ops, NULL), 0);
}

/* Other methods do the work as well: symmetric Gauss-Seidel on classical coarse grids without any
 * limit. */
static void test_kit_settings(void **state)
{
    (void)state;
    mps_hypre_settings settings = defaults();
    mps_solver_ops ops;
    settings.coarsening = 6;
    settings.interpolation = 0;
    settings.row_entries = 0;
    settings.relaxation = 8;
    settings.sweeps = 2;
    settings.aggressive_levels = 0;
    settings.threshold = 0.25;
    assert_int_equal(mps_hypre_solver(&settings, &ops), MPS_OK);
    assert_int_equal(kit_check_solver(&ops, NULL), 0);
}

static int32_t iterations(const mps_hypre_settings *settings)
{
    static const kit_lattice lattice = {2, 80, 60, 1, 1, 1, 3.1, 1, 0};
    kit_system *s = kit_lattice_system(&lattice);
    mps_solver_ops ops;
    mps_ppe_result result = {.struct_size = sizeof result};
    kit_memory memory;
    double *p = calloc((size_t)s->problem.n, sizeof *p);
    kit_memory_init(&memory);
    s->problem.tolerance = 1e-6;
    assert_int_equal(mps_hypre_solver(settings, &ops), MPS_OK);
    assert_int_equal(kit_solve(&ops, NULL, &memory, &s->problem, p, &result), MPS_PPE_CONVERGED);
    free(p);
    kit_system_free(s);
    return result.iterations;
}

/* A setting reaches hypre: twice the relaxation needs fewer iterations. */
static void test_setting_works(void **state)
{
    (void)state;
    mps_hypre_settings settings = defaults();
    const int32_t usual = iterations(NULL);
    assert_in_range(usual, 2, 30);
    assert_int_equal(iterations(&settings), usual);
    settings.sweeps = 4;
    assert_true(iterations(&settings) < usual);
}

static void refused(const mps_hypre_settings *settings, const char *text)
{
    mps_solver_ops ops;
    assert_int_equal(mps_hypre_solver(settings, &ops), MPS_E_ARG);
    assert_string_equal(settings->error, text);
}

static void test_settings_refused(void **state)
{
    (void)state;
    char error[128];
    mps_hypre_settings good = defaults(), bad;
    mps_solver_ops ops;
    good.error = error;
    good.error_size = sizeof error;
    bad = good, bad.coarsening = 23;
    refused(&bad, "coarsening is 23; allowed: 0 to 22");
    bad = good, bad.interpolation = -1;
    refused(&bad, "interpolation is -1; allowed: 0 to 18");
    bad = good, bad.row_entries = 101;
    refused(&bad, "row_entries is 101; allowed: 0 to 100");
    bad = good, bad.sweeps = 0;
    refused(&bad, "sweeps is 0; allowed: 1 to 16");
    bad = good, bad.aggressive_levels = 26;
    refused(&bad, "aggressive_levels is 26; allowed: 0 to 25");
    bad = good, bad.relaxation = 3;
    refused(&bad, "relaxation is 3; allowed: 6, 7, 8, 16 and 18");
    bad = good, bad.threshold = NAN;
    refused(&bad, "threshold is nan; allowed: at least 0, below 1");
    assert_int_equal(mps_hypre_solver(&good, NULL), MPS_E_ARG);
    assert_string_equal(error, "ops is NULL");
    bad = good, bad.struct_size += 8;
    assert_int_equal(mps_hypre_solver(&bad, &ops), MPS_E_VERSION);
    bad.struct_size = 4;
    assert_int_equal(mps_hypre_solver(&bad, &ops), MPS_E_ARG);
    assert_int_equal(mps_hypre_settings_init(NULL, sizeof bad), MPS_E_ARG);
    assert_int_equal(mps_hypre_settings_init(&bad, 4), MPS_E_ARG);
    assert_int_equal(mps_hypre_solver(&good, &ops), MPS_OK);
}

/* ---- real steps ---- */

static double worst; /* largest difference of the two solutions of a step */

/* Solves by hypre.boomeramg and by sundials.pcg with auxgrid, both from zero, and keeps the
 * latter's solution. */
static void solve_both(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                       void *pc_self, double *p, mps_ppe_result *result)
{
    (void)self, (void)pc, (void)pc_self;
    mps_ppe_problem sharp = *problem;
    mps_solver_ops hypre;
    kit_memory memory;
    double *q = calloc((size_t)problem->n, sizeof *q);
    kit_memory_init(&memory);
    sharp.tolerance = 1e-10;
    memset(p, 0, (size_t)problem->n * sizeof *p);
    assert_int_equal(mps_hypre_solver(NULL, &hypre), MPS_OK);
    assert_int_equal(kit_solve(&hypre, NULL, &memory, &sharp, q, result), MPS_PPE_CONVERGED);
    assert_true(result->residual <= 1e-10);
    assert_int_equal(
        kit_solve(&mps__solver_pcg, &mps__preconditioner_auxgrid, &memory, &sharp, p, result),
        MPS_PPE_CONVERGED);
    worst = fmax(worst, kit_difference(q, p, problem->n));
    free(q);
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

static mps_sim *make_tank(int32_t dim, bool air)
{
    const double lo[3] = {0}, water[3] = {0.2, 0.2, 0.2}, rest[3] = {0.4, 0.4, 0.2};
    mps_config config;
    mps_tank tank;
    mps_phase gas;
    mps_sim *sim;
    mps_config_init(&config, sizeof config);
    config.dim = dim;
    config.dp = dim == 2 ? 0.01 : 0.025;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    mps_phase_init(&gas, sizeof gas);
    gas.density = 1.29;
    gas.viscosity = 1.8e-5;
    if (air) assert_int_equal(mps_preset_use(sim, "mmps"), MPS_OK);
    if (air) assert_int_equal(mps_phase_set(sim, 1, &gas), MPS_OK);
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, rest, sizeof rest);
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 0, lo, water, NULL, NULL), MPS_OK);
    if (air) assert_int_equal(mps_fill_box_add(sim, 1, lo, rest, NULL, NULL), MPS_OK);
    return sim;
}

static void take_steps(mps_sim *sim, int count)
{
    mps_step_info info;
    for (int k = 0; k < count; k++) {
        mps_step_info_init(&info, sizeof info);
        assert_int_equal(mps_step(sim, 2e-3, &info), MPS_OK);
        assert_true(info.ppe_unknowns > 0);
    }
}

/* A collapsing column of water: both solvers give the same pressure in each step, with a free
 * surface and with air around. */
static void test_against_pcg(void **state)
{
    (void)state;
    const mps_solver_ops both = {.struct_size = sizeof both,
                                 .api = MPS_PPE_API,
                                 .name = "test.both",
                                 .symmetric = 1,
                                 .create = create_nothing,
                                 .solve = solve_both,
                                 .destroy = destroy_nothing};
    for (int k = 0; k < 4; k++) {
        mps_sim *sim = make_tank(2 + k / 2, k % 2);
        assert_int_equal(mps_solver_register(sim, &both), MPS_OK);
        assert_int_equal(mps_solver_use(sim, "test.both", NULL), MPS_OK);
        worst = 0;
        take_steps(sim, 8);
        print_message("%d-D, %s: solutions differ by %.1e\n", 2 + k / 2,
                      k % 2 ? "water and air" : "water", worst);
        assert_true(worst < 1e-7);
        mps_sim_destroy(sim);
    }
}

/* By name on a handle; a setting that is changed is taken up when the solver is chosen again. */
static void test_registered(void **state)
{
    (void)state;
    mps_hypre_settings settings = defaults();
    mps_sim *sim = make_tank(2, false);
    const char *name = NULL, *preconditioner = "";
    settings.threshold = 2;
    assert_int_equal(mps_hypre_register(sim, &settings), MPS_E_ARG);
    settings.threshold = 0.6;
    assert_int_equal(mps_hypre_register(sim, &settings), MPS_OK);
    assert_int_equal(mps_hypre_register(sim, &settings), MPS_E_ARG); /* the name is taken */
    assert_int_equal(mps_solver_use(sim, "hypre.boomeramg", NULL), MPS_OK);
    assert_int_equal(mps_solver_name(sim, &name, &preconditioner), MPS_OK);
    assert_true(strcmp(name, "hypre.boomeramg") == 0 && strcmp(preconditioner, "none") == 0);
    take_steps(sim, 3);
    settings.relaxation = 8;
    assert_int_equal(mps_solver_use(sim, "hypre.boomeramg", NULL), MPS_OK);
    take_steps(sim, 3);
    assert_int_equal(mps_hypre_register(NULL, NULL), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* The library has initialised MPI, and does not finalise it. */
static void test_mpi_runs(void **state)
{
    (void)state;
    int running = 0, over = 1;
    assert_int_equal(mps_hypre_solver(NULL, &(mps_solver_ops){0}), MPS_OK);
    MPI_Initialized(&running);
    MPI_Finalized(&over);
    assert_true(running && !over);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mpi_runs),         cmocka_unit_test(test_kit),
        cmocka_unit_test(test_kit_settings),     cmocka_unit_test(test_setting_works),
        cmocka_unit_test(test_against_pcg),      cmocka_unit_test(test_registered),
        cmocka_unit_test(test_settings_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
