/* SPDX-License-Identifier: BSD-3-Clause */
/* Load by momentum and added mass, against exact values. */
#include "tank_fixture.h"
#include <stdio.h>

static const double width = 0.8, rho = 1000;

/* A tank of 0.8 x 0.5 m (x 0.4 m), moments about (0.4, height, 0.2). */
static mps_sim *tank(int32_t dim, double dp, double depth, double height)
{
    const double centre[3] = {0.4, height, 0.2};
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, width, 0.5, dim == 3 ? 0.4 : 0);
    fill_depth(sim, width, depth, 0.4);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

static mps_load load_of(mps_sim *sim, const double *centre)
{
    mps_load l;
    assert_int_equal(mps_load_init(&l, sizeof l), MPS_OK);
    ASSERT_OK(sim, mps_load_get(sim, centre, &l));
    return l;
}

static mps_load step_with(mps_sim *sim, int32_t what, int32_t steps)
{
    ASSERT_OK(sim, mps_load_watch(sim, what));
    for (int32_t k = 0; k < steps; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    return load_of(sim, NULL);
}

/* The load of a step of 1 ms, in which the tank has an acceleration in one degree of freedom. */
static mps_load trial(mps_sim *sim, const mps_snapshot *start, int32_t dof, double a)
{
    const double dt = 1e-3;
    double t;
    mps_motion_state pose;
    ASSERT_OK(sim, mps_snapshot_restore((mps_snapshot *)start));
    assert_int_equal(mps_motion_state_init(&pose, sizeof pose), MPS_OK);
    ASSERT_OK(sim, mps_motion_state_get(sim, &pose));
    ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
    pose.value[dof] += a * dt * dt;
    ASSERT_OK(sim, mps_motion_pose_set(sim, t + dt, &pose));
    ASSERT_OK(sim, mps_step(sim, dt, NULL));
    const mps_load l = load_of(sim, NULL);
    for (int k = 0; k < 6; k++) ASSERT_NEAR(l.acceleration[k], k == dof ? a : 0, 1e-6);
    return l;
}

/* All of the liquid moves with the tank; about the middle rho (I_polar - St Venant's torsion
 * constant): 9.293. */
static void full_box(void **state)
{
    mps_sim *sim = tank(2, 0.01, 0.5, 0.25);
    const mps_load l = step_with(sim, MPS_LOAD_MASS, 1);
    (void)state;
    assert_int_equal(l.has_mass, 1);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            const double exact = i != j ? 0 : i < 2 ? 400 : i == 5 ? 9.293 : 0;
            ASSERT_NEAR(l.mass[6 * i + j], exact, i == 5 && j == 5 ? 0.005 * 9.293 : 400 * 1e-5);
        }
    ASSERT_NEAR(l.force[0], 0, 1e-3);
    ASSERT_NEAR(l.force[1], -400 * 9.81, 400 * 9.81 * 1e-5);
    ASSERT_NEAR(l.force[5], 0, 1e-3);
    mps_sim_destroy(sim);
}

/* p = 0 on the surface: A11 = 4 rho/h sum tanh(k L/2)/k^3, k = (m - 1/2) pi/h. */
static double surge_mass(double h)
{
    double sum = 0;
    for (int m = 1; m < 2000; m++) {
        const double k = (m - 0.5) * acos(-1.0) / h;
        sum += 4 * rho / h * tanh(k * width / 2) / (k * k * k);
    }
    return sum;
}

static void with_surface(void **state)
{
    const double h = 0.25, surge = surge_mass(h);
    (void)state;
    ASSERT_NEAR(surge, 67.003, 1e-3);
    mps_sim *sim = tank(2, 0.01, h, 0);
    const mps_load l = step_with(sim, MPS_LOAD_MASS, 2);
    ASSERT_NEAR(l.mass[0], surge, 0.015 * surge);
    ASSERT_NEAR(l.mass[7], 200, 1e-3 * 200);
    ASSERT_NEAR(l.mass[5], -21.714, 0.015 * 21.714);
    ASSERT_NEAR(l.mass[30], l.mass[5], 0.01 * 21.714);
    ASSERT_NEAR(l.mass[35], 11.316, 0.015 * 11.316);
    ASSERT_NEAR(l.force[1], -200 * 9.81, 200 * 9.81 * 1e-3);
    mps_sim_destroy(sim);
}

/* A third dimension: all of a full box, and its fraction with a surface, where the width has no
 * effect on surge. */
