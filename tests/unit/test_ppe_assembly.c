/* SPDX-License-Identifier: BSD-3-Clause */
/* The pressure equation of small clouds: against a dense double loop, with known solutions, and its
 * singular components. */
#include "ppe_fixture.h"

static double entry(const mps__ppe *e, int64_t r, int32_t c)
{
    if (c == r) return e->diagonal[r];
    for (int64_t m = e->row[r]; m < e->row[r + 1]; m++)
        if (e->col[m] == c) return (double)e->val[m];
    return 0;
}

static double pair_rho(const tank *k, int64_t i, int64_t j)
{
    return 0.5 * (k->density[i] + k->density[j]);
}

static bool in_equation(const tank *k, int64_t i)
{
    return k->fixed[i] || (k->kind[i] != MPS_DUMMY && k->region[i] <= MPS_REGION_NEAR);
}

/* What a cut-off surface loses of the flux of a linear pressure, as a factor on the pairs that are
 * left. */
static double surface_factor(const tank *k, double re)
{
    double full = 0, left = 0;
    for (int i = -4; i <= 4; i++)
        for (int j = 1; j <= 4; j++)
            for (int m = k->c.dim == 3 ? -4 : 0; m <= (k->c.dim == 3 ? 4 : 0); m++) {
                const double r = CLOUD_DP * sqrt((double)(i * i + j * j + m * m));
                if (r >= re) continue;
                full += j * j * (re / (0.85 * r + 0.15 * re) - 1);
                left += j * (re / (0.85 * r + 0.15 * re) - 1);
            }
    return k->terms.equation.complete_surface ? full / left : 1;
}

/* 2D/(n0 lambda) W/rho of one pair, in single precision as the matrix has it; 0 if it takes no
 * part. */
static double coefficient(const tank *k, int64_t i, int64_t j)
{
    const mps_stencil *t = k->terms.equation.radius == MPS_NEAR ? &k->view.near : &k->view.far;
    const double r = sqrt(cloud_distance2(&k->c, i, j));
    if (i == j || r >= t->re || !in_equation(k, i) || !in_equation(k, j)) return 0;
    double factor = 1;
    if (k->kind[i] == MPS_WALL && k->kind[j] == MPS_WALL)
        factor = k->flux.wall_factor * fmin(k->wet[i], k->wet[j]);
    else if ((k->region[i] == MPS_REGION_SURFACE) != (k->region[j] == MPS_REGION_SURFACE))
        factor = surface_factor(k, t->re);
    return (double)(float)(2 * k->c.dim / (t->n0 * t->lambda) * factor *
                           (t->re / (0.85 * r + 0.15 * t->re) - 1) / pair_rho(k, i, j));
}

/* sum_j k_ij (p_i - p_j + q_ij) + shift p_i - rhs for a particle, with p of all particles given. */
static double residual(const tank *k, int64_t i, const double *p)
{
    double sum = k->terms.equation.gain * (k->shift[i] * p[i] - k->rhs[i]);
    for (int64_t j = 0; j < k->c.n; j++) {
        double q = 0;
        for (int d = 0; d < k->c.dim; d++)
            q -= 0.5 * (k->accel[i * k->c.dim + d] + k->accel[j * k->c.dim + d]) *
                 (k->c.x[j * k->c.dim + d] - k->c.x[i * k->c.dim + d]);
        sum += coefficient(k, i, j) * (p[i] - p[j] + pair_rho(k, i, j) * q);
    }
    return sum;
}

/* Solve the assembled system by elimination (no pivots: it is symmetric positive definite) and
 * spread the pressures. */
static void solve(tank *k, double *p)
{
    const int64_t n = k->e.n;
    double *a = calloc((size_t)(n * (n + 1)), sizeof *a);
    for (int64_t r = 0; r < n; r++) {
        a[r * (n + 1) + r] = k->e.diagonal[r];
        for (int64_t m = k->e.row[r]; m < k->e.row[r + 1]; m++)
            a[r * (n + 1) + k->e.col[m]] = (double)k->e.val[m];
        a[r * (n + 1) + n] = k->e.rhs[r];
    }
    for (int64_t c = 0; c < n; c++)
        for (int64_t r = c + 1; r < n; r++) {
            const double f = a[r * (n + 1) + c] / a[c * (n + 1) + c];
            for (int64_t m = c; f != 0 && m <= n; m++) a[r * (n + 1) + m] -= f * a[c * (n + 1) + m];
        }
    for (int64_t r = n - 1; r >= 0; r--) {
        double sum = a[r * (n + 1) + n];
        for (int64_t c = r + 1; c < n; c++) sum -= a[r * (n + 1) + c] * k->e.p[c];
        k->e.p[r] = sum / a[r * (n + 1) + r];
    }
    free(a);
    mps__ppe_scatter(&k->e, &k->view, &k->terms, p);
}

