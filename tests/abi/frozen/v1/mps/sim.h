/* SPDX-License-Identifier: BSD-3-Clause */
/** @file sim.h  Create, configure and destroy a simulation; choose models and the pressure solver
 *  by name.
 *
 *  W22: Wen, Zhao & Wan (2022). Z14: Zhang, Wan & Hino (2014). (n): equation number there. */
#ifndef MPS_SIM_H
#define MPS_SIM_H

#include <mps/parallel.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Treatment of a fluid particle that leaves the domain or the tank. A particle has left the tank
 *  if it is closer than dp to a dummy behind a wall, on the same side of the face as the dummy, and
 *  no wall particle is closer. */
enum {
    /** It is removed at the beginning of the next step, counted in mps_step_info.lost, and logged
     *  (default). */
    MPS_LOST_REMOVE = 0,
    /** The next step fails with MPS_E_LOST and its id in the text; remove it to continue. */
    MPS_LOST_ERROR = 1
};

/** Configuration of a simulation. Initialise it with mps_config_init(), then change entries; zero
 *  is the default. */
typedef struct mps_config {
    /** Set by mps_config_init(). */
    uint32_t struct_size;
    /** 2 (default) or 3 */
    int32_t dim;
    /** Initial particle spacing [m], 1e-12..1e12; required. The first tank changes it so that whole
     *  cells fill the tank: mps_tank_add(). */
    double dp;
    /** Gravity [m/s2]; all zero: none. mps_config_init() sets (0, -9.81, 0). */
    double gravity[3];
    /** "improved" (default, W22 (3)) or "original" (Z14 (3)); a kernel of the user:
     *  mps_kernel_use(). */
    const char *kernel;
    /** Near radius: number density, gradient and divergence [dp], 1.5..10; default 2.1. */
    double re_near;
    /** Far radius: Laplacians [dp], re_near..10; default 3.1 in 2-D, 2.1 in 3-D. */
    double re_far;
    /** U_g [m/s], velocity scale of limits of models and time steps; default sqrt(|g| dp), or
     *  sqrt(9.81 dp) without gravity. */
    double velocity_scale;
    /** Threads of the library; default 1. */
    int32_t threads;
    /** MPS_LOST_REMOVE or MPS_LOST_ERROR */
    int32_t lost_policy;
    /** Lower corner of the domain in the frame of the tank [m]. Both corners zero: the bounding box
     *  of all solids, enlarged on every side by its longest side. */
    double domain_min[3];
    /** Upper corner of the domain [m]. */
    double domain_max[3];
    /** Speed of a particle relative to the tank at which the run counts as diverged [m/s]; default
     *  1000. */
    double speed_limit;
    /** Default: malloc and free. */
    mps_allocator allocator;
    /** NULL: no log. */
    mps_log_fn log;
    /** First argument of log. */
    void *log_user;
    /** NULL, or buffer for the error text of mps_sim_create(). */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
    /** Parallel-for of the application, with which the library starts no threads; all zero
     *  (default): threads of the library. parallel.threads above 1 replaces `threads`. `run` is
     *  called in the thread that calls the library, and must be valid until the handle is
     *  destroyed. */
    mps_parallel parallel;
} mps_config;

/** Set every entry to its default. @param size  sizeof(mps_config) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_config_init(mps_config *config, size_t size);

/** Create an empty simulation with the preset "imps", phase 0 = water and solver "sundials.pcg".
 *  @param config  copied, with its strings
 *  @param sim     out: the handle, or NULL on failure; destroy it with mps_sim_destroy()
 *  @return MPS_E_ARG, MPS_E_NAME, MPS_E_VERSION, MPS_E_NOMEM; the text is in config->error. An
 *          uninitialised config gives only the status code, no text */
MPS_API mps_status mps_sim_create(const mps_config *config, mps_sim **sim);

/** Destroy a simulation and all it owns. NULL is allowed. Called from a callback of this simulation
 *  (log, monitor, motion, load of a body, inside function, kernel, verb, create or destroy of a
 *  model) it does nothing: mps_sim_error() and a logged warning report this; a log callback gets no
 *  warning. */
