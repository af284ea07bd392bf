/* SPDX-License-Identifier: BSD-3-Clause */
/* The tank moves from pose to pose. */
#include "tank_fixture.h"

static mps_sim *half_full(int32_t start)
{
    const double centre[2] = {0.3, 0.1};
    mps_sim *sim = new_sim(2, 0.05);
    add_tank(sim, 0.6, 0.6, 0);
    fill_depth(sim, 0.6, 0.3, 0);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, start));
    return sim;
}

static mps_motion_state pose_of(mps_sim *sim)
{
    mps_motion_state s;
    assert_int_equal(mps_motion_state_init(&s, sizeof s), MPS_OK);
    ASSERT_OK(sim, mps_motion_state_get(sim, &s));
    return s;
}

static mps_motion_state swing(double t)
{
    mps_motion_state s;
    assert_int_equal(mps_motion_state_init(&s, sizeof s), MPS_OK);
    const double w = 3, c = cos(w * t), z = sin(w * t);
    const double a[3] = {0.1 * (1 - c), 0.1 * w * z, 0.1 * w * w * c};
    s.value[MPS_MOVE_X] = a[0];
    s.rate[MPS_MOVE_X] = a[1];
    s.accel[MPS_MOVE_X] = a[2];
    s.value[MPS_ROTATE_Z] = -0.5 * a[0];
    s.rate[MPS_ROTATE_Z] = -0.5 * a[1];
    s.accel[MPS_ROTATE_Z] = -0.5 * a[2];
    return s;
}

/* Not a digit of the pose that was given is lost, and on the way the polynomial follows a smooth
 * motion: error T^6/46080 of its 6th derivative. */
static void meets_poses(void **state)
{
    mps_sim *sim = half_full(MPS_START_AT_REST);
    const double T = 0.1;
    mps_step_info info;
    (void)state;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    /* the pose at rest has another acceleration than the swing */
    for (int k = 1; k <= 4; k++) {
        const mps_motion_state end = swing(k * T);
        ASSERT_OK(sim, mps_motion_pose_set(sim, k * T, &end));
        double t = (k - 1) * T;
        while (k * T - t > 1e-9) {
            ASSERT_OK(sim, mps_step(sim, k * T - t, &info));
            t = info.t;
            const mps_motion_state at = pose_of(sim), exact = swing(t);
            if (k == 1) continue;
            const double allowed = 0.1 * pow(3 * T, 6) / 46080 * 1.01 + 1e-12;
            ASSERT_NEAR(at.value[MPS_MOVE_X], exact.value[MPS_MOVE_X], allowed);
            ASSERT_NEAR(at.value[MPS_ROTATE_Z], exact.value[MPS_ROTATE_Z], 0.5 * allowed + 1e-12);
            ASSERT_NEAR(at.rate[MPS_MOVE_X], exact.rate[MPS_MOVE_X], 100 * allowed);
            ASSERT_NEAR(at.accel[MPS_MOVE_X], exact.accel[MPS_MOVE_X], 1e4 * allowed);
        }
        const mps_motion_state at = pose_of(sim);
        assert_memory_equal(at.value, end.value, sizeof at.value);
        assert_memory_equal(at.rate, end.rate, sizeof at.rate);
        assert_memory_equal(at.accel, end.accel, sizeof at.accel);
    }
    mps_sim_destroy(sim);
}

static int follow(void *user, double t, mps_motion_state *state)
{
    const mps_motion_state *end = user;
    (void)t;
    *state = *end;
    return 0;
}

/* Walls use poses at the ends of steps, so that a callback with the same poses gives the same
 * bytes. */
static void same_as_callback(void **state)
{
    mps_sim *sim = half_full(MPS_START_AT_REST), *called = half_full(MPS_START_AT_REST);
    const double dt = 2e-3;
    mps_motion_state pose;
    mps_lease a = {.struct_size = sizeof a}, b = {.struct_size = sizeof b};
    (void)state;
    assert_int_equal(mps_motion_state_init(&pose, sizeof pose), MPS_OK);
    ASSERT_OK(called, mps_motion_callback_set(called, follow, &pose));
    for (int k = 1; k <= 20; k++) {
        pose = swing(k * dt);
        ASSERT_OK(sim, mps_motion_pose_set(sim, k * dt, &pose));
        double t;
        ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
        ASSERT_OK(sim, mps_step(sim, k * dt - t, NULL));
        ASSERT_OK(called, mps_step(called, k * dt - t, NULL));
    }
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &a));
    ASSERT_OK(called, mps_lease_begin(called, "velocity", MPS_READ, &b));
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.data, b.data, (size_t)(a.count * a.stride) * sizeof *a.data);
    ASSERT_OK(sim, mps_lease_end(sim, &a));
    ASSERT_OK(called, mps_lease_end(called, &b));
    mps_sim_destroy(sim);
    mps_sim_destroy(called);
}

/* The motion that was set last moves the tank; a step beyond the pose is refused, and the next pose
 * continues. */
