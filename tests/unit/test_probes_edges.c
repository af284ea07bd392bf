/* SPDX-License-Identifier: BSD-3-Clause */
/* A sensor near an edge at which the wall turns away from the liquid reads its own face: random
 * loads on both faces of a box and of prisms whose particles are not on a lattice, for any pressure
 * of the particles on the edge. */
#include "../every.h"
#include "probe_fixture.h"

/* after cmocka.h */
#include "../turns.h"

static const double deep = 0.1; /* of the liquid in 3-D [m] */

/* A body: a convex polygon of sides n.x = offset, the same along the third axis. */
typedef struct body {
    int count;
    double n[5][2], offset[5];
    double load[5], slope[5][3]; /* of each side: load + slope.x [Pa] */
    double on_edge;              /* what particles on edges show; NAN: the mean of their sides */
} body;

static double above(const body *b, int k, const double *x)
{
    return b->n[k][0] * x[0] + b->n[k][1] * x[1] - b->offset[k];
}

static double distance(void *user, const double *x)
{
    const body *b = user;
    double most = -INFINITY;
    for (int k = 0; k < b->count; k++) most = fmax(most, above(b, k, x));
    return most;
}

static double load_of(const body *b, int k, const double *x, int dim)
{
    return b->load[k] + mps__dot(b->slope[k], x, dim);
}

/* Loads by the sides on which a wall particle is. */
static void write_loads(mps_sim *sim, const body *b)
{
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        const double *x = &s->ref[i * s->dim];
        double sum = 0;
        int sides = 0;
        if (s->kind[i] != MPS_WALL || distance((void *)b, x) < -0.3 * dp ||
            distance((void *)b, x) > 0.3 * dp)
            continue;
        for (int k = 0; k < b->count; k++)
            if (fabs(above(b, k, x)) < 0.25 * dp) {
                sum += load_of(b, k, x, s->dim);
                sides++;
            }
        s->load[i] = sides > 1 && !isnan(b->on_edge) ? b->on_edge : sum / fmax(1, sides);
    }
}

/* Reading of a sensor on one side, at a distance from the edge with the previous side. */
static double read_side(mps_sim *sim, const body *b, int k, const double *edge, double t,
                        double diameter, double at[3])
{
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0, 0);
    const int dim = sim->world.setup.dim;
    const double along[2] = {b->n[k][1], -b->n[k][0]}; /* to the right of the normal */
    for (int d = 0; d < 2; d++) {
        at[d] = p.at[d] = edge[d] + t * along[d];
        p.normal[d] = b->n[k][d];
    }
    at[2] = p.at[2] = dim == 3 ? 0.5 * deep : 0;
    p.diameter = diameter;
    return read_one(sim, &p);
}

/* A box on the floor, whose particles are those of the lattice: side 0 is the front, side 1 the
 * top. */
static body box(void)
{
    return (body){.count = 3, .n = {{-1, 0}, {0, 1}, {1, 0}}, .offset = {-0.2, 0.08, 0.28}};
}
static const double box_edge[2] = {0.2, 0.08};

static mps_sim *with_box(int dim)
{
    const double lo[3] = {0.2, 0, 0}, hi[3] = {0.28, 0.08, deep};
    mps_sim *sim = filled(dim, 0);
    ASSERT_OK(sim, mps_baffle_add(sim, "box", lo, hi, NULL));
    return sim;
}

static const double diameters[] = {1e-5, 0.01, 0.023};

/* One side is loaded, the other is not: each reads its own load, for any pressure of the edge. */
static void faces_of_a_box(void **state)
{
    (void)state;
    const double on_edge[] = {NAN, 0, 2000, 100, -300, 5000};
    for (int dim = 2; dim <= 3; dim++)
        for (int swap = 0; swap < 2; swap++) {
            body b = box();
            mps_sim *sim = with_box(dim);
            b.load[swap] = 2000;
            b.load[1 - swap] = 100;
            for (int e = 0; e < 6; e++) {
                if (!has_turn(e, dim + swap, 3)) continue;
                double at[3];
                b.on_edge = on_edge[e];
                write_loads(sim, &b);
                for (int m = 0; m < 3; m++)
                    for (double t = 0.02 * dp; t < 4 * dp; t += 0.24 * dp)
                        for (int k = 0; k < 2; k++)
                            ASSERT_NEAR(
                                read_side(sim, &b, k, box_edge, k ? t : -t, diameters[m], at),
                                b.load[k], 1e-8);
            }
            mps_sim_destroy(sim);
        }
}

