/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates: construction; the neighbours of each particle are all liquid particles of its own
 * side, each once. */
#include "plate_fixture.h"

/* Kernel sums of row i over fluid, walls and dummies. */
static void row_sums(const mps_stencil *t, const int32_t *kind, int64_t i, double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0;
    for (int64_t k = t->begin[i]; k < t->end[i]; k++) {
        const mps_pair q = mps_stencil_pair(t, i, k);
        sum[kind[q.j]] += q.w;
    }
}

/* The particle of b at the position of particle i of a, moved by `offset` along x, of the same
 * kind, and on the same side. */
static int64_t same_place(const mps__particles *a, int64_t i, const mps__particles *b,
                          double offset, double side)
{
    for (int64_t j = 0; j < b->n; j++) {
        double r2 = 0;
        for (int d = 0; d < a->dim; d++)
            r2 += pow(a->ref[i * a->dim + d] + (d == 0 ? offset : 0) - b->ref[j * a->dim + d], 2);
        if (r2 < 1e-6 * dp * dp && b->kind[j] == a->kind[i] && !mps__is_shadow(b, j) &&
            (b->plate[j] == 0 || b->area[j * a->dim] * side > 0))
            return j;
    }
    return -1;
}

static void keep_places(mps_sim *sim)
{
    mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n * s->dim; i++)
        if (s->kind[i / s->dim] == MPS_FLUID) s->ref[i] = s->x[i];
}

/* Rows and areas of a divided tank are those of two tanks. */
static void compare_with_tank(int dim, int columns, int right)
{
    mps_sim *one = divided(dim, 0), *two = divided(dim, columns);
    const double offset = right ? 0.5 + (columns - 1) * dp : 0;
    mps_stencil a[2] = {{.struct_size = sizeof a[0]}, {.struct_size = sizeof a[0]}},
                b[2] = {{.struct_size = sizeof b[0]}, {.struct_size = sizeof b[0]}};
    for (int which = MPS_NEAR; which <= MPS_FAR; which++) {
        ASSERT_OK(one, mps_stencil_get(one, which, &a[which]));
        ASSERT_OK(two, mps_stencil_get(two, which, &b[which]));
    }
    const mps__particles *s = &one->world.particles, *t = &two->world.particles;
    keep_places(one);
    keep_places(two);
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] == MPS_DUMMY) continue;
        const int64_t j = same_place(s, i, t, offset, right ? 1 : -1);
        assert_true(j >= 0);
        for (int d = 0; d < dim; d++)
            ASSERT_NEAR(s->area[i * dim + d], t->area[j * dim + d], 1e-14);
        for (int which = MPS_NEAR; which <= MPS_FAR; which++) {
            double wanted[3], got[3];
            row_sums(&a[which], s->kind, i, wanted);
            row_sums(&b[which], t->kind, j, got);
            for (int kind = 0; kind < (s->kind[i] == MPS_FLUID ? 3 : 2); kind++)
                ASSERT_NEAR(got[kind], wanted[kind], 1e-9);
        }
    }
    mps_sim_destroy(one);
    mps_sim_destroy(two);
}

static void divided_tank_is_two_tanks(void **state)
{
    (void)state;
    for (int columns = 1; columns <= 3; columns++)
        for (int right = 0; right < 2; right++) {
            compare_with_tank(2, columns, right);
            compare_with_tank(3, columns, right);
        }
}

/* Inside the liquid a plate without thickness occupies no volume: around its edges every lattice
 * point is a neighbour once. */
static void edges_are_seen_once(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = new_sim(dim, dp);
        const double lo[3] = {0.5, 0.3, 0.4}, hi[3] = {0.5, 0.6, 0.6};
        add_tank(sim, 1, 1, 1);
        ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
        fill_depth(sim, 1, 1, 1);
        for (int which = MPS_NEAR; which <= MPS_FAR; which++) {
            mps_stencil t = {.struct_size = sizeof t};
            int64_t checked = 0;
            ASSERT_OK(sim, mps_stencil_get(sim, which, &t));
            const mps__particles *s = &sim->world.particles;
            for (int64_t i = 0; i < s->n; i++) {
                double sum[3];
                if (s->kind[i] != MPS_FLUID || fabs(s->x[i * dim] - 0.5) > 0.3) continue;
                row_sums(&t, s->kind, i, sum);
                ASSERT_NEAR(sum[0] + sum[1] + sum[2], t.n0, 1e-9);
                checked++;
            }
            assert_true(checked > 100);
        }
        mps_sim_destroy(sim);
    }
}

