/* SPDX-License-Identifier: BSD-3-Clause */
/** @file model.h  Plug-in interface of models: forces, walls, free surface, source, gradient, ...
 *
 *  A model is a table: name, help, settings, the channels it brings and its verbs. A channel is a
 *  named array with a value per particle. A hook is a place in the step. A verb is a
 *  function with its hook and the channels that it reads and writes; it gets those arrays and no
 *  others. The library makes, clears, moves, saves and frees
 *  channels, and it runs all loops over particles. Built-in models use this interface and no other.
 *
 *  Notation: n particles, dim = 2 or 3; rows are particles in their present order.
 *
 *  Order: hooks run in the order of MPS_POPULATE .. MPS_SHIFT. Within a hook a verb that writes a
 *  channel runs before verbs that change it, and these run before verbs that only read it. An
 *  `after` or `before` of a verb takes precedence over this; otherwise the order of registration
 *  holds. mps_verb_info_get() tells the order that results; verbs that wait
 *  for each other fail the step with MPS_E_STATE and the names of their models.
 *
 *  Channels are looked up when the first step after a change of models begins: a channel that no
 *  active model brings, or that cannot be used so in this hook, fails it with MPS_E_STATE.
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

#include <mps/stage.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_model_ops.api: it fixes the layout of all tables below. */
#define MPS_MODEL_API 1u

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
     *  model that does, dummies have no rows in mps_view.near and .far. */
    MPS_USE_DUMMIES = 16,
    /** Reads the near rows of neighbours within the far radius too, and values of the particles in
     *  these rows. Implies MPS_USE_NEIGHBOURS. */
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
    /** From the beginning of MPS_MOTION to the end of the step; not kept. */
    MPS_LIFE_STEP = 0,
    /** As long as its particle: it travels with it, is saved by checkpoints, comes back after a
     *  failed step, and is a field for mps_lease_begin(), e.g. to write first values after
     *  mps_model_use(). Verbs of all hooks may read it, and all but MPS_POPULATE may write it. When
     *  its model is switched off the field stays with its values. Real numbers only. */
    MPS_LIFE_PARTICLE = 1
};

/** Components of a vector and of a matrix: dim and dim*dim numbers a particle. A scalar is one
 *  number for all particles: its array has one entry, which a verb reads and writes itself; many
 *  ranks write the same. */
enum { MPS_VECTOR = -1, MPS_MATRIX = -2, MPS_SCALAR = -3 };

/** A named array with a value per particle that a model brings. Two models may bring the same one
 *  if all entries but `help` agree. mps_channel_info_get() lists the library's own channels. */
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

/** One action of a model at one hook of a step. */
typedef struct mps_verb {
    /** MPS_POPULATE .. MPS_SHIFT */
    int32_t hook;
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
    int32_t part_count; /**< Entries of parts, 0..8. */
    /** Numbers that a user may set. */
    const mps_setting *settings;
    /** Channels that it brings. */
    const mps_channel *channels;
    /** What it does. */
    const mps_verb *verbs;
    /** NULL, or make a state in *self, which holds `user` before. Non-zero: no memory.
     *  Checkpoints do not save the state: what later steps depend on must be in channels of
     *  MPS_LIFE_PARTICLE, or in numbers of mps_stage_state(). */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Gives back what create made; needed with create. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Data of the caller, e.g. a pointer that the verbs need as s->self. */
    void *user;
    /** NULL, or the farthest distance at which its verbs look at particles, if it is more than the
     *  far radius [m].
     *  @param setting  values of the settings in their order @param dp  spacing [m] */
    double (*reach)(const double *setting, double dp);
    /** [part_count] names of solids without particles that it stands for, see mps/reaction.h */
    const char *const *parts;
    /** NULL, or look at numbers of mps_stage_state() that a checkpoint brings, which may be of
     *  another build of the model or forged. The checkpoint is refused with `why` if it returns
     *  non-zero, and nothing has changed then.
     *  @param numbers  [count], finite @param why  [size] out: what does not fit, one line */
    int (*check)(const double *numbers, int64_t count, char *why, size_t size);
} mps_model_ops;

/** Register a model on a handle; the table is copied. Then choose it with mps_model_use().
 *  @return MPS_E_ARG (which entry, and what is allowed), MPS_E_VERSION, MPS_E_BUSY */
MPS_API mps_status mps_model_register(mps_sim *sim, const mps_model_ops *ops);

/** Densities of the fluid, by phases. Most steps need no loop over the rows for them. All ranks
 *  call it.
 *  @param least  NULL, or [MPS_PHASES] out: of the fluid of each phase; 0 without any [kg/m3]
 *  @param greatest  likewise */
MPS_API void mps_stage_densities(const mps_stage *s, double *least, double *greatest);

MPS_END_DECLS

#endif
