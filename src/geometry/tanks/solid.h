/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of any shape in a simulation. The public functions check arguments: api_solid.c. */
#ifndef MPS_CORE_SOLID_H
#define MPS_CORE_SOLID_H

#include "sim.h"
#include <mps/geometry.h>

/* One solid to add: its shape and its search box. */
typedef struct mps__solid {
    const char *name;
    int32_t layers; /* of dummies */
    mps__shape shape;
    double lo[3], hi[3];
    int32_t open; /* MPS_SIDE_...: the side of that box where it has no walls */
} mps__solid;

mps_status mps__solid_add(mps_sim *sim, const mps__solid *solid);
/* Whether a position of the tank frame is in a solid or nearer than dp/2 to one. If solids alone
 * define the lattice, positions outside of their boxes count as well. */
bool mps__solid_covers(const mps_sim *sim, const double *X);
/* Distance to the nearest solid of any shape [m]: < 0 inside, INFINITY far from all, -INFINITY
 * outside of a lattice defined by solids. */
double mps__solid_clearance(const mps_sim *sim, const double *X);

#endif
