/* SPDX-License-Identifier: BSD-3-Clause */
/* collision.pair: phases of very different density (momentum, order of particles), edges of thin
 * plates, corners of tanks and between solids. */
#include "phase_fixture.h"

/* after cmocka.h */
#include "../turns.h"

static const double rho[2] = {1000, 1};

/* Velocities after one step with collisions alone, by id. */
static double *after(const cloud *c, const int32_t *phase, const double *u)
{
    mps_sim *sim = bare_sim(c->dim, CLOUD_DP, 2.1, 1e-9);
    set_phase(sim, 0, rho[0], 0);
    set_phase(sim, 1, rho[1], 0);
    add_cloud(sim, c, phase, u);
    ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 1.1));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    double *v = field_by_id(sim, "velocity");
    mps_sim_destroy(sim);
    return v;
}

static cloud crowd(int dim)
{
    return dim == 2 ? cloud_lattice(2, 24, 20, 1, 0.3, 3) : cloud_lattice(3, 10, 9, 8, 0.3, 3);
}

static int32_t *two_phases(int64_t n)
{
    int32_t *phase = cloud_phases(n);
    for (int64_t i = 0; i < n; i++) phase[i] = i / 5 % 2;
    return phase;
}

static void momentum(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        cloud c = crowd(dim);
        int32_t *phase = two_phases(c.n);
        double *u = cloud_field(c.n * dim, 4), *v = after(&c, phase, u);
        for (int d = 0; d < dim; d++) {
            double sum = 0, size = 0;
            int64_t hit = 0;
            for (int64_t i = 0; i < c.n; i++) {
                const double change = rho[phase[i]] * (v[i * dim + d] - u[i * dim + d]);
                sum += change;
                size += rho[phase[i]] * fabs(u[i * dim + d]);
                hit += change != 0;
            }
            assert_true(hit > c.n / 4 && fabs(sum) <= 1e-13 * size);
        }
        cloud_free(&c);
        free(phase);
        free(u);
        free(v);
    }
}

/* W22 (24)(25) for one pair. */
static void lone_pair(void **state)
{
    (void)state;
    const double x[4] = {0, 0, 0.5 * CLOUD_DP, 0}, u[4] = {0, 3, -2, 0};
    const int32_t phase[2] = {0, 1};
    const cloud c = {2, 2, (double *)x};
    double *v = after(&c, phase, u);
    ASSERT_NEAR(v[0], 1.5 * -2 * rho[1] / (rho[0] + rho[1]), 1e-15);
    ASSERT_NEAR(v[2], -2 + 1.5 * 2 * rho[0] / (rho[0] + rho[1]), 1e-14);
    assert_true(v[1] == 3 && v[3] == 0);
    free(v);
}

/* Pairs up to 0.6 dp collide, others do not, in millimetres as in dozens of metres. */
static void any_spacing(void **state)
{
    (void)state;
    static const double spacings[] = {1e-3, 1, 64}, distances[] = {0.3, 0.599, 0.601, 1};
    for (int k = 0; k < 12; k++) {
        const double dp = spacings[k % 3], x[4] = {0, 0, distances[k / 3] * dp, 0},
                     u[4] = {0, 0, -2, 0};
        const int32_t phase[2] = {0, 0};
        const cloud c = {2, 2, (double *)x};
        mps_sim *sim = bare_sim(2, dp, 2.1, 1e-9);
        set_phase(sim, 0, rho[0], 0);
        add_cloud(sim, &c, phase, u);
        ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double *v = field_by_id(sim, "velocity");
        ASSERT_NEAR(v[0], distances[k / 3] < 0.6 ? -1.5 : 0, 1e-14);
        free(v);
        mps_sim_destroy(sim);
    }
}

/* Velocity after a step with collisions alone of a drop at `x` [dp] from the upper edge of a plate
 * of one column. */
