/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles through the public interface: add, remove, ids, and all refusals. */
#include "particle_fixture.h"

/* ---- add ------------------------------------------------------------------------------------- */

static void add_and_read(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double x[6] = {0, 0, 0.05, 0, 0.1, 0.02}, u[6] = {1, 2, 3, 4, 5, 6};
    double got[1000];
    int64_t ids[3] = {-1, -1, -1};
    const int32_t *kinds, *phases, *parts;
    mps_particle_block b = block_of(3, x);
    b.velocity = u;
    ASSERT_OK(sim, mps_particles_add(sim, &b, ids));
    for (int k = 0; k < 3; k++) assert_int_equal(ids[k], k);
    assert_int_equal(mps_particles_count(sim, -1), 3);
    assert_int_equal(mps_particles_count(sim, MPS_FLUID), 3);
    by_id(sim, "position", 1, got);
    assert_true(got[0] == 0 && got[2] == 0.02);
    by_id(sim, "velocity", 0, got);
    assert_true(got[0] == 1 && got[1] == 3 && got[2] == 5);
    by_id(sim, "density", 0, got);
    assert_true(got[0] == 1000);
    const double wall[2] = {0, -0.05}, area[2] = {0, 0.05};
    b = block_of(1, wall);
    b.kind = MPS_WALL;
    b.part = "floor";
    b.area = area;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    assert_int_equal(mps_particles_count(sim, MPS_WALL), 1);
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, &phases, &parts));
    const int64_t at = mps_particle_index(sim, 3);
    assert_true(kinds[at] == MPS_WALL && phases[at] == 0 &&
                parts[at] == mps_part_find(sim, "floor"));
    assert_true(parts[mps_particle_index(sim, 0)] == -1 && mps_part_find(sim, "ceiling") == -1);
    mps_sim_destroy(sim);
}

/* Bad blocks, each with what its text must name; nothing changes. */
static void add_refused(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    const int64_t n = mps_particles_count(sim, -1);
    const double x[4] = {0.1, 0.4, 0.2, 0.4}, bad[4] = {0.1, 0.4, NAN, 0.4},
                 infinite[4] = {0.1, -INFINITY, 0.2, 0.4};
    mps_particle_block b = block_of(0, x);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "count is 0");
    b = block_of(-5, x);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "count is -5");
    b = block_of(2, NULL);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "position");
    b = block_of(2, bad);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG,
                   "position of particle 1, axis 0 is");
    b = block_of(2, infinite);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG,
                   "position of particle 0, axis 1 is -inf");
    b = block_of(2, x), b.velocity = bad;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "velocity of particle 1");
    b = block_of(2, x), b.phase = 1;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "phase is 1");
    b = block_of(2, x), b.phase = 16;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "phase is 16");
    b = block_of(2, x), b.phase = -1;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "phase is -1");
    b = block_of(2, x), b.kind = 3;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "kind is 3");
    b = block_of(2, x), b.kind = MPS_WALL, b.part = "a name of more than thirty-one letters";
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "part");
    b = block_of(2, x), b.kind = MPS_DUMMY, b.part = "";
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "part");
    b = block_of(2, x), b.struct_size = 0;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "struct_size is 0");
    ASSERT_REFUSED(sim, mps_particles_add(sim, NULL, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_particles_add(NULL, &b, NULL), MPS_E_ARG);
    assert_int_equal(mps_particles_count(sim, -1), n);
    mps_sim_destroy(sim);
}

static void overlap_refused(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    const int64_t n = mps_particles_count(sim, -1);
    int64_t id = -7;
    const double inside[6] = {0.1, 0.4, 0.2, 0.4, 0.2 + 0.09 * dp, 0.4},
                 apart[4] = {0.2, 0.4, 0.2 + 0.11 * dp, 0.4};
    mps_particle_block b = block_of(3, inside);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, &id), MPS_E_ARG,
                   "within 0.1 dp of its particle");
    const double on_fluid[2] = {0.1, 0.1}, on_wall[2] = {0, 0.4};
    b = block_of(1, on_fluid);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, &id), MPS_E_ARG, "within 0.1 dp of particle");
    b = block_of(1, on_wall);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, &id), MPS_E_ARG, "within 0.1 dp of particle");
    assert_int_equal(id, -7);
    assert_int_equal(mps_particles_count(sim, -1), n);
    b = block_of(2, apart);
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    mps_sim_destroy(sim);
}