/* The same off the lattice: the sum does not jump by a particle's weight when one passes over the
 * edge. */
static void passing_the_edge(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    mps_stencil t = {.struct_size = sizeof t};
    add_tank(sim, 1, 1, 0);
    add_plate(sim, 1, 0, 0.5);
    fill_depth(sim, 1, 0.9, 0);
    double least = INFINITY, most = 0;
    for (int k = -20; k <= 20; k++) {
        mps__particles *s = &sim->world.particles;
        int64_t moved = -1;
        double sum[3];
        for (int64_t i = 0; i < s->n; i++)
            if (s->kind[i] == MPS_FLUID &&
                hypot(s->x[2 * i] - 0.5, s->x[2 * i + 1] - 0.55) < 0.4 * dp)
                moved = i;
        assert_true(moved >= 0);
        s->x[2 * moved] = 0.5 + 0.01 * k * dp;
        sim->world.lists.neighbours.valid = false;
        const int64_t id = s->id[moved];
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_FAR, &t));
        const int64_t i = mps_particle_index(sim, id);
        row_sums(&t, s->kind, i, sum);
        least = fmin(least, sum[0] + sum[1] + sum[2]);
        most = fmax(most, sum[0] + sum[1] + sum[2]);
    }
    assert_true(most - least < 0.02 * t.n0);
    mps_sim_destroy(sim);
}

static void areas(void **state)
{
    (void)state;
    for (int columns = 1; columns <= 3; columns++) {
        mps_sim *sim = new_sim(2, dp);
        double side[2] = {0, 0}, up = 0, floor = 0;
        int64_t walls = 0;
        add_tank(sim, 1, 0.6, 0);
        add_plate(sim, columns, 0, 0.3);
        const mps__particles *s = &sim->world.particles;
        const int32_t part = mps_part_find(sim, "plate");
        for (int64_t i = 0; i < s->n; i++) {
            if (s->kind[i] != MPS_WALL) continue;
            if (s->plate[i]) side[s->area[2 * i] > 0] += s->area[2 * i];
            if (s->plate[i] && s->part[i] == part) up += s->area[2 * i + 1];
            if (s->ref[2 * i + 1] == 0) floor += s->area[2 * i + 1];
            walls += s->part[i] == part;
        }
        /* of one column the edge takes half a cell of both sides, with the same pressure on both */
        const double height = 0.3 - (columns == 1 ? 0.5 * dp : 0);
        ASSERT_NEAR(side[0], -height, 1e-14);
        ASSERT_NEAR(side[1], height, 1e-14);
        ASSERT_NEAR(up, (columns - 1) * dp, 1e-5 * dp);
        ASSERT_NEAR(floor, 1 - (columns - 1) * dp, 1e-14);
        assert_int_equal(walls, columns == 1 ? 2 * 5 + 1 : 2 * 6 + columns - 2);
        mps_sim_destroy(sim);
    }
}

/* A box next to the floor is built down to it; a flat one on the floor is a step with one wet
 * side. */
static void what_is_a_plate(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double lo[2] = {0.2, 0}, hi[2] = {0.6, dp}, thick[2] = {0.8, 0.3},
                 end[2] = {0.8 + 3 * dp, 0.5};
    add_tank(sim, 1, 0.6, 0);
    add_plate(sim, 1, 0.4, 0.6 - dp);
    assert_int_equal(sim->world.lists.occluders.count, 1);
    ASSERT_NEAR(sim->world.lists.occluders.list[0].length[0], 0.2, 1e-12);
    ASSERT_OK(sim, mps_baffle_add(sim, "step", lo, hi, NULL));
    ASSERT_OK(sim, mps_baffle_add(sim, "box", thick, end, NULL));
    assert_int_equal(sim->world.lists.occluders.count, 1);
    mps_sim_destroy(sim);
}

