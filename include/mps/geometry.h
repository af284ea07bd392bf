/* SPDX-License-Identifier: BSD-3-Clause */
/** @file geometry.h  Tanks, baffles and fluid fills on the papers' lattice.
 *
 *  Lattice points are lo + k dp. The wall layer lies ON the tank's wall, the first fluid particle one dp inside, dummy
 *  layers one and two dp behind the wall. 2-D: 199 x 62 fluid and 1974 boundary particles for Z14's surge tank.
 *  Places are in the tank's frame; particles go where its pose at present puts them. */
#ifndef MPS_GEOMETRY_H
#define MPS_GEOMETRY_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A rectangular tank. Faces are parts named "<name>.x0", ".x1", ".y0", ".y1", ".z0", ".z1" (edges belong to the
 *  first face in the order y0, y1, x0, x1, z0, z1; a force probe counts them with each face they touch). "Up" is y in 2-D and 3-D. */
typedef struct mps_tank {
    uint32_t struct_size; /**< set by mps_tank_init() */
    const char *name;     /**< default "tank" */
    double lo[3];         /**< lower corner [m] */
    double size[3];       /**< inner size [m]; rounded to whole spacings, at least 3 dp */
    int32_t open_top;     /**< 1: no wall at the upper y end; the side walls end there */
    int32_t dummy_layers; /**< default 2 */
} mps_tank;

/** Defaults. */
MPS_API mps_status mps_tank_init(mps_tank *tank, size_t size);

/** Add the walls of a tank; its lattice is the one fills use from now on.
 *  @param built  NULL, or [3] out: the size built [m] after rounding to the lattice (a rounding is logged) */
MPS_API mps_status mps_geometry_tank(mps_sim *sim, const mps_tank *tank, double *built);

/** Add a solid box (a baffle): lattice points of the closed box lo..hi, its outer layer walls, what lies inside dummies.
 *  Must follow mps_geometry_tank() and come before the fill; points taken by other particles are left out, so that the
 *  walls a baffle stands on stay. A box thinner than dp is one column of walls whose two faces cancel (net area 0: no force).
 *  Give a baffle with liquid on both sides at least 2 dp (three layers): through a thinner one the sides feel each other; a warning is
 *  logged.
 *  @param name  part name @param lo,hi [dim] corners [m]
 *  @return MPS_E_ARG if no lattice point lies inside */
MPS_API mps_status mps_geometry_baffle(mps_sim *sim, const char *name, const double *lo, const double *hi);

/** Fill a box with fluid of a phase: free lattice points of the closed box.
 *  @param added  NULL, or out: particles added @return MPS_E_ARG if there is none */
MPS_API mps_status mps_geometry_fill_box(mps_sim *sim, int32_t phase, const double *lo, const double *hi, int64_t *added);

/** Non-zero if a point [dim] [m] is inside. */
typedef int (*mps_inside_fn)(void *user, const double *x);

/** Fill the free lattice points of the tank for which `inside` answers non-zero. */
MPS_API mps_status mps_geometry_fill(mps_sim *sim, int32_t phase, mps_inside_fn inside, void *user, int64_t *added);

MPS_END_DECLS

#endif
