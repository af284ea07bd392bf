/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields and leases of particles: reads, writes and all refusals. */
#include "particle_fixture.h"

/* ---- leases ---------------------------------------------------------------------------------- */

static void lease_conflicts(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_lease a = {.struct_size = sizeof a}, b = {.struct_size = sizeof b},
              c = {.struct_size = sizeof c};
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &a));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &b));
    assert_ptr_equal(a.data, b.data);
    assert_int_equal(a.stride, 2);
    assert_int_equal(a.count, mps_particles_count(sim, -1));
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &c), MPS_E_BUSY, "velocity");
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &c)); /* another field is free */
    mps_lease d = {.struct_size = sizeof d};
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "pressure", MPS_READ, &d), MPS_E_BUSY, "writing");
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &d), MPS_E_BUSY, "writing");
    ASSERT_OK(sim, mps_lease_end(sim, &a));
    assert_null(a.data);
    ASSERT_REFUSED(sim, mps_lease_end(sim, &a), MPS_E_ARG, "not open");
    mps_lease copy = b;
    ASSERT_OK(sim, mps_lease_end(sim, &b));
    ASSERT_REFUSED(sim, mps_lease_end(sim, &copy), MPS_E_ARG, "velocity");
    ASSERT_OK(sim, mps_lease_end(sim, &c));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &c));
    ASSERT_OK(sim, mps_lease_end(sim, &c));
    mps_sim_destroy(sim);
}

static void lease_refused(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_lease a = {.struct_size = sizeof a};
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "presure", MPS_READ, &a), MPS_E_NAME, "'pressure'");
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "held", MPS_READ, &a), MPS_E_NAME,
                   "held"); /* private */
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "pressure", 2, &a), MPS_E_ARG, "mode is 2");
    ASSERT_REFUSED(sim, mps_lease_begin(sim, NULL, MPS_READ, &a), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "pressure", MPS_READ, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_lease_end(sim, NULL), MPS_E_ARG, "mps_lease is NULL");
    ASSERT_REFUSED(sim, mps_lease_end(sim, &a), MPS_E_ARG, "not open");
    a.slot = 12345;
    ASSERT_REFUSED(sim, mps_lease_end(sim, &a), MPS_E_ARG, "not open");
    assert_int_equal(mps_lease_begin(NULL, "pressure", MPS_READ, &a), MPS_E_ARG);
    assert_int_equal(mps_lease_end(NULL, &a), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* With a lease open nothing may move: not the time, not the particles. */
static void lease_blocks(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    const double x[2] = {0.25, 0.45};
    const int64_t id = 0, n = mps_particles_count(sim, -1);
    double t = -1, before[1000], after[1000];
    int64_t steps = -1;
    mps_lease lease = {.struct_size = sizeof lease};
    mps_phase phase;
    mps_stencil s = {.struct_size = sizeof s};
    const mps_particle_block b = block_of(1, x);
    by_id(sim, "position", 1, before);
    for (int32_t mode = MPS_READ; mode <= MPS_WRITE; mode++) {
        ASSERT_OK(sim, mps_lease_begin(sim, "position", mode, &lease));
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_BUSY, "1 lease");
        ASSERT_STATUS(sim, mps_run(sim, 1e-3, NULL, NULL), MPS_E_BUSY);
        ASSERT_STATUS(sim, mps_particles_add(sim, &b, NULL), MPS_E_BUSY);
        ASSERT_STATUS(sim, mps_particles_remove(sim, 1, &id), MPS_E_BUSY);
        ASSERT_STATUS(sim, mps_field_add(sim, "mine", 1), MPS_E_BUSY);
        ASSERT_STATUS(sim, mps_motion_clear(sim), MPS_E_BUSY);
        assert_int_equal(mps_phase_init(&phase, sizeof phase), MPS_OK);
        ASSERT_STATUS(sim, mps_phase_set(sim, 1, &phase), MPS_E_BUSY);
        ASSERT_STATUS(sim, mps_stencil_get(sim, MPS_NEAR, &s),
                      mode == MPS_READ ? MPS_OK : MPS_E_BUSY);
        assert_true(mode == MPS_WRITE || (s.n == n && s.x == lease.data));
        ASSERT_OK(sim, mps_lease_end(sim, &lease));
    }
    ASSERT_OK(sim, mps_sim_time(sim, &t, &steps));
    assert_true(t == 0 && steps == 0);
    assert_int_equal(mps_particles_count(sim, -1), n);
    by_id(sim, "position", 1, after);
    for (int64_t k = 0; k < n; k++) assert_true(before[k] == after[k]);
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

/* Written values are used by the next step; NaN is refused with name and index, and can be
 * corrected. */
static void written_values(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_lease lease = {.struct_size = sizeof lease};
    const int64_t *ids;
    char word[64];
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &lease));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    lease.data[2 * 7 + 1] = NAN;
    snprintf(word, sizeof word, "'velocity' of particle %lld", (long long)ids[7]);
    ASSERT_REFUSED(sim, mps_lease_end(sim, &lease), MPS_E_ARG, word);
    ASSERT_STATUS(sim, mps_step(sim, 1e-3, NULL), MPS_E_BUSY); /* still open */
    lease.data[2 * 7 + 1] = INFINITY;
    ASSERT_STATUS(sim, mps_lease_end(sim, &lease), MPS_E_ARG);
    lease.data[2 * 7 + 1] = 0;
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_lease_begin(sim, "density", MPS_WRITE, &lease));
    lease.data[7] = 0;
    ASSERT_REFUSED(sim, mps_lease_end(sim, &lease), MPS_E_ARG, "> 0");
    lease.data[7] = 999;
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

