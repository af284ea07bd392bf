/* SPDX-License-Identifier: BSD-3-Clause */
/** @file body.h  A rigid body that carries the tank: the library solves its motion together with
 *  the liquid. mps_run() and mps_step() then move the tank.
 *
 *  The degrees of freedom q are those of <mps/motion.h>: x, y, z of the centre of motion c and
 *  three angles. Some are free, the others are fixed. In the axes of the lab, with the acceleration
 *  a of c, the angular velocity w, its derivative w', and the vector r from c to the centre of
 *  mass,
 *
 *    m b = force of all loads,   b = a + w' x r + w x (w x r),
 *    I w' + w x I w + r x m b = moment of all loads about c,
 *    loads = F + weight + external load - K (q - q_0) - C dq/dt,
 *
 *  along the free degrees of freedom k, with an additional dry friction (Coulomb) f_k of each:
 *
 *    f_k = -F_k sign(dq_k/dt) if it moves; |f_k| <= F_k if it sticks,
 *
 *  so that a degree of freedom sticks as long as the magnitude of the other loads is at most F_k. I
 *  is the inertia about the centre of mass. F is the load of the liquid, mps_load. It depends on
 *  the acceleration of the same step, F = F0 - A a, so a follows from (M + A) a = F0 + other loads:
 *  one more solution of the pressure equation for each free degree of freedom, with the matrix of
 *  the step. Pressures, walls and liquid of the step then use this acceleration. There is no
 *  iteration and no repeated step. The mass may be 0, or much less than that of the liquid.
 *
 *  A mean velocity over a step is that of its midpoint. K and C are evaluated there too: springs
 *  use the mean of three poses, (q_before + 2 q + q_next)/4, without numerical damping, for any
 *  time step. Friction is implicit (Moreau's time stepping): rates and friction loads of a step are
 *  solved together, with the load of the liquid, and the sign is that of the new rate. A degree of
 *  freedom that sticks has exactly the rate 0; there is no threshold speed. Collisions of spray
 *  load the walls after the pressures are known: this load acts on the body in the next step, so
 *  that it receives all of mps_load.force. Walls that separate from the liquid because the
 *  acceleration has changed separate in the next step, too. */
#ifndef MPS_BODY_H
#define MPS_BODY_H

#include <mps/motion.h>

MPS_BEGIN_DECLS

/** Bit of a degree of freedom in mps_body.free, e.g. MPS_BODY_FREE(MPS_MOVE_X). */
#define MPS_BODY_FREE(dof) (1 << (dof))

/** External load on the body in addition to liquid, weight, springs and dampers, e.g. of waves or
 *  of a test rig. Called once per step on each rank, with the time and the state at its beginning.
 *  It must return the same values on all ranks.
 *  @param state  pose, velocity and the acceleration of the last step
 *  @param load   out, 0 on entry: force [N] and moment about the centre of motion [N m], axes of
 *                the lab; per metre of width in 2-D
 *  @return 0; non-zero: the step fails with MPS_E_PLUGIN */
typedef int (*mps_body_load_fn)(void *user, double t, const mps_motion_state *state,
                                double load[6]);

/** A rigid body. In 2-D all masses, loads and stiffnesses are per metre of width. The liquid is not
 *  included. */
typedef struct mps_body {
    /** Set by mps_body_init(). */
    uint32_t struct_size;
    /** Degrees of freedom that are free: a sum of MPS_BODY_FREE(MPS_...), at least one. In 2-D only
     *  MPS_MOVE_X, MPS_MOVE_Y and MPS_ROTATE_Z. The others remain at their current values. */
    int32_t free;
    /** m, >= 0 [kg]. */
    double mass;
    /** Centre of mass in the frame of the tank [m]. */
    double centre_of_mass[3];
    /** I about the centre of mass in axes of the tank, row by row [kg m2]; symmetric, no negative
     *  moment about any axis. In 2-D only the last entry may differ from 0. */
    double inertia[9];
    /** K, row by row: loads along the degrees of freedom (rows) by displacements (columns) [N/m, N,
     *  N m]; finite, any sign. */
    double stiffness[36];
    /** C, row by row: loads along the degrees of freedom by rates [N s/m, N s, N m s]; finite, any
     *  sign. */
    double damping[36];
    /** q_0: position without spring loads [m, rad]. */
    double equilibrium[6];
    /** NULL: no external load. */
    mps_body_load_fn load;
    /** Passed to `load`. */
    void *user;
    /** 1 (default): m g acts at the centre of mass; 0: it does not, e.g. because buoyancy balances
     *  it. The weight of the liquid always acts. */
    int32_t gravity;
    /** Kept 0. */
    int32_t reserved;
    /** F_k: dry friction along each degree of freedom, >= 0 [N, N m]; ignored if it is not free. 0
     *  (default): none. */
    double friction[6];
} mps_body;

