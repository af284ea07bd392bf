/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction at walls against exact solutions of unsteady viscous flow:
 *   channel  a slug of liquid between two plates, both ends free, driven by gravity along them:
 *            plane Poiseuille flow from rest;
 *   jump     the plates jump to a velocity: Stokes' first problem between two plates;
 *   swing    the plates swing: Stokes' second problem between two plates, from rest;
 *   round    a full round tank jumps to a rate of rotation: spin-up.
 * Velocities are compared in the middle of the slug, a gap long. The half cells at walls have no
 * particles, so the friction of the force models is the stress half a spacing inside the wall; its
 * time integral is compared with the exact one at this distance. */
#include "../tags.h"
#include <math.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const double GAP = 1, NU = 1, SLUG = 4, PI = 3.14159265358979;

#define OK(sim, call)                                               \
    do {                                                            \
        mps_status status_ = (call);                                \
        if (status_ != MPS_OK)                                      \
            fail_msg("%s: %s: %s", #call, mps_status_name(status_), \
                     (sim) ? mps_sim_error(sim) : "no handle");     \
    } while (0)

typedef enum flow_kind { CHANNEL, JUMP, SWING, ROUND } flow_kind;

/* What drives the flow: gravity [m/s2], speed of the plates [m/s], rate [rad/s] of the swing or the
 * rotation; until t_end. */
typedef struct flow {
    const char *name;
    flow_kind kind;
    double gravity, speed, rate, t_end;
    double dt_max; /* [s]; 0: what viscosity allows. Walls have their mean velocity over a step, so
                      one that swings lags by half of it */
} flow;

static const flow channel_flow = {"channel", CHANNEL, 5, 0, 0, 0.2, 0};
static const flow jump_flow = {"jump", JUMP, 0, 1, 0, 0.1, 0};
static const flow swing_flow = {"swing", SWING, 0, 1, 10, 0.25, 5e-4};
static const flow round_flow = {"round", ROUND, 0, 0, 1, 0.04, 0};

/* ---- exact solutions ------------------------------------------------------------------------- */

/* Bessel function of the first kind, by its integral; z below 100. */
static double bessel(int n, double z)
{
    enum { POINTS = 160 };
    double sum = 0;
    for (int k = 0; k < POINTS; k++) {
        const double a = (k + 0.5) / POINTS * PI;
        sum += cos(n * a - z * sin(a)) / POINTS;
    }
    return sum;
}

/* Velocity at the time t and the height y between the plates, or along the circle of radius y, in
 * the lab's frame. */
static double exact(const flow *f, double y, double t)
{
    double u = 0, z = 3.8317;
    if (f->kind == CHANNEL) u = f->gravity * y * (GAP - y) / (2 * NU);
    if (f->kind == JUMP) u = f->speed;
    if (f->kind == SWING) u = f->speed * sin(f->rate * t);
    for (int n = 1; n < 200 && f->kind != ROUND; n += 2) {
        const double k = n * PI / GAP, l = NU * k * k, w = f->rate,
                     mode = 4 / (n * PI) * sin(k * y), decay = exp(-l * t);
        if (f->kind == CHANNEL) u -= f->gravity / l * mode * decay;
        if (f->kind == JUMP) u -= f->speed * mode * decay;
        if (f->kind == SWING)
            u -= f->speed * mode * w * (l * cos(w * t) + w * sin(w * t) - l * decay) /
                 (l * l + w * w);
    }
    if (f->kind != ROUND) return u;
    u = f->rate * y;
    for (int n = 1; n < 24; n++, z += PI) { /* zeros of J1 */
        for (int k = 0; k < 6; k++) z -= bessel(1, z) / (bessel(0, z) - bessel(1, z) / z);
        u += f->rate * GAP * bessel(1, 2 * z * y / GAP) / (z * bessel(0, z)) *
             exp(-4 * z * z * NU * t / (GAP * GAP));
    }
    return u;
}