/* ---- structure ------------------------------------------------------------------------------- */

/* Columns ascend, without the diagonal, A is symmetric, row sums are the shift. */
static void check_matrix(const mps__ppe *e)
{
    const mps_ppe_problem *q = &e->problem;
    assert_int_equal(q->struct_size, sizeof *q);
    assert_int_equal(q->n, e->n);
    assert_int_equal(q->row[0], 0);
    for (int64_t r = 0; r < q->n; r++) {
        const double diagonal = entry(e, r, (int32_t)r);
        double sum = diagonal;
        assert_true(diagonal > 0 && q->shift[r] >= 0);
        for (int64_t m = q->row[r]; m < q->row[r + 1]; m++) {
            assert_in_range(q->col[m], 0, q->n - 1);
            assert_true(m == q->row[r] || q->col[m] > q->col[m - 1]);
            assert_true(q->col[m] != r && q->val[m] < 0);
            assert_true((double)q->val[m] == entry(e, q->col[m], (int32_t)r));
            sum += (double)q->val[m];
        }
        assert_true(fabs(sum - q->shift[r]) <= 1e-12 * diagonal);
    }
}

/* Everything an assembly can meet at once: symmetric, and the solution fulfils the equation of the
 * double loop. */
static void check_all_terms(int radius, int complete, double walls)
{
    uint64_t seed = 1;
    tank k;
    double p[MOST];
    tank_init(&k, cloud_lattice(2, 14, 14, 1, 0.2, 2));
    add_floor(&k, 14);
    add_surface(&k, 14, 50);
    k.terms.equation.radius = radius;
    k.terms.equation.complete_surface = complete;
    k.flux.wall_factor = walls;
    k.terms.equation.gain = radius == MPS_NEAR ? 0.7 : 1;
    for (int64_t i = 0; i < k.c.n; i++) {
        k.density[i] = i % 14 < 7 ? 1000 : 1;
        k.wet[i] = 0.5 + 0.5 * cloud_random(&seed);
        k.rhs[i] = cloud_random(&seed);
        k.shift[i] = i % 5 == 0 ? 0.01 : 0;
        for (int d = 0; d < 2; d++) k.accel[2 * i + d] = gravity * cloud_random(&seed);
    }
    assemble(&k);
    assert_int_equal(k.e.n, 14 * 11); /* walls and fluid, less the surface */
    check_matrix(&k.e);
    assert_int_equal(k.e.problem.components, 0);
    assert_null(k.e.problem.component);
    solve(&k, p);
    for (int64_t i = 0; i < k.c.n; i++) {
        if (k.fixed[i])
            assert_true(p[i] == k.value[i]);
        else if (k.kind[i] == MPS_DUMMY)
            assert_true(p[i] == 0 && k.e.unknown[i] == -1);
        else
            assert_true(fabs(residual(&k, i, p)) < 1e-9);
    }
    tank_free(&k);
}

static void matrix_and_double_loop(void **state)
{
    (void)state;
    check_all_terms(MPS_FAR, 0, 0);
    check_all_terms(MPS_FAR, 1, 0.5);
    check_all_terms(MPS_NEAR, 0, 1);
    check_all_terms(MPS_NEAR, 1, 0);
}

/* More threads, the same bytes. */
static void threads_agree(void **state)
{
    (void)state;
    tank one, two;
    tank_init(&one, cloud_lattice(3, 8, 7, 8, 0.2, 3));
    tank_init(&two, cloud_lattice(3, 8, 7, 8, 0.2, 3));
    for (int64_t i = 0; i < one.c.n; i++) one.fixed[i] = two.fixed[i] = i % 11 == 0;
    const mps_parallel threads = {.struct_size = sizeof threads, .threads = 2};
    assert_int_equal(mps_neighbours_parallel_set(two.list, &threads), MPS_OK);
    assemble(&one);
    assemble(&two);
    check_matrix(&one.e);
    assert_int_equal(one.e.n, two.e.n);
    assert_memory_equal(one.e.row, two.e.row, (size_t)(one.e.n + 1) * sizeof *one.e.row);
    assert_memory_equal(one.e.col, two.e.col, (size_t)one.e.row[one.e.n] * sizeof *one.e.col);
    assert_memory_equal(one.e.val, two.e.val, (size_t)one.e.row[one.e.n] * sizeof *one.e.val);
    assert_memory_equal(one.e.rhs, two.e.rhs, (size_t)one.e.n * sizeof *one.e.rhs);
    tank_free(&one);
    tank_free(&two);
}

/* ---- known solutions ------------------------------------------------------------------------- */

/* A tank at rest, b = g: p = rho g (top - y) is the solution, on any cloud and to rounding, with no
 * source at all. */
