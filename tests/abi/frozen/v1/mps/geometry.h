/* SPDX-License-Identifier: BSD-3-Clause */
/** @file geometry.h  Tanks, baffles, plates, solids and fluid on a lattice.
 *
 *  Points of the lattice are lo + k h, h the edges of its cells, near dp: mps_tank_add(). The wall
 *  particles are ON the wall of the tank, the first fluid particles one h inside, dummies one and
 *  two h behind the wall. Positions are in the frame of the tank; particles are placed according to
 *  its current pose. "Up" is y in 2-D and 3-D.
 *
 *  Z14: Zhang, Wan & Hino (2014); its surge tank in 2-D has 199 x 62 fluid particles and 1974 of
 *  walls and dummies.
 *
 *  Errors. All functions that add particles return these errors, and then add nothing:
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | an argument is out of its range; an overlap, at the position in the text |
 *  | MPS_E_STATE | after the first step (walls and solids); no tank or solid (fluid, baffles) |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
#ifndef MPS_GEOMETRY_H
#define MPS_GEOMETRY_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A rectangular tank. Faces are parts named "<name>.x0", ".x1", ".y0", ".y1", ".z0", ".z1". Edges
 *  belong to the first face in the order y0, y1, x0, x1, z0, z1; a force probe includes them in
 *  each face that they touch. */
typedef struct mps_tank {
    /** Set by mps_tank_init(). */
    uint32_t struct_size;
    /** Default "tank". */
    const char *name;
    /** Lower corner [m]. The whole tank must be within 1e9 dp of the origin, so that the points of
     *  its lattice are distinct. */
    double lo[3];
    /** Inner size [m], at least 3 dp. */
    double size[3];
    /** 1: no wall at the upper y end; the side walls end there. */
    int32_t open_top;
    /** Default 2. */
    int32_t dummy_layers;
} mps_tank;

/** Set every entry to its default. @param size  sizeof(mps_tank) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_tank_init(mps_tank *tank, size_t size);

/** Add the walls of a tank. Fills use its lattice from now on.
 *
 *  The tank has the requested size: a side of length L has n = L/dp cells, rounded, with edges h =
 *  L/n. They differ from dp by at most 1/(2n): by less than 1 % for 50 cells and more. If a side is
 *  not a whole number of dp, the first tank changes the spacing to dp = (hx hy hz)^(1/3), in 2-D
 *  (hx hy)^(1/2), because a cell has the volume of a particle; mps_sim_shape() returns it. The
 *  radii of config.re_near and config.re_far, and the default of config.velocity_scale, change
 *  accordingly. The spacing is fixed once there are particles: a tank whose cell volume differs by
 *  more than .1 % is then rounded to whole dp. The log reports the cells and warns of a rounded
 *  tank.
 *  @param built  NULL, or [3] out: size as built [m]
 *  @return see the table of this file */
MPS_API mps_status mps_tank_add(mps_sim *sim, const mps_tank *tank, double *built);

/** The lattice of the fills: that of the last tank, or of all solids.
 *  @param lo  NULL, or [dim] out: its first point [m], in the frame of the tank
 *  @param h   NULL, or [dim] out: distance of its points along each axis [m]
 *  @return MPS_E_ARG; MPS_E_STATE: there is no tank and no solid */
MPS_API mps_status mps_lattice_get(const mps_sim *sim, double *lo, double *h);

/** Add a solid box (a baffle): points of the lattice in the closed box lo..hi, walls in its outer
 *  layer, dummies inside. Add it after the tank and before the fluid: fluid closer than dp/2 to its
 *  points is refused. Points of other solids are omitted: a baffle does not replace walls to which
 *  it is attached.
 *
 *  A box of one to three layers across one axis, with liquid on both sides, is a plate: it occludes
 *  the liquid of the other side, and walls to which the plate is attached are divided between the
 *  sides. The plate is extended to a wall that is next to it on the lattice: this closes the slot
 *  between them, and a warning is logged. One layer has no thickness: each lattice point has two
 *  wall particles, one for each side, with opposite areas. Along a free edge each lattice point has
 *  one wall particle, of almost no area. Forces are those on both faces. A wall probe reads the
 *  side of its position; for a position in the plane it reads the side that was created first.
 *  Dummies of a plate: field "plate" in mps/particles.h.
 *  @param name   name of the part
 *  @param lo,hi  [dim] corners [m]
 *  @param built  NULL, or [2*dim] out: corners of the box of its lattice points [m] (a difference
 *                to lo and hi is logged)
 *  @return see the table of this file; MPS_E_ARG also if no free lattice point lies inside */
MPS_API mps_status mps_baffle_add(mps_sim *sim, const char *name, const double *lo,
                                  const double *hi, double *built);

