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
 *  come and gone since. Leases, pointers of mps_probe_series() and mps_model_state() end. On failure
 *  the simulation is as before.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | snapshot is NULL |
 *  | MPS_E_STATE | nothing was taken; geometry, models or user fields changed since (the text says |
 *  | | which); particles are gathered |
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
 *  | MPS_E_ARG | t_end; `state` is not finite, has a degree of freedom that 2-D lacks, or moves the |
 *  | | tank farther than 1e9 dp |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_motion_pose_set(mps_sim *sim, double t_end, const mps_motion_state *state);

MPS_END_DECLS

#endif
