/* SPDX-License-Identifier: BSD-3-Clause */
/* A ship's six degrees of freedom: against Rodrigues' formula on skew axes, by virtual work, round
 * trips, signs, tables. */
#include "tank_fixture.h"

static const double pi = 3.14159265358979323846;

enum { SHIPS = 48 };

/* ---- vectors and matrices, independent of the library ---- */

static double draw(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1; /* -1..1 */
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* x rotated by an angle about a unit vector e: x cos + (e x x) sin + e (e.x) (1 - cos). */
static void rodrigues(const double *e, double angle, const double *x, double *out)
{
    double across[3];
    cross(e, x, across);
    const double c = cos(angle), s = sin(angle), along = dot(e, x) * (1 - c);
    for (int d = 0; d < 3; d++) out[d] = c * x[d] + s * across[d] + along * e[d];
}

static void rotate(const double *R, const double *x, double *out)
{
    for (int d = 0; d < 3; d++) out[d] = dot(R + 3 * d, x);
}

/* e1, e2, e3 as the header defines them. */
static void ship_axes(const mps_ship *ship, double e[3][3])
{
    const double f = sqrt(dot(ship->forward, ship->forward)), u = sqrt(dot(ship->up, ship->up)),
                 sign = ship->axes == MPS_SHIP_Z_DOWN ? -1 : 1;
    for (int d = 0; d < 3; d++) {
        e[0][d] = ship->forward[d] / f;
        e[2][d] = sign * ship->up[d] / u;
    }
    cross(e[2], e[0], e[1]);
}

/* ---- ships and motions of any kind ---- */

static mps_ship usual_ship(void)
{
    mps_ship ship;
    assert_int_equal(mps_ship_init(&ship, sizeof ship), MPS_OK);
    return ship;
}

/* Skew axes, all orders, both directions, both units. */
static mps_ship skew_ship(uint64_t *seed, int k)
{
    static const int32_t order[6][3] = {{5, 4, 3}, {3, 4, 5}, {4, 5, 3},
                                        {4, 3, 5}, {5, 3, 4}, {3, 5, 4}};
    mps_ship ship = usual_ship();
    double any[3];
    memcpy(ship.order, order[k % 6], sizeof ship.order);
    ship.axes = k / 6 % 2;
    ship.degrees = k / 12 % 2;
    for (int d = 0; d < 3; d++) {
        ship.forward[d] = 3 * draw(seed);
        any[d] = draw(seed);
        ship.origin[d] = draw(seed);
    }
    cross(ship.forward, any, ship.up);
    return ship;
}

static mps_ship_motion some_motion(uint64_t *seed, const mps_ship *ship)
{
    const double unit = ship->degrees ? 180 / pi : 1;
    mps_ship_motion m = {.struct_size = sizeof m};
    for (int d = 0; d < 6; d++) {
        const double scale = d < 3 ? 1 : d == ship->order[1] ? 1.2 * unit : 3 * unit;
        m.value[d] = scale * draw(seed);
        m.rate[d] = (d < 3 ? 1 : unit) * draw(seed);
        m.accel[d] = (d < 3 ? 1 : unit) * draw(seed);
    }
    return m;
}

static mps_motion_state tank_of(const mps_ship *ship, const mps_ship_motion *m)
{
    mps_motion_state tank = {.struct_size = sizeof tank};
    assert_int_equal(mps_ship_to_tank(ship, m, &tank), MPS_OK);
    return tank;
}

static mps_motion_pose pose_of(const mps_motion_state *tank)
{
    mps_motion_pose pose = {.struct_size = sizeof pose};
    assert_int_equal(mps_motion_pose_from_state(tank, &pose), MPS_OK);
    return pose;
}

/* ---- tests ---- */

/* R is the product of three rotations about the axes at rest, the first rotation last; also by
 * intrinsic rotations. */
static void composes_on_skew_axes(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int k = 0; k < SHIPS; k++) {
        const mps_ship ship = skew_ship(&seed, k);
        const mps_ship_motion m = some_motion(&seed, &ship);
        const mps_motion_state tank = tank_of(&ship, &m);
        const mps_motion_pose pose = pose_of(&tank);
        const double unit = ship.degrees ? pi / 180 : 1, x[3] = {0.3, -0.8, 0.5};
        double e[3][3], fixed[3] = {0.3, -0.8, 0.5}, along[3] = {0.3, -0.8, 0.5}, got[3];
        ship_axes(&ship, e);
        for (int d = 0; d < 3; d++)
            ASSERT_NEAR(pose.translation[d],
                        m.value[0] * e[0][d] + m.value[1] * e[1][d] + m.value[2] * e[2][d], 1e-12);
        for (int n = 2; n >= 0; n--)
            rodrigues(e[ship.order[n] - 3], m.value[ship.order[n]] * unit, fixed, fixed);
        for (int n = 0; n < 3; n++) {
            double axis[3];
            memcpy(axis, e[ship.order[n] - 3], sizeof axis);
            for (int b = 0; b < 3; b++) rodrigues(axis, m.value[ship.order[n]] * unit, e[b], e[b]);
            rodrigues(axis, m.value[ship.order[n]] * unit, along, along);
        }
        rotate(pose.rotation, x, got);
        for (int d = 0; d < 3; d++) {
            ASSERT_NEAR(got[d], fixed[d], 1e-12);
            ASSERT_NEAR(got[d], along[d], 1e-12);
        }
    }
}

