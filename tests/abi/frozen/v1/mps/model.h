/* SPDX-License-Identifier: BSD-3-Clause */
/** @file model.h  Plug-in interface of models: forces, walls, free surface, source, gradient, ...
 *
 *  A model is a table: name, help, settings, the channels it brings and its verbs. A channel is a
 *  named array with a value per particle. A verb says when it runs and which channels it reads and
 *  writes; it gets those arrays and no others. The library makes, clears, moves, saves and frees
 *  channels, and it runs all loops over particles. Built-in models use this interface and no other.
 *
 *  Notation: n particles, dim = 2 or 3; rows are particles in their present order.
 *
 *  Order: moments run in the order of MPS_LIMIT .. MPS_SHIFT. Within a moment a verb that writes a
 *  channel runs before verbs that change it, and these run before verbs that only read it. Where
 *  `after` or `before` names an order of two models, it holds instead. Where nothing decides, the
 *  order of registration holds. mps_verb_info_get() tells the order that results; verbs that wait
 *  for each other fail the step with MPS_E_STATE and the names of their models.
 *
 *  Channels are looked up when the first step after a change of models begins: a channel that no
 *  active model brings, or that cannot be used so in this moment, fails it with MPS_E_STATE.
 *
 *  Channels that built-in models use if a model brings them:
 *    "viscosity" [Pa s], 1 number, for a step: used by "viscosity.laplacian" and "viscosity.pair"
 *      instead of the viscosity of the phase. Write it in MPS_PREPARE. The time control knows the
 *      viscosities of the phases only: limit the step in MPS_LIMIT.
 *
 *  docs/tutorials/your_own_model.md writes a model step by step. The package has a conformance kit,
 *  model_kit.h, which runs a model and reports the rules that it breaks. */
#ifndef MPS_MODEL_H
#define MPS_MODEL_H

#include <mps/flux.h>
#include <mps/operators.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_model_ops.api: it fixes the layout of all tables below. */
#define MPS_MODEL_API 1u

/** Region of a particle: values of the channel "region", written in MPS_CLASSIFY. */
enum {
    /** Inside the fluid, or a wetted solid particle. */
    MPS_REGION_INNER = 0,
    /** Fluid with a NEAR particle among its near neighbours. */
    MPS_REGION_SECOND = 1,
    /** Fluid with a SURFACE particle among its near neighbours. */
    MPS_REGION_NEAR = 2,
    /** On the free surface: the pressure is given there. */
    MPS_REGION_SURFACE = 3,
    /** Detached fluid: ballistic, p = 0, in no operator of the pressure. */
    MPS_REGION_SPRAY = 4,
    /** Solid without fluid about it, and every dummy: p = 0, in no operator of the pressure. */
    MPS_REGION_DRY = 5
};

/** Moments of a step: when a verb runs. */
enum {
    /** Before the step: lower s->dt_limit. s->dt is that of the last step which the caller did not
     *  cut (0: none). Channels that live for a step cannot be used. Skipped if dt is fixed. */
    MPS_LIMIT = 0,
    /** Write "region" and what follows from it. Another value fails with MPS_E_PLUGIN. */
    MPS_CLASSIFY = 1,
    /** Write the quantities that later moments read. */
    MPS_PREPARE = 2,
    /** Add non-pressure accelerations of fluid particles to "acceleration". */
    MPS_FORCE = 3,
    /** Add to the pressure equation; "velocity" is u*. The equation is solved after this. */
    MPS_SOURCE = 4,
    /** Change the new pressures. */
    MPS_LEVEL = 5,
    /** Add accelerations by the new pressures to "acceleration", which arrives as 0. */
    MPS_GRADIENT = 6,
    /** Change "wall_pressure"; "acceleration" holds what MPS_GRADIENT left. */
    MPS_LOAD = 7,
    /** Change velocities after the correction, e.g. collisions. */
    MPS_VELOCITY = 8,
    /** Add to "displacement" of fluid particles; may change "velocity" to transport it. */
    MPS_SHIFT = 9,
    /** Number of moments. */
    MPS_MOMENT_COUNT = 10
};

