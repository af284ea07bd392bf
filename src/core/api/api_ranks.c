/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of ranks. */
#include "sim.h"
#include "world_ranks.h"

mps_status mps_sim_ranks_set(mps_sim *sim, const mps_ranks_ops *ops)
{
    MPS__CHANGES(sim);
    mps__world *w = &sim->world;
    if (w->ranks.ops.name)
        return mps__fail(&sim->context, MPS_E_STATE, "the handle has engine of ranks '%s' already",
                         w->ranks.ops.name);
    if (w->particles.n > 0 || w->state.step > 0 || sim->solids > 0 || sim->probes.count > 0)
        return mps__fail(&sim->context, MPS_E_STATE,
                         "the handle has particles, solids, probes or steps already: call "
                         "mps_sim_ranks_set() first");
    return mps__world_ranks_set(w, ops);
}

mps_status mps_sim_ranks(const mps_sim *sim, int32_t *rank, int32_t *ranks)
{
    if (!sim) return MPS_E_ARG;
    if (rank) *rank = sim->world.ranks.rank;
    if (ranks) *ranks = sim->world.ranks.count;
    return MPS_OK;
}

mps_status mps_particles_ghosts(const mps_sim *sim, const uint8_t **ghost)
{
    MPS__READS(sim);
    MPS__CHECK(mps__sim_context(sim), ghost, "ghost is NULL");
    *ghost = sim->world.ghosts.ghost;
    return MPS_OK;
}
