/* SPDX-License-Identifier: BSD-3-Clause */
/* Refusals of the functions of mps/ship.h and of pose matrices; outputs are unchanged. */
#include "tank_fixture.h"

static const double pi = 3.14159265358979323846;

static mps_ship usual_ship(void)
{
    mps_ship ship;
    assert_int_equal(mps_ship_init(&ship, sizeof ship), MPS_OK);
    return ship;
}

static void bad_ships(void **state)
{
    (void)state;
    const mps_ship_motion rest = {.struct_size = sizeof rest};
    mps_motion_state tank = {.struct_size = sizeof tank};
#define REFUSE(change)                                                      \
    do {                                                                    \
        mps_ship ship = usual_ship();                                       \
        change;                                                             \
        tank.value[0] = 7;                                                  \
        assert_int_equal(mps_ship_to_tank(&ship, &rest, &tank), MPS_E_ARG); \
        assert_true(tank.value[0] == 7);                                    \
    } while (0)
    REFUSE(ship.struct_size = 3);
    REFUSE(ship.axes = 2);
    REFUSE(ship.degrees = -1);
    REFUSE(ship.order[1] = MPS_SHIP_YAW);
    REFUSE(ship.order[0] = MPS_SHIP_HEAVE);
    REFUSE(ship.order[2] = 6);
    REFUSE(ship.forward[0] = 0);
    REFUSE(ship.forward[1] = NAN);
    REFUSE(ship.up[1] = INFINITY);
    REFUSE(ship.up[0] = 1e-3);
    REFUSE(ship.origin[2] = NAN);
#undef REFUSE
    assert_int_equal(mps_ship_to_tank(NULL, &rest, &tank), MPS_E_ARG);
    assert_int_equal(mps_ship_init(NULL, sizeof(mps_ship)), MPS_E_ARG);
    assert_int_equal(mps_ship_motion_init(NULL, 0), MPS_E_ARG);
}

static void bad_arguments(void **state)
{
    (void)state;
    const mps_ship ship = usual_ship();
    const int32_t dof[6] = {0, 1, 2, 3, 4, 5}, twice[2] = {3, 3}, none[1] = {6};
    mps_ship_motion m = {.struct_size = sizeof m}, empty = {0};
    mps_motion_state tank = {.struct_size = sizeof tank}, bare = {0};
    double six[6] = {0}, out[6] = {0}, nan[6] = {0, NAN, 0, 0, NAN, 0};
    m.rate[3] = NAN;
    assert_int_equal(mps_ship_to_tank(&ship, &m, &tank), MPS_E_ARG);
    m.rate[3] = 0;
    assert_int_equal(mps_ship_to_tank(&ship, &m, &bare), MPS_E_ARG);
    assert_int_equal(mps_ship_to_tank(&ship, &empty, &tank), MPS_E_ARG);
    assert_int_equal(mps_ship_to_tank(&ship, NULL, &tank), MPS_E_ARG);
    assert_int_equal(mps_ship_from_tank(&ship, &tank, &empty), MPS_E_ARG);
    assert_int_equal(mps_ship_from_tank(&ship, &bare, &m), MPS_E_ARG);
    tank.accel[5] = INFINITY;
    assert_int_equal(mps_ship_from_tank(&ship, &tank, &m), MPS_E_ARG);
    tank.accel[5] = 0;
    assert_int_equal(mps_ship_table(&ship, 0, six, 6, dof, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, NULL, 6, dof, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, six, 6, NULL, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, six, 6, dof, NULL), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, six, 0, dof, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, six, 7, dof, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, six, 2, twice, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, six, 1, none, out), MPS_E_ARG);
    assert_int_equal(mps_ship_table(&ship, 1, nan, 6, dof, out), MPS_E_ARG);
    assert_int_equal(mps_ship_load_from_lab(&ship, &tank, 2, NULL, six, out), MPS_E_ARG);
    assert_int_equal(mps_ship_load_from_lab(&ship, &tank, 0, nan, six, out), MPS_E_ARG);
    assert_int_equal(mps_ship_load_from_lab(&ship, &tank, 0, NULL, nan, out), MPS_E_ARG);
    assert_int_equal(mps_ship_load_from_lab(&ship, &tank, 0, NULL, NULL, out), MPS_E_ARG);
    assert_int_equal(mps_ship_load_to_lab(&ship, &tank, 0, NULL, nan, out), MPS_E_ARG);
    assert_int_equal(mps_ship_load_to_lab(&ship, NULL, 0, NULL, six, out), MPS_E_ARG);
    assert_int_equal(mps_ship_vector_from_lab(&ship, &tank, 0, nan, out), MPS_E_ARG);
    assert_int_equal(mps_ship_vector_from_lab(&ship, &tank, 0, six, NULL), MPS_E_ARG);
    assert_int_equal(mps_ship_vector_to_lab(&ship, &tank, -1, six, out), MPS_E_ARG);
    assert_int_equal(mps_ship_vector_to_lab(&ship, &tank, 0, nan, out), MPS_E_ARG);
    for (int d = 0; d < 6; d++) assert_true(out[d] == 0);
}

