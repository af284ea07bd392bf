/* SPDX-License-Identifier: BSD-3-Clause */
/* The bytes and texts of a run depend on the particles and their ids, not on their order in memory
 * before a search. */
#include "sim.h"
#include "cloud.h"
#include "phase_fixture.h"
#include <stdio.h>

enum { STEPS = 24, SHUFFLE_EACH = 6 };
static const double dp = 0.05;

/* A tank in violent motion, with a column of water on its left side. */
typedef struct scene {
    const char *preset;
    int32_t dim;
    bool plate, air;
} scene;

static mps_sim *tank_of(const scene *c)
{
    const mps_harmonic motion[2] = {{.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 12},
                                    {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .omega = 9}};
    const double size[3] = {0.6, 0.5, 0.3}, lo[3] = {0}, water[3] = {0.3, 0.35, 0.3},
                 air_right[3] = {0.3, 0, 0}, air_above[3] = {0, 0.35, 0}, left[3] = {0.3, 0.5, 0.3},
                 plate_lo[3] = {0.45, 0, 0}, plate_hi[3] = {0.45, 0.2, 0.3};
    mps_sim *sim = new_sim(c->dim, dp);
    ASSERT_OK(sim, mps_preset_use(sim, c->preset));
    set_phase(sim, 0, 1000, 1e-3);
    if (c->air) set_phase(sim, 1, 1, 1.8e-5);
    add_tank(sim, size[0], size[1], size[2]);
    if (c->plate) ASSERT_OK(sim, mps_baffle_add(sim, "plate", plate_lo, plate_hi, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, water, NULL, NULL));
    if (c->air) {
        ASSERT_OK(sim, mps_fill_box_add(sim, 1, air_above, left, NULL, NULL));
        ASSERT_OK(sim, mps_fill_box_add(sim, 1, air_right, size, NULL, NULL));
    }
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, motion));
    return sim;
}

/* Permute the particles, as after another history, or keep their order. The next step searches
 * neighbours. */
static void new_history(mps_sim *sim, bool shuffle, uint64_t *seed)
{
    mps__particles *s = &sim->world.particles;
    int32_t *order = calloc((size_t)s->n, sizeof *order);
    for (int32_t i = 0; i < s->n; i++) {
        const int32_t j = (int32_t)((0.5 + 0.4999 * cloud_random(seed)) * (i + 1));
        order[i] = order[j];
        order[j] = i;
    }
    if (shuffle) assert_int_equal(mps__particles_permute(s, s->n, order), MPS_OK);
    sim->world.lists.neighbours.valid = false;
    free(order);
}

static void same_particles(mps_sim *a, mps_sim *b)
{
    const mps__particles *s = &a->world.particles, *r = &b->world.particles;
    assert_int_equal(s->n, r->n);
    for (int32_t k = 0; k < s->fields; k++) {
        const mps__field *f = &s->field[k], *g = &r->field[k];
        const size_t bytes = (size_t)s->n * (size_t)f->components * f->size;
        if (memcmp(*f->data, *g->data, bytes) != 0) fail_msg("field '%s' differs", f->name);
    }
}

/* Energies are also summed in the order before a search. */
static void same_energies(mps_sim *a, mps_sim *b)
{
    mps_energy e = {.struct_size = sizeof e}, f = {.struct_size = sizeof f};
    ASSERT_OK(a, mps_energy_get(a, &e));
    ASSERT_OK(b, mps_energy_get(b, &f));
    ASSERT_NEAR(e.kinetic, f.kinetic, 1e-12 * fabs(e.kinetic));
    ASSERT_NEAR(e.potential, f.potential, 1e-12 * fabs(e.potential));
    ASSERT_NEAR(e.numerical, f.numerical, 1e-9 * fabs(e.kinetic));
}

static void history_of_store(void **state)
{
    static const scene scenes[] = {{"imps", 2, true, false},
                                   {"imps", 3, false, false},
                                   {"imps.paper", 2, false, false},
                                   {"mmps", 2, false, true},
                                   {"mmps", 3, false, true}};
    (void)state;
    for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; k++) {
        mps_sim *kept = tank_of(&scenes[k]), *mixed = tank_of(&scenes[k]);
        uint64_t seed = 5;
        for (int step = 0; step < STEPS; step++) {
            if (step % SHUFFLE_EACH == 0) {
                new_history(kept, false, &seed);
                new_history(mixed, true, &seed);
            }
            ASSERT_OK(kept, mps_step(kept, 1, NULL));
            ASSERT_OK(mixed, mps_step(mixed, 1, NULL));
            same_particles(kept, mixed);
        }
        same_energies(kept, mixed);
        mps_sim_destroy(kept);
        mps_sim_destroy(mixed);
    }
}

/* Within a cell particles are sorted by id, so that the order does not depend on the previous
 * order, nor on the bounding box of all particles. */