/** How a verb uses a channel: a sum of these. READ + WRITE changes values. */
enum {
    /** Reads the value of its own row. */
    MPS_USE_READ = 1,
    /** Reads values of neighbours within the far radius too. Implies MPS_USE_READ. A loop that
     *  reads a channel at neighbours must not write it: write scratch first, and the channel in a
     *  second loop. */
    MPS_USE_NEIGHBOURS = 2,
    /** Writes values of its own row. Alone: the values before are not read. Rows that are not
     *  written keep their values. */
    MPS_USE_WRITE = 4,
    /** Reads and writes its own row. */
    MPS_USE_CHANGE = 5,
    /** The channel may be missing: no active model brings it. Its array is NULL then. */
    MPS_USE_OPTIONAL = 8,
    /** Reads values of the neighbours of dummies too. Implies MPS_USE_NEIGHBOURS. Without an active
     *  model that does, dummies have no rows in mps_stage.near and .far. */
    MPS_USE_DUMMIES = 16,
    /** Reads values of the near neighbours of neighbours within the far radius too, and looks at
     *  the near rows of these. Implies MPS_USE_NEIGHBOURS. */
    MPS_USE_ROWS = 32
};

/** A channel that a verb uses. Its array is s->data[k], k the place in mps_verb.uses. */
typedef struct mps_use {
    /** Name of the channel. */
    const char *channel;
    /** Sum of MPS_USE_... */
    int32_t access;
} mps_use;

/** How long a channel lives. */
enum {
    /** From the beginning of MPS_CLASSIFY to the end of the step; not kept. */
    MPS_LIFE_STEP = 0,
    /** As long as its particle: it travels with it, is saved by checkpoints, comes back after a
     *  failed step, and is a field for mps_lease_begin(), e.g. to write first values after
     *  mps_model_use(). Verbs of all moments may read and write it. When its model is switched off
     *  the field stays with its values. Real numbers only. */
    MPS_LIFE_PARTICLE = 1
};

/** Type of the numbers of a channel or a setting. */
enum {
    /** double */
    MPS_TYPE_REAL = 0,
    /** int32_t of a channel, a whole number of a setting */
    MPS_TYPE_INTEGER = 1,
    /** Settings only: 0 (off) or 1 (on). */
    MPS_TYPE_FLAG = 2
};

/** Components of a vector and of a matrix: dim and dim*dim numbers. */
enum { MPS_VECTOR = -1, MPS_MATRIX = -2 };

/** A named array with a value per particle that a model brings. Two models may bring the same one
 *  if all entries but `help` agree. mps_channel_info_get() lists the library's own channels. */
typedef struct mps_channel {
    /** 1..31 characters, not one of the library's own. */
    const char *name;
    /** e.g. "kg/m3"; "-" for none */
    const char *unit;
    /** One line: what it is. */
    const char *help;
    /** Numbers per particle: 1..9, MPS_VECTOR or MPS_MATRIX. */
    int32_t components;
    /** MPS_TYPE_REAL or MPS_TYPE_INTEGER */
    int32_t type;
    /** MPS_LIFE_... */
    int32_t life;
    /** Value at the beginning of a step (of a life for MPS_LIFE_PARTICLE); on the diagonal of a
     *  matrix, whose other entries are 0. */
    double initial;
} mps_channel;

/** A number that a user may set with mps_model_set(). */
typedef struct mps_setting {
    /** e.g. "distance" */
    const char *key;
    /** e.g. "dp"; "-" for none */
    const char *unit;
    /** One line: what it does. */
    const char *help;
    /** MPS_TYPE_... */
    int32_t type;
    /** Default. */
    double initial;
    /** Smallest allowed value. */
    double min;
    /** Largest allowed value. */
    double max;
} mps_setting;

/** Scalars of the pressure equation, to be set from MPS_CLASSIFY to MPS_SOURCE:
 *    sum_j k_ij (p_i - p_j + q_ij) + gain (shift_i p_i + gas_i f(p_i)) = gain source_i   [1/s2]
 *  over pairs of fluid and walls, k_ij and q_ij as in mps/flux.h, and
 *    "pressure_source" [1/s2], e.g. -div u* / dt; arrives 0
 *    "pressure_shift" >= 0 [1/(Pa s2)], e.g. compressibility; arrives 0
 *    "gas_shift" >= 0 [1/(Pa s2)], "gas_law" P [Pa]: f(p) = p, or P ln(1 + p/P) where P > 0, which
 *    needs a solver of nonlinear rows; arrive 0
 *    "pressure_condition" MPS_ROW_..., "pressure_value" [Pa]; arrive FIXED at 0 on the surface,
 *    FREE elsewhere.
 *  Unknowns are particles of regions INNER, SECOND and NEAR that are not fixed. */
typedef struct mps_equation {
    /** sizeof(mps_equation) of the library */
    uint32_t struct_size;
    /** The pairs of the Laplacian: MPS_NEAR or MPS_FAR (default). */
    int32_t radius;
    /** 1: pairs with one particle on the surface also carry the flux of the pairs that the surface
     *  cuts off; default 0. */
    int32_t complete_surface;
    /** 1: pressures are those beyond a fluid that moves with the tank, b = g - a_tank in
     *  mps/flux.h; default 0. */
    int32_t body;
    /** Weight of wall-wall pairs, times the smaller "wetted_share" of both; default 0. */
    double wall_factor;
    /** Share of the divergence that a step takes away, 0 < gain <= 1; default 1. */
    double gain;
} mps_equation;