static void last_one_counts(void **state)
{
    mps_sim *sim = half_full(MPS_START_AT_REST);
    const mps_harmonic h = {.dof = MPS_MOVE_X, .form = 1, .amplitude = 0.1, .omega = 3};
    mps_motion_state pose = swing(0.01);
    (void)state;
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    ASSERT_OK(sim, mps_motion_pose_set(sim, 0.01, &pose));
    ASSERT_OK(sim, mps_run(sim, 0.01, NULL, NULL));
    ASSERT_NEAR(pose_of(sim).value[MPS_MOVE_X], pose.value[MPS_MOVE_X], 0);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "mps_motion_pose_set");
    pose = swing(0.02);
    ASSERT_OK(sim, mps_motion_pose_set(sim, 0.02, &pose));
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    ASSERT_OK(sim, mps_motion_clear(sim));
    const mps_motion_state at = pose_of(sim);
    ASSERT_OK(sim, mps_run(sim, 0.05, NULL, NULL));
    ASSERT_NEAR(pose_of(sim).value[MPS_MOVE_X], at.value[MPS_MOVE_X], 0);
    mps_sim_destroy(sim);
}

/* The liquid takes the velocity of the tank once, not with each pose. */
static void starts_once(void **state)
{
    mps_sim *sim = half_full(MPS_START_WITH_TANK);
    mps_momentum m;
    mps_motion_state pose = swing(0);
    (void)state;
    assert_int_equal(mps_momentum_init(&m, sizeof m), MPS_OK);
    for (int k = 1; k <= 5; k++) {
        pose.value[MPS_MOVE_X] = 2e-6 * k * (k + 1);
        pose.rate[MPS_MOVE_X] = 4e-3 * k;
        ASSERT_OK(sim, mps_motion_pose_set(sim, 1e-3 * k, &pose));
        ASSERT_OK(sim, mps_run(sim, 1e-3 * k, NULL, NULL));
    }
    ASSERT_OK(sim, mps_momentum_get(sim, &m));
    ASSERT_NEAR(m.added[0], 0, 1e-9);
    mps_sim_destroy(sim);
}

/* A tank of a tenth of its liquid's added mass, moved by the load of the last step alone: the error
 * names the coupling. A tank that is thrown about by other reasons than its load is moved by a
 * function. */
static void diverges(void **state)
{
    (void)state;
    for (int by_poses = 0; by_poses < 2; by_poses++) {
        const double dt = 2e-3, mass = 2;
        double x = 0, v = 1e-2, a = 0;
        mps_sim *sim = half_full(MPS_START_AT_REST);
        mps_load load;
        mps_motion_state pose = swing(0);
        mps_status status = MPS_OK;
        assert_int_equal(mps_load_init(&load, sizeof load), MPS_OK);
        ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_FORCE));
        if (!by_poses) ASSERT_OK(sim, mps_motion_callback_set(sim, follow, &pose));
        for (int k = 1; status >= 0 && k < 200; k++) {
            v += dt * a;
            x += dt * v;
            pose.value[MPS_MOVE_X] = x;
            if (by_poses) ASSERT_OK(sim, mps_motion_pose_set(sim, k * dt, &pose));
            status = mps_step(sim, dt, NULL);
            if (status >= 0) ASSERT_OK(sim, mps_load_get(sim, NULL, &load));
            a = load.force[0] / mass;
        }
        assert_int_equal(status, MPS_E_DIVERGED);
        const char *said = strstr(mps_sim_error(sim), "coupling: mps_motion_pose_set()");
        assert_true((said != NULL) == by_poses);
        mps_sim_destroy(sim);
    }
}

/* A refusal leaves the motion unchanged. */
static void refused(void **state)
{
    mps_sim *sim = half_full(MPS_START_AT_REST);
    mps_motion_state pose = swing(0.1), bad = pose;
    (void)state;
    ASSERT_OK(sim, mps_motion_pose_set(sim, 0.1, &pose));
    assert_int_equal(mps_motion_pose_set(NULL, 0.1, &pose), MPS_E_ARG);
    ASSERT_REFUSED(sim, mps_motion_pose_set(sim, 0.1, NULL), MPS_E_ARG, "mps_motion_state");
    ASSERT_REFUSED(sim, mps_motion_pose_set(sim, 0, &pose), MPS_E_ARG, "t_end");
    ASSERT_REFUSED(sim, mps_motion_pose_set(sim, (double)NAN, &pose), MPS_E_ARG, "t_end");
    bad.value[MPS_MOVE_Z] = 1;
    ASSERT_REFUSED(sim, mps_motion_pose_set(sim, 0.2, &bad), MPS_E_ARG, "MPS_MOVE_Z");
    bad = pose;
    bad.accel[MPS_MOVE_X] = (double)INFINITY;
    ASSERT_REFUSED(sim, mps_motion_pose_set(sim, 0.2, &bad), MPS_E_ARG, "MPS_MOVE_X");
    bad = pose;
    bad.value[MPS_MOVE_X] = 1e9;
    ASSERT_STATUS(sim, mps_motion_pose_set(sim, 0.2, &bad), MPS_E_ARG);
    ASSERT_OK(sim, mps_run(sim, 0.1, NULL, NULL));
    ASSERT_NEAR(pose_of(sim).value[MPS_MOVE_X], pose.value[MPS_MOVE_X], 0);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meets_poses),     cmocka_unit_test(same_as_callback),
        cmocka_unit_test(last_one_counts), cmocka_unit_test(starts_once),
        cmocka_unit_test(diverges),        cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
