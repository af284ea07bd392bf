/* SPDX-License-Identifier: BSD-3-Clause */
/* Liquid in round tanks: at rest, in rolling motion, next to inclined walls. */
#include "solid_fixture.h"

/* ---- liquid in round tanks ---- */

static int lower_half(void *user, const double *x)
{
    (void)user;
    return x[1] < 1e-6;
}

static mps_sim *half_full(int dim, double dp)
{
    mps_sim *sim = new_sim(dim, dp);
    mps_solid solid = solid_of(ball, NULL, dim == 3 ? &three : &two, 1);
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    ASSERT_OK(sim, mps_fill_add(sim, 0, lower_half, NULL, NULL));
    return sim;
}

static double kinetic(mps_sim *sim)
{
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    return e.kinetic;
}

static int64_t through_the_wall(const mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    int dim = s->dim;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++)
        count += s->kind[i] == MPS_FLUID && ball(&dim, &s->x[i * dim]) < 0.2 * sim->world.setup.dp;
    return count;
}

/* Pressure at the bottom is rho g h, the force is the weight of the liquid between wall and
 * level. */
static void rest(int dim, double dp, double t_end, double volume)
{
    mps_sim *sim = half_full(dim, dp);
    mps_probe probe;
    int32_t bottom, force;
    double pressure, values[6];
    mps_probe_init(&probe, sizeof probe);
    probe.at[1] = -1;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &bottom));
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_FORCE;
    probe.part = "solid";
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &force));
    assert_true(mps_run(sim, t_end, NULL, NULL) >= 0);
    ASSERT_OK(sim, mps_probe_read(sim, bottom, &pressure));
    ASSERT_OK(sim, mps_probe_read(sim, force, values));
    ASSERT_NEAR(pressure / 9810, 1, 0.02);
    ASSERT_NEAR(-values[1] / (9810 * volume), 1,
                0.03); /* 1.022 at first; the level rises by another 0.005 R in the next 1.5 s */
    ASSERT_NEAR(values[0] / (9810 * volume), 0, 0.01);
    /* of a column that falls by dp: 1/1000 of its energy */
    assert_true(kinetic(sim) < 1e-3 * 9810 * volume * dp);
    assert_int_equal(through_the_wall(sim), 0);
    mps_sim_destroy(sim);
}

/* Floor and side walls at 45 degrees; liquid above the floor and between the walls, which are 0.4 m
 * apart at the floor. */
static double trapezoid(void *user, const double *x)
{
    (void)user;
    return fmin(fmin(x[1], 0.4 - x[1]), sqrt(0.5) * (0.2 - fabs(x[0]) + x[1]));
}

/* Rows of the lattice are 0.7 dp apart along such walls: the initial excess density there must not
 * cause an impact. */
static void start_beside_sloping_walls(void **state)
{
    static const double spacing[] = {0.02, 0.01}, place[3][2] = {{0, 0}, {0.25, 0.05}, {-0.3, 0.1}};
    (void)state;
    for (int s = 0; s < 2; s++) {
        const double lo[2] = {-1, 0}, hi[2] = {1, 0.2};
        mps_sim *sim = new_sim(2, spacing[s]);
        mps_solid solid = solid_of(trapezoid, NULL, NULL, 1);
        int32_t id[3];
        solid.lo[1] = 0;
        solid.hi[1] = 0.4;
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
        for (int k = 0; k < 3; k++) {
            mps_probe p;
            assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
            memcpy(p.at, place[k], sizeof place[k]);
            p.average = 0;
            ASSERT_OK(sim, mps_probe_add(sim, &p, &id[k]));
        }
        for (int step = 0; step < 100; step++) {
            assert_true(mps_step(sim, 1, NULL) >= 0);
            for (int k = 0; k < 3; k++) {
                const double wanted = 9810 * (0.2 - place[k][1]);
                double p = NAN;
                ASSERT_OK(sim, mps_probe_read(sim, id[k], &p));
                ASSERT_NEAR(p, wanted, (step == 0 ? 0.01 : 0.05) * wanted);
            }
        }
        mps_sim_destroy(sim);
    }
}

static void rest_in_a_circle(void **state)
{
    (void)state;
    rest(2, 0.1, 1, pi / 2);
}

static void rest_in_a_sphere(void **state)
{
    (void)state;
    rest(3, 0.125, 0.5, 2 * pi / 3);
}

/* A circle that rotates about its centre slides along its liquid: rigid rotation would have rho pi
 * w^2/8. */
static void rolling_circle(void **state)
{
    (void)state;
    mps_sim *sim = half_full(2, 0.1);
    const mps_harmonic h = {.dof = MPS_ROTATE_Z, .amplitude = 0.3, .omega = 3};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    assert_true(mps_run(sim, 1.5, NULL, NULL) >= 0);
    assert_true(kinetic(sim) < 1e-3 * 1000 * pi / 8 * 0.81);
    assert_int_equal(through_the_wall(sim), 0);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_in_a_circle),
        cmocka_unit_test(rest_in_a_sphere),
        cmocka_unit_test(rolling_circle),
        cmocka_unit_test(start_beside_sloping_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
