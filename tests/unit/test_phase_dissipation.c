/* SPDX-License-Identifier: BSD-3-Clause */
/* dissipation.radial: its limit in violent impacts, and what it conserves. */
#include "phase_fixture.h"

static const double DT = 1e-3, rho[2] = {1000, 1};

static double mu[2]; /* of the phases [Pa s] */

static mps_sim *damped(const cloud *c, const int32_t *phase, const double *u)
{
    mps_sim *sim = bare_sim(c->dim, CLOUD_DP, 3.1, DT);
    for (int p = 0; p < 2; p++) set_phase(sim, p, rho[p], mu[p]);
    add_cloud(sim, c, phase, u);
    ASSERT_OK(sim, mps_model_use(sim, "dissipation.radial"));
    return sim;
}

/* Speed at which two particles `distance` dp apart approach after a step, over that before it. */
static double left_over(int dim, double distance, double speed, const int32_t phase[2])
{
    cloud c = cloud_empty(dim, 2);
    double *u = cloud_doubles(2 * dim);
    c.x[dim] = distance * CLOUD_DP;
    u[0] = 0.75 * speed;
    u[dim] = -0.25 * speed;
    mps_sim *sim = damped(&c, phase, u);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    double *now = field_by_id(sim, "velocity");
    for (int k = 0; k < 2 * dim; k++)
        assert_true(k % dim == 0 || now[k] == 0); /* along their line */
    const double left = (now[0] - now[dim]) / speed;
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(u);
    free(now);
    return left;
}

/* 1 - dt 2 dp 2(D+2)/n0 nu W/r^2, with nu = alpha U_g - D mean(mu/rho)/dp, not below 0, + beta u_n,
 * at most 0.15 dp/dt, nearer than dp less by (r/dp)^3. */
static double wanted(int dim, double distance, double speed, const int32_t phase[2])
{
    const double r = distance * CLOUD_DP, re = 2.1 * CLOUD_DP;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    double n0;
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&kernel, dim, CLOUD_DP, re, &n0, NULL), MPS_OK);
    const double own = 0.5 * (mu[phase[0]] / rho[phase[0]] + mu[phase[1]] / rho[phase[1]]);
    const double calm = fmax(0, 0.1 * sqrt(9.81 * CLOUD_DP) - dim * own / CLOUD_DP);
    const double nu = fmin(calm + speed,
                           0.15 * CLOUD_DP / DT * fmin(1, distance * distance * distance));
    return 1 -
           DT * 2 * CLOUD_DP * 2 * (dim + 2) / n0 * nu * mps_kernel_value(&kernel, r, re) / (r * r);
}

/* However fast they are, two particles go on approaching, of one density or of two. */
static void approaching(void **state)
{
    (void)state;
    static const int32_t phases[3][2] = {{0, 0}, {0, 1}, {1, 0}};
    for (int dim = 2; dim <= 3; dim++)
        for (int p = 0; p < 3; p++)
            for (double distance = 0.4; distance < 2; distance += 0.2) {
                double before = 1;
                for (double speed = 0.1; speed < 300;
                     speed *= 3) { /* 300 m/s are 19 dp in a step */
                    const double left = left_over(dim, distance, speed, phases[p]);
                    ASSERT_NEAR(left, wanted(dim, distance, speed, phases[p]), 1e-12);
                    assert_true(left > 0 && left < 1 && left <= before + 1e-12);
                    before = left;
                }
            }
}

/* The viscosity of the liquid replaces alpha: one third of it, all of it. */
static void yields_to_viscosity(void **state)
{
    (void)state;
    static const int32_t phases[3][2] = {{0, 0}, {0, 1}, {1, 1}};
    const double calm = 0.1 * sqrt(9.81 * CLOUD_DP);
    for (int dim = 2; dim <= 3; dim++)
        for (int p = 0; p < 3; p++) {
            mu[0] = rho[0] * calm * CLOUD_DP / dim / 3;
            mu[1] = rho[1] * calm * CLOUD_DP / dim * 1.5;
            const double left = left_over(dim, 1, 0.01, phases[p]);
            ASSERT_NEAR(left, wanted(dim, 1, 0.01, phases[p]), 1e-12);
            mu[0] = mu[1] = 0;
            assert_true(left > left_over(dim, 1, 0.01, phases[p])); /* less is damped */
        }
}

/* Two blocks run into each other, faster than the limit, with noise: momentum stays and the energy
 * does not grow. */
static void momentum(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        cloud c = dim == 2 ? cloud_lattice(2, 14, 14, 1, 0.2, 8)
                           : cloud_lattice(3, 8, 8, 8, 0.2, 8);
        int32_t *phase = cloud_phases(c.n);
        double *u = cloud_field(c.n * dim, 9), sum[3] = {0}, size = 0, energy[2] = {0};
        for (int64_t i = 0; i < c.n; i++) {
            phase[i] = i % 3 == 0;
            u[i * dim] += c.x[i * dim] < (dim == 2 ? 7 : 4) * CLOUD_DP ? 20 : -20;
        }
        mps_sim *sim = damped(&c, phase, u);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double *now = field_by_id(sim, "velocity");
        for (int64_t k = 0; k < c.n * dim; k++) {
            const double mass = rho[phase[k / dim]];
            sum[k % dim] += mass * spy.a[k];
            size += mass * fabs(spy.a[k]);
            energy[0] += mass * u[k] * u[k];
            energy[1] += mass * now[k] * now[k];
        }
        assert_true(size > 0);
        for (int d = 0; d < dim; d++) ASSERT_NEAR(sum[d] / size, 0, 1e-13);
        assert_true(energy[1] < energy[0]);
        mps_sim_destroy(sim);
        cloud_free(&c);
        free(phase);
        free(u);
        free(now);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(approaching),
                                       cmocka_unit_test(yields_to_viscosity),
                                       cmocka_unit_test(momentum)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
