/* SPDX-License-Identifier: BSD-3-Clause */
/** @file body.h  A rigid body that carries the tank: the library solves its motion together with
 *  the liquid. mps_run() and mps_step() then move the tank by themselves.
 *
 *  The degrees of freedom q are those of <mps/motion.h>: x, y, z of the centre of motion c and
 *  three angles. Some are free, the others stay where they are. In the axes of the lab, with the
 *  acceleration a of c, the angular velocity w, its change w', and the way r from c to the centre
 *  of mass,
 *
 *    m b = force of all loads,   b = a + w' x r + w x (w x r),
 *    I w' + w x I w + r x m b = moment of all loads about c,
 *    loads = F + weight + external load - K (q - q_0) - C dq/dt,
 *
 *  along the free degrees, with dry friction (Coulomb) f_k of each degree beside them:
 *
 *    f_k = -F_k sign(dq_k/dt) where it moves; |f_k| <= F_k where it rests,
 *
 *  so that a degree rests as long as F_k holds the other loads. I is the inertia about the centre
 *  of mass. F is the load of the liquid, mps_load. It depends on the acceleration of the same step,
 *  F = F0 - A a, so a follows from (M + A) a = F0 + other loads: one more solution of the pressure
 *  equation for each free degree, with the matrix of the step. Pressures, walls and liquid of the
 *  step then get that acceleration. Nothing is iterated and no step is done twice. The mass may be
 *  0, or much less than that of the liquid.
 *
 *  A mean velocity over a step belongs to its middle. So do K and C: springs act by the mean of
 *  three poses, (q_before + 2 q + q_next)/4, without numerical damping, in steps of any length.
 *  Friction acts by the sign that the rate of the step has with it (Moreau's time stepping): in
 *  each step the rates and the loads of friction are solved together, with those of the liquid. A
 *  degree that rests has the rate 0 exactly, and no speed is chosen below which it does.
 *  Collisions of spray load the walls after the pressures are known: that load acts on the body in
 *  the next step, so that it gets all of mps_load.force. Walls that separate from the liquid
 *  because the acceleration has changed separate in the next step, too. */
#ifndef MPS_BODY_H
#define MPS_BODY_H

#include <mps/motion.h>

MPS_BEGIN_DECLS

/** Bit of a degree of freedom in mps_body.free, e.g. MPS_BODY_FREE(MPS_MOVE_X). */
#define MPS_BODY_FREE(dof) (1 << (dof))

/** Load on the body beside the liquid, its weight, springs and dampers, e.g. of waves or of a rig.
 *  Called once a step, on each rank, with the time and the state at its beginning. On all ranks it
 *  must give the same values.
 *  @param state  place, velocity and the acceleration of the last step
 *  @param load   out, arrives as 0: force [N] and moment about the centre of motion [N m], axes of
 *                the lab; per metre of width in 2-D
 *  @return 0; non-zero: the step fails with MPS_E_PLUGIN */
typedef int (*mps_body_load_fn)(void *user, double t, const mps_motion_state *state,
                                double load[6]);

/** A rigid body. In 2-D all masses, loads and stiffnesses are per metre of width. It does not
 *  contain the liquid. */
typedef struct mps_body {
    /** Set by mps_body_init(). */
    uint32_t struct_size;
    /** Degrees of freedom that are free: a sum of MPS_BODY_FREE(MPS_...), at least one. In 2-D
     *  only MPS_MOVE_X, MPS_MOVE_Y and MPS_ROTATE_Z. The others keep the pose that they have. */
    int32_t free;
    /** m, >= 0 [kg]. */
    double mass;
    /** Centre of mass in the frame of the tank [m]. */
    double centre_of_mass[3];
    /** I about the centre of mass in axes of the tank, row by row [kg m2]; symmetric, no negative
     *  moment about any axis. In 2-D only the last entry is not 0. */
    double inertia[9];
    /** K, row by row: loads along the degrees of freedom (rows) by displacements (columns) [N/m, N,
     *  N m]; finite. Any sign. */
    double stiffness[36];
    /** C, likewise, by rates [N s/m, N s, N m s]. */
    double damping[36];
    /** q_0: where the springs have no load [m, rad]. */
    double equilibrium[6];
    /** NULL: no external load. */
    mps_body_load_fn load;
    /** Passed to `load`. */
    void *user;
    /** 1: m g acts at the centre of mass (default); 0: it does not, e.g. because buoyancy carries
     *  the body. The weight of the liquid always acts. */
    int32_t gravity;
    /** Kept 0. */
    int32_t reserved;
    /** F: dry friction along each degree of freedom, >= 0 [N, N m]; no effect where it is not
     *  free. 0 (default): none. */
    double friction[6];
} mps_body;

