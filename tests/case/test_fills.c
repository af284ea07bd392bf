/* SPDX-License-Identifier: BSD-3-Clause */
/* Fills and rigid bodies of cases: volumes, motions and energies against exact values; refusals. */
#include "build_kit.h"

/* after cmocka.h */
#include "../turns.h"

static mps_energy energy(const built *t)
{
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    assert_int_equal(mps_energy_get(t->b.sim, &e), MPS_OK);
    return e;
}

static void make(built *t, const char *head, const char *rest)
{
    char text[900];
    snprintf(text, sizeof text, "mps: 1\n%s\nrun: {until: 1 s}\n%s\n", head, rest);
    built_make(t, text, NULL);
}

static const char FLAT[] = "dp: 10 mm\ntank: {size: 1 0.6 m}";
static const char SPACE[] = "dim: 3\ndp: 40 mm\ntank: {size: 1.2 0.8 0.6 m}";

typedef struct volume_case {
    const char *head, *rest;
    double exact, most; /* largest relative error */
} volume_case;

static void check_volumes(const volume_case *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        built t;
        make(&t, v[i].head, v[i].rest);
        const double off = energy(&t).volume_filled / v[i].exact - 1;
        printf("%s: %+.3f %% of %g\n", v[i].rest, 100 * off, v[i].exact);
        if (!(fabs(off) < v[i].most)) fail_msg("%s: %g", v[i].rest, off);
        built_free(&t);
    }
}

/* Each kind of fill has the volume of its shape, to half a spacing at free sides: 1.7 % of the
 * wave's depth, 5 % of the box in 3-D. */
static void fills(void **state)
{
    const double pi = acos(-1.0);
    const volume_case v[] = {
        {FLAT, "fill: [{water: {depth: 50 %}}]", 0.3, 0.001},
        {FLAT, "fill: [{water: {depth: 304 mm, whole_rows: yes}}]", 0.3, 0.001},
        {FLAT, "fill: [{water: {box: [0 0 m, 0.4 0.3 m]}}]", 0.12, 0.01},
        /* with the points on its sides: 21 x 21 cells */
        {FLAT, "fill: [{water: {box: [0.5 0.4 m, 0.3 0.2 m]}}]", 0.0441, 1e-6},
        {FLAT, "fill: [{water: {polygon: [0 0 m, 1 0 m, 0 0.5 m]}}]", 0.25, 0.02},
        {FLAT, "fill: [{water: {sphere: {centre: 0.5 0.3 m, radius: 0.2 m}}}]", pi * 0.04, 0.02},
        {FLAT, "fill: [{water: {wave: {level: 0.3 m, amplitude: 50 mm, length: 1 m}}}]", 0.3, 0.02},
        {FLAT, "fill: [{water: {depth: 0.3 m, start: {standing_wave: 20 mm}}}]", 0.3, 0.01},
        {FLAT, "model: mmps\nfill: [{water: {depth: 50 %}}, {air: rest}]", 0.6, 0.001},
        {SPACE, "fill: [{water: {depth: 50 %}}]", 0.288, 0.02},
        {SPACE, "fill: [{water: {box: [0 0 0 m, 0.4 0.4 0.6 m]}}]", 0.096, 0.055},
        {SPACE, "fill: [{water: {box: [0 0 m, 0.4 0.4 m]}}]", 0.096, 0.055},
        {SPACE, "fill: [{water: {polygon: [0 0 m, 1.2 0 m, 0 0.8 m]}}]", 0.288, 0.04},
        {SPACE, "fill: [{water: {sphere: {centre: 0.6 0.4 0.3 m, radius: 0.24 m}}}]",
         4 * pi / 3 * 0.24 * 0.24 * 0.24, 0.04},
    };
    (void)state;
    check_volumes(v, sizeof v / sizeof *v);
}

