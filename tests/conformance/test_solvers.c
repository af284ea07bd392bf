/* SPDX-License-Identifier: BSD-3-Clause */
/* Every built-in solver with every built-in preconditioner through the solver kit, and all against the direct one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h needs those four before it */
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/ppe/builtin.h"
#include "solver_kit.h"

static void kit_over(const mps_solver_ops *solver)
{
    int failures = kit_check_solver(solver, NULL);
    for (int k = 0; solver->preconditioner && mps__builtin_preconditioners[k]; k++)
        failures += kit_check_solver(solver, mps__builtin_preconditioners[k]);
    assert_int_equal(failures, 0);
}

static void test_pcg(void **state)
{
    (void)state;
    kit_over(&mps__solver_pcg);
}

static void test_bicgstab(void **state)
{
    (void)state;
    kit_over(&mps__solver_bicgstab);
}

static void test_gmres(void **state)
{
    (void)state;
    kit_over(&mps__solver_gmres);
}

static void test_klu(void **state)
{
    (void)state;
    kit_over(&mps__solver_klu);
}

static void test_preconditioners(void **state)
{
    (void)state;
    for (int k = 0; mps__builtin_preconditioners[k]; k++) assert_int_equal(kit_check_preconditioner(mps__builtin_preconditioners[k]), 0);
}

static double *solved(const mps_solver_ops *solver, const mps_preconditioner_ops *pc, const mps_ppe_problem *problem)
{
    kit_memory memory;
    mps_ppe_result result;
    kit_memory_init(&memory);
    double *p = calloc((size_t)problem->n, sizeof *p);
    assert_int_equal(kit_solve(solver, pc, &memory, problem, p, &result), MPS_PPE_CONVERGED);
    return p;
}

/* All pairs agree with the direct solver to 1e-8. */
static void test_against_direct(void **state)
{
    (void)state;
    static const kit_lattice lattices[] = {{2, 25, 20, 1, 1, 1, 3.1, 1, 0},
                                           {2, 25, 20, 1, 1, 1, 3.1, 1000, 0},
                                           {2, 25, 20, 1, 2, 0, 3.1, 1, 0},
                                           {3, 8, 8, 8, 1, 0, 2.1, 1000, 0}};
    for (size_t i = 0; i < sizeof lattices / sizeof lattices[0]; i++) {
        kit_system *s = kit_lattice_system(&lattices[i]);
        s->problem.tolerance = 1e-13;
        double *direct = solved(&mps__solver_klu, NULL, &s->problem);
        for (int a = 0; mps__builtin_solvers[a]; a++)
            for (int b = 0; mps__builtin_solvers[a]->preconditioner && mps__builtin_preconditioners[b]; b++) {
                double *p = solved(mps__builtin_solvers[a], mps__builtin_preconditioners[b], &s->problem);
                assert_true(kit_difference(p, direct, s->problem.n) < 1e-8);
                free(p);
            }
        free(direct);
        kit_system_free(s);
    }
}

/* The built-in preconditioners earn their names. */
static void test_iterations(void **state)
{
    (void)state;
    static const kit_lattice lattice = {2, 100, 80, 1, 1, 1, 3.1, 1, 0};
    kit_system *s = kit_lattice_system(&lattice);
    const mps_preconditioner_ops *pcs[] = {&mps__preconditioner_jacobi, &mps__preconditioner_ic0};
    mps_ppe_result result[2];
    s->problem.tolerance = 1e-6;
    for (int k = 0; k < 2; k++) {
        kit_memory memory;
        kit_memory_init(&memory);
        double *p = calloc((size_t)s->problem.n, sizeof *p);
        assert_int_equal(kit_solve(&mps__solver_pcg, pcs[k], &memory, &s->problem, p, &result[k]), MPS_PPE_CONVERGED);
        free(p);
    }
    assert_true(result[0].iterations < 250);
    assert_true(result[1].iterations < result[0].iterations / 3);
    kit_system_free(s);
}

/* A pivot that is not positive makes ic0 shift the diagonal instead of giving up. */
static void test_ic0_shift(void **state)
{
    (void)state;
    /* positive definite (eigenvalues 0.0034 .. 6.8), yet the factorisation without fill has a pivot of -5 (Kershaw 1978) */
    static const double a[16] = {3, -2, 0, 2, -2, 3, -2, 0, 0, -2, 3, -2, 2, 0, -2, 3}, exact[4] = {1, 2, 3, 4};
    kit_system *s = kit_dense_system(4, a, exact);
    double *p = solved(&mps__solver_pcg, &mps__preconditioner_ic0, &s->problem);
    assert_true(kit_difference(p, exact, 4) < 1e-7);
    free(p);
    kit_system_free(s);
}

static void test_check(void **state)
{
    (void)state;
    static const double a[4] = {2, -1, -1, 2}, exact[2] = {3, 4};
    double work[2], wrong[2] = {3, 5};
    kit_system *s = kit_dense_system(2, a, exact);
    mps_ppe_result result = {0};
    mps_ppe_check(&s->problem, exact, work, &result);
    assert_true(result.residual == 0 && result.divergence == 0);
    mps_ppe_check(&s->problem, wrong, work, &result);
    assert_true(work[0] == 1 && work[1] == -2 && result.divergence == 2);
    assert_true(fabs(result.residual - sqrt(5.0) / sqrt(4 + 25)) < 1e-15);
    s->weight[0] = NAN;
    mps_ppe_check(&s->problem, wrong, work, &result);
    assert_true(isnan(result.divergence));
    kit_system_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pcg),        cmocka_unit_test(test_bicgstab),        cmocka_unit_test(test_gmres),
        cmocka_unit_test(test_klu),        cmocka_unit_test(test_preconditioners), cmocka_unit_test(test_against_direct),
        cmocka_unit_test(test_iterations), cmocka_unit_test(test_ic0_shift),       cmocka_unit_test(test_check),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
