/* SPDX-License-Identifier: BSD-3-Clause */
/* surface.asymmetry: surface particles, remaining particles in spray; the volume error of liquid of
 * few rows. */
#include "tank_fixture.h"
#include <mps/model.h>

static const double dp = 0.05;

static int32_t region[1000]; /* by id, of the last step */

static int keep_regions(mps_stage *s)
{
    const int32_t *regions = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++) region[s->view->id[i]] = regions[i];
    return 0;
}

static const mps_use keeper_uses[] = {{"region", MPS_USE_READ}};
static const mps_verb keeper_verbs[] = {
    {.hook = MPS_SOURCE, .use_count = 1, .uses = keeper_uses, .after = "*", .run = keep_regions}};
static const mps_model_ops keeper = {.struct_size = sizeof(mps_model_ops),
                                     .api = MPS_MODEL_API,
                                     .name = "keeper.regions",
                                     .help = "keeps the regions of a step",
                                     .verb_count = 1,
                                     .verbs = keeper_verbs};

/* Id of the first of `count` particles at x [count*2], in dp, in the lower left corner of a tank,
 * after a step. */
static int64_t classified(int64_t count, const double *x)
{
    double at[42];
    int64_t ids[21];
    mps_particle_block b;
    mps_sim *sim = new_sim(2, dp);
    ASSERT_OK(sim, mps_model_register(sim, &keeper));
    ASSERT_OK(sim, mps_model_use(sim, "keeper.regions"));
    add_tank(sim, 0.5, 0.5, 0);
    for (int64_t k = 0; k < 2 * count; k++) at[k] = x[k] * dp;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = count;
    b.position = at;
    ASSERT_OK(sim, mps_particles_add(sim, &b, ids));
    ASSERT_OK(sim, mps_step(sim, 1e-5, NULL));
    mps_sim_destroy(sim);
    return ids[0];
}

/* Its two neighbours have too little fluid about them and are spray. The one in the corner has
 * enough, but all of it is spray. */
static void island_in_a_corner(void **state)
{
    (void)state;
    const double x[] = {1, 1, 2, 1, 1, 2, 2, 2};
    int64_t id = classified(3, x);
    assert_true(region[id + 1] == MPS_REGION_SPRAY && region[id + 2] == MPS_REGION_SPRAY);
    assert_int_equal(region[id], MPS_REGION_SURFACE);
    id = classified(4, x); /* with a fourth it is a puddle */
    assert_int_equal(region[id + 3], MPS_REGION_SURFACE);
    assert_true(region[id] < MPS_REGION_SURFACE);
}

/* A row of seven half a spacing above the floor, the middle one of which has more about it than in
 * a full lattice, is a film with p = 0. Under two more rows it is not. */
static void film_on_the_floor(void **state)
{
    (void)state;
    double x[42];
    for (int k = 0; k < 21; k++) {
        const int column = (k % 7 + 3) % 7; /* the middle first */
        x[2 * k] = 2 + column;
        x[2 * k + 1] = 0.5 + k / 7;
    }
    assert_int_equal(region[classified(7, x)], MPS_REGION_SURFACE);
    assert_true(region[classified(21, x)] < MPS_REGION_SURFACE);
}

/* Region of the particle below the tip of liquid that climbs a wall: four rows, in the column at
 * the wall the top one lifted, in the next the upper two lower. contact < 0: as the model
 * begins. */
static int32_t below_the_tip(double contact)
{
    double at[72];
    int64_t ids[36], count = 0;
    mps_particle_block b;
    mps_sim *sim = new_sim(2, dp);
    ASSERT_OK(sim, mps_model_register(sim, &keeper));
    ASSERT_OK(sim, mps_model_use(sim, "keeper.regions"));
    if (contact >= 0) ASSERT_OK(sim, mps_model_set(sim, "surface", "contact", contact));
    add_tank(sim, 0.5, 0.5, 0);
    for (int column = 1; column <= 9; column++)
        for (int row = 1; row <= 4; row++, count++) {
            const double lift = column == 1 && row == 4 ? 0.7 : column == 2 && row >= 3 ? -0.2 : 0;
            at[2 * count] = column * dp;
            at[2 * count + 1] = (row + lift) * dp;
        }
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = count;
    b.position = at;
    ASSERT_OK(sim, mps_particles_add(sim, &b, ids));
    ASSERT_OK(sim, mps_step(sim, 1e-5, NULL));
    mps_sim_destroy(sim);
    return region[ids[2]];
}

/* Next to a wall that extends above the surface n is too large and the asymmetry too small. */
static void surface_meets_a_wall(void **state)
{
    (void)state;
    assert_int_equal(below_the_tip(-1), MPS_REGION_SURFACE);
    assert_int_equal(below_the_tip(1), MPS_REGION_SURFACE);
    assert_int_equal(below_the_tip(0), MPS_REGION_NEAR);
}

/* Five rows: none of them is further from the surface than the second band, and still a squeeze of
 * 2 % is seen. */
static void volume_of_shallow_liquid(void **state)
{
    (void)state;
    mps_energy e;
    mps_lease x = {.struct_size = sizeof x};
    const int32_t *kind;
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 1, 0.5, 0);
    assert_true(fill_depth(sim, 1, 5.5 * dp, 0) > 0);
    ASSERT_OK(sim, mps_step(sim, 1e-6, NULL));
    ASSERT_OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t i = 0; i < x.count; i++)
        if (kind[i] == MPS_FLUID) x.data[2 * i] *= 0.98;
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_step(sim, 1e-6, NULL));
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    assert_true(e.volume_error < -0.008 &&
                e.volume_error > -0.02); /* the walls are where they were */
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(island_in_a_corner), cmocka_unit_test(film_on_the_floor),
        cmocka_unit_test(surface_meets_a_wall), cmocka_unit_test(volume_of_shallow_liquid)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
