/* SPDX-License-Identifier: BSD-3-Clause */
/* friction.history in simulations: free particles, on which only it and a given force act, against
 * exact unsteady flow between two plates; the energy balance; a rotating tank. */
#include "phase_fixture.h"
#include <complex.h>
#include <mps/output.h>
#include <stdbool.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846, NU = 5e-5, WIDTH = 0.062;

/* Acceleration of the particles: amount cos(rate t), along x, as its mean over a step; and, if the
 * tank rotates, that of the tank. */
static struct {
    double amount, rate;
    bool with_tank;
} drive;

static int push(mps_stage *s)
{
    const mps_view *v = s->view;
    double *a = s->data[0];
    const double *tank = s->data[1], half = 0.5 * drive.rate * v->dt;
    const double now = drive.amount * cos(drive.rate * v->t + half) *
                       (half > 0 ? sin(half) / half : 1);
    for (int64_t i = 0; i < v->n; i++) {
        if (v->kind[i] != MPS_FLUID) continue;
        a[2 * i] += now;
        for (int d = 0; d < 2 && drive.with_tank; d++) a[2 * i + d] += tank[2 * i + d];
    }
    return 0;
}

static const mps_use push_uses[] = {{"acceleration", MPS_USE_CHANGE},
                                    {"tank_acceleration", MPS_USE_READ}};
static const mps_verb push_verbs[] = {
    {.hook = MPS_FORCE, .use_count = 2, .uses = push_uses, .run = push}};
static const mps_model_ops pusher = {.struct_size = sizeof(mps_model_ops),
                                     .api = MPS_MODEL_API,
                                     .name = "push.test",
                                     .help = "a given force",
                                     .verb_count = 1,
                                     .verbs = push_verbs};

/* Free particles with the velocity (u, 0). */
static mps_sim *free_particles(double u, double dt)
{
    cloud c = cloud_lattice(2, 3, 3, 1, 0, 1);
    int32_t *phase = cloud_phases(c.n);
    double *first = cloud_doubles(2 * c.n);
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, dt);
    for (int64_t i = 0; i < c.n; i++) first[2 * i] = u;
    set_phase(sim, 0, 900, 900 * NU);
    add_cloud(sim, &c, phase, first);
    ASSERT_OK(sim, mps_model_register(sim, &pusher));
    ASSERT_OK(sim, mps_model_use(sim, "push.test"));
    ASSERT_OK(sim, mps_model_use(sim, "friction.history"));
    ASSERT_OK(sim, mps_model_set(sim, "friction", "width", WIDTH));
    memset(&drive, 0, sizeof drive);
    free(first);
    free(phase);
    cloud_free(&c);
    return sim;
}

/* Mean velocity of the particles. */
static double complex velocity_of(mps_sim *sim)
{
    mps_lease u = {.struct_size = sizeof u};
    double complex sum = 0;
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &u));
    for (int64_t i = 0; i < u.count; i++) sum += u.data[2 * i] + I * u.data[2 * i + 1];
    const double complex mean = sum / (double)u.count;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    return mean;
}

/* Mean velocity across the width at the time t, by an acceleration of exp(i w t) from rest on. */
static double complex pushed(double w, double t)
{
    double complex u = 0;
    for (int m = 1; m < 6000; m += 2) {
        const double rate = m * m * PI * PI * NU / (WIDTH * WIDTH);
        u += 8 / (m * m * PI * PI) * (cexp(I * w * t) - exp(-rate * t)) / (rate + I * w);
    }
    return u;
}

/* Exact mean velocity for an initial velocity 1, and the mean of its square. */
static double struck(double t, double *square)
{
    double u = 0;
    *square = 0;
    for (int m = 1; m < 6000; m += 2) {
        const double part = 8 / (m * m * PI * PI), rate = m * m * PI * PI * NU / (WIDTH * WIDTH);
        u += part * exp(-rate * t);
        *square += part * exp(-2 * rate * t);
    }
    return u;
}

static const double SMALL = 1e-6; /* of velocities [m/s]: particles stay where they are */

/* Within 0.02 % of the exact mean velocity, from the tenth step on. */
static void constant_force(void **state)
{
    (void)state;
    static const double dt[] = {0.05, 5e-3};
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = free_particles(0, dt[k]);
        double worst = 0;
        drive.amount = SMALL;
        for (int n = 1; n <= 900; n++) {
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            const double exact = SMALL * creal(pushed(0, n * dt[k]));
            if (n >= 10) worst = fmax(worst, fabs(creal(velocity_of(sim)) / exact - 1));
        }
        print_message("    constant force, dt %g s: %.4f %%\n", dt[k], 100 * worst);
        assert_true(worst < 2e-4);
        mps_sim_destroy(sim);
    }
}

