/* SPDX-License-Identifier: BSD-3-Clause */
/* Properties of the operators on any set of particles: consistency on the lattice, symmetries,
 * conservation. */
#include "../unit/cloud.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <cmocka.h>

/* A set of particles with its list and stencil (default: improved kernel, re = 2.1 dp). */
typedef struct scene {
    cloud c;
    mps_neighbours *list;
    mps_stencil t;
} scene;

static scene scene_make(cloud c, double re)
{
    scene s = {.c = c, .t = {.struct_size = sizeof s.t}};
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_create(c.dim, CLOUD_DP, NULL, &s.list), MPS_OK);
    assert_int_equal(mps_neighbours_build(s.list, c.n, c.x, re * CLOUD_DP, re * CLOUD_DP), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(s.list, MPS_NEAR, &kernel, &s.t), MPS_OK);
    return s;
}

static void scene_free(scene *s)
{
    mps_neighbours_destroy(s->list);
    cloud_free(&s->c);
}

static cloud lattice(int dim)
{
    return dim == 2 ? cloud_lattice(2, 24, 20, 1, 0, 1) : cloud_lattice(3, 12, 11, 10, 0, 1);
}
static cloud jittered(int dim, uint64_t seed)
{
    return dim == 2 ? cloud_lattice(2, 24, 20, 1, 0.3, seed)
                    : cloud_lattice(3, 12, 11, 10, 0.3, seed);
}
static const int *sides(int dim)
{
    static const int two[3] = {24, 20, 1}, three[3] = {12, 11, 10};
    return dim == 2 ? two : three;
}

static double largest(const double *v, int64_t n)
{
    double most = 0;
    for (int64_t k = 0; k < n; k++) most = fmax(most, fabs(v[k]));
    return most;
}

static void assert_close(const double *a, const double *b, int64_t n, double tolerance)
{
    const double scale = largest(b, n);
    for (int64_t k = 0; k < n; k++)
        if (!(fabs(a[k] - b[k]) <= tolerance * scale))
            fail_msg("value %lld: %.17g, not %.17g, of at most %g", (long long)k, a[k], b[k],
                     scale);
}

/* ---- consistency ----------------------------------------------------------------------------- */

static void sum_of_weights(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(lattice(dim), 3.1);
        double *n = cloud_doubles(s.c.n);
        int64_t inside = 0;
        assert_int_equal(mps_op_number_density(&s.t, n), MPS_OK);
        for (int64_t i = 0; i < s.c.n; i++) {
            if (cloud_inside(&s.c, i, sides(dim), s.t.re)) {
                assert_true(fabs(n[i] - s.t.n0) <= 1e-13 * s.t.n0);
                inside++;
            } else {
                assert_true(n[i] < s.t.n0 * (1 + 1e-13));
            }
        }
        assert_true(inside > 20);
        free(n);
        scene_free(&s);
    }
}

/* Differences of equal numbers: not small but zero. */
static void constants_vanish(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(jittered(dim, 2), 2.1);
        double *f = cloud_doubles(s.c.n * dim), *b = cloud_doubles(s.c.n * dim * dim),
               *out = cloud_doubles(s.c.n * dim);
        for (int64_t k = 0; k < s.c.n * dim; k++) f[k] = 7.7;
        assert_int_equal(mps_op_correction(&s.t, 0.2, b), MPS_OK);
        for (int op = 0; op < 6; op++) {
            for (int64_t k = 0; k < s.c.n * dim; k++) out[k] = 0;
            if (op == 0) assert_int_equal(mps_op_gradient(&s.t, f, out), MPS_OK);
            if (op == 1) assert_int_equal(mps_op_gradient_corrected(&s.t, b, f, out), MPS_OK);
            if (op == 2) assert_int_equal(mps_op_divergence(&s.t, f, out), MPS_OK);
            if (op == 3) assert_int_equal(mps_op_divergence_corrected(&s.t, b, f, out), MPS_OK);
            if (op == 4) assert_int_equal(mps_op_laplacian(&s.t, f, out), MPS_OK);
            if (op == 5) assert_int_equal(mps_op_laplacian_vector(&s.t, f, out), MPS_OK);
            assert_true(largest(out, s.c.n * dim) == 0);
        }
        free(f);
        free(b);
        free(out);
        scene_free(&s);
    }
}

/* f = a.x + 3 and u = G x: gradient a, divergence tr G; exact where `all` or the neighbourhood is
 * full. */
