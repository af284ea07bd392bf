/* SPDX-License-Identifier: BSD-3-Clause */
/* A rigid body that carries the tank. A full box moves with its liquid as a rigid body: its mass is
 * known. */
#include "tank_fixture.h"
#include <stdio.h>

static const double width = 0.8, height = 0.5, dp = 0.05;
enum { FULL = 400 }; /* kg/m of water in it */

static mps_sim *box(int32_t dim, double depth, const double centre[3])
{
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, width, height, dim == 3 ? 0.4 : 0);
    fill_depth(sim, width, depth, 0.4);
    if (centre) ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

static mps_body body_of(int32_t dof, double mass)
{
    mps_body b;
    assert_int_equal(mps_body_init(&b, sizeof b), MPS_OK);
    assert_int_equal(b.gravity, 1);
    b.free = MPS_BODY_FREE(dof);
    b.mass = mass;
    return b;
}

static mps_body_report report_of(mps_sim *sim)
{
    mps_body_report r;
    assert_int_equal(mps_body_report_init(&r, sizeof r), MPS_OK);
    ASSERT_OK(sim, mps_body_get(sim, &r));
    return r;
}

static double energy_of(const mps_body_report *r)
{
    return r->kinetic + r->spring + r->weight;
}

static double balance_of(const mps_body_report *r)
{
    return r->start + r->external_work + r->liquid_work - r->damped;
}

/* ---- one degree of freedom ---- */

/* x'' (M + liquid) = -K (x - x0): the scheme has tan(w' dt/2) = w dt/2, and no damping. */
static void spring(void **state)
{
    const double dt = 2e-3, stiffness = 4e4, offset = 0.01;
    static const double mass[] = {100, 4, 0}; /* A/M: 4, 100, any */
    (void)state;
    for (int k = 0; k < 3; k++) {
        mps_sim *sim = box(2, height, NULL);
        mps_body b = body_of(MPS_MOVE_X, mass[k]);
        b.stiffness[0] = stiffness;
        b.equilibrium[0] = offset;
        ASSERT_OK(sim, mps_body_set(sim, &b));
        const double w = sqrt(stiffness / (mass[k] + FULL)), turn = 2 * atan(w * dt / 2),
                     most = 0.5 * stiffness * offset * offset;
        for (int n = 1; n <= 400; n++) {
            ASSERT_OK(sim, mps_step(sim, dt, NULL));
            const mps_body_report r = report_of(sim);
            /* rates are means over steps, so the rest was half a step before the start */
            const double exact = offset * (1 - cos(turn * (n + 0.5)) / cos(0.5 * turn));
            ASSERT_NEAR(r.pose[0], exact, 2e-3 * offset);
            ASSERT_NEAR(r.mass[0], FULL, 1e-3 * FULL);
            ASSERT_NEAR(energy_of(&r), balance_of(&r), 1e-9 * most);
            ASSERT_NEAR(energy_of(&r) + 0.5 * FULL * r.velocity[0] * r.velocity[0], most,
                        0.02 * most);
            ASSERT_NEAR(r.liquid[0], -FULL * r.acceleration[0], 1e-3 * stiffness * offset);
            ASSERT_NEAR(r.late[0], 0, 1e-3 * stiffness * offset);
        }
        mps_sim_destroy(sim);
    }
}

typedef struct push {
    double load[6];
    int calls, fails;
} push;

static int apply(void *user, double t, const mps_motion_state *state, double load[6])
{
    push *p = user;
    (void)t;
    p->calls++;
    for (int k = 0; k < 6; k++) {
        if (load[k] != 0 || state->struct_size != sizeof *state) return 99;
        load[k] = p->load[k];
    }
    return p->fails;
}

