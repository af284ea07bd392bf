/* SPDX-License-Identifier: BSD-3-Clause */
/* Tests of every built-in solver with every built-in preconditioner with the solver kit, and all
 * against the direct solver. */
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
#include "../every.h"
#include "solver_kit.h"
#include "solver_ranks.h"

static void kit_over(const mps_solver_ops *solver)
{
    int failures = kit_check_solver(solver, NULL);
    for (int k = 0; solver->preconditioner && mps__builtin_preconditioners[k]; k++)
        if (has_turn(k, (int64_t)strlen(solver->name), 3))
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

static void test_kinsol(void **state)
{
    (void)state;
    kit_over(&mps__solver_kinsol);
}

static void test_preconditioners(void **state)
{
    (void)state;
    for (int k = 0; mps__builtin_preconditioners[k]; k++)
        assert_int_equal(kit_check_preconditioner(mps__builtin_preconditioners[k]), 0);
}

static double *solved(const mps_solver_ops *solver, const mps_preconditioner_ops *pc,
                      const mps_ppe_problem *problem)
{
    kit_memory memory;
    mps_ppe_result result = {.struct_size = sizeof result};
    kit_memory_init(&memory);
    double *p = calloc((size_t)problem->n, sizeof *p);
    assert_int_equal(kit_solve(solver, pc, &memory, problem, p, &result), MPS_PPE_CONVERGED);
    return p;
}

static size_t bytes_taken;

static void *take_bytes(void *user, size_t size)
{
    (void)user;
    bytes_taken += size;
    return malloc(size);
}

static void give_bytes(void *user, void *block)
{
    (void)user;
    free(block);
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
            for (int b = 0;
                 mps__builtin_solvers[a]->preconditioner && mps__builtin_preconditioners[b]; b++) {
                double *p = solved(mps__builtin_solvers[a], mps__builtin_preconditioners[b],
                                   &s->problem);
                assert_true(kit_difference(p, direct, s->problem.n) < 1e-8);
                free(p);
            }
        free(direct);
        kit_system_free(s);
    }
}

static int32_t iterations_of(const mps_preconditioner_ops *pc, const kit_lattice *lattice)
{
    kit_system *s = kit_lattice_system(lattice);
    kit_memory memory;
    mps_ppe_result result = {.struct_size = sizeof result};
    double *p = calloc((size_t)s->problem.n, sizeof *p);
    kit_memory_init(&memory);
    s->problem.tolerance = 1e-6;
    assert_int_equal(kit_solve(&mps__solver_pcg, pc, &memory, &s->problem, p, &result),
                     MPS_PPE_CONVERGED);
    free(p);
    kit_system_free(s);
    return result.iterations;
}

/* ic0 needs less than a third of the iterations of jacobi. */
static void test_iterations(void **state)
{
    (void)state;
    static const kit_lattice lattice = {2, 100, 80, 1, 1, 1, 3.1, 1, 0};
    int32_t jacobi = iterations_of(&mps__preconditioner_jacobi, &lattice);
    assert_true(jacobi < 250);
    assert_true(iterations_of(&mps__preconditioner_ic0, &lattice) < jacobi / 3);
}

/* The background grid makes the iterations independent of the number of unknowns and of the
 * densities. */
static void test_auxgrid_iterations(void **state)
{
    (void)state;
    static const kit_lattice lattices[] = {
        {2, 40, 30, 1, 1, 1, 3.1, 1, 0},    {2, 160, 120, 1, 1, 1, 3.1, 1, 0},
        {2, 80, 60, 1, 1, 1, 3.1, 1000, 0}, {2, 80, 60, 1, 1, 0, 3.1, 1, 0},
        {3, 16, 16, 16, 1, 1, 2.1, 1, 0},   {3, 16, 16, 16, 1, 1, 2.1, 1000, 0},
        {2, 12, 12, 1, 30, 15, 3.1, 1, 0},
    };
    for (size_t i = 0; i < sizeof lattices / sizeof lattices[0]; i++)
        assert_in_range(iterations_of(&mps__preconditioner_auxgrid, &lattices[i]), 1, 20);
}

/* Systems of one to five rows, rows without entries, particles at any distance. */
static void test_auxgrid_few(void **state)
{
    (void)state;
    static const double far[5] = {0, 1e-9, 0.02, 10, 1e12}, exact[5] = {1, -2, 3, 4, -5};
    for (int n = 1; n <= 5; n++)
        for (int chain = 0; chain < 2; chain++) {
            double a[25] = {0};
            for (int i = 0; i < n; i++) a[i * n + i] = 2 + i;
            for (int i = 1; chain && i < n; i++) a[i * n + i - 1] = a[(i - 1) * n + i] = -1;
            kit_system *s = kit_dense_system(n, a, exact);
            for (int i = 0; i < n; i++) s->x[2 * i] = far[i];
            double *p = solved(&mps__solver_pcg, &mps__preconditioner_auxgrid, &s->problem);
            assert_true(kit_difference(p, exact, n) < 1e-8);
            free(p);
            kit_system_free(s);
        }
}

