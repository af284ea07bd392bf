/* SPDX-License-Identifier: BSD-3-Clause */
/** @file model.h  Plug-in interface of the models of a time step: forces, walls, free surface, source, gradient, ...
 *
 *  A model is a table of verbs. A step calls them in this order, each verb for all active models in the order of their slots:
 *  classify, force, source, [the pressure equation is solved], gradient, load, velocity, shift. Built-in models use this
 *  interface and no other. Verbs loop over rows with `s->threads` threads and write only their own row. */
#ifndef MPS_MODEL_H
#define MPS_MODEL_H

#include <mps/operators.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_model_ops.api. */
#define MPS_MODEL_API 1u

/** Where a particle is, set by classify verbs. */
enum {
    MPS_REGION_INNER = 0,   /**< inside the fluid, or a wetted solid particle */
    MPS_REGION_SECOND = 1,  /**< fluid with a NEAR particle among its near neighbours */
    MPS_REGION_NEAR = 2,    /**< fluid with a SURFACE particle among its near neighbours */
    MPS_REGION_SURFACE = 3, /**< on the free surface: p is given there */
    MPS_REGION_SPRAY = 4,   /**< detached fluid: ballistic, p = 0, in no operator of the pressure */
    MPS_REGION_DRY = 5      /**< solid without fluid about it, and every dummy: p = 0, in no operator of the pressure */
};

/** Everything a verb may see; rows are particles in the present order. All arrays are borrowed for the call. */
typedef struct mps_stage {
    uint32_t struct_size;    /**< sizeof(mps_stage) */
    int32_t dim;             /**< 2 or 3 */
    int32_t threads;         /**< OpenMP threads to use */
    int32_t phases;          /**< phases defined */
    int64_t n;               /**< particles */
    int64_t step;            /**< number of this step, from 1 */
    double t;                /**< time at the beginning of the step [s] */
    double dt;               /**< step [s] */
    double dp;               /**< spacing [m] */
    double velocity_scale;   /**< U_g [m/s] */
    double g[3];             /**< gravity [m/s2] */
    const int32_t *kind;     /**< [n] MPS_FLUID ... */
    const int32_t *phase;    /**< [n] */
    const int64_t *id;       /**< [n] */
    const double *x;         /**< [n*dim] positions at the beginning of the step [m] */
    double *u;               /**< [n*dim] velocities [m/s]; of walls: the tank's over this step; written by `velocity` */
    double *p;               /**< [n] pressures [Pa]; from `gradient` on the new ones */
    const double *density;   /**< [n] rho [kg/m3] */
    const double *viscosity; /**< [16] mu of the phases [Pa s] */
    double *tank_accel;      /**< [n*dim] acceleration over this step of the rigid tank at the particle's place, solid or fluid: the motion
                                 from which pressures are reckoned; g in a body of fluid that falls freely; classify may change it [m/s2] */
    const double *area;      /**< [n*dim] wetted area vector of wall particles, into the fluid */
    const int32_t *wall_of;  /**< [n] nearest wall particle of a dummy, -1: none near */
    double *number_density;  /**< [n] sum W over the near pairs, kept where a solid has no fluid about it; classify may change it */
    double *volume;          /**< [n] mps_op_volume_deviation() over the far pairs; classify may change it */
    const double *asymmetry; /**< [n*dim] A_i over the near pairs, W22 (11) */
    int32_t *region;         /**< [n] MPS_REGION_..., written by classify; fluid and walls arrive INNER, dummies DRY */
    double *wet;             /**< [n] share 0..1 of a wall particle's fluid side that holds fluid, written by classify; arrives 1 */
    double *correction;      /**< [n*dim*dim] B_i, symmetric, written by classify; arrives as the unit matrix */
    const mps_stencil *near; /**< pairs within re_near; rows of solids without fluid within the radii may be empty */
    const mps_stencil *far;  /**< pairs within re_far, likewise; row i of one need not begin where row i of the other does */
    void *host;              /**< private */
    double *density_smooth;  /**< [n] density for operators of the pressure, written by classify; arrives as a copy of density [kg/m3] */
    const double *tension;   /**< [16*16] sigma between two phases by mps_sim_set_tension() [N/m], symmetric; < 0: not set */
    int32_t level_free;      /**< from `gradient` on, 1: nothing fixed the level of the pressures, their mean is 0; else 0 */
    double *
        capillary; /**< [n] sigma kappa: what a phase has more pressure than the other across an interface, written by classify; arrives 0 [Pa] */
    double
        *depth; /**< [n] distance from an interface between two densities, on the particle's own side, written by classify; arrives 0: not
                        known [m] */
    int64_t since_jump;    /**< steps since the velocity of the tank jumped, 0: in this one; large where it never did */
    double *wall_pressure; /**< [n] pressure on the walls as probes and forces see it, written by `load`, where it arrives as p [Pa]; NULL
                                before */
} mps_stage;

/** rho_ij of a pair of the pressure equation [kg/m3]: the mean along the line between both, by their distances from the interface;
 *  (rho_i + rho_j)/2, W22 (17), where these are not known. */
static inline double mps_stage_pair_density(const mps_stage *s, int64_t i, int64_t j)
{
    const double a = s->density_smooth[i], b = s->density_smooth[j], f = s->depth[i], h = s->depth[j];
    return a == b || !(f > 0 && h > 0) ? 0.5 * (a + b) : (f * a + h * b) / (f + h);
}