/* Momentum per mass that friction has transferred to the particles until time t: the mean velocity
 * from half a spacing inside one plate to half a spacing inside the other, minus that by
 * gravity. */
static double exact_friction(const flow *f, double dp, double t)
{
    enum { STRIPS = 400 };
    double sum = 0;
    for (int k = 0; k < STRIPS; k++)
        sum += exact(f, 0.5 * dp + (k + 0.5) / STRIPS * (GAP - dp), t) / STRIPS;
    return sum - f->gravity * t;
}

/* ---- simulation ------------------------------------------------------------------------------ */

static int drive(void *user, double t, mps_motion_state *s)
{
    const flow *f = user;
    const double w = f->rate;
    if (f->kind == ROUND) {
        s->value[MPS_ROTATE_Z] = w * t;
        s->rate[MPS_ROTATE_Z] = w;
    } else if (f->kind == SWING) {
        s->value[MPS_MOVE_X] = f->speed / w * (1 - cos(w * t));
        s->rate[MPS_MOVE_X] = f->speed * sin(w * t);
        s->accel[MPS_MOVE_X] = f->speed * w * cos(w * t);
    } else {
        s->value[MPS_MOVE_X] = f->speed * t;
        s->rate[MPS_MOVE_X] = f->speed;
    }
    return 0;
}

static double circle(void *user, const double *x)
{
    (void)user;
    return 0.5 * GAP - hypot(x[0], x[1]);
}

static int anywhere(void *user, const double *x)
{
    (void)user, (void)x;
    return 1;
}

/* Middle of the slug. */
static double middle(const double *x, const int32_t *kind, int64_t n)
{
    double sum = 0, count = 0;
    for (int64_t i = 0; i < n; i++) {
        if (kind[i] != MPS_FLUID) continue;
        sum += x[2 * i];
        count++;
    }
    return sum / count;
}

static double friction; /* momentum per mass from force models in the middle of the slug */

static int watch(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *a = s->data[0];
    double sum = 0, count = 0;
    const double centre = middle(v->x, v->kind, v->n);
    for (int64_t i = 0; i < v->n; i++) {
        if (v->kind[i] != MPS_FLUID || fabs(v->x[2 * i] - centre) > 0.5 * GAP) continue;
        sum += a[2 * i];
        count++;
    }
    friction += v->dt * sum / count;
    return 0;
}

static const mps_use watch_uses[] = {{"acceleration", MPS_USE_READ}};
static const mps_verb watch_verbs[] = {
    {.hook = MPS_FORCE, .use_count = 1, .uses = watch_uses, .after = "*", .run = watch}};
static const mps_model_ops watcher = {.struct_size = sizeof(mps_model_ops),
                                      .api = MPS_MODEL_API,
                                      .name = "watch.test",
                                      .help = "adds up the friction",
                                      .verb_count = 1,
                                      .verbs = watch_verbs};

static void build(mps_sim *sim, const flow *f)
{
    const double lo[2] = {0}, hi[2] = {SLUG, GAP};
    if (f->kind == ROUND) {
        mps_solid solid;
        OK(sim, mps_solid_init(&solid, sizeof solid));
        solid.distance = circle;
        for (int d = 0; d < 2; d++) solid.lo[d] = -(solid.hi[d] = 0.5 * GAP);
        OK(sim, mps_solid_add(sim, &solid));
        OK(sim, mps_fill_add(sim, 0, anywhere, NULL, NULL));
        return;
    }
    mps_tank tank;
    OK(sim, mps_tank_init(&tank, sizeof tank));
    tank.lo[0] = -GAP;
    tank.size[0] = SLUG + 2 * GAP;
    tank.size[1] = GAP;
    OK(sim, mps_tank_add(sim, &tank, NULL));
    OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
}

