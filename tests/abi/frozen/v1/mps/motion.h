/* SPDX-License-Identifier: BSD-3-Clause */
/** @file motion.h  Rigid motion of the tank: six degrees of freedom about a given centre.
 *
 *    x(t) = c + d(t) + R(t) (X - c),   R = Rz(yaw) Ry(pitch) Rx(roll) in 3-D.
 *
 *  2-D has surge, heave and one rotation, that of the plane, positive from x to y. It has two
 *  names: MPS_ROLL, as for the cross-section of a ship, and MPS_YAW, about the axis z. The tank
 *  turns by the sum of both, R = Rz(roll + yaw). Sway and pitch are refused.
 *
 *  All walls, probes and gauges move with the tank. Setting a motion carries the tank and its
 *  liquid to the pose of the motion at the present time. Between steps a new motion should begin at
 *  the present pose. */
#ifndef MPS_MOTION_H
#define MPS_MOTION_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Degrees of freedom in tables and harmonics. */
enum {
    /** Along x [m]. */
    MPS_SURGE = 0,
    /** Along y, up [m]. */
    MPS_HEAVE = 1,
    /** Along z [m]; 3-D only. */
    MPS_SWAY = 2,
    /** About x [rad]; in 2-D the rotation of the plane. */
    MPS_ROLL = 3,
    /** About z [rad]; in 2-D the rotation of the plane. */
    MPS_YAW = 4,
    /** About y [rad]; 3-D only. */
    MPS_PITCH = 5,
    /** Number of degrees of freedom. */
    MPS_DOF_COUNT = 6
};

/** Pose of the tank with its first two derivatives, one entry for each degree of freedom. */
typedef struct mps_motion_state {
    /** Set by mps_motion_state_init(), or sizeof(mps_motion_state). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Displacements and angles [m, rad]. */
    double value[MPS_DOF_COUNT];
    /** First derivative [m/s, rad/s]. */
    double rate[MPS_DOF_COUNT];
    /** Second derivative [m/s2, rad/s2]. */
    double accel[MPS_DOF_COUNT];
} mps_motion_state;

/** Set struct_size and zero. @param size  sizeof(mps_motion_state) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_motion_state_init(mps_motion_state *state, size_t size);

/** How the motion begins. */
enum {
    /** Walls jump to their velocity, the liquid is at rest in the lab (as in the papers;
     *  default). */
    MPS_START_AT_REST = 0,
    /** The liquid takes the velocity of the tank when the first step with this motion begins. */
    MPS_START_WITH_TANK = 1
};

/** Set the centre of rotation and how the motion begins. Default: origin, MPS_START_AT_REST.
 *  @param centre  [dim] [m], in the frame of the tank
 *  @param start   MPS_START_...
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | centre is not finite; start |
 *  | MPS_E_STATE | a step was done |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback | */
MPS_API mps_status mps_motion_centre_set(mps_sim *sim, const double *centre, int32_t start);

/** One harmonic. Its layout does not change within a major version. */
typedef struct mps_harmonic {
    /** MPS_SURGE .. MPS_PITCH */
    int32_t dof;
    /** 0: A sin(w t + phase); 1: -A (1 - cos(w t)), phase is not used. */
    int32_t form;
    /** A [m or rad] */
    double amplitude;
    /** w [rad/s], >= 0 */
    double omega;
    /** [rad] */
    double phase;
} mps_harmonic;

/** Motion as a sum of harmonics. @param count  >= 1 @param harmonics  [count], copied
 *  @return MPS_E_ARG (which harmonic), MPS_E_BUSY, MPS_E_NOMEM */
MPS_API mps_status mps_motion_harmonics_set(mps_sim *sim, int32_t count,
                                            const mps_harmonic *harmonics);

/** Motion from a table, interpolated by a natural cubic spline (C2). Accelerations at the first and
 *  the last row are zero, velocities there are not: a tank that is to stop needs some rows of equal
 *  values at the end.
 *
 *  A step that would end more than 1e-9 s beyond the last row fails with MPS_E_STATE, and the
 *  simulation can continue with another motion. mps_run() to the time of the last row meets it
 *  exactly. mps_step() does not cut its step to the table, but takes at most the given dt_max.
 *  After the table mps_motion_clear() holds the tank where it is; its velocity becomes zero at
 *  once.
 *  @param rows    >= 2
 *  @param t       [rows] [s], strictly increasing, t[0] <= present time
 *  @param dofs    number of columns, 1..6
 *  @param dof     [dofs] degree of freedom of each column, each once
 *  @param values  [rows*dofs] row by row [m, rad]; copied
 *  @return MPS_E_ARG (the first bad row), MPS_E_BUSY, MPS_E_NOMEM */
MPS_API mps_status mps_motion_table_set(mps_sim *sim, int64_t rows, const double *t, int32_t dofs,
                                        const int32_t *dof, const double *values);

/** Pose, rates and accelerations at a time; a smooth function of t alone. `state` arrives with its
 *  struct_size and zeros. @return 0; non-zero: the step fails with MPS_E_PLUGIN */
typedef int (*mps_motion_fn)(void *user, double t, mps_motion_state *state);

/** Motion by callback. @return MPS_E_ARG, MPS_E_BUSY, MPS_E_PLUGIN (the callback fails at the
 *  present time) */
MPS_API mps_status mps_motion_callback_set(mps_sim *sim, mps_motion_fn fn, void *user);

/** No motion from now on; the tank stays where it is. @return MPS_E_BUSY */
MPS_API mps_status mps_motion_clear(mps_sim *sim);

/** Pose at the present time. @param state  initialised by mps_motion_state_init(); out
 *  @return MPS_E_ARG */
MPS_API mps_status mps_motion_state_get(const mps_sim *sim, mps_motion_state *state);

/** Map a point from the frame of the tank to the lab at the present time.
 *  @param tank      [dim] [m], finite
 *  @param lab       [dim] out [m]
 *  @param velocity  NULL, or [dim] out: velocity of the tank there [m/s]
 *  @return MPS_E_ARG */
MPS_API mps_status mps_motion_to_lab(const mps_sim *sim, const double *tank, double *lab,
                                     double *velocity);

MPS_END_DECLS

#endif
