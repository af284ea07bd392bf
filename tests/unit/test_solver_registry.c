/* SPDX-License-Identifier: BSD-3-Clause */
/* Choice, limits and registration of pressure solvers, and error texts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h needs those four before it */
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sim.h"

/* ---- a solver and a preconditioner with prescribed results ---- */

static int live;                /* states alive */
static int create_result;       /* what create answers */
static void *got_user;          /* value of *self on entry to the last create */
static mps_allocator made_by;   /* the allocator that create got */
static mps_ppe_result reported; /* what solve reports */
static double reported_p;       /* its resulting pressure */
static mps_ppe_problem seen;    /* the problem it got */

static int dummy_create(const mps_allocator *allocator, void **self)
{
    made_by = *allocator;
    got_user = *self;
    if (!create_result) live++;
    return create_result;
}

static void dummy_destroy(const mps_allocator *allocator, void *self)
{
    (void)self;
    assert_ptr_equal(allocator->user, made_by.user);
    assert_true(allocator->alloc == made_by.alloc && allocator->release == made_by.release);
    live--;
}

static void dummy_solve(void *self, const mps_ppe_problem *problem,
                        const mps_preconditioner_ops *pc, void *pc_self, double *p,
                        mps_ppe_result *result)
{
    (void)self, (void)pc, (void)pc_self;
    seen = *problem;
    p[0] = reported_p;
    *result = reported;
}

static int dummy_setup(void *self, const mps_ppe_problem *problem)
{
    (void)self, (void)problem;
    return 0;
}

static int dummy_apply(void *self, const double *r, double *z)
{
    (void)self, (void)r, (void)z;
    return 0;
}

static mps_solver_ops dummy_solver(const char *name, const char *pc)
{
    return (mps_solver_ops){.struct_size = sizeof(mps_solver_ops),
                            .api = MPS_PPE_API,
                            .name = name,
                            .preconditioner = pc,
                            .symmetric = 1,
                            .create = dummy_create,
                            .solve = dummy_solve,
                            .destroy = dummy_destroy};
}

static mps_preconditioner_ops dummy_preconditioner(const char *name)
{
    return (mps_preconditioner_ops){.struct_size = sizeof(mps_preconditioner_ops),
                                    .api = MPS_PPE_API,
                                    .name = name,
                                    .symmetric = 1,
                                    .create = dummy_create,
                                    .setup = dummy_setup,
                                    .apply = dummy_apply,
                                    .destroy = dummy_destroy};
}

/* ---- fixture ---- */

static int make_sim(void **state)
{
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = 0.01;
    live = create_result = 0;
    reported = (mps_ppe_result){.struct_size = sizeof reported};
    reported_p = 0;
    return mps_sim_create(&config, (mps_sim **)state);
}

static int drop_sim(void **state)
{
    mps_sim_destroy(*state);
    return live; /* states that were never destroyed */
}

static void expect_error(mps_sim *sim, mps_status got, mps_status wanted, const char *text)
{
    assert_int_equal(got, wanted);
    if (!strstr(mps_sim_error(sim), text)) fail_msg("'%s' lacks '%s'", mps_sim_error(sim), text);
}

static void expect_pair(const mps_sim *sim, const char *solver, const char *pc)
{
    const char *s, *p;
    assert_int_equal(mps_solver_name(sim, &s, &p), MPS_OK);
    assert_string_equal(s, solver);
    assert_string_equal(p, pc);
}

/* ---- tests ---- */

static void test_choice(void **state)
{
    mps_sim *sim = *state;
    expect_pair(sim, "sundials.pcg", "auxgrid");
    assert_int_equal(mps_solver_use(sim, "sundials.bicgstab", "ic0"), MPS_OK);
    expect_pair(sim, "sundials.bicgstab", "ic0");
    assert_int_equal(mps_solver_use(sim, "sundials.gmres", "none"), MPS_OK);
    expect_pair(sim, "sundials.gmres", "none");
    assert_int_equal(mps_solver_use(sim, "sundials.klu", NULL), MPS_OK);
    expect_pair(sim, "sundials.klu", "none");
    assert_int_equal(mps_solver_name(sim, NULL, NULL), MPS_OK);
}

static void test_wrong_names(void **state)
{
    mps_sim *sim = *state;
    expect_error(sim, mps_solver_use(sim, "sundials.pgc", NULL), MPS_E_NAME,
                 "did you mean 'sundials.pcg'");
    expect_error(sim, mps_solver_use(sim, "sundials.pcg", "jakobi"), MPS_E_NAME,
                 "did you mean 'jacobi'");
    expect_error(sim, mps_solver_use(sim, "sundials.pcg", "nome"), MPS_E_NAME,
                 "did you mean 'none'");
    expect_error(sim, mps_solver_use(sim, NULL, NULL), MPS_E_ARG, "NULL");
    expect_error(sim, mps_solver_use(sim, "sundials.klu", "jacobi"), MPS_E_ARG,
                 "uses no preconditioner");
    expect_pair(sim, "sundials.pcg", "auxgrid");
}