static int sail(void *user, double t, mps_motion_state *tank)
{
    (void)t;
    const mps_motion_state *wanted = user;
    memcpy(tank, wanted, sizeof *tank);
    return 0;
}

/* A tank whose centre is the origin of the ship maps a point to o + s + R (X - o), with the
 * velocity of a rigid body. */
static void carries_a_tank(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int k = 0; k < SHIPS; k += 7) {
        const mps_ship ship = skew_ship(&seed, k);
        const mps_ship_motion m = some_motion(&seed, &ship);
        mps_motion_state tank = tank_of(&ship, &m);
        const mps_motion_pose pose = pose_of(&tank);
        const double X[3] = {1.1, 0.4, -0.6};
        double x[3], v[3], arm[3], turned[3], turning[3];
        mps_sim *sim = new_sim(3, 0.1);
        ASSERT_OK(sim, mps_motion_centre_set(sim, ship.origin, MPS_START_AT_REST));
        ASSERT_OK(sim, mps_motion_callback_set(sim, sail, &tank));
        ASSERT_OK(sim, mps_motion_to_lab(sim, X, x, v));
        for (int d = 0; d < 3; d++) arm[d] = X[d] - ship.origin[d];
        rotate(pose.rotation, arm, turned);
        cross(pose.omega, turned, turning);
        for (int d = 0; d < 3; d++) {
            ASSERT_NEAR(x[d], ship.origin[d] + pose.translation[d] + turned[d], 1e-12);
            ASSERT_NEAR(v[d], pose.velocity[d] + turning[d], 1e-12);
        }
        mps_sim_destroy(sim);
    }
}

/* The motion after t seconds: derivatives of m are those of this polynomial at 0. */
static mps_ship_motion later(const mps_ship_motion *m, double t)
{
    mps_ship_motion next = *m;
    for (int d = 0; d < 6; d++) {
        next.value[d] = m->value[d] + t * m->rate[d] + 0.5 * t * t * m->accel[d];
        next.rate[d] = m->rate[d] + t * m->accel[d];
    }
    return next;
}

/* dR/dt = omega x R, and alpha is the derivative of omega; so are the rates of the tank's angles
 * those of its angles. */