/* A drop ten metres away costs a few bytes, not a grid of ten metres. */
static void test_auxgrid_far_drop(void **state)
{
    (void)state;
    static const kit_lattice lattice = {3, 12, 12, 12, 2, 1, 2.1, 1, 0};
    kit_system *s = kit_lattice_system(&lattice);
    for (int64_t i = s->problem.n / 2; i < s->problem.n; i++)
        s->x[3 * i] += 10 + 1e3 * s->problem.dp;
    bytes_taken = 0;
    void *self = NULL;
    const mps_allocator allocator = {take_bytes, give_bytes, NULL};
    assert_int_equal(mps__preconditioner_auxgrid.create(&allocator, &self), 0);
    assert_int_equal(mps__preconditioner_auxgrid.setup(self, &s->problem), MPS_PPE_CONVERGED);
    assert_true(bytes_taken < 400 * (size_t)s->problem.n + 300000);
    const size_t first = bytes_taken;
    assert_int_equal(mps__preconditioner_auxgrid.setup(self, &s->problem), MPS_PPE_CONVERGED);
    assert_int_equal(bytes_taken, first); /* kept for the next time */
    mps__preconditioner_auxgrid.destroy(&allocator, self);
    kit_system_free(s);
}

/* Non-finite entries of the matrix are reported, and the state can be used again. */
static void test_auxgrid_nan(void **state)
{
    (void)state;
    static const kit_lattice lattice = {2, 30, 24, 1, 1, 1, 3.1, 1, 0};
    kit_system *s = kit_lattice_system(&lattice);
    kit_memory memory;
    kit_memory_init(&memory);
    void *self = NULL;
    double *z = calloc((size_t)s->problem.n, sizeof *z);
    assert_int_equal(mps__preconditioner_auxgrid.create(&memory.allocator, &self), 0);
    for (int64_t k = 0; k < 40; k++) { /* the diagonal holds the sum of the others */
        const double value = s->diagonal[k];
        s->diagonal[k] = k % 2 ? (double)NAN : -(double)INFINITY;
        assert_int_not_equal(mps__preconditioner_auxgrid.setup(self, &s->problem),
                             MPS_PPE_CONVERGED);
        s->diagonal[k] = value;
    }
    assert_int_equal(mps__preconditioner_auxgrid.setup(self, &s->problem), MPS_PPE_CONVERGED);
    assert_int_equal(mps__preconditioner_auxgrid.apply(self, s->rhs, z), MPS_PPE_CONVERGED);
    for (int64_t i = 0; i < s->problem.n; i++) assert_true(isfinite(z[i]));
    mps__preconditioner_auxgrid.destroy(&memory.allocator, self);
    assert_int_equal(memory.live, 0);
    free(z);
    kit_system_free(s);
}

/* A pivot that is not positive makes ic0 shift the diagonal instead of failing. */
static void test_ic0_shift(void **state)
{
    (void)state;
    /* positive definite (eigenvalues 0.0034 .. 6.8), yet the factorisation without fill has a pivot
     * of -5 (Kershaw 1978) */
    static const double a[16] = {3, -2, 0, 2, -2, 3, -2, 0, 0, -2, 3, -2, 2, 0, -2, 3},
                        exact[4] = {1, 2, 3, 4};
    kit_system *s = kit_dense_system(4, a, exact);
    double *p = solved(&mps__solver_pcg, &mps__preconditioner_ic0, &s->problem);
    assert_true(kit_difference(p, exact, 4) < 1e-7);
    free(p);
    kit_system_free(s);
}

/* ---- nonlinear rows: sundials.kinsol ---- */

/* Every second row follows the law of a gas at `law`; the right side is that of s->exact. */
static void make_gas(kit_system *s, double law, double *gas, double *laws)
{
    for (int64_t i = 0; i < s->problem.n; i++) {
        gas[i] = 0.9 * s->shift[i];
        laws[i] = i % 2 ? law : 0;
        s->rhs[i] += gas[i] * (mps_ppe_law(laws[i], s->exact[i], NULL) - s->exact[i]);
    }
    s->problem.gas = gas;
    s->problem.law = laws;
}

/* One row, a p + g (P ln(1 + p/P) - p) = b, against bisection; from p strongly compressed to nearly
 * empty, from any guess. */