static void hydrostatic(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        tank k;
        double p[MOST];
        tank_init(&k, cloud_lattice(2, 12, 15, 1, variant % 2 ? 0.3 : 0, 4));
        const double top = 14 * CLOUD_DP, slope[2] = {2.5, -gravity}, accel[2] = {-2.5, gravity};
        add_floor(&k, 12);
        add_surface(&k, 12, 0);
        k.terms.equation.complete_surface = variant / 2;
        k.flux.wall_factor = 0.5 * (variant / 2);
        for (int64_t i = 0; i < k.c.n; i++) {
            memcpy(k.accel + 2 * i, accel, sizeof accel);
            if (k.fixed[i])
                k.value[i] = rho0 * (slope[0] * k.c.x[2 * i] - slope[1] * (top - k.c.x[2 * i + 1]));
        }
        assemble(&k);
        solve(&k, p);
        for (int64_t i = 24; i < k.c.n; i++) {
            const double exact = rho0 *
                                 (slope[0] * k.c.x[2 * i] - slope[1] * (top - k.c.x[2 * i + 1]));
            assert_true(fabs(p[i] - exact) < 1e-11 * rho0 * gravity * top);
        }
        tank_free(&k);
    }
}

/* Fixed rows are eliminated from the matrix and give a shift and a right-hand side; the initial
 * guess is the previous pressure. */
static void fixed_rows(void **state)
{
    (void)state;
    tank k;
    tank_init(&k, cloud_lattice(3, 5, 5, 5, 0.2, 5));
    const int64_t fixed = 62, next = 63;
    k.fixed[fixed] = 1;
    k.value[fixed] = 1234;
    k.p[next] = 77;
    assemble(&k);
    assert_int_equal(k.e.n, 124);
    assert_int_equal(k.e.unknown[fixed], -1);
    const int64_t row = k.e.unknown[next];
    const double kij = coefficient(&k, next, fixed);
    assert_true(kij > 0);
    assert_int_equal(k.e.particle[row], next);
    assert_true(fabs(k.e.shift[row] - kij) < 1e-14 * kij);
    assert_true(fabs(k.e.rhs[row] - 1234 * kij) < 1e-11 * kij);
    assert_true(k.e.p[row] == 77 && k.e.weight[row] == 1e-3 * 1e-3);
    assert_memory_equal(k.e.x + 3 * row, k.c.x + 3 * next, 3 * sizeof(double));
    tank_free(&k);
}

/* ---- pressure data and components
 * ------------------------------------------------------------------- */

static double mean_rhs(const mps__ppe *e, int32_t component)
{
    double sum = 0, size = 0;
    for (int64_t r = 0; r < e->n; r++)
        if (e->problem.component[r] == component) {
            sum += e->rhs[r];
            size += fabs(e->rhs[r]);
        }
    assert_true(size > 0);
    return sum / size;
}

/* A full closed tank has no pressure datum: one component, and a right-hand side with mean zero. */
static void closed_tank(void **state)
{
    (void)state;
    tank k;
    tank_init(&k, cloud_lattice(2, 10, 12, 1, 0.2, 6));
    add_floor(&k, 10);
    for (int64_t i = 0; i < k.c.n; i++) k.rhs[i] = 1 + (double)(i % 7);
    assemble(&k);
    check_matrix(&k.e);
    assert_int_equal(k.e.problem.components, 1);
    for (int64_t r = 0; r < k.e.n; r++) assert_int_equal(k.e.problem.component[r], 0);
    assert_true(fabs(mean_rhs(&k.e, 0)) < 1e-14);
    k.shift[60] = 1e-6; /* the smallest shift is a pressure datum */
    assemble(&k);
    assert_int_equal(k.e.problem.components, 0);
    k.shift[60] = 0;
    k.fixed[60] = 1; /* so is one fixed neighbour */
    assemble(&k);
    assert_int_equal(k.e.problem.components, 0);
    tank_free(&k);
}

/* Separate pools: each has its own pressure datum or none; only the closed ones are singular. */
static void separate_pools(void **state)
{
    (void)state;
    tank k;
    cloud c = cloud_lattice(2, 18, 6, 1, 0.2, 7);
    for (int64_t i = 0; i < c.n; i++)
        c.x[2 * i] += 10 * CLOUD_DP * (double)(i % 18 / 6); /* three pools, 6 wide */
    tank_init(&k, c);
    for (int64_t i = 0; i < c.n; i++) {
        k.rhs[i] = 1 + (double)(i % 18 / 6) + (double)(i % 5);
        k.fixed[i] = i == 3; /* the first one is open */
    }
    assemble(&k);
    check_matrix(&k.e);
    assert_int_equal(k.e.problem.components, 2);
    for (int64_t i = 0; i < c.n; i++)
        if (k.e.unknown[i] >= 0)
            assert_int_equal(k.e.problem.component[k.e.unknown[i]], (int)(i % 18 / 6) - 1);
    assert_true(fabs(mean_rhs(&k.e, 0)) < 1e-14 && fabs(mean_rhs(&k.e, 1)) < 1e-14);
    tank_free(&k);
}

