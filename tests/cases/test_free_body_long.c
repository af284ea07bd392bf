/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank moved by its liquid, mps_body_set(), against linear theory: frequencies, momentum, two
 * peaks of a tank on a spring, energy. */
#include "../tags.h"
#include <complex.h>
#include <math.h>
#include <mps/mps.h>
#include <mps/stage.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double width = 0.8, depth = 0.25, tilt = 0.005, dp = 0.01, dt = 1.8e-3;

static void ok(mps_sim *sim, mps_status status)
{
    if (status < 0) fail_msg("%s", mps_sim_error(sim));
}

/* The first mode of the surface, small amplitude; horizontal if `user` is set. */
static int below(void *user, const double *x)
{
    const double rise = user ? 0 : tilt * cos(acos(-1.0) * x[0] / width);
    return x[1] < depth + rise + 1e-9;
}

static mps_sim *tank(bool level)
{
    mps_config c;
    mps_tank t;
    mps_sim *sim = NULL;
    mps_config_init(&c, sizeof c);
    c.dp = dp;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    mps_tank_init(&t, sizeof t);
    t.size[0] = width;
    t.size[1] = 0.5;
    ok(sim, mps_tank_add(sim, &t, NULL));
    ok(sim, mps_fill_add(sim, 0, below, level ? &c : NULL, NULL));
    return sim;
}

static void set_body(mps_sim *sim, double mass)
{
    mps_body b;
    mps_body_init(&b, sizeof b);
    b.free = MPS_BODY_FREE(MPS_MOVE_X);
    b.mass = mass;
    ok(sim, mps_body_set(sim, &b));
}

static mps_body_report report_of(mps_sim *sim)
{
    mps_body_report r;
    mps_body_report_init(&r, sizeof r);
    ok(sim, mps_body_get(sim, &r));
    return r;
}

/* ---- theory ---- */

/* Mass of tank and liquid at s = sigma + i w: M + m0 + sum m_n w_n^2 .../(w_n^2 + s^2), with a
 * damping `delta` of all waves [1/s]. */
static double complex mass_at(double mass, double complex s, double delta)
{
    const double pi = acos(-1.0), liquid = 1000 * width * depth;
    double moving = 0;
    double complex sum = 0;
    for (int n = 1; n < 400; n += 2) {
        const double k = n * pi / width, square = 9.81 * k * tanh(k * depth),
                     m = 8 * liquid * tanh(k * depth) * width / (depth * pi * pi * pi * n * n * n);
        moving += m;
        sum += m * (square + 2 * delta * s) / (square + s * s + 2 * delta * s);
    }
    return mass + liquid - moving + sum;
}

static double frequency(double mass)
{
    double lo = 5.3895, hi = 9.2; /* between the first poles the balance rises through 0 */
    for (int k = 0; k < 100; k++) {
        const double middle = 0.5 * (lo + hi);
        *(creal(mass_at(mass, I * middle, 0)) < 0 ? &lo : &hi) = middle;
    }
    return lo;
}

/* ---- free ---- */

enum { STEPS = 1400 };

/* Residual of positions after a fit of 1, t, cos wt and sin wt. */
static double left_over(const double *place, double w)
{
    double g[4][5] = {{0}}, all = 0;
    for (int i = 0; i < STEPS; i++) {
        const double t = (i + 1) * dt, f[4] = {1, t, cos(w * t), sin(w * t)};
        for (int r = 0; r < 4; r++) {
            for (int c = 0; c < 4; c++) g[r][c] += f[r] * f[c];
            g[r][4] += f[r] * place[i];
        }
        all += place[i] * place[i];
    }
    for (int r = 0; r < 4; r++) { /* Gauss elimination; the last column is reduced by the explained
                                     part */
        for (int q = r + 1; q < 4; q++)
            for (int c = 4; c >= r; c--) g[q][c] -= g[q][r] / g[r][r] * g[r][c];
        all -= g[r][4] * g[r][4] / g[r][r];
    }
    return all;
}

static double frequency_of(const double *place)
{
    double best = 0, least = INFINITY;
    for (double w = 4.5; w < 10; w += 1e-3) {
        const double left = left_over(place, w);
        if (left < least) best = w;
        least = fmin(least, left);
    }
    return best;
}

/* A/M from .17 to 33, and no mass at all. */
static void frequencies(void **state)
{
    static const double mass[] = {400, 200, 100, 50, 20, 5, 2, 0},
                        known[] = {6.049, 6.479, 7.003, 7.510, 7.987, 8.302, 8.372};
    double place[STEPS];
    (void)state;
    for (int k = 0; k < 8; k++) {
        const double exact = frequency(mass[k]);
        double late = 0, load = 0;
        if (k < 7) assert_true(fabs(exact - known[k]) < 2e-3);
        mps_sim *sim = tank(false);
        set_body(sim, mass[k]);
        for (int i = 0; i < STEPS; i++) {
            ok(sim, mps_step(sim, dt, NULL));
            const mps_body_report r = report_of(sim);
            place[i] = r.pose[0];
            late = fmax(late, fabs(r.late[0]));
            load = fmax(load, r.mass[0] * fabs(r.acceleration[0]));
        }
        mps_sim_destroy(sim);
        const double found = frequency_of(place);
        print_message("M = %g: %.3f rad/s, theory %.3f; felt late %.2g of %.2g N\n", mass[k], found,
                      exact, late, load);
        assert_true(fabs(found / exact - 1) < 0.01);
        assert_true(late < 0.01 * load);
    }
}

