/* SPDX-License-Identifier: BSD-3-Clause */
/* Refusals: tables of engines, engines that fail in create, and calls at the wrong time. */
#include "kit_engine.h"
#include "scenes.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { RANKS = 2, TEXT = 300 };

static void refuses(const mps_ranks_ops *ops, mps_status wanted, const char *word)
{
    mps_sim *sim = NULL;
    assert_int_equal(scene_create(&scenes[0], &sim), MPS_OK);
    assert_int_equal(mps_sim_ranks_set(sim, ops), wanted);
    if (!strstr(mps_sim_error(sim), word))
        fail_msg("'%s' does not mention '%s'", mps_sim_error(sim), word);
    int32_t rank = -1, ranks = -1; /* the handle works on one rank */
    assert_int_equal(mps_sim_ranks(sim, &rank, &ranks), MPS_OK);
    assert_int_equal(mps_sim_ranks(sim, NULL, NULL), MPS_OK);
    assert_true(rank == 0 && ranks == 1);
    mps_sim_destroy(sim);
}

static int says_why(const mps_allocator *allocator, void **self, char *text, size_t size)
{
    (void)allocator, (void)self;
    snprintf(text, size, "no network");
    return 1;
}

static int says_nothing(const mps_allocator *allocator, void **self, char *text, size_t size)
{
    (void)allocator, (void)self, (void)text, (void)size;
    return 1;
}

static int begins(const mps_allocator *allocator, void **self, char *text, size_t size)
{
    (void)allocator, (void)self, (void)text, (void)size;
    return 0;
}

static void ends(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
}

static int32_t place_rank, place_ranks;
static void tells_place(void *self, int32_t *rank, int32_t *ranks)
{
    (void)self;
    *rank = place_rank;
    *ranks = place_ranks;
}

static void tables(void **state)
{
    (void)state;
    kit_engine_team *team = kit_engine_create(RANKS, 0);
    const mps_ranks_ops good = kit_engine_ops(team, 0);
    mps_ranks_ops bad = good;
    refuses(NULL, MPS_E_ARG, "mps_ranks_ops");
    bad.struct_size = 8;
    refuses(&bad, MPS_E_ARG, "mps_ranks_ops");
    bad = good;
    bad.api = MPS_RANKS_API + 1;
    refuses(&bad, MPS_E_ARG, "api");
    bad = good;
    bad.name = NULL;
    refuses(&bad, MPS_E_ARG, "name");
    bad.name = "";
    refuses(&bad, MPS_E_ARG, "name");
#define WITHOUT(entry) \
    bad = good;        \
    bad.entry = NULL;  \
    refuses(&bad, MPS_E_ARG, "lacks a function");
    WITHOUT(create)
    WITHOUT(destroy)
    WITHOUT(place)
    WITHOUT(partition)
    WITHOUT(owner)
    WITHOUT(overlap)
    WITHOUT(connect)
    WITHOUT(disconnect)
    WITHOUT(exchange_begin)
    WITHOUT(exchange_end)
    WITHOUT(reduce)
    WITHOUT(gather)
    WITHOUT(fail)
    WITHOUT(failure)
#undef WITHOUT
    kit_engine_destroy(team);
}

static void engines_that_do_not_begin(void **state)
{
    (void)state;
    static const int32_t places[][2] = {{0, 0}, {-1, 2}, {2, 2}};
    kit_engine_team *team = kit_engine_create(RANKS, 0);
    mps_ranks_ops ops = kit_engine_ops(team, 0);
    ops.create = says_why;
    refuses(&ops, MPS_E_PLUGIN, "no network");
    ops.create = says_nothing;
    refuses(&ops, MPS_E_NOMEM, "no memory");
    ops.create = begins;
    ops.destroy = ends;
    ops.place = tells_place;
    for (int k = 0; k < 3; k++) {
        place_rank = places[k][0];
        place_ranks = places[k][1];
        refuses(&ops, MPS_E_PLUGIN, "must be 0..ranks-1");
    }
    kit_engine_destroy(team);
}

/* ---- calls ---- */

typedef struct run {
    kit_engine_team *team;
    char fault[RANKS][TEXT];
} run;