static void in_3d(void **state)
{
    mps_sim *sim = tank(3, 0.05, 0.5, 0.25);
    mps_load l = step_with(sim, MPS_LOAD_MASS, 1);
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) ASSERT_NEAR(l.mass[6 * i + j], i == j ? 160 : 0, 160 * 2e-5);
    /* about z it is a slice of the tank in 2-D, that is, 0.4 of it, to the spacing */
    mps_sim *slice = tank(2, 0.05, 0.5, 0.25);
    const mps_load flat = step_with(slice, MPS_LOAD_MASS, 1);
    ASSERT_NEAR(l.mass[35], 0.4 * flat.mass[35], 0.01 * l.mass[35]);
    mps_sim_destroy(slice);
    mps_sim_destroy(sim);
    sim = tank(3, 0.05, 0.25, 0);
    l = step_with(sim, MPS_LOAD_MASS, 2);
    slice = tank(2, 0.05, 0.25, 0);
    const mps_load half = step_with(slice, MPS_LOAD_MASS, 2);
    ASSERT_NEAR(l.mass[0], 0.4 * half.mass[0], 0.02 * l.mass[0]);
    ASSERT_NEAR(l.mass[7], 0.4 * half.mass[7], 0.01 * l.mass[7]);
    mps_sim_destroy(slice);
    mps_sim_destroy(sim);
}

/* A is the derivative of F: central differences of whole steps, in a wave. The column of each
 * degree of freedom. */
static void derivative(mps_sim *sim, double tolerance)
{
    static const int32_t dof[3] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    mps_snapshot *start = NULL;
    ASSERT_OK(sim, mps_snapshot_create(sim, &start));
    ASSERT_OK(sim, mps_snapshot_take(start));
    for (int c = 0; c < 3; c++) {
        const double a = 0.1;
        const mps_load up = trial(sim, start, dof[c], a), down = trial(sim, start, dof[c], -a);
        assert_int_equal(up.has_mass, 1);
        for (int r = 0; r < 3; r++) {
            const int i = dof[r], at = 6 * i + dof[c];
            const double slope = -(up.force[i] - down.force[i]) / (2 * a),
                         scale = sqrt(up.mass[7 * i] * up.mass[7 * dof[c]]);
            ASSERT_NEAR(up.mass[at], slope, tolerance * scale);
            ASSERT_NEAR(up.rest[i], up.force[i] + up.mass[at] * a, 1e-9 * (1 + fabs(up.rest[i])));
        }
    }
    mps_snapshot_destroy(start);
}

static void is_derivative(void **state)
{
    const mps_harmonic h = {.dof = MPS_MOVE_X, .form = 1, .amplitude = 0.03, .omega = 5.4};
    mps_sim *sim = tank(2, 0.025, 0.25, 0);
    (void)state;
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    ASSERT_OK(sim, mps_run(sim, 0.3, NULL, NULL));
    ASSERT_OK(sim, mps_motion_clear(sim));
    step_with(sim, MPS_LOAD_MASS, 3); /* the tank has stopped */
    derivative(sim, 5e-3);
    mps_sim_destroy(sim);
}