/** Conditions on a row of the pressure equation, for mps_ppe_terms.fixed. */
enum {
    MPS_ROW_FREE = 0,  /**< the equation holds */
    MPS_ROW_FIXED = 1, /**< p_i = value_i (Dirichlet) */
    MPS_ROW_LEAST = 2  /**< p_i >= value_i: where p_i is above, the equation holds; at value_i the row's fluid may separate from it */
};

/** The pressure equation: sum_j k_ij (p_i - p_j + q_ij) + gain (shift_i p_i + gas_i f(p_i)) = gain rhs_i [1/s2] over pairs of fluid and
 *  walls, with k_ij = 2D/(n0 lambda) W_ij/rho_ij and q_ij = rho_ij (b_i + b_j)/2 . r_ij, the difference p_j - p_i of a fluid that moves
 *  with the tank, less (capillary_i - capillary_j)/2 between phases. f(p) = p, or P ln(1 + p/P) where law_i = P > 0, which needs a solver of nonlinear rows. Unknowns are particles of
 *  regions INNER, SECOND and NEAR that are not fixed. Verbs add to what they find. */
typedef struct mps_ppe_terms {
    uint32_t struct_size;     /**< sizeof(mps_ppe_terms) */
    int32_t radius;           /**< MPS_NEAR or MPS_FAR (default): the pairs of the Laplacian */
    int32_t complete_surface; /**< 1: pairs with one particle on the surface also carry the flux of those cut off by it; default 0 */
    double wall_factor;       /**< weight of wall-wall pairs, times the smaller `wet` of the two; default 0 */
    double *rhs;              /**< [n] e.g. -div u* / dt */
    double *shift;            /**< [n] >= 0, e.g. compressibility */
    double *value;            /**< [n] pressure of rows that are fixed or have a least one [Pa] */
    int32_t *fixed;           /**< [n] MPS_ROW_...; region SURFACE arrives fixed at 0 */
    double *body;             /**< [n*dim] b, e.g. g - tank_accel [m/s2]; default 0 */
    double gain;              /**< share of the divergence that a step takes away: default 1 */
    double *gas;              /**< [n] >= 0, compressibility of a gas; default 0 */
    double *law;              /**< [n] P_i of the law of the gas [Pa]; default 0: linear */
} mps_ppe_terms;

/** A number a user may set by mps_model_set(). */
typedef struct mps_setting {
    const char *key; /**< e.g. "distance" */
    double initial;  /**< default */
    double min;      /**< smallest allowed */
    double max;      /**< largest allowed */
} mps_setting;

/** A model. Verbs are optional; they return 0, or non-zero after mps_stage_fail(). `k` holds the settings in the order of `settings`. */
typedef struct mps_model_ops {
    uint32_t struct_size;        /**< sizeof(mps_model_ops) */
    uint32_t api;                /**< MPS_MODEL_API */
    const char *name;            /**< "slot.variant", at most 47 characters */
    int32_t order;               /**< verbs run by ascending order, then in the order of mps_model_use(); built-ins use 100..900 */
    int32_t setting_count;       /**< entries of settings, at most 16 */
    const mps_setting *settings; /**< must outlive the handle */
    /** New state in *self; NULL: the model has none. Non-zero: out of memory. */
    int (*create)(const mps_allocator *allocator, void **self);
    void (*destroy)(void *self); /**< needed with create */
    /** Set region, wet, correction. Another region than MPS_REGION_INNER .. MPS_REGION_DRY fails the step with MPS_E_PLUGIN. */
    int (*classify)(void *self, const double *k, mps_stage *s);
    /** Add non-pressure accelerations a [n*dim] [m/s2] of fluid particles; gravity too, where a model puts it there. */
    int (*force)(void *self, const double *k, mps_stage *s, double *a);
    /** Add to the pressure equation; s->u is u*. */
    int (*source)(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms);
    /** Add accelerations a [n*dim] due to the new pressures s->p. */
    int (*gradient)(void *self, const double *k, mps_stage *s, double *a);
    /** Change velocities after the correction, e.g. collisions. */
    int (*velocity)(void *self, const double *k, mps_stage *s);
    /** Add displacements dx [n*dim] [m] of fluid particles beside dt u; may change s->u to transport it. */
    int (*shift)(void *self, const double *k, mps_stage *s, double *dx);
    /** Largest time step [s] this model allows, > 0; INFINITY: any (else the step fails with MPS_E_PLUGIN). Called before the step: s->dt is
     *  that of the last step which the caller did not cut, 0: none; the stencils are those of the step, nothing is classified yet. Not
     *  called where the step is fixed. */
    double (*dt_limit)(void *self, const double *k, const mps_stage *s);
    /** Change s->wall_pressure, what probes and forces see of the new pressures. @param a [n*dim] accelerations by `gradient` [m/s2] */
    int (*load)(void *self, const double *k, mps_stage *s, const double *a);
} mps_model_ops;

/** Register a model on a handle; the table is copied. Then choose it with mps_model_use().
 *  @return MPS_E_ARG for a taken or malformed name, a setting out of its own range, no verb at all; MPS_E_VERSION */
MPS_API mps_status mps_model_register(mps_sim *sim, const mps_model_ops *ops);

/** Scratch of `count` doubles, zeroed, given back by itself when the verb returns; NULL when memory is out (and the error is set). */
MPS_API double *mps_stage_scratch(mps_stage *s, int64_t count);

/** Report a failure of a verb; text as printf. Always returns 1, so that a verb can end with it. */
MPS_API int mps_stage_fail(mps_stage *s, const char *format, ...);

MPS_END_DECLS

#endif
