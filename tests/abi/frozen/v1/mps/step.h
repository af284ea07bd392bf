/* SPDX-License-Identifier: BSD-3-Clause */
/** @file step.h  Advance in time; results of a step; the monitor.
 *
 *  W22: Wen, Zhao & Wan (2022). */
#ifndef MPS_STEP_H
#define MPS_STEP_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Time-step control: dt is the smallest of all limits. cfl, gravity, viscous and dt_max are off if
 *  they are 0 or less; at least one of cfl, gravity and dt_max must be on. Zero is not the default:
 *  start with mps_time_control_init(). */
typedef struct mps_time_control {
    /** Set by mps_time_control_init(). */
    uint32_t struct_size;
    /** > 0: fixed step [s], the other entries are ignored; 0 (default): adaptive. A warning is
     *  logged once if fluid moves more than dp in a fixed step. */
    double dt;
    /** dt |u|max / dp; default 0.3. |u|max: largest speed of the fluid relative to the tank, of the
     *  change of wall velocities in the next step, and of the fluid relative to the walls after it;
     *  a uniform motion of the tank with its liquid does not limit steps. In addition, a motion of
     *  the tank limits adaptive steps so that they resolve it (mps/motion.h). */
    double cfl;
    /** dt U_g / dp, U_g the velocity scale; default 0.06. */
    double gravity;
    /** dt nu / dp^2; default 0.2. */
    double viscous;
    /** Largest dt / previous dt, > 1; default 1.1; < 0: no limit. Steps that are shortened by
     *  dt_max (here or of mps_step()) are not used as previous dt. */
    double growth;
    /** Longest step [s]; default 0: no limit; may be below dt_min. */
    double dt_max;
    /** If all other limits are smaller, the step fails with MPS_E_DIVERGED [s], >= 0; 0 (default):
     *  1e-9 sqrt(dp/9.81). It cannot be switched off. */
    double dt_min;
} mps_time_control;

/** Set every entry to its default. @param size  sizeof(mps_time_control)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_time_control_init(mps_time_control *control, size_t size);

/** Use a time-step control from the next step on. The growth limit does not apply to the first step
 *  after this call.
 *  @return MPS_E_ARG (which value, and what is allowed), MPS_E_BUSY (called from a monitor, a verb
 *          or a callback) */
MPS_API mps_status mps_time_control_set(mps_sim *sim, const mps_time_control *control);

/** Stages of a step, for timings. */
enum {
    /** Neighbour lists, sorting. */
    MPS_STAGE_NEIGHBOURS = 0,
    /** Number density, free surface, forces, source. */
    MPS_STAGE_OPERATORS = 1,
    /** Matrix and preconditioner. */
    MPS_STAGE_PPE_SETUP = 2,
    /** Solution of the pressure equation. */
    MPS_STAGE_PPE_SOLVE = 3,
    /** Gradient, motion of particles, collisions, shifting. */
    MPS_STAGE_CORRECT = 4,
    /** Number of stages. */
    MPS_STAGE_COUNT = 5
};

/** Results of the last step. */
typedef struct mps_step_info {
    /** Set by mps_step_info_init(). */
    uint32_t struct_size;
    /** Iterations of the pressure solver. */
    int32_t ppe_iterations;
    /** Number of this step, from 1. */
    int64_t step;
    /** Time reached [s]. */
    double t;
    /** Length of the step [s]. */
    double dt;
    /** dt |u|max / dp */
    double cfl;
    /** |u|max of the fluid relative to the rigid tank at the same position [m/s]: 0 for liquid that
     *  moves and rotates with the tank. */
    double max_speed;
    /** True relative 2-norm of the residual. */
    double ppe_residual;
    /** Largest residual as divergence times dt. */
    double ppe_divergence;
    /** Number of rows of the pressure equation. */
    int64_t ppe_unknowns;
    /** Particles removed since creation. */
    int64_t lost;
    /** Free-surface particles. */
    int64_t surface;
    /** Wall-clock time of each stage [s]. */
    double seconds[MPS_STAGE_COUNT];
    /** dp/u [s], u the speed of the fastest coherent liquid (fluid at least half as dense as the
     *  densest phase): pressures that change faster depend on the time step. u = max_i u_i, u_i the
     *  N-th largest speed within re_near of particle i, itself included, at most its own; N the
     *  particles that a film of two rows has within re_near of one of its own, 8 in 2-D and 22 in
     *  3-D with re_near = 2.1 dp. Therefore a film of two rows is included; spray, i.e. single
     *  particles and droplets of fewer than N particles, is not. At most dp/(5 U_g); in calm
     *  liquid, where |u|max < U_g, at most |u|max/U_g times this. Its rate of change is at most
     *  0.1. */
    double crossing_time;
    /** Number of solutions of the pressure equation: 2 if there is void, more while liquid
     *  separates from walls. */
    int32_t ppe_solves;
    /** Wall particles with an active constraint: at their lower bound of the pressure, where the
     *  liquid may separate. */
    int32_t separated;
    /** Name of the limit that determined dt:
     *
     *  | limit | set by |
     *  |---|---|
     *  | "cfl", "gravity", "viscous", "growth", "dt_max" | the entry of mps_time_control |
     *  | "walls" | mps_time_control.cfl: speed of walls, and of fluid relative to them |
     *  | "motion" | the motion of the tank, see mps_motion_table_set() |
     *  | e.g. "tension.jump" | the model of this name |
     *  | "fixed" | mps_time_control.dt |
     *  | "caller" | dt_max of mps_step(), t_end of mps_run() |
     *
     *  A static string of the library or of the plug-in of the model. */
    const char *limit;
    /** Number of pockets of trapped gas, of the model gas.pocket. */
    int32_t pockets;
    /** Kept 0. */
    int32_t reserved;
    /** Volume of all pockets at the end of the step [m3, m2 in 2-D]. */
    double pocket_volume;
    /** Gauge pressure of the largest magnitude of all pockets: pocket minus ambient [Pa]. */
    double pocket_pressure;
} mps_step_info;

