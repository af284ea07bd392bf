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
    double lo[3];         /**< lower corner [m]; the whole tank within 1e9 dp of the origin, where its lattice points still differ */
    double size[3];       /**< inner size [m]; rounded to whole spacings, at least 3 dp */
    int32_t open_top;     /**< 1: no wall at the upper y end; the side walls end there */
    int32_t dummy_layers; /**< default 2 */
} mps_tank;

/** Defaults. */
MPS_API mps_status mps_tank_init(mps_tank *tank, size_t size);

/** Add the walls of a tank; its lattice is the one fills use from now on.
 *  @param built  NULL, or [3] out: the size built [m] after rounding to the lattice (a rounding is logged)
 *  @return MPS_E_ARG (also for fluid in the way, with its place), MPS_E_STATE after the first step, MPS_E_BUSY, MPS_E_NOMEM; nothing is
 *          added then */
MPS_API mps_status mps_tank_add(mps_sim *sim, const mps_tank *tank, double *built);

/** Add a solid box (a baffle): lattice points of the closed box lo..hi, its outer layer walls, what lies inside dummies.
 *  Must follow mps_tank_add() and come before the fill: fluid nearer than dp/2 to its points is refused. Points taken by other
 *  solids are left out, so that the walls a baffle stands on stay.
 *
 *  A box of one to three layers across one axis, open to the liquid on both sides, is a plate: the liquid on one side does not feel
 *  the other, and walls the plate stands on are divided between the sides. It reaches a wall that is next to it on the lattice. One layer
 *  has no thickness: each lattice point carries two walls, one a side, with opposite areas, a point of a free edge one wall without area to
 *  speak of. So forces are those on both faces, and a wall probe looks at the side its place lies on; at the very plane it is the older one.
 *  Dummies of a plate: see mps_particles_plates().
 *  @param name   part name @param lo,hi [dim] corners [m]
 *  @param built  NULL, or [2*dim] out: corners of the box of its lattice points [m] (what differs from lo and hi is logged)
 *  @return MPS_E_ARG if no lattice point lies inside, all are taken, or fluid is in the way (with its place); MPS_E_STATE without a tank
 *          and after the first step; MPS_E_BUSY, MPS_E_NOMEM; nothing is added then */
MPS_API mps_status mps_baffle_add(mps_sim *sim, const char *name, const double *lo, const double *hi, double *built);

/** Add a plate without thickness anywhere in the tank, e.g. an inclined baffle; otherwise as a baffle of one layer. Its particles have a
 *  lattice of their own, about dp wide; fills leave out points nearer than 0.7 dp. An edge stands on a wall if it lies within 0.75 dp
 *  of wall particles along its whole length: let it end on the wall. Plates may stand on plates.
 *  @param name    part name
 *  @param corner  [dim] an end (2-D), a corner (3-D) [m]
 *  @param edge    [dim] from there to the other end, or along one side [m], at least 2 dp long
 *  @param edge2   [3] along the other side [m], at right angles to `edge`, at least 2 dp long; NULL in 2-D
 *  @return MPS_E_ARG, also if the plate leaves the tank, all its points are taken or fluid is nearer than dp/2 (with its place);
 *          MPS_E_STATE without a tank and after the first step; MPS_E_BUSY, MPS_E_NOMEM; nothing is added then */
MPS_API mps_status mps_plate_add(mps_sim *sim, const char *name, const double *corner, const double *edge, const double *edge2);

/** Fill a box with fluid of a phase: free lattice points of the closed box. The level of n rows is n dp above the floor, so that a depth
 *  which is no multiple of dp becomes the next smaller one: mps_fill_level_add() keeps it.
 *  @param added  NULL, or out: particles added
 *  @param built  NULL, or [2*dim] out: corners of the box of lattice points [m] (what differs from lo and hi is logged)
 *  @return MPS_E_ARG (no lattice point, none is free), MPS_E_STATE without a tank, MPS_E_BUSY, MPS_E_NOMEM; nothing is added then */
MPS_API mps_status mps_fill_box_add(mps_sim *sim, int32_t phase, const double *lo, const double *hi, int64_t *added, double *built);

/** Fill a box up to the level hi[1] [m]. If this lies between two rows of the lattice, the upper row gets the share of its points that the
 *  mass below the level needs, evenly spread; the liquid at rest settles to the level. All else as mps_fill_box_add().
 *  @param built  NULL, or [2*dim] out: built[dim+1] is the level of the mass that was filled in [m] */