/* A steady force, a damper, weights. */
static void forces(void **state)
{
    push p = {.load = {10, 0, 0, 0, 0, 0}};
    mps_sim *sim = box(2, height, NULL);
    mps_body b = body_of(MPS_MOVE_X, 100);
    (void)state;
    b.load = apply;
    b.user = &p;
    b.damping[0] = 200;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    const double dt = 2e-3, rate = 200.0 / 500;
    for (int n = 1; n <= 500; n++) {
        ASSERT_OK(sim, mps_step(sim, dt, NULL));
        const mps_body_report r = report_of(sim);
        ASSERT_NEAR(r.velocity[0], 10.0 / 200 * (1 - exp(-rate * n * dt)), 1e-4 * 10.0 / 200);
        ASSERT_NEAR(energy_of(&r), balance_of(&r), 1e-9);
        assert_true(r.damped > 0 && r.damped < r.external_work);
        assert_true(r.external[0] == 10 && p.calls == n);
    }
    mps_sim_destroy(sim);
    /* weights of both, then of the liquid alone: g, and g 400/500 */
    for (int own = 0; own < 2; own++) {
        sim = box(2, height, NULL);
        b = body_of(MPS_MOVE_Y, 100);
        b.gravity = own;
        ASSERT_OK(sim, mps_body_set(sim, &b));
        for (int n = 0; n < 20; n++) ASSERT_OK(sim, mps_step(sim, dt, NULL));
        const mps_body_report r = report_of(sim);
        ASSERT_NEAR(r.acceleration[1], own ? -9.81 : -9.81 * 0.8, 1e-3 * 9.81);
        ASSERT_NEAR(energy_of(&r), balance_of(&r), 1e-9 * r.kinetic);
        assert_true(own ? r.weight < 0 : r.weight == 0);
        mps_sim_destroy(sim);
    }
}

/* A full box that hangs 1 m below its axis: w2 = (m + M) g l/(A + I + M l2), A about the axis from
 * the report, against theory: the liquid does not rotate, except for its moment, rho (I_polar -
 * torsion constant) = 9.29 kg m2/m at fine spacing. */
static void pendulum(void **state)
{
    const double centre[3] = {0.4, 1.25, 0}, mass = 50, dt = 4e-3, start = 0.02;
    mps_sim *sim = box(2, height, centre);
    mps_body b = body_of(MPS_ROTATE_Z, mass);
    (void)state;
    b.centre_of_mass[0] = 0.4;
    b.centre_of_mass[1] = 0.25;
    b.inertia[8] = 3;
    /* initial angle of the spring: equilibrium at `start` with g */
    const double moment = (mass + FULL) * 9.81;
    b.stiffness[35] = moment;
    b.equilibrium[MPS_ROTATE_Z] = start;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    double inertia = 0;
    for (int n = 1; n <= 500; n++) {
        ASSERT_OK(sim, mps_step(sim, dt, NULL));
        const mps_body_report r = report_of(sim);
        inertia = r.mass[35] + mass + 3;
        const double w = sqrt(2 * moment / inertia),
                     exact = 0.5 * start * (1 - cos(2 * atan(w * dt / 2) * n));
        ASSERT_NEAR(r.pose[MPS_ROTATE_Z], exact, 0.03 * start);
        ASSERT_NEAR(r.pose[0], 0, 0);
        ASSERT_NEAR(energy_of(&r), balance_of(&r), 1e-3 * 0.5 * moment * start * start);
    }
    ASSERT_NEAR(inertia, FULL + 9.29 + mass + 3, 0.01 * FULL);
    mps_sim_destroy(sim);
}

/* ---- in 3-D ---- */

/* Rotation about skew axes, without loads: Euler's equations by a Runge-Kutta method, axes of the
 * body. */
static void spin(const double inertia[3], double w[3], double R[9], double dt)
{
    double k[4][12] = {{0}};
    for (int s = 0; s < 4; s++) {
        const double part = s == 0 ? 0 : s == 3 ? dt : dt / 2;
        double v[3], A[9];
        for (int d = 0; d < 3; d++) v[d] = w[d] + (s ? part * k[s - 1][d] : 0);
        for (int d = 0; d < 9; d++) A[d] = R[d] + (s ? part * k[s - 1][3 + d] : 0);
        for (int d = 0; d < 3; d++) {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            k[s][d] = (inertia[e] - inertia[f]) * v[e] * v[f] / inertia[d];
            for (int r = 0; r < 3; r++) /* R' = R [w] */
                k[s][3 + 3 * r + d] = A[3 * r + e] * v[f] - A[3 * r + f] * v[e];
        }
    }
    for (int d = 0; d < 12; d++)
        *(d < 3 ? &w[d] : &R[d - 3]) += dt / 6 * (k[0][d] + 2 * k[1][d] + 2 * k[2][d] + k[3][d]);
}

