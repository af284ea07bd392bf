/* SPDX-License-Identifier: BSD-3-Clause */
/* Collective operations before a step: partition the particles, and agree on what to do. On a
 * single rank these calls do nothing. */
#ifndef MPS_CORE_WORLD_RANKS_H
#define MPS_CORE_WORLD_RANKS_H

#include "world.h"

/* Run on the ranks of an engine, before particles are added. */
mps_status mps__world_ranks_set(mps__world *w, const mps_ranks_ops *ops);
/* Keep the owned ones of the particles that all ranks have added in the same way. */
mps_status mps__world_adopt(mps__world *w);
/* Replace the particles by others, which are the same on all ranks. `listed`: positions of a search
 * will follow. Unchanged on failure. */
mps_status mps__world_replace(mps__world *w, int64_t n, const void *const from[], bool listed);
/* On many ranks move lists.listed_at into the field that mps__world_replace() made, so that it
 * migrates with the particles. */
void mps__world_keep_listed(mps__world *w);
/* Lists of the particles at the positions of lists.listed_at, as on a single rank. */
mps_status mps__world_list_again(mps__world *w, mps_status (*search)(mps__world *w));
/* Account for the time of a step on this rank; regularly compare the ranks, and request a new
 * partition. */
void mps__world_balance(mps__world *w, double seconds);
/* Computational work of particle i, as far as it is known. */
float mps__world_weight(const void *world, int64_t i);
/* Whether on many ranks models or the solver need a larger reach than that of the ghosts, or rows
 * that ghosts lack. */
bool mps__world_wants_ghosts(const mps__world *w);
/* Logical or over all ranks, for each of `count` flags, at most 16. */
void mps__world_any(mps__world *w, int32_t count, bool *things);
/* Migrate particles to their owners, renew the ghosts, and sort the particles for a search. */
mps_status mps__world_divide(mps__world *w);
/* Set the walls of dummies that are ghosts, and the areas of walls that are ghosts. */
mps_status mps__world_link_ghosts(mps__world *w);
/* Indices of dummies' walls from their ids. */
mps_status mps__world_find_walls(mps__world *w);
mps_status mps__world_exchange_areas(mps__world *w);
/* Halo exchange at the end of a step: positions and all changed fields. */
mps_status mps__world_exchange_step(mps__world *w);
/* Halo exchange of all fields that the user may have written. */
mps_status mps__world_exchange_written(mps__world *w);
/* Particles with a property: their number, and the one with the least id. */
typedef struct mps__found {
    int64_t count, id; /* id: INT64_MAX without any */
    double x[3];
} mps__found;
/* Combine those of all ranks. */
void mps__world_find(mps__world *w, mps__found *found);

#endif