/** Add a plate without thickness anywhere in the tank, e.g. an inclined baffle; otherwise as a
 *  baffle of one layer. Its particles have their own lattice with a spacing of about dp. Fills omit
 *  points closer than 0.7 dp. An edge is attached to a wall if it is within 0.75 dp of wall
 *  particles along its whole length: put the edge on the wall. Plates may be attached to plates.
 *  @param name    name of the part
 *  @param corner  [dim] an end (2-D), a corner (3-D) [m]
 *  @param edge    [dim] from there to the other end, or along one side [m], at least 2 dp long
 *  @param edge2   [3] along the other side [m], at right angles to `edge`, at least 2 dp long; NULL
 *                 in 2-D
 *  @return see the table of this file; MPS_E_ARG also if the plate leaves the tank */
MPS_API mps_status mps_plate_add(mps_sim *sim, const char *name, const double *corner,
                                 const double *edge, const double *edge2);

/** Fill a box with fluid of a phase: free points of the lattice in the closed box. Each fill logs
 *  the built and the requested volume; next to inclined walls, both consist of whole cells of the
 *  lattice. The first fill after solids warns of slots between walls that are too narrow for a
 *  particle. The level of n rows is n h above the floor: a side of the box that is not on the
 *  lattice (mps_lattice_get()) moves to the next lattice point inside the box. mps_fill_level_add()
 *  keeps the volume of the box.
 *  @param added  NULL, or out: particles added
 *  @param built  NULL, or [2*dim] out: corners of the box of lattice points [m] (a difference to lo
 *                and hi is logged)
 *  @return see the table of this file; MPS_E_ARG also if no free lattice point lies inside */
MPS_API mps_status mps_fill_box_add(mps_sim *sim, int32_t phase, const double *lo, const double *hi,
                                    int64_t *added, double *built);

/** Fill a box with its volume, up to the level hi[1] [m], in a tank or in any solid. If the level
 *  is between two rows of the lattice, a fraction of the points of the upper row is filled, evenly
 *  distributed, so that the mass below the level is correct; the liquid at rest settles to the
 *  level. The other sides of the box are filled in the same way. The number of particles is correct
 *  to half a particle.
 *
 *  Half a cell of the liquid at a wall belongs to the wall particle, and a free surface is at the
 *  centres of the outermost particles. So a side of length L has L/h particles between a wall and a
 *  free surface, L/h - 1 between two walls, L/h + 1 between two free surfaces. A gap between the
 *  box and a wall of a tank that is narrower than h is closed. Otherwise as mps_fill_box_add().
 *  @param built  NULL, or [2*dim] out: built[dim+1] is the level that corresponds to the filled
 *  mass [m] */
MPS_API mps_status mps_fill_level_add(mps_sim *sim, int32_t phase, const double *lo,
                                      const double *hi, int64_t *added, double *built);

/** Non-zero if a point [dim] [m] is inside. */
typedef int (*mps_inside_fn)(void *user, const double *x);

/** Fill the free lattice points of the tank for which `inside` returns non-zero. For a flat surface
 *  use mps_fill_level_add(): with `inside` the level can be up to one row too low, because only
 *  whole rows are filled. `inside` is also called between the points, to compute the requested
 *  volume.
 *  @return see the table of this file */
MPS_API mps_status mps_fill_add(mps_sim *sim, int32_t phase, mps_inside_fn inside, void *user,
                                int64_t *added);

/* ---- solids of any shape --------------------------------------------------------------------- */

/** Signed distance of a point [dim] from the surface of a solid [m]: > 0 where liquid may be, < 0
 *  inside the solid. It need not be exact, but near the surface it must be the distance times a
 *  slowly varying factor. */
typedef double (*mps_distance_fn)(void *user, const double *x);

/** A solid of any shape: a tank (its outside is solid) or a body in a tank. Set `distance` or
 *  `inside`. */
typedef struct mps_solid {
    /** Set by mps_solid_init(). */
    uint32_t struct_size;
    /** Default 2. */
    int32_t dummy_layers;
    /** Name of its part; default "solid". */
    const char *name;
    /** Lower corner of the box in which the surface is searched [m]. The box must contain the whole
     *  surface, except parts beyond the walls of a tank. */
    double lo[3];
    /** Upper corner of the box [m]. */
    double hi[3];
    /** Signed distance, or NULL. */
    mps_distance_fn distance;
    /** Non-zero inside the solid, or NULL. Edges are rounded by about dp/4. */
    mps_inside_fn inside;
    /** First argument of both; neither is called after the call returns. */
    void *user;
    /** 1: exchange solid and liquid. */
    int32_t invert;
} mps_solid;

