/* SPDX-License-Identifier: BSD-3-Clause */
/* Load balance: when space is repartitioned, and the weights of particles of a slow rank. */
#include "kit_engine.h"
#include "scenes.h"
#include "sim.h"
#include "world_ranks.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

enum { RANKS = 2, STEPS = 50, SEEN = 4 };

typedef struct run {
    kit_engine_team *team;
    double seconds[RANKS]; /* of a step */
    double waited[RANKS];  /* outside of steps */
    bool first, recut[RANKS];
    double cost[RANKS], load[RANKS];
    char error[RANKS][300];
} run;

static double load_of(const mps__world *w)
{
    double load = 0;
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < w->particles.n;
         i = mps__own_from(&w->ghosts, i + 1))
        load += mps__world_weight(w, i);
    return load;
}

/* Two real steps, then as many as are compared with given seconds only. */
static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    const mps_ranks_ops ops = kit_engine_ops(k->team, rank);
    mps_status status = scene_create(&scenes[0], &sim);
    if (status == MPS_OK) status = mps_sim_ranks_set(sim, &ops);
    if (status == MPS_OK) status = scene_build(sim, &scenes[0]);
    if (status == MPS_OK) status = mps_step(sim, 1, NULL);
    mps__world *w = &sim->world;
    if (rank == 0) k->first = w->ghosts.recut;
    if (status == MPS_OK) status = mps_step(sim, 1, NULL);
    if (status < 0) snprintf(k->error[rank], sizeof k->error[rank], "%s", mps_sim_error(sim));
    w->ghosts.recut = false;
    w->balance.steps = 0;
    w->balance.work = 0;
    k->load[rank] = load_of(w);
    for (int s = 0; s < STEPS && status >= 0; s++) {
        w->ranks.seconds += k->waited[rank];
        w->balance.waited = w->ranks.seconds; /* as a step begins */
        mps__world_balance(w, k->seconds[rank]);
    }
    k->recut[rank] = w->ghosts.recut;
    k->cost[rank] = w->balance.cost;
    mps_sim_destroy(sim);
}

static run take(double first, double second, double waited)
{
    run k = {
        .seconds = {first, second}, .waited = {0, waited}, .team = kit_engine_create(RANKS, 0)};
    assert_non_null(k.team);
    kit_engine_run(k.team, run_rank, &k);
    kit_engine_destroy(k.team);
    for (int r = 0; r < RANKS; r++)
        if (k.error[r][0]) fail_msg("rank %d: %s", r, k.error[r]);
    assert_true(k.recut[0] == k.recut[1]);
    return k;
}

static void first_step(void **state)
{
    (void)state;
    assert_true(take(1, 1, 0).first);
}

static void even_work_stays(void **state)
{
    (void)state;
    assert_false(take(1, 1, 0).recut[0]);
    assert_false(take(1.04, 0.96, 0).recut[0]);
    assert_false(take(1, 1, 100).recut[0]); /* waiting between steps is no work */
}

/* Cost: seconds for a unit of load, over the mean of the ranks. */
static void slow_ranks_get_less(void **state)
{
    (void)state;
    const run k = take(1, 3, 0);
    assert_true(k.recut[0]);
    const double mean = (k.load[0] + k.load[1]) / (1 + 3);
    assert_true(fabs(k.cost[0] - 1 / k.load[0] * mean) < 1e-6 * k.cost[0]);
    assert_true(fabs(k.cost[1] - 3 / k.load[1] * mean) < 1e-6 * k.cost[1]);
    assert_true(k.cost[1] > 1 && k.cost[0] < 1);
    assert_true(take(1e-3, 1e3, 0).cost[0] == 0.2); /* limited */
    assert_true(take(0, 1, 0).cost[0] == 1);        /* no work, no information */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(first_step),
                                       cmocka_unit_test(even_work_stays),
                                       cmocka_unit_test(slow_ranks_get_less)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