static void rates_are_derivatives(void **state)
{
    (void)state;
    const double h = 1e-4;
    uint64_t seed = 3;
    for (int k = 0; k < SHIPS; k++) {
        const mps_ship ship = skew_ship(&seed, k);
        const mps_ship_motion m = some_motion(&seed, &ship);
        const mps_ship_motion before = later(&m, -h), after = later(&m, h);
        const mps_motion_state a = tank_of(&ship, &before), b = tank_of(&ship, &after),
                               now = tank_of(&ship, &m);
        const mps_motion_pose pa = pose_of(&a), pb = pose_of(&b), p = pose_of(&now);
        if (fabs(cos(now.value[MPS_ROTATE_Z])) < 0.1)
            continue; /* the angles of the tank are steep */
        for (int d = 0; d < 3; d++) {
            const double column[3] = {p.rotation[d], p.rotation[3 + d], p.rotation[6 + d]};
            double rate[3];
            cross(p.omega, column, rate);
            for (int row = 0; row < 3; row++)
                ASSERT_NEAR((pb.rotation[3 * row + d] - pa.rotation[3 * row + d]) / (2 * h),
                            rate[row], 1e-6);
            ASSERT_NEAR((pb.omega[d] - pa.omega[d]) / (2 * h), p.alpha[d], 1e-6);
            ASSERT_NEAR((pb.velocity[d] - pa.velocity[d]) / (2 * h), p.accel[d], 1e-6);
        }
        for (int d = 0; d < MPS_DOF_COUNT; d++) {
            const double step = b.value[d] - a.value[d];
            if (fabs(step) > 1) continue; /* beyond 180 degrees */
            ASSERT_NEAR(step / (2 * h), now.rate[d], 1e-3);
            ASSERT_NEAR((b.rate[d] - a.rate[d]) / (2 * h), now.accel[d], 1e-2);
        }
    }
}

static void there_and_back(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int k = 0; k < SHIPS; k++) {
        const mps_ship ship = skew_ship(&seed, k);
        const mps_ship_motion m = some_motion(&seed, &ship);
        const mps_motion_state tank = tank_of(&ship, &m);
        const mps_motion_pose pose = pose_of(&tank);
        const double unit = ship.degrees ? 180 / pi : 1;
        const double steep = fabs(cos(tank.value[MPS_ROTATE_Z])), least = 1e-12 / (steep * steep);
        mps_ship_motion back = {.struct_size = sizeof back};
        mps_motion_state again = {.struct_size = sizeof again};
        assert_int_equal(mps_ship_from_tank(&ship, &tank, &back), MPS_OK);
        assert_int_equal(mps_motion_pose_to_state(&pose, &again), MPS_OK);
        for (int d = 0; d < 6; d++) {
            const double e = (d < 3 ? 1 : unit) * least;
            ASSERT_NEAR(back.value[d], m.value[d], e);
            ASSERT_NEAR(back.rate[d], m.rate[d], 10 * e);
            ASSERT_NEAR(back.accel[d], m.accel[d], 100 * e);
            ASSERT_NEAR(again.value[d], tank.value[d], least);
            ASSERT_NEAR(again.rate[d], tank.rate[d], 100 * least);
            ASSERT_NEAR(again.accel[d], tank.accel[d], 1000 * least);
        }
    }
}

/* F.v + M.omega of a load about any point of the tank is the same in the lab, along fixed axes and
 * along those of the body. */
