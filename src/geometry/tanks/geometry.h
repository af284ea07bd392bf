/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on the lattice of a tank. Arguments are checked by the public functions, see api_geometry.c. */
#ifndef MPS_CORE_GEOMETRY_H
#define MPS_CORE_GEOMETRY_H

#include "sim.h"
#include <mps/geometry.h>

/* Lattice points first..last (both included) of the lattice lo + k h, in the tank's frame. */
typedef struct mps__lattice_box {
    double lo[3], h[3];
    int64_t first[3], last[3];
    /* > 0: of the first and the last layer across an axis a fill takes this share of the points,
     * evenly spread; 0: all of them */
    double share[3][2];
} mps__lattice_box;

/* A thin plate: nodes on a rectangle (in 2-D a line), one to three columns of them side by side. */
typedef struct mps__plate_shape {
    double corner[3], normal[3], along[2][3]; /* tank's frame; the last three are unit vectors */
    double spacing[2], across;                /* along the edges, between columns */
    int64_t nodes[2];                         /* along the edges; the second is 1 in 2-D */
    int32_t columns;
    int32_t axis; /* of the normal on the tank's lattice, -1: the plate does not stand on it */
} mps__plate_shape;

/* Whether particles may be added now, and whether solids may. */
mps_status mps__fill_allowed(mps_sim *sim);
mps_status mps__solids_allowed(mps_sim *sim);
/* Lattice points must differ in their coordinates; `what` is what is at fault in the refusal, e.g. "tank.lo". */
mps_status mps__place_resolved(mps_sim *sim, const char *what, int d, double place);
/* The refusal of a solid that would stand on fluid particle i, which is at X in the tank's frame; `what` is e.g. "baffle". */
mps_status mps__in_the_way(mps_sim *sim, int64_t i, const double *X, const char *what,
                           const char *name);
/* Lattice points of the closed box lo..hi that lie in the last tank; false if there is none. */
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
/* True if a box is thin and has liquid on both sides, or may have; then its shape. */
bool mps__plate_of_box(mps_sim *sim, const mps__lattice_box *box, mps__plate_shape *shape);
mps_status mps__geometry_plate(mps_sim *sim, const char *name, const mps__plate_shape *shape);
/* Warn of slots that no liquid fits in, once for all solids that are there. */
mps_status mps__slots_tell(mps_sim *sim);
/* What is filled: the corners that were asked for [dim], or `inside`; whether the volume of the
 * corners is kept beside solids of any shape. */
typedef struct mps__fill {
    int32_t phase;
    bool keeps;
    const double *lo, *hi;
    mps_inside_fn inside;
    void *user;
} mps__fill;

/* Fill points of the box. box->share becomes what was taken. */
mps_status mps__geometry_fill(mps_sim *sim, const mps__fill *fill, mps__lattice_box *box,
                              int64_t *added);

#endif
