/* SPDX-License-Identifier: BSD-3-Clause */
/* Every operator against a double loop over all particles that shares no code with the library. */
#include "operator_fixture.h"
#include "parallel.h"

/* Allowed difference over the largest of the summed terms. */
static const double tolerance = 1e-13;

enum {
    DENSITY,
    GRADIENT,
    CONSERVATIVE,
    GRADIENT_CORRECTED,
    DIVERGENCE,
    DIVERGENCE_CORRECTED,
    LAPLACIAN,
    LAPLACIAN_VECTOR,
    ASYMMETRY,
    VOLUME,
    VOLUME_SUM,
    OPS
};
static const char *const op_name[OPS] = {"density",      "gradient",
                                         "conservative", "corrected gradient",
                                         "divergence",   "corrected divergence",
                                         "laplacian",    "vector laplacian",
                                         "asymmetry",    "volume",
                                         "volume sum"};

/* Volume measure, one at the centre: Wendland C2 in 2-D, broader in 3-D. */
static double wide_2d(double r, double re)
{
    return pow(1 - r / re, 4) * (1 + 4 * r / re);
}

static double wide_3d(double r, double re)
{
    return pow(1 - r * r / (re * re), 3);
}

static double user_parabola(void *user, double r, double re)
{
    return *(const double *)user * (1 - r / re) * (1 - r / re);
}

/* One cloud with fields on it, and what the operators made of them. */
typedef struct bench {
    cloud c;
    double *f, *u, *b;
    double *result[OPS];
} bench;

static int components(const bench *s, int op)
{
    const bool vector = op == GRADIENT || op == CONSERVATIVE || op == GRADIENT_CORRECTED ||
                        op == LAPLACIAN_VECTOR || op == ASYMMETRY;
    return vector ? s->c.dim : 1;
}

static bench bench_make(cloud c)
{
    bench s = {.c = c};
    s.f = cloud_field(c.n, 11);
    s.u = cloud_field(c.n * c.dim, 12);
    s.b = cloud_field(c.n * c.dim * c.dim, 13);
    for (int op = 0; op < OPS; op++) s.result[op] = cloud_doubles(c.n * components(&s, op));
    return s;
}

static void bench_free(bench *s)
{
    for (int op = 0; op < OPS; op++) free(s->result[op]);
    free(s->f);
    free(s->u);
    free(s->b);
    cloud_free(&s->c);
}

static void bench_run(bench *s, const mps_stencil *t)
{
    assert_int_equal(mps_op_number_density(t, s->result[DENSITY]), MPS_OK);
    assert_int_equal(mps_op_gradient(t, s->f, s->result[GRADIENT]), MPS_OK);
    assert_int_equal(mps_op_gradient_conservative(t, s->f, s->result[CONSERVATIVE]), MPS_OK);
    assert_int_equal(mps_op_gradient_corrected(t, s->b, s->f, s->result[GRADIENT_CORRECTED]),
                     MPS_OK);
    assert_int_equal(mps_op_divergence(t, s->u, s->result[DIVERGENCE]), MPS_OK);
    assert_int_equal(mps_op_divergence_corrected(t, s->b, s->u, s->result[DIVERGENCE_CORRECTED]),
                     MPS_OK);
    assert_int_equal(mps_op_laplacian(t, s->f, s->result[LAPLACIAN]), MPS_OK);
    assert_int_equal(mps_op_laplacian_vector(t, s->u, s->result[LAPLACIAN_VECTOR]), MPS_OK);
    assert_int_equal(mps_op_asymmetry(t, s->result[ASYMMETRY]), MPS_OK);
    assert_int_equal(mps_op_volume_deviation(t, s->result[VOLUME]), MPS_OK);
    assert_int_equal(mps_op_volume_sum(t, s->f, s->result[VOLUME_SUM]), MPS_OK);
}

/* ---- the oracle ------------------------------------------------------------------------------ */

typedef struct total {
    double sum[3], largest;
} total;

static void add(total *t, int d, double term)
{
    t->sum[d] += term;
    t->largest = fmax(t->largest, fabs(term));
}