static void virtual_work(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int k = 0; k < SHIPS; k++) {
        const mps_ship ship = skew_ship(&seed, k);
        const mps_ship_motion m = some_motion(&seed, &ship);
        const mps_motion_state tank = tank_of(&ship, &m);
        const mps_motion_pose pose = pose_of(&tank);
        double lab[6], at[3], arm[3], turned[3], v[3];
        for (int d = 0; d < 6; d++) lab[d] = draw(&seed);
        for (int d = 0; d < 3; d++) at[d] = 2 * draw(&seed);
        for (int d = 0; d < 3; d++) arm[d] = at[d] - ship.origin[d];
        rotate(pose.rotation, arm, turned);
        cross(pose.omega, turned, v);
        for (int d = 0; d < 3; d++) v[d] += pose.velocity[d];
        const double work = dot(lab, v) + dot(lab + 3, pose.omega);
        for (int32_t axes = MPS_SHIP_FIXED; axes <= MPS_SHIP_BODY; axes++) {
            double load[6], back[6], u[3], w[3];
            assert_int_equal(mps_ship_load_from_lab(&ship, &tank, axes, at, lab, load), MPS_OK);
            assert_int_equal(mps_ship_vector_from_lab(&ship, &tank, axes, pose.velocity, u),
                             MPS_OK);
            assert_int_equal(mps_ship_vector_from_lab(&ship, &tank, axes, pose.omega, w), MPS_OK);
            ASSERT_NEAR(dot(load, u) + dot(load + 3, w), work, 1e-12);
            assert_int_equal(mps_ship_load_to_lab(&ship, &tank, axes, at, load, back), MPS_OK);
            for (int d = 0; d < 6; d++) ASSERT_NEAR(back[d], lab[d], 1e-12);
            const double rates[3] = {u[0], u[1], u[2]};
            assert_int_equal(mps_ship_vector_to_lab(&ship, &tank, axes, u, u), MPS_OK);
            for (int d = 0; d < 3; d++) ASSERT_NEAR(u[d], pose.velocity[d], 1e-12);
            for (int d = 0; d < 3 && axes == MPS_SHIP_FIXED; d++)
                ASSERT_NEAR(rates[d], m.rate[d], 1e-12); /* of surge, sway, heave */
        }
    }
}

/* Displacement of a point beside, in front of or above the origin, in the axes x forward, y up, z
 * to starboard of the usual ship. */
static void signs(void **state)
{
    (void)state;
    const double small = 0.01;
    const struct {
        int32_t axes, dof;
        double point[3];
        int moves; /* 1, 2, 3: to +x, +y, +z; negative: the other way */
    } list[] = {
        {MPS_SHIP_Z_UP, MPS_SHIP_SURGE, {0, 0, 0}, 1},
        {MPS_SHIP_Z_UP, MPS_SHIP_SWAY, {0, 0, 0}, -3},  /* to port */
        {MPS_SHIP_Z_UP, MPS_SHIP_HEAVE, {0, 0, 0}, 2},  /* up */
        {MPS_SHIP_Z_UP, MPS_SHIP_ROLL, {0, 0, 1}, -2},  /* starboard down */
        {MPS_SHIP_Z_UP, MPS_SHIP_PITCH, {1, 0, 0}, -2}, /* bow down */
        {MPS_SHIP_Z_UP, MPS_SHIP_YAW, {1, 0, 0}, -3},   /* bow to port */
        {MPS_SHIP_Z_DOWN, MPS_SHIP_SURGE, {0, 0, 0}, 1},
        {MPS_SHIP_Z_DOWN, MPS_SHIP_SWAY, {0, 0, 0}, 3},   /* to starboard */
        {MPS_SHIP_Z_DOWN, MPS_SHIP_HEAVE, {0, 0, 0}, -2}, /* down */
        {MPS_SHIP_Z_DOWN, MPS_SHIP_ROLL, {0, 0, 1}, -2},  /* starboard down */
        {MPS_SHIP_Z_DOWN, MPS_SHIP_PITCH, {1, 0, 0}, 2},  /* bow up */
        {MPS_SHIP_Z_DOWN, MPS_SHIP_YAW, {1, 0, 0}, 3},    /* bow to starboard */
    };
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        mps_ship ship = usual_ship();
        mps_ship_motion m = {.struct_size = sizeof m};
        double x[3];
        ship.axes = list[k].axes;
        m.value[list[k].dof] = small;
        const mps_motion_state tank = tank_of(&ship, &m);
        const mps_motion_pose pose = pose_of(&tank);
        rotate(pose.rotation, list[k].point, x);
        for (int d = 0; d < 3; d++) {
            const double way = x[d] + pose.translation[d] - list[k].point[d];
            const int wanted = list[k].moves == d + 1 ? 1 : list[k].moves == -d - 1 ? -1 : 0;
            ASSERT_NEAR(way, wanted * small, small * small);
        }
    }
}