/** Conditions on a row of the pressure equation: values of the channel "pressure_condition". */
enum {
    /** The equation holds. */
    MPS_ROW_FREE = 0,
    /** p_i = value_i (Dirichlet). */
    MPS_ROW_FIXED = 1,
    /** p_i >= value_i. The equation holds where p_i is above; at value_i fluid may separate. */
    MPS_ROW_LEAST = 2
};

/** What a verb sees. All arrays are borrowed for the call. */
typedef struct mps_stage {
    /** sizeof(mps_stage) */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** The moment: MPS_LIMIT .. MPS_SHIFT. */
    int32_t moment;
    /** Number of phases defined. */
    int32_t phases;
    /** Number of particles. */
    int64_t n;
    /** Number of this step, from 1. */
    int64_t step;
    /** Steps since the velocity of the tank jumped; 0: in this one; large if it never did. */
    int64_t since_jump;
    /** Time at the beginning of the step [s]. */
    double t;
    /** Length of the step [s]. */
    double dt;
    /** Spacing [m]. */
    double dp;
    /** U_g [m/s] */
    double velocity_scale;
    /** Gravity [m/s2]. */
    double g[3];
    /** [n] MPS_FLUID ... */
    const int32_t *kind;
    /** [n] number of the phase of fluid particles */
    const int32_t *phase;
    /** [n] */
    const int64_t *id;
    /** [n*dim] positions at the beginning of the step, in the lab [m]; in the frame of the tank:
     *  mps_stage_tank() */
    const double *x;
    /** [n*dim] wetted area vector of wall particles, into the fluid [m^(dim-1)] */
    const double *area;
    /** [n] nearest wall particle of a dummy; -1: none near */
    const int32_t *wall_of;
    /** Pairs within re_near. Rows of solids without fluid within the radii may be empty, and those
     *  of dummies are, unless an active model has MPS_USE_DUMMIES. Dummies are in the rows of
     *  others. A particle without a row keeps its "number_density"; other sums are those of no
     *  pairs. */
    const mps_stencil *near;
    /** Pairs within re_far, likewise. Row i of one need not begin where row i of the other does. */
    const mps_stencil *far;
    /** [16] mu of the phases [Pa s] */
    const double *viscosity;
    /** [16*16] sigma of two phases by mps_tension_set() [N/m], symmetric; < 0: not set */
    const double *tension;
    /** From MPS_FORCE on: fluxes of pairs of the pressure equation, NULL before. `body` is final
     *  from MPS_LEVEL on. Its channels need not be among the uses. */
    const mps_flux *flux;
    /** From MPS_CLASSIFY to MPS_SOURCE: scalars of the pressure equation. NULL otherwise. */
    mps_equation *equation;
    /** From MPS_LEVEL on, 1: nothing fixed the level of the pressures, their mean is 0; else 0. */
    int32_t level_free;
    /** Kept 0. */
    int32_t reserved;
    /** In MPS_LIMIT: longest step allowed [s], arrives INFINITY; a verb lowers it, to > 0. */
    double dt_limit;
    /** Arrays of the verb's uses, in their order; double or int32_t. */
    void *const *data;
    /** Values of the model's settings, in their order; also those of integers and flags. */
    const double *setting;
    /** State of the model: what mps_model_ops.create made, else mps_model_ops.user. */
    void *self;
    /** Private. */
    void *host;
} mps_stage;

/** One action of a model at one moment of a step. */
typedef struct mps_verb {
    /** MPS_LIMIT .. MPS_SHIFT */
    int32_t moment;
    /** Number of entries of uses, 0..24. */
    int32_t use_count;
    /** Channels that it uses. */
    const mps_use *uses;
    /** NULL, or a slot, e.g. "source": it runs after that model. "*": after all others. */
    const char *after;
    /** NULL, or a slot: it runs before that model. "*": before all others. */
    const char *before;
    /** The action. @return 0, or non-zero after mps_stage_fail() */
    int (*run)(mps_stage *s);
} mps_verb;

