/* SPDX-License-Identifier: BSD-3-Clause */
/* gradient.corrected with its second pass, by sums over all particles. */
#include "phase_fixture.h"

static const double rho = 800;

/* All particles are on the surface, and no moment matrix corrects them. */
static int lay_region(mps_stage *s)
{
    int32_t *region = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++) region[i] = MPS_REGION_SURFACE;
    return 0;
}

static int lay_identity(mps_stage *s)
{
    double *b = s->data[0];
    const int dim = s->view->dim;
    for (int64_t i = 0; i < s->view->n; i++)
        for (int k = 0; k < dim * dim; k++) b[i * dim * dim + k] = k % (dim + 1) == 0;
    return 0;
}

static const mps_use region_uses[] = {{"region", MPS_USE_CHANGE}},
                     correction_uses[] = {{"correction", MPS_USE_CHANGE}};
static const mps_verb laying[] = {
    {.hook = MPS_CLASSIFY, .use_count = 1, .uses = region_uses, .after = "*", .run = lay_region},
    {.hook = MPS_PREPARE,
     .use_count = 1,
     .uses = correction_uses,
     .after = "*",
     .run = lay_identity}};
static const mps_model_ops layer = {.struct_size = sizeof(mps_model_ops),
                                    .api = MPS_MODEL_API,
                                    .name = "layer.surface",
                                    .help = "all is surface",
                                    .verb_count = 2,
                                    .verbs = laying};

static double wavy(const double *x, int dim)
{
    double p = 1000;
    for (int d = 0; d < dim; d++) p += 300 * sin((40 + 10 * d) * x[d] + d);
    return p;
}

/* D/n0 sum w d r of particle i, with d = (P_j - P_i)/rho, or 2 d - G_j.r with the G of all
 * particles. */
static void gradient(const cloud *c, int64_t i, const double *first, double *g)
{
    const int dim = c->dim;
    const double re = 2.1 * CLOUD_DP, *x = c->x + i * dim;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    double n0;
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&kernel, dim, CLOUD_DP, re, &n0, NULL), MPS_OK);
    for (int d = 0; d < dim; d++) g[d] = 0;
    for (int64_t j = 0; j < c->n; j++) {
        const double r2 = cloud_distance2(c, i, j), *y = c->x + j * dim;
        if (j == i || r2 >= re * re) continue;
        double difference = (wavy(y, dim) - wavy(x, dim)) / rho, slope = 0;
        for (int d = 0; first && d < dim; d++) slope += first[j * dim + d] * (y[d] - x[d]);
        if (first) difference = 2 * difference - slope;
        const double w = dim / n0 * mps_kernel_value(&kernel, sqrt(r2), re) / r2;
        for (int d = 0; d < dim; d++) g[d] += w * difference * (y[d] - x[d]);
    }
}

static void check(int dim, int second)
{
    cloud c = dim == 2 ? cloud_lattice(2, 14, 14, 1, 0.2, 6) : cloud_lattice(3, 7, 7, 7, 0.2, 6);
    double *first = cloud_doubles(c.n * dim);
    int32_t *phase = calloc((size_t)c.n, sizeof *phase);
    assert_non_null(phase);
    mps_sim *sim = bare_sim(dim, CLOUD_DP, 3.1, 1e-6);
    set_phase(sim, 0, rho, 0);
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_register(sim, &layer));
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "layer.surface"));
    ASSERT_OK(sim, mps_model_use(sim, "gradient.corrected"));
    ASSERT_OK(sim, mps_model_set(sim, "gradient", "second_order", second));
    spy.pressure = wavy;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    for (int64_t i = 0; i < c.n; i++) gradient(&c, i, NULL, first + i * dim);
    for (int64_t i = 0; i < c.n; i++) {
        double wanted[3], size = 0;
        gradient(&c, i, second ? first : NULL, wanted);
        for (int d = 0; d < dim; d++) size = fmax(size, fabs(wanted[d]));
        for (int d = 0; d < dim; d++) ASSERT_NEAR(spy.dp_a[i * dim + d], -wanted[d], 1e-10 * size);
    }
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    free(first);
}

static void by_all_particles(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int second = 0; second < 2; second++) check(dim, second);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_all_particles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
