/* SPDX-License-Identifier: BSD-3-Clause */
/** @file couple.h  Couple the tank to a body that another program computes: go back a step, move
 *  the tank to a pose, read the load and the added mass of the liquid.
 *
 *  A host that iterates a step:
 *
 *    mps_snapshot_take(snapshot);
 *    for (;;) {
 *        mps_motion_pose_set(sim, t_end, &pose);    where the body is at t_end
 *        mps_run(sim, t_end, NULL, NULL);
 *        ... load of the liquid, and the pose that the body has under it: is it the same?
 *        mps_snapshot_restore(snapshot);            once more
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
 *  It is about 150 bytes a particle, beside samples of probes. Take and restore are copies: a few
 *  per cent of a step. Where the library has searched neighbours after the snapshot was taken, the
 *  next step after restoring searches again.
 *
 *  Nothing is compared, neither pose nor settings: settings of models and of the solver, motions
 *  (but for the way of mps_motion_pose_set()), the time control and phases stay as they are. What
 *  a plug-in, a motion callback or a solver of the user keeps outside of channels and numbers of
 *  models does not come back; the log does not either. Probes that were added later begin anew.
 *
 *  On many ranks all ranks make these calls. */
typedef struct mps_snapshot mps_snapshot;

/** Make an empty snapshot. There may be several.
 *  @param snapshot  out; destroy it with mps_snapshot_destroy(). The simulation must outlive it.
 *  @return MPS_E_ARG (snapshot is NULL), MPS_E_NOMEM, MPS_E_BUSY (called from a monitor, a verb or
 *          a callback), MPS_E_STATE (particles are gathered) */
MPS_API mps_status mps_snapshot_create(mps_sim *sim, mps_snapshot **snapshot);

/** Copy the present state into the snapshot, in place of what it holds. May be called by a monitor.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | snapshot is NULL |
 *  | MPS_E_BUSY | a field is leased for writing; called from a verb or a callback |
 *  | MPS_E_NOMEM | no memory; the snapshot is empty then |
 *  | MPS_E_STATE | particles are gathered |
 *  | MPS_E_RANKS | another rank failed | */
MPS_API mps_status mps_snapshot_take(mps_snapshot *snapshot);

/** Give the simulation the state that the snapshot holds, as often as wanted. Particles may have
 *  come and gone since. Pointers of mps_probe_series() and mps_model_state() end. On failure the
 *  simulation is as before.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | snapshot is NULL |
 *  | MPS_E_STATE | nothing was taken; geometry, models or user fields changed since (the text |
 *  | | says which); particles are gathered |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory |
 *  | MPS_E_RANKS | another rank failed | */
MPS_API mps_status mps_snapshot_restore(mps_snapshot *snapshot);

/** Free a snapshot. NULL is allowed. */
MPS_API void mps_snapshot_destroy(mps_snapshot *snapshot);

/* ---- motion by poses ------------------------------------------------------------------------- */

/** Move the tank from its present pose to this one, where it is at t_end. It is a motion like those
 *  of <mps/motion.h>: it takes the place of the present one, and the next one takes its place. In
 *  each degree of freedom, with s = (t - t0)/(t_end - t0) from the time t0 of this call,
 *
 *    q(t) = c0 + c1 s + c2 s^2 + c3 s^3 + c4 s^4 + c5 s^5
 *
 *  has value, rate and acceleration of the present pose at t0 and those of `state` at t_end. Walls
 *  have the velocity (pose at the end of a step - pose at its beginning)/dt, so that with one step
 *  to t_end rates and accelerations of `state` do not matter for the liquid.
 *
 *  mps_run() to t_end meets t_end exactly. A step beyond t_end fails with MPS_E_STATE; then set the
 *  next pose. With MPS_START_WITH_TANK the liquid takes the velocity of the first pose that is set
 *  after another motion or none, not of those that follow it.
 *  @param t_end  [s], after the present time
 *  @param state  initialised by mps_motion_state_init(), finite; copied
 *
 *  | error | reason; the motion is as before |
 *  |---|---|
 *  | MPS_E_ARG | t_end; `state` is not finite, has a degree of freedom that 2-D lacks, or moves |
 *  | | the tank farther than 1e9 dp |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_motion_pose_set(mps_sim *sim, double t_end, const mps_motion_state *state);

/* ---- load and added mass --------------------------------------------------------------------- */

