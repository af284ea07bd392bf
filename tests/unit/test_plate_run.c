/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates in steps: pressures, particles and probes of one side do not depend on the other. */
#include "plate_fixture.h"

/* Pressures on the left of a plate; on the right the water depth is `right`. */
static int64_t pressures_left(double right, double *p)
{
    mps_sim *sim = new_sim(2, dp);
    mps_time_control control;
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.4}, lo2[2] = {0.5, 0}, hi2[2] = {1, right};
    int64_t count = 0;
    add_tank(sim, 1, 0.6, 0);
    add_plate(sim, 1, 0, 0.6);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo2, hi2, NULL, NULL));
    ASSERT_OK(sim, mps_solver_use(sim, "sundials.klu", NULL));
    ASSERT_OK(sim, mps_time_control_init(&control, sizeof control));
    control.dt = 1e-3;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    ASSERT_OK(sim, mps_run(sim, 0.01, NULL, NULL));
    const mps__particles *s = &sim->world.particles;
    for (int64_t id = 0; id < s->next_id; id++) {
        const int64_t i = mps_particle_index(sim, id);
        if (s->kind[i] == MPS_FLUID && s->x[2 * i] < 0.5) p[count++] = s->p[i];
    }
    mps_sim_destroy(sim);
    return count;
}

/* In the direct solver the sides have only the order of elimination in common: equal to
 * rounding. */
static void sides_do_not_feel_each_other(void **state)
{
    (void)state;
    double a[100], b[100];
    const int64_t count = pressures_left(0.1, a);
    assert_int_equal(count, 8 * 9);
    assert_int_equal(pressures_left(0.5, b), count);
    assert_true(a[0] > 3000);
    for (int64_t k = 0; k < count; k++) ASSERT_NEAR(a[k], b[k], 1e-8);
}

/* Droplets that hit a plate at several spacings per step remain on their side and lose their normal
 * speed, also in a rotating tank. */
static void no_particle_passes(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = new_sim(dim, dp);
        mps_time_control control;
        mps_particle_block block;
        mps_tank tank;
        const double centre[3] = {0.3, 0.1, 0},
                     at[4][3] = {
                         {0.1, 0.1, 0.2}, {0.3, 0.2, 0.2}, {0.4, 0.4, 0.2}, {0.9, 0.3, 0.2}};
        const mps_harmonic turn = {.dof = MPS_ROTATE_Z, .amplitude = 0.5, .omega = 5};
        double x[12], u[12] = {0};
        int64_t ids[4];
        ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &turn));
        mps_tank_init(&tank, sizeof tank);
        tank.size[0] = 1;
        tank.size[1] = 0.6;
        tank.size[2] = 0.4;
        tank.dummy_layers = 3; /* 4 dp deep */
        ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
        const double lo[3] = {0.5, 0, 0}, hi[3] = {0.5, 0.6, 0.4};
        ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
        mps_particle_block_init(&block, sizeof block);
        block.count = 4;
        block.position = x;
        block.velocity = u;
        for (int k = 0; k < 4; k++) {
            memcpy(x + k * dim, at[k], (size_t)dim * sizeof *x);
            u[k * dim] = k < 3 ? 40 : -40;
        }
        ASSERT_OK(sim, mps_particles_add(sim, &block, ids));
        mps_time_control_init(&control, sizeof control);
        control.dt = 4e-3; /* 3 dp a step */
        ASSERT_OK(sim, mps_time_control_set(sim, &control));
        for (int k = 0; k < 10; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        for (int k = 0; k < 4; k++) {
            const mps__particles *s = &sim->world.particles;
            const int64_t i = mps_particle_index(sim, ids[k]);
            double X[3];
            mps__motion_to_tank(&sim->world.motion, &sim->world.motion.now, s->x + i * dim, X);
            assert_true(k < 3 ? X[0] < 0.5 && X[0] > 0.3 : X[0] > 0.5 && X[0] < 0.7);
            assert_true(fabs(s->u[i * dim]) < 10);
        }
        mps_sim_destroy(sim);
    }
}

/* Force and both faces' pressures, by probes on either side of one column. */
static void probes_tell_the_sides(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.4};
    mps_probe probe;
    int32_t left, right, force, inside;
    double p, f[3];
    add_tank(sim, 1, 0.6, 0);
    add_plate(sim, 1, 0, 0.6);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    mps_probe_init(&probe, sizeof probe);
    probe.at[0] = 0.5 - 1e-3 * dp;
    probe.at[1] = 0.2;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &left));
    probe.at[0] = 0.5 + 1e-3 * dp;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &right));
    probe.type = MPS_PROBE_FLUID_PRESSURE;
    probe.at[0] = 0.5 + 0.3 * dp;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &inside));
    probe.type = MPS_PROBE_FORCE;
    probe.part = "plate";
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &force));
    ASSERT_OK(sim, mps_run(sim, 0.02, NULL, NULL));
    ASSERT_OK(sim, mps_probe_read(sim, left, &p));
    ASSERT_NEAR(p, 1000 * 9.81 * 0.2, 40);
    ASSERT_OK(sim, mps_probe_read(sim, right, &p));
    ASSERT_NEAR(p, 0, 0);
    ASSERT_OK(sim, mps_probe_read(sim, inside, &p));
    ASSERT_NEAR(p, 0, 0);
    ASSERT_OK(sim, mps_probe_read(sim, force, f));
    /* only of the water below the level: the dry row above it has pressure 0 */
    ASSERT_NEAR(f[0], 1000 * 9.81 * 0.5 * 0.4 * 0.4, 0.001 * 1000 * 9.81 * 0.08);
    mps_sim_destroy(sim);
}

/* Without its walls a plate hides nothing. */
static void removed_plate(void **state)
{
    (void)state;
    mps_sim *sim = divided(2, 1);
    mps_stencil t = {.struct_size = sizeof t};
    int64_t ids[2 * 13], count = 0, across = 0;
    const mps__particles *s = &sim->world.particles;
    const int32_t part = mps_part_find(sim, "plate");
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_WALL && s->part[i] == part) ids[count++] = s->id[i];
    assert_int_equal(count, 2 * 11);
    for (int pass = 0; pass < 2; pass++) {
        across = 0;
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &t));
        for (int64_t i = 0; i < s->n; i++)
            for (int64_t k = t.begin[i]; k < t.end[i]; k++)
                across += s->kind[i] == MPS_FLUID && s->kind[t.col[k]] == MPS_FLUID &&
                          (s->x[2 * i] - 0.5) * (s->x[2 * t.col[k]] - 0.5) < 0;
        assert_true(pass ? across > 0 : across == 0);
        if (!pass) ASSERT_OK(sim, mps_particles_remove(sim, count, ids));
    }
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_do_not_feel_each_other),
        cmocka_unit_test(no_particle_passes),
        cmocka_unit_test(probes_tell_the_sides),
        cmocka_unit_test(removed_plate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
