/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints of any number of ranks are the same file, and are resumed with any other number with
 * the same bytes. */
#include "team.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { TEXT = 300, BEFORE = 17, AFTER = 12 };

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    const char *from,
        *to; /* checkpoints that are read before and written after the steps; NULL: none */
    int steps;
    record *last; /* of the last step */
    char error[64][TEXT];
} run;

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    if (status == MPS_OK && k->from) status = mps_checkpoint_read(sim, k->from);
    for (int s = 0; s < k->steps && status >= 0; s++) status = mps_step(sim, 1, &info);
    if (status >= 0) record_note(sim, &info, k->last);
    if (status >= 0 && k->to) status = mps_checkpoint_write(sim, k->to);
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* Take steps on so many ranks. @return what the last one left; for free() */
static record *take(const scene *s, int32_t ranks, int steps, const char *from, const char *to)
{
    run k = {.scene = s,
             .from = from,
             .to = to,
             .steps = steps,
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
    return k.last;
}

static void same_files(const char *a, const char *b, int32_t ranks)
{
    FILE *f = fopen(a, "rb"), *g = fopen(b, "rb");
    long at = 0;
    int x, y;
    assert_non_null(f);
    assert_non_null(g);
    do {
        x = fgetc(f);
        y = fgetc(g);
        if (x != y) fail_msg("checkpoint of %d ranks: byte %ld is another one", (int)ranks, at);
        at++;
    } while (x != EOF);
    fclose(f);
    fclose(g);
}

static void check(const scene *s)
{
    static const int32_t ranks[] = {2, 3, 7}, later[] = {4, 1, 2};
    char one[100], many[100], text[TEXT], end[2][100];
    snprintf(one, sizeof one, "ranks_%s_1.chk", s->name);
    snprintf(end[0], sizeof end[0], "ranks_%s_end.chk", s->name);
    snprintf(end[1], sizeof end[1], "ranks_%s_ends.chk", s->name);
    free(take(s, 1, BEFORE, NULL, one));
    record *whole = take(s, 1, BEFORE + AFTER, NULL, end[0]);
    for (int k = 0; k < 3; k++) {
        if (!scene_runs(s, k, 3)) continue;
        snprintf(many, sizeof many, "ranks_%s_%d.chk", s->name, (int)ranks[k]);
        free(take(s, ranks[k], BEFORE, NULL, many));
        same_files(one, many, ranks[k]);
        record *resumed = take(s, later[k], AFTER, many, end[1]);
        if (!record_same(whole, resumed, text, sizeof text))
            fail_msg("%s: %d ranks after %d: %s", s->name, (int)later[k], (int)ranks[k], text);
        same_files(end[0], end[1], later[k]);
        free(resumed);
        remove(many);
    }
    remove(one);
    remove(end[0]);
    remove(end[1]);
    free(whole);
}

static void test_scene(void **state)
{
    check(*state);
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
