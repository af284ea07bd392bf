/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on the lattice of a tank. The public functions check arguments: api_geometry.c. */
#ifndef MPS_CORE_GEOMETRY_H
#define MPS_CORE_GEOMETRY_H

#include "sim.h"
#include <mps/geometry.h>

/* Lattice points first..last (both included) of the lattice lo + k h, in the tank frame. */
typedef struct mps__lattice_box {
    double lo[3], h[3];
    int64_t first[3], last[3];
    /* > 0: a fill uses this fraction of the points of the first and the last layer across an axis,
     * evenly spread; 0: all of them */
    double share[3][2];
} mps__lattice_box;

/* A thin plate: nodes on a rectangle (in 2-D a line), in one to three adjacent columns. */
typedef struct mps__plate_shape {
    double corner[3], normal[3], along[2][3]; /* tank frame; normal and along are unit vectors */
    double spacing[2], across;                /* along the edges, between columns */
    int64_t nodes[2];                         /* along the edges; the second is 1 in 2-D */
    int32_t columns;
    int32_t axis; /* of the normal on the tank's lattice, -1: the plate is not on it */
} mps__plate_shape;

/* Whether particles may be added now; whether solids may. */
mps_status mps__fill_allowed(mps_sim *sim);
mps_status mps__solids_allowed(mps_sim *sim);
/* Lattice points must have different coordinates; `what` names the argument in the error text, e.g.
 * "tank.lo". */
mps_status mps__place_resolved(mps_sim *sim, const char *what, int d, double place);
/* Error of a solid that would cover fluid particle i, at X in the tank frame; `what` is e.g.
 * "baffle". */
mps_status mps__in_the_way(mps_sim *sim, int64_t i, const double *X, const char *what,
                           const char *name);
/* Lattice points of the closed box lo..hi within the last tank; false: none. */
bool mps__lattice_clip(const mps_sim *sim, const double *lo, const double *hi,
                       mps__lattice_box *box);
/* The lattice of a tank: cells along each axis, their edges, and the spacing of a square cell of
 * the same volume. */
typedef struct mps__tank_lattice {
    int64_t cells[3];
    double h[3], dp;
} mps__tank_lattice;
mps_status mps__geometry_tank(mps_sim *sim, const mps_tank *tank, const mps__tank_lattice *lattice);
mps_status mps__geometry_baffle(mps_sim *sim, const char *name, const mps__lattice_box *box);
/* Whether a box is thin and has, or may have, liquid on both sides; then its shape. */
bool mps__plate_of_box(mps_sim *sim, const mps__lattice_box *box, mps__plate_shape *shape);
mps_status mps__geometry_plate(mps_sim *sim, const char *name, const mps__plate_shape *shape);
/* Log a warning about slots too narrow for liquid, once for all existing solids. */
mps_status mps__slots_log(mps_sim *sim);
/* Region to fill: the requested corners [dim], or `inside`; whether the volume of the corners is
 * kept beside solids of any shape. */
typedef struct mps__fill {
    int32_t phase;
    bool keeps;
    const double *lo, *hi;
    mps_inside_fn inside;
    void *user;
} mps__fill;

/* Fill points of the box. box->share: out, fraction used. */
mps_status mps__geometry_fill(mps_sim *sim, const mps__fill *fill, mps__lattice_box *box,
                              int64_t *added);

#endif
