/* SPDX-License-Identifier: BSD-3-Clause */
/** @file stage.h  Interface of a step to verbs of models; their loops, sums and workspace.
 *
 *  A verb gets a stage. Its loops run over rows; row i is particle i in the current order. A row
 *  function gets a view, which has numbers and arrays only, and the fields that the verb passes to
 *  the loop. Notation: n particles, dim = 2 or 3. */
#ifndef MPS_STAGE_H
#define MPS_STAGE_H

#include <mps/flux.h>
#include <mps/numbers.h>
#include <mps/operators.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Region of a particle: values of the channel "region", written in MPS_CLASSIFY. */
enum {
    /** Interior fluid, or a wetted solid particle. */
    MPS_REGION_INNER = 0,
    /** Fluid with a NEAR particle among its near neighbours. */
    MPS_REGION_SECOND = 1,
    /** Fluid with a SURFACE particle among its near neighbours. */
    MPS_REGION_NEAR = 2,
    /** On the free surface, where the pressure is prescribed. */
    MPS_REGION_SURFACE = 3,
    /** Detached fluid: ballistic, p = 0, excluded from all operators of the pressure. */
    MPS_REGION_SPRAY = 4,
    /** Solid without fluid around it, and every dummy: p = 0, excluded from all operators of the
     *  pressure. */
    MPS_REGION_DRY = 5
};

