/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure on any face: a linear pressure is read exactly on flat faces, with any
 * surroundings; positions away from the wall are refused. */
#include "../every.h"
#include "probe_fixture.h"

/* after cmocka.h */
#include "../turns.h"

static const double slope[3] = {700, -9810, 2000};

/* Linear pressure on the walls, in the tank's frame. */
static double linear(const double *X, int dim)
{
    return 5000 + mps__dot(slope, X, dim);
}

static void write_linear(mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++)
        s->load[i] = s->kind[i] == MPS_WALL ? linear(&s->ref[i * s->dim], s->dim) : 0;
}

/* The sensor reads the pressure at its own position within `off` spacings. */
static void assert_linear(mps_sim *sim, double x, double y, double z, double diameter, double off)
{
    const int dim = sim->world.setup.dim;
    const double at[3] = {x, y, dim == 3 ? z : 0}, wanted = linear(at, dim),
                 most = sqrt(mps__dot(slope, slope, dim)) * off * dp + 1e-8;
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, x, y, at[2]);
    p.diameter = diameter;
    double got = NAN;
    int32_t id;
    if (mps_probe_add(sim, &p, &id) < 0)
        fail_msg("at (%g, %g, %g): %s", x, y, at[2], mps_sim_error(sim));
    ASSERT_OK(sim, mps_probe_read(sim, id, &got));
    if (!(fabs(got - wanted) <= most))
        fail_msg("dim %d, sensor of %g at (%g, %g, %g): %.9g instead of %.9g, %g dp off", dim,
                 diameter, x, y, at[2], got, wanted,
                 fabs(got - wanted) / sqrt(mps__dot(slope, slope, dim)) / dp);
}

static const double point = 1e-5; /* diameter of a sensor that does not reach beyond a face [m] */

/* ---- tanks ---- */

static void edges_and_corners(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0);
        write_linear(sim);
        for (double t = 0; t < 3 * dp; t += 0.23 * dp)
            for (double z = 0; z < (dim == 3 ? 2.5 * dp : 1e-9); z += 0.37 * dp) {
                assert_linear(sim, 0, t, z, point, 1e-3);
                assert_linear(sim, 0.4, 0.3 - t, z, point, 1e-3);
                assert_linear(sim, t, 0, z, point, 1e-3);
                assert_linear(sim, 0.4 - t, 0.3, 0.1 - z, point, 1e-3);
                if (dim == 3) assert_linear(sim, t, z, 0.1, point, 1e-3);
            }
        mps_sim_destroy(sim);
    }
}

/* ---- baffles ---- */

/* Sensors on both sides and the top of a baffle of n layers, from its foot on, and on the adjacent
 * floor. */
static void baffles(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int layers = 1; layers <= 7; layers += (int)every(2)) {
            const double left = 0.2, right = left + (layers - 1) * dp, lo[3] = {left, 0, 0},
                         hi[3] = {right, 0.1, 0.1}, z = 0.043;
            const double side = layers == 1 ? 1e-6 : 0;
            mps_sim *sim = filled(dim, 0);
            ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
            write_linear(sim);
            for (double y = 0.03 * dp; y < 9.6 * dp; y += 0.31 * dp)
                for (int large = 0; large < 2; large++) {
                    const double diameter = large && y > 0.5 * dp && y < 9.5 * dp ? dp : point;
                    assert_linear(sim, left - side, y, z, diameter, 1e-3);
                    assert_linear(sim, right + side, y, z, diameter, 1e-3);
                }
            for (double x = 0.07 * dp; x < 3 * dp; x += 0.31 * dp) {
                assert_linear(sim, left - x, 0, z, point, 1e-3);
                assert_linear(sim, right + x, 0, z, point, 1e-3);
            }
            for (double x = left + 1.2 * dp; x < right - 1.2 * dp; x += 0.31 * dp)
                assert_linear(sim, x, 0.1, z, dp, 1e-3);
            mps_sim_destroy(sim);
        }
}

/* Liquid on only one side of a baffle: sensors on the dry side and its floor do not read the
 * liquid, and sensors on the wet side do not read the dry one. */
