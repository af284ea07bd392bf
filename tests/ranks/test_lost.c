/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles behind a wall are lost once, also at a boundary between ranks: ghosts are not
 * counted. */
#include "team.h"
#include "sim.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 7, TEXT = 300, STEPS = 5, SPILL_STEP = 2 };

typedef struct run {
    const scene *scene;
    kit_engine_team *team; /* NULL: one rank */
    record *records;       /* [STEPS] */
    int64_t lost[MOST];
    char error[MOST][TEXT];
} run;

/* Fluid on the floor moves below it, in front of its dummies. */
static mps_status spill(const run *k, mps_sim *sim)
{
    const double dp = k->scene->dp;
    const mps__world *w = &sim->world;
    mps_lease x = {.struct_size = sizeof x};
    MPS__TRY(mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t i = 0; i < x.count; i++) {
        double *at = x.data + i * x.stride;
        const bool floor = w->particles.kind[i] == MPS_FLUID && at[1] > 0 && at[1] < 1.4 * dp;
        if (floor && at[0] > 4 * dp && at[0] < 0.5 && mps__own_place(&w->ghosts, i) == i)
            at[1] = -0.7 * dp;
    }
    return mps_lease_end(sim, &x);
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    for (int s = 0; s < STEPS && status >= 0; s++) {
        if (s == SPILL_STEP) status = spill(k, sim);
        if (status >= 0) status = mps_step(sim, 1e-5, &info);
        if (status >= 0) record_note(sim, &info, &k->records[s]);
    }
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    k->lost[rank] = info.lost;
    mps_sim_destroy(sim);
}

static run run_scene(const scene *s, int32_t ranks)
{
    run k = {.scene = s, .records = calloc(STEPS, sizeof(record))};
    assert_non_null(k.records);
    if (ranks > 1) k.team = kit_engine_create(ranks, 0);
    if (k.team)
        kit_engine_run(k.team, run_rank, &k);
    else
        run_rank(&k, 0);
    for (int32_t r = 0; r < ranks; r++)
        if (k.error[r][0])
            fail_msg("%s, rank %d of %d: %s", s->name, (int)r, (int)ranks, k.error[r]);
    if (k.team) kit_engine_destroy(k.team);
    return k;
}

static void lost_once(void **state)
{
    char text[TEXT];
    (void)state;
    for (int c = 0; c < SCENES; c++) {
        const scene *s = &scenes[c];
        if (strcmp(s->name, "dam_2d") != 0 && strcmp(s->name, "air_2d") != 0) continue;
        run alone = run_scene(s, 1);
        assert_true(alone.lost[0] > 4);
        for (int32_t ranks = 2; ranks <= MOST; ranks++) {
            run many = run_scene(s, ranks);
            for (int32_t r = 0; r < ranks; r++)
                if (many.lost[r] != alone.lost[0])
                    fail_msg("%s on %d ranks: %lld particles lost, not %lld", s->name, (int)ranks,
                             (long long)many.lost[r], (long long)alone.lost[0]);
            for (int k = 0; k < STEPS; k++)
                if (!record_same(&alone.records[k], &many.records[k], text, sizeof text))
                    fail_msg("%s on %d ranks, step %d: %s", s->name, (int)ranks, k, text);
            free(many.records);
        }
        free(alone.records);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lost_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
