/* SPDX-License-Identifier: BSD-3-Clause */
/** @file model.h  Plug-in interface of models: forces, walls, free surface, source, gradient, ...
 *
 *  A model is a table: name, help, settings, the channels that it provides and its verbs. A channel
 *  is a named array with a value per particle. A hook is a phase of the step. A verb is a callback
 *  with its hook and the channels that it reads and writes; it gets these arrays only. The library
 *  allocates, clears, permutes, saves and frees channels, and it runs all loops over particles.
 *  Built-in models use this interface only.
 *
 *  Notation: n particles, dim = 2 or 3; rows are particles in their current order.
 *
 *  Order: hooks run in the order of MPS_POPULATE .. MPS_SHIFT. Within a hook a verb that writes a
 *  channel runs before verbs that change it, and these run before verbs that only read it. An
 *  `after` or `before` of a verb takes precedence over this; otherwise the order of registration
 *  holds. mps_verb_info_get() returns the resulting order. A cycle of verbs fails the step with
 *  MPS_E_STATE and the names of their models.
 *
 *  Channels are resolved at the beginning of the first step after a change of models. This step
 *  fails with MPS_E_STATE if no active model provides a channel, or if its access is not allowed in
 *  this hook.
 *
 *  Optional channels that built-in models use if a model provides them:
 *    "viscosity" [Pa s], 1 number, MPS_LIFE_STEP: "viscosity.laplacian" and "viscosity.pair" use it
 *    instead of the viscosity of the phase. Write it in MPS_PREPARE. The time control uses the
 *    viscosities of the phases only: limit the step in MPS_LIMIT.
 *
 *  Tutorial: docs/tutorials/your_own_model.md. The package has a conformance kit, model_kit.h,
 *  which runs a model and reports the rules that it violates. */
#ifndef MPS_MODEL_H
#define MPS_MODEL_H

#include <mps/stage.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_model_ops.api: it fixes the layout of all tables below. */
#define MPS_MODEL_API 1u

/** How a verb uses a channel: a sum of these. READ + WRITE changes values. */
enum {
    /** Reads the values of its own row. */
    MPS_USE_READ = 1,
    /** Reads values of neighbours within the far radius too. Implies MPS_USE_READ. A loop that
     *  reads a channel at neighbours must not write it: write a workspace array first, and the
     *  channel in a second loop. */
    MPS_USE_NEIGHBOURS = 2,
    /** Writes values of its own row. Without MPS_USE_READ the previous values must not be read.
     *  Rows that are not written keep their values. */
    MPS_USE_WRITE = 4,
    /** Reads and writes its own row. */
    MPS_USE_CHANGE = 5,
    /** The channel is optional: its array is NULL if no active model provides it. */
    MPS_USE_OPTIONAL = 8,
    /** Reads values of the neighbours of dummies too. Implies MPS_USE_NEIGHBOURS. Without an active
     *  model with this access, dummies have empty rows in mps_view.near and .far. */
    MPS_USE_DUMMIES = 16,
    /** Reads the near pair lists of neighbours within the far radius too, and values of the
     *  particles in these lists. Implies MPS_USE_NEIGHBOURS. */
    MPS_USE_ROWS = 32
};

/** A channel that a verb uses. Its array is s->data[k], k the index in mps_verb.uses. */
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
    /** As long as its particle: it is permuted and migrated with the particle, saved by
     *  checkpoints, restored after a failed step, and is a field for mps_lease_begin(), e.g. to
     *  write initial values after mps_model_use(). Verbs of all hooks may read it; verbs of all
     *  hooks except MPS_POPULATE may write it. If its model is switched off, the field remains with
     *  its values. Real numbers only. */
    MPS_LIFE_PARTICLE = 1
};

/** Components of a vector and of a matrix: dim and dim*dim numbers a particle. A scalar is one
 *  number for all particles: its array has one entry, which a verb reads and writes outside of
 *  loops; all ranks must write the same value. */
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
    /** Value at the beginning of a step (MPS_LIFE_PARTICLE: of a new particle). For a matrix: value
     *  of the diagonal; the other entries are 0. */
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

/** One action of a model at one hook of a step. */
typedef struct mps_verb {
    /** MPS_POPULATE .. MPS_SHIFT */
    int32_t hook;
    /** Number of entries of uses, 0..24. */
    int32_t use_count;
    /** Channels that it uses. */
    const mps_use *uses;
    /** NULL, or a slot, e.g. "source": the verb runs after that model. "*": after all others. */
    const char *after;
    /** NULL, or a slot: the verb runs before that model. "*": before all others. */
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
    int32_t part_count; /**< Entries of parts, 0..8. */
    /** Numbers that a user may set. */
    const mps_setting *settings;
    /** Channels that it provides. */
    const mps_channel *channels;
    /** Its verbs. */
    const mps_verb *verbs;
    /** NULL, or create a state in *self; on entry *self is `user`. Non-zero: out of memory.
     *  Checkpoints do not save the state: data that later steps depend on must be in channels of
     *  MPS_LIFE_PARTICLE or in numbers of mps_stage_state(). */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Frees the state of create; required with create. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Data of the caller; without create the verbs get it as s->self. */
    void *user;
    /** NULL, or the largest distance at which its verbs read particles, if it exceeds the far
     *  radius [m].
     *  @param setting  values of the settings in the order of `settings` @param dp  spacing [m] */
    double (*reach)(const double *setting, double dp);
    /** [part_count] names of the solids without particles that it represents, see mps/reaction.h */
    const char *const *parts;
    /** NULL, or validate the numbers of mps_stage_state() in a checkpoint, which another build of
     *  the model may have written or which may be manipulated. Non-zero: the checkpoint is refused
     *  with `why`, and the simulation is unchanged.
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