/* Dummies keep their wall when the store is sorted, and lose it with it. */
static void links_follow(void **state)
{
    (void)state;
    mps__context context = {.allocator = mps__allocator_default()};
    mps__particles s;
    const int32_t order[4] = {3, 1, 4, 0}; /* 2 is removed */
    assert_int_equal(mps__particles_init(&s, &context, 2), MPS_OK);
    assert_int_equal(mps__particles_reserve(&s, 5), MPS_OK);
    assert_int_equal(mps__particles_append(&s, 5, MPS_WALL), 0);
    for (int k = 0; k < 5; k++) assert_int_equal(s.wall_of[k], -1);
    s.wall_of[0] = 3;
    s.wall_of[1] = 2;
    s.wall_of[3] = 4;
    const int64_t generation = s.generation, solids = s.solids;
    assert_int_equal(mps__particles_permute(&s, 4, order), MPS_OK);
    assert_true(s.n == 4 && s.generation > generation && s.solids > solids);
    const int32_t links[4] = {2, -1, -1, 0};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(s.id[k], order[k]);
        assert_int_equal(s.wall_of[k], links[k]);
    }
    mps__particles_free(&s);
}

/* The stencil has the pairs of the current positions, also during a read lease; no particle changes
 * its index, and later steps are as without the call. */
static void stencil_of_moved(double shift, bool look, double *after)
{
    mps_sim *sim = pool();
    mps_lease lease = {.struct_size = sizeof lease};
    mps_stencil s = {.struct_size = sizeof s};
    const int64_t *ids;
    int64_t before[1000];
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &lease));
    for (int64_t i = 0; i < lease.count; i++) lease.data[2 * i] += (i % 3 - 1) * shift * dp;
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &lease));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    memcpy(before, ids, (size_t)lease.count * sizeof *ids);
    for (int again = 0; look && again < 2; again++) {
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &s));
        for (int64_t i = 0; i < s.n; i++) {
            int64_t pairs = 0;
            for (int64_t j = 0; j < s.n; j++)
                pairs += j != i &&
                         hypot(s.x[2 * j] - s.x[2 * i], s.x[2 * j + 1] - s.x[2 * i + 1]) < s.re;
            assert_int_equal(s.end[i] - s.begin[i], pairs);
        }
        assert_memory_equal(before, ids, (size_t)lease.count * sizeof *ids);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    for (int d = 0; d < 2; d++) by_id(sim, "position", d, after + 1000 * d);
    mps_sim_destroy(sim);
}

static void stencil_under_lease(void **state)
{
    (void)state;
    double seen[2000], unseen[2000];
    for (int far = 0; far < 2;
         far++) { /* within half the skin of 0.25 dp, and beyond: a new search */
        memset(seen, 0, sizeof seen);
        memset(unseen, 0, sizeof unseen);
        stencil_of_moved(far ? 0.3 : 0.1, true, seen);
        stencil_of_moved(far ? 0.3 : 0.1, false, unseen);
        assert_memory_equal(seen, unseen, sizeof seen);
    }
}

/* ---- fields and ids -------------------------------------------------------------------------- */