/* @param model NULL, or the viscosity to use with the whole stress @param radius far radius [dp] */
static mps_sim *begin(flow *f, int across, const char *model, double radius)
{
    mps_config config;
    mps_phase liquid;
    mps_time_control control;
    mps_sim *sim = NULL;
    friction = 0;
    OK(sim, mps_config_init(&config, sizeof config));
    config.dp = GAP / across;
    config.re_far = radius;
    config.gravity[0] = f->gravity;
    config.gravity[1] = 0;
    OK(sim, mps_sim_create(&config, &sim));
    OK(sim, mps_threads_set(sim, 1));
    OK(sim, mps_time_control_init(&control, sizeof control));
    control.dt_max = f->dt_max;
    OK(sim, mps_time_control_set(sim, &control));
    OK(sim, mps_phase_init(&liquid, sizeof liquid));
    liquid.density = 1;
    liquid.viscosity = NU;
    OK(sim, mps_phase_set(sim, 0, &liquid));
    if (model) {
        OK(sim, mps_model_use(sim, model));
        OK(sim, mps_model_set(sim, model, "stress", 1));
    }
    OK(sim, mps_model_register(sim, &watcher));
    OK(sim, mps_model_use(sim, "watch.test"));
    build(sim, f);
    if (f->kind != CHANNEL) OK(sim, mps_motion_callback_set(sim, drive, f));
    return sim;
}

/* Deviations from the exact solution. */
typedef struct measured {
    double size;     /* of the whole profile: its projection on the exact one, less 1 */
    double scatter;  /* root mean square of the velocity's, over the largest velocity */
    double friction; /* of the friction's integral over the time */
} measured;

static measured compare(mps_sim *sim, const flow *f, double dp)
{
    const int32_t *kind;
    mps_lease x = {.struct_size = sizeof x}, u = {.struct_size = sizeof u};
    double uu = 0, ue = 0, square = 0, most = 0, count = 0;
    OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &u));
    const double centre = middle(x.data, kind, x.count);
    for (int64_t i = 0; i < x.count; i++) {
        const double *at = x.data + 2 * i, *v = u.data + 2 * i, r = hypot(at[0], at[1]);
        if (kind[i] != MPS_FLUID || (f->kind != ROUND && fabs(at[0] - centre) > 0.5 * GAP))
            continue;
        const double is = f->kind == ROUND ? (at[0] * v[1] - at[1] * v[0]) / fmax(r, 1e-9) : v[0];
        const double wanted = exact(f, f->kind == ROUND ? r : at[1], f->t_end);
        uu += is * wanted;
        ue += wanted * wanted;
        square += (is - wanted) * (is - wanted);
        most = fmax(most, fabs(wanted));
        count++;
    }
    OK(sim, mps_lease_end(sim, &u));
    OK(sim, mps_lease_end(sim, &x));
    return (measured){uu / ue - 1, sqrt(square / count) / most,
                      friction / exact_friction(f, dp, f->t_end) - 1};
}

static measured run(const flow *given, int across, const char *model, double radius)
{
    flow f = *given;
    mps_sim *sim = begin(&f, across, model, radius);
    OK(sim, mps_run(sim, f.t_end, NULL, NULL));
    const measured m = compare(sim, &f, GAP / across);
    print_message("    %s, %d across, far radius %.1f%s: profile %+.2f %%, scatter %.2f %%", f.name,
                  across, radius, model ? ", whole stress" : "", 100 * m.size, 100 * m.scatter);
    print_message(f.kind == ROUND ? "\n" : ", friction %+.2f %%\n", 100 * m.friction);
    mps_sim_destroy(sim);
    return m;
}

/* ---- tests ----------------------------------------------------------------------------------- */

/* Within 2 % at 20 across, and nearer to the exact solution the finer. */
static void converges(const flow *f)
{
    static const int across[] = {10, 14, 20};
    measured m[3];
    for (int k = 0; k < 3; k++) m[k] = run(f, across[k], NULL, 3.1);
    assert_true(m[1].scatter < m[0].scatter && m[2].scatter < m[1].scatter);
    assert_true(fabs(m[2].size) < 0.01 && m[2].scatter < 0.01 && fabs(m[2].friction) < 0.01);
    assert_true(fabs(m[0].size) < 0.02 && fabs(m[0].friction) < 0.02);
}