static int turning(void *user, double t, mps_motion_state *s)
{
    const double *rate = user;
    for (int k = 0; k < 6; k++) {
        s->value[k] = t * rate[k];
        s->rate[k] = rate[k];
    }
    return 0;
}

static void top(void **state)
{
    const double centre[3] = {0.4, 0.25, 0.2}, inertia[3] = {2e5, 3e5, 4.5e5};
    double rate[6] = {0, 0, 0, 0.9, 0.7, -0.5}, R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
           w[3] = {0.9, 0.7, -0.5};
    mps_sim *sim = box(3, height, centre);
    mps_body b = body_of(MPS_MOVE_X, 1e6);
    mps_motion_state now;
    mps_motion_pose pose;
    (void)state;
    b.free = (1 << MPS_DOF_COUNT) - 1;
    for (int d = 0; d < 3; d++) {
        b.centre_of_mass[d] = centre[d];
        b.inertia[4 * d] = inertia[d];
    }
    b.gravity = 0;
    ASSERT_OK(sim, mps_motion_callback_set(sim, turning, rate));
    ASSERT_OK(sim, mps_body_set(sim, &b));
    const double dt = 4e-3, energy = report_of(sim).start;
    for (int n = 0; n < 125; n++) ASSERT_OK(sim, mps_step(sim, dt, NULL));
    for (int n = 0; n < 1250; n++) spin(inertia, w, R, dt / 10);
    assert_int_equal(mps_motion_state_init(&now, sizeof now), MPS_OK);
    assert_int_equal(mps_motion_pose_init(&pose, sizeof pose), MPS_OK);
    ASSERT_OK(sim, mps_motion_state_get(sim, &now));
    assert_int_equal(mps_motion_pose_from_state(&now, &pose), MPS_OK);
    /* rotation by half a radian; the effect of the liquid, 160 kg, is small */
    for (int d = 0; d < 9; d++) ASSERT_NEAR(pose.rotation[d], R[d], 5e-3);
    assert_true(fabs(R[1]) > 0.1 && fabs(R[5]) > 0.1);
    const mps_body_report r = report_of(sim);
    ASSERT_NEAR(r.kinetic, energy, 0.01 * energy);
    ASSERT_NEAR(energy_of(&r), balance_of(&r), 0.01 * energy);
    mps_sim_destroy(sim);
}

/* ---- what is kept ---- */

static mps_sim *sloshing(void)
{
    static push p = {.load = {30, 0, 0, 0, 0, 0}};
    const double centre[3] = {0.4, 0.1, 0};
    mps_sim *sim = box(2, 0.25, centre);
    mps_body b = body_of(MPS_MOVE_X, 20);
    b.free |= MPS_BODY_FREE(MPS_ROTATE_Z);
    b.inertia[8] = 2;
    b.stiffness[35] = 2000;
    b.damping[35] = 20;
    b.load = apply;
    b.user = &p;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    return sim;
}

static void same_bytes(mps_sim *a, mps_sim *b)
{
    const mps_body_report one = report_of(a), other = report_of(b);
    mps_lease x = {.struct_size = sizeof x}, y = x;
    assert_memory_equal(&one, &other, sizeof one);
    ASSERT_OK(a, mps_lease_begin(a, "velocity", MPS_READ, &x));
    ASSERT_OK(b, mps_lease_begin(b, "velocity", MPS_READ, &y));
    assert_int_equal(x.count, y.count);
    assert_memory_equal(x.data, y.data, (size_t)(2 * x.count) * sizeof(double));
    ASSERT_OK(a, mps_lease_end(a, &x));
    ASSERT_OK(b, mps_lease_end(b, &y));
}

static void go(mps_sim *sim, int steps)
{
    for (int n = 0; n < steps; n++) ASSERT_OK(sim, mps_step(sim, 2e-3, NULL));
}