static void field_refused(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    char name[16];
    ASSERT_REFUSED(sim, mps_field_add(sim, "pressure", 1), MPS_E_ARG, "exists");
    ASSERT_REFUSED(sim, mps_field_add(sim, "kind", 1), MPS_E_ARG, "exists"); /* a private one */
    ASSERT_REFUSED(sim, mps_field_add(sim, "mine", 0), MPS_E_ARG, "components is 0");
    ASSERT_REFUSED(sim, mps_field_add(sim, "mine", 10), MPS_E_ARG, "components is 10");
    ASSERT_REFUSED(sim, mps_field_add(sim, "", 1), MPS_E_ARG, "1..31");
    ASSERT_REFUSED(sim, mps_field_add(sim, NULL, 1), MPS_E_ARG, "1..31");
    ASSERT_REFUSED(sim, mps_field_add(sim, "a name of more than thirty-one letters", 1), MPS_E_ARG,
                   "1..31");
    assert_int_equal(mps_field_add(NULL, "mine", 1), MPS_E_ARG);
    mps_status status = MPS_OK;
    for (int k = 0; k < 40 && status == MPS_OK; k++) {
        snprintf(name, sizeof name, "f%d", k);
        status = mps_field_add(sim, name, 1);
    }
    ASSERT_REFUSED(sim, status, MPS_E_ARG, "too many");
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

/* Write values to a field that identify its particle: its initial position, and its id. */
static void mark(mps_sim *sim)
{
    mps_lease mine = {.struct_size = sizeof mine}, x = {.struct_size = sizeof x};
    const int64_t *ids;
    ASSERT_OK(sim, mps_field_add(sim, "mine", 3));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "mine", MPS_WRITE, &mine));
    assert_int_equal(mine.stride, 3);
    for (int64_t i = 0; i < mine.count; i++) {
        for (int c = 0; c < 3; c++) assert_true(mine.data[3 * i + c] == 0); /* zero at first */
        mine.data[3 * i] = x.data[2 * i];
        mine.data[3 * i + 1] = x.data[2 * i + 1];
        mine.data[3 * i + 2] = (double)ids[i];
    }
    ASSERT_OK(sim, mps_lease_end(sim, &mine));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
}

/* The store is sorted by the first step and grown by an addition: every particle keeps what is its
 * own. */
static void field_travels(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    double x0[1000], y0[1000], mine[1000], x[1000];
    const int64_t n = mps_particles_count(sim, -1);
    const double top[2] = {0.25, 0.45};
    const mps_particle_block b = block_of(1, top);
    bool moved = false;
    by_id(sim, "position", 0, x0);
    by_id(sim, "position", 1, y0);
    mark(sim);
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    for (int64_t id = 0; id < n; id++) moved = moved || mps_particle_index(sim, id) != id;
    assert_true(moved); /* else nothing was sorted, and the test shows nothing */
    by_id(sim, "mine", 0, mine);
    for (int64_t id = 0; id < n; id++) assert_true(mine[id] == x0[id]);
    by_id(sim, "mine", 1, mine);
    for (int64_t id = 0; id < n; id++) assert_true(mine[id] == y0[id]);
    by_id(sim, "mine", 2, mine);
    for (int64_t id = 0; id < n; id++) assert_true(mine[id] == (double)id);
    assert_true(mine[n] == 0);
    by_id(sim, "position", 0, x);
    for (int64_t id = 0; id < n; id++)
        assert_true(fabs(x[id] - x0[id]) < 0.1 * dp); /* ids are still the same particles */
    mps_sim_destroy(sim);
}

/* Integers of particles are leased by name, for reading only, and prevent reordering like all
 * leases. */
static void leases_of_tags(void **state)
{
    (void)state;
    static const char *const names[] = {"id", "kind", "phase", "part", "region", "plate"};
    mps_sim *sim = pool();
    const int64_t n = mps_particles_count(sim, -1);
    mps_lease l[6];
    for (int k = 0; k < 6; k++) {
        assert_int_equal(mps_lease_init(&l[k], sizeof l[k]), MPS_OK);
        ASSERT_REFUSED(sim, mps_lease_begin(sim, names[k], MPS_WRITE, &l[k]), MPS_E_ARG,
                       "cannot be written");
        ASSERT_OK(sim, mps_lease_begin(sim, names[k], MPS_READ, &l[k]));
        assert_true(l[k].count == n && l[k].stride == 1 && !l[k].data);
        assert_int_equal(l[k].type, k == 0 ? MPS_DATA_INT64 : MPS_DATA_INT32);
        assert_true(!l[k].ids == (k > 0) && !l[k].integers == (k == 0));
    }
    for (int64_t i = 0; i < n; i++) {
        assert_int_equal(mps_particle_index(sim, l[0].ids[i]), i);
        assert_true(l[1].integers[i] >= MPS_FLUID && l[1].integers[i] <= MPS_DUMMY &&
                    l[5].integers[i] == 0);
    }
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_BUSY, "6 lease(s) are open");
    for (int k = 0; k < 6; k++) {
        ASSERT_OK(sim, mps_lease_end(sim, &l[k]));
        assert_true(l[k].struct_size == sizeof l[k] && l[k].count == 0 && !l[k].integers &&
                    !l[k].ids);
        ASSERT_REFUSED(sim, mps_lease_end(sim, &l[k]), MPS_E_ARG, "not open");
    }
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "wall_of", MPS_READ, &l[0]), MPS_E_NAME,
                   "no field 'wall_of'");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leases_of_tags), cmocka_unit_test(lease_conflicts),
        cmocka_unit_test(lease_refused),  cmocka_unit_test(lease_blocks),
        cmocka_unit_test(written_values), cmocka_unit_test(field_refused),
        cmocka_unit_test(field_travels),  cmocka_unit_test(stencil_under_lease),
        cmocka_unit_test(links_follow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
