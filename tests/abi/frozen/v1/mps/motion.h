/* SPDX-License-Identifier: BSD-3-Clause */
/** @file motion.h  Rigid motion of the tank: six degrees of freedom about a given centre.
 *
 *  Axes of the lab: x and z horizontal, y up; right-handed. A tank in its initial pose has the same
 *  axes. A point X of the tank is at
 *
 *    x(t) = c + d(t) + R(t) (X - c),   R = Ry(b) Rz(g) Rx(a),
 *
 *  where c is the centre of rotation, d = (MPS_MOVE_X, MPS_MOVE_Y, MPS_MOVE_Z), a = MPS_ROTATE_X,
 *  b = MPS_ROTATE_Y, g = MPS_ROTATE_Z, and
 *
 *          | 1    0       0   |         |  cos b  0  sin b |         | cos g  -sin g  0 |
 *    Rx(a)=| 0  cos a  -sin a |,  Ry(b)=|    0    1    0   |,  Rz(g)=| sin g   cos g  0 |
 *          | 0  sin a   cos a |         | -sin b  0  cos b |         |   0       0    1 |
 *
 *  Positive angles rotate y to z, z to x, x to y: right-handed about the axis. Intrinsic rotations
 *  (about axes of the tank): b about y, then g about the new z, then a about the newest x.
 *  Extrinsic rotations (about axes of the lab): first x, then z, then y. For a ship with its bow
 *  along +x this is the usual order yaw (b), pitch (g), roll (a). <mps/ship.h> converts from and to
 *  the axes of a ship.
 *
 *  2-D is the plane x, y: it has MPS_MOVE_X, MPS_MOVE_Y and MPS_ROTATE_Z, positive from x to y
 *  (counterclockwise). The other three are refused.
 *
 *  An application that computes the motion step by step sets poses: mps_motion_pose_set() of
 *  <mps/couple.h>.
 *
 *  All walls, probes and gauges move with the tank. Setting a motion moves the tank and its liquid
 *  to the pose of the motion at the current time. After the first step a new motion should begin at
 *  the current pose. A motion that moves the origin of the tank farther than 1e9 dp from that of
 *  the lab is refused when it is set, or fails the step with MPS_E_DIVERGED. */
