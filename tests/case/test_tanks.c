/* SPDX-License-Identifier: BSD-3-Clause */
/* Volumes, levels and natural periods of tanks that cases build, against their exact values. */
#include "build_kit.h"
#include "../every.h"
#include "section.h"

/* Volume of all fluid with its half cells at walls. */
static double volume(const built *t)
{
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    assert_int_equal(mps_energy_get(t->b.sim, &e), MPS_OK);
    return e.volume_filled;
}

/* Area of a polygon below a level. */
static double area_below(const double (*p)[2], int n, double level)
{
    double twice = 0, cut[64][2];
    int count = 0;
    for (int i = 0; i < n; i++) {
        const double *a = p[i], *b = p[(i + 1) % n];
        if (a[1] <= level) memcpy(cut[count++], a, sizeof *cut);
        if ((a[1] <= level) != (b[1] <= level)) {
            const double f = (level - a[1]) / (b[1] - a[1]);
            cut[count][0] = a[0] + f * (b[0] - a[0]);
            cut[count++][1] = level;
        }
    }
    for (int i = 0; i < count; i++) {
        const double *a = cut[i], *b = cut[(i + 1) % count];
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return 0.5 * fabs(twice);
}

static const double CHAMFERED[8][2] = {{0.095, 0},    {0.855, 0},    {0.95, 0.095}, {0.95, 0.455},
                                       {0.735, 0.67}, {0.215, 0.67}, {0, 0.455},    {0, 0.095}};

#define CHAMFER \
    "mps: 1\ndp: %g mm\ntank: {size: 950 670 mm, chamfer: {bottom: 95 95 mm, top: 215 215 mm}}\n"

/* In a chamfered tank the volume is that of the polygon below the level, within 0.2 %. Of liquid
 * that is 13 spacings deep at its lowest, between slopes, it is 0.3 %. */
static void chamfered(void **state)
{
    static const struct {
        double share, dp, most;
    } fill[] = {{0.1, 5, 0.003},   {0.1, 2.5, 0.002}, {0.3, 5, 0.002},
                {0.3, 2.5, 0.002}, {0.6, 5, 0.002},   {0.9, 5, 0.002}};
    (void)state;
    for (size_t i = 0; i < sizeof fill / sizeof *fill; i++) {
        char text[400];
        built t;
        snprintf(text, sizeof text, CHAMFER "fill: [{water: {depth: %g %%}}]\nrun: {until: 1 s}\n",
                 fill[i].dp, 100 * fill[i].share);
        built_make(&t, text, NULL);
        const double exact = area_below(CHAMFERED, 8, 0.67 * fill[i].share),
                     off = volume(&t) / exact - 1;
        printf("chamfered tank, %g %%, dp %g mm: %.5f m2 of %.5f m2, %+.3f %%\n",
               100 * fill[i].share, fill[i].dp, volume(&t), exact, 100 * off);
        assert_true(fabs(off) < fill[i].most);
        same_number(t.b.level, 0.67 * fill[i].share, 0.02 * t.b.dp);
        built_free(&t);
    }
}

/* The same tank in 3-D, with the chamfers across x or across z. */
static void chamfered_3d(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[500];
        built t;
        if (!has_turn(k, 0, 2)) continue;
        snprintf(text, sizeof text,
                 "mps: 1\ndim: 3\ndp: 40 mm\ntank: {size: %s m, chamfer: {bottom: 0.4 0.4 m, top: "
                 "0.8 0.8 m, across: %c}}\nfill: [{water: {depth: 1 m}}]\nrun: {until: 1 s}\n",
                 k ? "1.2 2 4" : "4 2 1.2", "xz"[k]);
        built_make(&t, text, NULL);
        const double exact = (4 * 1 - 0.4 * 0.4) * 1.2, off = volume(&t) / exact - 1;
        printf("3-D, across %c: %.4f m3 of %.4f m3, %+.2f %%\n", "xz"[k], volume(&t), exact,
               100 * off);
        assert_true(fabs(off) < 0.01);
        built_free(&t);
    }
}

/* An inclined tank, as a rotated polygon: the lattice does not follow its walls. */
static void rolled(void **state)
{
    const double angle = 0.31, c = cos(angle), s = sin(angle);
    double p[4][2], corner[4][2] = {{0, 0}, {1, 0}, {1, 0.7}, {0, 0.7}}, floor = 0;
    char text[600];
    built t;
    (void)state;
    for (int i = 0; i < 4; i++) {
        p[i][0] = c * corner[i][0] - s * corner[i][1];
        p[i][1] = s * corner[i][0] + c * corner[i][1];
        floor = fmin(floor, p[i][1]);
    }
    snprintf(text, sizeof text,
             "mps: 1\ndp: 10 mm\ntank: {polygon: [%.17g %.17g m, %.17g %.17g m, %.17g %.17g m, "
             "%.17g %.17g m]}\nfill: [{water: {depth: 0.4 m}}]\nrun: {until: 1 s}\n",
             p[0][0], p[0][1], p[1][0], p[1][1], p[2][0], p[2][1], p[3][0], p[3][1]);
    built_make(&t, text, NULL);
    const double exact = area_below((const double(*)[2])p, 4, floor + 0.4),
                 off = volume(&t) / exact - 1;
    printf("rolled polygon: %.5f m2 of %.5f m2, %+.3f %%\n", volume(&t), exact, 100 * off);
    assert_true(fabs(off) < 0.01);
    built_free(&t);
}