static void poiseuille(void **state)
{
    (void)state;
    converges(&channel_flow);
}

static void plates_that_jump(void **state)
{
    (void)state;
    converges(&jump_flow);
}

static void plates_that_swing(void **state)
{
    (void)state;
    converges(&swing_flow);
}

/* The profile does not depend on the radius of the operator, nor on the direction of pair forces,
 * after the flow has disturbed the square lattice. (On the lattice itself the full stress is 1.2 %
 * too small along its rows with a far radius of 3.1 dp, 6 % with 2.1 dp, which is omitted here.) */
static void radii_and_stress(void **state)
{
    (void)state;
    static const double radius[] = {2.1, 3.1, 4.1};
    flow f = channel_flow;
    f.gravity = 20;
    for (int k = 0; k < 3; k++) {
        const measured plain = run(&f, 20, NULL, radius[k]);
        assert_true(fabs(plain.size) < 0.015 && plain.scatter < 0.015 &&
                    fabs(plain.friction) < 0.01);
        if (k == 0) continue;
        const measured whole = run(&f, 20, "viscosity.pair", radius[k]);
        assert_true(fabs(whole.size) < 0.02 && whole.scatter < 0.02 && fabs(whole.friction) < 0.01);
    }
}

/* With radius 2.1 dp the full stress needs shorter steps than the limits of the time control: it is
 * stable. */
static void whole_stress_is_stable(void **state)
{
    (void)state;
    const measured m = run(&channel_flow, 10, "viscosity.pair", 2.1);
    assert_true(fabs(m.size) < 0.1 && m.scatter < 0.1);
}

/* A rotating curved wall: the particles next to it are not on a lattice. */
static void spin_up(void **state)
{
    (void)state;
    const measured coarse = run(&round_flow, 20, NULL, 3.1), fine = run(&round_flow, 40, NULL, 3.1);
    const measured whole = run(&round_flow, 40, "viscosity.pair", 3.1);
    assert_true(fabs(coarse.size) < 0.02 && coarse.scatter < 0.025);
    assert_true(fabs(fine.size) < 0.01 && fine.scatter < 0.01 && fine.scatter < coarse.scatter);
    assert_true(fabs(whole.size) < 0.01 && whole.scatter < 0.01);
}

/* In a tank that has rotated long enough there is no friction: a liquid that rotates with its tank
 * continues to do so. */
static void turning_together(void **state)
{
    (void)state;
    flow late = round_flow;
    late.t_end = 0.4;
    const measured m = run(&late, 20, "viscosity.pair", 3.1);
    assert_true(fabs(m.size) < 1e-3 && m.scatter < 4e-3);
}

/* Numerical dissipation does not change the viscosity of a viscous liquid: a hundred times the
 * default would double it. */
static void dissipation_yields(void **state)
{
    (void)state;
    flow f = channel_flow;
    double size[2];
    for (int yields = 0; yields < 2; yields++) {
        mps_sim *sim = begin(&f, 14, NULL, 3.1);
        OK(sim, mps_model_set(sim, "dissipation", "alpha", 10));
        OK(sim, mps_model_set(sim, "dissipation", "viscous", yields));
        OK(sim, mps_run(sim, f.t_end, NULL, NULL));
        size[yields] = compare(sim, &f, GAP / 14).size;
        mps_sim_destroy(sim);
    }
    print_message(
        "    alpha 10: profile %+.2f %%, with the fluid's own viscosity taken off %+.2f %%\n",
        100 * size[0], 100 * size[1]);
    assert_true(size[0] < -0.03 && fabs(size[1]) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(poiseuille),
                                       cmocka_unit_test(plates_that_jump),
                                       cmocka_unit_test(plates_that_swing),
                                       cmocka_unit_test(radii_and_stress),
                                       cmocka_unit_test(whole_stress_is_stable),
                                       cmocka_unit_test(spin_up),
                                       cmocka_unit_test(turning_together),
                                       cmocka_unit_test(dissipation_yields)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