/* Fluid may be in an occluded region. */
static void shadows_are_not_in_the_way(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    mps_particle_block block;
    const double beside[2] = {0.55, 0.3}, on[2] = {0.5, 0.3};
    mps_lease plates = {.struct_size = sizeof plates};
    const int32_t *kinds;
    int64_t shadows = 0;
    add_tank(sim, 1, 0.6, 0);
    add_plate(sim, 1, 0, 0.6);
    assert_int_equal(fill_depth(sim, 1, 0.2, 0), 4 * (19 - 1));
    mps_particle_block_init(&block, sizeof block);
    block.count = 1;
    block.position = beside;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    block.position = on;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &block, NULL), MPS_E_ARG, "apart");
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "plate", MPS_READ, &plates));
    assert_int_equal(plates.count, mps_particles_count(sim, -1));
    for (int64_t i = 0; i < plates.count; i++)
        shadows += plates.integers[i] && kinds[i] == MPS_DUMMY;
    assert_int_equal(shadows, 2 * 2 * (13 + 2 * 2));
    ASSERT_OK(sim, mps_lease_end(sim, &plates));
    mps_sim_destroy(sim);
}

/* Each shadow belongs to the face before it. */
static void shadows_know_their_wall(void **state)
{
    (void)state;
    mps_sim *sim = divided(2, 1);
    mps_stencil t = {.struct_size = sizeof t};
    int64_t linked = 0;
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &t));
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        if (!mps__is_shadow(s, i) || s->wall_of[i] < 0) continue;
        assert_true((s->ref[2 * i] - 0.5) * s->area[2 * s->wall_of[i]] < 0);
        linked++;
    }
    assert_true(linked > 40);
    mps_sim_destroy(sim);
}

/* A shelf on a wall between two compartments: its corners are corners of a tank, the other side is
 * a flat wall. */
static void plate_on_plate(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp), *tank = new_sim(2, dp);
    const double lo[2] = {0.5, 0.3}, hi[2] = {0.8, 0.3};
    mps_stencil t = {.struct_size = sizeof t}, u = {.struct_size = sizeof u};
    double corner[3], flat[3], sum[3];
    add_tank(tank, 1, 0.6, 0);
    fill_depth(tank, 1, 0.6, 0);
    add_tank(sim, 1, 0.6, 0);
    add_plate(sim, 1, 0, 0.6);
    ASSERT_OK(sim, mps_baffle_add(sim, "shelf", lo, hi, NULL));
    fill_depth(sim, 1, 0.6, 0);
    ASSERT_OK(tank, mps_stencil_get(tank, MPS_NEAR, &u));
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &t));
    const mps__particles *a = &tank->world.particles, *b = &sim->world.particles;
    for (int64_t i = 0; i < a->n; i++) {
        if (hypot(a->x[2 * i] - dp, a->x[2 * i + 1] - dp) < 1e-9) row_sums(&u, a->kind, i, corner);
        if (hypot(a->x[2 * i] - dp, a->x[2 * i + 1] - 0.3) < 1e-9) row_sums(&u, a->kind, i, flat);
    }
    int64_t found = 0;
    for (int64_t i = 0; i < b->n; i++)
        for (int where = 0; where < 3; where++) {
            const double *wanted = where < 2 ? corner : flat, x = where < 2 ? 0.5 + dp : 0.5 - dp,
                         y = 0.3 + (where < 2 ? where * 2 - 1 : 0) * dp;
            if (b->kind[i] != MPS_FLUID || hypot(b->x[2 * i] - x, b->x[2 * i + 1] - y) > 1e-9)
                continue;
            row_sums(&t, b->kind, i, sum);
            for (int kind = 0; kind < 3; kind++) ASSERT_NEAR(sum[kind], wanted[kind], 1e-9);
            found++;
        }
    assert_int_equal(found, 3);
    mps_sim_destroy(sim);
    mps_sim_destroy(tank);
}

/* An inclined plate that ends half a spacing above the floor: true area, no fluid too near, no
 * particle has neighbours through it or under it. */