/** What steps find out for mps_load_get(). */
enum {
    /** Nothing (default). */
    MPS_LOAD_NONE = 0,
    /** The load: about 2 % of a step. */
    MPS_LOAD_FORCE = 1,
    /** The load and the added mass: one more solution of the pressure equation for each degree of
     *  freedom, with the matrix and the preconditioner of the step. */
    MPS_LOAD_MASS = 2
};

/** Choose what the next steps find out. It is a setting: snapshots and checkpoints do not hold it.
 *  The first call with MPS_LOAD_MASS gives each particle 8 bytes a degree of freedom; snapshots
 *  that were taken before it cannot be restored after it.
 *
 *  The added mass needs a pressure equation in the frame of the tank (source.volume, so the presets
 *  imps and mmps); otherwise the step fails with MPS_E_STATE.
 *  @param what  MPS_LOAD_...
 *  @return MPS_E_ARG, MPS_E_NOMEM, MPS_E_BUSY (a lease is open; called from a monitor, a verb or a
 *          callback), MPS_E_STATE (particles are gathered) */
MPS_API mps_status mps_load_watch(mps_sim *sim, int32_t what);

/** Load of the liquid on the tank in the last step, per metre of width in 2-D, axes of the lab.
 *
 *  F is what the momentum of the liquid lacks. The liquid ends where the pressure equation ends it:
 *  at walls, before which half cells have no particles, and at the centres of surface particles, of
 *  which half a cell counts. With masses m_i and velocities u_i of particles i, and half cells h at
 *  wetted walls,
 *
 *    F = sum_i m_i (g - (u_i(t) - u_i(t - dt))/dt) + sum_h m_h (g - a_h),
 *
 *  m_i = rho dp^dim, half of it on the surface, m_h = rho dp/2 times the wetted area (a quarter of
 *  a cell where two walls of a tank meet, an eighth where three meet; three quarters at an edge of
 *  a block, seven eighths at its corner), a_h the acceleration of the wall along its normal and of
 *  the liquid beside it along the face. The moment likewise, about the place that the centre has at
 *  the beginning of the step. In a wave its part by the weight errs by a share of about dp over the
 *  size of the tank: half cells at the ends grow with the wave, whose liquid is in particles that
 *  came, and those on the floor do not move with it. F contains all that the liquid exchanges with
 *  solids: pressure, collisions, friction. It is the mean over this one step. Force probes
 *  (MPS_PROBE_FORCE) show pressures on walls instead, by default averaged over past steps: they
 *  must not drive a body.
 *
 *  With the acceleration a of the tank, the change of its velocity over dt,
 *
 *    F = F0 - A a.
 *
 *  A is the added mass, F0 the load without acceleration. F is linear in a as long as the same
 *  walls separate (separation.void), else to some per cent. With a compressible gas A is the
 *  tangent of one step and depends on dt: gas is compressed as far as sound travels in a step.
 *  A body of mass m that moves with the tank under other forces Q has m a = Q + F, so
 *  a = (Q + F0)/(m + A): with it a step may be done again, where with m a = Q + F alone it diverges
 *  for A > m.
 *
 *  The first step feels half of a jump of the velocity: start bodies at rest. Solids that models
 *  move in the tank (body.free) count as part of it. On many ranks all have the same values. */
typedef struct mps_load {
    /** Set by mps_load_init(). */
    uint32_t struct_size;
    /** out: 1: rest and mass are those of the last step; 0: MPS_LOAD_MASS was not chosen, or its
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