static void check_linear(scene *s, const double *b, bool all)
{
    static const double a[3] = {1.5, -2.25, 0.75}, G[9] = {1, 2, -1, 0.5, -3, 1, 4, -2, 2.5};
    const int dim = s->c.dim;
    double *f = cloud_doubles(s->c.n), *u = cloud_doubles(s->c.n * dim),
           *grad = cloud_doubles(s->c.n * dim), *div = cloud_doubles(s->c.n), trace = 0;
    int64_t checked = 0;
    for (int64_t i = 0; i < s->c.n; i++) {
        f[i] = 3;
        for (int d = 0; d < dim; d++) {
            f[i] += a[d] * s->c.x[i * dim + d];
            for (int e = 0; e < dim; e++) u[i * dim + d] += G[3 * d + e] * s->c.x[i * dim + e];
        }
    }
    for (int d = 0; d < dim; d++) trace += G[4 * d];
    assert_int_equal(
        b ? mps_op_gradient_corrected(&s->t, b, f, grad) : mps_op_gradient(&s->t, f, grad), MPS_OK);
    assert_int_equal(b ? mps_op_divergence_corrected(&s->t, b, u, div)
                       : mps_op_divergence(&s->t, u, div),
                     MPS_OK);
    for (int64_t i = 0; i < s->c.n; i++) {
        if (!all && !cloud_inside(&s->c, i, sides(dim), s->t.re)) continue;
        for (int d = 0; d < dim; d++)
            assert_true(fabs(grad[i * dim + d] - a[d]) < 2e-11); /* eps |f| / dp */
        assert_true(fabs(div[i] - trace) < 2e-11);
        checked++;
    }
    assert_true(checked > 100);
    free(f);
    free(u);
    free(grad);
    free(div);
}

static void linear_fields(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(lattice(dim), 2.1);
        check_linear(&s, NULL, false);
        scene_free(&s);
        s = scene_make(jittered(dim, 3), 2.1);
        double *b = cloud_doubles(s.c.n * dim * dim);
        /* a floor low enough that no particle, not even in a corner, is bounded */
        assert_int_equal(mps_op_correction(&s.t, 1e-3, b), MPS_OK);
        check_linear(&s, b, true);
        free(b);
        scene_free(&s);
    }
}

static void laplacian_of_square(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(lattice(dim), dim == 2 ? 4.1 : 3.1);
        double *f = cloud_doubles(s.c.n), *lap = cloud_doubles(s.c.n);
        int64_t checked = 0;
        for (int64_t k = 0; k < s.c.n * dim; k++) f[k / dim] += s.c.x[k] * s.c.x[k];
        assert_int_equal(mps_op_laplacian(&s.t, f, lap), MPS_OK);
        for (int64_t i = 0; i < s.c.n; i++) {
            if (!cloud_inside(&s.c, i, sides(dim), s.t.re)) continue;
            assert_true(fabs(lap[i] - 2 * dim) < 1e-11);
            checked++;
        }
        assert_true(checked > 20);
        free(f);
        free(lap);
        scene_free(&s);
    }
}

/* ---- symmetries ------------------------------------------------------------------------------ */

/* Results of all operators for one scene: density, divergence, laplacian [n]; gradient,
 * conservative, asymmetry [n*dim]. */
enum { SCALARS = 3, VECTORS = 3, RESULTS = 6 };

static void run_all(const scene *s, const double *f, const double *u, double *out[RESULTS])
{
    for (int k = 0; k < RESULTS; k++) out[k] = cloud_doubles(s->c.n * (k < SCALARS ? 1 : s->c.dim));
    assert_int_equal(mps_op_number_density(&s->t, out[0]), MPS_OK);
    assert_int_equal(mps_op_divergence(&s->t, u, out[1]), MPS_OK);
    assert_int_equal(mps_op_laplacian(&s->t, f, out[2]), MPS_OK);
    assert_int_equal(mps_op_gradient(&s->t, f, out[3]), MPS_OK);
    assert_int_equal(mps_op_gradient_conservative(&s->t, f, out[4]), MPS_OK);
    assert_int_equal(mps_op_asymmetry(&s->t, out[5]), MPS_OK);
}

static void free_all(double *out[RESULTS])
{
    for (int k = 0; k < RESULTS; k++) free(out[k]);
}

/* Rotate `n` vectors by 90 degrees about z. */
static void turn(double *v, int64_t n, int dim)
{
    for (int64_t i = 0; i < n; i++) {
        const double x = v[i * dim];
        v[i * dim] = -v[i * dim + 1];
        v[i * dim + 1] = x;
    }
}

/* r_ij is the same number after a translation, and permuted after a rotation by 90 degrees: results
 * have the same bytes. */
