/* SPDX-License-Identifier: BSD-3-Clause */
/** @file couple.h  Couple the tank to a rigid body that an application computes: restore a previous
 *  state, move the tank to a pose, read the load and the added mass of the liquid.
 *
 *  Iterated coupling:
 *
 *    mps_snapshot_take(snapshot);
 *    for (;;) {
 *        mps_motion_pose_set(sim, t_end, &pose);    pose of the body at t_end
 *        mps_run(sim, t_end, NULL, NULL);
 *        ... load of the liquid, new pose under this load: if converged, break
 *        mps_snapshot_restore(snapshot);            repeat the step
 *    } */
#ifndef MPS_COUPLE_H
#define MPS_COUPLE_H

#include <mps/motion.h>

MPS_BEGIN_DECLS

/* ---- snapshots ------------------------------------------------------------------------------- */

/** The state of a simulation in memory: particles, time, pose of the tank and jumps of its
 *  velocity, energies and momentum, averages and samples of probes, numbers of models, the last
 *  mps_step_info. A step after mps_snapshot_restore() gives the same bytes as a step after
 *  mps_snapshot_take(), with any number of threads and ranks.
 *
 *  Size: about 150 bytes per particle, plus samples of probes. Take and restore are copies and take
 *  a few per cent of a step. If a neighbour search took place after the snapshot was taken, the
 *  next step after restoring searches again.
 *
 *  Pose and settings are neither compared nor restored: settings of models and of the solver,
 *  motions (except the path of mps_motion_pose_set()), the time control and phases remain
 *  unchanged. Data that a plug-in, a motion callback or a solver of the user keeps outside of
 *  channels and numbers of models is not restored, nor is the log. Probes that were added later
 *  restart.
 *
 *  Collective on many ranks: all ranks make these calls. */
typedef struct mps_snapshot mps_snapshot;

/** Create an empty snapshot. Several may exist.
 *  @param snapshot  out; destroy it with mps_snapshot_destroy(). The simulation must outlive it.
 *  @return MPS_E_ARG (snapshot is NULL), MPS_E_NOMEM, MPS_E_BUSY (called from a monitor, a verb or
 *          a callback), MPS_E_STATE (particles are collected) */
MPS_API mps_status mps_snapshot_create(mps_sim *sim, mps_snapshot **snapshot);

/** Copy the current state into the snapshot; its previous state is overwritten. May be called by a
 *  monitor.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | snapshot is NULL |
 *  | MPS_E_BUSY | a field is leased for writing; called from a verb or a callback |
 *  | MPS_E_NOMEM | no memory; the snapshot is empty then |
 *  | MPS_E_STATE | particles are collected (mps_particles_collect()) |
 *  | MPS_E_RANKS | another rank failed | */
MPS_API mps_status mps_snapshot_take(mps_snapshot *snapshot);

/** Restore the state of the snapshot; may be repeated. Particles may have been added or removed
 *  since. Pointers of mps_probe_series() and mps_model_state() become invalid. On failure the
 *  simulation is unchanged.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | snapshot is NULL |
 *  | MPS_E_STATE | the snapshot is empty; geometry, models or user fields changed since (the text |
 *  | | says which); particles are collected |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory |
 *  | MPS_E_RANKS | another rank failed | */
MPS_API mps_status mps_snapshot_restore(mps_snapshot *snapshot);

/** Free a snapshot. NULL is allowed. */
MPS_API void mps_snapshot_destroy(mps_snapshot *snapshot);

/* ---- motion by poses ------------------------------------------------------------------------- */

/** Move the tank from its current pose at t0, the time of this call, to the given pose at t_end. It
 *  is a motion like those of <mps/motion.h>: it replaces the current motion, and the next motion
 *  replaces it. In each degree of freedom, with s = (t - t0)/(t_end - t0),
 *
 *    q(t) = c0 + c1 s + c2 s^2 + c3 s^3 + c4 s^4 + c5 s^5
 *
 *  has value, rate and acceleration of the current pose at t0 and those of `state` at t_end. Walls
 *  have the velocity (pose at the end of a step - pose at its beginning)/dt: with a single step to
 *  t_end, rates and accelerations of `state` do not affect the liquid.
 *
 *  mps_run() to t_end ends at t_end exactly. A step beyond t_end fails with MPS_E_STATE; then set
 *  the next pose. With MPS_START_WITH_TANK the liquid gets the velocity of the first pose that is
 *  set after another motion or none, not of later poses.
 *  @param t_end  [s], after the current time
 *  @param state  initialised by mps_motion_state_init(), finite; copied
 *
 *  | error | reason; the motion is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | t_end; `state` is not finite, uses a degree of freedom that 2-D lacks, or moves |
 *  | | the tank farther than 1e9 dp |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_motion_pose_set(mps_sim *sim, double t_end, const mps_motion_state *state);

/* ---- load and added mass --------------------------------------------------------------------- */

