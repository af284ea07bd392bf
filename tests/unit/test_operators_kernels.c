/* SPDX-License-Identifier: BSD-3-Clause */
/* Operators: kernels, refused arguments, particles without neighbours, a stretched lattice. */
#include "operator_fixture.h"

/* ---- kernels and bad arguments --------------------------------------------------------------- */

static double negative_kernel(void *user, double r, double re)
{
    return (void)user, 0.5 * re - r;
}
static double nan_kernel(void *user, double r, double re)
{
    return (void)user, NAN * r * re;
}

/* Many weights at once are the weights one by one. */
static void kernel_rows(void **state)
{
    (void)state;
    double r[7], w[7];
    mps_kernel k[3] = {
        {.struct_size = sizeof k[0]}, {.struct_size = sizeof k[0]}, {.struct_size = sizeof k[0]}};
    assert_int_equal(mps_kernel_find("improved", &k[0]), MPS_OK);
    assert_int_equal(mps_kernel_find("original", &k[1]), MPS_OK);
    assert_int_equal(mps_kernel_custom(negative_kernel, NULL, &k[2]), MPS_OK);
    for (int i = 0; i < 7; i++) r[i] = 0.1 + 0.27 * i;
    for (int n = 0; n < 3; n++) {
        mps_kernel_weights(&k[n], 2.1, 7, r, w);
        for (int i = 0; i < 7; i++) assert_true(w[i] == mps_kernel_weight(&k[n], r[i], 2.1));
        memcpy(w, r, sizeof w);
        mps_kernel_weights(&k[n], 2.1, 6, w, w);
        assert_true(w[5] == mps_kernel_weight(&k[n], r[5], 2.1) && w[6] == r[6]);
    }
}

static void kernels(void **state)
{
    (void)state;
    mps_kernel k = {.struct_size = sizeof k};
    double n0 = 0, lambda = 0, n0_oracle, lambda_oracle;
    assert_int_equal(mps_kernel_find("improved", &k), MPS_OK);
    assert_true(fabs(mps_kernel_value(&k, 0, 1) - (1 / 0.15 - 1)) < 1e-14); /* W22 (3) */
    assert_true(mps_kernel_value(&k, 1, 1) == 0 && mps_kernel_value(&k, 2, 1) == 0 &&
                mps_kernel_value(&k, -1, 1) == 0);
    for (int dim = 2; dim <= 3; dim++) {
        lattice(dim, 4.1 * CLOUD_DP, improved, &n0_oracle, &lambda_oracle);
        assert_int_equal(mps_lattice_constants(&k, dim, CLOUD_DP, 4.1 * CLOUD_DP, &n0, &lambda),
                         MPS_OK);
        assert_true(fabs(n0 / n0_oracle - (1)) < 1e-13);
        assert_true(fabs(lambda / lambda_oracle - (1)) < 1e-13);
    }
    assert_int_equal(mps_lattice_constants(&k, 2, CLOUD_DP, 4.1 * CLOUD_DP, NULL, NULL), MPS_OK);
    assert_int_equal(mps_lattice_constants(&k, 4, 1, 2.1, &n0, &lambda), MPS_E_ARG);
    assert_int_equal(mps_lattice_constants(&k, 2, 0, 2.1, &n0, &lambda), MPS_E_ARG);
    assert_int_equal(mps_lattice_constants(&k, 2, 1, 0.9, &n0, &lambda), MPS_E_ARG);
    assert_int_equal(mps_lattice_constants(&k, 2, 1, NAN, &n0, &lambda), MPS_E_ARG);
    assert_int_equal(mps_lattice_constants(NULL, 2, 1, 2.1, &n0, &lambda), MPS_E_ARG);
    const mps_kernel bare = {.id = MPS_KERNEL_CUSTOM}; /* a custom kernel without its function */
    assert_int_equal(mps_lattice_constants(&bare, 2, 1, 2.1, &n0, &lambda), MPS_E_ARG);
    assert_true(mps_kernel_value(&bare, 0.5, 1) == 0);
    assert_int_equal(mps_kernel_find("improvd", &k), MPS_E_NAME);
    assert_int_equal(mps_kernel_find(NULL, &k), MPS_E_ARG);
    assert_int_equal(mps_kernel_custom(NULL, NULL, &k), MPS_E_ARG);
    assert_int_equal(mps_kernel_custom(negative_kernel, NULL, &k), MPS_OK);
    assert_int_equal(mps_lattice_constants(&k, 2, 1, 2.1, &n0, &lambda), MPS_E_ARG);
    assert_int_equal(mps_kernel_custom(nan_kernel, NULL, &k), MPS_OK);
    assert_int_equal(mps_lattice_constants(&k, 2, 1, 2.1, &n0, &lambda), MPS_E_ARG);
}

