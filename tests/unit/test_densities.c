/* SPDX-License-Identifier: BSD-3-Clause */
/* Densities of phases that verbs request: cached from step to step, but invalidated when particles
 * change. */
#include "model_fixture.h"
#include <mps/couple.h>

static double least[MPS_PHASES], greatest[MPS_PHASES];
static int64_t asked;

static int ask(mps_stage *s)
{
    double again[MPS_PHASES];
    asked++;
    mps_stage_densities(s, least, greatest);
    mps_stage_densities(s, again, NULL);
    mps_stage_densities(s, NULL, NULL);
    assert_memory_equal(again, least, sizeof again);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_PREPARE, .run = ask}};
static const mps_model_ops asker = {TOY("asker.toy", 1, verbs)};

static void set_phase(mps_sim *sim, int32_t index, double density)
{
    mps_phase phase;
    assert_int_equal(mps_phase_init(&phase, sizeof phase), MPS_OK);
    phase.density = density;
    ASSERT_OK(sim, mps_phase_set(sim, index, &phase));
}

/* Three in a row at a height. @param ids  NULL, or [3] out */
static void add_layer(mps_sim *sim, int32_t phase, double y, int64_t *ids)
{
    const double x[] = {0, y, 1, y, 2, y};
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 3;
    b.position = x;
    b.phase = phase;
    ASSERT_OK(sim, mps_particles_add(sim, &b, ids));
}

/* After a step: of phases 0 and 1, least and greatest; others have no fluid. */
static void assert_told(mps_sim *sim, double least0, double greatest0, double least1,
                        double greatest1)
{
    const int64_t before = asked;
    ASSERT_OK(sim, mps_step(sim, 1e-4, NULL));
    assert_int_equal(asked, before + 1);
    assert_true(least[0] == least0 && greatest[0] == greatest0);
    assert_true(least[1] == least1 && greatest[1] == greatest1);
    for (int p = 2; p < MPS_PHASES; p++) assert_true(least[p] == 0 && greatest[p] == 0);
}

/* Density of the first particle in memory that has one above `above`. */
static void write_density(mps_sim *sim, double above, double density)
{
    mps_lease lease = {.struct_size = sizeof lease};
    int64_t i = 0;
    ASSERT_OK(sim, mps_lease_begin(sim, "density", MPS_WRITE, &lease));
    while (i < lease.count && !(lease.data[i * lease.stride] > above)) i++;
    assert_true(i < lease.count);
    lease.data[i * lease.stride] = density;
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
}

/* Three particles of 1000 kg/m3, and a phase 1 of 2 kg/m3 without any. */
static mps_sim *asking(void)
{
    mps_sim *sim = empty_sim(2, 1, NULL);
    set_phase(sim, 0, 1000);
    set_phase(sim, 1, 2);
    use_model(sim, &asker);
    add_layer(sim, 0, 0, NULL);
    return sim;
}

static void follow_the_particles(void **state)
{
    mps_sim *sim = asking();
    (void)state;
    for (int k = 0; k < 3; k++) assert_told(sim, 1000, 1000, 0, 0);
    add_layer(sim, 1, 10, NULL);
    for (int k = 0; k < 3; k++) assert_told(sim, 1000, 1000, 2, 2);
    write_density(sim, 500, 900);
    assert_told(sim, 900, 1000, 2, 2);
    set_phase(sim, 1, 3);
    assert_told(sim, 900, 1000, 3, 3);
    mps_sim_destroy(sim);
}

/* A snapshot and a removal bring other particles. */
static void follow_what_is_restored(void **state)
{
    mps_sim *sim = asking();
    mps_snapshot *kept;
    int64_t light[3];
    (void)state;
    add_layer(sim, 1, 10, light);
    assert_told(sim, 1000, 1000, 2, 2);
    ASSERT_OK(sim, mps_snapshot_create(sim, &kept));
    ASSERT_OK(sim, mps_snapshot_take(kept));
    ASSERT_OK(sim, mps_particles_remove(sim, 3, light));
    assert_told(sim, 1000, 1000, 0, 0);
    ASSERT_OK(sim, mps_snapshot_restore(kept));
    assert_told(sim, 1000, 1000, 2, 2);
    mps_snapshot_destroy(kept);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(follow_the_particles),
                                       cmocka_unit_test(follow_what_is_restored)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