static void translation_and_rotation(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const int64_t n = (int64_t)sides(dim)[0] * sides(dim)[1] * sides(dim)[2];
        double *f = cloud_field(n, 5), *u = cloud_field(n * dim, 6), *before[RESULTS],
               *after[RESULTS];
        scene s = scene_make(jittered(dim, 4), 2.1);
        run_all(&s, f, u, before);
        scene_free(&s);
        cloud moved = jittered(dim, 4);
        for (int64_t k = 0; k < n * dim; k++) moved.x[k] += k % dim == 0 ? 1024 : -3;
        s = scene_make(moved, 2.1);
        run_all(&s, f, u, after);
        scene_free(&s);
        for (int k = 0; k < RESULTS; k++)
            assert_memory_equal(after[k], before[k],
                                (size_t)(n * (k < SCALARS ? 1 : dim)) * sizeof(double));
        free_all(after);
        cloud turned = jittered(dim, 4);
        turn(turned.x, n, dim);
        turn(u, n, dim);
        s = scene_make(turned, 2.1);
        run_all(&s, f, u, after);
        scene_free(&s);
        for (int k = SCALARS; k < RESULTS; k++) turn(before[k], n, dim);
        for (int k = 0; k < RESULTS; k++)
            assert_close(after[k], before[k], n * (k < SCALARS ? 1 : dim), 0);
        free_all(before);
        free_all(after);
        free(f);
        free(u);
    }
}

/* Particles in another order: sums in another order, so equal to rounding only. */
static void permutation(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(jittered(dim, 7), 2.1);
        const int64_t n = s.c.n;
        double *f = cloud_field(n, 8), *u = cloud_field(n * dim, 9), *g = cloud_doubles(n),
               *v = cloud_doubles(n * dim), *before[RESULTS], *after[RESULTS];
        run_all(&s, f, u, before);
        cloud mixed = cloud_empty(dim, n);
        for (int64_t i = 0; i < n; i++) {
            const int64_t to = (i * 1009 + 17) % n; /* 1009 is prime and divides neither n */
            memcpy(mixed.x + to * dim, s.c.x + i * dim, (size_t)dim * sizeof(double));
            memcpy(v + to * dim, u + i * dim, (size_t)dim * sizeof(double));
            g[to] = f[i];
        }
        scene p = scene_make(mixed, 2.1);
        run_all(&p, g, v, after);
        for (int k = 0; k < RESULTS; k++) {
            const int c = k < SCALARS ? 1 : dim;
            double *back = cloud_doubles(n * c);
            for (int64_t i = 0; i < n; i++)
                memcpy(back + i * c, after[k] + (i * 1009 + 17) % n * c,
                       (size_t)c * sizeof(double));
            assert_close(back, before[k], n * c, 1e-13);
            free(back);
        }
        scene_free(&s);
        scene_free(&p);
        free_all(before);
        free_all(after);
        free(f);
        free(u);
        free(g);
        free(v);
    }
}

/* ---- conservation ---------------------------------------------------------------------------- */

static double dot(const double *a, const double *b, int64_t n, double *size)
{
    double sum = 0;
    *size = 0;
    for (int64_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
        *size += fabs(a[k] * b[k]);
    }
    return sum;
}

/* Pair forces cancel: the conservative gradient and the Laplacian sum to nothing over all
 * particles. */
static void momentum_balance(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(jittered(dim, 10), 2.1);
        const int64_t n = s.c.n;
        double *f = cloud_field(n, 11), *grad = cloud_doubles(n * dim), *lap = cloud_doubles(n),
               sum = 0, size = 0;
        assert_int_equal(mps_op_gradient_conservative(&s.t, f, grad), MPS_OK);
        assert_int_equal(mps_op_laplacian(&s.t, f, lap), MPS_OK);
        for (int d = 0; d < dim; d++) {
            sum = size = 0;
            for (int64_t i = 0; i < n; i++) {
                sum += grad[i * dim + d];
                size += fabs(grad[i * dim + d]);
            }
            assert_true(size > 0 && fabs(sum) <= 1e-13 * size);
        }
        sum = size = 0;
        for (int64_t i = 0; i < n; i++) {
            sum += lap[i];
            size += fabs(lap[i]);
        }
        assert_true(size > 0 && fabs(sum) <= 1e-13 * size);
        free(f);
        free(grad);
        free(lap);
        scene_free(&s);
    }
}

/* The Laplacian is symmetric and negative; divergence and conservative gradient are minus each
 * other's transpose. */
