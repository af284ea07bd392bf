/* SPDX-License-Identifier: BSD-3-Clause */
/* Results of `auxgrid` depend on the particles and their rows only: not on threads, the order of
 * particles or distant particles. */
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

/* One and two densities, in 2-D and in 3-D; enough rows for threads. */
static const kit_lattice lattices[] = {{2, 120, 80, 1, 1, 1, 3.1, 1, 0},
                                       {2, 120, 80, 1, 1, 1, 3.1, 1000, 0},
                                       {3, 24, 24, 20, 1, 1, 2.1, 1, 0},
                                       {3, 24, 24, 20, 1, 1, 2.1, 1000, 0}};
enum { LATTICES = sizeof lattices / sizeof lattices[0] };

/* z = M^-1 rhs; the caller frees it. */
static double *applied(const mps_ppe_problem *problem)
{
    kit_memory memory;
    void *self = NULL;
    double *z = calloc((size_t)problem->n, sizeof *z);
    kit_memory_init(&memory);
    assert_non_null(z);
    assert_int_equal(mps__preconditioner_auxgrid.create(&memory.allocator, &self), 0);
    assert_int_equal(mps__preconditioner_auxgrid.setup(self, problem), MPS_PPE_CONVERGED);
    assert_int_equal(mps__preconditioner_auxgrid.apply(self, problem->rhs, z), MPS_PPE_CONVERGED);
    mps__preconditioner_auxgrid.destroy(&memory.allocator, self);
    assert_int_equal(memory.live, 0);
    return z;
}

static void check_same_bytes(const double *a, const double *b, int64_t n)
{
    assert_memory_equal(a, b, (size_t)n * sizeof *a);
}

static void same_for_any_threads(void **state)
{
    (void)state;
    for (int k = 0; k < LATTICES; k++) {
        kit_system *s = kit_lattice_system(&lattices[k]);
        double *one = applied(&s->problem);
        for (int threads = 1; threads <= 4; threads++) {
            const mps_parallel parallel = kit_parallel(threads);
            s->problem.parallel = &parallel;
            double *z = applied(&s->problem);
            check_same_bytes(one, z, s->problem.n);
            free(z);
        }
        free(one);
        kit_system_free(s);
    }
}

/* ---- the same particles in another order ---- */

/* New numbers of n rows. */
static int64_t *shuffled(int64_t n)
{
    int64_t *to = calloc((size_t)n, sizeof *to);
    uint64_t state = 1;
    assert_non_null(to);
    for (int64_t i = 0; i < n; i++) to[i] = i;
    for (int64_t i = n - 1; i > 0; i--) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const int64_t j = (int64_t)((state >> 33) % (uint64_t)(i + 1));
        const int64_t swap = to[i];
        to[i] = to[j];
        to[j] = swap;
    }
    return to;
}

/* Row i of `from` as row to[i] of s; columns ascend. */
static void copy_row(const kit_system *from, kit_system *s, int64_t i, const int64_t *to)
{
    const int64_t first = s->row[to[i]], dim = s->problem.dim;
    for (int64_t k = from->row[i]; k < from->row[i + 1]; k++) {
        int64_t at = first + k - from->row[i];
        const int32_t col = (int32_t)to[from->col[k]];
        for (; at > first && s->col[at - 1] > col; at--) {
            s->col[at] = s->col[at - 1];
            s->val[at] = s->val[at - 1];
        }
        s->col[at] = col;
        s->val[at] = from->val[k];
    }
    s->diagonal[to[i]] = from->diagonal[i];
    s->shift[to[i]] = from->shift[i];
    s->rhs[to[i]] = from->rhs[i];
    memcpy(s->x + to[i] * dim, from->x + i * dim, (size_t)dim * sizeof *s->x);
}

/* Renumber all rows of s, made with the same options as `from`. */
static void renumber(const kit_system *from, kit_system *s, const int64_t *to)
{
    const int64_t n = s->problem.n;
    for (int64_t i = 0; i < n; i++) s->row[to[i] + 1] = from->row[i + 1] - from->row[i];
    for (int64_t i = 0; i < n; i++) s->row[i + 1] += s->row[i];
    for (int64_t i = 0; i < n; i++) copy_row(from, s, i, to);
}