MPS_API void mps_sim_destroy(mps_sim *sim);

/** Text of the last failed call on this handle: what failed, which value, what is allowed. Never
 *  NULL; valid until the next call on the handle. */
MPS_API const char *mps_sim_error(const mps_sim *sim);

/** Dimension and spacing [m]. Only mps_tank_add() changes the spacing. Outputs may be NULL.
 *  @return MPS_E_ARG */
MPS_API mps_status mps_sim_shape(const mps_sim *sim, int32_t *dim, double *dp);

/** Time [s] and number of steps done. Outputs may be NULL. @return MPS_E_ARG */
MPS_API mps_status mps_sim_time(const mps_sim *sim, double *t, int64_t *steps);

/** Set the number of threads. Threads of the library are joined and created again by the next step.
 *  With a parallel-for of the application it is the number of parts into which loops are split.
 *  @param threads  1..1024
 *  @return MPS_E_ARG, MPS_E_BUSY (called from a monitor, a verb or a callback) */
MPS_API mps_status mps_threads_set(mps_sim *sim, int32_t threads);

/* ---- phases ---------------------------------------------------------------------------------- */

/** Properties of one phase. For some models the number of a phase has a meaning: phase 1 is the gas
 *  of "mmps". */
typedef struct mps_phase {
    /** Set by mps_phase_init(). */
    uint32_t struct_size;
    /** rho [kg/m3], > 0; default 1000. */
    double density;
    /** Dynamic viscosity mu [Pa s], >= 0; default 1e-3. */
    double viscosity;
} mps_phase;

/** Set water: 1000 kg/m3, 1e-3 Pa s. @param size  sizeof(mps_phase) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_phase_init(mps_phase *phase, size_t size);

/** Define phase `index` (0..15) before its particles are added, or change it. Existing particles of
 *  the phase get its density immediately.
 *  @return MPS_E_ARG (which value, and what is allowed), MPS_E_BUSY */
MPS_API mps_status mps_phase_set(mps_sim *sim, int32_t index, const mps_phase *phase);

/** Read phase `index`. @param phase  initialised by mps_phase_init(); out
 *  @return MPS_E_ARG: not defined */
MPS_API mps_status mps_phase_get(const mps_sim *sim, int32_t index, mps_phase *phase);

/** Set the surface tension between two phases, for the models of the slot "tension". The default
 *  for a pair is the setting "sigma" of the model.
 *  @param a,b    two different defined phases, in any order
 *  @param sigma  [N/m], >= 0
 *  @return MPS_E_ARG, MPS_E_BUSY */
MPS_API mps_status mps_tension_set(mps_sim *sim, int32_t a, int32_t b, double sigma);

/** Read the surface tension between two phases [N/m]. @return MPS_E_ARG: never set */
MPS_API mps_status mps_tension_get(const mps_sim *sim, int32_t a, int32_t b, double *sigma);

/* ---- models ---------------------------------------------------------------------------------- */

/** Replace all models by those of a preset, with its settings; previous settings are discarded. A
 *  preset is a list of calls of mps_model_use() and mps_model_set().
 *
 *  "imps" (default): one liquid with a free surface, stable and accurate.
 *
 *  "mmps": several phases that fill the tank together, without a free surface; operators of "imps",
 *  stable at densities of 1000 : 1. It has surface tension ("tension.jump", 0.0727 N/m unless set),
 *  and phase 1 is a gas ("gas.compressible", 340 m/s unless set). A step fails if there is no gas
 *  particle or the gas reaches its speed of sound. For two liquids: mps_model_remove(sim, "gas").
 *
 *  "imps.paper": W22 (1)-(12) literally; "mmps.paper": W22 (10)-(26) literally. They are for
 *  comparison and are less stable. They need mps_config.re_far 4.1 in 2-D and
 *  mps_time_control.gravity 0.03, which a preset cannot set.
 *  @return MPS_E_NAME (with the nearest known name), MPS_E_NOMEM, MPS_E_BUSY */