/** Hooks of a step: when a verb runs. */
enum {
    /** Before the neighbour search: inflow and outflow, mps_stage_add(), mps_stage_remove().
     *  view->dt is the length of the last step (0: none); pair lists are empty. */
    MPS_POPULATE = 0,
    /** Before the time step is known: reduce s->dt_limit. view->dt is that of the last step that
     *  the caller did not shorten (0: none). Channels of MPS_LIFE_STEP cannot be used. Skipped if
     *  dt is fixed. */
    MPS_LIMIT = 1,
    /** Move solids: write "solid_place" and "solid_area" of rigid bodies in the tank that move on
     *  their own. Pair lists are empty. */
    MPS_MOTION = 2,
    /** Write "region" and quantities that depend on it. A value that is no MPS_REGION_... fails
     *  with MPS_E_PLUGIN. */
    MPS_CLASSIFY = 3,
    /** Write the quantities that later hooks read. */
    MPS_PREPARE = 4,
    /** Add non-pressure accelerations of fluid particles to "acceleration". */
    MPS_FORCE = 5,
    /** Add to the pressure equation; "velocity" is u*. The equation is solved after this. */
    MPS_SOURCE = 6,
    /** Change the new pressures. */
    MPS_LEVEL = 7,
    /** Add accelerations by the new pressures to "acceleration", which is 0 on entry. */
    MPS_GRADIENT = 8,
    /** Change "wall_pressure"; "acceleration" is the result of MPS_GRADIENT. */
    MPS_LOAD = 9,
    /** Change velocities after the correction, e.g. collisions. */
    MPS_VELOCITY = 10,
    /** Add to "displacement" of fluid particles; may change "velocity" to transport it. */
    MPS_SHIFT = 11,
    /** Number of hooks. */
    MPS_HOOK_COUNT = 12
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

/* The pressure equation is
 *    sum_j k_ij (p_i - p_j + q_ij) + gain (shift_i p_i + gas_i f(p_i)) = gain source_i   [1/s2]
 *  over pairs of fluid and walls, k_ij and q_ij as in mps/flux.h. Verbs write its terms as
 *  channels; initial values in parentheses:
 *    "pressure_source" [1/s2], e.g. -div u* / dt (0)
 *    "pressure_shift" >= 0 [1/(Pa s2)], e.g. compressibility (0)
 *    "gas_shift" >= 0 [1/(Pa s2)], "gas_law" P [Pa]: f(p) = p, or P ln(1 + p/P) where P > 0, which
 *    needs a solver for nonlinear rows (both 0)
 *    "pressure_condition" MPS_ROW_..., "pressure_value" [Pa] (FIXED at 0 on the surface, FREE
 *    elsewhere). In MPS_LOAD they can be read; a condition above MPS_ROW_LEAST marks an active
 *    constraint: a row of MPS_ROW_LEAST with p_i = value_i.
 *  Unknowns are particles of regions INNER, SECOND and NEAR that are not fixed.
 *  Scalars of the equation, written from MPS_CLASSIFY to MPS_SOURCE:
 *    "equation_radius" pairs of the Laplacian, MPS_NEAR or MPS_FAR (MPS_FAR)
 *    "equation_complete" 1: pairs with one particle on the surface also include the flux of the
 *    pairs that the surface truncates (0)
 *    "equation_body" 1: pressures relative to a fluid that moves with the tank, b = g - a_tank in
 *    mps/flux.h (0)
 *    "equation_wall_factor" >= 0, weight of wall-wall pairs, times the smaller "wetted_share" of
 *    both (0)
 *    "equation_gain" fraction of the divergence that a step removes, 0 < gain <= 1 (1). */

/** Conditions of a row of the pressure equation: values of the channel "pressure_condition". */
enum {
    /** The equation holds. */
    MPS_ROW_FREE = 0,
    /** p_i = value_i (Dirichlet). */
    MPS_ROW_FIXED = 1,
    /** p_i >= value_i (inequality constraint). The equation holds where p_i > value_i; at value_i
     *  fluid may separate. */
    MPS_ROW_LEAST = 2
};

/** Poses of the rigid tank at the beginning and at the end of a step, for mps_view_tank(). A member
 *  of mps_view; its layout is fixed within a major version. */
typedef struct mps_tank_pose {
    /** Centre of rotations, in the frame of the tank [m]. */
    double centre[3];
    /** Displacement at the beginning of the step [m]. */
    double shift[3];
    /** Rotation at the beginning of the step, row by row. */
    double rotation[9];
    /** Displacement at the end of the step [m]. */
    double next_shift[3];
    /** Rotation at the end of the step. */
    double next_rotation[9];
    /** Velocity of the centre at the beginning of the step [m/s]. */
    double rate[3];
    /** Angular velocity at the beginning of the step [rad/s]. */
    double omega[3];
    /** 1: the end of the step is known; 0 in MPS_LIMIT. */
    int32_t has_next;
    /** Kept 0. */
    int32_t reserved;
} mps_tank_pose;

/** View for row functions: numbers and borrowed arrays, no pointers to other structs. */
typedef struct mps_view {
    /** sizeof(mps_view) of the library */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** Number of particles. */
    int64_t n;
    /** Time at the beginning of the step [s]. */
    double t;
    /** Length of the step [s]. */
    double dt;
    /** Spacing [m]. */
    double dp;
    /** U_g, mps_config.velocity_scale [m/s] */
    double velocity_scale;
    /** Gravity [m/s2]. */
    double g[3];
    /** Number of phases defined. */
    int32_t phases;
    /** Kept 0. */
    int32_t reserved;
    /** [n] MPS_FLUID ... */
    const int32_t *kind;
    /** [n] number of the phase of fluid particles */
    const int32_t *phase;
    /** [n] */
    const int64_t *id;
    /** [n*dim] positions at the beginning of the step, in the lab [m]; in the frame of the tank:
     *  mps_view_tank() */
    const double *x;
    /** [n*dim] wetted area vector of wall particles, into the fluid [m^(dim-1)] */
    const double *area;
    /** [n] nearest wall particle of a dummy; -1: none within range */
    const int32_t *wall_of;
    /** [16] mu of the phases [Pa s] */
    const double *viscosity;
    /** [16*16] sigma of two phases by mps_tension_set() [N/m], symmetric; < 0: not set */
    const double *tension;
    /** Values of the model's settings, in their order, integers and flags included. */
    const double *setting;
    /** Pairs within re_near. Rows of solids without fluid within the radii may be empty. Rows of
     *  dummies are empty unless an active model has MPS_USE_DUMMIES; dummies occur in other rows. A
     *  particle with an empty row keeps its "number_density"; its other sums are empty. */
    mps_stencil near;
    /** Pairs within re_far, with the same empty rows. Rows of `near` and `far` may begin at
     *  different indices. */
    mps_stencil far;
    /** From MPS_FORCE on: fluxes of pairs of the pressure equation; before: zero. `body` is final
     *  from MPS_LEVEL on. A verb may read its channels without a mps_use. */
    mps_flux flux;
    /** The rigid tank. */
    mps_tank_pose tank;
    /** From MPS_LIMIT on: upper bound of the speeds relative to the tank at the beginning of the
     *  step; INFINITY: unknown [m/s] */
    double fastest;
} mps_view;

/** Whether row i is fluid. */
static inline int mps_is_fluid(const mps_view *v, int64_t i)
{
    return v->kind[i] == MPS_FLUID;
}

/** Whether row i is a wall particle. */
static inline int mps_is_wall(const mps_view *v, int64_t i)
{
    return v->kind[i] == MPS_WALL;
}

/** Whether row i is a dummy. */
static inline int mps_is_dummy(const mps_view *v, int64_t i)
{
    return v->kind[i] == MPS_DUMMY;
}

/** Region of row i, MPS_REGION_... @param region  the channel "region" */
static inline int32_t mps_region_of(const int32_t *region, int64_t i)
{
    return region[i];
}

/** Argument of a verb: the view, its channels, and access to the library. Borrowed for the call. */
typedef struct mps_stage {
    /** sizeof(mps_stage) of the library */
    uint32_t struct_size;
    /** The hook: MPS_POPULATE .. MPS_SHIFT. */
    int32_t hook;
    /** View for row functions. */
    const mps_view *view;
    /** Arrays of the verb's uses, in their order; double or int32_t. */
    void *const *data;
    /** State of the model: that of mps_model_ops.create, else mps_model_ops.user. */
    void *self;
    /** Number of this step, from 1. */
    int64_t step;
    /** Steps since the last jump of the tank velocity; 0: in this step; large: no jump yet. */
    int64_t since_jump;
    /** In MPS_LIMIT: time-step limit [s], INFINITY on entry; a verb reduces it to a value > 0. */
    double dt_limit;
    /** From MPS_LEVEL on, 1: there is no pressure datum, so the mean pressure is 0; else 0. */
    int32_t level_free;
    /** Kept 0. */
    int32_t reserved;
    /** Private. */
    void *host;
} mps_stage;

/* ---- loops and sums over particles ----------------------------------------------------------- */

/** Process rows begin .. end-1. It may write entries of these rows only. */
typedef void (*mps_rows_fn)(const mps_view *view, const void *fields, int64_t begin, int64_t end);

/** Contributions of rows begin .. end-1: row i adds to values[(i - begin) * stride + k], initially
 *  0. For maxima stride is 0: all rows raise the same values, initially -INFINITY. */
typedef void (*mps_sums_fn)(const mps_view *view, const void *fields, int64_t begin, int64_t end,
                            int32_t stride, double *values);

/** A loop over rows; MPS_ROWS() defines one. */
typedef struct mps_rows {
    /** sizeof(mps_rows) */
    uint32_t struct_size;
    /** Bytes of the fields that it takes. */
    uint32_t bytes;
    /** Name of the loop. */
    const char *name;
    /** What it does. */
    mps_rows_fn run;
    /** Source file that defines it. */
    const char *file;
} mps_rows;

/** Sums or maxima over rows; MPS_SUMS() defines them. */
typedef struct mps_sums {
    /** sizeof(mps_sums) */
    uint32_t struct_size;
    /** Bytes of the fields that they take. */
    uint32_t bytes;
    /** Name of the loop. */
    const char *name;
    /** What it does. */
    mps_sums_fn run;
    /** Source file that defines it. */
    const char *file;
} mps_sums;

/** Run a loop over all rows in parallel. Returns when all rows are complete.
 *  @param fields  numbers and arrays, no pointers to other structs: rows->bytes bytes, copied */
MPS_API void mps_stage_rows(const mps_stage *s, const mps_rows *rows, const void *fields);

/** Sums over all rows: the same bytes for any number of threads and any order of the rows, see
 *  mps/exact.h. The contribution of a row must not depend on other rows.
 *  @param count  1..16 @param sums  [count] out */
MPS_API void mps_stage_sum(const mps_stage *s, int32_t count, const mps_sums *add,
                           const void *fields, double *sums);

/** Maxima over all rows. @param count  1..16 @param maxima  [count] out; -INFINITY without rows */
MPS_API void mps_stage_max(const mps_stage *s, int32_t count, const mps_sums *raise,
                           const void *fields, double *maxima);

/** Mark rows with a near neighbour among the member rows. Solids far from fluid have no pairs. Not
 *  allowed in MPS_POPULATE, where pair lists are empty.
 *  @param member  [n] not 0 for member rows @param beside  [n] out: 1 or 0
 *  @return 0, or non-zero after a failure (the error is set) */
MPS_API int mps_stage_adjacent(mps_stage *s, int32_t *member, int32_t *beside);

/** Roles of rows in mps_stage_bodies(). A body is a connected component of rows. */
enum {
    /** In no body. */
    MPS_BODY_NONE = 0,
    /** In the body of its neighbours. */
    MPS_BODY_MEMBER = 1,
    /** Member from which the search of a body starts. Bodies without a seed are not found. */
    MPS_BODY_SEED = 2,
    /** In no body; bodies adjacent to it are not free. */
    MPS_BODY_ANCHOR = 3
};

/** Find free bodies: sets of fluid rows connected by near pairs, without a near pair with an
 *  anchor. Not allowed in MPS_POPULATE. Solids may be anchors and are in no body. Uses up to 3
 *  workspace blocks during the call.
 *  @param most  bodies with more rows are not free @param role  [n] MPS_BODY_...
 *  @param body  [n] out: number of the free body from 0, in the order of their smallest ids, else
 *               -1
 *  @return 0, or non-zero after a failure (no memory; the error is set) */
MPS_API int mps_stage_bodies(mps_stage *s, int32_t most, int32_t *role, int32_t *body);

/** Hash grid of rows by square cells, for searches beyond the far radius. Bucket b contains the
 *  rows of all cells with that bucket, ascending: r = first[b] - 1, then r = next[r] - 1, until r
 *  is -1. */
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

/** Cell of a position x [dim]. */
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

/** Sort the fluid rows into cells of a given side. The grid is valid as long as workspace and takes
 *  2 blocks of it.
 *  @param grid  initialised by mps_grid_init(); out
 *  @return 0, or non-zero after a failure (no memory, side not > 0, grid not initialised) */
MPS_API int mps_stage_grid(mps_stage *s, double side, mps_grid *grid);

/** Position of a point of the lab in the frame of the tank, and the velocity of the rigid tank at
 *  this point over this step, equal to "velocity" of a solid particle there; in MPS_LIMIT the
 *  velocity at the beginning of the step.
 *  @param x  [dim] point, e.g. v->x + i * dim [m] @param place  NULL, or [dim] out [m]
 *  @param velocity  NULL, or [dim] out, in the lab [m/s] */
static inline void mps_view_tank(const mps_view *v, const double *x, double *place,
                                 double *velocity)
{
    const mps_tank_pose *k = &v->tank;
    const int dim = v->dim == 2 ? 2 : 3; /* a known bound, so that loops unroll */
    const double *R = k->rotation, *N = k->next_rotation;
    double r[3] = {0, 0, 0}, arm[3] = {0, 0, 0}, turned[3];
    for (int d = 0; d < dim; d++) r[d] = x[d] - k->centre[d] - k->shift[d];
    for (int d = 0; d < dim; d++) {
        const double X = k->centre[d] + (R[d] * r[0] + R[3 + d] * r[1] + R[6 + d] * r[2]);
        arm[d] = X - k->centre[d];
        if (place) place[d] = X;
    }
    if (!velocity) return;
    for (int d = 0; d < 3; d++)
        turned[d] = k->has_next ? N[3 * d] * arm[0] + N[3 * d + 1] * arm[1] + N[3 * d + 2] * arm[2]
                                : R[3 * d] * arm[0] + R[3 * d + 1] * arm[1] + R[3 * d + 2] * arm[2];
    for (int d = 0; d < dim; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        velocity[d] = k->has_next
                          ? (k->centre[d] + k->next_shift[d] + turned[d] - x[d]) / v->dt
                          : k->rate[d] + (k->omega[e] * turned[f] - k->omega[f] * turned[e]);
    }
}

/** Velocity of a particle relative to the rigid tank, with the rates of the tank at the beginning
 *  of the step; bitwise u if the tank is at rest. Compare speeds by it, so that a model does not
 *  depend on a uniform motion of the tank.
 *  @param dim  2 or 3, constant in a row function @param x  [dim] e.g. v->x + i * dim [m]
 *  @param u  [dim] its velocity in the lab @param relative  [dim] out [m/s] */
static inline void mps_view_relative(const int dim, const mps_view *v, const double *x,
                                     const double *u, double *relative)
{
    const mps_tank_pose *k = &v->tank;
    const double *w = k->omega;
    double arm[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) arm[d] = x[d] - k->centre[d] - k->shift[d];
    relative[0] = u[0] - (k->rate[0] + (dim == 2 ? -w[2] * arm[1] : w[1] * arm[2] - w[2] * arm[1]));
    relative[1] = u[1] - (k->rate[1] + (dim == 2 ? w[2] * arm[0] : w[2] * arm[0] - w[0] * arm[2]));
    if (dim == 3) relative[2] = u[2] - (k->rate[2] + (w[0] * arm[1] - w[1] * arm[0]));
}

/** Workspace or a channel whose values a verb wrote and then reads at neighbours. */
typedef struct mps_shared {
    /** [n*components], double or int32_t */
    void *values;
    /** Numbers per particle. */
    int32_t components;
    /** MPS_TYPE_REAL or MPS_TYPE_INTEGER */
    int32_t type;
} mps_shared;

/** Halo exchange of values that rows wrote. Call it between a loop that writes workspace or a
 *  channel and a loop of the same verb that reads it at neighbours. Channels that other verbs wrote
 *  need no call.
 *  @param shared  [count], 1..16 @return 0, or non-zero after a failure (the error is set) */
MPS_API int mps_stage_refresh(mps_stage *s, int32_t count, const mps_shared *shared);

/** Inflow, in MPS_POPULATE: particles of one phase, added when the verb returns. The budgets
 *  include them in `added`. On many ranks all ranks add the same particles.
 *  @param phase  a defined phase @param count  >= 0
 *  @param x  [count*dim] positions in the lab [m], finite, at least 0.5 dp apart from each other
 *            and from other particles; not checked
 *  @param u  [count*dim] velocities [m/s]
 *  @return 0, or non-zero after a failure (no memory, invalid arguments; the error is set) */
MPS_API int mps_stage_add(mps_stage *s, int32_t phase, int64_t count, const double *x,
                          const double *u);

/** Outflow, in MPS_POPULATE: rows that are removed when the verb returns. The budgets include them
 *  in `added` with a negative sign; they are not counted as lost. Several calls in a step add up.
 *  @param leaves  [n] not 0 for these rows; ignored for solids
 *  @return 0, or non-zero after a failure (the error is set) */
MPS_API int mps_stage_remove(mps_stage *s, const int32_t *leaves);

/** Workspace of `count` doubles, zeroed, valid until the verb returns. At most 16 blocks of both
 *  types in total.
 *  @return NULL: no memory, or too many blocks (the error is set; let the verb return non-zero) */
MPS_API double *mps_stage_scratch(mps_stage *s, int64_t count);

/** As mps_stage_scratch(), for integers. */
MPS_API int32_t *mps_stage_scratch_integers(mps_stage *s, int64_t count);

/** Report trapped gas, in MPS_SHIFT: for mps_step_info, and its work for mps_energy. Once a step;
 *  the last report is used. On many ranks all ranks report the same values.
 *  @param pockets  number, >= 0 @param volume  total of all pockets [m3, m2 in 2-D]
 *  @param pressure  gauge pressure of the largest magnitude of all pockets: pocket minus ambient
 *                   [Pa]
 *  @param work  of the gas on the liquid in this step [J]
 *  @return 0, or non-zero after a failure (another hook, a non-finite number; the error is set) */
MPS_API int mps_stage_gas(mps_stage *s, int32_t pockets, double volume, double pressure,
                          double work);
/** Numbers of a model that belong to no particle, e.g. amounts of gas. They exist as long as the
 *  model is active, are saved by checkpoints, and are restored after a failed step. All ranks write
 *  the same values. A model begins with none.
 *  @param count  required number: existing numbers keep their values, new ones are 0
 *  @return [count], shared by the verbs of the model, valid until the next call with another count
 *          or the end of the step; finite when the step ends. NULL: no memory, count < 0, or in
 *          MPS_POPULATE, where they can only be read (the error is set) */
MPS_API double *mps_stage_state(mps_stage *s, int64_t count);

/** Read the numbers of mps_stage_state(), in any hook. @param count  out
 *  @return [count] */
MPS_API const double *mps_stage_state_get(const mps_stage *s, int64_t *count);

/** Report a failure of a verb; arguments as printf. Returns 1, for `return mps_stage_fail(...)`. */
MPS_API int mps_stage_fail(mps_stage *s, const char *format, ...);

/** For row functions: inlined into their loops. */
#if defined(__GNUC__)
#define MPS_ROW static inline __attribute__((always_inline))
#else
#define MPS_ROW static inline
#endif

/** Source file of a loop, without folders if the compiler supports this. */
#if defined(__FILE_NAME__)
#define MPS_FILE __FILE_NAME__
#else
#define MPS_FILE __FILE__
#endif

/** Define the mps_rows `name` from a row function
 *    MPS_ROW void row(const int dim, const mps_view *v, const type *fields, int64_t i);
 *  compiled for dim = 2 and 3, so that loops over dim unroll. View and fields are local copies,
 *  which stay in registers: a loop without fields needs a struct too. */
#define MPS_ROWS(name, row, type)                                                                  \
    static void name##_run(const mps_view *view_, const void *fields_, int64_t begin, int64_t end) \
    {                                                                                              \
        const mps_view own_ = *view_;                                                              \
        const type given_ = *(const type *)fields_;                                                \
        if (own_.dim == 2)                                                                         \
            for (int64_t i = begin; i < end; i++) row(2, &own_, &given_, i);                       \
        else                                                                                       \
            for (int64_t i = begin; i < end; i++) row(3, &own_, &given_, i);                       \
    }                                                                                              \
    static const mps_rows name = {sizeof(mps_rows), sizeof(type), #name, name##_run, MPS_FILE};

/** Define the mps_sums `name` from a row function
 *    MPS_ROW void row(const int dim, const mps_view *v, const type *fields, int64_t i,
 *                     double *sums);
 *  It adds to sums[0] .. sums[count-1] only; for mps_stage_max() it raises them. */
#define MPS_SUMS(name, row, type)                                                                  \
    static void name##_run(const mps_view *view_, const void *fields_, int64_t begin, int64_t end, \
                           int32_t stride_, double *values_)                                       \
    {                                                                                              \
        const mps_view own_ = *view_;                                                              \
        const type given_ = *(const type *)fields_;                                                \
        if (own_.dim == 2)                                                                         \
            for (int64_t i = begin; i < end; i++)                                                  \
                row(2, &own_, &given_, i, values_ + (i - begin) * stride_);                        \
        else                                                                                       \
            for (int64_t i = begin; i < end; i++)                                                  \
                row(3, &own_, &given_, i, values_ + (i - begin) * stride_);                        \
    }                                                                                              \
    static const mps_sums name = {sizeof(mps_sums), sizeof(type), #name, name##_run, MPS_FILE};

MPS_END_DECLS

#endif
