/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of devices. */
#include "sim.h"
#include <mps/device.h>

/* Collective calls have the same order on all ranks only if all have a device, or none. */
static mps_status all_alike(mps_sim *sim, bool device)
{
    mps__ranks *r = &sim->world.ranks;
    double most[2] = {device, !device};
    if (!mps__ranks_many(r)) return MPS_OK;
    mps__ranks_max(r, 2, most);
    MPS__TRY(mps__ranks_status(r));
    return most[0] > 0 && most[1] > 0
               ? mps__fail(&sim->context, MPS_E_ARG,
                           "some of the %d ranks set a device, others none: must be all or none",
                           (int)r->count)
               : MPS_OK;
}

mps_status mps_sim_device_set(mps_sim *sim, const mps_device_ops *ops)
{
    MPS__CHANGES(sim);
    mps__world *w = &sim->world;
    const int32_t open = mps__particles_leases(&w->particles);
    if (open)
        return mps__fail(&sim->context, MPS_E_BUSY, "%d lease(s) are open; end them first", open);
    MPS__TRY(all_alike(sim, ops != NULL));
    /* a new search does not need the last one */
    if (mps__world_fetch_lists(w) < 0) w->lists.neighbours.valid = false;
    mps__solvers_release_device(&w->solvers, &w->runner.memory.device);
    mps__ppe_release_device(&w->ppe, &w->runner.memory.device);
    mps__ghosts_release_device(&w->ghosts);
    const mps_status status = mps__ranks_agree(&w->ranks,
                                               mps__memory_attach(&w->runner.memory, ops));
    if (status < 0 && mps__ranks_many(&w->ranks)) mps__memory_attach(&w->runner.memory, NULL);
    return status;
}

mps_status mps_device_info_init(mps_device_info *info, size_t size)
{
    static const mps_device_info none = {.struct_size = sizeof none};
    return mps__struct_init("mps_device_info", info, size, &none, sizeof none);
}

mps_status mps_sim_device_info(const mps_sim *sim, mps_device_info *info)
{
    MPS__READS(sim);
    return mps__struct_out(mps__sim_context(sim), "mps_device_info", info,
                           &sim->world.runner.memory.last, sizeof *info);
}
