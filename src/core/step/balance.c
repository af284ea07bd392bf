/* SPDX-License-Identifier: BSD-3-Clause */
/* Even work on all ranks: space is cut anew when one of them works longer than the others. Results do not depend on cuts, so these may follow
 * the clock. */
#include "world_ranks.h"

/* Steps whose work is compared, and the largest work over the mean that is left as it is. */
enum { STEPS = 50 };
static const double UNEVEN = 1.15;

void mps__world_balance(mps__world *w, double seconds)
{
    mps__balance *b = &w->balance;
    if (!mps__ranks_many(&w->ranks)) return;
    b->work += seconds - (w->ranks.seconds - b->waited);
    b->waited = w->ranks.seconds;
    if (++b->steps < STEPS) return;
    double most = b->work;
    mps_exact sum = {{0}, 0, 0};
    mps_exact_add(&sum, 1, &b->work);
    mps__ranks_max(&w->ranks, 1, &most);
    mps__ranks_sum(&w->ranks, 1, &sum);
    const double uneven = most * w->ranks.count / mps_exact_value(&sum);
    w->ghosts.recut = w->ghosts.recut || uneven > UNEVEN;
    b->work = 0;
    b->steps = 0;
}
