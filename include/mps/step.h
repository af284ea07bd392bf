/* SPDX-License-Identifier: BSD-3-Clause */
/** @file step.h  Advance in time; results of a step; the monitor.
 *
 *  W22: Wen, Zhao & Wan (2022). */
#ifndef MPS_STEP_H
#define MPS_STEP_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Time-step control: dt is the smallest of all limits. cfl, gravity, viscous and dt_max are off
 *  where they are 0 or less; of cfl, gravity and dt_max one must be on. Zero is not the default:
 *  begin with mps_time_control_init(). */
typedef struct mps_time_control {
    /** Set by mps_time_control_init(). */
    uint32_t struct_size;
    /** > 0: fixed step [s], the other entries are ignored; 0 (default): adaptive. A warning is
     *  logged once when fluid moves more than dp in a fixed step. */
    double dt;
    /** dt |u|max / dp; default 0.3. |u|max: of the fluid relative to the tank, of the change of the
     *  walls' velocity in the step to come, and of the fluid relative to the walls then; a uniform
     *  motion of the tank with its liquid does not limit steps. Besides, a motion of the tank
     *  limits adaptive steps so that none misses a part of it (mps/motion.h). */
    double cfl;
    /** dt U_g / dp, U_g the velocity scale; default 0.06. */
    double gravity;
    /** dt nu / dp^2; default 0.2. */
    double viscous;
    /** Largest dt / previous dt, > 1; default 1.1; < 0: no limit. Steps cut by dt_max, here or of
     *  mps_step(), do not count as previous. */
    double growth;
    /** Longest step [s]; default 0: no limit; may be below dt_min. */
    double dt_max;
    /** If all other limits give less, the step fails with MPS_E_DIVERGED [s], >= 0; 0 (default):
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
    /** Lists, sorting. */
    MPS_STAGE_NEIGHBOURS = 0,
    /** Number density, free surface, forces, source. */
    MPS_STAGE_OPERATORS = 1,
    /** Matrix and preconditioner. */
    MPS_STAGE_PPE_SETUP = 2,
    /** Solution. */
    MPS_STAGE_PPE_SOLVE = 3,
    /** Gradient, move, collisions, shift. */
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
    /** |u|max of the fluid relative to the rigid tank at its place [m/s]: liquid that moves or
     *  turns with its tank has 0. */
    double max_speed;
    /** True relative 2-norm of the residual. */
    double ppe_residual;
    /** Largest residual as divergence times dt. */
    double ppe_divergence;
    /** Rows of the pressure equation. */
    int64_t ppe_unknowns;
    /** Particles removed since creation. */
    int64_t lost;
    /** Free-surface particles. */
    int64_t surface;
    /** Wall clock by stage [s]. */
    double seconds[MPS_STAGE_COUNT];
    /** dp/u [s], u the speed of the fastest piece of the liquid (fluid at least half as dense as
     *  the densest phase): pressures that change faster depend on the time step. u = max_i u_i,
     *  u_i the N-th largest speed within re_near of particle i, itself included, at most its own;
     *  N the particles that a film of two rows has within re_near of one of its own, 8 in 2-D and
     *  22 in 3-D with re_near = 2.1 dp. So a film of two rows counts, spray does not: drops of
     *  fewer than N particles, single particles. At most dp/(5 U_g); in calm liquid, where |u|max
     *  < U_g, |u|max/U_g times that. Its rate of change is at most 0.1. */
    double crossing_time;
    /** Solutions of the pressure equation: 2 beside void, more while liquid separates from
     *  walls. */
    int32_t ppe_solves;
    /** Wall particles at their least pressure, from which the liquid may separate. */
    int32_t separated;
    /** Name of the limit that chose dt:
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
     *  A constant of the library or of the plug-in that brings the model. */
    const char *limit;
    /** Pockets of trapped gas, of the model gas.pocket. */
    int32_t pockets;
    /** Kept 0. */
    int32_t reserved;
    /** Volume of all pockets at the end of the step [m3, m2 in 2-D]. */
    double pocket_volume;
    /** Pressure of the pocket that is farthest from the ambient pressure, less that [Pa]. */
    double pocket_pressure;
} mps_step_info;

/** Set struct_size and zero. @param size  sizeof(mps_step_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_step_info_init(mps_step_info *info, size_t size);

/** Results of the last step again; all 0 before the first step of this handle, also after
 *  mps_checkpoint_read().
 *  @param info  initialised by mps_step_info_init(); out
 *  @return MPS_E_ARG, MPS_E_BUSY (called from a verb or a callback) */
MPS_API mps_status mps_step_info_get(mps_sim *sim, mps_step_info *info);

/** Advance by one step of at most dt_max. W22 section 2.5 and Fig. 2. After an error positions,
 *  velocities, pressures and time are as before the call, and particles lost in it are back.
 *  @param sim     has at least one fluid particle
 *  @param dt_max  upper bound of the step [s], > 0 and finite; the step taken is info->dt
 *  @param info    NULL, or initialised by mps_step_info_init(); out
 *
 *  | status | reason |
 *  |---|---|
 *  | MPS_W_NOT_CONVERGED | the step was done; the pressure residual stayed above its tolerance |
 *  | MPS_E_ARG | dt_max; info is not initialised |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_DIVERGED | not finite, or faster than mps_config.speed_limit; a step below dt_min (the |
 *  | | text names the limit that decided, and its value); |
 *  | | fluid would pass through walls and dummies, 1 + dummy_layers spacings (with a fixed |
 *  | | step, a cfl that is off or above 1, or a plug-in among the models) |
 *  | MPS_E_LOST | a particle left the domain or the tank, with MPS_LOST_ERROR |
 *  | MPS_E_SOLVER | the pressure solver failed |
 *  | MPS_E_PLUGIN | a model cannot continue, e.g. no gas, or faster than sound; a plug-in failed |
 *  | MPS_E_STATE | no fluid; models without an order; the end of a motion table; a nonlinear gas |
 *  | | with a linear solver |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_step(mps_sim *sim, double dt_max, mps_step_info *info);

/** Called after every step of mps_run(); non-zero stops the run, in C++ and Python true. It may
 *  call functions that change nothing: getters, lists, leases for reading, stencils, probes,
 *  energies, frames, mps_checkpoint_write(), and mps_probe_series_clear(). Functions that change
 *  the simulation return MPS_E_BUSY; mps_sim_destroy() does nothing. A lease that is open when the
 *  monitor returns ends the run with MPS_E_BUSY. */
typedef int (*mps_monitor_fn)(void *user, mps_sim *sim, const mps_step_info *info);

/** Step until t_end; the last step is cut so that t_end is met exactly. Where t_end is the present
 *  time but for rounding, 1e-12 max(1 s, |t_end|), no step is taken. After MPS_OK and
 *  MPS_W_NOT_CONVERGED mps_sim_time() is t_end, to the last bit.
 *  @param t_end  finite, not before the present time but for this rounding [s]
 *  @param monitor  NULL, or the callback
 *  @return MPS_OK, MPS_W_STOPPED, MPS_W_NOT_CONVERGED (if any step was), or the error of the
 *          failing step */
MPS_API mps_status mps_run(mps_sim *sim, double t_end, mps_monitor_fn monitor, void *user);

MPS_END_DECLS

#endif