static void after_edge(int dim, const double *x, const double *u, double *v)
{
    const double dp = CLOUD_DP, lo[3] = {10 * dp, 0, 0}, hi[3] = {10 * dp, 6 * dp, 8 * dp};
    mps_sim *sim = bare_sim(dim, dp, 2.1, 1e-9);
    mps_particle_block b;
    double at[3];
    int64_t id;
    add_tank(sim, 20 * dp, 16 * dp, 8 * dp);
    ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
    ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
    for (int d = 0; d < dim; d++) at[d] = (d == 0 ? hi[0] : d == 1 ? hi[1] : 4 * dp) + x[d] * dp;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = at;
    b.velocity = u;
    ASSERT_OK(sim, mps_particles_add(sim, &b, &id));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    double *all = field_by_id(sim, "velocity");
    memcpy(v, all + id * dim, (size_t)dim * sizeof *v);
    free(all);
    mps_sim_destroy(sim);
}

/* The edge of a thin plate is a round post: what approaches along the line to it is lost, the rest
 * stays. */
static void edge_is_a_post(void **state)
{
    (void)state;
    const double above[3] = {0, 0.4, 0}, aslant[3] = {0.3, 0.3, 0}, off[3] = {0.4, 0.4, 0};
    const double down[3] = {0, -1, 0}, up[3] = {0, 1, 0}, past[3] = {2, -1, 0.5};
    double v[3];
    for (int dim = 2; dim <= 3; dim++) {
        after_edge(dim, above, down, v);
        assert_true(fabs(v[0]) < 1e-12 && fabs(v[1]) < 1e-12);
        after_edge(dim, above, past, v);
        assert_true(fabs(v[0] - 2) < 1e-12 && fabs(v[1]) < 1e-12 &&
                    (dim == 2 || fabs(v[2] - 0.5) < 1e-12));
        after_edge(dim, aslant, down, v);
        assert_true(fabs(v[0] - 0.5) < 1e-12 && fabs(v[1] + 0.5) < 1e-12);
        after_edge(dim, above, up, v);
        assert_true(v[0] == 0 && v[1] == 1);
        after_edge(dim, off, down, v);
        assert_true(v[0] == 0 && v[1] == -1);
    }
}

/* A corner of a tank, or of a tank and a solid, with collisions alone: the box of the solid, if it
 * has a size, and a point in the corner [dp], whose component along axis d increases into the
 * liquid by side[d]; 0: the corner is uniform along this axis. A plate, if any, extends from lo[]
 * by plate[]. */
typedef struct corner {
    int dim;
    double lo[3], hi[3], at[3], side[3], plate[2];
} corner;

enum { THROW_STEPS = 8 };

static const double box[3] = {10, 8, 6};

/* How deep x [dp] is behind the solid's faces in the tank, or behind a wall of the tank. */
static double depth_in(const corner *c, const double *x)
{
    double solid = c->plate[1] > 0 ? -INFINITY : INFINITY, beyond = -INFINITY;
    for (int d = 0; d < c->dim; d++) {
        if (c->lo[d] > 0) solid = fmin(solid, x[d] - c->lo[d]);
        if (c->hi[d] < box[d]) solid = fmin(solid, c->hi[d] - x[d]);
        beyond = fmax(beyond, fmax(-x[d], x[d] - box[d]));
    }
    return fmax(solid, beyond);
}

static mps_sim *corner_sim(const corner *c)
{
    const double dp = CLOUD_DP;
    double lo[3], hi[3];
    const double up[3] = {c->plate[0] * dp, c->plate[1] * dp, 0}, across[3] = {0, 0, box[2] * dp};
    mps_sim *sim = bare_sim(c->dim, dp, 2.1, 1);
    for (int d = 0; d < 3; d++) {
        lo[d] = c->lo[d] * dp;
        hi[d] = c->hi[d] * dp;
    }
    add_tank(sim, box[0] * dp, box[1] * dp, box[2] * dp);
    if (c->plate[1] > 0)
        ASSERT_OK(sim, mps_plate_add(sim, "plate", lo, up, c->dim == 3 ? across : NULL));
    else if (c->hi[1] > 0)
        ASSERT_OK(sim, mps_baffle_add(sim, "solid", lo, hi, NULL));
    ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
    return sim;
}

