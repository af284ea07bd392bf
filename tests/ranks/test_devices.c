/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks that have a device each have the bytes of a run alone on the host, after every step. */
#include "team.h"
#include "shadow.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { TEXT = 300, MOST = 4 };

typedef struct run {
    const scene *scene;
    kit_engine_team *team; /* NULL: alone, without a device */
    record *records;       /* [steps] */
    shadow device[MOST];
    char error[MOST][TEXT];
} run;

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    if (status == MPS_OK && k->team) shadow_attach(&k->device[rank], sim);
    for (int s = 0; s < k->scene->steps && status >= 0; s++) {
        sim->world.ghosts.recut = s % 7 == 3; /* new cuts whenever a search comes */
        status = scene_change(sim, k->scene, s);
        if (status == MPS_OK) status = mps_step(sim, 1, &info);
        if (status >= 0 && mps__world_fetch(&sim->world) == MPS_OK)
            record_note(sim, &info, &k->records[s]);
    }
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static run *run_scene(const scene *s, int32_t ranks)
{
    run *k = calloc(1, sizeof *k);
    assert_non_null(k);
    k->scene = s;
    k->records = calloc((size_t)s->steps, sizeof *k->records);
    assert_non_null(k->records);
    if (ranks > 1) {
        k->team = kit_engine_create(ranks, 1);
        kit_engine_run(k->team, run_rank, k);
        kit_engine_destroy(k->team);
    } else {
        run_rank(k, 0);
    }
    for (int32_t r = 0; r < ranks; r++)
        if (k->error[r][0]) fail_msg("rank %d of %d: %s", (int)r, (int)ranks, k->error[r]);
    return k;
}

static void give_back(run *k)
{
    free(k->records);
    free(k);
}

static void test_scene(void **state)
{
    const scene *s = *state;
    run *alone = run_scene(s, 1);
    for (int32_t ranks = 2; ranks <= MOST; ranks += 2) {
        char text[TEXT];
        run *many = run_scene(s, ranks);
        for (int k = 0; k < s->steps; k++)
            if (!record_same(&alone->records[k], &many->records[k], text, sizeof text))
                fail_msg("%s on %d ranks, step %d: %s", s->name, (int)ranks, k + 1, text);
        for (int32_t r = 0; r < ranks; r++) {
            assert_true(many->device[r].launches > 100 * s->steps);
            assert_int_equal(many->device[r].rooms, 0);
        }
        give_back(many);
    }
    give_back(alone);
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