/** What steps compute for mps_load_get(). */
enum {
    /** Nothing (default). */
    MPS_LOAD_NONE = 0,
    /** The load: about 2 % of a step. */
    MPS_LOAD_FORCE = 1,
    /** The load and the added mass: one more solution of the pressure equation for each degree of
     *  freedom, with the matrix and the preconditioner of the step. */
    MPS_LOAD_MASS = 2
};

/** Set what the next steps compute. It is a setting: snapshots and checkpoints do not save it. The
 *  first call with MPS_LOAD_MASS allocates 8 bytes per particle and degree of freedom; snapshots
 *  that were taken before cannot be restored after it.
 *
 *  The added mass needs a pressure equation in the frame of the tank (source.volume, so the presets
 *  imps and mmps); otherwise the step fails with MPS_E_STATE.
 *  @param what  MPS_LOAD_...
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_BUSY (a lease is open; called from a monitor, a verb or a
 *          callback), MPS_E_STATE (particles are collected) */
MPS_API mps_status mps_load_watch(mps_sim *sim, int32_t what);

/** Load of the liquid on the tank in the last step, per metre of width in 2-D, axes of the lab.
 *
 *  F follows from the momentum balance of the liquid. Its boundaries are those of the pressure
 *  equation: walls, with half cells that have no fluid particles, and the centres of surface
 *  particles, of which half a cell is included. With masses m_i and velocities u_i of particles i,
 *  and half cells h at wetted walls,
 *
 *    F = sum_i m_i (g - (u_i(t) - u_i(t - dt))/dt) + sum_h m_h (g - a_h),
 *
 *  m_i = rho dp^dim, half of it on the surface, m_h = rho dp/2 times the wetted area (a quarter of
 *  a cell where two walls of a tank meet, an eighth where three meet; three quarters at an edge of
 *  a block, seven eighths at its corner), a_h the acceleration of the wall along its normal and of
 *  the adjacent liquid along the face. The moment is the corresponding sum, about the position of
 *  the centre at the beginning of the step. In a wave the moment of the weight has a relative error
 *  of about dp over the size of the tank: half cells at the end walls grow with the wave, although
 *  particles already contain its liquid, and half cells on the floor do not move with it. F
 *  contains all forces between liquid and solids: pressure, collisions, friction. It is the mean
 *  over this step. Force probes (MPS_PROBE_FORCE) measure pressures on walls instead, by default
 *  averaged over previous steps: do not use them as the load of a rigid body.
 *
 *  With the acceleration a of the tank, the change of its velocity over dt,
 *
 *    F = F0 - A a.
 *
 *  A is the added mass, F0 the load without acceleration. F is linear in a as long as the same
 *  walls separate (separation.void), otherwise within some per cent. With a compressible gas A is
 *  the tangent of one step and depends on dt: gas is compressed over the distance that sound
 *  travels in a step. A rigid body of mass m that moves with the tank under other forces Q has m a
 *  = Q + F, so a = (Q + F0)/(m + A). An iteration with this a converges; with a = (Q + F)/m it
 *  diverges for A > m.
 *
 *  The load of the first step contains half of a jump of the velocity: start rigid bodies at rest.
 *  Solids that models move in the tank (body.free) are part of the tank. On many ranks all ranks
 *  have the same values. */
typedef struct mps_load {
    /** Set by mps_load_init(). */
    uint32_t struct_size;
    /** out: 1: rest and mass are those of the last step; 0: MPS_LOAD_MASS was not set, or its
     *  solutions did not converge. */
    int32_t has_mass;
    /** out: force and moment about the centre, F [N, N m]. */
    double force[6];
    /** out: F0 [N, N m]; 0 without has_mass. */
    double rest[6];
    /** out: A, row by row [kg, kg m, kg m2]: rows are forces and moments, columns accelerations of
     *  the centre along x, y, z and angular accelerations about x, y, z. In 2-D only x, y and
     *  rotation about z are not 0. 0 without has_mass. */
    double mass[36];
    /** out: a of the centre [m/s2, rad/s2]. */
    double acceleration[6];
    /** out: length of the step [s]. */
    double dt;
    /** out: iterations of the solver for A. */
    int32_t iterations;
    /** Kept 0. */
    int32_t reserved;
} mps_load;

/** Set struct_size and zero. @param size  sizeof(mps_load) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_load_init(mps_load *load, size_t size);

/** Load on the tank in the last step.
 *  @param centre  [dim] of moments and accelerations, in the frame of the tank [m]; NULL: the
 *                 centre of mps_motion_centre_set()
 *  @param load    initialised by mps_load_init(); out
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | centre is not finite; load was not initialised |
 *  | MPS_E_STATE | no step since mps_load_watch(), or since a checkpoint without a load was read |
 *  | MPS_E_BUSY | called from a verb or a callback | */
MPS_API mps_status mps_load_get(mps_sim *sim, const double *centre, mps_load *load);

MPS_END_DECLS

#endif