MPS_API mps_status mps_fill_level_add(mps_sim *sim, int32_t phase, const double *lo, const double *hi, int64_t *added, double *built);

/** Non-zero if a point [dim] [m] is inside. */
typedef int (*mps_inside_fn)(void *user, const double *x);

/** Fill the free lattice points of the tank for which `inside` answers non-zero. */
MPS_API mps_status mps_fill_add(mps_sim *sim, int32_t phase, mps_inside_fn inside, void *user, int64_t *added);

/* ---- solids of any shape -------------------------------------------------------------------------------------- */

/** Signed distance of a point [dim] from the surface of a solid [m]: > 0 where liquid may be, < 0 inside the solid. It need not be exact
 *  but must be near the surface, up to a factor that varies slowly. */
typedef double (*mps_distance_fn)(void *user, const double *x);

/** A solid of any shape: a tank (everything outside of it is solid) or a body in one. Give `distance`, or `inside`. */
typedef struct mps_solid {
    uint32_t struct_size;     /**< set by mps_solid_init() */
    int32_t dummy_layers;     /**< default 2 */
    const char *name;         /**< name of its part; default "solid" */
    double lo[3];             /**< box to look in [m]; must contain the whole surface, but for what lies beyond a tank's walls */
    double hi[3];             /**< its upper corner [m] */
    mps_distance_fn distance; /**< signed distance, or */
    mps_inside_fn inside;     /**< non-zero inside the solid; edges come out rounded by about dp/4 */
    void *user;               /**< first argument of either; neither is called after the call returns */
    int32_t invert;           /**< 1: solid and liquid change places */
} mps_solid;

/** Defaults. */
MPS_API mps_status mps_solid_init(mps_solid *solid, size_t size);

/** Add a solid with walls that follow its surface: wall particles lie on it about dp apart, at edges and corners too, each with its
 *  share of the area; behind them dummies. Fills leave out the inside and what is nearer than dp/2 to the surface, because wall particles
 *  are half cells: the liquid reaches to the surface, the volume of the fluid particles to dp/2 from it. The first rows beside a
 *  solid are moved by up to 0.45 dp, so that their density is even; `inside` of a fill is asked for the lattice point.
 *
 *  The first tank or solid lays the lattice of the fills, a solid's from its corner `lo`: put `lo` on a lattice plane of flat walls. Without
 *  a tank each further solid extends it; then fills keep to the boxes of the solids. A body in a tank may end in its walls: what
 *  lies beyond them, or nearer than 0.7 dp to a wall particle that is there, is left out, and walls inside of the body become dummies.
 *  Add bodies before the fill: fluid inside of a solid is refused. Parts thinner than 3 dp are logged as a warning, since liquid on one side
 *  feels the other; screens of no thickness are made by mps_baffle_add().
 *  @return MPS_E_ARG (a distance that is not finite, with its place; no surface in the box; a surface that leaves the box; fluid in the
 *          way), MPS_E_STATE after the first step, MPS_E_BUSY, MPS_E_NOMEM; nothing is added then */
MPS_API mps_status mps_solid_add(mps_sim *sim, const mps_solid *solid);

/** A solid from a file: binary or ASCII STL, a closed surface of triangles, 3-D only. */
typedef struct mps_stl {
    uint32_t struct_size; /**< set by mps_stl_init() */
    int32_t dummy_layers; /**< default 2 */
    const char *name;     /**< name of its part; default "solid" */
    double scale;         /**< [m] a unit of the file; default 1; 0.001 for millimetres */
    double shift[3];      /**< added to all coordinates after scaling [m] */
    int32_t container;    /**< 1: the liquid is inside of the surface; 0 (default): the surface encloses a body */
} mps_stl;

/** Defaults. */
MPS_API mps_status mps_stl_init(mps_stl *stl, size_t size);

/** Add a solid from an STL file as mps_solid_add() does; the lattice begins at the lower corner of its bounding box. Triangles
 *  without area are skipped, a surface that is inside out is turned over, both are logged.
 *  @param built  NULL, or [6] out: lower and upper corner of the surface [m]
 *  @return MPS_E_IO (the file cannot be read, is cut short, is no STL file), MPS_E_ARG (no triangles, a coordinate that is not finite, open
 *          or inconsistently oriented: how many edges and where the first is), and what mps_solid_add() returns */
MPS_API mps_status mps_stl_add(mps_sim *sim, const char *path, const mps_stl *stl, double *built);

MPS_END_DECLS

#endif