/* A swinging force from rest on, with layers of 1/1 to 1/50 of the width: within 0.05 % of the
 * largest velocity. */
static void swinging_force(void **state)
{
    (void)state;
    static const double ratio[] = {1, 3, 10, 50};
    for (int k = 0; k < 4; k++) {
        const double layer = WIDTH / ratio[k], w = 2 * NU / (layer * layer), dt = 2 * PI / w / 500;
        mps_sim *sim = free_particles(0, dt);
        double worst = 0, most = 0;
        drive.amount = w * SMALL;
        drive.rate = w;
        for (int n = 1; n <= 750; n++) {
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            const double exact = w * SMALL * creal(pushed(w, n * dt));
            most = fmax(most, fabs(exact));
            worst = fmax(worst, fabs(creal(velocity_of(sim)) - exact));
        }
        print_message("    width over layer %2.0f: %.4f %%\n", ratio[k], 100 * worst / most);
        assert_true(worst < 5e-4 * most && most < 2 * SMALL);
        mps_sim_destroy(sim);
    }
}

static mps_energy energy_of(mps_sim *sim)
{
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    return e;
}

/* A uniform initial velocity: the mean within 0.06 % of the initial one; its energy goes to the
 * profile and to friction as in the exact flow, and to nothing else. */
static void impulse_and_energy(void **state)
{
    (void)state;
    const double dt = 5e-3;
    mps_sim *sim = free_particles(SMALL, dt);
    const double start = energy_of(sim).kinetic;
    double worst[3] = {0};
    for (int n = 1; n <= 4000; n++) {
        double square;
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        if (n < 10) continue;
        const double u = struck(n * dt, &square);
        const mps_energy e = energy_of(sim);
        worst[0] = fmax(worst[0], fabs(creal(velocity_of(sim)) / SMALL - u));
        worst[1] = fmax(worst[1], fabs(e.layers / start - (square - u * u)));
        worst[2] = fmax(worst[2], fabs(e.friction / start - (1 - square)));
        ASSERT_NEAR(e.kinetic + e.layers + e.friction, start, 1e-12 * start);
        assert_true(fabs(e.numerical) < 1e-12 * start && e.collision == 0 &&
                    fabs(e.viscous) < 1e-12 * start && e.added == 0);
    }
    const mps_energy e = energy_of(sim);
    print_message(
        "    impulse: velocity %.4f %%, energy of the profile %.4f %%, dissipated %.4f %%\n",
        100 * worst[0], 100 * worst[1], 100 * worst[2]);
    assert_true(worst[0] < 6e-4 && worst[1] < 1e-3 && worst[2] < 1e-3);
    assert_true(e.layers > 0.05 * e.kinetic && e.friction > 0.9 * start);
    mps_sim_destroy(sim);
}

/* Wall friction is reported: no momentum in other lines, and the part "sides" has all of it. */
static void momentum_and_probe(void **state)
{
    (void)state;
    mps_sim *sim = free_particles(SMALL, 5e-3);
    mps_momentum m, before;
    mps_probe p;
    int32_t id;
    double force[3], impulse = 0;
    assert_int_equal(mps_momentum_init(&before, sizeof before), MPS_OK);
    assert_int_equal(mps_momentum_init(&m, sizeof m), MPS_OK);
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = MPS_PROBE_FORCE;
    p.part = "sides";
    p.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    ASSERT_OK(sim, mps_momentum_get(sim, &before));
    for (int n = 0; n < 100; n++) {
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, mps_probe_read(sim, id, force));
        impulse += 5e-3 * force[0];
    }
    ASSERT_OK(sim, mps_momentum_get(sim, &m));
    const double lost = before.total[0] - m.total[0];
    assert_true(lost > 0.03 * before.total[0]);
    ASSERT_NEAR(impulse, lost, 1e-12 * before.total[0]);
    ASSERT_NEAR(-m.friction[0], lost, 1e-12 * before.total[0]);
    ASSERT_NEAR(-m.reaction[0], lost, 1e-12 * before.total[0]);
    assert_true(fabs(m.force[0]) < 1e-12 * lost && fabs(m.collision[0]) < 1e-12 * lost);
    mps_sim_destroy(sim);
}