/* A rotation by 90 degrees about the second axis with another angle has no unique angles; a
 * rotation about this axis only has. */
static void a_quarter_turn(void **state)
{
    (void)state;
    const mps_ship ship = usual_ship();
    mps_motion_state tank = {.struct_size = sizeof tank};
    mps_ship_motion m = {.struct_size = sizeof m};
    m.value[MPS_SHIP_PITCH] = -pi / 2;
    m.rate[MPS_SHIP_PITCH] = -0.7;
    assert_int_equal(mps_ship_to_tank(&ship, &m, &tank), MPS_OK);
    ASSERT_NEAR(tank.value[MPS_ROTATE_Z], pi / 2, 1e-15);
    ASSERT_NEAR(tank.rate[MPS_ROTATE_Z], 0.7, 1e-15);
    m.value[MPS_SHIP_PITCH] = -3;
    assert_int_equal(mps_ship_to_tank(&ship, &m, &tank), MPS_OK);
    ASSERT_NEAR(tank.value[MPS_ROTATE_Z], 3, 1e-15);
    m.value[MPS_SHIP_PITCH] = -pi / 2;
    m.value[MPS_SHIP_ROLL] = 0.1;
    tank.value[0] = 7;
    assert_int_equal(mps_ship_to_tank(&ship, &m, &tank), MPS_E_STATE);
    assert_true(tank.value[0] == 7);
}

static void bad_poses(void **state)
{
    (void)state;
    mps_motion_pose pose;
    mps_motion_state tank = {.struct_size = sizeof tank};
    assert_int_equal(mps_motion_pose_init(&pose, 4), MPS_E_ARG);
    assert_int_equal(mps_motion_pose_init(&pose, sizeof pose), MPS_OK);
    assert_int_equal(mps_motion_pose_to_state(&pose, &tank), MPS_OK);
    for (int d = 0; d < 6; d++) assert_true(tank.value[d] == 0);
    pose.rotation[0] = -1; /* a mirror */
    assert_int_equal(mps_motion_pose_to_state(&pose, &tank), MPS_E_ARG);
    pose.rotation[0] = 1.001;
    assert_int_equal(mps_motion_pose_to_state(&pose, &tank), MPS_E_ARG);
    pose.rotation[0] = NAN;
    assert_int_equal(mps_motion_pose_to_state(&pose, &tank), MPS_E_ARG);
    pose.rotation[0] = 1;
    pose.alpha[1] = INFINITY;
    assert_int_equal(mps_motion_pose_to_state(&pose, &tank), MPS_E_ARG);
    pose.alpha[1] = 0;
    assert_int_equal(mps_motion_pose_to_state(NULL, &tank), MPS_E_ARG);
    assert_int_equal(mps_motion_pose_to_state(&pose, NULL), MPS_E_ARG);
    assert_int_equal(mps_motion_pose_from_state(NULL, &pose), MPS_E_ARG);
    tank.value[4] = NAN;
    assert_int_equal(mps_motion_pose_from_state(&tank, &pose), MPS_E_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_ships),
        cmocka_unit_test(bad_arguments),
        cmocka_unit_test(a_quarter_turn),
        cmocka_unit_test(bad_poses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