/* Largest depth of a drop thrown from x [dp] with u [dp per step]. */
static double thrown(mps_sim *sim, const corner *c, const double *x, const double *u)
{
    const double dp = CLOUD_DP;
    double at[3], go[3], deepest = -INFINITY;
    int64_t id;
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    for (int d = 0; d < c->dim; d++) {
        at[d] = x[d] * dp;
        go[d] = u[d] * dp;
    }
    b.count = 1;
    b.position = at;
    b.velocity = go;
    ASSERT_OK(sim, mps_particles_add(sim, &b, &id));
    for (int k = 0; k < THROW_STEPS && mps_particle_index(sim, id) >= 0; k++) {
        mps_lease p = {.struct_size = sizeof p};
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &p));
        for (int d = 0; d < c->dim; d++)
            at[d] = p.data[mps_particle_index(sim, id) * c->dim + d] / dp;
        deepest = fmax(deepest, depth_in(c, at));
        ASSERT_OK(sim, mps_lease_end(sim, &p));
    }
    ASSERT_OK(sim, mps_particles_remove(sim, 1, &id));
    return deepest;
}

/* From many positions near the corner, in all directions into it, faster along one face than along
 * the others. */
static void stays_out(const corner *c, int throws)
{
    mps_sim *sim = corner_sim(c);
    double *random = cloud_field((int64_t)throws * 6, 7), x[3], u[3];
    for (int k = 0; k < throws; k++) {
        for (int d = 0; d < 3; d++) {
            const double place = 0.5 + 0.5 * random[6 * k + d],
                         speed = random[6 * k + 3 + d]; /* 0..1, -1..1 */
            x[d] = c->at[d] + (c->side[d] != 0 ? c->side[d] * (0.1 + 0.45 * place) : place);
            u[d] = 0.2 * (c->side[d] != 0 ? c->side[d] * fmin(speed, 0.1) : speed);
        }
        const double deepest = thrown(sim, c, x, u);
        if (deepest > 0)
            fail_msg("%d-D: from (%g, %g, %g) by (%g, %g, %g) it got %g dp deep", c->dim, x[0],
                     x[1], x[2], u[0], u[1], u[2], deepest);
    }
    free(random);
    mps_sim_destroy(sim);
}

/* Common particles of a solid and the tank have the normal of the tank; the solid also repels
 * droplets there. */
static void corners_are_closed(void **state)
{
    (void)state;
    const corner c[] = {
        {2, {3, 0, 0}, {7, 4, 0}, {3, 0, 0}, {-1, 1, 0}, {0}},    /* before a solid on the floor */
        {2, {3, 0, 0}, {7, 4, 0}, {7, 0, 0}, {1, 1, 0}, {0}},     /* behind it */
        {2, {6, 2, 0}, {10, 6, 0}, {10, 6, 0}, {-1, 1, 0}, {0}},  /* on a shelf */
        {2, {6, 2, 0}, {10, 6, 0}, {10, 2, 0}, {-1, -1, 0}, {0}}, /* under it */
        {3,
         {3, 0, 0},
         {7, 4, 6},
         {3, 0, 2},
         {-1, 1, 0},
         {0}}, /* the same, along an edge and in corners of three faces */
        {3, {3, 0, 0}, {7, 4, 6}, {7, 0, 6}, {1, 1, -1}, {0}},
        {3, {3, 0, 0}, {7, 4, 6}, {5, 4, 0}, {0, 1, 1}, {0}},
        {3, {6, 2, 0}, {10, 6, 6}, {10, 6, 0}, {-1, 1, 1}, {0}},
        {3, {6, 2, 0}, {10, 6, 6}, {10, 2, 6}, {-1, -1, -1}, {0}},
    };
    for (size_t k = 0; k < sizeof c / sizeof c[0]; k++) stays_out(&c[k], c[k].dim == 2 ? 200 : 40);
}

/* The edges of a tank have one inclined normal; the adjacent faces repel droplets nevertheless. */
static void edges_are_closed(void **state)
{
    (void)state;
    const corner c[] = {{.dim = 2, .at = {0, 0}, .side = {1, 1}},
                        {.dim = 2, .at = {10, 8}, .side = {-1, -1}},
                        {.dim = 3, .at = {0, 0, 2}, .side = {1, 1, 0}},
                        {.dim = 3, .at = {10, 4, 6}, .side = {-1, 0, -1}},
                        {.dim = 3, .at = {0, 0, 0}, .side = {1, 1, 1}},
                        {.dim = 3, .at = {10, 8, 0}, .side = {-1, -1, 1}}};
    for (size_t k = 0; k < sizeof c / sizeof c[0]; k++) stays_out(&c[k], c[k].dim == 2 ? 200 : 100);
}

