/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of pictures without own pixels: ticks, the outside of a tank, the contents of a scene. */
#include "picture_axes.h"
#include "picture_fixture.h"
#include "picture_hull.h"

/* Round numbers inside the range, not too many, also far from zero and for ranges of any size. */
static void ticks_are_round(void **state)
{
    (void)state;
    static const double range[][2] = {{0, 1},        {-0.04, 0.84},   {0, 3100},
                                      {-1800, 1900}, {1e9, 1e9 + 1},  {1e17, 1.0000000000000002e17},
                                      {0, 1e-300},   {-1e300, 1e300}, {0.3, 0.30001}};
    for (size_t k = 0; k < sizeof range / sizeof range[0]; k++)
        for (int most = 0; most <= 80; most += 8) {
            ticks t;
            mps__axes_ticks(&t, range[k][0], range[k][1], most);
            assert_in_range(t.count, 0, AXES_TICKS);
            assert_true(t.count <= (most > 1 ? most : 1) + 1);
            const double digit = t.step / pow(10, floor(log10(t.step) + 1e-9));
            assert_true(fabs(digit - 1) < 1e-6 || fabs(digit - 2) < 1e-6 || fabs(digit - 5) < 1e-6);
            for (int i = 0; i < t.count; i++)
                assert_true(t.value[i] >= range[k][0] - 1e-6 * t.step &&
                            t.value[i] <= range[k][1] + 1e-6 * t.step);
        }
    ticks t;
    mps__axes_ticks(&t, -0.02, 0.82, 9);
    assert_int_equal(t.count, 9);
    ASSERT_NEAR(t.value[0], 0, 1e-12);
    ASSERT_NEAR(t.value[8], 0.8, 1e-12);
}

static void expect_outwards(const hull *h, float x, float y, float z, int a, int b, int c)
{
    const float at_place[3] = {x, y, z};
    const double wanted[3] = {a, b, c};
    double out[3];
    mps__hull_outwards(h, at_place, out);
    for (int d = 0; d < 3; d++)
        if (out[d] != wanted[d])
            fail_msg("at %g %g %g axis %d looks to %g", (double)x, (double)y, (double)z, d, out[d]);
}

/* A box with a plate in its middle: faces have outward normals, the plate has none. */
static void outside_of_a_box(void **state)
{
    (void)state;
    enum { N = 20 };
    const double dp = 0.05;
    scene s = {.dim = 3, .dp = dp};
    hull h;
    int64_t n = 0;
    assert_true(mps__scene_reserve(&s, (N + 1) * (N + 1) * (N + 1)));
    for (int k = 0; k < (N + 1) * (N + 1) * (N + 1); k++) {
        const int i[3] = {k % (N + 1), k / (N + 1) % (N + 1), k / (N + 1) / (N + 1)};
        bool face = i[0] == N / 2 && i[1] <= N / 2;
        for (int d = 0; d < 3; d++) face = face || i[d] == 0 || i[d] == N;
        if (!face) continue;
        for (int d = 0; d < 3; d++) s.x[3 * n + d] = (float)(i[d] * dp);
        s.p[n] = 0;
        s.phase[n] = 0;
        s.kind[n++] = SCENE_WALL;
    }
    s.n = n;
    assert_true(mps__scene_end(&s));
    assert_true(mps__hull_create(&h, &s));
    expect_outwards(&h, 0, 0.5f, 0.5f, -1, 0, 0);
    expect_outwards(&h, 1, 0.5f, 0.5f, 1, 0, 0);
    expect_outwards(&h, 0.5f, 0, 0.3f, 0, -1, 0);
    expect_outwards(&h, 0.3f, 1, 0.5f, 0, 1, 0);
    expect_outwards(&h, 0.5f, 0.5f, 1, 0, 0, 1);
    expect_outwards(&h, 1, 0.5f, 0, 1, 0, -1); /* an edge */
    expect_outwards(&h, 0.5f, 0.5f, 0.5f, 0, 0, 0);
    expect_outwards(&h, 0.5f, 0.3f, 0.7f, 0, 0, 0);
    mps__hull_free(&h);
    mps__scene_free(&s);
}

/* The extent includes fluid above an open tank, up to a quarter of the height; without walls only
 * the fluid; positions that are NaN are ignored. */
static void box_of_a_scene(void **state)
{
    (void)state;
    static const float point[4][3] = {{0, 0, 0}, {2, 1, 0}, {1, 1.1f, 0}, {1, 9, 0}};
    static const uint8_t kind[4] = {SCENE_WALL, SCENE_WALL, SCENE_FLUID, SCENE_FLUID};
    scene s = {.dim = 2, .dp = 0.1, .run_lo = {1, 1, 1}};
    assert_true(mps__scene_reserve(&s, 4));
    for (int k = 0; k < 4; k++) {
        memcpy(s.x + 3 * k, point[k], sizeof point[k]);
        s.kind[k] = kind[k];
        s.phase[k] = k == 3 ? 200 : 0;
    }
    assert_true(mps__scene_end(&s));
    assert_int_equal(s.phases, SCENE_PHASES);
    ASSERT_NEAR(s.hi[1], 1.25, 1e-6);
    ASSERT_NEAR(s.hi[0], 2, 1e-6);
    s.x[10] = NAN;
    assert_true(mps__scene_end(&s));
    ASSERT_NEAR(s.hi[1], 1.1, 1e-6);
    s.kind[0] = s.kind[1] = SCENE_FLUID;
    assert_true(mps__scene_end(&s));
    ASSERT_NEAR(s.lo[0], 0, 1e-6);
    for (int k = 0; k < 12; k++) s.x[k] = NAN;
    assert_false(mps__scene_end(&s));
    mps__scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ticks_are_round),
                                       cmocka_unit_test(outside_of_a_box),
                                       cmocka_unit_test(box_of_a_scene)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
