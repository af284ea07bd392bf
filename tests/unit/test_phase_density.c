/* SPDX-License-Identifier: BSD-3-Clause */
/* density.smooth, gradient.density and gas.compressible against their equations. */
#include "phase_fixture.h"

static const double rho[3] = {1000, 1.2, 800};

/* A jittered block of layers of three phases. */
typedef struct block {
    cloud c;
    int32_t *phase;
    mps_sim *sim;
    mps_kernel kernel;
    double n0, re;
} block;

static block block_make(int dim, double jitter)
{
    block b = {.c = dim == 2 ? cloud_lattice(2, 18, 21, 1, jitter, 6) : cloud_lattice(3, 8, 12, 8, jitter, 6), .re = 2.1 * CLOUD_DP};
    b.phase = cloud_phases(b.c.n);
    for (int64_t i = 0; i < b.c.n; i++) b.phase[i] = (int32_t)fmin(2, b.c.x[i * dim + 1] / ((dim == 2 ? 7 : 4) * CLOUD_DP));
    b.sim = bare_sim(dim, CLOUD_DP, 3.1, 1e-6);
    for (int p = 0; p < 3; p++) set_phase(b.sim, p, rho[p], 0);
    add_cloud(b.sim, &b.c, b.phase, NULL);
    assert_int_equal(mps_kernel_find("improved", &b.kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&b.kernel, dim, CLOUD_DP, b.re, &b.n0, NULL), MPS_OK);
    return b;
}

static void block_free(block *b)
{
    mps_sim_destroy(b->sim);
    cloud_free(&b->c);
    free(b->phase);
}

/* W22 (13) by a sum over all particles. */
static double smoothed(const block *b, int64_t i, double self)
{
    double sum = self * rho[b->phase[i]], weight = self;
    for (int64_t j = 0; j < b->c.n; j++) {
        if (j == i) continue;
        const double w = mps_kernel_value(&b->kernel, sqrt(cloud_distance2(&b->c, i, j)), b->re);
        sum += w * rho[b->phase[j]];
        weight += w;
    }
    return sum / weight;
}

static void smoothing(void **state)
{
    (void)state;
    static const double self[] = {1, 100, 0};
    for (int dim = 2; dim <= 3; dim++) {
        block b = block_make(dim, 0.2);
        ASSERT_OK(b.sim, mps_step(b.sim, 1, NULL)); /* without the model: the densities themselves */
        for (int64_t i = 0; i < b.c.n; i++) assert_true(spy.density[i] == rho[b.phase[i]]);
        ASSERT_OK(b.sim, mps_model_use(b.sim, "density.smooth"));
        for (int k = 0; k < 3; k++) {
            int64_t same = 0;
            ASSERT_OK(b.sim, mps_model_set(b.sim, "density", "self", self[k]));
            ASSERT_OK(b.sim, mps_step(b.sim, 1, NULL));
            for (int64_t i = 0; i < b.c.n; i++) {
                const double own = rho[b.phase[i]], wanted = smoothed(&b, i, self[k] * mps_kernel_value(&b.kernel, 0, b.re));
                ASSERT_NEAR(spy.density[i] / wanted, 1, 1e-10);
                same += spy.density[i] == own;
            }
            assert_true(same > b.c.n / 5 && same < b.c.n * 4 / 5); /* only near interfaces */
        }
        double *density = field_by_id(b.sim, "density");
        for (int64_t i = 0; i < b.c.n; i++) assert_true(density[i] == rho[b.phase[i]]); /* nobody's mass changes */
        free(density);
        block_free(&b);
    }
}

/* ---- gradient.density --------------------------------------------------------------------------------------------------- */

static double wavy(const double *x, int dim)
{
    double p = 1000;
    for (int d = 0; d < dim; d++) p += 300 * sin((40 + 10 * d) * x[d] + d);
    return p;
}

static double linear(const double *x, int dim)
{
    return 50 - 2000 * x[0] + 700 * x[1] + (dim == 3 ? 300 * x[2] : 0);
}

/* W22 (18) by sums over all particles. */
static void literal(const block *b, const double *density, int64_t i, double a[3])
{
    const int dim = b->c.dim;
    const double *x = b->c.x, pi = wavy(x + i * dim, dim);
    double least = pi;
    for (int pass = 0; pass < 2; pass++)
        for (int64_t j = 0; j < b->c.n; j++) {
            const double r2 = cloud_distance2(&b->c, i, j), pj = wavy(x + j * dim, dim);
            if (j == i || r2 >= b->re * b->re) continue;
            if (pass == 0) {
                if (b->phase[j] == b->phase[i]) least = fmin(least, pj);
                continue;
            }
            const double w = dim / b->n0 * mps_kernel_value(&b->kernel, sqrt(r2), b->re) / r2;
            const double share = 2 * (pj - pi) / (density[i] + density[j]) + (pi - least) / density[i];
            for (int d = 0; d < dim; d++) a[d] -= w * share * (x[j * dim + d] - x[i * dim + d]);
        }
}