static void adjoint_pairs(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(jittered(dim, 12), 2.1);
        const int64_t n = s.c.n;
        double *f = cloud_field(n, 13), *g = cloud_field(n, 14), *u = cloud_field(n * dim, 15);
        double *lf = cloud_doubles(n), *lg = cloud_doubles(n), *div = cloud_doubles(n),
               *grad = cloud_doubles(n * dim), size, other;
        assert_int_equal(mps_op_laplacian(&s.t, f, lf), MPS_OK);
        assert_int_equal(mps_op_laplacian(&s.t, g, lg), MPS_OK);
        assert_int_equal(mps_op_divergence(&s.t, u, div), MPS_OK);
        assert_int_equal(mps_op_gradient_conservative(&s.t, f, grad), MPS_OK);
        const double fg = dot(f, lg, n, &size), gf = dot(g, lf, n, &other);
        assert_true(fabs(fg - gf) <= 1e-13 * size);
        assert_true(dot(f, lf, n, &size) < 0);
        const double fdiv = dot(f, div, n, &size), ugrad = dot(u, grad, n * dim, &other);
        assert_true(fabs(fdiv + ugrad) <= 1e-13 * (size + other));
        free(f);
        free(g);
        free(u);
        free(lf);
        free(lg);
        free(div);
        free(grad);
        scene_free(&s);
    }
}

/* ---- surface and bounds ---------------------------------------------------------------------- */

/* |A| in the top row of a half space, by counting lattice points. */
static double half_space(const mps_stencil *t)
{
    double sum = 0;
    for (int i = -4; i <= 4; i++)
        for (int j = 1; j <= 4; j++)
            for (int k = t->dim == 3 ? -4 : 0; k <= (t->dim == 3 ? 4 : 0); k++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum += j * t->dp / r * mps_kernel_value(&t->kernel, r, t->re);
            }
    return t->dim / t->n0 * sum;
}

static void asymmetry_of_half_space(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        scene s = scene_make(lattice(dim), 2.1);
        double *a = cloud_doubles(s.c.n * dim);
        const double top = CLOUD_DP * (sides(dim)[1] - 1);
        int64_t surface = 0;
        assert_int_equal(mps_op_asymmetry(&s.t, a), MPS_OK);
        for (int64_t i = 0; i < s.c.n; i++) {
            double middle[3];
            cloud one = {dim, 1, middle};
            memcpy(middle, s.c.x + i * dim, (size_t)dim * sizeof(double));
            const bool inside = cloud_inside(&s.c, i, sides(dim), s.t.re), upper = middle[1] == top;
            middle[1] = top / 2; /* so that only the side faces count */
            if (!inside && !(upper && cloud_inside(&one, 0, sides(dim), s.t.re))) continue;
            for (int d = 0; d < dim; d++)
                assert_true(fabs(a[i * dim + d] - (upper && d == 1 ? half_space(&s.t) : 0)) <
                            1e-13);
            surface += upper;
        }
        assert_true(surface > 10 && half_space(&s.t) > 0.1);
        free(a);
        scene_free(&s);
    }
}

/* |B v| <= |v| / floor and B symmetric, for every shape: a pair, a line, a plane, a cloud. */
static void check_bounded(cloud c, double floor)
{
    scene s = scene_make(c, 2.1);
    const int dim = c.dim;
    double *b = cloud_doubles(c.n * dim * dim);
    uint64_t seed = 16;
    assert_int_equal(mps_op_correction(&s.t, floor, b), MPS_OK);
    for (int64_t i = 0; i < c.n; i++) {
        const double *m = b + i * dim * dim;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < d; e++)
                assert_true(fabs(m[d * dim + e] - m[e * dim + d]) <= 1e-13 / floor);
        for (int k = 0; k < 5; k++) {
            double v[3], v2 = 0, w2 = 0, vw = 0;
            for (int d = 0; d < dim; d++) v[d] = cloud_random(&seed);
            for (int d = 0; d < dim; d++) {
                double w = 0;
                for (int e = 0; e < dim; e++) w += m[d * dim + e] * v[e];
                v2 += v[d] * v[d];
                w2 += w * w;
                vw += v[d] * w;
            }
            assert_true(sqrt(w2) <= (1 + 1e-12) * sqrt(v2) / floor && vw > 0);
        }
    }
    free(b);
    scene_free(&s);
}

static void correction_bounded(void **state)
{
    (void)state;
    const double floors[] = {0.05, 0.2, 1.0};
    for (int k = 0; k < 3; k++)
        for (int dim = 2; dim <= 3; dim++) {
            check_bounded(cloud_lattice(dim, 2, 1, 1, 0.2, 17), floors[k]);
            check_bounded(cloud_lattice(dim, 40, 1, 1, 0, 18), floors[k]);
            check_bounded(cloud_lattice(dim, 15, 15, 1, 0, 19), floors[k]);
            check_bounded(jittered(dim, 20), floors[k]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_of_weights),
        cmocka_unit_test(constants_vanish),
        cmocka_unit_test(linear_fields),
        cmocka_unit_test(laplacian_of_square),
        cmocka_unit_test(permutation),
        cmocka_unit_test(translation_and_rotation),
        cmocka_unit_test(momentum_balance),
        cmocka_unit_test(adjoint_pairs),
        cmocka_unit_test(asymmetry_of_half_space),
        cmocka_unit_test(correction_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