static void goes_on(void **state)
{
    static const char path[] = "body.checkpoint";
    mps_sim *sim = sloshing(), *other = sloshing();
    mps_snapshot *k = NULL;
    (void)state;
    go(sim, 40);
    ASSERT_OK(sim, mps_snapshot_create(sim, &k));
    ASSERT_OK(sim, mps_snapshot_take(k));
    ASSERT_OK(sim, mps_checkpoint_write(sim, path));
    go(sim, 30);
    ASSERT_OK(other, mps_checkpoint_read(other, path));
    go(other, 30);
    same_bytes(sim, other);
    ASSERT_OK(sim, mps_snapshot_restore(k));
    go(sim, 30);
    same_bytes(sim, other);
    mps_sim_destroy(other);
    /* a checkpoint of a body is no checkpoint of a tank at rest */
    other = sloshing();
    ASSERT_OK(other, mps_body_set(other, NULL));
    ASSERT_REFUSED(other, mps_checkpoint_read(other, path), MPS_E_ARG, "by a body");
    mps_sim_destroy(other);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim);
    remove(path);
}

/* A failed step leaves the body unchanged; then it is stopped at its pose. */
static void fails_and_ends(void **state)
{
    push p = {.load = {30, 0, 0, 0, 0, 0}};
    mps_sim *sim = box(2, 0.25, NULL);
    mps_body b = body_of(MPS_MOVE_X, 20);
    mps_body_report r;
    (void)state;
    assert_int_equal(mps_body_report_init(&r, sizeof r), MPS_OK);
    ASSERT_REFUSED(sim, mps_body_get(sim, &r), MPS_E_STATE, "mps_body_set()");
    b.load = apply;
    b.user = &p;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    go(sim, 5);
    const mps_body_report before = report_of(sim);
    p.fails = 7;
    ASSERT_REFUSED(sim, mps_step(sim, 2e-3, NULL), MPS_E_PLUGIN, "failed with 7");
    p.fails = 0;
    p.load[0] = NAN;
    ASSERT_REFUSED(sim, mps_step(sim, 2e-3, NULL), MPS_E_PLUGIN, "load[0]");
    p.load[0] = 1e9; /* moves the walls by decimetres */
    ASSERT_REFUSED(sim, mps_step(sim, 2e-3, NULL), MPS_E_DIVERGED, "coupling");
    r = report_of(sim);
    assert_memory_equal(&r, &before, sizeof r);
    p.load[0] = 30;
    go(sim, 5);
    const double x = report_of(sim).pose[0];
    assert_true(x > before.pose[0]);
    ASSERT_OK(sim, mps_body_set(sim, NULL));
    ASSERT_OK(sim, mps_body_set(sim, NULL));
    go(sim, 5);
    mps_motion_state now;
    assert_int_equal(mps_motion_state_init(&now, sizeof now), MPS_OK);
    ASSERT_OK(sim, mps_motion_state_get(sim, &now));
    assert_true(now.value[0] == x && now.rate[0] == 0);
    mps_sim_destroy(sim);
}

/* A spring that pushes away, by more in a step than all masses resist. */
static void nothing_resists(void **state)
{
    mps_sim *sim = box(2, 0.25, NULL);
    mps_body b = body_of(MPS_MOVE_X, 0);
    (void)state;
    b.free |= MPS_BODY_FREE(MPS_MOVE_Y);
    b.stiffness[7] = -1e12;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "'MPS_MOVE_Y' of the body is free");
    b.stiffness[7] = 0;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    go(sim, 2);
    mps_sim_destroy(sim);
}

/* Where the second angle is a right one, the first and the third are one. */
static int upright(void *user, double t, mps_motion_state *s)
{
    (void)user, (void)t;
    s->value[MPS_ROTATE_Z] = 0.5 * acos(-1.0);
    return 0;
}

static void angles_are_one(void **state)
{
    mps_sim *sim = box(3, 0.25, NULL);
    mps_body b = body_of(MPS_ROTATE_X, 10);
    (void)state;
    b.inertia[0] = b.inertia[4] = b.inertia[8] = 10;
    ASSERT_OK(sim, mps_motion_callback_set(sim, upright, NULL));
    ASSERT_OK(sim, mps_body_set(sim, &b));
    go(sim, 1);
    b.free |= MPS_BODY_FREE(MPS_ROTATE_Y);
    ASSERT_OK(sim, mps_body_set(sim, &b));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE,
                   "'MPS_ROTATE_X' and 'MPS_ROTATE_Y' are one");
    mps_sim_destroy(sim);
}