/* Rows in any order, so that a pool starts as many union-find trees that merge late: 1 and 3
 * threads find the one without a pressure datum. */
static void pools_in_any_order(void **state)
{
    (void)state;
    for (int32_t many = 1; many <= 3; many += 2) {
        tank k;
        int pool[MOST];
        cloud c = cloud_lattice(2, 24, 20, 1, 0, 11);
        const mps_parallel threads = {.struct_size = sizeof threads, .threads = many};
        for (int64_t i = 0; i < c.n; i++) {
            const int64_t at = i * 151 % c.n;
            pool[i] = (int)(at % 24 / 8);
            c.x[2 * i] = CLOUD_DP * (double)(at % 24 + 10 * pool[i]);
            c.x[2 * i + 1] = CLOUD_DP * (double)(at / 24);
        }
        tank_init(&k, c);
        assert_int_equal(mps_neighbours_parallel_set(k.list, &threads), MPS_OK);
        assert_int_equal(
            mps_neighbours_stencil_get(k.list, MPS_FAR, &k.view.far.kernel, &k.view.far), MPS_OK);
        for (int64_t i = c.n - 9; i < c.n; i++) k.shift[i] = pool[i] != 1 ? 1e-6 : 0;
        assemble(&k);
        assert_int_equal(k.e.problem.components, 1);
        for (int64_t r = 0; r < k.e.n; r++)
            assert_int_equal(k.e.problem.component[r], pool[k.e.particle[r]] == 1 ? 0 : -1);
        k.shift[2] = 1e-6; /* in the second pool */
        assert_int_equal(pool[2], 1);
        assemble(&k);
        assert_int_equal(k.e.problem.components, 0);
        tank_free(&k);
    }
}

/* Drops that nothing touches: fixed, they have their value; spray is in no equation; never a zero
 * row. */
static void detached_fluid(void **state)
{
    (void)state;
    tank k;
    double p[MOST];
    cloud c = cloud_lattice(2, 8, 8, 1, 0.2, 8);
    for (int j = 0; j < 3; j++) c.x[2 * (60 + j)] += (20 + 10 * j) * CLOUD_DP;
    tank_init(&k, c);
    k.fixed[0] = k.fixed[60] = 1;
    k.value[60] = 42;
    k.rhs[61] = 5;   /* no neighbour, no pressure datum: p = 0 */
    k.shift[62] = 2; /* no neighbour, but a pressure datum */
    k.rhs[62] = 8;
    k.region[20] = MPS_REGION_SPRAY;
    k.rhs[20] = 3;
    for (int64_t i = 0; i < k.c.n; i++) k.p[i] = 7;
    assemble(&k);
    check_matrix(&k.e);
    assert_int_equal(k.e.problem.components, 0);
    assert_int_equal(k.e.unknown[20], -1);
    assert_int_equal(k.e.n, 64 - 3);
    solve(&k, p);
    assert_true(p[60] == 42 && p[61] == 0 && p[20] == 0);
    assert_true(fabs(p[62] - 4) < 1e-12);
    for (int64_t i = 1; i < 60; i++)
        if (i != 20)
            assert_true(fabs(p[i]) < 1e-9); /* the spray's source has no effect on others */
    tank_free(&k);
}

/* All rows fixed: no unknowns, and the fixed values are the result. */
static void no_unknowns(void **state)
{
    (void)state;
    tank k;
    double p[MOST];
    tank_init(&k, cloud_lattice(2, 5, 5, 1, 0, 9));
    for (int64_t i = 0; i < k.c.n; i++) {
        k.fixed[i] = 1;
        k.value[i] = (double)i;
    }
    assemble(&k);
    assert_int_equal(k.e.n, 0);
    assert_int_equal(k.e.problem.components, 0);
    mps__ppe_scatter(&k.e, &k.view, &k.terms, p);
    for (int64_t i = 0; i < k.c.n; i++) assert_true(p[i] == (double)i);
    tank_free(&k);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrix_and_double_loop),
        cmocka_unit_test(threads_agree),
        cmocka_unit_test(hydrostatic),
        cmocka_unit_test(fixed_rows),
        cmocka_unit_test(closed_tank),
        cmocka_unit_test(separate_pools),
        cmocka_unit_test(pools_in_any_order),
        cmocka_unit_test(detached_fluid),
        cmocka_unit_test(no_unknowns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