/* A cylinder with heads: volume by mps__form_volume() is that of a grid of points inside. */
static void forms(void **state)
{
    form f = {.kind = FORM_TUBE, .dim = 3, .radius = 0.25, .length = 0.6, .heads = 0.125};
    const double hi[3] = {0.85, 0.5, 0.25}, lo[3] = {0, 0, -0.25};
    const double step = 0.005;
    int64_t inside = 0;
    (void)state;
    memcpy(f.lo, lo, sizeof lo);
    memcpy(f.hi, hi, sizeof hi);
    for (double x = 0.5 * step; x < 0.85; x += step)
        for (double y = 0.5 * step; y < 0.5; y += step)
            for (double z = -0.25 + 0.5 * step; z < 0.25; z += step)
                inside += mps__form_inside(&f, (const double[]){x, y, z}) > 0;
    const double counted = (double)inside * step * step * step;
    assert_true(fabs(counted / mps__form_volume(&f) - 1) < 0.002);
    form rod = {.kind = FORM_ROD, .dim = 3, .end = {{0, 0, 0}, {3, 4, 0}}, .radius = 1};
    mps__form_box(&rod);
    same_number(mps__form_inside(&rod, (const double[]){1.5, 2, 0}), 1, 1e-12);
    same_number(mps__form_inside(&rod, (const double[]){1.5, 2, 3}), -2, 1e-12);
    same_number(mps__form_inside(&rod, (const double[]){-0.6, -0.8, 0}), -1, 1e-12);
    same_number(mps__form_inside(&rod, (const double[]){3.6, 4.8, 2}), -hypot(1, 1), 1e-12);
    same_number(rod.lo[0], -0.8, 1e-12);
    same_number(rod.hi[1], 4.6, 1e-12);
}

/* Volume of a shape up to a level: a box; the chamfered section 20 x 12 m, whose chamfers take 9 m2
 * below and 36 m2 above. */
static void below(void **state)
{
    form box = {.kind = FORM_BOX, .dim = 3, .lo = {1, 1, 1}, .hi = {3, 4, 2}};
    form tank = {.kind = FORM_POLYGON,
                 .dim = 2,
                 .points = 8,
                 .point = {{3, 0}, {17, 0}, {20, 3}, {20, 6}, {14, 12}, {6, 12}, {0, 6}, {0, 3}}};
    (void)state;
    same_number(mps__form_volume_below(&box, 2.5), 3, 1e-12);
    same_number(mps__form_volume_below(&box, 9), 6, 1e-12);
    same_number(mps__form_volume_below(&box, 0.5), 0, 1e-12);
    mps__form_box(&tank);
    for (int i = 0; i <= 48; i++) {
        const double y = 0.25 * i, low = fmin(y, 3), high = fmax(y - 6, 0);
        same_number(mps__form_volume_below(&tank, y), 20 * y - (6 * low - low * low) - high * high,
                    1e-12);
    }
    tank.dim = 3;
    tank.sideways = true;
    tank.lo[0] = 0;
    tank.hi[0] = 5;
    same_number(mps__form_volume_below(&tank, 3.6), 5 * 63, 1e-12);
    tank.kind = FORM_TUBE;
    assert_true(isnan(mps__form_volume_below(&tank, 3.6)));
}

/* T1 of a rectangular tank is that of the requested size, for any spacing; 40 x 20 m, g 9.807,
 * 7.476 s. */
static void periods(void **state)
{
    static const char *const dps[] = {"dp=0.5 m", "dp=0.7 m"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        built t;
        const char *sets[] = {dps[i], NULL};
        built_make(&t,
                   "mps: 1\ndp: 1 m\ntank: {size: 40 30 m}\nfill: [{water: {depth: 20 m}}]\n"
                   "gravity: 9.807 m/s2\nrun: {until: 2 T1}\n",
                   sets);
        const double pi = acos(-1.0), k = pi / 40;
        same_number(t.b.modes.period[0], 2 * pi / sqrt(9.807 * k * tanh(k * 20)), 1e-12);
        assert_true(fabs(t.b.modes.period[0] - 7.476) < 0.003);
        same_number(t.b.until, 2 * t.b.modes.period[0], 1e-12);
        built_free(&t);
    }
}

