/* SPDX-License-Identifier: BSD-3-Clause */
/** @file ship.h  Motions and loads in the axes of a ship. The functions need no simulation. They
 *  convert between the six degrees of freedom of a ship and the motion of the tank, and between
 *  forces and moments along the axes of the lab and of the ship.
 *
 *  The axes of the ship at rest are e1, e2, e3, given by mps_ship.forward, .up and .axes as vectors
 *  of the lab. With surge, sway and heave s1, s2, s3 and the angles roll a1, pitch a2, yaw a3, a
 *  point X of the tank is at
 *
 *    x = o + s1 e1 + s2 e2 + s3 e3 + R (X - o),
 *    R = T(e3, yaw) T(e2, pitch) T(e1, roll)   in the usual order,
 *
 *  where o is mps_ship.origin and T(e, a) the right-handed rotation by a about e. As intrinsic
 *  rotations (about axes of the ship): yaw about e3, then pitch about the new e2, then roll about
 *  the newest e1 (z-y'-x''). Surge, sway and heave are along axes that do not rotate.
 *
 *  | | MPS_SHIP_Z_UP | MPS_SHIP_Z_DOWN |
 *  |---|---|---|
 *  | e1, e2, e3 | forward, to port, up | forward, to starboard, down |
 *  | positive surge, sway, heave | forward, to port, up | forward, to starboard, down |
 *  | positive roll | starboard down | starboard down |
 *  | positive pitch | bow down | bow up |
 *  | positive yaw | bow to port | bow to starboard |
 *
 *  All poses are about `origin`: pass the same point to mps_motion_centre_set(). */
#ifndef MPS_SHIP_H
#define MPS_SHIP_H

#include <mps/motion.h>

MPS_BEGIN_DECLS

/** Degrees of freedom of a ship, in the usual order of columns. */
enum {
    /** Along e1 [m]. */
    MPS_SHIP_SURGE = 0,
    /** Along e2 [m]. */
    MPS_SHIP_SWAY = 1,
    /** Along e3 [m]. */
    MPS_SHIP_HEAVE = 2,
    /** About e1 [rad or degrees]. */
    MPS_SHIP_ROLL = 3,
    /** About e2 [rad or degrees]. */
    MPS_SHIP_PITCH = 4,
    /** About e3 [rad or degrees]. */
    MPS_SHIP_YAW = 5
};

/** Directions of e1, e2, e3. */
enum {
    /** Forward, to port, up: usual for motions in waves (default). */
    MPS_SHIP_Z_UP = 0,
    /** Forward, to starboard, down: usual for manoeuvring. */
    MPS_SHIP_Z_DOWN = 1
};

/** Axes along which the components of a vector are given. */
enum {
    /** e1, e2, e3 of the ship at rest; they do not rotate. */
    MPS_SHIP_FIXED = 0,
    /** R e1, R e2, R e3, which rotate with the ship. */
    MPS_SHIP_BODY = 1
};

/** Axes, origin, order of angles and units of a ship. Fill it with mps_ship_init(). */
typedef struct mps_ship {
    /** Set by mps_ship_init(). */
    uint32_t struct_size;
    /** MPS_SHIP_Z_UP (default) or MPS_SHIP_Z_DOWN. */
    int32_t axes;
    /** 0: angles in rad (default), 1: in degrees; rates per s, accelerations per s2. */
    int32_t degrees;
    /** MPS_SHIP_ROLL, MPS_SHIP_PITCH and MPS_SHIP_YAW, each once: order of the intrinsic rotations
     *  (about axes of the ship). Default: yaw, pitch, roll. */
    int32_t order[3];
    /** Direction of the bow at rest, in the axes of the lab; any length. Default (1, 0, 0). */
    double forward[3];
    /** Direction up at rest, normal to `forward` within 1e-6; any length. Default (0, 1, 0). */
    double up[3];
    /** Reference point of surge, sway and heave, for example the centre of gravity, in the frame of
     *  the tank [m]. */
    double origin[3];
} mps_ship;

/** Set every entry to its default. @param size  sizeof(mps_ship) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_ship_init(mps_ship *ship, size_t size);

/** Six degrees of freedom with their first two derivatives, in the order MPS_SHIP_SURGE to
 *  MPS_SHIP_YAW. The rates of angles are derivatives of the angles, not components of the angular
 *  velocity. */
typedef struct mps_ship_motion {
    /** Set by mps_ship_motion_init(), or sizeof(mps_ship_motion). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** [m, rad or degrees] */
    double value[6];
    /** Derivative of value [per s]. */
    double rate[6];
    /** Derivative of rate [per s2]. */
    double accel[6];
} mps_ship_motion;

