/* SPDX-License-Identifier: BSD-3-Clause */
/* Collecting the particles of all ranks on one rank, or the solids on all: for output, and for
 * functions that need a whole face. */
#ifndef MPS_CORE_COLLECT_H
#define MPS_CORE_COLLECT_H

#include "world_ranks.h"

/* Collect all particles on rank 0, in the order that they would have on a single rank;
 * lists.listed_at has the positions of the last search, if its candidates are still valid. The
 * stores of other ranks are empty then. Only reading is allowed until mps__collect_end(). On a
 * single rank, and before the particles are partitioned, the store is unchanged. */
mps_status mps__collect_all(mps__world *w);
/* Collect all solids on all ranks, by ascending id. */
mps_status mps__collect_solids(mps__world *w);
/* Restore the store. */
void mps__collect_end(mps__world *w);

/* Whether the particles are partitioned. */
static inline bool mps__world_divided(const mps__world *w)
{
    return w->ghosts.divided;
}

#endif
