/* SPDX-License-Identifier: BSD-3-Clause */
/* Voids of the tank: drawn shapes are found, with their extent, and parted where they are. */
#include "void_fixture.h"

static const double DP = 0.02;

/* A tank of 1 m x 0.8 m with liquid up to 0.5 m but for a drawn void, after one step. */
static mps_sim *drawn_2d(found_voids *f, int (*is_void)(const double *))
{
    mps_sim *sim = new_sim(2, DP);
    add_tank(sim, 1, 0.8, 0);
    fill_drawn(sim, 2, 0.5, is_void);
    watch_voids(sim, f);
    return sim;
}

static void step_and_end(mps_sim *sim)
{
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* A cell counts by its centre: the extent is known within a share of the outline's length. */
static void expect_extent(const found_voids *f, int32_t label, double extent, double outline)
{
    const double seen = extent_of(f, label);
    if (!(fabs(seen - extent) < 0.25 * DP * outline))
        fail_msg("component %d has %g m2, drawn are %g, outline %g m", label, seen, extent,
                 outline);
}

static int none(const double *X)
{
    (void)X;
    return 0;
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

static int in_circle(const double *X)
{
    return hypot(X[0] - 0.503, X[1] - 0.252) < 0.12;
}

static int in_box(const double *X)
{
    return fabs(X[0] - 0.2) < 0.106 && fabs(X[1] - 0.2) < 0.066;
}

static int in_both(const double *X)
{
    return in_circle(X) || in_box(X);
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_calm), cmocka_unit_test(test_circle),
                                       cmocka_unit_test(test_two), cmocka_unit_test(test_at_wall)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