static void gradient_to_the_letter(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int smooth = 0; smooth < 2; smooth++) {
            block b = block_make(dim, 0.2);
            ASSERT_OK(b.sim, mps_model_use(b.sim, "gradient.density"));
            if (smooth) ASSERT_OK(b.sim, mps_model_use(b.sim, "density.smooth"));
            spy.pressure = wavy;
            ASSERT_OK(b.sim, mps_step(b.sim, 1, NULL));
            for (int64_t i = 0; i < b.c.n; i++) {
                double a[3] = {0}, size = 0;
                literal(&b, spy.density, i, a);
                for (int d = 0; d < dim; d++) size = fmax(size, fabs(a[d]));
                for (int d = 0; d < dim; d++) ASSERT_NEAR(spy.dp_a[i * dim + d], a[d], 1e-10 * size);
            }
            block_free(&b);
        }
}

/* Amid a lattice, between walls and dummies too, a linear pressure gives its slope over rho: the second sum vanishes. */
static void gradient_of_linear(void **state)
{
    (void)state;
    static const double slope[3] = {-2000, 700, 300};
    for (int dim = 2; dim <= 3; dim++) {
        const double dp = 0.05, lo[3] = {0}, hi[3] = {0.4, 0.4, 0.4};
        mps_sim *sim = bare_sim(dim, dp, 3.1, 1e-6);
        set_phase(sim, 1, 1.2, 0);
        add_tank(sim, 0.4, 0.4, 0.4);
        ASSERT_OK(sim, mps_geometry_fill_box(sim, 1, lo, hi, NULL));
        ASSERT_OK(sim, mps_model_use(sim, "gradient.density"));
        double *x = field_by_id(sim, "position");
        const int64_t *ids;
        const int32_t *kinds;
        const int64_t n = mps_particles_count(sim, -1);
        spy.pressure = linear;
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, mps_particles_tags(sim, &ids, &kinds, NULL, NULL));
        int64_t checked = 0;
        for (int64_t k = 0; k < n; k++) {
            const int64_t i = ids[k];
            if (kinds[k] != MPS_FLUID || x[i * dim + 1] > 0.3) continue;
            for (int d = 0; d < dim; d++) ASSERT_NEAR(spy.dp_a[i * dim + d] * -1.2, slope[d], 1e-8);
            checked++;
        }
        assert_true(checked > 20);
        free(x);
        mps_sim_destroy(sim);
    }
}

/* ---- gas.compressible --------------------------------------------------------------------------------------------------- */

static const double cs = 340, dt = 1e-4, swollen = 1e-3;

/* Water and, apart from it, gas; the source wants gas and water denser by `swollen`, weighted gamma. */
static mps_sim *gas(double gamma, double printed)
{
    cloud c = cloud_lattice(2, 12, 12, 1, 0, 1);
    int32_t phase[144];
    for (int i = 0; i < 144; i++) {
        phase[i] = i / 12 >= 6;
        if (phase[i]) c.x[2 * i + 1] += 1;
    }
    mps_sim *sim = bare_sim(2, CLOUD_DP, 2.1, dt);
    set_phase(sim, 1, rho[1], 0);
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_use(sim, "gas.compressible"));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "sound", cs));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "gamma", gamma));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "printed", printed));
    spy.given_rhs = gamma * swollen / (dt * dt);
    cloud_free(&c);
    return sim;
}

/* Only the gas has terms, and they are those of W22 (26) over rho. */
static void gas_terms(void **state)
{
    (void)state;
    const double stiff = 1 / (rho[1] * cs * cs * dt * dt);
    for (int printed = 0; printed < 2; printed++) {
        mps_sim *sim = gas(0.1, printed);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double *before = field_by_id(sim, "pressure");
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        assert_true(before[100] > 1);
        for (int64_t i = 0; i < 144; i++) {
            ASSERT_NEAR(spy.shift[i], i < 72 ? 0 : stiff, 1e-12 * stiff);
            const double kept = i < 72 || printed ? 0 : 0.9 * stiff * before[i];
            ASSERT_NEAR(spy.rhs[i], spy.given_rhs + kept, 1e-12 * spy.given_rhs);
        }
        free(before);
        mps_sim_destroy(sim);
    }
}

/* At rest the pressure is that of the equation of state; as printed it is gamma times that. */
static void equation_of_state(void **state)
{
    (void)state;
    for (int printed = 0; printed < 2; printed++) {
        mps_sim *sim = gas(0.1, printed);
        for (int k = 0; k < 150; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        for (int64_t i = 72; i < 144; i++) ASSERT_NEAR(spy.p[i] / (rho[1] * cs * cs * swollen), printed ? 0.1 : 1.0, 1e-4);
        mps_sim_destroy(sim);
    }
}

/* A relaxation time instead of gamma. */
static void relaxation(void **state)
{
    (void)state;
    mps_sim *sim = gas(0.1, 0);
    const double velocity_scale = sqrt(9.81 * CLOUD_DP), gamma = dt * velocity_scale / (5 * CLOUD_DP);
    ASSERT_OK(sim, mps_model_set(sim, "gas", "tau", 5));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    double *before = field_by_id(sim, "pressure");
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_NEAR((spy.rhs[100] - spy.given_rhs) / (spy.shift[100] * before[100]), 1 - gamma, 1e-10);
    free(before);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(smoothing),          cmocka_unit_test(gradient_to_the_letter),
                                       cmocka_unit_test(gradient_of_linear), cmocka_unit_test(gas_terms),
                                       cmocka_unit_test(equation_of_state),  cmocka_unit_test(relaxation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