/** Set struct_size and zero. @param size  sizeof(mps_step_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_step_info_init(mps_step_info *info, size_t size);

/** Results of the last step; all 0 before the first step of this handle, also after
 *  mps_checkpoint_read().
 *  @param info  initialised by mps_step_info_init(); out
 *  @return MPS_E_ARG, MPS_E_BUSY (called from a verb or a callback) */
MPS_API mps_status mps_step_info_get(mps_sim *sim, mps_step_info *info);

/** Advance by one step of at most dt_max. W22 section 2.5 and Fig. 2. After an error the state is
 *  that before the call: positions, velocities, pressures, time and particles that were lost in the
 *  step.
 *  @param sim     with at least one fluid particle
 *  @param dt_max  upper bound of the step [s], > 0 and finite; the step taken is info->dt
 *  @param info    NULL, or initialised by mps_step_info_init(); out
 *
 *  | status | reason |
 *  |---|---|
 *  | MPS_W_NOT_CONVERGED | the step is complete; the pressure residual exceeds its tolerance |
 *  | MPS_E_ARG | dt_max; info is not initialised |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_DIVERGED | a non-finite value; a speed above mps_config.speed_limit; a step below |
 *  | | dt_min (the text contains the limit and its value); |
 *  | | fluid would move through walls and dummies, 1 + dummy_layers spacings (with a fixed |
 *  | | step, a cfl that is off or above 1, or a plug-in among the models) |
 *  | MPS_E_LOST | a particle left the domain or the tank, with MPS_LOST_ERROR |
 *  | MPS_E_SOLVER | the pressure solver failed |
 *  | MPS_E_PLUGIN | a model cannot continue, e.g. no gas, supersonic gas; a plug-in failed |
 *  | MPS_E_STATE | no fluid; a cycle in the order of verbs; end of a motion table; a nonlinear gas
 *  |
 *  | | model with a linear solver |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_step(mps_sim *sim, double dt_max, mps_step_info *info);

/** Called after every step of mps_run(); non-zero (in C++ and Python: true) stops the run. It may
 *  call functions that do not change the simulation: getters, lists, leases for reading, stencils,
 *  probes, energies, frames, mps_checkpoint_write(), and mps_probe_series_clear(). Functions that
 *  change the simulation return MPS_E_BUSY; mps_sim_destroy() does nothing. If a lease is open when
 *  the monitor returns, the run ends with MPS_E_BUSY. */
typedef int (*mps_monitor_fn)(void *user, mps_sim *sim, const mps_step_info *info);

/** Step until t_end; the last step is shortened so that it ends at t_end. If t_end is the current
 *  time within rounding, 1e-12 max(1 s, |t_end|), no step is done. After MPS_OK and
 *  MPS_W_NOT_CONVERGED mps_sim_time() is bitwise t_end.
 *  @param t_end  finite, not before the current time within this rounding [s]
 *  @param monitor  NULL, or the callback
 *  @return MPS_OK, MPS_W_STOPPED, MPS_W_NOT_CONVERGED (in at least one step), or the error of the
 *          failed step */
MPS_API mps_status mps_run(mps_sim *sim, double t_end, mps_monitor_fn monitor, void *user);

MPS_END_DECLS

#endif