/** Set struct_size, gravity = 1 and zero. @param size  sizeof(mps_body)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_body_init(mps_body *body, size_t size);

/** Let a body carry the tank. The body replaces the motion and begins with its pose and rates;
 *  rates of degrees that are not free become 0. The next motion that is set replaces the body. To
 *  begin at another pose, set a motion that has this pose first.
 *
 *  Once set, the added mass of the free degrees is found in each step; mps_load_get() gives the
 *  load of all steps, and the whole A only with MPS_LOAD_MASS of mps_load_watch(). The first call
 *  gives each particle 8 bytes a degree of freedom, so that snapshots that were taken before it
 *  cannot be restored after it. Snapshots and checkpoints hold the motion of the body and its
 *  energies, not `body` itself: set it again before a checkpoint is read.
 *
 *  A body does not limit the time step. Set mps_time_control.dt_max to a twentieth of the shortest
 *  period of the body and of its load.
 *  @param body  initialised by mps_body_init(); copied. NULL: no body; the tank stays where it is,
 *               as after mps_motion_clear(), if a body carries it
 *
 *  | error | reason; the motion is as before |
 *  |---|---|
 *  | MPS_E_ARG | a member of `body`, which the text names |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory |
 *  | MPS_E_STATE | particles are gathered |
 *
 *  | error of mps_step(), mps_run() | reason; the state is as before the step |
 *  |---|---|
 *  | MPS_E_STATE | the models have no added mass (presets imps and mmps have one); a model |
 *  | | moves solids in the tank; nothing resists an acceleration along a free degree; two of the |
 *  | | angles are one, MPS_ROTATE_Z = +-pi/2 |
 *  | MPS_E_DIVERGED | the walls move farther in one step than a spacing from where the last |
 *  | | acceleration carries them: smaller steps are needed |
 *  | MPS_E_PLUGIN | `load` failed or gave what is not finite | */
MPS_API mps_status mps_body_set(mps_sim *sim, const mps_body *body);

/** What the body did in the last step. */
typedef struct mps_body_report {
    /** Set by mps_body_report_init(). */
    uint32_t struct_size;
    /** out: mps_body.free. */
    int32_t free;
    /** out: degrees of freedom q at the end of the step [m, rad]. */
    double pose[6];
    /** out: their rates, (q - q before)/dt [m/s, rad/s]. */
    double velocity[6];
    /** out: change of the rates over dt [m/s2, rad/s2]. */
    double acceleration[6];
    /** out: load of the liquid that moved the body: force [N] and moment about the centre of motion
     *  [N m], axes of the lab. */
    double liquid[6];
    /** out: what mps_body.load gave. */
    double external[6];
    /** out: -K (q - q_0) - C dq/dt, along the degrees of freedom. */
    double restoring[6];
    /** out: A, row by row, as in mps_load; columns that no free degree needs are 0. */
    double mass[36];
    /** out: part of the liquid's load of this step that the body feels in the next one [N, N m]. */
    double late[6];
    /** out: iterations of the solver for A. */
    int32_t iterations;
    /** Kept 0. */
    int32_t reserved;
    /** out: kinetic energy of the body, of the rates above [J]. */
    double kinetic;
    /** out: q' K q'/2 of q' = q - q_0 in the middle of the step [J]. */
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

/** The body in the last step. On many ranks all have the same values.
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
