/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank of any size has that size: whole cells fill it and the spacing follows them. Blocks of
 * liquid have their volume. */
#include "sim.h"
#include "tank_fixture.h"
#include <mps/operators.h>
#include <stdio.h>
#include <stdlib.h>

enum { TANKS = 60 };

static char warned[400];

static void keep_warning(void *user, int level, const char *text)
{
    (void)user;
    if (level == MPS_LOG_WARNING) snprintf(warned, sizeof warned, "%s", text);
}

static mps_sim *logging(int32_t dim, double dp)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.log = keep_warning;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    warned[0] = 0;
    return sim;
}

/* The same numbers in 0..1 everywhere. */
static double next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static mps_tank tank_at(double x, const double *size)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.lo[0] = x;
    memcpy(tank.size, size, sizeof tank.size);
    return tank;
}

/* Largest distance of a wall from the faces of a tank at the origin. */
static double off_the_faces(const mps_sim *sim, const double *size)
{
    const mps__particles *s = &sim->world.particles;
    double most = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double least = INFINITY;
        if (s->kind[i] != MPS_WALL) continue;
        for (int d = 0; d < s->dim; d++)
            least = fmin(least,
                         fmin(fabs(s->x[i * s->dim + d]), fabs(s->x[i * s->dim + d] - size[d])));
        most = fmax(most, least);
    }
    return most;
}

static void any_size(void **state)
{
    uint32_t seed = 1;
    (void)state;
    for (int k = 0; k < TANKS; k++) {
        const int32_t dim = 2 + k % 2;
        const double asked = 0.01 + 0.05 * next(&seed);
        double size[3], built[3], h[3], dp, volume = 1;
        mps_sim *sim = new_sim(dim, asked);
        for (int d = 0; d < 3; d++) size[d] = asked * (3 + (dim == 2 ? 100 : 20) * next(&seed));
        const mps_tank tank = tank_at(0, size);
        ASSERT_OK(sim, mps_tank_add(sim, &tank, built));
        ASSERT_OK(sim, mps_lattice_get(sim, NULL, h));
        ASSERT_OK(sim, mps_sim_shape(sim, NULL, &dp));
        for (int d = 0; d < dim; d++) {
            const double cells = round(size[d] / asked);
            ASSERT_NEAR(built[d], size[d], 1e-9 * asked);
            ASSERT_NEAR(h[d] * cells, size[d], 1e-9 * asked);
            ASSERT_NEAR(h[d], asked, asked * 0.5 / cells * (1 + 1e-9));
            volume *= h[d];
        }
        ASSERT_NEAR(pow(dp, dim) / volume, 1, 1e-12);
        ASSERT_NEAR(off_the_faces(sim, size), 0, 1e-9 * asked);
        mps_sim_destroy(sim);
    }
}

/* A tank that is whole in dp changes nothing, to the last bit. */
static void whole_sizes(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        const double size[3] = {0.57, 0.3, 0.21};
        double dp, h[3], lo[3];
        mps_sim *sim = new_sim(dim, 0.03);
        const mps_tank tank = tank_at(0.1, size);
        ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
        ASSERT_OK(sim, mps_sim_shape(sim, NULL, &dp));
        ASSERT_OK(sim, mps_lattice_get(sim, lo, h));
        assert_true(dp == 0.03 && lo[0] == 0.1 && lo[1] == 0);
        for (int d = 0; d < dim; d++) assert_true(h[d] == 0.03);
        mps_sim_destroy(sim);
    }
}

/* Radii are multiples of the spacing that is built, and a lattice at rest has the volume and the
 * number density of a square one. */