/* Every operator refuses a stencil. */
static void refuse_all(const mps_stencil *t, const double *in, double *out)
{
    assert_int_equal(mps_op_number_density(t, out), MPS_E_ARG);
    assert_int_equal(mps_op_gradient(t, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_gradient_conservative(t, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_gradient_corrected(t, in, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_divergence(t, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_divergence_corrected(t, in, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_laplacian(t, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_laplacian_vector(t, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_asymmetry(t, out), MPS_E_ARG);
    assert_int_equal(mps_op_correction(t, 0.2, out), MPS_E_ARG);
    assert_int_equal(mps_op_volume_deviation(t, out), MPS_E_ARG);
    assert_int_equal(mps_op_volume_sum(t, in, out), MPS_E_ARG);
}

#define TOLD(list, call, word)                                                              \
    do {                                                                                    \
        assert_int_equal(call, MPS_E_ARG);                                                  \
        if (!strstr(mps_neighbours_error(list), (word)))                                    \
            fail_msg("\"%s\" does not mention \"%s\"", mps_neighbours_error(list), (word)); \
    } while (0)

/* The error text of the list names the invalid argument of an operator, and what is allowed. */
static void refuse_told(mps_neighbours *list, const mps_stencil *t, const double *in, double *out)
{
    mps_stencil bad;
    TOLD(list, mps_op_gradient(t, NULL, out), "mps_op_gradient(): f is NULL");
    TOLD(list, mps_op_gradient(t, in, NULL), "grad is NULL");
    TOLD(list, mps_op_divergence_corrected(t, NULL, in, out),
         "mps_op_divergence_corrected(): b is NULL");
    TOLD(list, mps_op_volume_sum(t, out, out), "f and sum are the same array");
    TOLD(list, mps_op_correction(t, NAN, out), "mps_op_correction(): floor is nan: must be > 0");
    bad = *t, bad.dim = 4;
    TOLD(list, mps_op_asymmetry(&bad, out), "stencil.dim is 4: must be 2 or 3");
    bad = *t, bad.re = NAN;
    TOLD(list, mps_op_volume_deviation(&bad, out), "stencil.re is nan: must be > 0 and finite");
    bad = *t, bad.n0 = INFINITY;
    TOLD(list, mps_op_laplacian(&bad, in, out), "stencil.n0 is inf");
    bad = *t, bad.col = NULL;
    TOLD(list, mps_op_number_density(&bad, out), "stencil.col is NULL");
    bad = *t, bad.struct_size = 24;
    TOLD(list, mps_op_number_density(&bad, out), "mps_stencil.struct_size is 24");
    bad = *t, bad.kernel.id = 9;
    TOLD(list, mps_op_number_density(&bad, out), "stencil.kernel.id is 9");
    TOLD(list, mps_neighbours_build(list, 4, NULL, 2.1, 2.1), "x is NULL");
    TOLD(list, mps_neighbours_build(list, 4, (const double[]){0, 0, 1, NAN, 0, 0, 0, 0}, 2.1, 2.1),
         "x of particle 1, axis 1 is nan");
    TOLD(list, mps_neighbours_build(list, 4, in, 2.1, 1),
         "re_far is 1 m: must be finite and at least re_near = 2.1 m");
    TOLD(list, mps_neighbours_stencil_get(list, MPS_NEAR, &t->kernel, &bad), "the list is empty");
    assert_int_equal(
        mps_neighbours_build(list, 4, (const double[]){0, 0, 1, 0, 0, 1, 1, 1}, 2.1, 2.1), MPS_OK);
    TOLD(list, mps_neighbours_stencil_get(list, 7, &t->kernel, &bad), "which is 7");
}

static void bad_arguments(void **state)
{
    (void)state;
    double in[64] = {0}, out[64], x[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil t = {.struct_size = sizeof t}, bad = {.struct_size = sizeof bad};
    mps_neighbours *list = NULL;
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_create(2, 1, NULL, &list), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t),
                     MPS_E_ARG); /* nothing built yet */
    assert_int_equal(mps_neighbours_build(list, 4, x, 2.1, 2.1), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, 2, &kernel, &t), MPS_E_ARG);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, NULL, &t), MPS_E_ARG);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, NULL), MPS_E_ARG);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t), MPS_OK);
    assert_non_null(strstr(mps_neighbours_error(NULL), "NULL"));
    refuse_told(list, &t, in, out);
    assert_int_equal(mps_neighbours_build(list, 4, x, 2.1, 2.1), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t), MPS_OK);
    refuse_all(NULL, in, out);
    refuse_all(&t, NULL, NULL);
    refuse_all(&t, in, NULL);
    bad = t, bad.struct_size = 0, refuse_all(&bad, in, out);
    bad = t, bad.dim = 4, refuse_all(&bad, in, out);
    bad = t, bad.n = 0, refuse_all(&bad, in, out);
    bad = t, bad.x = NULL, refuse_all(&bad, in, out);
    assert_int_equal(mps_op_gradient(&t, NULL, out), MPS_E_ARG);
    assert_int_equal(mps_op_gradient_corrected(&t, NULL, in, out), MPS_E_ARG);
    assert_int_equal(mps_op_divergence_corrected(&t, in, NULL, out), MPS_E_ARG);
    const double floors[] = {0, -1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) assert_int_equal(mps_op_correction(&t, floors[k], out), MPS_E_ARG);
    for (int k = 0; k < 4; k++) {
        double m[4] = {2, 1, 1, 2};
        assert_int_equal(mps_matrix_inverse_bounded(2, m, 0.2, out), MPS_OK);
        m[k] = k < 2 ? NAN : INFINITY;
        assert_int_equal(mps_matrix_inverse_bounded(2, m, 0.2, out), MPS_E_ARG);
    }
    mps_neighbours_destroy(list);
}