/** Set every entry to its default. @param size  sizeof(mps_solid) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_solid_init(mps_solid *solid, size_t size);

/** Add a solid with walls that follow its surface: wall particles are on it about dp apart, at
 *  edges and corners too, each with its part of the area; dummies are behind them. Wall particles
 *  are half cells. Therefore fills omit the inside and points closer than dp/2 to the surface: the
 *  liquid reaches the surface, the volume of the fluid particles ends dp/2 before it. Fills move
 *  the first rows next to a solid by up to 0.45 dp, so that their density is uniform, and call
 *  `inside` with the lattice point.
 *
 *  The first tank or solid defines the lattice of the fills. The lattice of a solid starts at its
 *  corner `lo`: put `lo` and `hi` on flat walls. Along the horizontal axes whole cells fill the box
 *  lo..hi, h = L/n with n = L/dp, rounded; the height of a cell gives it the volume dp^dim. Without
 *  a tank each further solid extends the lattice, and fills are limited to the boxes of the solids.
 *  A body may penetrate the walls of a tank: its points beyond the walls, or closer than 0.7 dp to
 *  a wall particle, are omitted. Walls of the tank inside the body become dummies. Add bodies
 *  before the fluid: fluid inside a solid is refused. Parts thinner than 3 dp are logged as a
 *  warning, because the liquid on one side interacts with the other; use mps_baffle_add() and
 *  mps_plate_add() for thin screens.
 *  @return see the table of this file; MPS_E_ARG also for a non-finite distance (with its
 *          position), no surface in the box, a surface that leaves the box */
MPS_API mps_status mps_solid_add(mps_sim *sim, const mps_solid *solid);

/** Sides of a box, in the frame of the tank. */
enum {
    /** No side. */
    MPS_SIDE_NONE = 0,
    /** Smallest x. */
    MPS_SIDE_X0 = 1,
    /** Largest x. */
    MPS_SIDE_X1 = 2,
    /** Smallest y: the bottom. */
    MPS_SIDE_Y0 = 3,
    /** Largest y: the top. */
    MPS_SIDE_Y1 = 4,
    /** Smallest z. */
    MPS_SIDE_Z0 = 5,
    /** Largest z. */
    MPS_SIDE_Z1 = 6
};

/** A solid from a file: binary or ASCII STL, a closed surface of triangles, 3-D only. A point X of
 *  the file is mapped to
 *    x = shift + Rz(rotation[2]) Ry(rotation[1]) Rx(rotation[0]) scale X,
 *  that is, the surface is scaled, rotated about the axes x, y and z in this order, and shifted.
 *  For a file with z up, rotation[0] = -pi/2 gives y up. */
typedef struct mps_stl {
    /** Set by mps_stl_init(). */
    uint32_t struct_size;
    /** Default 2. */
    int32_t dummy_layers;
    /** Name of its part; default "solid". */
    const char *name;
    /** Length unit of the file [m]; default 1; 0.001 for millimetres. */
    double scale;
    /** Angles about the axes x, y and z through the origin, in this order [rad]; default 0. */
    double rotation[3];
    /** Added to all coordinates after scaling and rotation [m]. */
    double shift[3];
    /** 1: the liquid is inside of the surface; 0 (default): the surface encloses a body. */
    int32_t container;
    /** Container only: side of the bounding box, after the rotation, that has no wall; default
     *  MPS_SIDE_NONE. The surface in the file is closed all the same, by a lid. The lid and parts
     *  within dp/2 of its plane get no particles: the other walls end at most 1 dp below the
     *  plane. */
    int32_t open_side;
} mps_stl;

/** Set every entry to its default. @param size  sizeof(mps_stl) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_stl_init(mps_stl *stl, size_t size);

/** Add a solid from an STL file, as mps_solid_add(); the lattice starts at the lower corner of its
 *  bounding box.
 *
 *  Repairs are logged: degenerate and duplicate triangles are skipped, the orientation of an
 *  inside-out surface is reversed, points of open edges within 0.01 dp of each other are merged,
 *  bytes after the last triangle are ignored. Warnings report closed surfaces within another one
 *  (thick walls: the liquid of a container is between them) or disjoint, surfaces that overlap or
 *  intersect (points that are not enclosed 0 or 1 times), and a number of wall particles that
 *  differs by 10 % from the surface area over dp^2.
 *  @param built  NULL, or [6] out: lower and upper corner of the surface [m]
 *
 *  | error (and those of the table of this file) | reason |
 *  |---|---|
 *  | MPS_E_IO | the file cannot be read, is cut short, or is not an STL file |
 *  | MPS_E_ARG | 2-D; no triangles; a non-finite coordinate; a surface with gaps wider than |
 *  | | 0.01 dp, or not oriented: number of such edges, and position of the first one | */
MPS_API mps_status mps_stl_add(mps_sim *sim, const char *path, const mps_stl *stl, double *built);

/** Sharp edges of the surface that mps_stl_add() would add, for drawings. Nothing is added.
 *  @param angle  least angle between the normals of two triangles at an edge, 0..pi [rad]
 *  @param capacity capacity of `ends` in edges, >= 0; further edges are only counted
 *  @param ends   [6*capacity] out: both ends of each edge, frame of the tank [m];
 *                 NULL where capacity is 0
 *  @param count  out: number of sharp edges
 *  @return MPS_E_ARG, MPS_E_IO, MPS_E_NOMEM: as mps_stl_add() */
MPS_API mps_status mps_stl_edges(mps_sim *sim, const char *path, const mps_stl *stl, double angle,
                                 int64_t capacity, double *ends, int64_t *count);

MPS_END_DECLS

#endif
