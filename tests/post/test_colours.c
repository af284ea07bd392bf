/* SPDX-License-Identifier: BSD-3-Clause */
/* The colours of phases: lightness increases monotonically in each map, and the maps of two phases
 * are distinguishable for all readers. Colour blindness by Machado, Oliveira & Fernandes 2009
 * (severity 1), distances in CIE L*a*b*. */
#include "page_scale.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { SIGHTS = 4, STEPS = 33 };

static const double sight[SIGHTS][9] = {
    {1, 0, 0, 0, 1, 0, 0, 0, 1},
    {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
    {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881},
    {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900}};
static const char *const name[SIGHTS] = {"full sight", "protanopia", "deuteranopia", "tritanopia"};

static double linear(double c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double root(double t)
{
    return t > 0.008856 ? cbrt(t) : 7.787 * t + 16.0 / 116;
}

/* Colour at fraction f of a map as perceived by a reader: L*, a*, b*. */
static void seen(int map, double f, int who, double lab[3])
{
    static const double to_xyz[9] = {0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522,
                                     0.0721750, 0.0193339, 0.1191920, 0.9503041};
    static const double white[3] = {0.95047, 1, 1.08883};
    double own[3], eye[3], xyz[3];
    const double at = f * (SCALE_COLOURS - 1);
    const int k = at < SCALE_COLOURS - 2 ? (int)at : SCALE_COLOURS - 2;
    for (int c = 0; c < 3; c++)
        own[c] = linear(mps__scale_map[map][k][c] +
                        (at - k) * (mps__scale_map[map][k + 1][c] - mps__scale_map[map][k][c]));
    for (int c = 0; c < 3; c++) {
        eye[c] = 0;
        for (int d = 0; d < 3; d++) eye[c] += sight[who][3 * c + d] * own[d];
        eye[c] = fmax(0, fmin(eye[c], 1));
    }
    for (int c = 0; c < 3; c++) {
        xyz[c] = 0;
        for (int d = 0; d < 3; d++) xyz[c] += to_xyz[3 * c + d] * eye[d];
        xyz[c] = root(xyz[c] / white[c]);
    }
    lab[0] = 116 * xyz[1] - 16;
    lab[1] = 500 * (xyz[0] - xyz[1]);
    lab[2] = 200 * (xyz[1] - xyz[2]);
}

static void lightness_grows(void **state)
{
    (void)state;
    for (int who = 0; who < SIGHTS; who++)
        for (int map = 0; map < SCALE_MAPS; map++) {
            double first[3], last[3], a[3], b[3];
            seen(map, 0, who, first);
            seen(map, 1, who, last);
            for (int k = 1; k < STEPS; k++) {
                seen(map, (k - 1.0) / (STEPS - 1), who, a);
                seen(map, (double)k / (STEPS - 1), who, b);
                if (!((b[0] - a[0]) * (last[0] - first[0]) > 0))
                    fail_msg("%s: map %d turns at %d", name[who], map, k);
            }
            assert_true(fabs(last[0] - first[0]) > 25);
        }
}

/* 10 is a clear difference; the maps of the first version had 0.3. */
static void phases_differ(void **state)
{
    (void)state;
    for (int who = 0; who < SIGHTS; who++)
        for (int pair = 0; pair < 3; pair++) {
            double least = INFINITY, a[3], b[3];
            for (int i = 0; i < STEPS; i++)
                for (int j = 0; j < STEPS; j++) {
                    seen(pair > 1, (double)i / (STEPS - 1), who, a);
                    seen(pair > 0 ? 2 : 1, (double)j / (STEPS - 1), who, b);
                    least = fmin(least, sqrt((a[0] - b[0]) * (a[0] - b[0]) +
                                             (a[1] - b[1]) * (a[1] - b[1]) +
                                             (a[2] - b[2]) * (a[2] - b[2])));
                }
            if (!(least > 10)) fail_msg("%s: pair %d comes to %.1f", name[who], pair, least);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lightness_grows),
                                       cmocka_unit_test(phases_differ)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
