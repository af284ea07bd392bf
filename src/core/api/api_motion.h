/* SPDX-License-Identifier: BSD-3-Clause */
/* Installation of a new motion of the tank. */
#ifndef MPS_CORE_API_MOTION_H
#define MPS_CORE_API_MOTION_H

#include "sim.h"

/* Refuse while leases are open. */
mps_status mps__sim_motion_free(mps_sim *sim);
/* Replace the motion; on failure the old one stays and `next` is released. */
mps_status mps__sim_motion_install(mps_sim *sim, mps__motion *next);

#endif