static void lattice_at_rest(void **state)
{
    static const double size[2][3] = {{3.22, 1}, {1.12, 0.78, 0.55}};
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        const double *all = size[dim - 2];
        double dp, n = 0, delta = 0;
        mps_sim *sim = new_sim(dim, 0.055);
        mps_stencil near = {.struct_size = sizeof near}, far = near;
        add_tank(sim, all[0], all[1], all[2]);
        assert_true(fill_depth(sim, all[0], 0.9 * all[1], all[2]) > 900);
        ASSERT_OK(sim, mps_sim_shape(sim, NULL, &dp));
        assert_true(fabs(dp / 0.055 - 1) > 1e-4 && fabs(dp / 0.055 - 1) < 0.03);
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_FAR, &far));
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &near));
        ASSERT_NEAR(near.re / dp, 2.1, 1e-12);
        ASSERT_NEAR(far.re / dp, dim == 2 ? 3.1 : 2.1, 1e-12);
        ASSERT_NEAR(near.dp, dp, 0);
        ASSERT_NEAR(sim->world.setup.velocity_scale, sqrt(9.81 * dp), 1e-12);
        double *of = calloc((size_t)near.n, sizeof *of), *at = calloc((size_t)near.n, sizeof *at);
        assert_non_null(of);
        assert_non_null(at);
        assert_int_equal(mps_op_volume_deviation(&far, of), MPS_OK);
        assert_int_equal(mps_op_number_density(&near, at), MPS_OK);
        const mps__particles *s = &sim->world.particles;
        for (int64_t i = 0; i < s->n; i++) {
            bool inside = s->kind[i] == MPS_FLUID;
            for (int d = 0; d < dim; d++)
                inside = inside && s->x[i * dim + d] > 3.2 * dp &&
                         s->x[i * dim + d] < (d == 1 ? 0.9 : 1) * all[d] - 4.2 * dp;
            if (!inside) continue;
            delta = fmax(delta, fabs(of[i]));
            n = fmax(n, fabs(at[i] / near.n0 - 1));
        }
        /* the cells are stretched by .9 and by 2.9 %: without a spacing that follows them they
         * would have 2 and 4 % more volume */
        assert_true(delta > 1e-9 && delta < (dim == 2 ? 2e-5 : 1e-3));
        assert_true(n > 1e-9 && n < (dim == 2 ? 1e-4 : 1e-3));
        free(of);
        free(at);
        mps_sim_destroy(sim);
    }
}

/* Only before the first particle the spacing is free. A tank like the first has its lattice,
 * another one is rounded. */
static void later_tanks(void **state)
{
    /* requested: 20.45 and 30.55 dp: 30.43 of the dp of whole cells */
    const double first[3] = {0.6135, 0.9165, 0}, other[3] = {0.485, 0.285, 0};
    const mps_tank tanks[] = {tank_at(0, first), tank_at(2, first), tank_at(4, other)};
    double built[3], h[2], dp, now;
    mps_sim *sim = logging(2, 0.03);
    (void)state;
    ASSERT_OK(sim, mps_tank_add(sim, &tanks[0], NULL));
    ASSERT_OK(sim, mps_sim_shape(sim, NULL, &dp));
    ASSERT_OK(sim, mps_tank_add(sim, &tanks[1], built));
    for (int d = 0; d < 2; d++) ASSERT_NEAR(built[d], first[d], 1e-12);
    assert_string_equal(warned, "");
    ASSERT_OK(sim, mps_tank_add(sim, &tanks[2], built));
    ASSERT_OK(sim, mps_lattice_get(sim, NULL, h));
    ASSERT_OK(sim, mps_sim_shape(sim, NULL, &now));
    assert_true(now == dp && h[0] == dp && h[1] == dp);
    for (int d = 0; d < 2; d++) ASSERT_NEAR(built[d], round(other[d] / dp) * dp, 1e-12);
    assert_true(fabs(built[0] - other[0]) > 1e-3 || fabs(built[1] - other[1]) > 1e-3);
    if (!strstr(warned, "rounded to")) fail_msg("\"%s\"", warned);
    mps_sim_destroy(sim);
}

/* Liquid that was added before a tank has the volume of the spacing as it was. */
static void after_liquid(void **state)
{
    const double x[2] = {5, 5}, size[3] = {0.515, 0.315, 0};
    const mps_tank tank = tank_at(0, size);
    mps_particle_block block;
    double dp;
    mps_sim *sim = logging(2, 0.03);
    (void)state;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    ASSERT_OK(sim, mps_sim_shape(sim, NULL, &dp));
    assert_true(dp == 0.03 && strstr(warned, "rounded to"));
    mps_sim_destroy(sim);
}

/* A refused tank leaves the spacing unchanged. */
static void refused(void **state)
{
    const double size[3] = {0.515, 0.315, 0};
    mps_tank tank = tank_at(0, size);
    double dp, lo[2];
    mps_sim *sim = new_sim(2, 0.03);
    (void)state;
    ASSERT_REFUSED(sim, mps_lattice_get(sim, lo, NULL), MPS_E_STATE, "no lattice");
    assert_int_equal(mps_lattice_get(NULL, lo, NULL), MPS_E_ARG);
    tank.dummy_layers = 9;
    ASSERT_REFUSED(sim, mps_tank_add(sim, &tank, NULL), MPS_E_ARG, "dummy_layers");
    ASSERT_OK(sim, mps_sim_shape(sim, NULL, &dp));
    assert_true(dp == 0.03);
    mps_sim_destroy(sim);
}

