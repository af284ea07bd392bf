/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on a lattice: choose points that are free, then append them all at once. */
#ifndef MPS_CORE_LATTICE_PLAN_H
#define MPS_CORE_LATTICE_PLAN_H

#include "geometry.h"
#include "packing.h"

/* Points; the last two are taken: by fluid, by a solid or beside its surface. */
enum { POINT_FREE = 0, POINT_CHOSEN = 1, POINT_FLUID = 2, POINT_SOLID = 3 };

/* What becomes of one lattice point. */
typedef struct mps__lattice_site {
    int32_t kind, phase, part;
    double area[3];
} mps__lattice_site;

/* One call's work: which points, what they become, and what was there before. */
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
    bool keeps;           /* the volume of a box, beside solids of any shape: */
    double wanted;        /* as many points */
    mps__packing packing; /* beside solids of any shape */
} mps__lattice_plan;

void mps__lattice_plan_init(mps__lattice_plan *p, mps_sim *sim, const mps__lattice_box *box);
void mps__lattice_plan_free(mps__lattice_plan *p);
/* The next point of the box, x fastest; false behind the last. */
bool mps__lattice_plan_next(const mps__lattice_plan *p, int64_t k[3]);
/* State of the point `step` beside k along an axis; walls of a tank are beyond the box of a fill. */
int mps__lattice_plan_beside(const mps__lattice_plan *p, const int64_t k[3], int axis,
                             int64_t step);
/* Place of a lattice point, tank's frame. */
void mps__lattice_point(const mps__lattice_plan *p, const int64_t k[3], double X[3]);
/* Whether liquid at a place of the tank's frame would press against a plate which is not on the lattice. */
bool mps__plate_covers(const mps_sim *sim, const double *X);
/* Decide for every lattice point of the box; the store is not touched. mps__lattice_plan_free() afterwards in any case. */
mps_status mps__lattice_plan_choose(mps__lattice_plan *p);
/* Share of the cell of a point that is `least` spacings or more from solids of any shape; of the cell only the lower part `height`, 0..1. More
 * than 1 where the lattice ends before the solid. */
double mps__lattice_plan_share(const mps__lattice_plan *p, const int64_t k[3], double least,
                               double height);
/* Whether fluid can be near a point: it is free, or covered by a solid of any shape that does not fill its cell. */
bool mps__lattice_plan_open(const mps__lattice_plan *p, const int64_t k[3], int state);
/* Volume of the box lo..hi that is neither in a solid nor in other fluid [m^dim]. */
double mps__lattice_plan_liquid(const mps__lattice_plan *p, const double *lo, const double *hi);
/* Volume that was chosen [m^dim], and that was asked for where it was free: the box lo..hi, or `inside` of a fill. */
void mps__lattice_plan_volumes(const mps__lattice_plan *p, const double *lo, const double *hi,
                               double *built, double *asked);
/* Append what was chosen: all or nothing. */
mps_status mps__lattice_plan_build(mps__lattice_plan *p);

#endif
