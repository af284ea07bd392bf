/* SPDX-License-Identifier: BSD-3-Clause */
/* Dry friction of a rigid body that carries the tank. A full box moves with its liquid as a rigid
 * body: turning points and sticking are known. */
#include "tank_fixture.h"
#include <stdbool.h>
#include <stdio.h>

static const double width = 0.8, height = 0.5, dp = 0.1, dt = 2e-3, mass = 100;
enum { FULL = 400 }; /* kg/m of water in it */

static mps_sim *box(double depth, const double centre[3])
{
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, width, height, 0);
    fill_depth(sim, width, depth, 0.4);
    if (centre) ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

static mps_body body_of(int32_t dof)
{
    mps_body b;
    assert_int_equal(mps_body_init(&b, sizeof b), MPS_OK);
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

static mps_body_report next(mps_sim *sim)
{
    ASSERT_OK(sim, mps_step(sim, dt, NULL));
    return report_of(sim);
}

static double imbalance(const mps_body_report *r)
{
    return r->kinetic + r->spring + r->weight -
           (r->start + r->external_work + r->liquid_work - r->damped - r->rubbed);
}

/* Coulomb's law of a degree, to the last digit but for a rest. */
static void law(const mps_body_report *r, int32_t dof, double most)
{
    if (r->velocity[dof] == 0)
        assert_true(fabs(r->friction[dof]) <= most * (1 + 1e-9));
    else
        assert_true(r->friction[dof] == (r->velocity[dof] > 0 ? -most : most));
}

/* Follows a rigid body from turning point to turning point. A turning point may last one step; two
 * steps are sticking. */
typedef struct follower {
    double last, way, before; /* pose, path, latest velocity that was not 0 */
    int turns, still;
    double turned[2]; /* positions of the last two turning points */
} follower;

/* @return whether it has reversed or stuck */
static bool follow(follower *f, const mps_body_report *r, int32_t dof)
{
    const double v = r->velocity[dof];
    const bool turns = v * f->before < 0, rests = v == 0 && f->still == 1;
    f->way += fabs(r->pose[dof] - f->last);
    f->still = v == 0 && f->before != 0 ? f->still + 1 : 0;
    if (turns || rests) {
        f->turns++;
        f->turned[0] = f->turned[1];
        f->turned[1] = f->last;
    }
    if (v != 0) f->before = v;
    f->last = r->pose[dof];
    return turns || rests;
}

/* A block on a spring: its amplitude falls by 2 F/k each half period, 4 F/k a period, until |k
 * (x - x0)| <= F at a turning point; then it rests for ever. */
static void block(void **state)
{
    const double stiffness = 4e4, offset = 0.05, most = 180; /* F/k = 4.5 mm */
    mps_sim *sim = box(height, NULL);
    mps_body b = body_of(MPS_MOVE_X);
    double amplitude = offset;
    follower f = {.last = 0};
    (void)state;
    b.stiffness[0] = stiffness;
    b.equilibrium[0] = offset;
    b.friction[MPS_MOVE_X] = most;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    for (int n = 0; n < 1300; n++) {
        const mps_body_report r = next(sim);
        const bool rested = f.still >= 2;
        law(&r, MPS_MOVE_X, most);
        if (follow(&f, &r, MPS_MOVE_X)) {
            amplitude -= 2 * most / stiffness;
            ASSERT_NEAR(fabs(f.turned[1] - offset), fabs(amplitude), 2e-3 * offset);
        }
        ASSERT_NEAR(imbalance(&r), 0, 1e-9 * r.start);
        ASSERT_NEAR(r.rubbed, most * f.way, 0.01 * most * offset);
        if (!rested) continue;
        assert_true(r.velocity[0] == 0 && r.pose[0] == f.turned[1]);
        ASSERT_NEAR(r.friction[0], stiffness * (r.pose[0] - offset), 2);
    }
    /* 50, 41, 32, 23, 14, 5 mm; then 4 mm on the other side, within 4.5 mm */
    assert_int_equal(f.turns, 6);
    assert_true(f.still > 100 && fabs(stiffness * (f.last - offset)) < most);
    mps_sim_destroy(sim);
}

/* A pendulum whose axis has dry friction M: between turning points (m + FULL) g l (cos a - cos
 * b) = M |a - b|. */
static void pendulum(void **state)
{
    const double centre[3] = {0.4, 1.25, 0}, start = 0.2, most = 300, heavy = 2000,
                 weight = (heavy + FULL) * 9.81;
    mps_sim *sim = box(height, centre);
    mps_body b = body_of(MPS_ROTATE_Z);
    const double time[2] = {0, 1}, tilt[2] = {start, start};
    const int32_t turn = MPS_ROTATE_Z;
    follower f = {.last = start, .turned = {0, start}};
    (void)state;
    b.mass = heavy; /* the loss of the liquid is small in comparison */
    b.centre_of_mass[0] = 0.4;
    b.centre_of_mass[1] = 0.25;
    b.inertia[8] = 3;
    b.friction[MPS_ROTATE_Z] = most;
    ASSERT_OK(sim, mps_motion_table_set(sim, 2, time, 1, &turn, tilt));
    ASSERT_OK(sim, mps_body_set(sim, &b));
    for (int n = 0; n < 6000 && f.still < 3; n++) {
        const mps_body_report r = next(sim);
        law(&r, MPS_ROTATE_Z, most);
        if (!follow(&f, &r, MPS_ROTATE_Z)) continue;
        const double lost = weight * (cos(f.turned[1]) - cos(f.turned[0])),
                     rubbed = most * fabs(f.turned[1] - f.turned[0]);
        ASSERT_NEAR(lost, rubbed, 0.03 * rubbed);
    }
    /* the amplitude falls by 2 M/(m g l) = 0.0255 each half period */
    assert_int_equal(f.turns, 8);
    assert_true(f.still >= 2 && fabs(weight * sin(f.last)) < most);
    mps_sim_destroy(sim);
}

static int push(void *user, double t, const mps_motion_state *state, double load[6])
{
    (void)t;
    (void)state;
    load[MPS_MOVE_X] = *(double *)user;
    return 0;
}

/* A force below F moves nothing, to the last digit; one above it moves with (P - F)/(m + M);
 * then it stops. */
static void sticks(void **state)
{
    double force = 49.9;
    mps_sim *sim = box(height, NULL);
    mps_body b = body_of(MPS_MOVE_X);
    (void)state;
    b.load = push;
    b.user = &force;
    b.friction[MPS_MOVE_X] = 50;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    for (int n = 0; n < 50; n++) {
        const mps_body_report r = next(sim);
        assert_true(r.pose[0] == 0 && r.velocity[0] == 0 && r.rubbed == 0);
        ASSERT_NEAR(r.friction[0], -49.9, 1e-6);
    }
    force = 80;
    for (int n = 0; n < 50; n++) {
        const mps_body_report r = next(sim);
        ASSERT_NEAR(r.acceleration[0], 30.0 / (mass + FULL), 1e-4);
        assert_true(r.friction[0] == -50);
    }
    const double speed = report_of(sim).velocity[0];
    force = 0;
    /* v/(F/m) = 60 steps, then rest at once and for ever */
    double at = 0;
    for (int n = 1; n <= 60; n++) {
        const mps_body_report r = next(sim);
        ASSERT_NEAR(r.velocity[0], fmax(0, speed - n * dt * 50 / (mass + FULL)), 1e-5);
        assert_true(n < 32 || r.velocity[0] == 0);
        assert_true(n < 33 || r.pose[0] == at);
        at = r.pose[0];
    }
    mps_sim_destroy(sim);
}

/* Waves in a half-filled tank make it stick and slip; both degrees of freedom obey the law in each
 * step, with springs and dampers in addition. A snapshot and a checkpoint continue with the same
 * bytes. */
static void waves(void **state)
{
    static const char path[] = "friction.checkpoint";
    const double centre[3] = {0.4, 0.1, 0}, most[2] = {150, 40};
    double force = 40;
    mps_sim *sim = box(0.3, centre), *other = box(0.3, centre);
    mps_body b = body_of(MPS_MOVE_X);
    mps_snapshot *k = NULL;
    int rests[2] = {0}, moves[2] = {0};
    (void)state;
    b.free |= MPS_BODY_FREE(MPS_ROTATE_Z);
    b.inertia[8] = 20;
    b.stiffness[0] = 2000;
    b.stiffness[35] = 4000;
    b.damping[35] = 2;
    b.friction[MPS_MOVE_X] = most[0];
    b.friction[MPS_ROTATE_Z] = most[1];
    b.load = push;
    b.user = &force;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    ASSERT_OK(other, mps_body_set(other, &b));
    for (int n = 0; n < 700; n++) {
        const mps_body_report r = next(sim);
        for (int i = 0; i < 2; i++) {
            const int32_t dof = i ? MPS_ROTATE_Z : MPS_MOVE_X;
            law(&r, dof, most[i]);
            *(r.velocity[dof] == 0 ? &rests[i] : &moves[i]) += 1;
        }
        ASSERT_NEAR(imbalance(&r), 0, 5e-3); /* rotations: second order */
        force = n % 200 < 100 ? 250 : 0;
    }
    fprintf(stderr, "%d %d %d %d\n", rests[0], rests[1], moves[0], moves[1]);
    for (int i = 0; i < 2; i++) assert_true(rests[i] > 20 && moves[i] > 20);
    ASSERT_OK(sim, mps_snapshot_create(sim, &k));
    ASSERT_OK(sim, mps_snapshot_take(k));
    ASSERT_OK(sim, mps_checkpoint_write(sim, path));
    ASSERT_OK(other, mps_checkpoint_read(other, path));
    mps_body_report one, two, three;
    for (int n = 0; n < 60; n++) one = next(sim);
    for (int n = 0; n < 60; n++) two = next(other);
    ASSERT_OK(sim, mps_snapshot_restore(k));
    for (int n = 0; n < 60; n++) three = next(sim);
    assert_memory_equal(&one, &two, sizeof one);
    assert_memory_equal(&one, &three, sizeof one);
    mps_snapshot_destroy(k);
    mps_sim_destroy(other);
    mps_sim_destroy(sim);
    remove(path);
}

static void refused(void **state)
{
    mps_sim *sim = box(height, NULL);
    mps_body b = body_of(MPS_MOVE_X);
    (void)state;
    b.friction[3] = -1;
    ASSERT_REFUSED(sim, mps_body_set(sim, &b), MPS_E_ARG, "mps_body.friction[3] is -1");
    b.friction[3] = INFINITY;
    ASSERT_REFUSED(sim, mps_body_set(sim, &b), MPS_E_ARG, "mps_body.friction[3]");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(block), cmocka_unit_test(pendulum),
                                       cmocka_unit_test(sticks), cmocka_unit_test(waves),
                                       cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
