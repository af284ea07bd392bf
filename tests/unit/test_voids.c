/* SPDX-License-Identifier: BSD-3-Clause */
/* Voids of the tank: random shapes are found, with their extent, and separated correctly. */
#include "void_fixture.h"

/* A cell counts by its centre: the error of the extent is a fraction of the length of the
 * outline. */
static void expect_extent(const found_voids *f, int32_t label, double extent, double outline)
{
    const double seen = extent_of(f, label);
    if (!(fabs(seen - extent) < 0.25 * DP * outline))
        fail_msg("component %d has %g m2, drawn are %g, outline %g m", label, seen, extent,
                 outline);
}

static int above(const double *X)
{
    return X[1] > 0.48;
}

static void test_calm(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, none);
    (void)state;
    step_and_end(sim);
    assert_int_equal(f.v.dim, 2);
    assert_int_equal(f.v.count, 1);
    assert_int_equal(f.v.faces, 0);
    ASSERT_NEAR(f.v.side, DP / 2, 1e-15);
    assert_true(share_within(&f, 0, above) == 1);
    ASSERT_NEAR(extent_of(&f, 0), 0.3, 1.0 * DP);
    forget_voids(&f);
}

static int at_wall(const double *X)
{
    return hypot(X[0], X[1] - 0.25) < 0.12;
}

static void test_circle(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, in_circle);
    (void)state;
    step_and_end(sim);
    assert_int_equal(f.v.count, 2);
    assert_true(share_within(&f, 1, in_circle) > 0.95);
    expect_extent(&f, 1, acos(-1) * 0.12 * 0.12, 2 * acos(-1) * 0.12);
    forget_voids(&f);
}

static void test_two(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, in_both);
    (void)state;
    step_and_end(sim);
    assert_int_equal(f.v.count, 3);
    assert_true(share_within(&f, 1, in_box) > 0.95);
    assert_true(share_within(&f, 2, in_circle) > 0.95);
    expect_extent(&f, 1, 0.212 * 0.132, 2 * (0.212 + 0.132));
    expect_extent(&f, 2, acos(-1) * 0.12 * 0.12, 2 * acos(-1) * 0.12);
    forget_voids(&f);
}

static void test_at_wall(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, at_wall);
    (void)state;
    step_and_end(sim);
    assert_int_equal(f.v.count, 2);
    assert_true(share_within(&f, 1, at_wall) > 0.95);
    expect_extent(&f, 1, acos(-1) * 0.12 * 0.12 / 2, acos(-1) * 0.12);
    forget_voids(&f);
}

/* ---- what parts voids ---- */

/* A pocket below one row of liquid, which falls on it. */
static int below_film(const double *X)
{
    return fabs(X[0] - 0.5) < 0.15 && X[1] > 0.35 && X[1] < 0.47;
}

static int below_and_above_film(const double *X)
{
    return below_film(X) || (fabs(X[0] - 0.5) < 0.15 && X[1] > 0.49);
}

static void test_film(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, below_and_above_film);
    int64_t films = 0;
    (void)state;
    step_and_end(sim);
    assert_int_equal(f.v.count, 2);
    assert_true(share_within(&f, 1, below_film) > 0.9);
    for (int64_t k = 0; k < f.v.faces; k++) {
        const int32_t behind = f.face[3][k];
        assert_true(f.face[0][k] == f.label[f.face[1][k]] && behind != f.face[0][k]);
        assert_true(behind >= 0 || behind == MPS_VOID_SOLID || f.face_id[k] >= 0);
        films += f.face[0][k] == 1 && f.face[2][k] == 3;
    }
    assert_true(films > 20); /* the upper side of the pocket */
    forget_voids(&f);
}

/* A neck of two rows' width is closed, one of four rows' open. */
static int with_neck(const double *X, double width)
{
    return below_film(X) || (fabs(X[0] - 0.51) < width / 2 && X[1] > 0.35);
}

static int narrow_neck(const double *X)
{
    return with_neck(X, 0.02 - 1e-6);
}

