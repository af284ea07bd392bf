/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank free along x, moved by its liquid only: each step is solved with the added mass. */
#include "../tags.h"
#include <math.h>
#include <mps/mps.h>
#include <mps/stage.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double width = 0.8, depth = 0.25, tilt = 0.005, dp = 0.01;

static void ok(mps_sim *sim, mps_status status)
{
    if (status < 0) fail_msg("%s", mps_sim_error(sim));
}

/* The first mode of the surface, small. */
static int below(void *user, const double *x)
{
    (void)user;
    return x[1] < depth + tilt * cos(acos(-1.0) * x[0] / width) + 1e-9;
}

static mps_sim *tilted(void)
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
    ok(sim, mps_fill_add(sim, 0, below, NULL, NULL));
    return sim;
}

/* ---- theory: M + m0 + sum m_n/(1 - w^2/w_n^2) = 0 ---- */

static double balance(double mass, double w)
{
    const double pi = acos(-1.0), liquid = 1000 * width * depth;
    double moving = 0, sum = 0;
    for (int n = 1; n < 400; n += 2) {
        const double k = n * pi / width,
                     m = 8 * liquid * tanh(k * depth) * width / (depth * pi * pi * pi * n * n * n);
        moving += m;
        sum += m / (1 - w * w / (9.81 * k * tanh(k * depth)));
    }
    return mass + liquid - moving + sum;
}

static double frequency(double mass)
{
    double lo = 5.3895, hi = 9.2; /* between the first poles the balance rises through 0 */
    for (int k = 0; k < 100; k++) {
        const double middle = 0.5 * (lo + hi);
        *(balance(mass, middle) < 0 ? &lo : &hi) = middle;
    }
    return lo;
}

/* ---- the run ---- */

enum { STEPS = 1400 };

/* The tank; `added`: with the added mass. */
typedef struct body {
    double mass;
    int added;
    double x, v, *a;
    int *trials; /* NULL: not counted */
} body;

/* A step to t with the acceleration by its load; without the added mass, with that of the last
 * step. */
static void solve_step(mps_sim *sim, mps_snapshot *start, double t, double dt, const body *b)
{
    double *a = b->a;
    mps_load load;
    mps_motion_state pose;
    mps_load_init(&load, sizeof load);
    mps_motion_state_init(&pose, sizeof pose);
    for (int again = 0; again < 6; again++) {
        if (again > 0) ok(sim, mps_snapshot_restore(start));
        pose.value[MPS_MOVE_X] = b->x + dt * (b->v + dt * *a);
        ok(sim, mps_motion_pose_set(sim, t, &pose));
        ok(sim, mps_run(sim, t, NULL, NULL));
        ok(sim, mps_load_get(sim, NULL, &load));
        if (b->trials) ++*b->trials;
        const double scale = (b->mass + load.mass[0]) * fabs(*a) + 0.1;
        if (!b->added || fabs(load.force[0] - b->mass * *a) < 1e-3 * scale || again == 5) break;
        *a = load.rest[0] / (b->mass + load.mass[0]);
    }
    if (!b->added) *a = load.force[0] / b->mass; /* of the next step */
}

/* Positions of the tank after each step. @return whether they are plausible */
static int drift(double mass, int added, double dt, double *place, int *trials)
{
    double x = 0, v = 0, a = 0;
    mps_sim *sim = tilted();
    mps_snapshot *start = NULL;
    ok(sim, mps_snapshot_create(sim, &start));
    ok(sim, mps_load_watch(sim, added ? MPS_LOAD_MASS : MPS_LOAD_FORCE));
    int done = 0;
    for (*trials = 0; done < STEPS && fabs(a) < 500; done++) {
        ok(sim, mps_snapshot_take(start));
        const double now = a;
        solve_step(sim, start, (done + 1) * dt, dt, &(body){mass, added, x, v, &a, trials});
        const double used = added ? a : now;
        v += dt * used;
        x += dt * v;
        place[done] = x;
    }
    mps_snapshot_destroy(start);
    mps_sim_destroy(sim);
    return done == STEPS;
}