/** Set struct_size, gravity = 1 and zero. @param size  sizeof(mps_body)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_body_init(mps_body *body, size_t size);

/** Move the tank with a rigid body. The body replaces the motion and starts from its pose and
 *  rates; rates of degrees of freedom that are not free become 0. The next motion that is set
 *  replaces the body. To start from another pose, first set a motion with this pose.
 *
 *  From then on each step computes the added mass of the free degrees of freedom; mps_load_get()
 *  returns the load of every step, and all of A only with MPS_LOAD_MASS of mps_load_watch(). The
 *  first call allocates 8 bytes per particle and degree of freedom; snapshots that were taken
 *  before cannot be restored after it. Snapshots and checkpoints save the motion and the energies
 *  of the body, not `body` itself: set it again before you read a checkpoint.
 *
 *  A body does not limit the time step. Set mps_time_control.dt_max to a twentieth of the shortest
 *  period of the body and of its load.
 *  @param body  initialised by mps_body_init(); copied. NULL: remove the body; the tank remains at
 *               its current pose, as after mps_motion_clear()
 *
 *  | error | reason; the motion is unchanged |
 *  |---|---|
 *  | MPS_E_ARG | a member of `body`; the text names it |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory |
 *  | MPS_E_STATE | particles are collected (mps_particles_collect()) |
 *
 *  | error of mps_step(), mps_run() | reason; the state is that before the step |
 *  |---|---|
 *  | MPS_E_STATE | the models have no added mass (presets imps and mmps have one); a model |
 *  | | moves solids in the tank; a free degree of freedom has no mass (singular M + A); two of the
 *  |
 *  | | angles have one axis, MPS_ROTATE_Z = +-pi/2 |
 *  | MPS_E_DIVERGED | the walls move farther in one step than a spacing from where the last |
 *  | | acceleration predicts: reduce the time step |
 *  | MPS_E_PLUGIN | `load` failed or returned a non-finite value | */
MPS_API mps_status mps_body_set(mps_sim *sim, const mps_body *body);

/** State, loads and energies of the body in the last step. */
typedef struct mps_body_report {
    /** Set by mps_body_report_init(). */
    uint32_t struct_size;
    /** out: mps_body.free. */
    int32_t free;
    /** out: degrees of freedom q at the end of the step [m, rad]. */
    double pose[6];
    /** out: rates, (q - q before)/dt [m/s, rad/s]. */
    double velocity[6];
    /** out: change of the rates over dt [m/s2, rad/s2]. */
    double acceleration[6];
    /** out: load of the liquid in the equations of motion: force [N] and moment about the centre of
     *  motion [N m], axes of the lab. */
    double liquid[6];
    /** out: load of mps_body.load. */
    double external[6];
    /** out: -K (q - q_0) - C dq/dt, along the degrees of freedom. */
    double restoring[6];
    /** out: A, row by row, as in mps_load; columns that no free degree of freedom needs are 0. */
    double mass[36];
    /** out: part of the load of the liquid in this step that acts on the body in the next step [N,
     *  N m]. */
    double late[6];
    /** out: iterations of the solver for A. */
    int32_t iterations;
    /** Kept 0. */
    int32_t reserved;
    /** out: kinetic energy of the body, from `velocity` [J]. */
    double kinetic;
    /** out: q' K q'/2 with q' = q - q_0 at the midpoint of the step [J]. */
    double spring;
    /** out: potential energy of the weight, -m g times the displacement of the centre of mass since
     *  mps_body_set() [J]. */
    double weight;
    /** out: energy that C has dissipated since mps_body_set() [J]. */
    double damped;
    /** out: work of the external load since then [J]. */
    double external_work;
    /** out: work of the liquid on the body since then [J]. */
    double liquid_work;
    /** out: kinetic + spring + weight at mps_body_set() [J]. Later kinetic + spring + weight =
     *  start + external_work + liquid_work - damped - rubbed: exact for translations in steps of
     *  equal length, else to second order in dt. */
    double start;
    /** out: load of friction along the degrees of freedom [N, N m]. */
    double friction[6];
    /** out: energy that friction has dissipated since mps_body_set() [J]. */
    double rubbed;
} mps_body_report;

/** Set struct_size and zero. @param size  sizeof(mps_body_report) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_body_report_init(mps_body_report *report, size_t size);

/** Report on the body in the last step, the same on all ranks.
 *  @param report  initialised by mps_body_report_init(); out
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | report was not initialised |
 *  | MPS_E_STATE | no body carries the tank |
 *  | MPS_E_BUSY | called from a verb or a callback | */
MPS_API mps_status mps_body_get(mps_sim *sim, mps_body_report *report);

MPS_END_DECLS

#endif