MPS_API mps_status mps_preset_use(mps_sim *sim, const char *name);

/** Activate a model. Names are "slot.variant"; a slot has one model, and the current one is
 *  replaced.
 *  @return MPS_E_NAME (with the nearest known name, the names of the slot, or all slots),
 *          MPS_E_NOMEM, MPS_E_BUSY */
MPS_API mps_status mps_model_use(mps_sim *sim, const char *name);

/** Deactivate the model of a slot. @param slot  e.g. "collision", or the full name
 *  @return MPS_E_NAME, MPS_E_BUSY */
MPS_API mps_status mps_model_remove(mps_sim *sim, const char *slot);

/** Change a setting of the model of a slot.
 *  @return MPS_E_NAME, MPS_E_ARG (with the allowed range), MPS_E_BUSY */
MPS_API mps_status mps_model_set(mps_sim *sim, const char *slot, const char *key, double value);

/** Read a setting of the model of a slot. @return MPS_E_NAME, MPS_E_ARG */
MPS_API mps_status mps_model_get(const mps_sim *sim, const char *slot, const char *key,
                                 double *value);

/** Numbers of the model of a slot that belong to no particle, after the last step; the help of the
 *  model explains them. Borrowed until the next call that steps, changes models or reads a
 *  checkpoint.
 *  @param values  out: [count], NULL where count is 0 @param count  out
 *  @return MPS_E_NAME, MPS_E_ARG, MPS_E_BUSY (called from a verb) */
MPS_API mps_status mps_model_state(const mps_sim *sim, const char *slot, const double **values,
                                   int64_t *count);

/** Name of active model number `index`, in the order of activation; NULL beyond the last. Valid
 *  until models change. */
MPS_API const char *mps_model_name(const mps_sim *sim, int32_t index);

/* ---- pressure solver ------------------------------------------------------------------------- */

/** Limits of the pressure solver. */
typedef struct mps_solver_limits {
    /** Set by mps_solver_limits_init(). */
    uint32_t struct_size;
    /** Maximum number of iterations; default 2000. */
    int32_t max_iterations;
    /** Relative 2-norm of the residual; default 1e-6. */
    double tolerance;
    /** Largest residual of a particle as velocity divergence times dt; default 1e-4; 0: not
     *  checked. */
    double divergence;
} mps_solver_limits;

/** Set every entry to its default. @param size  sizeof(mps_solver_limits)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_solver_limits_init(mps_solver_limits *limits, size_t size);

/** Choose the pressure solver.
 *  @param solver          "sundials.pcg", "sundials.bicgstab", "sundials.gmres", "sundials.klu",
 *                         "sundials.kinsol" (needed by gas.isentropic), or a registered one
 *  @param preconditioner  NULL (default of the solver), "none", "jacobi", "ic0", "auxgrid", or a
 *                         registered one. If "auxgrid", the default of sundials.pcg, fails for a
 *                         matrix, the equation is solved again with "jacobi", with a logged warning
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_NAME | unknown; the text contains the nearest known name |
 *  | MPS_E_ARG | a preconditioner with a solver that uses none (sundials.klu), or an |
 *  | | unsymmetric one with a solver that needs a symmetric one (sundials.pcg) |
 *  | MPS_E_BUSY | called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_solver_use(mps_sim *sim, const char *solver, const char *preconditioner);

/** Change the limits of the solver. @return MPS_E_ARG (which value, and what is allowed),
 *  MPS_E_BUSY */
MPS_API mps_status mps_solver_limits_set(mps_sim *sim, const mps_solver_limits *limits);

/** Names of the current solver and preconditioner. Outputs may be NULL; valid until
 *  mps_solver_use(). @return MPS_E_ARG */
MPS_API mps_status mps_solver_name(const mps_sim *sim, const char **solver,
                                   const char **preconditioner);

MPS_END_DECLS

#endif