/* Residual of positions after a fit of 1, t, cos wt and sin wt. */
static double left_over(const double *place, double dt, double w)
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

static double frequency_of(const double *place, double dt)
{
    double best = 0, least = INFINITY;
    for (double w = 4.5; w < 10; w += 1e-3) {
        const double left = left_over(place, dt, w);
        if (left < least) best = w;
        least = fmin(least, left);
    }
    return best;
}

/* A/M from .17 to 33, and no mass at all. */
static void frequencies(void **state)
{
    static const double mass[] = {400, 100, 20, 5, 2, 0},
                        known[] = {6.049, 7.003, 7.987, 8.302, 8.372};
    const double dt = 1.8e-3;
    double place[STEPS];
    int trials;
    (void)state;
    for (int k = 0; k < 6; k++) {
        const double exact = frequency(mass[k]);
        if (k < 5) assert_true(fabs(exact - known[k]) < 2e-3);
        assert_true(drift(mass[k], 1, dt, place, &trials));
        const double found = frequency_of(place, dt);
        print_message("M = %g: %.3f rad/s, theory %.3f, %.2f trials a step\n", mass[k], found,
                      exact, (double)trials / STEPS);
        assert_true(fabs(found / exact - 1) < 0.01);
        assert_true(trials < 3 * STEPS);
    }
}

/* Momentum of the liquid along x as its load counts it: half of surface particles, half cells of
 * the floor with the row above them, and of the ends with the tank. */
static double momentum_of(mps_sim *sim, double x, double v)
{
    mps_lease u = {.struct_size = sizeof u}, at = {.struct_size = sizeof at}, region;
    const int32_t *kind;
    double sum = 0;
    ok(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    ok(sim, tags_lease(sim, "region", &region));
    ok(sim, mps_lease_begin(sim, "velocity", MPS_READ, &u));
    ok(sim, mps_lease_begin(sim, "position", MPS_READ, &at));
    for (int64_t i = 0; i < u.count; i++) {
        if (kind[i] != MPS_FLUID) continue;
        const double cell = 1000 * dp * dp, r = at.data[2 * i] - x,
                     share = region.integers[i] == MPS_REGION_SURFACE ? 0.5 : 1;
        sum += share * cell * u.data[2 * i];
        if (at.data[2 * i + 1] < 1.5 * dp) sum += 0.5 * cell * u.data[2 * i];
        if (r < 1.5 * dp || r > width - 1.5 * dp) sum += 0.5 * share * cell * v;
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
    const double dt = 1.8e-3, mass = 100;
    double x = 0, v = 0, a = 0, largest = 0, error = 0;
    mps_sim *sim = tilted();
    mps_snapshot *start = NULL;
    (void)state;
    ok(sim, mps_snapshot_create(sim, &start));
    ok(sim, mps_load_watch(sim, MPS_LOAD_MASS));
    for (int k = 0; k < 500; k++) {
        ok(sim, mps_snapshot_take(start));
        solve_step(sim, start, (k + 1) * dt, dt, &(body){mass, 1, x, v, &a, NULL});
        v += dt * a;
        x += dt * v;
        const double liquid = momentum_of(sim, x, v);
        largest = fmax(largest, fabs(liquid));
        error = fmax(error, fabs(liquid + mass * v));
    }
    print_message("momentum: %.3g of %.3g kg m/s\n", error, largest);
    assert_true(error < 0.005 * largest);
    mps_snapshot_destroy(start);
    mps_sim_destroy(sim);
}

/* Without the added mass a step multiplies an error by A/M. */
static void needs_the_added_mass(void **state)
{
    const double dt = 1.8e-3;
    double place[STEPS];
    int trials;
    (void)state;
    assert_true(drift(100, 0, dt, place, &trials));
    assert_false(drift(50, 0, dt, place, &trials));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(frequencies),
                                       cmocka_unit_test(keeps_momentum),
                                       cmocka_unit_test(needs_the_added_mass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