/* Terms of one pair, as the equations have them. */
static void add_pair(const bench *s, int64_t i, int64_t j, double r2, double w, total t[OPS])
{
    const int dim = s->c.dim;
    double df = s->f[j] - s->f[i], du[3], e[3], rdu = 0, edu = 0;
    for (int d = 0; d < dim; d++) {
        const double rd = s->c.x[j * dim + d] - s->c.x[i * dim + d];
        du[d] = s->u[j * dim + d] - s->u[i * dim + d];
        e[d] = 0;
        for (int c = 0; c < dim; c++)
            e[d] += s->b[(i * dim + d) * dim + c] * (s->c.x[j * dim + c] - s->c.x[i * dim + c]);
        rdu += rd * du[d];
        edu += e[d] * du[d];
        add(&t[GRADIENT], d, df * rd / r2 * w);
        add(&t[CONSERVATIVE], d, (s->f[j] + s->f[i]) * rd / r2 * w);
        add(&t[GRADIENT_CORRECTED], d, df * e[d] / r2 * w);
        add(&t[LAPLACIAN_VECTOR], d, du[d] * w);
        add(&t[ASYMMETRY], d, -rd / sqrt(r2) * w);
    }
    add(&t[DENSITY], 0, w);
    add(&t[LAPLACIAN], 0, df * w);
    add(&t[DIVERGENCE], 0, rdu / r2 * w);
    add(&t[DIVERGENCE_CORRECTED], 0, edu / r2 * w);
}

static double factor(int op, int dim, double n0, double lambda, double s0)
{
    if (op == DENSITY) return 1;
    if (op == VOLUME || op == VOLUME_SUM) return 1 / s0;
    return op == LAPLACIAN || op == LAPLACIAN_VECTOR ? 2.0 * dim / (n0 * lambda) : dim / n0;
}

static void compare(const bench *s, double re, weight_fn weight)
{
    double n0, lambda, s0, unused, worst[OPS] = {0};
    lattice(s->c.dim, re, weight, &n0, &lambda);
    const weight_fn wide = s->c.dim == 2 ? wide_2d : wide_3d;
    lattice(s->c.dim, re, wide, &s0, &unused);
    for (int64_t i = 0; i < s->c.n; i++) {
        total t[OPS] = {{{0}, 0}};
        add(&t[VOLUME], 0, 1); /* the particle itself */
        add(&t[VOLUME_SUM], 0, s->f[i]);
        for (int64_t j = 0; j < s->c.n; j++) {
            const double r2 = cloud_distance2(&s->c, i, j);
            if (j == i || r2 >= re * re) continue;
            add_pair(s, i, j, r2, weight(sqrt(r2), re), t);
            add(&t[VOLUME], 0, wide(sqrt(r2), re));
            add(&t[VOLUME_SUM], 0, s->f[j] * wide(sqrt(r2), re));
        }
        for (int op = 0; op < OPS; op++)
            for (int d = 0; d < components(s, op); d++) {
                const double c = factor(op, s->c.dim, n0, lambda, 1 + s0);
                const double got = s->result[op][i * components(s, op) + d] +
                                   (op == VOLUME); /* a deviation from one */
                assert_true(isfinite(got));
                worst[op] = fmax(worst[op], fabs(got - c * t[op].sum[d]) / (c * t[op].largest));
            }
    }
    for (int op = 0; op < OPS; op++) {
        if (worst[op] > tolerance)
            print_error("%s, %d-D, re %g dp: off by %g\n", op_name[op], s->c.dim, re / CLOUD_DP,
                        worst[op]);
        assert_true(worst[op] <= tolerance);
    }
}

/* All operators for one kernel: against the oracle, and with two threads the same bytes. */
static void check_kernel(bench *s, const mps_kernel *kernel, weight_fn weight)
{
    const double re[2] = {2.1 * CLOUD_DP, 3.1 * CLOUD_DP};
    mps_neighbours *list = NULL;
    mps__context context = {.allocator = mps__allocator_default()};
    mps__pool pool;
    bench two = bench_make(cloud_empty(s->c.dim, s->c.n));
    mps__pool_init(&pool, &context);
    mps__pool_resize(&pool, 2);
    assert_int_equal(mps_neighbours_create(s->c.dim, CLOUD_DP, NULL, &list), MPS_OK);
    assert_int_equal(mps_neighbours_build(list, s->c.n, s->c.x, re[0], re[1]), MPS_OK);
    for (int which = 0; which < 2; which++) {
        mps_stencil t = {.struct_size = sizeof t};
        assert_int_equal(mps_neighbours_stencil_get(list, which, kernel, &t), MPS_OK);
        bench_run(s, &t);
        compare(s, re[which], weight);
        t.parallel = &pool.parallel;
        bench_run(&two, &t);
        for (int op = 0; op < OPS; op++)
            assert_memory_equal(two.result[op], s->result[op],
                                (size_t)(s->c.n * components(s, op)) * sizeof(double));
    }
    mps_neighbours_destroy(list);
    mps__pool_free(&pool);
    bench_free(&two);
}

