/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on a lattice: choose points that are free, then append them all at once. */
#ifndef MPS_CORE_LATTICE_PLAN_H
#define MPS_CORE_LATTICE_PLAN_H

#include "geometry.h"
#include "packing.h"

/* States of points; the last two are occupied: by fluid, by a solid or its surroundings. */
enum { POINT_FREE = 0, POINT_CHOSEN = 1, POINT_FLUID = 2, POINT_SOLID = 3 };

/* Decision for one lattice point. */
typedef struct mps__lattice_site {
    int32_t kind, phase, part;
    double area[3];
} mps__lattice_site;

/* Data of one call: chosen points, their kinds, and the previous state. */
typedef struct mps__lattice_plan {
    mps_sim *sim;
    mps__lattice_box box;
    int32_t dim;
    unsigned char *state; /* POINT_... of every lattice point of the box, x fastest */
    bool (*choose)(const struct mps__lattice_plan *p, const int64_t k[3]);
    void (*describe)(const struct mps__lattice_plan *p, const int64_t k[3], mps__lattice_site *out);
    int64_t taken, chosen;
    /* of solids: the box whose ends are faces, and the part of each end */
    int64_t first[3], last[3];
    int32_t part[6]; /* x0 x1 y0 y1 z0 z1 */
    bool open_top, of_tank;
    /* of fluid */
    int32_t phase;
    mps_inside_fn inside;
    void *user;
    bool keeps;    /* keep the volume of a box beside solids of any shape; uses the next members */
    double wanted; /* volume as a number of points */
    mps__packing packing; /* beside solids of any shape */
} mps__lattice_plan;

void mps__lattice_plan_init(mps__lattice_plan *p, mps_sim *sim, const mps__lattice_box *box);
void mps__lattice_plan_free(mps__lattice_plan *p);
/* The next point of the box, x fastest; false after the last. */
bool mps__lattice_plan_next(const mps__lattice_plan *p, int64_t k[3]);
/* State of the point at distance `step` from k along an axis; walls of a tank are beyond the box of
 * a fill. */
int mps__lattice_plan_beside(const mps__lattice_plan *p, const int64_t k[3], int axis,
                             int64_t step);
/* Position of a lattice point, tank frame. */
void mps__lattice_point(const mps__lattice_plan *p, const int64_t k[3], double X[3]);
/* Whether liquid at a position of the tank frame would overlap a plate that is not on the
 * lattice. */
bool mps__plate_covers(const mps_sim *sim, const double *X);
/* Decide for every lattice point of the box; the particles are not changed. Call
 * mps__lattice_plan_free() afterwards in any case. */
mps_status mps__lattice_plan_choose(mps__lattice_plan *p);
/* Fraction of the cell of a point that is `least` spacings or more from solids of any shape; of the
 * cell only the lower part `height`, 0..1. More than 1 where the lattice ends before the solid. */
double mps__lattice_plan_fraction(const mps__lattice_plan *p, const int64_t k[3], double least,
                                  double height);
/* Whether fluid can be near a point: it is free, or covered by a solid of any shape that does not
 * fill its cell. */
bool mps__lattice_plan_open(const mps__lattice_plan *p, const int64_t k[3], int state);
/* Volume of the box lo..hi that is neither in a solid nor in other fluid [m^dim]. */
double mps__lattice_plan_liquid(const mps__lattice_plan *p, const double *lo, const double *hi);
/* Chosen volume [m^dim], and requested volume where it was free: the box lo..hi, or `inside` of a
 * fill. */
void mps__lattice_plan_volumes(const mps__lattice_plan *p, const double *lo, const double *hi,
                               double *built, double *asked);
/* Append the chosen points: all or none. */
mps_status mps__lattice_plan_build(mps__lattice_plan *p);

#endif
