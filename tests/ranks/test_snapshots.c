/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots on any number of ranks: steps after a restore are those of one rank without
 * snapshots. */
#include "team.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { TEXT = 300, STEPS = 24, TAKES = 3 };

/* Before these steps a snapshot is taken; after so many more it is restored, twice. Space is
 * divided and cut anew meanwhile. */
static const int take_at[TAKES] = {1, 6, 15}, away[TAKES] = {1, 9, 2};

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    bool trials;
    record *last; /* of the last step */
    mps_load load[4];
    char error[64][TEXT];
} run;

static mps_status advance(mps_sim *sim, const scene *s, int from, int to, mps_step_info *info)
{
    mps_status status = MPS_OK;
    for (int k = from; k < to && status >= 0; k++) {
        status = scene_change(sim, s, k);
        if (status >= 0) status = mps_step(sim, 1, info);
    }
    return status;
}

/* Restore after other steps; the added mass, and a field, are first used while positions of a
 * search are kept for the next one. */
static mps_status go_astray(mps_sim *sim, const run *k, mps_snapshot *snapshot, mps_step_info *info)
{
    const int32_t what = strstr(k->scene->preset, "paper") ? MPS_LOAD_FORCE : MPS_LOAD_MASS;
    mps_status status = MPS_OK;
    if (k->trials) status = advance(sim, k->scene, 0, 1, info);
    if (k->trials && status >= 0) status = mps_snapshot_take(snapshot);
    if (k->trials && status >= 0) status = advance(sim, k->scene, 1, 9, info);
    if (k->trials && status >= 0) status = mps_snapshot_restore(snapshot);
    if (!k->trials && status >= 0) status = advance(sim, k->scene, 0, 1, info);
    if (status >= 0) status = mps_load_watch(sim, what);
    return status >= 0 ? mps_field_add(sim, "mine", 2) : status;
}

static mps_status go(mps_sim *sim, const run *k, mps_step_info *info)
{
    mps_snapshot *snapshot = NULL;
    mps_status status = mps_snapshot_create(sim, &snapshot);
    int done = 1;
    if (status >= 0) status = go_astray(sim, k, snapshot, info);
    for (int c = 0; c < TAKES && k->trials && status >= 0; done = take_at[c++]) {
        status = advance(sim, k->scene, done, take_at[c], info);
        if (status >= 0) status = mps_snapshot_take(snapshot);
        for (int again = 0; again < 2 && status >= 0; again++) {
            status = advance(sim, k->scene, take_at[c], take_at[c] + away[c] + again, info);
            if (status >= 0) status = mps_snapshot_restore(snapshot);
        }
    }
    if (status >= 0) status = advance(sim, k->scene, done, STEPS, info);
    mps_snapshot_destroy(snapshot);
    return status;
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    if (status == MPS_OK) status = go(sim, k, &info);
    mps_load_init(&k->load[rank], sizeof k->load[rank]);
    if (status >= 0) status = mps_load_get(sim, NULL, &k->load[rank]);
    if (status >= 0) record_note(sim, &info, k->last);
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* @return what the last step left; for free() */
static record *take(const scene *s, int32_t ranks, bool trials, mps_load *load)
{
    run k = {.scene = s,
             .trials = trials,
             .last = calloc(1, sizeof(record)),
             .team = ranks > 1 ? kit_engine_create(ranks, (uint32_t)ranks) : NULL};
    assert_non_null(k.last);
    if (k.team)
        kit_engine_run(k.team, run_rank, &k);
    else
        run_rank(&k, 0);
    for (int32_t r = 0; r < ranks; r++)
        if (k.error[r][0])
            fail_msg("%s, rank %d of %d: %s", s->name, (int)r, (int)ranks, k.error[r]);
    if (k.team) kit_engine_destroy(k.team);
    for (int32_t r = 1; r < ranks; r++) assert_memory_equal(&k.load[0], &k.load[r], sizeof *k.load);
    *load = k.load[0];
    return k.last;
}

static void test_scene(void **state)
{
    const scene *s = *state;
    char text[TEXT];
    mps_load first, load;
    record *alone = take(s, 1, false, &first);
    for (int32_t ranks = 1; ranks <= 4; ranks++) {
        if (!scene_runs(s, ranks - 1, 4)) continue;
        record *many = take(s, ranks, true, &load);
        if (!record_same(alone, many, text, sizeof text))
            fail_msg("%s: %d ranks: %s", s->name, (int)ranks, text);
        assert_memory_equal(&first, &load, sizeof load);
        free(many);
    }
    free(alone);
}

int main(void)
{
    struct CMUnitTest tests[SCENES];
    for (int k = 0; k < SCENES; k++)
        tests[k] = (struct CMUnitTest){.name = scenes[k].name,
                                       .test_func = test_scene,
                                       .initial_state = (void *)(uintptr_t)&scenes[k]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