/** A model. All strings and tables must outlive the handle. */
typedef struct mps_model_ops {
    /** sizeof(mps_model_ops) */
    uint32_t struct_size;
    /** MPS_MODEL_API */
    uint32_t api;
    /** "slot.variant", at most 47 characters; a slot holds one model. */
    const char *name;
    /** One line: what it models. */
    const char *help;
    /** Entries of settings, 0..16. */
    int32_t setting_count;
    /** Entries of channels, 0..8. */
    int32_t channel_count;
    /** Entries of verbs, 1..16. */
    int32_t verb_count;
    /** Kept 0. */
    int32_t reserved;
    /** Numbers that a user may set. */
    const mps_setting *settings;
    /** Channels that it brings. */
    const mps_channel *channels;
    /** What it does. */
    const mps_verb *verbs;
    /** NULL, or make a state in *self, which holds `user` before. Non-zero: no memory.
     *  Checkpoints do not save the state: what later steps depend on must be in channels of
     *  MPS_LIFE_PARTICLE. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Gives back what create made; needed with create. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Data of the caller, e.g. a pointer that the verbs need as s->self. */
    void *user;
    /** NULL, or the farthest distance at which its verbs look at particles, if it is more than the
     *  far radius [m].
     *  @param setting  values of the settings in their order @param dp  spacing [m] */
    double (*reach)(const double *setting, double dp);
} mps_model_ops;

/** Register a model on a handle; the table is copied. Then choose it with mps_model_use().
 *  @return MPS_E_ARG (which entry, and what is allowed), MPS_E_VERSION, MPS_E_BUSY */
MPS_API mps_status mps_model_register(mps_sim *sim, const mps_model_ops *ops);

/* ---- loops and sums over particles ----------------------------------------------------------- */

/** Work on rows begin .. end-1. It may write rows of its own only. */
typedef void (*mps_rows_fn)(const mps_stage *s, void *arguments, int64_t begin, int64_t end);

/** Run a function over all rows, in parts at the same time. Returns when all are done. */
MPS_API void mps_stage_rows(const mps_stage *s, mps_rows_fn rows, void *arguments);

/** Add what rows begin .. end-1 contribute to sums[count], which begin at 0, or raise
 *  maxima[count], which begin at -INFINITY. */
typedef void (*mps_sums_fn)(const mps_stage *s, void *arguments, int64_t begin, int64_t end,
                            double *sums);

/** Sums over all rows: the same bytes for any number of threads and any order of the rows, see
 *  mps/exact.h. `add` is called for one row at a time, with sums of 0: what a row contributes must
 *  not depend on other rows.
 *  @param count  1..16 @param sums  [count] out */
MPS_API void mps_stage_sum(const mps_stage *s, int32_t count, mps_sums_fn add, void *arguments,
                           double *sums);

/** Maxima over all rows. @param count  1..16 @param maxima  [count] out; -INFINITY without rows */
MPS_API void mps_stage_max(const mps_stage *s, int32_t count, mps_sums_fn raise, void *arguments,
                           double *maxima);

/** Mark rows that have a near neighbour among some rows. A row without pairs, which solids away
 *  from fluid and dummies may be, is not marked.
 *  @param member  [n] not 0 for these rows @param beside  [n] out: 1 or 0
 *  @return 0, or non-zero after a failure (the error is set) */
MPS_API int mps_stage_beside(mps_stage *s, int32_t *member, int32_t *beside);

/** Roles of rows in mps_stage_bodies(). */
enum {
    /** Belongs to no body. */
    MPS_BODY_NONE = 0,
    /** Belongs to the body of its neighbours. */
    MPS_BODY_MEMBER = 1,
    /** Member where the search of a body begins. Bodies without a seed are not found. */
    MPS_BODY_SEED = 2,
    /** Belongs to no body and holds those beside it. */
    MPS_BODY_ANCHOR = 3
};

/** Find bodies, sets of fluid rows linked by near pairs, that no anchor holds. Solids may be
 *  anchors and belong to no body. Borrows up to 3 blocks of scratch and returns them.
 *  @param most  larger bodies are taken for held @param role  [n] MPS_BODY_...
 *  @param body  [n] out: 0.. for rows of bodies that are free, by the least id of each, else -1
 *  @return 0, or non-zero after a failure (no memory; the error is set) */
MPS_API int mps_stage_bodies(mps_stage *s, int32_t most, int32_t *role, int32_t *body);

/** Rows by square cells, for searches beyond the far radius: bucket b holds the rows first[b] - 1,
 *  next[of that] - 1, ... until 0, ascending, of all cells with that bucket. */
typedef struct mps_grid {
    /** Set by mps_grid_init(), or sizeof(mps_grid). */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** Side of a cell [m]. */
    double side;
    /** Number of buckets. */
    int64_t buckets;
    /** [buckets] */
    const int32_t *first;
    /** [n] */
    const int32_t *next;
} mps_grid;

