/* SPDX-License-Identifier: BSD-3-Clause */
/** @file sim.h  Create, configure and destroy a simulation; choose models and the pressure solver by name. */
#ifndef MPS_SIM_H
#define MPS_SIM_H

#include <mps/parallel.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** What happens to a fluid particle that leaves the domain, or the tank: less than dp from a dummy that stands behind a wall, on the same
 *  side of its face, with no wall particle nearer. Spilled liquid touches the tank that way. */
enum {
    MPS_LOST_REMOVE = 0, /**< removed when the next step begins, counted in mps_step_info.lost and logged (default) */
    MPS_LOST_ERROR = 1   /**< the next step fails with MPS_E_LOST and names it; remove it to go on */
};

/** Configuration of a simulation. Fill with mps_config_init(), then change what matters; zero means "default". */
typedef struct mps_config {
    uint32_t struct_size;    /**< set by mps_config_init() */
    int32_t dim;             /**< 2 (default) or 3 */
    double dp;               /**< initial particle spacing [m], 1e-12..1e12; no default */
    double gravity[3];       /**< [m/s2], all zero = no gravity; mps_config_init() sets (0, -9.81, 0) */
    const char *kernel;      /**< "improved" (default, W22 (3)), "original" (Z14 (3)); a user's own: mps_kernel_use() */
    double re_near;          /**< radius of n, gradient, divergence [dp]; default 2.1 */
    double re_far;           /**< radius of the Laplacians [dp]; default 3.1 in 2-D, 2.1 in 3-D; >= re_near */
    double velocity_scale;   /**< U_g [m/s] that scales models where |g| = 0; default sqrt(|g| dp), or sqrt(9.81 dp) without gravity */
    int32_t threads;         /**< threads that loops run on; default 1 */
    int32_t lost_policy;     /**< MPS_LOST_REMOVE or MPS_LOST_ERROR */
    double domain_min[3];    /**< lower corner in the tank's frame [m]; with domain_max all zero: bounding box of all solids, */
    double domain_max[3];    /**< enlarged by its longest side on every side */
    double speed_limit;      /**< a faster particle is a diverged run [m/s]; default 1000 */
    mps_allocator allocator; /**< default malloc and free */
    mps_log_fn log;          /**< NULL: silent */
    void *log_user;          /**< first argument of log */
    char *error;             /**< NULL, or where mps_sim_create() writes why it failed */
    size_t error_size;       /**< bytes at `error` */
    /** The host's parallel-for, with which the library makes no threads; all zero (default): threads of the library. parallel.threads above 1
     *  takes the place of `threads`. `run` is called in the thread that calls the library, and must work as long as the handle lives. */
    mps_parallel parallel;
} mps_config;

/** Set every entry to its default. @param size sizeof(mps_config) of the caller's headers */
MPS_API mps_status mps_config_init(mps_config *config, size_t size);

/** Create an empty simulation with the preset "imps", phase 0 = water, solver "sundials.pcg".
 *  @param config  copied; strings too
 *  @param sim     out: the handle, or NULL on failure; destroy with mps_sim_destroy()
 *  @return MPS_OK, MPS_E_ARG, MPS_E_NAME, MPS_E_VERSION, MPS_E_NOMEM; text in config->error, if struct_size reaches over error_size: it
 *          is not looked for behind the struct, so a config that mps_config_init() never saw (struct_size 0) gets the status alone */
MPS_API mps_status mps_sim_create(const mps_config *config, mps_sim **sim);

/** Destroy a simulation and all it owns. NULL is allowed. */
MPS_API void mps_sim_destroy(mps_sim *sim);

/** Text of the last failed call on this handle: what was wrong with which value, and what is allowed. Never NULL;
 *  valid until the next call on the handle. */
MPS_API const char *mps_sim_error(const mps_sim *sim);

/** Scalars of a simulation that never change: dimension and spacing [m]. Outputs may be NULL. */
MPS_API mps_status mps_sim_shape(const mps_sim *sim, int32_t *dim, double *dp);

/** Time [s] and number of steps taken. Outputs may be NULL. */
MPS_API mps_status mps_sim_time(const mps_sim *sim, double *t, int64_t *steps);

/** Number of threads. Those of the library are joined and made anew by the next step. With a parallel-for of the host it is the number of
 *  parts that loops are split into. @param threads 1..1024 */
MPS_API mps_status mps_threads_set(mps_sim *sim, int32_t threads);

/** Properties of one phase. Its number has no meaning to the handle, but models have one for it: phase 1 is the gas of "mmps". */
typedef struct mps_phase {
    uint32_t struct_size; /**< set by mps_phase_init() */
    double density;       /**< rho [kg/m3], > 0; default 1000 */
    double viscosity;     /**< dynamic viscosity mu [Pa s], >= 0; default 1e-3 */
} mps_phase;

/** Set water: 1000 kg/m3, 1e-3 Pa s. */
MPS_API mps_status mps_phase_init(mps_phase *phase, size_t size);