static void test_no_sim(void **state)
{
    (void)state;
    assert_int_equal(mps_solver_use(NULL, "sundials.pcg", NULL), MPS_E_ARG);
    assert_int_equal(mps_solver_name(NULL, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_solver_limits_set(NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_solver_register(NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_preconditioner_register(NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_solver_limits_init(NULL, sizeof(mps_solver_limits)), MPS_E_ARG);
}

static void test_limits(void **state)
{
    mps_sim *sim = *state;
    mps__solvers *s = &sim->world.solvers;
    mps_solver_limits limits;
    assert_int_equal(mps_solver_limits_init(&limits, sizeof limits), MPS_OK);
    assert_int_equal(limits.max_iterations, 2000);
    limits.tolerance = 1e-8;
    limits.max_iterations = 0;
    limits.divergence = 0;
    assert_int_equal(mps_solver_limits_set(sim, &limits), MPS_OK);
    assert_true(s->limits.tolerance == 1e-8 && s->limits.max_iterations == 2000 &&
                s->limits.divergence == 0);
    static const double bad[] = {-1e-6, 1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        limits.tolerance = bad[k];
        expect_error(sim, mps_solver_limits_set(sim, &limits), MPS_E_ARG, "tolerance is");
    }
    limits.tolerance = 1e-6;
    limits.max_iterations = -1;
    expect_error(sim, mps_solver_limits_set(sim, &limits), MPS_E_ARG, "max_iterations is -1");
    limits.max_iterations = 1;
    limits.divergence = NAN;
    expect_error(sim, mps_solver_limits_set(sim, &limits), MPS_E_ARG, "divergence is nan");
    limits.struct_size = 0;
    expect_error(sim, mps_solver_limits_set(sim, &limits), MPS_E_ARG, "struct_size");
    expect_error(sim, mps_solver_limits_set(sim, NULL), MPS_E_ARG, "NULL");
    assert_true(s->limits.tolerance == 1e-8 && s->limits.max_iterations == 2000);
}

static void test_register_solver(void **state)
{
    mps_sim *sim = *state;
    char name[] = "my.solver", pc_name[] = "ic0";
    mps_solver_ops ops = dummy_solver(name, pc_name);
    assert_int_equal(mps_solver_register(sim, &ops), MPS_OK);
    /* the table and its strings were copied */
    memset(&ops, 0, sizeof ops);
    name[0] = pc_name[0] = 'x';
    assert_int_equal(mps_solver_use(sim, "my.solver", NULL), MPS_OK);
    expect_pair(sim, "my.solver", "ic0");
    assert_int_equal(live, 1);
    assert_int_equal(mps_solver_use(sim, "sundials.pcg", NULL), MPS_OK);
    assert_int_equal(live, 0);
}

static void test_register_refused(void **state)
{
    mps_sim *sim = *state;
    mps_solver_ops ops = dummy_solver("sundials.pcg", NULL);
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_ARG, "registered already");
    ops = dummy_solver(NULL, NULL);
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_ARG, "needs a name");
    ops = dummy_solver("a name that is much longer than any name has to be in here", NULL);
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_ARG, "too long");
    ops = dummy_solver("my", "");
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_ARG, "default preconditioner");
    ops = dummy_solver("my", NULL);
    ops.solve = NULL;
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_ARG, "lacks");
    ops = dummy_solver("my", NULL);
    ops.api = MPS_PPE_API + 1;
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_VERSION, "api");
    ops = dummy_solver("my", NULL);
    ops.struct_size = offsetof(mps_solver_ops, solve); /* shorter than in 1.0.0 */
    expect_error(sim, mps_solver_register(sim, &ops), MPS_E_ARG, "version 1.0.0 has");

    expect_error(sim, mps_solver_register(sim, NULL), MPS_E_ARG, "NULL");
    expect_pair(sim, "sundials.pcg", "auxgrid");
}