static int wide_neck(const double *X)
{
    return with_neck(X, 0.08);
}

static void test_neck(void **state)
{
    found_voids f;
    (void)state;
    step_and_end(drawn_2d(&f, narrow_neck));
    assert_int_equal(f.v.count, 2);
    forget_voids(&f);
    step_and_end(drawn_2d(&f, wide_neck));
    assert_int_equal(f.v.count, 1);
    forget_voids(&f);
}

static int left_of_plate(const double *X)
{
    return X[0] < 0.6 + 0.1 * X[1] / 0.8;
}

static int right_of_plate(const double *X)
{
    return !left_of_plate(X);
}

/* An inclined thin plate from floor to roof divides the ullage and a void that crosses it. */
static int across_plate(const double *X)
{
    return fabs(X[0] - 0.62) < 0.12 && fabs(X[1] - 0.2) < 0.1;
}

static void test_plate(void **state)
{
    found_voids f;
    mps_sim *sim = new_sim(2, DP);
    (void)state;
    add_tank(sim, 1, 0.8, 0);
    add_dividing_plate(sim);
    fill_drawn(sim, 2, 0.5, across_plate);
    watch_voids(sim, &f);
    step_and_end(sim);
    assert_int_equal(f.v.count, 4);
    const int32_t left = share_within(&f, 1, left_of_plate) == 1 ? 1 : 3, right = 4 - left;
    assert_true(share_within(&f, 0, left_of_plate) == 1);
    assert_true(share_within(&f, 2, right_of_plate) == 1);
    assert_true(share_within(&f, left, left_of_plate) == 1);
    assert_true(share_within(&f, right, right_of_plate) == 1);
    assert_true(share_within(&f, left, across_plate) > 0.9);
    assert_true(share_within(&f, right, across_plate) > 0.9);
    ASSERT_NEAR(extent_of(&f, 0) + extent_of(&f, 2), 0.3, 0.015);
    forget_voids(&f);
}

static int in_baffle(const double *X)
{
    return fabs(X[0] - 0.5) < 0.09 && X[1] < 0.6;
}

/* A surface-piercing block in a void: two voids next to it, and none of their cells in it. */
static int round_block(const double *X)
{
    return fabs(X[0] - 0.5) < 0.206 && fabs(X[1] - 0.2) < 0.086;
}

static void test_block(void **state)
{
    const double lo[2] = {0.4, 0}, hi[2] = {0.6, 0.6};
    found_voids f;
    mps_sim *sim = new_sim(2, DP);
    (void)state;
    add_tank(sim, 1, 0.8, 0);
    ASSERT_OK(sim, mps_baffle_add(sim, "block", lo, hi, NULL));
    fill_drawn(sim, 2, 0.5, round_block);
    watch_voids(sim, &f);
    step_and_end(sim);
    assert_int_equal(f.v.count, 3);
    for (int32_t k = 0; k < 3; k++) ASSERT_NEAR(share_within(&f, k, in_baffle), 0, 0);
    expect_extent(&f, 1, 0.106 * 0.172, 2 * (0.106 + 0.172));
    expect_extent(&f, 2, 0.106 * 0.172, 2 * (0.106 + 0.172));
    forget_voids(&f);
}

/* ---- any tank, any pose ---- */

static int in_shell(void *user, const double *X)
{
    (void)user;
    return hypot(X[0] - 0.5, X[1] - 0.5) > 0.5;
}

static int in_ring(const double *X)
{
    return hypot(X[0] - 0.5, X[1] - 0.5) < 0.505;
}

static int low_circle(const double *X)
{
    return hypot(X[0] - 0.55, X[1] - 0.25) < 0.12;
}