/* Particles that a side of a block needs, in cells: between walls, from a wall to a surface,
 * between two surfaces. */
static double layers(double from, double to, double size, double h)
{
    const int walls = (from <= 0) + (to >= size);
    return (to - from) / h + 1 - walls;
}

/* Levels, columns at walls and free blocks in tanks of any size. */
static void blocks(void **state)
{
    uint32_t seed = 7;
    (void)state;
    for (int k = 0; k < TANKS; k++) {
        const int32_t dim = 2 + k % 2, kind = k / 2 % 3;
        const double asked = 0.01 + 0.05 * next(&seed);
        double size[3], lo[3] = {0}, hi[3], h[3], built[6], wanted = 1;
        int64_t added;
        mps_sim *sim = new_sim(dim, asked);
        for (int d = 0; d < 3; d++)
            hi[d] = size[d] = asked * ((dim == 2 ? 30 : 12) * (1 + next(&seed)));
        hi[1] *= 0.4 + 0.3 * next(&seed);
        if (kind > 0) hi[0] *= 0.5 + 0.2 * next(&seed);
        for (int d = 0; d < dim && kind == 2; d++) lo[d] = size[d] * (0.1 + 0.1 * next(&seed));
        if (kind == 2) hi[2] *= 0.8;
        add_tank(sim, size[0], size[1], size[2]);
        ASSERT_OK(sim, mps_lattice_get(sim, NULL, h));
        ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, &added, built));
        for (int d = 0; d < dim; d++) wanted *= layers(lo[d], hi[d], size[d], h[d]);
        ASSERT_NEAR((double)added, wanted, 0.5 + 1e-6 * wanted);
        for (int d = 0; d < dim; d++) {
            ASSERT_NEAR(built[d], lo[d], 0.2 * h[d]);
            ASSERT_NEAR(built[dim + d], hi[d], 0.2 * h[d]);
        }
        mps_sim_destroy(sim);
    }
}

/* A layer that is only partly in the box does not reach beyond a plate. */
static void stops_at_plates(void **state)
{
    (void)state;
    for (int end = 0; end < 2; end++) {
        const double foot[2] = {0.5, 0}, edge[2] = {0, 0.4}, lo[2] = {end ? 0 : 0.485, 0},
                     hi[2] = {end ? 0.515 : 1, 0.2};
        int64_t added;
        mps_sim *sim = new_sim(2, 0.05);
        add_tank(sim, 1, 0.4, 0);
        ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
        ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, &added, NULL));
        assert_int_equal(added, 9 * 4);
        mps_sim_destroy(sim);
    }
}

/* Plates on the lattice of a tank are attached to its walls, for any edges of its cells; each face
 * has the area of the plate. */
static void plates_on_the_lattice(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int kind = 0; kind < 2; kind++) {
            const double size[3] = {1.03, 0.62, 0.43};
            double h[3], sum[2] = {0, 0}, wanted = size[1] * (dim == 3 ? size[2] : 1);
            mps_sim *sim = logging(dim, 0.05);
            add_tank(sim, size[0], size[1], size[2]);
            ASSERT_OK(sim, mps_lattice_get(sim, NULL, h));
            const double x = 8 * h[0], lo[3] = {x, 0, 0}, hi[3] = {x, size[1], size[2]},
                         edge[3] = {0, size[1], 0}, edge2[3] = {0, 0, size[2]};
            if (kind == 0)
                ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
            else
                ASSERT_OK(sim, mps_plate_add(sim, "plate", lo, edge, dim == 3 ? edge2 : NULL));
            assert_string_equal(warned, "");
            assert_int_equal(sim->world.lists.occluders.list[0].axis, 0);
            const mps__particles *s = &sim->world.particles;
            for (int64_t i = 0; i < s->n; i++)
                if (s->kind[i] == MPS_WALL && fabs(s->x[i * dim] - x) < 1e-9)
                    sum[s->area[i * dim] > 0] += s->area[i * dim];
            ASSERT_NEAR(sum[1], wanted, 1e-9);
            ASSERT_NEAR(sum[0], -wanted, 1e-9);
            mps_sim_destroy(sim);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_size),
        cmocka_unit_test(whole_sizes),
        cmocka_unit_test(lattice_at_rest),
        cmocka_unit_test(later_tanks),
        cmocka_unit_test(after_liquid),
        cmocka_unit_test(refused),
        cmocka_unit_test(blocks),
        cmocka_unit_test(stops_at_plates),
        cmocka_unit_test(plates_on_the_lattice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