static void check_cloud(cloud c)
{
    double three = 3;
    bench s = bench_make(c);
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    check_kernel(&s, &kernel, improved);
    assert_int_equal(mps_kernel_find("original", &kernel), MPS_OK);
    check_kernel(&s, &kernel, original);
    assert_int_equal(mps_kernel_custom(user_parabola, &three, &kernel), MPS_OK);
    check_kernel(&s, &kernel, parabola);
    bench_free(&s);
}

static void oracle_2d(void **state)
{
    (void)state;
    check_cloud(cloud_lattice(2, 52, 48, 1, 0.3, 1));
}

static void oracle_3d(void **state)
{
    (void)state;
    check_cloud(cloud_lattice(3, 12, 11, 12, 0.3, 2));
}

/* ---- correction matrix ----------------------------------------------------------------------- */

/* M of one particle by the double loop. */
static void moment(const cloud *c, int64_t i, double re, double n0, double m[9])
{
    memset(m, 0, 9 * sizeof *m);
    for (int64_t j = 0; j < c->n; j++) {
        const double r2 = cloud_distance2(c, i, j);
        if (j == i || r2 >= re * re) continue;
        for (int a = 0; a < c->dim; a++)
            for (int b = 0; b < c->dim; b++)
                m[a * c->dim + b] += c->dim / n0 * (c->x[j * c->dim + a] - c->x[i * c->dim + a]) *
                                     (c->x[j * c->dim + b] - c->x[i * c->dim + b]) / r2 *
                                     improved(sqrt(r2), re);
    }
}

static double identity_error(int dim, const double *b, const double *m)
{
    double worst = 0;
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) {
            double sum = i == j ? -1 : 0;
            for (int k = 0; k < dim; k++) sum += b[i * dim + k] * m[k * dim + j];
            worst = fmax(worst, fabs(sum));
        }
    return worst;
}

/* B M = 1 in a cloud whose every particle has neighbours on all sides but the outer ones, down to
 * the smallest floor. */
static void check_correction(cloud c)
{
    const double re = 2.1 * CLOUD_DP;
    double n0, lambda, m[9], *b = cloud_doubles(c.n * c.dim * c.dim);
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil t = {.struct_size = sizeof t};
    mps_neighbours *list = NULL;
    lattice(c.dim, re, improved, &n0, &lambda);
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_create(c.dim, CLOUD_DP, NULL, &list), MPS_OK);
    assert_int_equal(mps_neighbours_build(list, c.n, c.x, re, re), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t), MPS_OK);
    assert_int_equal(mps_op_correction(&t, 1e-6, b), MPS_OK);
    for (int64_t i = 0; i < c.n; i++) {
        moment(&c, i, re, n0, m);
        assert_true(identity_error(c.dim, b + i * c.dim * c.dim, m) < 1e-12);
    }
    mps_neighbours_destroy(list);
    free(b);
    cloud_free(&c);
}

static void correction_inverts(void **state)
{
    (void)state;
    check_correction(cloud_lattice(2, 30, 30, 1, 0.25, 3));
    check_correction(cloud_lattice(3, 9, 9, 9, 0.25, 4));
}

/* On a line M has one eigenvalue of the line and zeros across it: those become the floor, and only
 * those. */
static void correction_floor(void **state)
{
    (void)state;
    const double re = 2.1 * CLOUD_DP, floor = 0.2;
    for (int dim = 2; dim <= 3; dim++) {
        cloud c = cloud_lattice(dim, 20, 1, 1, 0, 5);
        double n0, lambda, m[9], b[20 * 9];
        mps_kernel kernel = {.struct_size = sizeof kernel};
        mps_stencil t = {.struct_size = sizeof t};
        mps_neighbours *list = NULL;
        lattice(dim, re, improved, &n0, &lambda);
        moment(&c, 10, re, n0, m);
        assert_true(m[0] > floor);
        assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
        assert_int_equal(mps_neighbours_create(dim, CLOUD_DP, NULL, &list), MPS_OK);
        assert_int_equal(mps_neighbours_build(list, c.n, c.x, re, re), MPS_OK);
        assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t), MPS_OK);
        assert_int_equal(mps_op_correction(&t, floor, b), MPS_OK);
        for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++) {
                const double exact = i != j ? 0 : i == 0 ? 1 / m[0] : 1 / floor;
                assert_true(fabs(b[10 * dim * dim + i * dim + j] - exact) < 1e-13 / floor);
            }
        mps_neighbours_destroy(list);
        cloud_free(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oracle_2d),
        cmocka_unit_test(oracle_3d),
        cmocka_unit_test(correction_inverts),
        cmocka_unit_test(correction_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
