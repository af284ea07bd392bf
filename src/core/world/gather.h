/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles of all ranks in the store of one rank, or the solids in those of all: for output, and for what looks at a whole face. */
#ifndef MPS_CORE_GATHER_H
#define MPS_CORE_GATHER_H

#include "world_ranks.h"

/* Put all particles into the store of rank 0, in the order that they would have on one rank; lists.listed_at has the positions of the last
 * search, if its candidates still hold. The stores of other ranks are empty then. Nothing but reading is allowed until mps__gather_end(). On one
 * rank, and before ranks have divided the particles, the store is left as it is. */
mps_status mps__gather_all(mps__world *w);
/* Put all solids into the stores of all ranks, by ascending id. */
mps_status mps__gather_solids(mps__world *w);
/* The store as it was. */
void mps__gather_end(mps__world *w);

/* Whether ranks have divided the particles. */
static inline bool mps__world_divided(const mps__world *w)
{
    return w->ghosts.divided;
}

#endif
