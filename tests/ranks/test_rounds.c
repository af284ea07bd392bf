/* SPDX-License-Identifier: BSD-3-Clause */
/* Number of messages of a step: rounds and bytes against a table. Both are exact, because results
 * and partitions are. If a change needs fewer, enter the new numbers here; if it needs more, find
 * the reason first. */
#include "team.h"
#include "sim.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { FIRST = 4, STEPS = 16, MOST_RANKS = 4 };

/* Of STEPS steps after the first ones: rounds, and bytes that all ranks send. */
typedef struct count {
    const char *scene;
    int32_t ranks;
    int64_t rounds, bytes;
} count;

static const count table[] = {{"dam_2d", 2, 2856, 1945817},
                              {"dam_2d", 4, 2936, 4944215},
                              {"dam_3d", 2, 2741, 12239314},
                              {"roll_2d", 2, 2902, 1954327},
                              {"air_2d", 2, 2527, 3244112}};
enum { ROWS = sizeof table / sizeof table[0] };

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    int64_t rounds[MOST_RANKS], bytes[MOST_RANKS];
    mps_status status[MOST_RANKS];
} run;

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    int64_t rounds = 0, bytes = 0;
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    for (int s = 0; s < FIRST + STEPS && status >= 0; s++) {
        if (s == FIRST) {
            rounds = sim->world.ranks.rounds;
            bytes = sim->world.ranks.bytes;
        }
        status = mps_step(sim, 1, NULL);
    }
    k->status[rank] = status;
    if (status >= 0) {
        k->rounds[rank] = sim->world.ranks.rounds - rounds;
        k->bytes[rank] = sim->world.ranks.bytes - bytes;
    }
    mps_sim_destroy(sim);
}

static void test_row(void **state)
{
    const count *row = *state;
    run k = {.scene = scene_named(row->scene), .team = kit_engine_create(row->ranks, 0)};
    int64_t bytes = 0;
    kit_engine_run(k.team, run_rank, &k);
    kit_engine_destroy(k.team);
    for (int32_t r = 0; r < row->ranks; r++) {
        assert_true(k.status[r] >= 0);
        assert_int_equal(k.rounds[r], k.rounds[0]);
        bytes += k.bytes[r];
    }
    print_message("%s on %d ranks: %.1f rounds and %.0f kB a step\n", row->scene, (int)row->ranks,
                  (double)k.rounds[0] / STEPS, 1e-3 * (double)bytes / STEPS);
    if (k.rounds[0] != row->rounds || bytes != row->bytes)
        fail_msg("%s on %d ranks: %lld rounds and %lld bytes, not %lld and %lld", row->scene,
                 (int)row->ranks, (long long)k.rounds[0], (long long)bytes, (long long)row->rounds,
                 (long long)row->bytes);
}

int main(void)
{
    struct CMUnitTest tests[ROWS];
    for (int k = 0; k < ROWS; k++)
        tests[k] = (struct CMUnitTest){.name = table[k].scene,
                                       .test_func = test_row,
                                       .initial_state = (void *)(uintptr_t)&table[k]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