/* An inclined plate attached to a wall has no particles there, and occludes those of the wall from
 * one side. */
static void feet_are_closed(void **state)
{
    (void)state;
    const corner c[] = {
        {.dim = 2, .lo = {5.38}, .at = {5.38, 0}, .side = {-1, 1}, .plate = {-2.4, 3.2}},
        {.dim = 2, .lo = {4.75}, .at = {4.75, 0}, .side = {-1, 1}, .plate = {2.1, 3.8}},
        {.dim = 2, .lo = {5.38}, .at = {5.18, 0}, .side = {-1, 1}, .plate = {-3, 2.6}},
        {.dim = 2, .lo = {4.75}, .at = {4.75, 0}, .side = {1, 1}, .plate = {2.1, 3.8}},
        {.dim = 3, .lo = {5.38}, .at = {5.38, 0, 3}, .side = {-1, 1, 0}, .plate = {-2.4, 3.2}},
        {.dim = 3, .lo = {4.75}, .at = {4.75, 0, 3}, .side = {-1, 1, 0}, .plate = {2.1, 3.8}},
        {.dim = 3, .lo = {4.75}, .at = {4.75, 0, 0}, .side = {-1, 1, 1}, .plate = {2.1, 3.8}},
        {.dim = 3, .lo = {4.75}, .at = {4.75, 0, 6}, .side = {1, 1, -1}, .plate = {2.1, 3.8}}};
    for (size_t k = 0; k < sizeof c / sizeof c[0]; k++) stays_out(&c[k], c[k].dim == 2 ? 200 : 100);
}

/* A drop that falls on a flat floor stops within half a spacing of it, wherever the wall particles
 * are: over one of them, between two, amid four. */
static void floor_stops_drops(void **state)
{
    (void)state;
    static const double aside[3][2] = {{0, 0}, {0.5, 0}, {0.5, 0.5}};
    const double dp = CLOUD_DP;
    for (int k = 0; k < 3; k++)
        for (double height = 0.1; height < 0.9; height += 0.1) {
            const double u[3] = {0, -1e-3, 0};
            cloud c = cloud_empty(3, 1);
            const int32_t phase = 0;
            c.x[0] = (5 + aside[k][0]) * dp;
            c.x[1] = height * dp;
            c.x[2] = (5 + aside[k][1]) * dp;
            mps_sim *sim = bare_sim(3, dp, 2.1, 0.1 * dp);
            add_tank(sim, 10 * dp, 10 * dp, 10 * dp);
            add_cloud(sim, &c, &phase, u);
            ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            double *now = field_by_id(sim, "velocity");
            const double left = now[3 * (mps_particles_count(sim, -1) - 1) + 1];
            ASSERT_NEAR(left, height < 0.5 - 1e-6 ? 0 : -1e-3, 1e-12);
            mps_sim_destroy(sim);
            cloud_free(&c);
            free(now);
        }
}

/* Liquid squeezed against the floor, with the shift alone, whose velocities are along the floor:
 * what is within 0.5 dp of it does not sink. */
static void shift_keeps_off(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const double dp = CLOUD_DP;
        cloud c = dim == 2 ? cloud_lattice(2, 9, 6, 1, 0.2, 8) : cloud_lattice(3, 9, 6, 5, 0.2, 8);
        int32_t *phase = cloud_phases(c.n);
        double *u = cloud_field(c.n * dim, 9), low = INFINITY;
        mps_sim *sim = bare_sim(dim, dp, 2.1, 0.1 * dp);
        for (int64_t i = 0; i < c.n; i++) low = fmin(low, c.x[i * dim + 1]);
        for (int64_t i = 0; i < c.n; i++) {
            c.x[i * dim] += 2 * dp;
            c.x[i * dim + 1] = 0.6 * (c.x[i * dim + 1] - low) + 0.15 * dp;
            if (dim == 3) c.x[i * dim + 2] += 2 * dp;
            u[i * dim + 1] = 0;
        }
        add_tank(sim, 14 * dp, 8 * dp, 10 * dp);
        const int64_t first = mps_particles_count(sim, MPS_WALL) +
                              mps_particles_count(sim, MPS_DUMMY);
        add_cloud(sim, &c, phase, u);
        ASSERT_OK(sim, mps_model_use(sim, "shift.tangential"));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double *x = field_by_id(sim, "position");
        int64_t near = 0, sunk = 0;
        for (int64_t i = 0; i < c.n; i++) {
            const double before = c.x[i * dim + 1], after_it = x[(first + i) * dim + 1];
            if (before < 0.5 * dp)
                near++, assert_true(after_it >= before * (1 - 1e-12));
            else
                sunk += after_it < before;
        }
        assert_true(near > 5 && sunk > 5);
        mps_sim_destroy(sim);
        cloud_free(&c);
        free(phase);
        free(u);
        free(x);
    }
}

