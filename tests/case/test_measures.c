/* SPDX-License-Identifier: BSD-3-Clause */
/* Measures of the drivers: interfaces, cavities, stray particles, on shapes cut from a lattice. */
#include "../tags.h"
#include "cloud.h"
#include "cavity.h"
#include "interface.h"
#include "phases.h"
#include "tank_fixture.h"

static const double dp = 0.01, pi = 3.14159265358979323846;
static const double size[3] = {1, 0.8, 0.1};

typedef struct disc {
    double x, y, radius;
} disc;

static int in_disc(void *user, const double *x)
{
    const disc *d = user;
    return hypot(x[0] - d->x, x[1] - d->y) < d->radius;
}

static int in_water(void *user, const double *x)
{
    return x[1] < 0.5 && !in_disc(user, x);
}

/* A closed box with phase `phase` where `inside` returns true; elsewhere phase `rest`, if it is a
 * phase. */
static mps_sim *box_with(int32_t dim, mps_inside_fn inside, disc d, int32_t phase, int32_t rest)
{
    const double lo[3] = {0};
    mps_phase other;
    mps_sim *sim = new_sim(dim, dp);
    assert_int_equal(mps_phase_init(&other, sizeof other), MPS_OK);
    ASSERT_OK(sim, mps_phase_set(sim, 1, &other));
    add_tank(sim, size[0], size[1], size[2]);
    ASSERT_OK(sim, mps_fill_add(sim, phase, inside, &d, NULL));
    if (rest >= 0) ASSERT_OK(sim, mps_fill_box_add(sim, rest, lo, size, NULL, NULL));
    return sim;
}

static contour contour_of(mps_sim *sim, double width)
{
    const double lo[2] = {0};
    raster g;
    assert_true(mps__raster_create(&g, sim, lo, size, width));
    assert_true(mps__raster_fill(&g, sim));
    const contour c = mps__contour_measure(&g);
    mps__raster_free(&g);
    mps_sim_destroy(sim);
    return c;
}

/* Discs of 8 to 31 spacings anywhere on the lattice: circularity, area, box. */
static void disc_is_round(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int k = 0; k < 24; k++) {
        const disc d = {0.5 + dp * cloud_random(&seed), 0.4 + dp * cloud_random(&seed),
                        (8.0 + k) * dp};
        const contour c = contour_of(box_with(2, in_disc, d, 1, 0), 2);
        ASSERT_NEAR(2 * sqrt(pi * c.area) / c.length, 1, 0.005);
        ASSERT_NEAR(c.area / (pi * d.radius * d.radius), 1,
                    0.03); /* 2/3 (width dp/R)^2 and the cut lattice */
        ASSERT_NEAR(c.lo[0], d.x - d.radius, 0.5 * dp);
        ASSERT_NEAR(c.hi[0], d.x + d.radius, 0.5 * dp);
        ASSERT_NEAR(c.lo[1], d.y - d.radius, 0.5 * dp);
        ASSERT_NEAR(c.hi[1], d.y + d.radius, 0.5 * dp);
    }
}

static int in_ellipse(void *user, const double *x)
{
    const disc *d = user; /* twice as long as high */
    return hypot((x[0] - d->x) / sqrt(2.0), (x[1] - d->y) * sqrt(2.0)) < d->radius;
}

/* Ellipses of a bubble's size and flatness: 2 sqrt(pi area)/circumference is 0.9169. */
static void ellipse_is_as_long(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int k = 0; k < 12; k++) {
        const disc d = {0.5 + dp * cloud_random(&seed), 0.4 + dp * cloud_random(&seed),
                        (10.0 + k) * dp};
        const contour c = contour_of(box_with(2, in_ellipse, d, 1, 0), 2);
        const double circularity = 2 * sqrt(pi * c.area) / c.length;
        print_message("ellipse of %d dp: circularity %+.4f\n", 10 + k, circularity - 0.9169);
        assert_true(fabs(circularity - 0.9169) < 0.01);
    }
}

static int under_a_line(void *user, const double *x)
{
    const disc *d = user;
    return x[1] < d->y + d->radius * x[0];
}

/* Straight lines from wall to wall, horizontal ones exactly between the rows. */
static void line_is_straight(void **state)
{
    (void)state;
    for (double slope = 0; slope < 0.45; slope += 0.2) {
        const disc d = {0, 0.305, slope};
        const contour c = contour_of(box_with(2, under_a_line, d, 1, 0), 2);
        ASSERT_NEAR(c.length, hypot(1, slope), slope == 0 ? 1e-9 : 0.01);
        ASSERT_NEAR(c.area, 0.305 + 0.5 * slope, slope == 0 ? 1e-9 : 0.3 * dp);
        ASSERT_NEAR(c.hi[1], 0.305 + slope, slope == 0 ? 1e-9 : dp);
    }
}