/* Models without an added mass. */
static void models(void **state)
{
    mps_sim *sim = box(2, 0.25, NULL);
    const mps_body b = body_of(MPS_MOVE_X, 1);
    (void)state;
    ASSERT_OK(sim, mps_preset_use(sim, "imps.paper"));
    ASSERT_OK(sim, mps_body_set(sim, &b));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "source.volume");
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    go(sim, 2);
    mps_sim_destroy(sim);
}

/* ---- arguments ---- */

static void refused(mps_sim *sim, mps_body b, const char *word)
{
    ASSERT_REFUSED(sim, mps_body_set(sim, &b), MPS_E_ARG, word);
}

#define WITH(member, value, word) \
    do {                          \
        mps_body b_ = good;       \
        b_.member = (value);      \
        refused(sim, b_, (word)); \
    } while (0)

static void arguments(void **state)
{
    const mps_body good = body_of(MPS_MOVE_X, 1);
    mps_sim *sim = box(2, 0.25, NULL);
    mps_body b;
    mps_lease x = {.struct_size = sizeof x};
    (void)state;
    WITH(struct_size, 3, "mps_body_init");
    WITH(free, 0, "free is 0");
    WITH(free, 64, "1..63");
    WITH(free, MPS_BODY_FREE(MPS_ROTATE_X), "2-D");
    WITH(mass, -1, "mass");
    WITH(mass, NAN, "mass");
    WITH(centre_of_mass[1], INFINITY, "centre_of_mass[1]");
    WITH(inertia[8], -1, "negative moment");
    WITH(inertia[0], 1, "2-D");
    WITH(stiffness[35], NAN, "stiffness[35]");
    WITH(damping[7], INFINITY, "damping[7]");
    WITH(equilibrium[5], NAN, "equilibrium[5]");
    WITH(gravity, 2, "gravity");
    assert_int_equal(mps_body_init(NULL, sizeof b), MPS_E_ARG);
    assert_int_equal(mps_body_init(&b, 3), MPS_E_ARG);
    assert_int_equal(mps_body_set(NULL, &good), MPS_E_ARG);
    assert_int_equal(mps_body_get(NULL, NULL), MPS_E_ARG);
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &x));
    ASSERT_STATUS(sim, mps_body_set(sim, &good), MPS_E_BUSY);
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    /* the motion is unchanged */
    mps_motion_state now;
    assert_int_equal(mps_motion_state_init(&now, sizeof now), MPS_OK);
    ASSERT_OK(sim, mps_body_set(sim, &good));
    ASSERT_REFUSED(sim, mps_body_get(sim, NULL), MPS_E_ARG, "NULL");
    mps_body_report r = report_of(sim);
    r.struct_size = 3;
    ASSERT_REFUSED(sim, mps_body_get(sim, &r), MPS_E_ARG, "mps_body_report_init");
    assert_int_equal(mps_body_report_init(NULL, sizeof r), MPS_E_ARG);
    mps_sim_destroy(sim);
    sim = box(3, 0.25, NULL);
    WITH(inertia[1], 1, "symmetric");
    b = good;
    b.inertia[0] = b.inertia[4] = 1;
    b.inertia[1] = b.inertia[3] = 2;
    refused(sim, b, "negative moment: [0] is 1, [4] is 1, [1] is 2");
    /* about each pair of axes it is allowed, about (1, 1, 1) it is -0.8 */
    for (int k = 0; k < 9; k++) b.inertia[k] = k % 4 == 0 ? 1 : -0.9;
    refused(sim, b, "about some axis");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spring),    cmocka_unit_test(forces),
        cmocka_unit_test(pendulum),  cmocka_unit_test(top),
        cmocka_unit_test(goes_on),   cmocka_unit_test(fails_and_ends),
        cmocka_unit_test(arguments), cmocka_unit_test(nothing_resists),
        cmocka_unit_test(models),    cmocka_unit_test(angles_are_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
