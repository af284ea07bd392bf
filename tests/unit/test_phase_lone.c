/* SPDX-License-Identifier: BSD-3-Clause */
/* drag.lone: gas particles with little gas about them. */
#include "phase_fixture.h"
#include <stdbool.h>

static const double rho[2] = {1000, 1}, TIMES = 3, dt = 1e-5;

static bool inner(const cloud *c, int64_t i, double reach)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    bool in = true;
    for (int64_t j = 0; j < c->n * c->dim; j++) {
        lo[j % c->dim] = fmin(lo[j % c->dim], c->x[j]);
        hi[j % c->dim] = fmax(hi[j % c->dim], c->x[j]);
    }
    for (int d = 0; d < c->dim; d++)
        in = in && c->x[i * c->dim + d] > lo[d] + reach && c->x[i * c->dim + d] < hi[d] - reach;
    return in;
}

/* Velocities after one step with drag.lone alone, by id; the energy that it took. */
static double *after(const cloud *c, const int32_t *phase, const double *u, double *taken)
{
    mps_sim *sim = bare_sim(c->dim, CLOUD_DP, 2.1, dt);
    mps_energy e;
    set_phase(sim, 0, rho[0], 0);
    set_phase(sim, 1, rho[1], 0);
    add_cloud(sim, c, phase, u);
    ASSERT_OK(sim, mps_model_use(sim, "drag.lone"));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_OK(sim, mps_energy_init(&e, sizeof e));
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    if (taken) *taken = e.collision;
    double *v = field_by_id(sim, "velocity");
    mps_sim_destroy(sim);
    return v;
}

/* Water at (1, 0, 0) m/s with every 40th particle gas at 50 m/s across it. */
static void single_particles(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        cloud c = dim == 2 ? cloud_lattice(2, 24, 20, 1, 0.1, 3)
                           : cloud_lattice(3, 10, 9, 8, 0.1, 3);
        int32_t *phase = cloud_phases(c.n);
        double *u = cloud_doubles(c.n * dim), before = 0, left = 0, taken;
        for (int64_t i = 0; i < c.n; i++) {
            phase[i] = i % 41 == 20;
            u[i * dim] = 1;
            u[i * dim + 1] = phase[i] ? 50 : 0;
        }
        double *v = after(&c, phase, u, &taken);
        const double most = TIMES * sqrt(9.81 * CLOUD_DP),
                     cell = dim == 2 ? CLOUD_DP * CLOUD_DP : CLOUD_DP * CLOUD_DP * CLOUD_DP;
        int64_t slowed = 0;
        for (int64_t i = 0; i < c.n; i++)
            if (phase[i]) {
                assert_true(fabs(v[i * dim + 1]) < 1.2 * most + 0.5 && fabs(v[i * dim] - 1) < 0.1);
                slowed++;
            }
        assert_true(slowed > 3);
        for (int d = 0; d < dim; d++) {
            double sum = 0, size = 0;
            for (int64_t i = 0; i < c.n; i++) {
                const double a = u[i * dim + d], b = v[i * dim + d];
                sum += rho[phase[i]] * (b - a);
                size += rho[phase[i]] * fabs(a);
                before += 0.5 * rho[phase[i]] * cell * a * a;
                left += 0.5 * rho[phase[i]] * cell * b * b;
            }
            assert_true(fabs(sum) <= 1e-12 * size);
        }
        assert_true(taken > 0 && fabs(before - left - taken) < 1e-9 * before);
        cloud_free(&c);
        free(phase);
        free(u);
        free(v);
    }
}

/* Gas in rows, slow gas and drops keep their velocity to the last bit. */
static void resolved_gas(void **state)
{
    (void)state;
    cloud c = cloud_lattice(2, 24, 20, 1, 0, 3);
    int32_t *phase = cloud_phases(c.n);
    double *u = cloud_doubles(c.n * 2);
    for (int kind = 0; kind < 3; kind++) {
        for (int64_t i = 0; i < c.n; i++) {
            const double y = c.x[2 * i + 1] / CLOUD_DP, single = i % 41 == 20;
            phase[i] = kind == 0 ? fmod(y + 100.25, 5) < 1 : kind == 1 ? single : !single;
            u[2 * i] = (kind == 1 ? 2.5 * sqrt(9.81 * CLOUD_DP) : 50) *
                       (kind == 2 ? !phase[i] : phase[i]);
        }
        double *v = after(&c, phase, u, NULL);
        for (int64_t i = 0; i < c.n; i++)
            if (kind || inner(&c, i, 2.2 * CLOUD_DP))
                assert_true(v[2 * i] == u[2 * i] && v[2 * i + 1] == u[2 * i + 1]);
        free(v);
    }
    cloud_free(&c);
    free(phase);
    free(u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(single_particles),
                                       cmocka_unit_test(resolved_gas)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
