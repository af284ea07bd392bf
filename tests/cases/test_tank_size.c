/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs in tanks that are not whole in dp: at rest, with a plate, and a standing wave. The cells are
 * stretched by .3 to 8 %. */
#include "../unit/tank_fixture.h"
#include <stdbool.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846, G = 9.81;

typedef struct rest {
    int32_t dim;
    double dp, size[3];
    int rows;
    bool plate;
    double pressure, kinetic; /* bounds: off rho g depth, of the potential energy */
} rest;

/* Means over the last second, at the floor. */
typedef struct means {
    int32_t probe[2];
    double sum[2], time, kinetic;
} means;

static int measure(void *user, mps_sim *sim, const mps_step_info *info)
{
    means *m = user;
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    m->kinetic = fmax(m->kinetic, e.kinetic);
    if (info->t < 1) return 0;
    m->time += info->dt;
    for (int k = 0; k < 2; k++) {
        double value;
        ASSERT_OK(sim, mps_probe_read(sim, m->probe[k], &value));
        m->sum[k] += info->dt * value;
    }
    return 0;
}

static void add_pressure(mps_sim *sim, const rest *c, double x, int32_t *id)
{
    mps_probe p;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = MPS_PROBE_WALL_PRESSURE;
    p.at[0] = x * c->size[0];
    p.at[2] = 0.5 * c->size[2];
    ASSERT_OK(sim, mps_probe_add(sim, &p, id));
}

static void at_rest(void **state)
{
    static const rest list[] = {
        {2, 0.02, {0.597, 0.4, 0}, 10, false, 1e-4, 2e-7},
        {2, 0.02, {0.61, 0.4, 0}, 10, false, 1e-4, 2e-7},
        {2, 0.02, {0.61, 0.4, 0}, 10, true, 1e-4, 2e-7},
        {2, 0.05, {1.03, 0.62, 0}, 6, true, 1e-3, 1e-6},
        {3, 0.025, {0.303, 0.297, 0.2}, 6, false, 3e-3, 2e-6},
        {3, 0.025, {0.303, 0.297, 0.2}, 6, true, 3e-3, 2e-6},
        {3, 0.025, {0.3, 0.3, 0.112}, 6, false, 3e-3, 2e-6}, /* 4 cells, stretched by 8 % */
    };
    (void)state;
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        const rest *c = &list[k];
        means m = {.time = 0};
        double h[3];
        int64_t added;
        mps_sim *sim = new_sim(c->dim, c->dp);
        add_tank(sim, c->size[0], c->size[1], c->size[2]);
        ASSERT_OK(sim, mps_lattice_get(sim, NULL, h));
        const double depth = c->rows * h[1], x = round(0.5 * c->size[0] / h[0]) * h[0],
                     lo[3] = {x, 0, 0}, hi[3] = {x, depth - 2 * h[1], c->size[2]};
        if (c->plate) ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
        added = fill_depth(sim, c->size[0], depth, c->size[2]);
        add_pressure(sim, c, 0.2, &m.probe[0]);
        add_pressure(sim, c, 0.7, &m.probe[1]);
        ASSERT_OK(sim, mps_run(sim, 2, measure, &m));
        const double level = 1000 * G * depth,
                     potential = 0.5 * level * depth * c->size[0] * (c->dim == 3 ? c->size[2] : 1);
        print_message("%zu: %lld particles, pressure %+.1e %+.1e, kinetic %.1e\n", k,
                      (long long)added, m.sum[0] / m.time / level - 1,
                      m.sum[1] / m.time / level - 1, m.kinetic / potential);
        for (int p = 0; p < 2; p++) ASSERT_NEAR(m.sum[p] / m.time / level, 1, c->pressure);
        assert_true(m.kinetic > 0 && m.kinetic < c->kinetic * potential);
        mps_sim_destroy(sim);
    }
}

/* ---- a standing wave ---- */

/* As in the case standing_wave: lattice points moved as linear theory does, amplitude a. */
static double add_wave(mps_sim *sim, const double *size, double depth, double a)
{
    double h[2];
    mps_particle_block block;
    ASSERT_OK(sim, mps_lattice_get(sim, NULL, h));
    const int columns = (int)lround(size[0] / h[0]) - 1, rows = (int)lround(depth / h[1]);
    const double top = rows * h[1], k = PI / size[0];
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = (int64_t)columns * rows;
    double *place = malloc((size_t)block.count * 2 * sizeof *place), *p = place;
    assert_non_null(place);
    for (int i = 1; i <= columns; i++)
        for (int j = 1; j <= rows; j++, p += 2) {
            const double x = i * h[0], y = j * h[1], b = a / sinh(k * top);
            p[0] = x - b * cosh(k * y) * sin(k * x);
            p[1] = y + b * sinh(k * y) * cos(k * x);
            p[1] *= (top + a * cos(k * (x - b * cosh(k * top) * sin(k * x)))) /
                    (top + a * cos(k * x));
        }
    block.position = place;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    free(place);
    return top;
}

/* Mean of the first three periods after the first half, over that of linear theory. */
static double period(double dp, const double *size, double depth)
{
    double zero[8], t, before = 0, last = 0;
    int zeros = 0;
    mps_energy e;
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, size[0], size[1], 0);
    const double top = add_wave(sim, size, depth, 0.02), k = PI / size[0];
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    while (zeros < 8) {
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, mps_energy_get(sim, &e));
        ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
        assert_true(t < 10);
        const double now = e.centre[0] - 0.5 * size[0];
        if (last * now < 0) zero[zeros++] = before + (t - before) * last / (last - now);
        last = now;
        before = t;
    }
    mps_sim_destroy(sim);
    return (zero[7] - zero[1]) / 3 / (2 * PI / sqrt(G * k * tanh(k * top)));
}

/* Waves of 20 mm in half a metre have periods .1 to .4 % longer than linear ones, and a stretched
 * lattice changes them by less than .1 %. */
static void standing_wave(void **state)
{
    static const double size[3][2] = {{1, 0.7}, {1.009, 0.7}, {1.009, 0.69}};
    double of[3];
    (void)state;
    for (int k = 0; k < 3; k++) {
        of[k] = period(0.02, size[k], 0.5);
        print_message("%g x %g m: %.5f\n", size[k][0], size[k][1], of[k]);
        ASSERT_NEAR(of[k], 1.0027, 0.0015);
        ASSERT_NEAR(of[k], of[0], 0.001);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_rest),
        cmocka_unit_test(standing_wave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
