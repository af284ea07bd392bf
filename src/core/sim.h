/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 8: the handle. */
#ifndef MPS_CORE_SIM_H
#define MPS_CORE_SIM_H

#include "contour.h"
#include "probes.h"
#include "world.h"
#include <mps/sim.h>

struct mps_sim {
    mps__context context;
    mps__world world;
    mps__probes probes;
    bool in_monitor; /* the handle must not step, add or remove */
    /* the lattice of the last tank, or of all solids */
    bool has_tank;
    bool lattice_of_solids;
    double lattice_lo[3];
    int64_t lattice_cells[3];
    /* where the solids are */
    int32_t solids;
    int64_t solid_capacity;
    mps__distances *solid;
};

/* The handle's context is part of its private state: error text may change through a const handle. */
static inline mps__context *mps__sim_context(const mps_sim *sim)
{
    return (mps__context *)&sim->context;
}

#endif