static void no_line_in_one_phase(void **state)
{
    (void)state;
    const disc whole = {0.5, 0.4, 2};
    const contour none = contour_of(box_with(2, in_disc, whole, 0, -1), 2),
                  full = contour_of(box_with(2, in_disc, whole, 1, -1), 2);
    assert_true(none.length == 0 && none.area == 0 && isnan(none.lo[0]) && isnan(none.hi[1]));
    assert_true(full.length == 0 && isnan(full.lo[0]));
    ASSERT_NEAR(full.area, size[0] * size[1], 1e-9);
}

static double cavity_volume(mps_sim *sim)
{
    cavities c;
    assert_true(mps__cavities_create(&c, sim, (const double[3]){0}, size));
    const double volume = mps__cavities_volume(&c, sim);
    assert_true(volume == mps__cavities_volume(&c, sim));
    mps__cavities_free(&c);
    mps_sim_destroy(sim);
    return volume;
}

/* Lattice points in a disc, as an area. */
static double cut_out(const disc *d)
{
    int64_t count = 0;
    for (int i = 1; i < 100; i++)
        for (int j = 1; j < 80; j++) count += in_disc((void *)d, (const double[]){i * dp, j * dp});
    return (double)count * dp * dp;
}

/* A hole under the surface is measured, with gas in it or without; one that opens into the space
 * above is none. */
static void cavity_is_measured(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int k = 0; k < 8; k++)
        for (int32_t rest = -1; rest <= 1; rest += 2) {
            const disc d = {0.5 + dp * cloud_random(&seed), 0.25, (3.0 + k) * dp};
            ASSERT_NEAR(cavity_volume(box_with(2, in_water, d, 0, rest)), cut_out(&d),
                        0.02 * dp * 2 * pi * d.radius);
        }
    const disc open = {0.5, 0.47, 0.08}, in_wall = {0, 0.25, 0.08}, across = {0.5, 0.25, 0.06};
    assert_true(cavity_volume(box_with(2, in_water, open, 0, -1)) == 0);
    ASSERT_NEAR(cavity_volume(box_with(2, in_water, in_wall, 0, 1)), 0.5 * pi * 0.0064,
                0.1 * pi * 0.0064);
    ASSERT_NEAR(cavity_volume(box_with(3, in_water, across, 0, -1)), 0.09 * cut_out(&across),
                0.005 * cut_out(&across));
}

/* The gaps of an uneven lattice are no cavities. */
static void gaps_are_no_cavities(void **state)
{
    (void)state;
    const disc none = {0, 0, 0};
    mps_sim *sim = box_with(2, in_water, none, 0, -1);
    const int32_t *kind;
    mps_lease x = {.struct_size = sizeof x};
    uint64_t seed = 11;
    ASSERT_OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t i = 0; i < x.count * x.stride; i++)
        if (kind[i / x.stride] == MPS_FLUID) x.data[i] += 0.25 * dp * cloud_random(&seed);
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    assert_true(cavity_volume(sim) == 0);
}

static int in_specks(void *user, const double *x)
{
    const disc *d = user;
    return in_disc(user, x) || hypot(x[0] - d->x, x[1] - d->y - 0.2) < 0.6 * dp ||
           hypot(x[0] - d->x - 0.5 * dp, x[1] - d->y - 0.3) < 0.6 * dp;
}

/* One stray particle, and a pair of them; a disc is none, nor is fluid alone. */
static void strays_are_counted(void **state)
{
    (void)state;
    for (int32_t phase = 0; phase <= 1; phase++)
        for (int32_t rest = -1; rest <= 1; rest++) {
            if (rest == phase) continue;
            const disc d = {0.5, 0.3, 0.04};
            mps_sim *sim = box_with(2, in_specks, d, phase, rest);
            assert_int_equal(mps__phase_strays(sim), rest < 0 ? 0 : 3);
            mps_sim_destroy(sim);
        }
}

static void means_of_a_phase(void **state)
{
    (void)state;
    const disc d = {0.4, 0.3, 0.0973};
    phase_means m;
    mps_sim *sim = box_with(2, in_disc, d, 1, 0);
    assert_true(mps__phase_means_get(sim, 1, &m));
    ASSERT_NEAR(m.x[0], d.x, 1e-12);
    ASSERT_NEAR(m.x[1], d.y, 1e-12);
    ASSERT_NEAR(2 * sqrt(m.x2[0] - m.x[0] * m.x[0]), d.radius, 0.1 * dp);
    assert_true(m.u[0] == 0 && m.u[1] == 0);
    ASSERT_NEAR((double)m.count * dp * dp, pi * d.radius * d.radius,
                0.02 * pi * d.radius * d.radius);
    assert_false(mps__phase_means_get(sim, 2, &m));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(disc_is_round),      cmocka_unit_test(ellipse_is_as_long),
        cmocka_unit_test(line_is_straight),   cmocka_unit_test(no_line_in_one_phase),
        cmocka_unit_test(cavity_is_measured), cmocka_unit_test(gaps_are_no_cavities),
        cmocka_unit_test(strays_are_counted), cmocka_unit_test(means_of_a_phase),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