static void sides_of_baffles(void **state)
{
    (void)state;
    for (int layers = 1; layers <= 6; layers++) {
        const double left = 0.2, right = left + (layers - 1) * dp, lo[2] = {left, 0},
                     hi[2] = {right, 0.3};
        mps_sim *sim = filled(2, 0);
        ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
        const mps__particles *s = &sim->world.particles;
        for (int64_t i = 0; i < s->n; i++) {
            const double *X = &s->ref[2 * i], *area = &s->area[2 * i];
            const double before = X[0] - left + (layers == 1 ? 1e-6 * area[0] / dp : 0);
            s->load[i] = s->kind[i] == MPS_WALL && before < 1e-9 ? linear(X, 2) : 0;
        }
        for (double t = 0.1 * dp; t < 3 * dp; t += 0.31 * dp) {
            assert_linear(sim, left - 1e-6, t, 0, point, 1e-3);
            assert_linear(sim, left - t, 0, 0, point, 1e-3);
            mps_probe dry = probe_of(MPS_PROBE_WALL_PRESSURE, right + 1e-6, t, 0);
            ASSERT_NEAR(read_one(sim, &dry), 0, 1e-9);
            dry = probe_of(MPS_PROBE_WALL_PRESSURE, right + t, 0, 0);
            ASSERT_NEAR(read_one(sim, &dry), 0, 1e-9);
        }
        mps_sim_destroy(sim);
    }
}

static void inclined_plates(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double angle = 0.2; angle < 1.5; angle += 0.3) {
            const double corner[3] = {0.2, 0, 0.02},
                         edge[3] = {0.12 * cos(angle), 0.12 * sin(angle), 0},
                         edge2[3] = {0, 0, 0.06};
            mps_sim *sim = filled(dim, 0);
            ASSERT_OK(sim, mps_plate_add(sim, "plate", corner, edge, dim == 3 ? edge2 : NULL));
            write_linear(sim);
            for (double t = 0.02; t < 0.95; t += 0.0371)
                for (int side = -1; side <= 1 && t * edge[1] > 0.6 * dp; side += 2) {
                    const double n[2] = {-side * 1e-6 * sin(angle), side * 1e-6 * cos(angle)};
                    assert_linear(sim, 0.2 + t * edge[0] + n[0], t * edge[1] + n[1], 0.047,
                                  t * edge[1] > 1.2 * dp && t < 0.9 ? dp : point, 1e-3);
                }
            mps_sim_destroy(sim);
        }
}

/* ---- solids ---- */

/* A plane: its normal into the liquid and its distance from the origin. */
typedef struct planes {
    int count;
    double n[4][2], offset[4];
    int body; /* 1: solid where all distances are negative, 0: where any is */
} planes;

static double from_planes(void *user, const double *x)
{
    const planes *p = user;
    double value = p->body ? -INFINITY : INFINITY;
    for (int k = 0; k < p->count; k++) {
        const double r = p->n[k][0] * x[0] + p->n[k][1] * x[1] - p->offset[k];
        value = p->body ? fmax(value, r) : fmin(value, r);
    }
    return value;
}

static void add_solid(mps_sim *sim, mps_distance_fn distance, void *user, const double *lo,
                      const double *hi)
{
    mps_solid solid;
    assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
    solid.distance = distance;
    solid.user = user;
    memcpy(solid.lo, lo, sizeof solid.lo);
    memcpy(solid.hi, hi, sizeof solid.hi);
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
}

/* A body on the floor of a tank, its sides upright (steep = 0) or inclined: its particles are not
 * those of the lattice. */
static void bodies_on_the_floor(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double steep = 0; steep < 0.7; steep += 0.3)
            for (double left = 0.1403; left < 0.15; left += 0.0031 * (double)every(3)) {
                const double c = cos(steep), s = sin(steep), lo[3] = {0.02, -0.06, -0.06},
                             hi[3] = {0.38, 0.2, 0.16};
                planes p = {3, {{-c, s}, {c, s}, {0, 1}}, {-c * left, c * (left + 0.13), 0.084}, 1};
                mps_sim *sim = filled(dim, 0);
                add_solid(sim, from_planes, &p, lo, hi);
                write_linear(sim);
                for (double y = 0.05 * dp; y < 7.9 * dp; y += 0.37 * dp)
                    for (int large = 0; large < 2; large++) {
                        const double diameter = large && y > 0.6 * dp && y < 7 * dp ? dp : point,
                                     z = 0.047;
                        assert_linear(sim, left + y * s / c, y, z, diameter, 0.03);
                        assert_linear(sim, left + 0.13 - y * s / c, y, z, diameter, 0.03);
                    }
                for (double x = 0.1 * dp; x < 3 * dp; x += 0.31 * dp)
                    assert_linear(sim, left - x, 0, 0.047, point, 0.03);
                mps_sim_destroy(sim);
            }
}

