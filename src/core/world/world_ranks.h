/* SPDX-License-Identifier: BSD-3-Clause */
/* What ranks do together before a step: divide the particles, and agree on what is to be done. Alone these calls change nothing. */
#ifndef MPS_CORE_WORLD_RANKS_H
#define MPS_CORE_WORLD_RANKS_H

#include "world.h"

/* Run on the ranks of an engine, before there is anything. */
mps_status mps__world_ranks_set(mps__world *w, const mps_ranks_ops *ops);
/* Keep the own ones of the particles that all ranks added alike. */
mps_status mps__world_adopt(mps__world *w);
/* Other particles, which all ranks have alike. `listed`: places of a search will follow. On failure nothing changed. */
mps_status mps__world_replace(mps__world *w, int64_t n, const void *const from[], bool listed);
/* On many ranks lists.listed_at goes into the field that mps__world_replace() made, so that it travels with the particles. */
void mps__world_keep_listed(mps__world *w);
/* Lists of the particles at these places, as lists.listed_at has them on one rank. */
mps_status mps__world_list_again(mps__world *w, mps_status (*search)(mps__world *w));
/* A step took so long on this rank; sometimes ranks compare, and cut space anew. */
void mps__world_balance(mps__world *w, double seconds);
/* Work that particle i makes, as far as is known. */
float mps__world_weight(const void *world, int64_t i);
/* Whether on many ranks models or the solver look farther than ghosts reach, or at rows that ghosts lack. */
bool mps__world_wants_ghosts(const mps__world *w);
/* Whether something is so on any rank, for each of `count` things, at most 16. */
void mps__world_any(mps__world *w, int32_t count, bool *things);
/* Send particles to their owners and renew the ghosts; order particles as a search wants them. */
mps_status mps__world_divide(mps__world *w);
/* Dummies that are ghosts learn their walls, and walls that are ghosts their areas. */
mps_status mps__world_link_ghosts(mps__world *w);
/* Places of dummies' walls from their ids. */
mps_status mps__world_find_walls(mps__world *w);
mps_status mps__world_share_areas(mps__world *w);
/* At the end of a step: ghosts get the places of their owners and all fields that have changed. */
mps_status mps__world_share_step(mps__world *w);
/* Ghosts get all fields that the user may have written. */
mps_status mps__world_share_written(mps__world *w);
/* Particles that something was found about: how many, and the one with the least id. */
typedef struct mps__found {
    int64_t count, id; /* id: INT64_MAX without any */
    double x[3];
} mps__found;
/* The same of all ranks. */
void mps__world_find(mps__world *w, mps__found *found);

#endif