/** Set struct_size and zero. @param size  sizeof(mps_ship_motion) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_ship_motion_init(mps_ship_motion *motion, size_t size);

/** Convert a motion of the ship to the motion of the tank, for example in an mps_motion_fn.
 *  @param motion  finite
 *  @param tank    initialised by mps_motion_state_init(); out. Angles: mps_motion_pose_to_state()
 *
 *  | error | reason; `tank` is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | an entry of `ship` or `motion`; a struct was not initialised |
 *  | MPS_E_STATE | MPS_ROTATE_Z would be within 1e-6 of +-pi/2, see mps_motion_pose_to_state() | */
MPS_API mps_status mps_ship_to_tank(const mps_ship *ship, const mps_ship_motion *motion,
                                    mps_motion_state *tank);

/** Convert a motion of the tank to the motion of the ship. The first and the third angle in `order`
 *  are in -pi..pi, the second in -pi/2..pi/2.
 *  @param tank    finite
 *  @param motion  initialised by mps_ship_motion_init(); out
 *
 *  | error | reason; `motion` is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | an entry of `ship` or `tank`; a struct was not initialised |
 *  | MPS_E_STATE | the second angle is within 1e-6 rad of +-pi/2 and not the only one | */
MPS_API mps_status mps_ship_from_tank(const mps_ship *ship, const mps_motion_state *tank,
                                      mps_ship_motion *motion);

/** Convert the six columns of a ship to columns for mps_motion_table_set(). From row to row each
 *  angle changes by less than pi, so that a heading may pass 180 degrees.
 *  @param columns  [rows*6] row by row: surge, sway, heave, roll, pitch, yaw
 *  @param dofs     number of columns of `values`, 1..6
 *  @param dof      [dofs] degrees of freedom of the columns, MPS_MOVE_X .. MPS_ROTATE_Z, all
 *                  different
 *  @param values   [rows*dofs] row by row [m, rad]; out
 *
 *  | error | reason; `values` is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | an entry of `ship`; rows < 1; dofs; dof; a NULL; a non-finite number; |
 *  | | the ship moves in a degree of freedom that is not in `dof` |
 *  | MPS_E_STATE | as mps_ship_to_tank() | */
MPS_API mps_status mps_ship_table(const mps_ship *ship, int64_t rows, const double *columns,
                                  int32_t dofs, const int32_t *dof, double *values);

/** Convert the components of a vector from the axes of the lab to those of the ship. With
 *  MPS_SHIP_BODY, `velocity` and `omega` of mps_motion_pose give u, v, w and p, q, r.
 *  @param axes    MPS_SHIP_FIXED or MPS_SHIP_BODY
 *  @param lab     [3] finite
 *  @param vector  [3] out; may be `lab`
 *  @return MPS_E_ARG; `vector` is unchanged then */
MPS_API mps_status mps_ship_vector_from_lab(const mps_ship *ship, const mps_motion_state *tank,
                                            int32_t axes, const double *lab, double *vector);

/** The inverse of mps_ship_vector_from_lab(). @return MPS_E_ARG; `lab` is unchanged then */
MPS_API mps_status mps_ship_vector_to_lab(const mps_ship *ship, const mps_motion_state *tank,
                                          int32_t axes, const double *vector, double *lab);

/** Convert force and moment from the axes of the lab to those of the ship, with the moment about
 *  `origin`: M_o = M_at + R (at - origin) x F.
 *  @param axes  MPS_SHIP_FIXED or MPS_SHIP_BODY
 *  @param at    [3] mps_probe.at of the probe MPS_PROBE_FORCE [m], or NULL: `origin`
 *  @param lab   [6] finite: force and moment about `at` along the axes of the lab [N, N m]. In 2-D:
 *               the values of the probe in entries 0, 1 and 5, zeros in the others [N/m, N]
 *  @param load  [6] out: force along e1, e2, e3, and moment about `origin`: roll, pitch, yaw
 *  @return MPS_E_ARG; `load` is unchanged then */
MPS_API mps_status mps_ship_load_from_lab(const mps_ship *ship, const mps_motion_state *tank,
                                          int32_t axes, const double *at, const double *lab,
                                          double *load);

/** The inverse of mps_ship_load_from_lab(). @return MPS_E_ARG; `lab` is unchanged then */
MPS_API mps_status mps_ship_load_to_lab(const mps_ship *ship, const mps_motion_state *tank,
                                        int32_t axes, const double *at, const double *load,
                                        double *lab);

MPS_END_DECLS

#endif