/* Momentum of the liquid along x as its load counts it: half of surface particles, half cells of
 * the floor with the row above them, and of the ends with the tank. */
static double momentum_of(mps_sim *sim, const mps_body_report *body)
{
    mps_lease u = {.struct_size = sizeof u}, at = {.struct_size = sizeof at}, region;
    const int32_t *kind = NULL;
    double sum = 0;
    ok(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    ok(sim, tags_lease(sim, "region", &region));
    ok(sim, mps_lease_begin(sim, "velocity", MPS_READ, &u));
    ok(sim, mps_lease_begin(sim, "position", MPS_READ, &at));
    for (int64_t i = 0; i < u.count && kind; i++) {
        if (kind[i] != MPS_FLUID) continue;
        const double cell = 1000 * dp * dp, r = at.data[2 * i] - body->pose[0],
                     share = region.integers[i] == MPS_REGION_SURFACE ? 0.5 : 1;
        sum += share * cell * u.data[2 * i];
        if (at.data[2 * i + 1] < 1.5 * dp) sum += 0.5 * cell * u.data[2 * i];
        if (r < 1.5 * dp || r > width - 1.5 * dp) sum += 0.5 * share * cell * body->velocity[0];
    }
    ok(sim, mps_lease_end(sim, &u));
    ok(sim, mps_lease_end(sim, &at));
    ok(sim, mps_lease_end(sim, &region));
    return sum;
}

/* What the tank gains the liquid loses, within half a per cent of the largest momentum of the
 * wave. */
static void keeps_momentum(void **state)
{
    const double mass = 100;
    double largest = 0, error = 0;
    mps_sim *sim = tank(false);
    (void)state;
    set_body(sim, mass);
    for (int k = 0; k < 500; k++) {
        ok(sim, mps_step(sim, dt, NULL));
        const mps_body_report r = report_of(sim);
        const double liquid = momentum_of(sim, &r);
        largest = fmax(largest, fabs(liquid));
        error = fmax(error, fabs(liquid + mass * r.velocity[0]));
    }
    print_message("momentum: %.3g of %.3g kg m/s\n", error, largest);
    assert_true(largest > 1 && error < 0.005 * largest);
    mps_sim_destroy(sim);
}

/* A dam that breaks in a tank of a fiftieth of its mass: the walls go where the water sends
 * them. */
static void stays_within_reason(void **state)
{
    const double lo[2] = {0, 0}, hi[2] = {0.3, 0.4};
    double fastest = 0, farthest = 0;
    mps_config c;
    mps_tank t;
    mps_sim *sim = NULL;
    (void)state;
    mps_config_init(&c, sizeof c);
    c.dp = 2 * dp;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    mps_tank_init(&t, sizeof t);
    t.size[0] = width;
    t.size[1] = 0.5;
    ok(sim, mps_tank_add(sim, &t, NULL));
    ok(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    set_body(sim, 1.2); /* liquid over body: 100 */
    for (int k = 0; k < 1000; k++) {
        ok(sim, mps_step(sim, 2e-3, NULL));
        const mps_body_report r = report_of(sim);
        fastest = fmax(fastest, fabs(r.velocity[0]));
        farthest = fmax(farthest, -r.pose[0]);
        assert_true(fabs(r.kinetic - r.start - r.liquid_work) < 1e-9 * (1 + fabs(r.liquid_work)));
    }
    print_message("dam: up to %.2f m/s, %.3f m away\n", fastest, farthest);
    /* the centre of mass of the water moves by .25 m relative to the tank; 2 sqrt(g .4 m) is the
     * speed of its tip */
    assert_true(farthest > 0.2 && farthest < 0.3);
    assert_true(fastest > 1 && fastest < 4);
    mps_sim_destroy(sim);
}

/* ---- on a spring ---- */

enum { RUN = 13900, PUSH = 278, LINES = 560 }; /* 25 s; of .5 s; from 4 to 6.8 rad/s */
static const double least = 4, resolution = 0.005, fading = 0.2;

static double push_at(double t)
{
    return t < PUSH * dt ? 200 * (1 - cos(2 * acos(-1.0) * t / (PUSH * dt))) : 0;
}

static int push(void *user, double t, const mps_motion_state *s, double load[6])
{
    (void)user, (void)s;
    load[0] = push_at(t);
    return 0;
}

/* Response |x/force| at s = fading + i w: as if all faded by e^(-t/5 s), so that 25 s are
 * enough. */
static void transform(const double *place, double *response)
{
    for (int k = 0; k < LINES; k++) {
        const double complex s = fading + I * (least + k * resolution), turn = cexp(-s * dt);
        double complex x = 0, f = 0, now = turn;
        for (int i = 0; i < RUN; i++, now *= turn) {
            x += place[i] * now;
            if (i < PUSH) f += push_at(i * dt) * now / turn;
        }
        response[k] = cabs(x / f);
    }
}

/* Response of linear theory, with wave damping. */
static void respond(const mps_body *b, double delta, double *response)
{
    for (int k = 0; k < LINES; k++) {
        const double complex s = fading + I * (least + k * resolution),
                             inertia = s * s * mass_at(b->mass, s, delta);
        response[k] = cabs(1 / (b->stiffness[0] + s * b->damping[0] + inertia));
    }
}

/* Positions of the two peaks. */
static void peaks(const double *response, int place[2])
{
    int found = 0;
    for (int k = 1; k < LINES - 1 && found < 2; k++)
        if (response[k] > response[k - 1] && response[k] >= response[k + 1]) place[found++] = k;
    assert_int_equal(found, 2);
}

/* The energy of the push is in the body, its damper or the liquid, whose wave loses almost
 * nothing. */
static void closes(const mps_body_report *r, const mps_energy *start, const mps_energy *end)
{
    const double body = r->kinetic + r->spring + r->damped,
                 liquid = end->kinetic + end->potential - start->kinetic - start->potential,
                 rest = r->external_work - body - liquid;
    print_message("%.4g J given: body and damper %.4g, liquid %.3g, rest %.2g\n", r->external_work,
                  body, liquid, rest);
    assert_true(fabs(rest) < 0.01 * r->external_work);
}

/* The wave as a damper: liquid a tenth of the tank, both of one frequency. The damping of the wave,
 * the one number that theory lacks, is that of the best fit to the whole response. */
static void two_peaks(void **state)
{
    const double mass = 2000, k1 = acos(-1.0) / width, w1 = sqrt(9.81 * k1 * tanh(k1 * depth)),
                 stiffness = w1 * w1 * (mass + 200), damping = 0.02 * w1 * (mass + 200);
    double *place = calloc(RUN, sizeof *place), found[LINES], linear[LINES], best = INFINITY,
           delta = 0, gap = 0;
    mps_energy e, start;
    mps_body b;
    mps_sim *sim = tank(true);
    (void)state;
    assert_non_null(place);
    mps_energy_init(&e, sizeof e);
    mps_energy_init(&start, sizeof start);
    ok(sim, mps_energy_get(sim, &start));
    mps_body_init(&b, sizeof b);
    b.free = MPS_BODY_FREE(MPS_MOVE_X);
    b.mass = mass;
    b.stiffness[0] = stiffness;
    b.damping[0] = damping;
    b.load = push;
    ok(sim, mps_body_set(sim, &b));
    mps_body_report r = report_of(sim);
    for (int i = 0; i < RUN; i++) {
        ok(sim, mps_step(sim, dt, NULL));
        r = report_of(sim);
        place[i] = r.pose[0];
        ok(sim, mps_energy_get(sim, &e));
        gap = fmax(gap, fabs(r.liquid_work + e.wall_work_momentum));
        assert_true(fabs(r.kinetic + r.spring + r.damped - r.external_work - r.liquid_work) <
                    1e-9 * (1 + r.external_work));
    }
    transform(place, found);
    for (double d = 0; d < 0.3; d += 0.005) {
        double error = 0;
        respond(&b, d, linear);
        for (int k = 0; k < LINES; k++) error += (linear[k] - found[k]) * (linear[k] - found[k]);
        if (error < best) delta = d;
        best = fmin(best, error);
    }
    respond(&b, delta, linear);
    int run[2], theory[2];
    peaks(found, run);
    peaks(linear, theory);
    print_message("damping of the wave %.3f of w; work %.3g of %.3g J is not the liquid's\n",
                  delta / w1, gap, r.external_work);
    closes(&r, &start, &e);
    for (int k = 0; k < 2; k++) {
        const double w = least + run[k] * resolution, exact = least + theory[k] * resolution;
        print_message("peak at %.3f rad/s, theory %.3f; height over theory %.4f\n", w, exact,
                      found[run[k]] / linear[theory[k]]);
        assert_true(fabs(w / exact - 1) < 0.01);
        assert_true(fabs(found[run[k]] / linear[theory[k]] - 1) < 0.05);
    }
    assert_true(delta / w1 < 0.03);
    assert_true(gap < 0.01 * r.external_work);
    mps_sim_destroy(sim);
    free(place);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frequencies), cmocka_unit_test(keeps_momentum),
        cmocka_unit_test(stays_within_reason), cmocka_unit_test(two_peaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
