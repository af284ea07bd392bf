/* SPDX-License-Identifier: BSD-3-Clause */
/** @file motion.h  Rigid motion of the tank: six degrees of freedom about a given centre.
 *
 *  x(t) = c + d(t) + R(t) (X - c), R = Rz(yaw) Ry(pitch) Rx(roll). In 2-D only d[0], d[1] and yaw (about z) exist; a
 *  motion in another direction is refused. All walls, probes and gauges move with the tank. Setting a motion carries the
 *  tank and its liquid to the motion's pose at the present time; between steps it should go on from the pose there is. */
#ifndef MPS_MOTION_H
#define MPS_MOTION_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Degrees of freedom in tables and harmonics. */
enum { MPS_SURGE = 0, MPS_HEAVE = 1, MPS_SWAY = 2, MPS_ROLL = 3, MPS_YAW = 4, MPS_PITCH = 5, MPS_DOF_COUNT = 6 };
/* along x, y (up), z; about x, z, y. */

/** Pose and its first two derivatives, one entry for each degree of freedom [m, rad; per s; per s2]. */
typedef struct mps_motion_state {
    double value[MPS_DOF_COUNT]; /**< displacement and angles */
    double rate[MPS_DOF_COUNT];  /**< first derivative */
    double accel[MPS_DOF_COUNT]; /**< second derivative */
} mps_motion_state;

/** How the motion begins. */
enum {
    MPS_START_AT_REST = 0,  /**< walls jump to their velocity, the liquid is at rest in the lab (the papers, default) */
    MPS_START_WITH_TANK = 1 /**< the liquid takes the tank's velocity when the first step with this motion begins */
};

/** Centre of rotation [m], in the tank's frame, and the start convention; before the first step. Default: origin, at rest. */
MPS_API mps_status mps_motion_centre_set(mps_sim *sim, const double *centre, int32_t start);

/** One harmonic: A sin(w t + phi) or -A (1 - cos w t). */
typedef struct mps_harmonic {
    int32_t dof;      /**< MPS_SURGE ... */
    int32_t form;     /**< 0: A sin(w t + phase); 1: -A (1 - cos(w t)), phase unused */
    double amplitude; /**< A [m or rad] */
    double omega;     /**< w [rad/s], >= 0 */
    double phase;     /**< [rad] */
} mps_harmonic;

/** Sum of harmonics; copied. @param count >= 1 */
MPS_API mps_status mps_motion_harmonics_set(mps_sim *sim, int32_t count, const mps_harmonic *harmonics);

/** Motion from a table, interpolated by a natural cubic spline (C2); copied. Its accelerations at the first and last row are zero, its
 *  velocities there are not: a tank that is to stop needs some rows of equal values at the end.
 *
 *  A step that would end beyond the last row by more than 1e-9 s is not done: MPS_E_STATE, and the simulation can go on with another
 *  motion. mps_run() to the time of the last row meets it exactly; mps_step() does not cut its step to it, but takes at most the dt_max it
 *  is given. mps_motion_clear() then leaves the tank where it is, at once without velocity.
 *  @param rows    >= 2
 *  @param t       [rows] strictly increasing, t[0] <= present time [s]
 *  @param dofs    number of columns, 1..6
 *  @param dof     [dofs] which degree of freedom each column is
 *  @param values  [rows*dofs] row by row [m, rad]
 *  @return MPS_E_ARG naming the first bad row */
MPS_API mps_status mps_motion_table_set(mps_sim *sim, int64_t rows, const double *t, int32_t dofs, const int32_t *dof,
                                        const double *values);

/** Pose, rates and accelerations at a time; must be smooth and a function of t alone. Non-zero: failed (MPS_E_PLUGIN). */
typedef int (*mps_motion_fn)(void *user, double t, mps_motion_state *state);

/** Motion by callback; `state` arrives zeroed. */
MPS_API mps_status mps_motion_callback_set(mps_sim *sim, mps_motion_fn fn, void *user);

/** No motion from now on; the tank stays where it is. */
MPS_API mps_status mps_motion_clear(mps_sim *sim);

/** Pose at the present time. */
MPS_API mps_status mps_motion_state_get(const mps_sim *sim, mps_motion_state *state);

/** Map a point of the tank's frame to the lab at the present time, with the velocity of the tank there.
 *  @param tank [dim] @param lab [dim] out @param velocity NULL or [dim] out */
MPS_API mps_status mps_motion_to_lab(const mps_sim *sim, const double *tank, double *lab, double *velocity);

MPS_END_DECLS

#endif