/* Largest difference of z of the same particles in two orders, over the largest z. */
static double difference_in_two_orders(const kit_lattice *lattice, void (*change)(kit_system *s))
{
    kit_system *s = kit_lattice_system(lattice), *other = kit_lattice_system(lattice);
    const int64_t n = s->problem.n;
    int64_t *to = shuffled(n);
    if (change) change(s);
    other->problem.dp = s->problem.dp;
    renumber(s, other, to);
    double *z = applied(&s->problem), *y = applied(&other->problem), largest = 0, difference = 0;
    for (int64_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(z[i]));
        difference = fmax(difference, fabs(z[i] - y[to[i]]));
    }
    assert_true(largest > 0);
    free(z);
    free(y);
    free(to);
    kit_system_free(s);
    kit_system_free(other);
    return difference / largest;
}

/* One density: links are rounded to floats. Two: they are exact sums, so all but the last digits
 * agree. */
static void nearly_same_in_any_order(void **state)
{
    (void)state;
    for (int k = 0; k < LATTICES; k++)
        assert_true(difference_in_two_orders(&lattices[k], NULL) <
                    (lattices[k].contrast > 1 ? 1e-12 : 1e-6));
}

/* One particle in each cell, on a lattice of powers of two, so that no sum over the rows is
 * rounded. */
static void spread_out(kit_system *s)
{
    const int64_t n = s->problem.n;
    const double dp = s->problem.dp, dense = s->val[0];
    s->problem.dp = 0x1p-7;
    for (int64_t k = 0; k < n * s->problem.dim; k++)
        s->x[k] = 4 * s->problem.dp * floor(s->x[k] / dp + 0.5);
    for (int64_t i = 0; i < n; i++) {
        s->diagonal[i] = s->shift[i] = i % 7 == 0 ? 0.25 : 0;
        for (int64_t k = s->row[i]; k < s->row[i + 1]; k++) {
            s->val[k] = (double)s->val[k] < 20 * dense ? -64 : -1;
            s->diagonal[i] -= (double)s->val[k];
        }
    }
}

/* Cells are in another order, and there are no other sums with rounding: the same bytes. */
static void same_for_any_order_of_cells(void **state)
{
    (void)state;
    for (int k = 0; k < LATTICES; k++)
        assert_true(difference_in_two_orders(&lattices[k], spread_out) == 0);
}

/* ---- the same particles elsewhere ---- */

/* Distances that have no rounding: by a multiple of many cells nothing changes. */
static void same_at_another_place(void **state)
{
    (void)state;
    static const double moves[] = {16, -32, 4096};
    for (int k = 1; k < LATTICES; k += 2) {
        kit_system *s = kit_lattice_system(&lattices[k]);
        const int64_t count = s->problem.n * s->problem.dim;
        for (int64_t i = 0; i < count; i++)
            s->x[i] = 0x1p-24 * floor(0x1p17 * s->x[i] / s->problem.dp);
        s->problem.dp = 0x1p-7;
        double *on_host = applied(&s->problem);
        for (size_t m = 0; m < sizeof moves / sizeof moves[0]; m++) {
            for (int64_t i = 0; i < count; i++) s->x[i] += moves[m];
            double *on_device = applied(&s->problem);
            check_same_bytes(on_host, on_device, s->problem.n);
            free(on_device);
            for (int64_t i = 0; i < count; i++) s->x[i] -= moves[m];
        }
        free(on_host);
        kit_system_free(s);
    }
}

/* A lone particle below all others does not move their cells. */
static void same_beside_a_lone_particle(void **state)
{
    (void)state;
    for (int k = 0; k < LATTICES; k++) {
        kit_system *s = kit_lattice_system(&lattices[k]);
        const int64_t n = s->problem.n - 1, dim = s->problem.dim;
        for (int64_t i = 0; i <= n; i++)
            for (int64_t e = s->row[i]; e < s->row[i + 1]; e++)
                if (i == n || s->col[e] == n) s->val[e] = 0;
        s->diagonal[n] = s->shift[n] = s->rhs[n] = 0;
        for (int64_t a = 0; a < dim; a++) s->x[n * dim + a] = -20.7 * s->problem.dp;
        double *near = applied(&s->problem);
        for (int64_t a = 0; a < dim; a++) s->x[n * dim + a] = -33.3 * s->problem.dp;
        double *far = applied(&s->problem);
        check_same_bytes(near, far, n);
        free(near);
        free(far);
        kit_system_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_for_any_threads),        cmocka_unit_test(nearly_same_in_any_order),
        cmocka_unit_test(same_for_any_order_of_cells), cmocka_unit_test(same_at_another_place),
        cmocka_unit_test(same_beside_a_lone_particle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
