/* SPDX-License-Identifier: BSD-3-Clause */
/* Voids of the tank: the same bytes with any number of threads, limits, refusals, places. */
#include "void_fixture.h"

/* Ten steps of liquid that falls into its voids. */
static void fall(found_voids *f, int32_t threads)
{
    mps_sim *sim = new_sim(2, DP);
    add_tank(sim, 1, 0.8, 0);
    add_dividing_plate(sim);
    fill_drawn(sim, 2, 0.5, in_both);
    watch_voids(sim, f);
    ASSERT_OK(sim, mps_threads_set(sim, threads));
    for (int k = 0; k < 10; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

static void test_threads(void **state)
{
    found_voids one, f;
    (void)state;
    fall(&one, 1);
    assert_true(one.v.count >= 4 && one.v.faces > 300);
    for (int32_t threads = 2; threads <= 5; threads += 3) {
        fall(&f, threads);
        assert_int_equal(f.v.count, one.v.count);
        assert_int_equal(f.v.faces, one.v.faces);
        assert_memory_equal(f.label, one.label, (size_t)cells_of(&f.v) * sizeof *f.label);
        assert_memory_equal(f.size, one.size, (size_t)f.v.count * sizeof *f.size);
        for (int k = 0; k < 5; k++)
            assert_memory_equal(f.face[k], one.face[k], (size_t)f.v.faces * sizeof *f.face[k]);
        forget_voids(&f);
    }
    forget_voids(&one);
}

static void test_least(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, in_both);
    (void)state;
    f.config.least = 65; /* the circle has 113 dp2, the box 70, of which deep are fewer */
    step_and_end(sim);
    assert_int_equal(f.v.count, 2);
    assert_true(share_within(&f, 1, in_circle) > 0.95);
    forget_voids(&f);
}

/* Liquid without a tank has no raster. */
static void test_no_tank(void **state)
{
    found_voids f;
    const double x[4] = {0, 0, 0, 0.02};
    mps_particle_block b;
    mps_sim *sim = new_sim(2, DP);
    (void)state;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 2;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    watch_voids(sim, &f);
    step_and_end(sim);
    assert_int_equal(f.steps, 1);
    assert_int_equal(f.v.count, 0);
    assert_int_equal(cells_of(&f.v), 0);
    forget_voids(&f);
}

static int ask_early(mps_stage *s)
{
    mps_voids v;
    assert_int_equal(mps_voids_init(&v, sizeof v), MPS_OK);
    return mps_stage_voids(s, NULL, &v);
}

static int ask_for_nothing(mps_stage *s)
{
    return mps_stage_voids(s, NULL, NULL);
}

static void test_refusals(void **state)
{
    static const mps_verb early[] = {{.hook = MPS_LIMIT, .run = ask_early}},
                          null[] = {{.hook = MPS_PREPARE, .run = ask_for_nothing}};
    const mps_model_ops early_ops = {TOY("early.voids", 1, early)},
                        null_ops = {TOY("null.voids", 1, null)};
    static const struct {
        double side, cover, channel, least;
        const char *word;
    } bad[] = {{0.1, 0, 0, 0, "side is 0.1 dp"},  {3, 0, 0, 0, "side is 3 dp"},
               {0, 0.2, 0, 0, "cover is 0.2 dp"}, {0, 0, 0.5, 0, "channel is 0.5 dp"},
               {0, 0, 4, 0, "channel is 4 dp"},   {0, 0, 0, -1, "least is -1 dp"},
               {NAN, 0, 0, 0, "side is nan"},     {0, 0, 0, INFINITY, "least is inf"}};
    found_voids f;
    mps_sim *sim = drawn_2d(&f, none);
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        f.config.side = bad[k].side;
        f.config.cover = bad[k].cover;
        f.config.channel = bad[k].channel;
        f.config.least = bad[k].least;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, bad[k].word);
    }
    assert_int_equal(mps_voids_config_init(&f.config, sizeof f.config), MPS_OK);
    use_model(sim, &early_ops);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "before MPS_PREPARE");
    ASSERT_OK(sim, mps_model_remove(sim, "early"));
    use_model(sim, &null_ops);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "mps_voids is NULL");
    ASSERT_OK(sim, mps_model_remove(sim, "null"));
    step_and_end(sim);
    assert_int_equal(f.v.count, 1);
    forget_voids(&f);
}

/* Places in the raster. */
static void test_places(void **state)
{
    found_voids f;
    const double in[2] = {0.503, 0.252}, beyond[2] = {0.5, -0.1}, wall[2] = {0.503, 0.39};
    mps_sim *sim = drawn_2d(&f, in_circle);
    (void)state;
    step_and_end(sim);
    f.v.label = f.label;
    assert_int_equal(f.label[mps_voids_cell(&f.v, in)], 1);
    assert_int_equal(mps_voids_cell(&f.v, beyond), -1);
    assert_int_equal(mps_voids_near(&f.v, in, 0.02), 1);
    assert_int_equal(mps_voids_near(&f.v, beyond, 0.05), -1);
    assert_int_equal(mps_voids_near(&f.v, wall, 0.01), -1);
    assert_int_equal(mps_voids_near(&f.v, wall, 0.04), 1);
    forget_voids(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_threads), cmocka_unit_test(test_least),
                                       cmocka_unit_test(test_no_tank),
                                       cmocka_unit_test(test_refusals),
                                       cmocka_unit_test(test_places)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