/** Define or change phase `index` (0..15), before its particles are added. Those there are take its density at once.
 *  @return MPS_E_ARG (which value is wrong, and what is allowed), MPS_E_BUSY */
MPS_API mps_status mps_phase_set(mps_sim *sim, int32_t index, const mps_phase *phase);

/** Read phase `index`. @return MPS_E_ARG if it was never defined */
MPS_API mps_status mps_phase_get(const mps_sim *sim, int32_t index, mps_phase *phase);

/** Set the surface tension between two phases. Used by the model "tension.csf", which has a value of its own for pairs not set here.
 *  @param a, b   two different defined phases, in any order
 *  @param sigma  [N/m], >= 0 */
MPS_API mps_status mps_tension_set(mps_sim *sim, int32_t a, int32_t b, double sigma);

/** Read the surface tension between two phases [N/m]. @return MPS_E_ARG if it was never set */
MPS_API mps_status mps_tension_get(const mps_sim *sim, int32_t a, int32_t b, double *sigma);

/* ---- models -------------------------------------------------------------------------------------------------- */

/** Replace all models by a named list. A preset is nothing but calls of mps_model_use() and mps_model_set(). Settings made before are gone.
 *
 *  "imps" (default): one liquid with a free surface, stable and accurate.
 *  "mmps": several phases that fill the tank together, without a free surface; the operators of "imps", stable at densities of 1000 : 1,
 *  with surface tension ("tension.csf", 0.0727 N/m unless set) and phase 1 a gas ("gas.compressible", 340 m/s unless set, whatever its
 *  density). A step fails without fluid of the gas, or when it moves at its speed of sound. Two liquids: mps_model_remove(sim, "gas").
 *  "imps.paper": W22 (1)-(12) to the letter; "mmps.paper": W22 (10)-(26). For comparison: they are less stable, and want
 *  mps_config.re_far 4.1 in 2-D and mps_time_control.gravity 0.03, which a preset cannot set.
 *  @return MPS_E_NAME with the nearest known name, MPS_E_NOMEM */
MPS_API mps_status mps_preset_use(mps_sim *sim, const char *name);

/** Switch a model on. Names are "slot.variant"; a slot holds one model, the one already there is replaced.
 *  @return MPS_E_NAME with the nearest known name, or those of the slot, or all slots */
MPS_API mps_status mps_model_use(mps_sim *sim, const char *name);

/** Switch the model in a slot off. @param slot "collision", or the full name */
MPS_API mps_status mps_model_remove(mps_sim *sim, const char *slot);

/** Change a number of the model in a slot. @return MPS_E_NAME, MPS_E_ARG (with the allowed range) */
MPS_API mps_status mps_model_set(mps_sim *sim, const char *slot, const char *key, double value);

/** Read a number of the model in a slot. */
MPS_API mps_status mps_model_get(const mps_sim *sim, const char *slot, const char *key, double *value);

/** Name of the index-th active model in the order of calling, or NULL behind the last. Valid until models change. */
MPS_API const char *mps_model_name(const mps_sim *sim, int32_t index);

/* ---- pressure solver ------------------------------------------------------------------------------------------ */

/** Limits of the pressure solver. */
typedef struct mps_solver_limits {
    uint32_t struct_size;   /**< set by mps_solver_limits_init() */
    int32_t max_iterations; /**< default 2000 */
    double tolerance;       /**< relative 2-norm of the residual; default 1e-6 */
    double divergence;      /**< largest residual as a velocity divergence times dt, per particle; default 1e-4; 0: not checked */
} mps_solver_limits;

/** Defaults. */
MPS_API mps_status mps_solver_limits_init(mps_solver_limits *limits, size_t size);

/** Choose the pressure solver.
 *  @param solver          "sundials.pcg", "sundials.bicgstab", "sundials.gmres", "sundials.klu", "sundials.kinsol" (the one for
 *                         gas.isentropic) or a registered one
 *  @param preconditioner  NULL (the solver's default), "none", "jacobi", "ic0", "auxgrid" or a registered one; should "auxgrid", the
 *                         default of sundials.pcg, fail at a matrix, "jacobi" solves again and a warning is logged
 *  @return MPS_E_NAME with the nearest known name; MPS_E_ARG for a preconditioner with a solver that uses none (sundials.klu) or an
 *          unsymmetric one with a solver that needs a symmetric one (sundials.pcg) */
MPS_API mps_status mps_solver_use(mps_sim *sim, const char *solver, const char *preconditioner);

/** Change the solver's limits. */
MPS_API mps_status mps_solver_limits_set(mps_sim *sim, const mps_solver_limits *limits);

/** Names in use. Outputs may be NULL; valid until mps_solver_use(). */
MPS_API mps_status mps_solver_name(const mps_sim *sim, const char **solver, const char **preconditioner);

MPS_END_DECLS

#endif
