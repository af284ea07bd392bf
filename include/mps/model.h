/* SPDX-License-Identifier: BSD-3-Clause */
/** @file model.h  Plug-in interface of models: forces, walls, free surface, source, gradient, ...
 *
 *  A model is a table: name, help, settings, the channels that it provides and its verbs. A channel
 *  is a named array with a value per particle. A hook is a phase of the step. A verb is a callback;
 *  it declares its hook and the channels that it reads and writes, and gets only these arrays. The
 *  library allocates, clears, permutes, saves and frees channels, and it runs all loops over
 *  particles. Built-in models use only this interface.
 *
 *  Notation: n particles, dim = 2 or 3; row i is particle i of the current order.
 *
 *  Order: hooks run in the order of MPS_POPULATE .. MPS_SHIFT. Within a hook a verb that writes a
 *  channel runs before verbs that change it, and these run before verbs that only read it. `after`
 *  and `before` of a verb take precedence over this order. If neither decides, the order of
 *  registration holds. mps_verb_info_get() returns the resulting order. If the order of verbs is
 *  cyclic, the step fails with MPS_E_STATE and the names of two of their models.
 *
 *  Channels are resolved at the beginning of the first step after a change of models. This step
 *  fails with MPS_E_STATE if a verb uses a channel that no active model provides, or if the channel
 *  does not allow this access in the hook of the verb.
 *
 *  Optional channels that built-in models use if a model provides them:
 *    "viscosity" [Pa s], 1 number, MPS_LIFE_STEP: "viscosity.laplacian" and "viscosity.pair" use it
 *    instead of the viscosity of the phase. Write it in MPS_PREPARE. The time control uses only the
 *    viscosities of the phases, so such a model must also limit the step, in MPS_LIMIT.
 *    "interface_distance" [m], "pressure_jump" [Pa], "wetted_share" [-]: the fluxes of mps/flux.h
 *    use them; "reference.lid" also uses "wetted_share".
 *
 *  Tutorial: docs/tutorials/your_own_model.md. The package has a conformance kit, model_kit.h,
 *  which runs a model and reports the rules that it violates. */
#ifndef MPS_MODEL_H
#define MPS_MODEL_H

#include <mps/stage.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_model_ops.api: it fixes the layout of all tables below. */
#define MPS_MODEL_API 1u

/** How a verb uses a channel: a sum of these values. */
enum {
    /** Reads the values of its own row. */
    MPS_USE_READ = 1,
    /** Reads values of neighbours within the far radius too. Implies MPS_USE_READ. A loop that
     *  reads a channel at neighbours must not write it: write a workspace array first, and copy it
     *  to the channel in a second loop. */
    MPS_USE_NEIGHBOURS = 2,
    /** Writes values of its own row. Without MPS_USE_READ the previous values must not be read.
     *  Rows that are not written keep their values. */
    MPS_USE_WRITE = 4,
    /** MPS_USE_READ + MPS_USE_WRITE: reads and writes values of its own row. */
    MPS_USE_CHANGE = 5,
    /** The channel is optional: its array is NULL if no active model provides it. */
    MPS_USE_OPTIONAL = 8,
    /** Also reads values at the neighbours of dummies. Implies MPS_USE_NEIGHBOURS. If no active
     *  model has this access, dummies have empty rows in mps_view.near and .far. */
    MPS_USE_DUMMIES = 16,
    /** Also reads the near pair lists of the neighbours within the far radius, and the values of
     *  the particles in these lists. Implies MPS_USE_NEIGHBOURS. */
    MPS_USE_ROWS = 32
};

/** A channel that a verb uses. mps_stage.data[k] is the array of mps_verb.uses[k]. */
typedef struct mps_use {
    /** Name of the channel. */
    const char *channel;
    /** Sum of MPS_USE_... */
    int32_t access;
} mps_use;

/** Lifetime of a channel. */
enum {
    /** From the beginning of MPS_MOTION to the end of the step. */
    MPS_LIFE_STEP = 0,
    /** As long as its particle. The library permutes and migrates the values with the particle,
     *  saves them in checkpoints and restores them after a failed step. The channel is a field, so
     *  mps_lease_begin() gives access to it, e.g. to write initial values after mps_model_use().
     *  Verbs of all hooks may read it; verbs of all hooks except MPS_POPULATE may write it. If its
     *  model is switched off, the field keeps its values. Real numbers only. */
    MPS_LIFE_PARTICLE = 1
};

/** Components of a channel. MPS_VECTOR: dim numbers per particle. MPS_MATRIX: dim*dim numbers per
 *  particle. MPS_SCALAR: one number for all particles. Its array has one entry, which a verb reads
 *  and writes outside of loops; all ranks must write the same value. */
enum { MPS_VECTOR = -1, MPS_MATRIX = -2, MPS_SCALAR = -3 };