/* Particles without neighbours have sums of nothing, and B = 1. */
static void lone_particles(void **state)
{
    (void)state;
    const double x[4] = {0, 0, 1, 0}, f[2] = {1, 2};
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil t = {.struct_size = sizeof t};
    mps_neighbours *list = NULL;
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_create(2, CLOUD_DP, NULL, &list), MPS_OK);
    for (int64_t n = 1; n <= 2; n++) {
        double out[8] = {7, 7, 7, 7, 7, 7, 7, 7};
        assert_int_equal(mps_neighbours_build(list, n, x, 0.04, 0.05), MPS_OK);
        assert_int_equal(mps_neighbours_stencil_get(list, MPS_FAR, &kernel, &t), MPS_OK);
        assert_int_equal(mps_op_number_density(&t, out), MPS_OK);
        assert_true(out[0] == 0);
        assert_int_equal(mps_op_gradient(&t, f, out), MPS_OK);
        assert_true(out[0] == 0 && out[1] == 0);
        assert_int_equal(mps_op_correction(&t, 0.2, out), MPS_OK);
        assert_true(out[0] == 1 && out[1] == 0 && out[2] == 0 && out[3] == 1);
    }
    mps_neighbours_destroy(list);
}

/* An area-preserving stretch by 10 %, as in every steep crest: n takes it for more than 1 % of
 * compression, the volume measure must not see a tenth of that. */
static void stretched_lattice(void **state)
{
    (void)state;
    cloud c = cloud_lattice(2, 21, 21, 1, 0, 1);
    const int64_t middle = 10 * 21 + 10;
    double *n = cloud_doubles(c.n), *delta = cloud_doubles(c.n), n0;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil t = {.struct_size = sizeof t};
    mps_neighbours *list = NULL;
    for (int64_t i = 0; i < c.n; i++) {
        c.x[2 * i] *= 1.1;
        c.x[2 * i + 1] /= 1.1;
    }
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_create(2, CLOUD_DP, NULL, &list), MPS_OK);
    assert_int_equal(mps_neighbours_build(list, c.n, c.x, 2.1 * CLOUD_DP, 3.1 * CLOUD_DP), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t), MPS_OK);
    n0 = t.n0;
    assert_int_equal(mps_op_number_density(&t, n), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_FAR, &kernel, &t), MPS_OK);
    assert_int_equal(mps_op_volume_deviation(&t, delta), MPS_OK);
    assert_true(n[middle] / n0 - 1 > 0.01);
    assert_true(fabs(delta[middle]) < 0.001);
    mps_neighbours_destroy(list);
    free(n);
    free(delta);
    cloud_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels),           cmocka_unit_test(bad_arguments),
        cmocka_unit_test(lone_particles),    cmocka_unit_test(kernel_rows),
        cmocka_unit_test(stretched_lattice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