/* Sections: the first value w^2/g of a rectangle k tanh(k h), of planes at 45 degrees 1/h (phi = x
 * y), of a half-full circle 1.3557/R. */
static void sections(void **state)
{
    const double pi = acos(-1.0);
    form box = {
        .kind = FORM_POLYGON, .dim = 2, .points = 4, .point = {{1, 0}, {3, 0}, {3, 2}, {1, 2}}};
    form wedge = {.kind = FORM_POLYGON, .dim = 2, .points = 3, .point = {{-1, 1}, {0, 0}, {1, 1}}};
    form circle = {.kind = FORM_BALL, .dim = 2, .end = {{0, 2}}, .radius = 2};
    double value[3];
    (void)state;
    mps__form_box(&box);
    mps__form_box(&wedge);
    mps__form_box(&circle);
    for (double depth = 0.2; depth < 2; depth += 0.6) {
        assert_int_equal(mps__section_modes(&box, depth, 3, value), MPS_OK);
        for (int n = 1; n <= 3; n++) {
            const double k = n * pi / 2, off = value[n - 1] / (k * tanh(k * depth)) - 1;
            printf("rectangle, depth %g, mode %d: %+.3f %%\n", depth, n, 100 * off);
            assert_true(fabs(off) < (n == 1 ? 0.0005 : 0.0025));
        }
    }
    assert_int_equal(mps__section_modes(&wedge, 0.8, 1, value), MPS_OK);
    printf("wedge: %+.3f %%\n", 100 * (value[0] * 0.8 - 1));
    assert_true(fabs(value[0] * 0.8 - 1) < 0.001);
    assert_int_equal(mps__section_modes(&circle, 2, 1, value), MPS_OK);
    printf("circle: %+.3f %%\n", 100 * (value[0] * 2 / 1.35573 - 1));
    assert_true(fabs(value[0] * 2 / 1.35573 - 1) < 0.001);
}

/* Natural periods in cases; that of a cylinder is an estimate, and marked as such. */
static void methods(void **state)
{
    built t;
    (void)state;
    built_make(&t,
               "mps: 1\ndp: 0.5 m\ntank: {polygon: [0 0 m, 40 0 m, 40 30 m, 0 30 m]}\n"
               "fill: [{water: {depth: 20 m}}]\nrun: {until: 2 T1}\n",
               NULL);
    assert_true(fabs(t.b.modes.period[0] / 7.4745 - 1) < 0.002);
    assert_non_null(strstr(t.b.modes.how, "potential flow"));
    built_free(&t);
    built_make(&t,
               "mps: 1\ndim: 3\ndp: 50 mm\ntank: {cylinder: {radius: 0.5 m, length: 1.5 m}}\n"
               "fill: [{water: {depth: 50 %}}]\nrun: {until: 2 T1}\n",
               NULL);
    assert_non_null(strstr(t.b.modes.how, "estimate"));
    same_number(t.b.modes.length, 1.5, 1e-3);
    same_number(t.b.modes.depth, 0.25 * acos(-1.0) * 0.5, 0.05);
    built_free(&t);
    /* a cube from a file, exact; the upper row has a fraction of its points */
    built_make(&t,
               "mps: 1\ndim: 3\ndp: 60 mm\ntank: {stl: " CASES "cube.stl, unit: m}\n"
               "fill: [{water: {depth: 40 %}}]\nrun: {until: 2 T1}\n",
               NULL);
    assert_true(fabs(t.b.modes.period[0] / 1.2275 - 1) < 0.02);
    built_free(&t);
}

/* Waves run across the axis of a roll, along that of a surge. */
static void axes(void **state)
{
    static const struct {
        const char *set;
        int32_t axis;
    } motion[] = {{"motion={surge: {amplitude: 1 mm, omega: 1 rad/s}}", 0},
                  {"motion={roll: {amplitude: 1 deg, omega: 1 rad/s}}", 2},
                  {"motion={forward: z, roll: {amplitude: 1 deg, omega: 1 rad/s}}", 0},
                  {"motion={heave: {amplitude: 1 mm, omega: 1 rad/s}}", 0}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        built t;
        const char *sets[] = {motion[i].set, NULL};
        built_make(&t,
                   "mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 3 2 1.6 m}\n"
                   "fill: [{water: {depth: 1 m}}]\nrun: {until: 1 s}\n",
                   sets);
        assert_int_equal(t.b.modes.axis, motion[i].axis);
        same_number(t.b.modes.length, motion[i].axis ? 1.6 : 3, 1e-12);
        built_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chamfered), cmocka_unit_test(chamfered_3d), cmocka_unit_test(rolled),
        cmocka_unit_test(forms),     cmocka_unit_test(below),        cmocka_unit_test(periods),
        cmocka_unit_test(sections),  cmocka_unit_test(methods),      cmocka_unit_test(axes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