static void test_gas_scalar(void **state)
{
    (void)state;
    static const double a[1] = {3}, law[1] = {100}, gas[1] = {2.5},
                        guesses[] = {0, -99.9, -1e6, 1e6, NAN};
    for (double wanted = -98; wanted < 1e4; wanted += wanted < 100 ? 11 : 1500)
        for (size_t g = 0; g < sizeof guesses / sizeof guesses[0]; g++) {
            kit_system *s = kit_dense_system(1, a, &wanted);
            kit_memory memory;
            mps_ppe_result result = {.struct_size = sizeof result};
            double p = guesses[g], low = -99.9999, high = 1e5;
            kit_memory_init(&memory);
            s->problem.gas = gas;
            s->problem.law = law;
            s->problem.tolerance = 1e-12;
            s->rhs[0] = 3 * wanted + 2.5 * (100 * log(1 + wanted / 100) - wanted);
            for (int k = 0; k < 200; k++) {
                const double middle = 0.5 * (low + high);
                *(0.5 * middle + 250 * log(1 + middle / 100) < s->rhs[0] ? &low : &high) = middle;
            }
            assert_int_equal(kit_solve(&mps__solver_kinsol, &mps__preconditioner_jacobi, &memory,
                                       &s->problem, &p, &result),
                             0);
            assert_true(fabs(p - low) < 1e-8 * (1 + fabs(low)) && result.residual <= 1e-12 &&
                        result.iterations > 0);
            kit_system_free(s);
        }
}

/* Lattices half of gas, with all preconditioners: the exact solution in few iterations, the same
 * bytes with more threads, no leak. */
static void test_gas_lattice(void **state)
{
    (void)state;
    static const kit_lattice lattices[] = {{2, 60, 50, 1, 1, 1, 3.1, 1, 0.01},
                                           {2, 110, 90, 1, 1, 0, 2.1, 1000, 0.001},
                                           {3, 9, 9, 9, 1, 0, 2.1, 1, 1}};
    for (size_t k = 0; k < sizeof lattices / sizeof lattices[0]; k++)
        for (int pc = 0; mps__builtin_preconditioners[pc]; pc++) {
            if (lattices[k].contrast > 1 &&
                mps__builtin_preconditioners[pc] == &mps__preconditioner_jacobi)
                continue; /* slow */
            kit_system *s = kit_lattice_system(&lattices[k]);
            const size_t n = (size_t)s->problem.n;
            double *gas = calloc(5 * n, sizeof *gas), *p = gas + 2 * n, *more = gas + 3 * n,
                   deepest = 0;
            mps_ppe_result result = {.struct_size = sizeof result},
                           again = {.struct_size = sizeof again};
            kit_memory memory;
            for (size_t i = 0; i < n; i++) deepest = fmax(deepest, -s->exact[i]);
            make_gas(s, deepest / 0.95, gas,
                     gas + n); /* down to a twentieth of the ambient pressure */
            s->problem.tolerance = 1e-10;
            kit_memory_init(&memory);
            assert_int_equal(kit_solve(&mps__solver_kinsol, mps__builtin_preconditioners[pc],
                                       &memory, &s->problem, p, &result),
                             0);
            assert_true(kit_difference(p, s->exact, s->problem.n) < 1e-6 &&
                        result.residual <= 1e-10);
            const mps_parallel three = kit_parallel(3);
            s->problem.parallel = &three;
            assert_int_equal(kit_solve(&mps__solver_kinsol, mps__builtin_preconditioners[pc],
                                       &memory, &s->problem, more, &again),
                             0);
            assert_memory_equal(p, more, n * sizeof *p);
            assert_int_equal(memory.live, 0);
            s->problem.gas = s->problem.law = NULL;
            s->problem.parallel = NULL;
            memset(p, 0, n * sizeof *p);
            assert_int_equal(kit_solve(&mps__solver_kinsol, mps__builtin_preconditioners[pc],
                                       &memory, &s->problem, p, &again),
                             0);
            print_message("lattice %zu, %s: %d iterations, linear %d\n", k,
                          mps__builtin_preconditioners[pc]->name, result.iterations,
                          again.iterations);
            assert_true(result.iterations < 4 * again.iterations + 20);
            free(gas);
            kit_system_free(s);
        }
}