#define EXPECT(call, wanted, word)                                                  \
    do {                                                                            \
        const mps_status got_ = (call);                                             \
        if ((got_ != (wanted) || !strstr(mps_sim_error(sim), (word))) && !fault[0]) \
            snprintf(fault, TEXT, "%s: %s '%s'", #call, mps_status_name(got_),      \
                     mps_sim_error(sim));                                           \
    } while (0)

static void too_late(mps_sim *sim, const mps_ranks_ops *ops, char *fault)
{
    const double lo[2] = {0.4, 0.2}, hi[2] = {0.5, 0.3};
    EXPECT(mps_sim_ranks_set(sim, ops), MPS_E_STATE, "has engine of ranks");
    EXPECT(mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_E_STATE, "before the first step");
    EXPECT(mps_checkpoint_read(sim, "none"), MPS_E_STATE, "before the first step");
}

static void collecting(mps_sim *sim, char *fault)
{
    mps_lease lease;
    mps_lease_init(&lease, sizeof lease);
    EXPECT(mps_particles_collect_end(sim), MPS_E_STATE, "not collected");
    EXPECT(mps_lease_begin(sim, "velocity", MPS_READ, &lease), MPS_OK, "");
    EXPECT(mps_particles_collect(sim), MPS_E_BUSY, "lease");
    EXPECT(mps_lease_end(sim, &lease), MPS_OK, "");
    EXPECT(mps_particles_collect(sim), MPS_OK, "");
    EXPECT(mps_particles_collect(sim), MPS_E_STATE, "collected already");
    EXPECT(mps_step(sim, 1, NULL), MPS_E_STATE, "collected");
    EXPECT(mps_lease_begin(sim, "velocity", MPS_READ, &lease), MPS_OK, "");
    EXPECT(mps_particles_collect_end(sim), MPS_E_BUSY, "lease");
    EXPECT(mps_lease_end(sim, &lease), MPS_OK, "");
    EXPECT(mps_particles_collect_end(sim), MPS_OK, "");
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    char *fault = k->fault[rank];
    mps_sim *sim = NULL;
    const uint8_t *ghost = NULL;
    const mps_ranks_ops ops = kit_engine_ops(k->team, rank);
    mps_status status = scene_create(&scenes[0], &sim);
    if (status == MPS_OK) status = mps_sim_ranks_set(sim, &ops);
    if (status == MPS_OK) status = scene_build(sim, &scenes[0]);
    if (status == MPS_OK) status = mps_step(sim, 1, NULL);
    EXPECT(status, MPS_OK, "");
    too_late(sim, &ops, fault);
    collecting(sim, fault);
    EXPECT(mps_particles_ghosts(sim, NULL), MPS_E_ARG, "ghost");
    EXPECT(mps_particles_ghosts(sim, &ghost), MPS_OK, "");
    if (!ghost && !fault[0]) snprintf(fault, TEXT, "no ghosts");
    EXPECT(mps_step(sim, 1, NULL), MPS_OK, "");
    mps_sim_destroy(sim);
}

static void calls(void **state)
{
    (void)state;
    run k = {.team = kit_engine_create(RANKS, 0)};
    kit_engine_run(k.team, run_rank, &k);
    kit_engine_destroy(k.team);
    for (int r = 0; r < RANKS; r++) assert_string_equal(k.fault[r], "");
    assert_int_equal(mps_sim_ranks(NULL, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_sim_ranks_set(NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_particles_collect(NULL), MPS_E_ARG);
    assert_int_equal(mps_particles_collect_end(NULL), MPS_E_ARG);
    assert_int_equal(mps_particles_ghosts(NULL, NULL), MPS_E_ARG);
}

/* An engine is set before the particles that it partitions. */
static void after_particles(void **state)
{
    (void)state;
    kit_engine_team *team = kit_engine_create(1, 0);
    const mps_ranks_ops ops = kit_engine_ops(team, 0);
    mps_sim *sim = NULL;
    assert_int_equal(scene_create(&scenes[0], &sim), MPS_OK);
    assert_int_equal(scene_build(sim, &scenes[0]), MPS_OK);
    assert_int_equal(mps_sim_ranks_set(sim, &ops), MPS_E_STATE);
    assert_non_null(strstr(mps_sim_error(sim), "call mps_sim_ranks_set() first"));
    mps_sim_destroy(sim);
    kit_engine_destroy(team);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tables),
                                       cmocka_unit_test(engines_that_do_not_begin),
                                       cmocka_unit_test(calls), cmocka_unit_test(after_particles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
