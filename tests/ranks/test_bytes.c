/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs on 2, 3, 4 and 7 ranks have the bytes of a run on one, after every step. The environment
 * variables MPS_RANKS_STEPS and MPS_RANKS_THREADS set other numbers of steps, and of threads of
 * each rank. */
#include "team.h"
#include "sim.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { TEXT = 300 };

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    record *records; /* [steps] */
    char error[64][TEXT];
} run;

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    for (int s = 0; s < k->scene->steps && status >= 0; s++) {
        sim->world.ghosts.recut = s % 7 == 3; /* a new partition in each neighbour search */
        status = scene_change(sim, k->scene, s);
        if (status == MPS_OK) status = mps_step(sim, 1, &info);
        if (status >= 0) record_note(sim, &info, &k->records[s]);
    }
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static record *run_scene(const scene *s, int32_t ranks, uint32_t skew)
{
    run k = {.scene = s, .records = calloc((size_t)s->steps, sizeof(record))};
    assert_non_null(k.records);
    if (ranks > 1) k.team = kit_engine_create(ranks, skew);
    if (k.team)
        kit_engine_run(k.team, run_rank, &k);
    else
        run_rank(&k, 0);
    for (int32_t r = 0; r < ranks; r++)
        if (k.error[r][0]) fail_msg("rank %d of %d: %s", (int)r, (int)ranks, k.error[r]);
    if (k.team) kit_engine_destroy(k.team);
    return k.records;
}

static void compare(const scene *s, const record *alone, const record *many, int32_t ranks)
{
    char text[TEXT];
    for (int k = 0; k < s->steps; k++)
        if (!record_same(&alone[k], &many[k], text, sizeof text))
            fail_msg("%s on %d ranks, step %d: %s", s->name, (int)ranks, k + 1, text);
}

/* `of`: the scene of the list, of which s is one with other numbers */
static void check(const scene *s, const scene *of)
{
    static const int32_t ranks[] = {2, 3, 4, 7};
    record *alone = run_scene(s, 1, 0);
    for (int k = 0; k < 4; k++) {
        if (!scene_runs(of, k, 4)) continue;
        record *many = run_scene(s, ranks[k], (uint32_t)k);
        compare(s, alone, many, ranks[k]);
        free(many);
    }
    free(alone);
}

static int32_t number_of(const char *name, int32_t otherwise)
{
    const char *text = getenv(name);
    return text ? (int32_t)strtol(text, NULL, 10) : otherwise;
}

static void test_scene(void **state)
{
    scene s = *(const scene *)*state;
    s.steps = number_of("MPS_RANKS_STEPS", s.steps);
    s.threads = number_of("MPS_RANKS_THREADS", s.threads);
    check(&s, *state);
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