/* An array that was not filled: all particles at the origin. A clear error, without much time or
 * memory. */
static void crowd_refused(void **state)
{
    (void)state;
    enum { MANY = 200000 };
    mps_sim *sim = new_sim(3, dp);
    double *x = calloc(3 * MANY, sizeof *x);
    mps_particle_block b = block_of(MANY, x);
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "200000 particles");
    b.kind = MPS_WALL; /* walls may coincide in pairs, but not all of them */
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "200000 particles");
    assert_int_equal(mps_particles_count(sim, -1), 0);
    free(x);
    mps_sim_destroy(sim);
}

/* The two faces of a thin plate may be at the same position. */
static void coincident_walls(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double x[4] = {0, 0, 0, 0};
    mps_particle_block b = block_of(2, x);
    b.kind = MPS_WALL;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    assert_int_equal(mps_particles_count(sim, MPS_WALL), 2);
    mps_sim_destroy(sim);
}

/* ---- remove ---------------------------------------------------------------------------------- */

static void remove_by_id(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    double before[1000], after[1000];
    const int64_t n = mps_particles_count(sim, -1), gone[3] = {n - 1, 0, 17};
    by_id(sim, "position", 0, before);
    ASSERT_OK(sim, mps_particles_remove(sim, 3, gone));
    assert_int_equal(mps_particles_count(sim, -1), n - 3);
    by_id(sim, "position", 0, after);
    for (int64_t id = 0; id < n; id++) {
        const bool left = id != gone[0] && id != gone[1] && id != gone[2];
        assert_true(left ? after[id] == before[id] : isnan(after[id]));
        assert_int_equal(mps_particle_index(sim, id) >= 0, left);
    }
    const double x[2] = {0.25, 0.4};
    int64_t id = -1;
    const mps_particle_block b = block_of(1, x);
    ASSERT_OK(sim, mps_particles_add(sim, &b, &id));
    assert_int_equal(id, n); /* ids are never reused */
    mps_sim_destroy(sim);
}

static void remove_refused(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    const int64_t n = mps_particles_count(sim, -1), twice[3] = {1, 2, 1}, unknown[2] = {1, 999},
                  negative[1] = {-1}, one[1] = {5};
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 3, twice), MPS_E_ARG, "id 1 ");
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 2, unknown), MPS_E_ARG, "id 999 ");
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 1, negative), MPS_E_ARG, "id -1 ");
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 0, one), MPS_E_ARG, "count is 0");
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 1, NULL), MPS_E_ARG, "no ids");
    assert_int_equal(mps_particles_count(sim, -1), n);
    ASSERT_OK(sim, mps_particles_remove(sim, 1, one));
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 1, one), MPS_E_ARG, "id 5 ");
    assert_int_equal(mps_particles_count(sim, -1), n - 1);
    mps_sim_destroy(sim);
}

static void remove_all(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double x[4] = {0, 0, 0.1, 0};
    const int64_t ids[2] = {0, 1};
    mps_particle_block b = block_of(2, x);
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    ASSERT_OK(sim, mps_particles_remove(sim, 2, ids));
    assert_int_equal(mps_particles_count(sim, -1), 0);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "no fluid");
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    assert_int_equal(mps_particle_index(sim, 3), 1);
    mps_sim_destroy(sim);
}

static void queries(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    assert_int_equal(mps_particles_count(sim, -1), 0);
    assert_int_equal(mps_particles_count(sim, -2), -1);
    assert_int_equal(mps_particles_count(sim, 3), -1);
    assert_int_equal(mps_particles_count(NULL, -1), -1);
    assert_int_equal(mps_particle_index(sim, 0), -1);
    assert_int_equal(mps_particle_index(NULL, 0), -1);
    assert_int_equal(tags_peek(NULL, NULL, NULL, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_part_find(NULL, "a"), -1);
    assert_int_equal(mps_part_find(sim, NULL), -1);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(add_and_read),     cmocka_unit_test(add_refused),
        cmocka_unit_test(overlap_refused),  cmocka_unit_test(crowd_refused),
        cmocka_unit_test(coincident_walls), cmocka_unit_test(remove_by_id),
        cmocka_unit_test(remove_refused),   cmocka_unit_test(remove_all),
        cmocka_unit_test(queries),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
