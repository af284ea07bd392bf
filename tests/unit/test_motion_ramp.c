/* SPDX-License-Identifier: BSD-3-Clause */
/* Harmonics with a ramp: derivatives, ends of the ramp, refusals, and the initial pressures of a
 * tank. */
#include "sim.h"
#include "tank_fixture.h"

static const double pi = 3.14159265358979323846;

static mps_sim *moving(const mps_harmonic *h)
{
    mps_sim *sim = new_sim(2, 0.1);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, h));
    return sim;
}

static void pose_at(mps_sim *sim, double t, double q[3])
{
    mps__pose pose;
    ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, t, &pose));
    q[0] = pose.state.value[MPS_MOVE_X];
    q[1] = pose.state.rate[MPS_MOVE_X];
    q[2] = pose.state.accel[MPS_MOVE_X];
}

static const mps_harmonic list[] = {{MPS_MOVE_X, 0, 0.02, 6.469, 0, 1.3},
                                    {MPS_MOVE_X, 0, 0.3, 2, 0.9, 0.4},
                                    {MPS_MOVE_X, 1, 0.1, 5, 0, 2}};
enum { LIST = sizeof list / sizeof list[0] };

/* Rate and acceleration are the derivatives of the position, before, at and after the end of the
 * ramp. */
static void exact_derivatives(void **state)
{
    (void)state;
    const double e = 1e-4;
    for (int k = 0; k < LIST; k++) {
        mps_sim *sim = moving(&list[k]);
        for (double t = 0.01; t < 1.5 * list[k].ramp; t += 0.0371) {
            double q[5][3];
            for (int j = 0; j < 5; j++) pose_at(sim, t + (j - 2) * e, q[j]);
            if (fabs(t - list[k].ramp) < 3 * e) continue; /* the third derivative jumps there */
            for (int d = 0; d < 2; d++)
                ASSERT_NEAR(q[2][d + 1], (8 * (q[3][d] - q[1][d]) - (q[4][d] - q[0][d])) / (12 * e),
                            1e-9);
        }
        mps_sim_destroy(sim);
    }
}

/* The tank starts at rest in its initial pose, without acceleration; after the ramp it moves as
 * without one. */
static void continuous_at_both_ends(void **state)
{
    (void)state;
    for (int k = 0; k < LIST; k++) {
        mps_harmonic at_once = list[k];
        at_once.ramp = 0;
        mps_sim *sim = moving(&list[k]), *other = moving(&at_once);
        double q[3], whole[3];
        pose_at(sim, 0, q);
        for (int d = 0; d < 3; d++) ASSERT_NEAR(q[d], 0, 0);
        pose_at(sim, 1e-9, q);
        for (int d = 0; d < 3; d++) ASSERT_NEAR(q[d], 0, 1e-6);
        for (int d = 0; d < 3; d++) {
            pose_at(sim, list[k].ramp * (1 - 1e-9), q);
            pose_at(other, list[k].ramp * (1 - 1e-9), whole);
            ASSERT_NEAR(q[d], whole[d], 1e-6);
            pose_at(sim, list[k].ramp, q);
            pose_at(other, list[k].ramp, whole);
            ASSERT_NEAR(q[d], whole[d], 0);
        }
        mps_sim_destroy(other);
        mps_sim_destroy(sim);
    }
}

static void refusals(void **state)
{
    (void)state;
    const double bad[] = {-1, NAN, INFINITY};
    mps_sim *sim = new_sim(2, 0.1);
    for (int k = 0; k < 3; k++) {
        mps_harmonic h = list[0];
        h.ramp = bad[k];
        ASSERT_REFUSED(sim, mps_motion_harmonics_set(sim, 1, &h), MPS_E_ARG, "ramp is ");
    }
    mps_sim_destroy(sim);
}

/* Least and largest wall pressure of the first quarter of a period, half a tank of water. */
static void pressures_of_start(double ramp, double range[2])
{
    const mps_harmonic h = {MPS_MOVE_X, 0, 0.02, 6.469, 0, ramp};
    mps_sim *sim = new_sim(2, 0.025);
    double t = 0;
    add_tank(sim, 0.8, 0.4, 0);
    fill_depth(sim, 0.8, 0.25, 0);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    range[0] = range[1] = 0;
    while (t < 0.5 * pi / h.omega) {
        mps_lease lease = {.struct_size = sizeof lease};
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "wall_pressure", MPS_READ, &lease));
        for (int64_t i = 0; i < lease.count; i++) {
            range[0] = fmin(range[0], lease.data[i]);
            range[1] = fmax(range[1], lease.data[i]);
        }
        ASSERT_OK(sim, mps_lease_end(sim, &lease));
    }
    mps_sim_destroy(sim);
}

/* A sine starts with a blow on both end walls; grown over a period pressures stay within 20 % of
 * the pressure at rest. */
static void starts_without_a_blow(void **state)
{
    (void)state;
    const double rest = 1000 * 9.81 * 0.25;
    double range[2];
    pressures_of_start(0, range);
    if (!(range[0] < -rest && range[1] > 3 * rest))
        fail_msg("at once: %g .. %g Pa", range[0], range[1]);
    pressures_of_start(2 * pi / 6.469, range);
    if (!(range[0] > -0.2 * rest && range[1] < 1.2 * rest))
        fail_msg("with a ramp: %g .. %g Pa", range[0], range[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_derivatives),
        cmocka_unit_test(continuous_at_both_ends),
        cmocka_unit_test(refusals),
        cmocka_unit_test(starts_without_a_blow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