static void test_register_preconditioner(void **state)
{
    mps_sim *sim = *state;
    mps_preconditioner_ops ops = dummy_preconditioner("mine");
    assert_int_equal(mps_preconditioner_register(sim, &ops), MPS_OK);
    expect_error(sim, mps_preconditioner_register(sim, &ops), MPS_E_ARG, "registered already");
    ops = dummy_preconditioner("none");
    expect_error(sim, mps_preconditioner_register(sim, &ops), MPS_E_ARG, "'none'");
    ops = dummy_preconditioner("no apply");
    ops.apply = NULL;
    expect_error(sim, mps_preconditioner_register(sim, &ops), MPS_E_ARG, "lacks");
    ops = dummy_preconditioner("skew");
    ops.symmetric = 0;
    assert_int_equal(mps_preconditioner_register(sim, &ops), MPS_OK);
    expect_error(sim, mps_solver_use(sim, "sundials.pcg", "skew"), MPS_E_ARG, "needs a symmetric");
    assert_int_equal(mps_solver_use(sim, "sundials.gmres", "skew"), MPS_OK);
    expect_pair(sim, "sundials.gmres", "skew");
}

/* Settings of a plug-in reach its create. */
static void test_user(void **state)
{
    mps_sim *sim = *state;
    int settings[2];
    mps_solver_ops ops = dummy_solver("my.solver", "mine"), old = dummy_solver("my.old", NULL);
    mps_preconditioner_ops pc = dummy_preconditioner("mine");
    ops.user = &settings[0];
    pc.user = &settings[1];
    assert_int_equal(mps_preconditioner_register(sim, &pc), MPS_OK);
    assert_int_equal(mps_solver_register(sim, &ops), MPS_OK);
    assert_int_equal(mps_solver_register(sim, &old), MPS_OK);
    assert_int_equal(mps_solver_use(sim, "my.solver", "none"), MPS_OK);
    assert_ptr_equal(got_user, &settings[0]);
    assert_int_equal(mps_solver_use(sim, "my.solver", NULL), MPS_OK);
    assert_ptr_equal(got_user, &settings[1]);
    assert_int_equal(mps_solver_use(sim, "my.old", NULL), MPS_OK);
    assert_null(got_user);
}

static void test_register_full(void **state)
{
    mps_sim *sim = *state;
    mps_status status = MPS_OK;
    char name[32];
    for (int k = 0; status == MPS_OK && k <= MPS__SOLVERS_KNOWN; k++) {
        snprintf(name, sizeof name, "solver %d", k);
        mps_solver_ops ops = dummy_solver(name, NULL);
        status = mps_solver_register(sim, &ops);
    }
    expect_error(sim, status, MPS_E_ARG, "places are taken");
    assert_int_equal(mps_solver_use(sim, "sundials.pcg", NULL), MPS_OK);
}

static void test_create_fails(void **state)
{
    mps_sim *sim = *state;
    mps_solver_ops ops = dummy_solver("my", "mine");
    mps_preconditioner_ops pc = dummy_preconditioner("mine");
    assert_int_equal(mps_solver_register(sim, &ops), MPS_OK);
    assert_int_equal(mps_preconditioner_register(sim, &pc), MPS_OK);
    create_result = 1;
    expect_error(sim, mps_solver_use(sim, "my", NULL), MPS_E_NOMEM, "solver 'my'");
    expect_error(sim, mps_solver_use(sim, "sundials.pcg", "mine"), MPS_E_NOMEM,
                 "preconditioner 'mine'");
    expect_pair(sim, "sundials.pcg", "auxgrid");
    create_result = 0;
}

/* One unknown: 2 p = 4. */
static mps_ppe_problem tiny(void)
{
    static const int64_t row[2] = {0, 0};
    static const int32_t col[1] = {0};
    static const float val[1] = {0};
    static const double diagonal[1] = {2}, rhs[1] = {4}, shift[1] = {2}, weight[1] = {1},
                        x[2] = {0};
    return (mps_ppe_problem){.struct_size = sizeof(mps_ppe_problem),
                             .dim = 2,
                             .n = 1,
                             .row = row,
                             .col = col,
                             .val = val,
                             .diagonal = diagonal,
                             .rhs = rhs,
                             .shift = shift,
                             .weight = weight,
                             .x = x,
                             .dp = 0.01};
}