/* Solid bodies displace their volume. */
static void bodies(void **state)
{
    const double pi = acos(-1.0);
#define WATER "fill: [{water: {depth: 50 %}}]\nsolids: "
    const volume_case v[] = {
        {FLAT, WATER "{b: {box: [0.4 0 m, 0.6 0.2 m]}}", 0.26, 0.01},
        {FLAT, WATER "{b: {sphere: {centre: 0.5 0.15 m, radius: 0.1 m}}}", 0.3 - pi * 0.01, 0.01},
        {FLAT, WATER "{b: {prism: [0.3 0 m, 0.7 0 m, 0.5 0.2 m]}}", 0.26, 0.01},
        {FLAT, WATER "{b: {plate: [0.5 0 m, 0.5 0.25 m]}}", 0.3, 0.002},
        {FLAT, WATER "{b: {plate: [0.5 0 m, 0.5 0.2 m], thickness: 40 mm}}", 0.292, 0.004},
        {FLAT, WATER "{b: {plate: [0.4 0.1 m, 0.6 0.25 m]}}", 0.3, 0.01},
        /* at each of the seven tips half of a cell has no particle and no face */
        {FLAT, WATER "{b: {plate: [0.5 0 m, 0.5 0.3 m], holes: {pitch: 100 mm, open: 40 %}}}",
         0.3 - 7 * 0.5e-4, 0.002},
        {SPACE, WATER "{b: {sphere: {centre: 0.6 0.2 0.3 m, radius: 0.16 m}}}",
         0.288 - 4 * pi / 3 * 0.16 * 0.16 * 0.16, 0.02},
        {SPACE, WATER "{b: {cylinder: {from: 0.6 0 0.3 m, to: 0.6 0.8 0.3 m, radius: 0.16 m}}}",
         0.4 * (0.72 - pi * 0.16 * 0.16), 0.03},
        {SPACE, WATER "{b: {prism: [0.4 0 m, 0.8 0 m, 0.8 0.4 m], between: 0.2 0.4 m}}",
         0.288 - 0.016, 0.02},
        {SPACE, WATER "{b: {plate: [0.6 0 0 m, 0.6 0.24 0.6 m]}}", 0.288, 0.015},
        {SPACE, WATER "{b: {plate: [0.6 0 0 m, 0.6 0.4 0 m, 0.6 0 0.6 m]}}", 0.288, 0.015},
    };
    (void)state;
    check_volumes(v, sizeof v / sizeof *v);
}

/* Largest relative error of the volume over several steps. */
static double volume_error(const built *t, double exact, int steps)
{
    double most = fabs(energy(t).volume_filled / exact - 1);
    for (int k = 0; k < steps; k++) {
        if (mps_step(t->b.sim, 1, NULL) < 0) fail_msg("%s", mps_sim_error(t->b.sim));
        most = fmax(most, fabs(energy(t).volume_filled / exact - 1));
    }
    return most;
}

static double circle_below(double depth, double r)
{
    return r * r * acos(1 - depth / r) - (r - depth) * sqrt(depth * (2 * r - depth));
}

/* Liquid of few rows, at rest and in waves: walls above its surface are dry. As wet they would add
 * 8 % in waves of the 3-D box, 2.5 % in 2-D. */
static void few_rows(void **state)
{
#define BOX   "tank: {size: 400 300 mm}"
#define CUT   "tank: {size: 400 300 mm, chamfer: {bottom: 50 50 mm, top: 100 100 mm}}"
#define SURGE "motion: {surge: {amplitude: 20 mm, period: 0.8 s}}"
    static const char deep[] = "dim: 3\ntank: {size: 200 300 100 mm}",
                      tube[] =
                          "dim: 3\ntank: {cylinder: {radius: 100 mm, length: 200 mm, axis: x}}",
                      round[] = "tank: {cylinder: {radius: 200 mm}}";
    const struct {
        const char *tank, *motion;
        int rows;
        double exact, most;
    } v[] = {{BOX, "", 4, 0.016, 0.002},
             {BOX, "", 8, 0.032, 0.001},
             {BOX, SURGE, 4, 0.016, 0.01},
             {BOX, SURGE, 8, 0.032, 0.005},
             {CUT, "", 4, 0.016 - 0.0025 + 0.0001, 0.003},
             {CUT, "", 8, 0.032 - 0.0025, 0.002},
             {CUT, SURGE, 4, 0.016 - 0.0025 + 0.0001, 0.018},
             {round, "", 4, circle_below(0.04, 0.2), 0.01},
             {round, "", 8, circle_below(0.08, 0.2), 0.003},
             {deep, "", 4, 0.0008, 0.012},
             {deep, "", 8, 0.0016, 0.007},
             {deep, SURGE, 4, 0.0008, 0.035},
             {tube, "", 4, 0.2 * circle_below(0.04, 0.1), 0.007},
             {tube, "", 8, 0.2 * circle_below(0.08, 0.1), 0.003}};
    (void)state;
    for (size_t i = 0; i < sizeof v / sizeof *v; i++) {
        char head[200], rest[200];
        built t;
        snprintf(head, sizeof head, "dp: 10 mm\n%s", v[i].tank);
        snprintf(rest, sizeof rest, "fill: [{water: {depth: %d mm}}]\n%s", 10 * v[i].rows,
                 v[i].motion);
        make(&t, head, rest);
        const double off = volume_error(&t, v[i].exact, v[i].motion[0] ? 150 : 0);
        printf("%s, %d rows, %s: %.3f %%\n", v[i].tank, v[i].rows,
               v[i].motion[0] ? "waves" : "rest", 100 * off);
        if (!(off < v[i].most)) fail_msg("%s, %d rows: %g", v[i].tank, v[i].rows, off);
        built_free(&t);
    }
}