/** A named array with a value per particle that a model provides. Two models may provide the same
 *  channel if all entries except `help` are equal. mps_channel_info_get() lists the library's own
 *  channels. */
typedef struct mps_channel {
    /** 1..31 characters, not one of the library's own. */
    const char *name;
    /** e.g. "kg/m3"; "-" for none */
    const char *unit;
    /** One line: what it is. */
    const char *help;
    /** Numbers per particle: 1..9, MPS_VECTOR or MPS_MATRIX; MPS_SCALAR with MPS_LIFE_STEP. */
    int32_t components;
    /** MPS_TYPE_REAL or MPS_TYPE_INTEGER */
    int32_t type;
    /** MPS_LIFE_... */
    int32_t life;
    /** MPS_LIFE_STEP: value at the beginning of each step. MPS_LIFE_PARTICLE: value of a new
     *  particle. For a matrix: value of the diagonal; the other entries are 0. */
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
    /** MPS_TYPE_REAL, MPS_TYPE_INTEGER or MPS_TYPE_FLAG */
    int32_t type;
    /** Default. */
    double initial;
    /** Smallest allowed value. */
    double min;
    /** Largest allowed value. */
    double max;
} mps_setting;

/** One action of a model at one hook of a step. */
typedef struct mps_verb {
    /** MPS_POPULATE .. MPS_SHIFT */
    int32_t hook;
    /** Number of entries of uses, 0..24. */
    int32_t use_count;
    /** Channels that it uses. */
    const mps_use *uses;
    /** NULL, or a slot, e.g. "source": the verb runs after the verbs of the model in that slot at
     *  the same hook. "*": after all others. */
    const char *after;
    /** NULL, or a slot: the verb runs before the verbs of the model in that slot at the same hook.
     *  "*": before all others. */
    const char *before;
    /** The action. @return 0, or non-zero after mps_stage_fail() */
    int (*run)(mps_stage *s);
    /** 1: the verb runs on the device of the handle, if it has one (<mps/device.h>). Then the
     *  arrays of mps_stage.data, of workspace and of the view are in device memory: the verb reads
     *  and writes them in loops of mps_stage_rows(), mps_stage_sum() and mps_stage_max() only.
     *  Scalars, and settings outside of loops, are in host memory. 0: it runs on the host; the
     *  library copies the arrays. Ignored in MPS_POPULATE, which is on the host. */
    int32_t device;
    /** Kept 0. */
    int32_t reserved;
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
    int32_t part_count; /**< Entries of parts, 0..8. */
    /** Numbers that a user may set. */
    const mps_setting *settings;
    /** Channels that it provides. */
    const mps_channel *channels;
    /** Its verbs. */
    const mps_verb *verbs;
    /** NULL, or a function that creates the state of the model in *self; on entry *self is `user`.
     *  It returns 0, or non-zero if memory is insufficient. Checkpoints do not save the state: data
     *  that later steps depend on must be in channels of MPS_LIFE_PARTICLE or in numbers of
     *  mps_stage_state(). */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Frees the state of create; required if create is not NULL. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Data of the caller. If create is NULL, verbs get it as s->self. */
    void *user;
    /** NULL, or a function that returns the largest distance at which verbs of the model read
     *  particles [m]. It is needed only if this distance exceeds the far radius.
     *  @param setting  values of the settings in the order of `settings`
     *  @param dp  particle spacing [m] */
    double (*reach)(const double *setting, double dp);
    /** [part_count] names of solids without particles; the model reports their forces
     *  (mps/reaction.h). */
    const char *const *parts;
    /** NULL, or a function that validates the numbers of mps_stage_state() in a checkpoint: another
     *  build of the model may have written them, or the file may be manipulated. If it returns
     *  non-zero, the checkpoint is refused with `why`, and the simulation is unchanged.
     *  @param numbers  [count], finite @param why  [size] out: the reason, one line */
    int (*check)(const double *numbers, int64_t count, char *why, size_t size);
} mps_model_ops;

/** Register a model on a handle; the table is copied. Then select it with mps_model_use().
 *  @return MPS_E_ARG (which entry, and what is allowed), MPS_E_VERSION, MPS_E_BUSY */
MPS_API mps_status mps_model_register(mps_sim *sim, const mps_model_ops *ops);

/** Smallest and largest density of each phase. In most steps this needs no loop over particles.
 *  Collective: all ranks call it.
 *  @param least  NULL, or [MPS_PHASES] out: minimum of each phase; 0 for a phase without fluid
 *                [kg/m3]
 *  @param greatest  NULL, or [MPS_PHASES] out: maximum of each phase; 0 as above [kg/m3] */
MPS_API void mps_stage_densities(const mps_stage *s, double *least, double *greatest);

MPS_END_DECLS

#endif