/* Water below air in a tank that they fill: all of both moves with the tank along y. */
static mps_sim *two_phases(void)
{
    const double lo[2] = {0, 0}, hi[2] = {0.8, 0.5}, centre[2] = {0.4, 0};
    mps_phase air;
    mps_sim *sim = new_sim(2, 0.025);
    assert_int_equal(mps_phase_init(&air, sizeof air), MPS_OK);
    air.density = 1.2;
    air.viscosity = 1.8e-5;
    ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
    ASSERT_OK(sim, mps_phase_set(sim, 1, &air));
    add_tank(sim, width, 0.5, 0);
    fill_depth(sim, width, 0.25, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

static void with_air(void **state)
{
    (void)state;
    for (int law = 0; law < 2; law++) {
        mps_sim *sim = two_phases();
        if (law) {
            ASSERT_OK(sim, mps_model_use(sim, "gas.isentropic"));
            ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
        }
        const mps_load l = step_with(sim, MPS_LOAD_MASS, 5);
        assert_int_equal(l.has_mass, 1);
        /* whole cells of water and half a cell at the floor: the interface is half a spacing above
         * the last row */
        ASSERT_NEAR(l.mass[0], surge_mass(10.5 * 0.025), 0.03 * 70);
        derivative(sim, 5e-3);
        mps_sim_destroy(sim);
    }
}

/* About another centre: the values of a tank that rotates about it. */
static void other_centre(void **state)
{
    const double there[2] = {0.1, 0.3};
    mps_sim *sim = tank(2, 0.025, 0.25, 0), *moved = tank(2, 0.025, 0.25, 0);
    (void)state;
    ASSERT_OK(moved, mps_motion_centre_set(moved, there, MPS_START_AT_REST));
    const mps_load wanted = step_with(moved, MPS_LOAD_MASS, 3);
    step_with(sim, MPS_LOAD_MASS, 3);
    const mps_load l = load_of(sim, there);
    for (int k = 0; k < 36; k++) ASSERT_NEAR(l.mass[k], wanted.mass[k], 2e-4 * 200);
    for (int k = 0; k < 6; k++) ASSERT_NEAR(l.force[k], wanted.force[k], 1e-6 * 2000);
    mps_sim_destroy(sim);
    mps_sim_destroy(moved);
}

/* A rotating tank has an acceleration about each point. */
static void acceleration_of_points(void **state)
{
    const mps_harmonic h = {.dof = MPS_ROTATE_Z, .form = 1, .amplitude = 0.05, .omega = 4};
    const double there[2] = {0.4, 0.5}; /* arm (0, 0.5) */
    mps_sim *sim = tank(2, 0.025, 0.25, 0);
    (void)state;
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    const mps_load at = step_with(sim, MPS_LOAD_FORCE, 30), point = load_of(sim, there);
    double t;
    ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
    const double alpha = -0.05 * 16 * cos(4 * (t - at.dt));
    assert_int_equal(at.has_mass, 0);
    ASSERT_NEAR(at.acceleration[5], alpha, 1e-3);
    ASSERT_NEAR(at.acceleration[0], 0, 1e-9);
    ASSERT_NEAR(point.acceleration[0], -0.5 * alpha, 2e-3);
    ASSERT_NEAR(point.force[5], at.force[5] + 0.5 * at.force[0], 2.0);
    for (int k = 0; k < 36; k++) assert_true(point.mass[k] == 0);
    mps_sim_destroy(sim);
}

/* It does not change the motion of the liquid. A snapshot includes the load, too. */
static void changes_nothing(void **state)
{
    mps_sim *sim[2] = {tank(2, 0.05, 0.25, 0), tank(2, 0.05, 0.25, 0)};
    mps_lease u[2] = {{.struct_size = sizeof(mps_lease)}, {.struct_size = sizeof(mps_lease)}};
    mps_snapshot *k = NULL;
    (void)state;
    ASSERT_OK(sim[1], mps_load_watch(sim[1], MPS_LOAD_MASS));
    for (int both = 0; both < 2; both++) {
        const mps_harmonic h = {.dof = MPS_MOVE_X, .form = 1, .amplitude = 0.05, .omega = 6};
        ASSERT_OK(sim[both], mps_motion_harmonics_set(sim[both], 1, &h));
        ASSERT_OK(sim[both], mps_run(sim[both], 0.1, NULL, NULL));
        ASSERT_OK(sim[both], mps_lease_begin(sim[both], "velocity", MPS_READ, &u[both]));
    }
    assert_memory_equal(u[0].data, u[1].data, (size_t)(u[0].count * u[0].stride) * sizeof(double));
    for (int both = 0; both < 2; both++) ASSERT_OK(sim[both], mps_lease_end(sim[both], &u[both]));
    const mps_load l = load_of(sim[1], NULL);
    ASSERT_OK(sim[1], mps_snapshot_create(sim[1], &k));
    ASSERT_OK(sim[1], mps_snapshot_take(k));
    ASSERT_OK(sim[1], mps_step(sim[1], 1e-3, NULL));
    ASSERT_OK(sim[1], mps_snapshot_restore(k));
    const mps_load back = load_of(sim[1], NULL);
    assert_memory_equal(l.force, back.force, sizeof l.force);
    assert_memory_equal(l.mass, back.mass, sizeof l.mass);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim[0]);
    mps_sim_destroy(sim[1]);
}

/* A checkpoint has the load of the last step, and the first guesses of A: the steps after it have
 * the same bytes. A checkpoint without them can be read, too. */
static void through_a_checkpoint(void **state)
{
    static const char path[] = "test_load_mass.mps";
    mps_sim *sim[3] = {tank(2, 0.05, 0.25, 0), tank(2, 0.05, 0.25, 0), tank(2, 0.05, 0.25, 0)};
    mps_load l[3];
    (void)state;
    mps_load last = step_with(sim[0], MPS_LOAD_MASS, 3);
    ASSERT_OK(sim[0], mps_checkpoint_write(sim[0], path));
    for (int k = 0; k < 2; k++) {
        ASSERT_OK(sim[k], mps_load_watch(sim[k], MPS_LOAD_MASS));
        ASSERT_OK(sim[k], mps_checkpoint_read(sim[k], path));
        const mps_load back = load_of(sim[k], NULL);
        assert_memory_equal(&back, &last, sizeof back);
        l[k] = step_with(sim[k], MPS_LOAD_MASS, 2);
    }
    assert_true(l[0].has_mass == 1 && l[1].has_mass == 1);
    assert_memory_equal(l[0].mass, l[1].mass, sizeof l[0].mass);
    assert_memory_equal(l[0].rest, l[1].rest, sizeof l[0].rest);
    ASSERT_OK(sim[2], mps_step(sim[2], 1e-3, NULL));
    ASSERT_OK(sim[2], mps_step(sim[2], 1e-3, NULL));
    ASSERT_OK(sim[2], mps_step(sim[2], 1e-3, NULL));
    ASSERT_OK(sim[2], mps_checkpoint_write(sim[2], path));
    ASSERT_OK(sim[1], mps_checkpoint_read(sim[1], path));
    mps_load_init(&last, sizeof last);
    assert_int_equal(mps_load_get(sim[1], NULL, &last), MPS_E_STATE);
    l[2] = step_with(sim[1], MPS_LOAD_MASS, 2);
    for (int k = 0; k < 36; k++) ASSERT_NEAR(l[2].mass[k], l[0].mass[k], 2e-4 * 200);
    assert_memory_equal(l[2].force, l[0].force, sizeof l[0].force);
    ASSERT_OK(sim[0], mps_checkpoint_write(sim[0], path));
    ASSERT_OK(sim[2], mps_checkpoint_read(sim[2], path)); /* nor is one refused that has them */
    remove(path);
    for (int k = 0; k < 3; k++) mps_sim_destroy(sim[k]);
}

static void refused(void **state)
{
    const double bad[2] = {0, (double)NAN};
    mps_sim *sim = tank(2, 0.05, 0.25, 0);
    mps_load l;
    mps_lease lease = {.struct_size = sizeof lease};
    (void)state;
    assert_int_equal(mps_load_init(&l, 7), MPS_E_ARG);
    assert_int_equal(mps_load_init(&l, sizeof l), MPS_OK);
    assert_int_equal(mps_load_watch(NULL, 0), MPS_E_ARG);
    assert_int_equal(mps_load_get(NULL, NULL, &l), MPS_E_ARG);
    ASSERT_REFUSED(sim, mps_load_watch(sim, 3), MPS_E_ARG, "MPS_LOAD_MASS");
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &lease));
    ASSERT_REFUSED(sim, mps_load_watch(sim, 2), MPS_E_BUSY, "lease");
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    ASSERT_REFUSED(sim, mps_load_get(sim, NULL, &l), MPS_E_STATE, "mps_load_watch");
    step_with(sim, MPS_LOAD_FORCE, 1);
    ASSERT_REFUSED(sim, mps_load_get(sim, bad, &l), MPS_E_ARG, "centre");
    ASSERT_REFUSED(sim, mps_load_get(sim, NULL, NULL), MPS_E_ARG, "mps_load");
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_NONE));
    ASSERT_REFUSED(sim, mps_load_get(sim, NULL, &l), MPS_E_STATE, "mps_load_watch");
    /* the equations of the papers are not in the frame of the tank */
    ASSERT_OK(sim, mps_preset_use(sim, "imps.paper"));
    step_with(sim, MPS_LOAD_FORCE, 1);
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_MASS));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "source.volume");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_box),        cmocka_unit_test(with_surface),
        cmocka_unit_test(in_3d),           cmocka_unit_test(is_derivative),
        cmocka_unit_test(with_air),        cmocka_unit_test(other_centre),
        cmocka_unit_test(refused),         cmocka_unit_test(acceleration_of_points),
        cmocka_unit_test(changes_nothing), cmocka_unit_test(through_a_checkpoint)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