#ifndef MPS_MOTION_H
#define MPS_MOTION_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Degrees of freedom. */
enum {
    /** Displacement along x of the lab [m]. */
    MPS_MOVE_X = 0,
    /** Displacement along y of the lab, up [m]. */
    MPS_MOVE_Y = 1,
    /** Displacement along z of the lab [m]; 3-D only. */
    MPS_MOVE_Z = 2,
    /** Angle a of R, about x [rad]; 3-D only. */
    MPS_ROTATE_X = 3,
    /** Angle b of R, about y [rad]; 3-D only. */
    MPS_ROTATE_Y = 4,
    /** Angle g of R, about z [rad]; in 2-D the rotation of the plane. */
    MPS_ROTATE_Z = 5,
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

/** Pose of the tank with the matrix R, for programs that compute with matrices. Vectors have the
 *  axes of the lab. */
typedef struct mps_motion_pose {
    /** Set by mps_motion_pose_init(), or sizeof(mps_motion_pose). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** R, row by row. */
    double rotation[9];
    /** Displacement d of the centre of rotation [m]. */
    double translation[3];
    /** Velocity of the centre of rotation [m/s]. */
    double velocity[3];
    /** Angular velocity [rad/s]. */
    double omega[3];
    /** Acceleration of the centre of rotation [m/s2]. */
    double accel[3];
    /** Angular acceleration [rad/s2]. */
    double alpha[3];
} mps_motion_pose;

/** Set struct_size, R = 1 and zero. @param size  sizeof(mps_motion_pose)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_motion_pose_init(mps_motion_pose *pose, size_t size);

/** Convert angles to the rotation matrix. Needs no simulation.
 *  @param state  finite
 *  @param pose   initialised by mps_motion_pose_init(); out
 *  @return MPS_E_ARG; `pose` is unchanged then */
MPS_API mps_status mps_motion_pose_from_state(const mps_motion_state *state, mps_motion_pose *pose);

/** Convert a rotation matrix to angles: MPS_ROTATE_X and MPS_ROTATE_Y in -pi..pi, MPS_ROTATE_Z in
 *  -pi/2..pi/2; for a rotation about z only, MPS_ROTATE_Z in -pi..pi. Needs no simulation.
 *  @param pose   finite; R^T R is 1 within 1e-6 in each entry and det R > 0
 *  @param state  initialised by mps_motion_state_init(); out
 *
 *  | error | reason; `state` is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | `pose`; a struct was not initialised |
 *  | MPS_E_STATE | MPS_ROTATE_Z is within 1e-6 of +-pi/2 and R is no rotation about z only: |
 *  | | the two other angles are not unique there (gimbal lock) | */
MPS_API mps_status mps_motion_pose_to_state(const mps_motion_pose *pose, mps_motion_state *state);

/** How the motion begins. */
enum {
    /** Walls start with their velocity at once, the liquid is at rest in the lab (as in the papers;
     *  default). */
    MPS_START_AT_REST = 0,
    /** The liquid gets the velocity of the tank at the beginning of the first step with this
     *  motion. */
    MPS_START_WITH_TANK = 1
};

/** Set the centre of rotation and how the motion begins. Default: origin, MPS_START_AT_REST.
 *  @param centre  [dim] [m], in the frame of the tank
 *  @param start   MPS_START_...
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | centre is not finite or farther than 1e9 dp from the origin; start |
 *  | MPS_E_STATE | called after the first step |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback | */
MPS_API mps_status mps_motion_centre_set(mps_sim *sim, const double *centre, int32_t start);

/** One harmonic, q(t) = f(t) h(t). Its layout is fixed within a major version.
 *
 *  h(t) = A sin(w t + phase) or -A (1 - cos(w t)) starts at t = 0 with the velocity A w or with the
 *  acceleration -A w^2. Liquid at rest then has a pressure peak in the first steps. The second form
 *  oscillates about -A, not about 0. With a ramp T, position, velocity and acceleration are
 *  continuous and start from 0: with x = t/T,
 *
 *    f = 10 x^3 - 15 x^4 + 6 x^5 for 0 <= t <= T, 1 after it.
 *
 *  One to two periods are usual. t is the time of the simulation, also if the motion is set later
 *  than at t = 0. */
typedef struct mps_harmonic {
    /** MPS_MOVE_X .. MPS_ROTATE_Z */
    int32_t dof;
    /** 0: A sin(w t + phase); 1: -A (1 - cos(w t)), phase is not used. */
    int32_t form;
    /** A [m or rad] */
    double amplitude;
    /** w [rad/s], >= 0 */
    double omega;
    /** [rad] */
    double phase;
    /** T, duration of the ramp [s], >= 0; 0: f = 1. */
    double ramp;
} mps_harmonic;

/** Motion as a sum of harmonics. An adaptive step is at most a twentieth of the shortest period,
 *  and of the shortest ramp during ramps, of all harmonics whose amplitude is not 0 (the limit
 *  "motion" of mps_step_info.limit). A longer fixed step is logged once as a warning.
 *  @param count  >= 1 @param harmonics  [count], copied
 *  @return MPS_E_ARG (which harmonic), MPS_E_BUSY, MPS_E_NOMEM */
MPS_API mps_status mps_motion_harmonics_set(mps_sim *sim, int32_t count,
                                            const mps_harmonic *harmonics);

/** Motion from a table, interpolated by a natural cubic spline (C2). Accelerations are zero at the
 *  first and the last row, velocities are not: to stop the tank, end the table with several rows of
 *  equal values.
 *
 *  A step that ends more than 1e-9 s after the last row fails with MPS_E_STATE; the simulation can
 *  continue with another motion. mps_run() to the time of the last row ends there exactly.
 *  mps_step() does not shorten its step to the end of the table; use its dt_max. After the table
 *  mps_motion_clear() stops the tank at its current pose; its velocity becomes zero immediately.
 *
 *  An adaptive step may span several rows only where the accelerations of the spline are linear in
 *  time, within 1.2 per cent of the largest one of the column (as those of a harmonic over a
 *  twentieth of its period). Elsewhere it is at most an interval of rows, or ends at the next row
 *  (the limit "motion" of mps_step_info.limit). Noise in the table shortens steps. A longer fixed
 *  step is logged once as a warning.
 *  @param rows    >= 2
 *  @param t       [rows] [s], strictly increasing, t[0] <= current time
 *  @param dofs    number of columns, 1..6
 *  @param dof     [dofs] degrees of freedom of the columns, all different
 *  @param values  [rows*dofs] row by row [m, rad]; copied
 *  @return MPS_E_ARG (the first invalid row), MPS_E_BUSY, MPS_E_NOMEM */
MPS_API mps_status mps_motion_table_set(mps_sim *sim, int64_t rows, const double *t, int32_t dofs,
                                        const int32_t *dof, const double *values);

/** Pose, rates and accelerations at a time; a smooth function of t only. `state` is initialised to
 *  zero on entry. @return 0; non-zero: the step fails with MPS_E_PLUGIN */
typedef int (*mps_motion_fn)(void *user, double t, mps_motion_state *state);

/** Motion by callback. It sets no time-step limit: set mps_time_control.dt_max to a twentieth of
 *  its shortest period.
 *  @return MPS_E_ARG, MPS_E_BUSY, MPS_E_PLUGIN (the callback fails at the current time) */
MPS_API mps_status mps_motion_callback_set(mps_sim *sim, mps_motion_fn fn, void *user);

/** End the motion; the tank remains at its current pose. @return MPS_E_BUSY */
MPS_API mps_status mps_motion_clear(mps_sim *sim);

/** Pose at the current time. @param state  initialised by mps_motion_state_init(); out
 *  @return MPS_E_ARG */
MPS_API mps_status mps_motion_state_get(const mps_sim *sim, mps_motion_state *state);

/** Pose, rates and accelerations of the motion at any time, as mps_run() uses them: of a table by
 *  its spline, of harmonics with their ramps. Without a motion: the current pose.
 *  @param t      [s], finite; before the first row of a table: the first row
 *  @param state  initialised by mps_motion_state_init(); out
 *
 *  | error | reason; `state` is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | t is not finite; `state` was not initialised |
 *  | MPS_E_STATE | a body carries the tank, so its motion is not known in advance; t is after |
 *  | | the last row of a table or the pose of mps_motion_pose_set() |
 *  | MPS_E_PLUGIN | the callback fails at t |
 *  | MPS_E_BUSY | called from a verb or a callback | */
MPS_API mps_status mps_motion_state_at(mps_sim *sim, double t, mps_motion_state *state);

/** Map a point from the frame of the tank to the lab at the current time.
 *  @param tank      [dim] [m], finite
 *  @param lab       [dim] out [m]
 *  @param velocity  NULL, or [dim] out: velocity of the tank at this point [m/s]
 *  @return MPS_E_ARG */
MPS_API mps_status mps_motion_to_lab(const mps_sim *sim, const double *tank, double *lab,
                                     double *velocity);

MPS_END_DECLS

#endif
