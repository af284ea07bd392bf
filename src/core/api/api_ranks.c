/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of ranks. */
#include "collect.h"
#include "sim.h"

mps_status mps_sim_ranks_set(mps_sim *sim, const mps_ranks_ops *ops)
{
    MPS__SETS(sim);
    mps__world *w = &sim->world;
    if (w->ranks.ops.name)
        return mps__fail(&sim->context, MPS_E_STATE, "the handle has engine of ranks '%s' already",
                         w->ranks.ops.name);
    if (w->runner.memory.device.ops.name)
        return mps__fail(&sim->context, MPS_E_STATE,
                         "the handle runs on device '%s': call mps_sim_ranks_set() before "
                         "mps_sim_device_set()",
                         w->runner.memory.device.ops.name);
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

static mps_status no_leases(mps_sim *sim)
{
    const int32_t open = mps__particles_leases(&sim->world.particles);
    return open ? mps__fail(&sim->context, MPS_E_BUSY, "%d lease(s) are open; end them first", open)
                : MPS_OK;
}

mps_status mps_particles_collect(mps_sim *sim)
{
    MPS__READS(sim);
    mps__world *w = &sim->world;
    MPS__TRY(no_leases(sim));
    if (w->collected.begun)
        return mps__fail(&sim->context, MPS_E_STATE, "the particles are collected already");
    MPS__TRY(mps__ranks_report(&w->ranks, mps__collect_all(w)));
    w->collected.begun = true;
    return MPS_OK;
}

mps_status mps_particles_collect_end(mps_sim *sim)
{
    MPS__READS(sim);
    MPS__TRY(no_leases(sim));
    if (!sim->world.collected.begun)
        return mps__fail(&sim->context, MPS_E_STATE,
                         "the particles are not collected: call mps_particles_collect() first");
    mps__collect_end(&sim->world);
    return MPS_OK;
}