/** Set struct_size and zero. @param size  sizeof(mps_grid) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_grid_init(mps_grid *grid, size_t size);

/** Cell of a place x [dim]. */
static inline void mps_grid_cell(const mps_grid *grid, const double *x, int64_t cell[3])
{
    cell[2] = 0;
    for (int d = 0; d < grid->dim; d++) cell[d] = (int64_t)floor(x[d] / grid->side);
}

/** Bucket of a cell. */
static inline int64_t mps_grid_bucket(const mps_grid *grid, const int64_t cell[3])
{
    const uint64_t h = (uint64_t)cell[0] * 73856093u ^ (uint64_t)cell[1] * 19349663u ^
                       (uint64_t)cell[2] * 83492791u;
    return (int64_t)(h % (uint64_t)grid->buckets);
}

/** Sort the fluid rows into cells of a side. The grid lives as long as scratch, and takes 2 blocks.
 *  @param grid  initialised by mps_grid_init(); out
 *  @return 0, or non-zero after a failure (no memory, side not > 0, grid not initialised) */
MPS_API int mps_stage_grid(mps_stage *s, double side, mps_grid *grid);

/** Place of a point of the lab in the frame of the tank, and the velocity of the rigid tank there
 *  over this step, as "velocity" has it for a solid at this point. In MPS_LIMIT it is the velocity
 *  at the beginning of the step. Row functions may call it.
 *  @param x  [dim] point, e.g. s->x + i * s->dim [m] @param place  NULL, or [dim] out [m]
 *  @param velocity  NULL, or [dim] out, in the lab [m/s] */
MPS_API void mps_stage_tank(const mps_stage *s, const double *x, double *place, double *velocity);

/** Scratch, or a channel, whose values a verb wrote and then reads at neighbours. */
typedef struct mps_shared {
    /** [n*components], double or int32_t */
    void *values;
    /** Numbers per particle. */
    int32_t components;
    /** MPS_TYPE_REAL or MPS_TYPE_INTEGER */
    int32_t type;
} mps_shared;

/** Make values that rows wrote visible at their neighbours. Call it between a loop that writes
 *  scratch or a channel and a loop of the same verb that reads it at neighbours. Channels that
 *  other verbs wrote need no call.
 *  @param shared  [count], 1..16 @return 0, or non-zero after a failure (the error is set) */
MPS_API int mps_stage_refresh(mps_stage *s, int32_t count, const mps_shared *shared);

/** Scratch of `count` doubles, zeroed, valid until the verb returns. At most 16, of both types.
 *  @return NULL: no memory, or too many (the error is set; let the verb return non-zero) */
MPS_API double *mps_stage_scratch(mps_stage *s, int64_t count);

/** As mps_stage_scratch(), of integers. */
MPS_API int32_t *mps_stage_scratch_integers(mps_stage *s, int64_t count);

/** Report a failure of a verb; text as printf. Returns 1, so that a verb can end with it. */
MPS_API int mps_stage_fail(mps_stage *s, const char *format, ...);

/** For row functions: inlined into their loops. */
#if defined(__GNUC__)
#define MPS_ROW static inline __attribute__((always_inline))
#else
#define MPS_ROW static inline
#endif

/** Define the mps_rows_fn `name` from a row function
 *    MPS_ROW void row(const int dim, const mps_stage *s, type *arguments, int64_t i);
 *  compiled for dim = 2 and 3, so that loops over dim unroll. */
#define MPS_ROWS(name, row, type)                                                     \
    static void name(const mps_stage *s, void *arguments, int64_t begin, int64_t end) \
    {                                                                                 \
        type *const given = (type *)arguments;                                        \
        if (s->dim == 2)                                                              \
            for (int64_t i = begin; i < end; i++) row(2, s, given, i);                \
        else                                                                          \
            for (int64_t i = begin; i < end; i++) row(3, s, given, i);                \
    }

/** Define the mps_sums_fn `name` from a row function
 *    MPS_ROW void row(const int dim, const mps_stage *s, type *arguments, int64_t i, double *sums);
 *  For mps_stage_max() it raises sums[k]. */
#define MPS_SUMS(name, row, type)                                                     \
    static void name(const mps_stage *s, void *arguments, int64_t begin, int64_t end, \
                     double *sums)                                                    \
    {                                                                                 \
        type *const given = (type *)arguments;                                        \
        if (s->dim == 2)                                                              \
            for (int64_t i = begin; i < end; i++) row(2, s, given, i, sums);          \
        else                                                                          \
            for (int64_t i = begin; i < end; i++) row(3, s, given, i, sums);          \
    }

MPS_END_DECLS

#endif