static void test_solve_policy(void **state)
{
    mps_sim *sim = *state;
    mps__solvers *s = &sim->world.solvers;
    mps_solver_ops ops = dummy_solver("my", "jacobi");
    mps_ppe_problem problem = tiny();
    mps_ppe_result result = {.struct_size = sizeof result};
    double p = 0;
    static const struct {
        int reason;
        mps_status status;
        const char *text;
    } cases[] = {
        {MPS_PPE_CONVERGED, MPS_OK, ""},
        {MPS_PPE_MAX_ITERATIONS, MPS_W_NOT_CONVERGED,
         "solver 'my' with preconditioner 'jacobi' did not converge: 17 iterations of at most "
         "2000, "
         "residual 0.25 (wanted 1e-06), divergence 0.5 (wanted 0.0001)"},
        {MPS_PPE_INDEFINITE, MPS_E_SOLVER, "negative curvature"},
        {MPS_PPE_NAN, MPS_E_SOLVER, "NaN"},
        {MPS_PPE_BREAKDOWN, MPS_E_SOLVER, "broke down"},
        {MPS_PPE_NOMEM, MPS_E_NOMEM, "memory"},
        {99, MPS_E_SOLVER, "unknown reason"},
    };
    assert_int_equal(mps_solver_register(sim, &ops), MPS_OK);
    assert_int_equal(mps_solver_use(sim, "my", NULL), MPS_OK);
    reported_p = 2; /* the solution */
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        reported = (mps_ppe_result){sizeof reported, cases[k].reason, 17, 0, 0.25, 0.5, 0};
        expect_error(sim, mps__solvers_solve(s, &problem, &p, &result), cases[k].status,
                     cases[k].text);
        assert_int_equal(result.iterations, 17);
    }
    assert_true(seen.tolerance == 1e-6 && seen.divergence == 1e-4 && seen.max_iterations == 2000);
    reported.reason = MPS_PPE_CONVERGED;
    reported_p = 0; /* a plug-in that claims too much */
    assert_int_equal(mps__solvers_solve(s, &problem, &p, &result), MPS_W_NOT_CONVERGED);
    assert_true(result.residual == 1);
    reported_p = NAN;
    expect_error(sim, mps__solvers_solve(s, &problem, &p, &result), MPS_E_SOLVER, "NaN");
    assert_int_equal(result.reason, MPS_PPE_NAN);
}

static void test_solve(void **state)
{
    mps_sim *sim = *state;
    mps_ppe_problem problem = tiny();
    mps_ppe_result result = {.struct_size = sizeof result};
    double p = 0;
    static const char *const names[] = {"sundials.pcg", "sundials.bicgstab", "sundials.gmres",
                                        "sundials.klu", "sundials.kinsol"};
    for (int k = 0; k < 5; k++, p = 0) {
        assert_int_equal(mps_solver_use(sim, names[k], NULL), MPS_OK);
        assert_int_equal(mps__solvers_solve(&sim->world.solvers, &problem, &p, &result), MPS_OK);
        assert_true(fabs(p - 2) < 1e-12);
    }
    problem.n = 0; /* no particle inside: nothing to do, nothing wrong */
    assert_int_equal(mps__solvers_solve(&sim->world.solvers, &problem, NULL, &result), MPS_OK);
    assert_true(result.iterations == 0 && result.residual == 0);
}

static char logged[256];

static void keep_log(void *user, int level, const char *text)
{
    (void)user;
    assert_int_equal(level, MPS_LOG_WARNING);
    snprintf(logged, sizeof logged, "%s", text);
}

static int failing_setup(void *self, const mps_ppe_problem *problem)
{
    (void)self, (void)problem;
    return MPS_PPE_BREAKDOWN;
}

/* If the default preconditioner fails, jacobi replaces it, with a logged warning. */
static void test_fall_back(void **state)
{
    mps_sim *sim = *state;
    mps__solvers *s = &sim->world.solvers;
    mps_ppe_problem problem = tiny();
    mps_ppe_result result = {.struct_size = sizeof result};
    double p = 0;
    s->context->log = keep_log;
    for (int k = 0; k < s->preconditioners; k++)
        if (strcmp(s->preconditioner_name[k], "auxgrid") == 0)
            s->preconditioner[k].setup = failing_setup;
    for (int again = 0; again < 2; again++, p = 0) {
        logged[0] = 0;
        assert_int_equal(mps__solvers_solve(s, &problem, &p, &result), MPS_OK);
        assert_true(fabs(p - 2) < 1e-12);
        assert_non_null(strstr(logged, "'auxgrid' broke down"));
        assert_non_null(strstr(logged, "with 'jacobi' the solver converged"));
    }
    logged[0] = 0; /* one that was selected by name is not replaced */
    assert_int_equal(mps_solver_use(sim, "sundials.pcg", "ic0"), MPS_OK);
    for (int k = 0; k < s->preconditioners; k++)
        if (strcmp(s->preconditioner_name[k], "ic0") == 0)
            s->preconditioner[k].setup = failing_setup;
    expect_error(sim, mps__solvers_solve(s, &problem, &p, &result), MPS_E_SOLVER, "broke down");
    assert_string_equal(logged, "");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_sim, drop_sim)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_choice),
        TEST(test_wrong_names),
        TEST(test_limits),
        TEST(test_register_solver),
        TEST(test_register_refused),
        TEST(test_user),
        TEST(test_register_full),
        TEST(test_register_preconditioner),
        TEST(test_create_fails),
        TEST(test_solve_policy),
        TEST(test_solve),
        TEST(test_fall_back),
        cmocka_unit_test(test_no_sim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