/* Two fluids in waves fill the tank all the time. */
static void two_fluids(void **state)
{
    built t;
    (void)state;
    make(&t, "dp: 10 mm\n" BOX,
         "model: mmps\nfill: [{water: {depth: 80 mm}}, {air: rest}]\n" SURGE);
    const double off = volume_error(&t, 0.12, 60);
    printf("water and air: %.3f %%\n", 100 * off);
    assert_true(off < 0.005);
    built_free(&t);
}

/* A velocity at the start is that of all of the fluid. Its particles are 99 columns of 100
 * spacings: the half cells at walls are of the walls. */
static void start_velocity(void **state)
{
    built t;
    (void)state;
    make(&t, FLAT, "fill: [{water: {depth: 50 %, start: {velocity: 1 -0.5 m/s}}}]");
    same_number(energy(&t).kinetic, 0.5 * 1000 * 0.99 * 0.3 * 1.25, 1e-6);
    built_free(&t);
}

/* A standing wave is highest at x = 0, by twice its amplitude above the other end. */
static void standing_wave(void **state)
{
    built t;
    mps_lease x = {.struct_size = sizeof x}, kind = x;
    double left = 0, right = 0;
    (void)state;
    make(&t, FLAT, "fill: [{water: {depth: 0.3 m, start: {standing_wave: 20 mm}}}]");
    same_number(t.b.level, 0.3, 1e-9);
    assert_int_equal(mps_lease_begin(t.b.sim, "position", MPS_READ, &x), MPS_OK);
    assert_int_equal(mps_lease_begin(t.b.sim, "kind", MPS_READ, &kind), MPS_OK);
    for (int64_t i = 0; i < x.count; i++) {
        const double *at = x.data + i * x.stride;
        if (kind.integers[i] != MPS_FLUID) continue;
        if (at[0] < 0.05) left = fmax(left, at[1]);
        if (at[0] > 0.95) right = fmax(right, at[1]);
    }
    mps_lease_end(t.b.sim, &kind);
    mps_lease_end(t.b.sim, &x);
    same_number(left - right, 0.04, 0.004);
    built_free(&t);
}

/* The second mode of a droplet in air with relative amplitude a: kinetic energy 3/2 pi sigma R a^2,
 * inside and outside together. */
static void oscillation(void **state)
{
    built t;
    (void)state;
    make(&t, "dp: 10 mm\ntank: {size: 1 1 m}",
         "model: mmps\nsettings: {tension.sigma: 72.7 mN/m}\nfill: [{water: {sphere: {centre: 0.5 "
         "0.5 m, radius: 0.2 m}, start: {oscillation: 5 %}}}, {air: rest}]");
    const double exact = 1.5 * acos(-1.0) * 0.0727 * 0.2 * 0.05 * 0.05;
    printf("oscillation: %g J/m of %g\n", energy(&t).kinetic, exact);
    same_number(energy(&t).kinetic, exact, 0.02 * exact);
    built_free(&t);
}

static void refused(void **state)
{
    static const struct {
        const char *rest, *words;
    } wrong[] = {
        {"fill: [{water: {depth: 0.7 m}}]", "more than the tank is high"},
        {"fill: [{water: {box: [0 0 m]}}]", "two|2"},
        {"fill: [{water: {depth: 0.3 m, start: {standing_wave: 0.2 m}}}]", "less than half"},
        {"fill: [{water: {depth: 50 %}}]\nsolids: {b: {prism: [0 0 m, 1 0 m]}}", "3"},
        {"fill: [{water: {depth: 50 %}}]\nsolids: {b: {cylinder: {from: 0 0 0 m, to: 0 1 0 m, "
         "radius: 0.1 m}}}",
         "3-D"},
        {"fill: [{water: {depth: 50 %}}]\nsolids: {b: {plate: [0.5 0.1 m, 0.5 0.1 m]}}", "no area"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[600];
        built t;
        snprintf(text, sizeof text, "mps: 1\n%s\nrun: {until: 1 s}\n%s\n", FLAT, wrong[i].rest);
        assert_int_not_equal(built_try(&t, text, NULL), MPS_OK);
        char *all = kit_messages(t.c);
        bool found = false;
        char words[80], *rest = NULL;
        snprintf(words, sizeof words, "%s", wrong[i].words);
        for (char *w = strtok_r(words, "|", &rest); w; w = strtok_r(NULL, "|", &rest))
            found = found || strstr(all, w);
        if (!found) fail_msg("%s: %s", wrong[i].rest, all);
        free(all);
        built_free(&t);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {cmocka_unit_test(fills),          cmocka_unit_test(bodies),
                                 cmocka_unit_test(few_rows),       cmocka_unit_test(two_fluids),
                                 cmocka_unit_test(start_velocity), cmocka_unit_test(standing_wave),
                                 cmocka_unit_test(oscillation),    cmocka_unit_test(refused)};
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
