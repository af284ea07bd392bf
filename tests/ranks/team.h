/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes on the ranks of a team, which are threads of this program. */
#ifndef RANKS_TEAM_H
#define RANKS_TEAM_H

#include "../every.h"
#include "kit_engine.h"
#include "scenes.h"
#include <string.h>

/* @return the scene of a name; NULL: no such scene */
static inline const scene *scene_named(const char *name)
{
    for (int k = 0; k < SCENES; k++)
        if (strcmp(scenes[k].name, name) == 0) return &scenes[k];
    return NULL;
}

/* Whether a scene runs in this one of several variants, e.g. numbers of ranks: in all of them,
 * under sanitizers in one. The scenes together then cover all variants. */
static inline bool scene_runs(const scene *s, int way, int ways)
{
    return has_turn(s - scenes, ways - way, ways);
}

/* A scene that is built and has not stepped, on a rank of a team; `team` NULL: alone. */
static inline mps_status scene_start(const scene *s, kit_engine_team *team, int32_t rank,
                                     mps_sim **sim)
{
    mps_status status = scene_create(s, sim);
    if (status == MPS_OK && team) {
        const mps_ranks_ops ops = kit_engine_ops(team, rank);
        status = mps_sim_ranks_set(*sim, &ops);
    }
    return status == MPS_OK ? scene_build(*sim, s) : status;
}

#endif