/* A round tank: cells outside of it are none of its void. */
static void test_round_tank(void **state)
{
    found_voids f;
    mps_solid solid;
    mps_sim *sim = new_sim(2, DP);
    (void)state;
    assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
    solid.inside = in_shell;
    solid.hi[0] = solid.hi[1] = 1;
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    fill_drawn(sim, 2, 0.5, low_circle);
    watch_voids(sim, &f);
    step_and_end(sim);
    assert_int_equal(f.v.count, 2);
    assert_true(share_within(&f, 0, in_ring) == 1);
    ASSERT_NEAR(extent_of(&f, 0), acos(-1) / 8, 0.02);
    expect_extent(&f, 1, acos(-1) * 0.12 * 0.12, 2 * acos(-1) * 0.12);
    forget_voids(&f);
}

static int tilted(void *user, double t, mps_motion_state *state)
{
    (void)user, (void)t;
    state->value[MPS_ROTATE_Z] = 2.2;
    state->value[MPS_MOVE_X] = 3;
    return 0;
}

/* The grid is fixed in the frame of the tank: it is the same in an inverted tank. */
static void test_tilted(void **state)
{
    found_voids upright, f;
    mps_sim *sim = drawn_2d(&upright, in_both);
    (void)state;
    step_and_end(sim);
    sim = drawn_2d(&f, in_both);
    ASSERT_OK(sim, mps_motion_callback_set(sim, tilted, NULL));
    step_and_end(sim);
    assert_int_equal(f.v.count, 3);
    assert_memory_equal(f.size, upright.size, 3 * sizeof *f.size);
    assert_memory_equal(f.label, upright.label, (size_t)cells_of(&f.v) * sizeof *f.label);
    assert_int_equal(f.v.faces, upright.v.faces);
    forget_voids(&upright);
    forget_voids(&f);
}

static int in_sphere(const double *X)
{
    return hypot(hypot(X[0] - 0.5, X[1] - 0.3), X[2] - 0.25) < 0.2;
}

static int at_corner(const double *X)
{
    return hypot(hypot(X[0] - 1, X[1]), X[2]) < 0.25;
}

static int in_sphere_or_corner(const double *X)
{
    return in_sphere(X) || at_corner(X);
}

/* Void reaches to `nearest` from the outline at least; wet walls within 1.5 dp of it are liquid
 * too. */
static void expect_shells(const found_voids *f, int32_t label, double factor, double r,
                          double nearest)
{
    const double seen = extent_of(f, label);
    if (!(seen > factor * pow(r - nearest, 3) && seen < factor * pow(r - 0.3 * 0.04, 3)))
        fail_msg("%g m3 of a sphere of %g m", seen, r);
}

static void expect_sphere(double side)
{
    const double pi = acos(-1);
    found_voids f;
    drawing d = {in_sphere_or_corner, 0.65, 1};
    mps_sim *sim = new_sim(3, 0.04);
    add_tank(sim, 1, 0.8, 0.6);
    ASSERT_OK(sim, mps_fill_add(sim, 0, is_drawn, &d, NULL));
    watch_voids(sim, &f);
    f.config.side = side;
    step_and_end(sim);
    assert_int_equal(f.v.count, 3);
    ASSERT_NEAR(f.v.side, (side > 0 ? side : 1) * 0.04, 1e-12);
    const int32_t corner = share_within(&f, 1, at_corner) > 0.5 ? 1 : 2;
    assert_true(share_within(&f, corner, at_corner) > 0.9);
    assert_true(share_within(&f, 3 - corner, in_sphere) > 0.9);
    expect_shells(&f, 3 - corner, 4 * pi / 3, 0.2, 0.9 * 0.04);
    expect_shells(&f, corner, pi / 6, 0.25, 1.3 * 0.04);
    forget_voids(&f);
}

static void test_3d(void **state)
{
    (void)state;
    expect_sphere(0);
    expect_sphere(0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_calm),       cmocka_unit_test(test_circle),
        cmocka_unit_test(test_two),        cmocka_unit_test(test_at_wall),
        cmocka_unit_test(test_film),       cmocka_unit_test(test_neck),
        cmocka_unit_test(test_plate),      cmocka_unit_test(test_block),
        cmocka_unit_test(test_round_tank), cmocka_unit_test(test_tilted),
        cmocka_unit_test(test_3d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