/* A droplet that came over the top edge is in the plane of a wall: it is moved out by 0.05 dp per
 * step up to 0.25 dp, and gains no speed. */
static void out_of_the_wall(void **state)
{
    (void)state;
    static const double places[][3] = {
        {-0.3, 5.4, 3.1}, {10.3, 4.9, 3.1}, {4.6, -0.2, 3.1}, {0.02, 5.3, 3.1}};
    for (int dim = 2; dim <= 3; dim++)
        for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
            const double dp = CLOUD_DP;
            const int axis = k == 2;
            double at[3];
            mps_sim *sim = bare_sim(dim, dp, 2.1, 0.1 * dp);
            add_tank(sim, box[0] * dp, box[1] * dp, box[2] * dp);
            mps_particle_block b;
            assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
            for (int d = 0; d < dim; d++) at[d] = places[k][d] * dp;
            b.count = 1;
            b.position = at;
            ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
            ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
            ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
            ASSERT_OK(sim, mps_model_use(sim, "shift.tangential"));
            const int64_t id = mps_particles_count(sim, -1) - 1;
            for (int step = 0; step < 15; step++) {
                ASSERT_OK(sim, mps_step(sim, 1, NULL));
                double *x = field_by_id(sim, "position"), *u = field_by_id(sim, "velocity");
                for (int d = 0; d < dim; d++) {
                    const double moved = fabs(x[id * dim + d] - at[d]) / dp;
                    assert_true(u[id * dim + d] == 0 && moved < (d == axis ? 0.05 + 1e-12 : 1e-12));
                    at[d] = x[id * dim + d];
                }
                free(x);
                free(u);
            }
            const double off = fmin(at[axis], box[axis] * dp - at[axis]) / dp;
            ASSERT_NEAR(off, 0.25, 1e-9);
            mps_sim_destroy(sim);
        }
}

/* Particles added in another order collide alike. */
static void order(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        cloud c = crowd(dim), mixed = cloud_empty(dim, c.n);
        int32_t *phase = two_phases(c.n), *other = cloud_phases(c.n);
        double *u = cloud_field(c.n * dim, 5), *w = cloud_doubles(c.n * dim),
               *v = after(&c, phase, u);
        for (int64_t i = 0; i < c.n; i++) {
            const int64_t to = (i * 1009 + 17) % c.n; /* 1009 is prime and divides neither n */
            memcpy(mixed.x + to * dim, c.x + i * dim, (size_t)dim * sizeof(double));
            memcpy(w + to * dim, u + i * dim, (size_t)dim * sizeof(double));
            other[to] = phase[i];
        }
        double *back = after(&mixed, other, w);
        for (int64_t i = 0; i < c.n; i++)
            for (int d = 0; d < dim; d++)
                ASSERT_NEAR(back[(i * 1009 + 17) % c.n * dim + d], v[i * dim + d], 1e-14);
        cloud_free(&c);
        cloud_free(&mixed);
        free(phase);
        free(other);
        free(u);
        free(w);
        free(v);
        free(back);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {cmocka_unit_test(momentum),
                                 cmocka_unit_test(lone_pair),
                                 cmocka_unit_test(any_spacing),
                                 cmocka_unit_test(edge_is_a_post),
                                 cmocka_unit_test(corners_are_closed),
                                 cmocka_unit_test(edges_are_closed),
                                 cmocka_unit_test(feet_are_closed),
                                 cmocka_unit_test(floor_stops_drops),
                                 cmocka_unit_test(shift_keeps_off),
                                 cmocka_unit_test(out_of_the_wall),
                                 cmocka_unit_test(order)};
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