/* With the bow along x a ship's angles are those of the tank, but for the sign of the pitch. */
static void usual_order_is_the_tanks(void **state)
{
    (void)state;
    const mps_ship ship = usual_ship();
    const mps_ship_motion m = {.struct_size = sizeof m, .value = {0.1, 0.2, 0.3, 0.4, 0.5, 2.6}};
    const mps_motion_state tank = tank_of(&ship, &m);
    ASSERT_NEAR(tank.value[MPS_MOVE_X], 0.1, 1e-15);
    ASSERT_NEAR(tank.value[MPS_MOVE_Y], 0.3, 1e-15);
    ASSERT_NEAR(tank.value[MPS_MOVE_Z], -0.2, 1e-15);
    ASSERT_NEAR(tank.value[MPS_ROTATE_X], 0.4, 1e-14);
    ASSERT_NEAR(tank.value[MPS_ROTATE_Y], 2.6, 1e-14);
    ASSERT_NEAR(tank.value[MPS_ROTATE_Z], -0.5, 1e-14);
}

/* A cross-section seen from aft: x to starboard, y up, the bow along -z. It may capsize. */
static void section_in_2d(void **state)
{
    (void)state;
    const int32_t dof[3] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    const double t[4] = {0, 1, 2, 3}, six[24] = {0, 0, 0, 0,   0, 0, 0, -0.1, 0.2, 90,  0, 0,
                                                 0, 0, 0, 180, 0, 0, 0, 0,    0,   300, 0, 0};
    double values[12];
    mps_ship ship = usual_ship();
    mps_sim *sim = new_sim(2, 0.1);
    ship.forward[0] = 0;
    ship.forward[2] = -1;
    ship.degrees = 1;
    assert_int_equal(mps_ship_table(&ship, 4, six, 3, dof, values), MPS_OK);
    ASSERT_NEAR(values[3], 0.1, 1e-15); /* sway to port is negative here */
    ASSERT_NEAR(values[4], 0.2, 1e-15);
    for (int k = 0; k < 4; k++) ASSERT_NEAR(values[3 * k + 2], -six[6 * k + 3] * pi / 180, 1e-14);
    ASSERT_OK(sim, mps_motion_table_set(sim, 4, t, 3, dof, values));
    mps_sim_destroy(sim);
    /* what 2-D does not have */
    double pitched[6] = {0, 0, 0, 0, 1, 0};
    const double before = values[2];
    assert_int_equal(mps_ship_table(&ship, 1, pitched, 3, dof, values), MPS_E_ARG);
    ASSERT_NEAR(values[2], before, 0);
}

/* A heading that passes 180 degrees is continuous, also in the column of the table. */
static void heading_goes_round(void **state)
{
    (void)state;
    enum { ROWS = 50 };
    const int32_t dof[6] = {0, 1, 2, 3, 4, 5};
    double six[6 * ROWS] = {0}, values[6 * ROWS];
    mps_ship ship = usual_ship();
    ship.degrees = 1;
    for (int k = 0; k < ROWS; k++) {
        six[6 * k + MPS_SHIP_YAW] = 20 * k;
        six[6 * k + MPS_SHIP_ROLL] = 5;
    }
    assert_int_equal(mps_ship_table(&ship, ROWS, six, 6, dof, values), MPS_OK);
    for (int k = 0; k < ROWS; k++) {
        ASSERT_NEAR(values[6 * k + MPS_ROTATE_Y], 20 * k * pi / 180, 1e-12);
        ASSERT_NEAR(values[6 * k + MPS_ROTATE_X], 5 * pi / 180, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(composes_on_skew_axes),
        cmocka_unit_test(carries_a_tank),
        cmocka_unit_test(rates_are_derivatives),
        cmocka_unit_test(there_and_back),
        cmocka_unit_test(virtual_work),
        cmocka_unit_test(signs),
        cmocka_unit_test(usual_order_is_the_tanks),
        cmocka_unit_test(section_in_2d),
        cmocka_unit_test(heading_goes_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