/* Linear pressures of each side alone are read exactly where the edge is beyond them. */
static void linear_on_each(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int high = 0; high < 2; high++) {
            body b = box();
            mps_sim *sim = with_box(dim);
            /* towards the edge the front rises and the top falls, or the other way */
            b.load[0] = 3000;
            b.load[1] = 3000;
            b.slope[0][1] = high ? 9000 : -9000;
            b.slope[1][0] = high ? -7000 : 7000;
            b.slope[0][2] = b.slope[1][2] = 500;
            b.on_edge = high ? 9000 : -9000;
            write_loads(sim, &b);
            for (double t = 0.02 * dp; t < 4 * dp; t += 0.24 * dp)
                for (int k = 0; k < 2; k++) {
                    double at[3];
                    const double got = read_side(sim, &b, k, box_edge, k ? t : -t, 1e-5, at);
                    ASSERT_NEAR(got, load_of(&b, k, at, dim), 1e-3 * dp * 9000);
                }
            mps_sim_destroy(sim);
        }
}

/* Pressures that fall steeply away from the edge, or to it: nothing is made up beyond what the
 * particles show. */
static void no_overshoot(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double jump = -3000; jump <= 3000; jump += 6000) {
            body b = box();
            mps_sim *sim = with_box(dim);
            const mps__particles *s = &sim->world.particles;
            b.on_edge = 0;
            write_loads(sim, &b);
            for (int64_t i = 0; i < s->n; i++) /* on the top from the second row on */
                if (s->kind[i] == MPS_WALL && fabs(s->ref[i * dim + 1] - 0.08) < 1e-6 &&
                    s->ref[i * dim] > 0.2 + 1.5 * dp)
                    s->load[i] = jump;
            for (double t = 0.02 * dp; t < 3 * dp; t += 0.24 * dp) {
                double at[3];
                const double got = read_side(sim, &b, 1, box_edge, t, 1e-5, at) / jump;
                assert_true(got >= -1e-9 && got <= 1 + 1e-9);
            }
            mps_sim_destroy(sim);
        }
}

/* Edges with an angle of 52 to 120 degrees, inclined to the lattice. */
static void prisms(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double turn = 0.9; turn < 2.2; turn += 0.1)
            for (double lean = 0; lean < 0.4; lean += 0.07 * (double)every(3)) {
                const double edge[2] = {0.2, 0.2}, a = 1.9 - lean, c = a - turn;
                body b = {.count = 5,
                          .n = {{cos(a), sin(a)}, {cos(c), sin(c)}, {0, -1}, {-1, 0}, {1, 0}},
                          .offset = {0, 0, -0.12, -0.1, 0.3},
                          .load = {2000, 100},
                          .on_edge = 2000};
                for (int k = 0; k < 2; k++) b.offset[k] = mps__dot(b.n[k], edge, 2);
                const double lo[3] = {0.02, 0.02, -0.06}, hi[3] = {0.38, 0.26, 0.16};
                mps_sim *sim = filled(dim, 0);
                mps_solid solid;
                assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
                solid.distance = distance;
                solid.user = &b;
                memcpy(solid.lo, lo, sizeof solid.lo);
                memcpy(solid.hi, hi, sizeof solid.hi);
                ASSERT_OK(sim, mps_solid_add(sim, &solid));
                write_loads(sim, &b);
                for (double t = 0.1 * dp; t < 3 * dp; t += 0.4 * dp)
                    for (int k = 0; k < 2; k++) {
                        double at[3];
                        const double got = read_side(sim, &b, k, edge, k ? t : -t, 1e-5, at);
                        ASSERT_NEAR(got, b.load[k], 1e-6);
                    }
                mps_sim_destroy(sim);
            }
}

int main(void)
{
    struct CMUnitTest tests[] = {cmocka_unit_test(faces_of_a_box), cmocka_unit_test(linear_on_each),
                                 cmocka_unit_test(no_overshoot), cmocka_unit_test(prisms)};
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