/* A tank with a floor and inclined side walls. */
static void sloping_tanks(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double angle = 0.3; angle < 1.4; angle += 0.2 * (double)every(3)) {
            const double c = cos(angle), s = sin(angle);
            planes p = {3, {{0, 1}, {-s, c}, {1, 0}}, {0.04, 0.04 * c - 0.2 * s, 0}, 0};
            mps_sim *sim = new_sim(dim, dp);
            const double box_lo[3] = {-0.1, -0.06, -0.06}, box_hi[3] = {0.9, 0.24, 0.16};
            mps_tank tank;
            assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
            tank.lo[0] = -0.05;
            tank.size[0] = 0.9;
            tank.size[1] = 0.2;
            tank.size[2] = 0.1;
            ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
            add_solid(sim, from_planes, &p, box_lo, box_hi);
            write_linear(sim);
            for (double t = 0.05 * dp; t < 0.12; t += 0.37 * dp)
                for (int large = 0; large < 2; large++) {
                    const double diameter = large && t > dp && t < 0.1 ? dp : point, z = 0.047,
                                 off = t < 1.5 * dp ? 0.08 : 0.03;
                    if (t * s < 0.15)
                        assert_linear(sim, 0.2 + t * c, 0.04 + t * s, z, diameter, off);
                    assert_linear(sim, 0.2 - t, 0.04, z, diameter, off);
                    assert_linear(sim, 0, 0.04 + t, z, diameter, 0.03);
                }
            mps_sim_destroy(sim);
        }
}

static double ball(void *user, const double *x)
{
    const double *of = user; /* radius, number of axes, sign */
    const double r2 = x[0] * x[0] + x[1] * x[1] + (of[1] > 2 ? x[2] * x[2] : 0);
    return of[2] * (of[0] - sqrt(r2));
}

/* Inside and outside of circles, spheres and, in 3-D, cylinders. */
static void curved_walls(void **state)
{
    static const double radius[] = {0.051, 0.083, 0.16};
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < (dim == 3 ? 2 : 3); k++)
            for (int sign = -1; sign <= 1; sign += 2) {
                double of[3] = {radius[k], dim, sign}, size = radius[k] + 0.06;
                const double lo[3] = {-size, -size, -size}, hi[3] = {size, size, size};
                mps_sim *sim = new_sim(dim, dp);
                add_solid(sim, ball, of, lo, hi);
                write_linear(sim);
                for (double a = 0; a < 6.28; a += 0.11)
                    for (double b = 0; b < (dim == 3 ? 1 : 0.1); b += 0.4) {
                        const double r = radius[k] * cos(b);
                        assert_linear(sim, r * cos(a), r * sin(a), radius[k] * sin(b), dp,
                                      0.35 * dp / radius[k]);
                    }
                mps_sim_destroy(sim);
            }
}

/* ---- refusals ---- */

static void off_the_wall(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0);
        int32_t id;
        mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, -dp, 0.1, 0.05);
        ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG,
                       "0.01 m behind the face of its wall; allowed");
        p.at[0] = 0.4 + 0.51 * dp;
        ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "0.0051 m behind");
        p.at[0] = 0.4 + 0.5 * dp;
        ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
        p.at[0] = 0.4 - 1.9 * dp;
        ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
        mps_sim_destroy(sim);
    }
}

/* Above the top edge of an open tank, in the plane of its wall. */
static void beyond_the_end(void **state)
{
    (void)state;
    mps_tank tank;
    int32_t id;
    mps_sim *sim = new_sim(2, dp);
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = 0.3;
    tank.size[1] = 0.2;
    tank.open_top = 1;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    const double lo[2] = {0.1, 0.08}, hi[2] = {0.1, 0.15};
    ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0.1 + 1e-6, 0.15 + 0.8 * dp, 0);
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG,
                   "0.008 m beyond the end of the face");
    p.at[1] = 0.15 + 0.4 * dp;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    mps_sim_destroy(sim);
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_and_corners),   cmocka_unit_test(baffles),
        cmocka_unit_test(sides_of_baffles),    cmocka_unit_test(inclined_plates),
        cmocka_unit_test(bodies_on_the_floor), cmocka_unit_test(sloping_tanks),
        cmocka_unit_test(curved_walls),        cmocka_unit_test(off_the_wall),
        cmocka_unit_test(beyond_the_end),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
