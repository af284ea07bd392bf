/* SPDX-License-Identifier: BSD-3-Clause */
/* Load balancing: space is repartitioned when one rank works longer than the others. Results do not
 * depend on the partition, so it may depend on the clock. */
#include "world_ranks.h"
#include <math.h>

/* Steps between comparisons; largest work over the mean that is tolerated. */
enum { STEPS = 50 };
static const double UNEVEN = 1.05;
/* Limits of the measured cost: a rank that other programs interrupt looks slower than it is. */
static const double cost_least = 0.2, cost_most = 5;

/* Work of a particle relative to fluid: solids without fluid in reach have no rows, walls with
 * fluid no gradients. */
static double load_of(const mps__particles *s, int64_t i)
{
    if (s->kind[i] == MPS_FLUID) return 1;
    return s->kind[i] == MPS_WALL && s->region[i] != MPS_REGION_DRY ? 0.5 : 0.05;
}

float mps__world_weight(const void *world, int64_t i)
{
    const mps__world *w = world;
    return (float)(w->balance.cost * load_of(&w->particles, i));
}

/* Compare the work of the ranks and their cost for a unit of load: the next partition gives less to
 * slower ranks. */
static void compare(mps__world *w)
{
    enum { WORK, LOAD, VALUES };
    mps__balance *b = &w->balance;
    double own[VALUES] = {b->work, 0}, most = b->work, mean[VALUES];
    mps_exact sum[VALUES] = {{{0}, 0, 0}};
    const mps__ghosts *g = &w->ghosts;
    for (int64_t i = mps__own_from(g, 0); i < w->particles.n; i = mps__own_from(g, i + 1))
        own[LOAD] += load_of(&w->particles, i);
    for (int k = 0; k < VALUES; k++) mps_exact_add(&sum[k], 1, &own[k]);
    mps__ranks_max(&w->ranks, 1, &most);
    mps__ranks_sum(&w->ranks, VALUES, sum);
    for (int k = 0; k < VALUES; k++) mean[k] = mps_exact_value(&sum[k]) / w->ranks.count;
    if (!(most > UNEVEN * mean[WORK])) return;
    w->ghosts.recut = true;
    b->cost = 1;
    if (own[LOAD] > 0 && own[WORK] > 0)
        b->cost = fmin(fmax(own[WORK] / own[LOAD] * (mean[LOAD] / mean[WORK]), cost_least),
                       cost_most);
}

void mps__world_balance(mps__world *w, double seconds)
{
    mps__balance *b = &w->balance;
    if (!mps__ranks_many(&w->ranks)) return;
    b->work += seconds - (w->ranks.seconds - b->waited);
    /* the first partition did not know the dry walls */
    if (w->state.step == 1) w->ghosts.recut = true;
    if (++b->steps < STEPS) return;
    compare(w);
    b->work = 0;
    b->steps = 0;
}