static int turn(void *user, double t, mps_motion_state *s)
{
    const double *rate = user;
    s->value[MPS_ROTATE_Z] = *rate * t;
    s->rate[MPS_ROTATE_Z] = *rate;
    return 0;
}

/* A rotating tank, with a force that balances the centrifugal force. Fluid that moves in the tank
 * has the Coriolis acceleration: in axes that rotate at twice the rate of the tank in the opposite
 * direction, the flow is that of a tank at rest. */
static void turning_tank(void **state)
{
    (void)state;
    double rate = 0.7;
    const double dt = 5e-3, centre[2] = {0};
    for (int moving = 0; moving < 2; moving++) {
        mps_sim *sim = free_particles(0, dt);
        double worst = 0;
        drive.with_tank = true;
        ASSERT_OK(sim, mps_motion_callback_set(sim, turn, &rate));
        ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        mps_lease u = {.struct_size = sizeof u};
        ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
        for (int64_t i = 0; i < u.count; i++) u.data[2 * i] += moving ? SMALL : 0;
        ASSERT_OK(sim, mps_lease_end(sim, &u));
        for (int n = 1; n <= 800; n++) {
            double square;
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            mps_lease x = {.struct_size = sizeof x};
            double complex middle = 0;
            ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
            for (int64_t i = 0; i < x.count; i++)
                middle += (x.data[2 * i] + I * x.data[2 * i + 1]) / (double)x.count;
            ASSERT_OK(sim, mps_lease_end(sim, &x));
            const double angle = rate * dt;
            const double complex tank = middle * (1 - cexp(-I * angle)) /
                                        dt; /* over the last step */
            const double complex exact = moving ? SMALL * struck(n * dt, &square) *
                                                      cexp(-I * angle * n)
                                                : 0;
            if (n > 10) worst = fmax(worst, cabs(velocity_of(sim) - tank - exact) / SMALL);
        }
        print_message("    turning tank, %s: %.4f %%\n", moving ? "moving" : "at rest",
                      100 * worst);
        assert_true(worst < 2e-3);
        mps_sim_destroy(sim);
    }
}

/* A run resumed from a checkpoint ends with the same bytes: velocities, energies, budget. */
static void goes_on(void **state)
{
    (void)state;
    const double dt = 5e-3;
    mps_energy e[2];
    double complex u[2];
    for (int resumed = 0; resumed < 2; resumed++) {
        mps_sim *sim = free_particles(SMALL, dt);
        drive.amount = SMALL;
        drive.rate = 3;
        if (resumed)
            ASSERT_OK(sim, mps_checkpoint_read(sim, "phase_history.mps"));
        else
            for (int n = 0; n < 50; n++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        if (!resumed) ASSERT_OK(sim, mps_checkpoint_write(sim, "phase_history.mps"));
        for (int n = 0; n < 50; n++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        u[resumed] = velocity_of(sim);
        e[resumed] = energy_of(sim);
        mps_sim_destroy(sim);
    }
    remove("phase_history.mps");
    assert_memory_equal(&u[0], &u[1], sizeof u[0]);
    assert_memory_equal(&e[0], &e[1], sizeof e[0]);
    assert_true(e[0].layers > 0 && e[0].friction > 0);
}

/* Without a width there are no side walls; a fluid without viscosity has no friction. */
static void no_friction(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = free_particles(SMALL, 5e-3);
        if (k == 0) ASSERT_OK(sim, mps_model_set(sim, "friction", "width", 1e9));
        if (k == 1) set_phase(sim, 0, 900, 0);
        ASSERT_OK(sim, mps_run(sim, 1, NULL, NULL));
        ASSERT_NEAR(creal(velocity_of(sim)), SMALL, 1e-9 * SMALL);
        mps_sim_destroy(sim);
    }
}

static void not_in_3d(void **state)
{
    (void)state;
    const double lo[3] = {0}, hi[3] = {0.3, 0.2, 0.3};
    mps_sim *sim = new_sim(3, 0.05);
    add_tank(sim, 0.3, 0.3, 0.3);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_model_use(sim, "friction.history"));
    assert_int_equal(mps_step(sim, 1, NULL), MPS_E_PLUGIN);
    assert_non_null(strstr(mps_sim_error(sim), "in 2-D"));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_force),     cmocka_unit_test(swinging_force),
        cmocka_unit_test(impulse_and_energy), cmocka_unit_test(momentum_and_probe),
        cmocka_unit_test(turning_tank),       cmocka_unit_test(goes_on),
        cmocka_unit_test(no_friction),        cmocka_unit_test(not_in_3d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