static void order_of_ties(void **state)
{
    (void)state;
    enum { SIDE = 8, N = SIDE * SIDE * SIDE };
    const double far_radius = 3.1 * CLOUD_DP;
    for (int dim = 2; dim <= 3; dim++) {
        mps__context context = {.allocator = mps__allocator_default()};
        mps_neighbours l;
        cloud c = dim == 2 ? cloud_lattice(2, SIDE * SIDE, SIDE, 1, 0.4, 64)
                           : cloud_lattice(3, SIDE, SIDE, SIDE, 0.4, 64);
        static double x[3 * N];
        static int64_t id[N], first[N];
        assert_int_equal(mps__neighbours_init(&l, &context, dim, CLOUD_DP), MPS_OK);
        const int64_t steps[] = {1, 7, 11, N - 1}; /* none has a factor of N */
        for (int m = 0; m < 4; m++) {
            const int64_t step = steps[m];
            for (int64_t i = 0; i < N; i++) {
                id[i] = (i * step + 3 * step) % N;
                for (int d = 0; d < dim; d++) x[i * dim + d] = c.x[id[i] * dim + d];
            }
            assert_int_equal(mps__neighbours_order(&l, N, x, id, far_radius), MPS_OK);
            for (int64_t k = 0; k < N; k++) {
                if (step == 1) first[k] = id[l.order[k]];
                assert_int_equal(id[l.order[k]], first[k]);
                if (k > 0 && l.key[k] == l.key[k - 1])
                    assert_true(id[l.order[k]] > id[l.order[k - 1]]);
            }
        }
        int64_t lowest = 0, seen = 0;
        for (int64_t i = 0; i < N; i++)
            if (x[i * dim] < x[lowest * dim]) lowest = i;
        const int64_t moved = id[lowest];
        x[lowest * dim] -= 12.3456 * CLOUD_DP; /* the box grows; all others keep their order */
        assert_int_equal(mps__neighbours_order(&l, N, x, id, far_radius), MPS_OK);
        for (int64_t k = 0; k < N; k++) {
            if (id[l.order[k]] == moved) continue;
            seen += first[seen] == moved;
            assert_int_equal(id[l.order[k]], first[seen++]);
        }
        mps__neighbours_free(&l);
        cloud_free(&c);
    }
}

/* Walls and dummies of an uneven floor without areas, and water on it. */
static mps_sim *uneven_floor(void)
{
    static const int32_t kind[4] = {MPS_DUMMY, MPS_DUMMY, MPS_WALL, MPS_FLUID};
    enum { LONG = 12 };
    mps_sim *sim = new_sim(2, dp);
    mps_particle_block b;
    double x[2 * LONG];
    uint64_t seed = 3;
    for (int row = 0; row < 4; row++) {
        for (int k = 0; k < 2 * LONG; k++)
            x[k] = dp * ((k % 2 ? row : k / 2) + 0.2 * cloud_random(&seed));
        assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
        b.count = LONG;
        b.kind = kind[row];
        b.position = x;
        ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    }
    return sim;
}

/* A wall given without an area faces along the sum of the ways from its dummies. */
static void areas_of_walls(void **state)
{
    (void)state;
    mps_sim *kept = uneven_floor(), *mixed = uneven_floor();
    const mps__particles *s = &kept->world.particles;
    uint64_t seed = 9;
    new_history(mixed, true, &seed);
    ASSERT_OK(kept, mps_step(kept, 1e-4, NULL));
    ASSERT_OK(mixed, mps_step(mixed, 1e-4, NULL));
    same_particles(kept, mixed);
    for (int64_t i = 0; i < s->n; i++) {
        double sum[2] = {0, 0};
        for (int64_t j = 0; j < s->n; j++)
            for (int d = 0; d < 2 && s->wall_of[j] == i; d++)
                sum[d] += s->ref[2 * i + d] - s->ref[2 * j + d];
        const double length = hypot(sum[0], sum[1]);
        for (int d = 0; d < 2; d++)
            ASSERT_NEAR(s->area[2 * i + d], length > 0 ? dp * sum[d] / length : 0, 1e-12 * dp);
        if (s->kind[i] == MPS_WALL && s->x[2 * i] > dp && s->x[2 * i] < 10 * dp)
            assert_true(s->area[2 * i + 1] > 0.5 * dp);
    }
    mps_sim_destroy(kept);
    mps_sim_destroy(mixed);
}

/* The text about lost particles contains the smallest id, in any order of the particles. */
static void least_id_is_named(void **state)
{
    static const scene plain = {"imps", 2, false, false};
    (void)state;
    for (int turn = 0; turn < 2; turn++) {
        mps_sim *sim = tank_of(&plain);
        mps__particles *s = &sim->world.particles;
        char word[40];
        int64_t lost[2] = {0}, found = 0; /* positions, by ascending ids */
        sim->world.setup.lost_policy = MPS_LOST_ERROR;
        for (int64_t i = 0; i < s->n && found < 2; i++)
            if (s->kind[i] == MPS_FLUID) lost[found++] = i;
        const int64_t least = s->id[lost[0]];
        assert_true(found == 2 && least < s->id[lost[1]]);
        for (int k = 0; k < 2; k++) s->x[2 * lost[k]] = 100;
        int32_t *order = calloc((size_t)s->n, sizeof *order);
        for (int32_t i = 0; i < s->n; i++) order[i] = turn ? (int32_t)s->n - 1 - i : i;
        assert_int_equal(mps__particles_permute(s, s->n, order), MPS_OK);
        free(order);
        snprintf(word, sizeof word, "2 particles left the domain");
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_LOST, word);
        snprintf(word, sizeof word, "; particle %lld is at", (long long)least);
        assert_non_null(strstr(mps_sim_error(sim), word));
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(history_of_store), cmocka_unit_test(order_of_ties),
        cmocka_unit_test(areas_of_walls), cmocka_unit_test(least_id_is_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
