/* SPDX-License-Identifier: BSD-3-Clause */
/** @file step.h  Advance in time; what a step did; the monitor. */
#ifndef MPS_STEP_H
#define MPS_STEP_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Time step control. dt = min of all limits. cfl, gravity, viscous and dt_max are off where they are 0 or less; of cfl, gravity and
 *  dt_max one must be on. Zero is no default here: begin with mps_time_control_init(). */
typedef struct mps_time_control {
    uint32_t struct_size; /**< set by mps_time_control_init() */
    double dt;            /**< > 0: fixed step [s], the other entries are ignored; 0 (default): adaptive. A warning is logged once when
                               fluid moves more than dp in a fixed step */
    double cfl;     /**< dt |u|max / dp; default 0.3; |u| of the fluid, and of walls in the step to come, and of both against each other */
    double gravity; /**< dt U_g / dp, U_g the velocity scale; default 0.06 */
    double viscous; /**< dt nu / dp^2; default 0.2 */
    double
        growth; /**< largest dt / previous dt, > 1; default 1.1; < 0: no limit. Steps cut by dt_max, here or of mps_step(), do not count */
    double dt_max; /**< [s]; default 0: none; may be below dt_min */
    double dt_min; /**< if all other limits give less: MPS_E_DIVERGED [s], >= 0; default 0: 1e-9 sqrt(dp/9.81). It cannot be switched off */
} mps_time_control;

/** Defaults. */
MPS_API mps_status mps_time_control_init(mps_time_control *control, size_t size);

/** Use a time step control from the next step on, which does not count as growth of the one before.
 *  @return MPS_E_ARG (which value, and what is allowed) */
MPS_API mps_status mps_time_control_set(mps_sim *sim, const mps_time_control *control);

/** Stages of a step, for timings. */
enum {
    MPS_STAGE_NEIGHBOURS = 0, /**< lists, sorting */
    MPS_STAGE_OPERATORS = 1,  /**< number density, free surface, forces, source */
    MPS_STAGE_PPE_SETUP = 2,  /**< matrix and preconditioner */
    MPS_STAGE_PPE_SOLVE = 3,  /**< solution */
    MPS_STAGE_CORRECT = 4,    /**< gradient, move, collisions, shift */
    MPS_STAGE_COUNT = 5
};

/** What the last step did. */
typedef struct mps_step_info {
    uint32_t struct_size;            /**< set by mps_step_info_init() */
    int32_t ppe_iterations;          /**< of the pressure solver */
    int64_t step;                    /**< number of this step, from 1 */
    double t;                        /**< time reached [s] */
    double dt;                       /**< step taken [s] */
    double cfl;                      /**< dt |u|max / dp */
    double max_speed;                /**< |u|max of the fluid in the lab's frame [m/s] */
    double ppe_residual;             /**< relative 2-norm, true residual */
    double ppe_divergence;           /**< largest residual as divergence times dt */
    int64_t ppe_unknowns;            /**< rows of the pressure equation */
    int64_t lost;                    /**< particles removed since creation */
    int64_t surface;                 /**< free-surface particles */
    double seconds[MPS_STAGE_COUNT]; /**< wall clock by stage [s] */
    double crossing_time;            /**< dp/u, u = |u|max of the liquid (all that is half as dense as the densest phase or more): pressures
                                          that change faster depend on the time step. At most dp/(5 U_g); where u < U_g, in calm
                                          liquid, u/U_g times that. It changes by a tenth of the time that passes at most [s] */
    int32_t ppe_solves;              /**< solutions of the pressure equation: 2 beside void, more while walls let go of the liquid */
    int32_t separated;               /**< wall particles at their least pressure, that the liquid may leave */
} mps_step_info;

/** Set struct_size and zero. */
MPS_API mps_status mps_step_info_init(mps_step_info *info, size_t size);

/** Advance by one step of at most dt_max. W22 section 2.5 and Fig. 2.
 *  @param sim     simulation with no open lease (else MPS_E_BUSY) and at least one fluid particle
 *  @param dt_max  upper bound of the step [s], > 0 and finite; the step taken is info->dt
 *  @param info    NULL, or out, with struct_size set
 *  @return MPS_OK, MPS_W_NOT_CONVERGED; MPS_E_DIVERGED (what is not finite or faster than mps_config.speed_limit; a step below dt_min;
 *          with a fixed step, a cfl that is off or above 1, or a plug-in among the models: fluid that would move farther than walls and
 *          dummies are deep, 1 + dummy_layers spacings), MPS_E_LOST, MPS_E_SOLVER, MPS_E_NOMEM, MPS_E_PLUGIN (a model, built in or
 *          not, cannot go on: no gas, or faster than sound; a plug-in left a region or dt_limit that there is not), MPS_E_STATE (no
 *          fluid; rows of a nonlinear gas with a solver of linear ones); after an error positions, velocities, pressures and time are as
 *          before the call, and particles that were lost in it are back */
MPS_API mps_status mps_step(mps_sim *sim, double dt_max, mps_step_info *info);

/** Called after every step of mps_run(); non-zero stops the run. Refused there with MPS_E_STATE: mps_step(), mps_run(),
 *  mps_particles_add(), mps_particles_remove(), mps_field_add() and all of mps/geometry.h that adds particles. All else of this handle may
 *  be called as between two steps and holds from the next one on: probes, frames, leases (a lease that is still open when the
 *  monitor returns ends the run with MPS_E_BUSY), phases, models and their settings, motion, solver, threads, time control.
 *  mps_sim_destroy() must not be called. */
typedef int (*mps_monitor_fn)(void *user, mps_sim *sim, const mps_step_info *info);

/** Step until t_end, the last step cut so that t_end is met exactly.
 *  @param monitor  NULL or the callback
 *  @return MPS_OK, MPS_W_STOPPED, MPS_W_NOT_CONVERGED (if any step was), or the error of the failing step */
MPS_API mps_status mps_run(mps_sim *sim, double t_end, mps_monitor_fn monitor, void *user);

MPS_END_DECLS

#endif