/* Any allocation may fail on a nonlinear problem too. */
static void test_gas_memory(void **state)
{
    (void)state;
    static const kit_lattice lattice = {2, 12, 10, 1, 2, 1, 2.1, 1, 0.01};
    kit_system *s = kit_lattice_system(&lattice);
    double gas[240], laws[240], p[240] = {0};
    int reason = MPS_PPE_NOMEM;
    assert_int_equal(s->problem.n, 240);
    make_gas(s, 1e6, gas, laws);
    for (int64_t fail_at = 1; reason == MPS_PPE_NOMEM; fail_at++) {
        kit_memory memory;
        mps_ppe_result result = {.struct_size = sizeof result};
        kit_memory_init(&memory);
        memory.fail_at = fail_at;
        reason = kit_solve(&mps__solver_kinsol, &mps__preconditioner_ic0, &memory, &s->problem, p,
                           &result);
        assert_int_equal(memory.live, 0);
    }
    assert_int_equal(reason, MPS_PPE_CONVERGED);
    kit_system_free(s);
}

/* The law: slope 1 at 0, its own derivative, one tangent below -0.99 P, finite for any p; without P
 * linear. */
static void test_gas_law(void **state)
{
    (void)state;
    double slope, low, high, tangent;
    assert_true(mps_ppe_law(1e5, 0, &slope) == 0 && slope == 1);
    assert_true(fabs(mps_ppe_law(1e5, 1e5, &slope) - 1e5 * log(2)) < 1e-9 && slope == 0.5);
    for (double p = -3e5; p < 3e5; p += 1.1e4) {
        low = mps_ppe_law(1e5, p - 1, NULL);
        high = mps_ppe_law(1e5, p + 1, NULL);
        mps_ppe_law(1e5, p, &slope);
        assert_true(fabs((high - low) / 2 - slope) < 1e-6 * slope);
    }
    mps_ppe_law(1e5, -0.99e5, &tangent);
    mps_ppe_law(1e5, -1e9, &slope);
    assert_true(fabs(tangent / slope - 1) < 1e-12);
    assert_true(mps_ppe_law(0, -7, &slope) == -7 && slope == 1);
}

static void test_check(void **state)
{
    (void)state;
    static const double a[4] = {2, -1, -1, 2}, exact[2] = {3, 4};
    double work[2], wrong[2] = {3, 5};
    kit_system *s = kit_dense_system(2, a, exact);
    mps_ppe_result result = {.struct_size = sizeof result};
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

/* ---- two ranks ---- */

/* Conjugate gradients that are wrong by a millionth on several ranks. */
static void solve_apart(void *self, const mps_ppe_problem *problem,
                        const mps_preconditioner_ops *pc, void *pc_self, double *p,
                        mps_ppe_result *result)
{
    mps__solver_pcg.solve(self, problem, pc, pc_self, p, result);
    for (int64_t i = 0; problem->ranks && i < problem->n; i++) p[i] *= 1 + 1e-6;
}

static void test_ranks_told(void **state)
{
    char text[KIT_RANKS_TEXT];
    mps_solver_ops apart = mps__solver_pcg;
    (void)state;
    apart.solve = solve_apart;
    assert_false(kit_ranks_failed(&mps__solver_pcg, NULL, text));
    assert_true(kit_ranks_failed(&apart, NULL, text));
    assert_non_null(strstr(text, "solutions on two ranks and on one differ by "));
    assert_non_null(strstr(text, "a sum or maximum without mps_ppe_total()"));
}

static void solve_nothing(void *self, const mps_ppe_problem *problem,
                          const mps_preconditioner_ops *pc, void *pc_self, double *p,
                          mps_ppe_result *result)
{
    (void)self, (void)problem, (void)pc, (void)pc_self, (void)p;
    result->reason = MPS_PPE_INDEFINITE;
}

/* An equation that is not solved is a failure, with the text of the library. */
static void test_ranks_failure(void **state)
{
    char text[KIT_RANKS_TEXT];
    mps_solver_ops nothing = mps__solver_pcg;
    (void)state;
    nothing.solve = solve_nothing;
    assert_true(kit_ranks_failed(&nothing, NULL, text));
    assert_non_null(strstr(text, "on 1 rank(s): "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pcg),
        cmocka_unit_test(test_bicgstab),
        cmocka_unit_test(test_gmres),
        cmocka_unit_test(test_klu),
        cmocka_unit_test(test_kinsol),
        cmocka_unit_test(test_preconditioners),
        cmocka_unit_test(test_ranks_told),
        cmocka_unit_test(test_ranks_failure),
        cmocka_unit_test(test_against_direct),
        cmocka_unit_test(test_iterations),
        cmocka_unit_test(test_ic0_shift),
        cmocka_unit_test(test_auxgrid_iterations),
        cmocka_unit_test(test_auxgrid_few),
        cmocka_unit_test(test_auxgrid_far_drop),
        cmocka_unit_test(test_auxgrid_nan),
        cmocka_unit_test(test_check),
        cmocka_unit_test(test_gas_scalar),
        cmocka_unit_test(test_gas_lattice),
        cmocka_unit_test(test_gas_memory),
        cmocka_unit_test(test_gas_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
