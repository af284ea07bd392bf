/* SPDX-License-Identifier: BSD-3-Clause */
/* Public function of mps/output.h that takes a handle. */
#include "frames.h"
#include "sim.h"

mps_status mps_frames_open(mps_sim *sim, const char *folder, const char *name, int32_t kinds,
                           mps_frames **frames)
{
    MPS__READS(sim);
    MPS__CHECK(&sim->context, frames, "frames is NULL");
    return mps__frames_open(&sim->world, folder, name, kinds, frames);
}