static void inclined_plate(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double corner[2] = {0.3, 0.5 * dp}, edge[2] = {0.3, 0.4}, normal[2] = {-0.8, 0.6},
                 top = 0.4;
    double area = 0;
    mps_stencil t = {.struct_size = sizeof t};
    add_tank(sim, 1, 0.6, 0);
    ASSERT_OK(sim, mps_plate_add(sim, "leaning", corner, edge, NULL));
    fill_depth(sim, 1, 0.5, 0);
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_FAR, &t));
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        const double *x = s->x + 2 * i,
                     height = (x[0] - corner[0]) * normal[0] + (x[1] - corner[1]) * normal[1];
        if (s->kind[i] == MPS_WALL && s->plate[i])
            area += fmax(0, s->area[2 * i] * normal[0] + s->area[2 * i + 1] * normal[1]);
        if (s->kind[i] == MPS_DUMMY || s->plate[i] || x[1] > top) continue;
        assert_true(s->kind[i] == MPS_WALL || fabs(height) > 0.7 * dp - 1e-12);
        for (int64_t k = t.begin[i]; k < t.end[i]; k++) {
            const int32_t j = t.col[k];
            const double *y = s->x + 2 * j;
            if (s->kind[j] == MPS_DUMMY || s->plate[j] || y[1] > top) continue;
            assert_true(height * ((y[0] - corner[0]) * normal[0] + (y[1] - corner[1]) * normal[1]) >
                        0);
        }
    }
    ASSERT_NEAR(area, 0.5, 1e-12);
    mps_sim_destroy(sim);
}

static void refusals(void **state)
{
    (void)state;
    mps_sim *flat = new_sim(2, dp), *sim = new_sim(3, dp);
    const double at[3] = {0.3, 0.1, 0.1}, up[3] = {0, 0.3, 0}, slant[3] = {0.2, 0.3, 0},
                 along[3] = {0, 0, 0.2}, none[3] = {0, 0, 0}, far[3] = {0, 2, 0},
                 nan[3] = {NAN, 0, 0};
    ASSERT_REFUSED(flat, mps_plate_add(flat, "p", at, up, NULL), MPS_E_STATE, "mps_tank_add");
    add_tank(flat, 1, 0.6, 0);
    add_tank(sim, 1, 0.6, 0.4);
    const int64_t before = mps_particles_count(sim, -1);
    assert_int_equal(mps_plate_add(NULL, "p", at, up, along), MPS_E_ARG);
    ASSERT_REFUSED(flat, mps_plate_add(flat, "p", at, up, along), MPS_E_ARG, "edge2");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "p", at, up, NULL), MPS_E_ARG, "edge2");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "p", at, up, slant), MPS_E_ARG, "right angles");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "p", at, none, along), MPS_E_ARG, "at least 2 spacings");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "p", at, far, along), MPS_E_ARG, "leaves the tank");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "p", nan, up, along), MPS_E_ARG, "finite");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "p", at, nan, along), MPS_E_ARG, "finite");
    ASSERT_REFUSED(sim, mps_plate_add(sim, "", at, up, along), MPS_E_ARG, "name");
    assert_int_equal(mps_particles_count(sim, -1), before);
    assert_int_equal(mps_part_find(sim, "p"), -1);
    ASSERT_OK(sim, mps_plate_add(sim, "p", at, up, along));
    ASSERT_REFUSED(sim, mps_plate_add(sim, "again", at, up, along), MPS_E_ARG, "taken");
    assert_int_equal(mps_part_find(sim, "again"), -1);
    assert_int_equal(sim->world.lists.occluders.count, 1);
    mps_sim_destroy(flat);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(divided_tank_is_two_tanks),
        cmocka_unit_test(edges_are_seen_once),
        cmocka_unit_test(passing_the_edge),
        cmocka_unit_test(areas),
        cmocka_unit_test(what_is_a_plate),
        cmocka_unit_test(shadows_are_not_in_the_way),
        cmocka_unit_test(shadows_know_their_wall),
        cmocka_unit_test(plate_on_plate),
        cmocka_unit_test(inclined_plate),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
