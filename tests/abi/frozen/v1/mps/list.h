/* SPDX-License-Identifier: BSD-3-Clause */
/** @file list.h  Lists of presets, models, settings, channels, verbs, solvers, preconditioners and
 *  kernels, built in or registered on the handle; passes of a step and their cost.
 *
 *  All functions ..._info_get() take an index from 0 and return MPS_E_ARG beyond the last entry,
 *  without an error text: loop until they fail. Texts are valid until models or solvers change. */
#ifndef MPS_LIST_H
#define MPS_LIST_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A model. */
typedef struct mps_model_info {
    /** Set by mps_model_info_init(). */
    uint32_t struct_size;
    /** 1: active */
    int32_t active;
    /** "slot.variant" */
    const char *name;
    /** One line. */
    const char *help;
    /** Number of settings. */
    int32_t settings;
    /** Number of channels that it provides. */
    int32_t channels;
    /** Number of verbs. */
    int32_t verbs;
    /** 1: built in, 0: registered by the user. */
    int32_t built_in;
} mps_model_info;

/** A setting of a model. */
typedef struct mps_setting_info {
    /** Set by mps_setting_info_init(). */
    uint32_t struct_size;
    /** MPS_TYPE_... of mps/model.h */
    int32_t type;
    /** As for mps_model_set(). */
    const char *key;
    /** e.g. "m/s"; "-" for none */
    const char *unit;
    /** One line. */
    const char *help;
    /** Default. */
    double initial;
    /** Smallest allowed value. */
    double min;
    /** Largest allowed value. */
    double max;
    /** Current value; the default if the model is not active. */
    double value;
} mps_setting_info;

/** A channel: of the library, or provided by an active model. */
typedef struct mps_channel_info {
    /** Set by mps_channel_info_init(). */
    uint32_t struct_size;
    /** Numbers per particle; 0: a scalar, one number for all particles. */
    int32_t components;
    /** MPS_TYPE_REAL or MPS_TYPE_INTEGER of mps/model.h */
    int32_t type;
    /** MPS_LIFE_STEP or MPS_LIFE_PARTICLE of mps/model.h */
    int32_t life;
    /** e.g. "density" */
    const char *name;
    /** e.g. "kg/m3"; "-" for none */
    const char *unit;
    /** One line. */
    const char *help;
    /** Hooks in which verbs may read it: bits 1 << MPS_POPULATE .. 1 << MPS_SHIFT. */
    uint32_t reads;
    /** Hooks in which verbs may write it. */
    uint32_t writes;
    /** 1: of the library; 0: of a model. */
    int32_t own;
} mps_channel_info;

/** A verb of an active model, in the order in which a step runs them. */
typedef struct mps_verb_info {
    /** Set by mps_verb_info_init(). */
    uint32_t struct_size;
    /** MPS_POPULATE .. MPS_SHIFT of mps/stage.h */
    int32_t hook;
    /** e.g. "force" */
    const char *hook_name;
    /** Name of the model. */
    const char *model;
    /** Channels that it uses, separated by spaces: "name:r" (read), "name:n" (neighbours), "name:d"
     *  (neighbours of dummies too), "name:a" (neighbours and their neighbours), "name:w" (write),
     *  "name:rw", "name:nw"; followed by "?" if the channel is optional. */
    const char *uses;
} mps_verb_info;

/** A pass, a part of a step, in the order in which a step runs them, and its cost. The seconds of
 *  all passes sum to mps_step_info.seconds. */
typedef struct mps_pass_info {
    /** Set by mps_pass_info_init(). */
    uint32_t struct_size;
    /** MPS_POPULATE .. MPS_SHIFT of mps/stage.h; -1: no hook */
    int32_t hook;
    /** e.g. "force"; "step" for hook -1 */
    const char *hook_name;
    /** For a verb: name of its model; else name of the pass, e.g. "predict". */
    const char *name;
    /** Channels that it uses, as mps_verb_info.uses. Passes of the library also use arrays that are
     *  not listed channels. */
    const char *uses;
    /** 1: a verb of a model, 0: a pass of the library. */
    int32_t model;
    /** Kept 0. */
    int32_t reserved;
    /** Calls since the last change of models or mps_profile_reset(), including those of failed
     *  steps. A pass that is not needed in a step is not called, e.g. "body" without a rigid
     *  body. */
    int64_t calls;
    /** Wall-clock time of these calls on this rank [s]. */
    double seconds;
    /** Bytes of the arrays in `uses`, once for reading and once for writing, summed over the calls:
     *  a lower bound of the memory traffic of loops over all particles. Neighbour lists, matrices
     *  and arrays that are not in `uses` are not included. */
    double bytes;
} mps_pass_info;

/** A preset, solver, preconditioner or kernel. */
typedef struct mps_name_info {
    /** Set by mps_name_info_init(). */
    uint32_t struct_size;
    /** 1: in use; 0 for presets */
    int32_t active;
    /** Name. */
    const char *name;
    /** One line. */
    const char *help;
} mps_name_info;

/** Set struct_size and zero. */
MPS_API mps_status mps_model_info_init(mps_model_info *info, size_t size);
/** Set struct_size and zero. */
MPS_API mps_status mps_setting_info_init(mps_setting_info *info, size_t size);
/** Set struct_size and zero. */
MPS_API mps_status mps_channel_info_init(mps_channel_info *info, size_t size);
/** Set struct_size and zero. */
MPS_API mps_status mps_verb_info_init(mps_verb_info *info, size_t size);
/** Set struct_size and zero. */
MPS_API mps_status mps_pass_info_init(mps_pass_info *info, size_t size);
/** Set struct_size and zero. */
MPS_API mps_status mps_name_info_init(mps_name_info *info, size_t size);

/** Model number `index` of all registered and built-in models. */
MPS_API mps_status mps_model_info_get(const mps_sim *sim, int32_t index, mps_model_info *info);

/** Setting number `index` of a model. @param model  full name @return MPS_E_NAME */
MPS_API mps_status mps_setting_info_get(const mps_sim *sim, const char *model, int32_t index,
                                        mps_setting_info *info);

/** Channel number `index`. */
MPS_API mps_status mps_channel_info_get(const mps_sim *sim, int32_t index, mps_channel_info *info);

/** Verb number `index` of the active models, in the order of execution.
 *  @return MPS_E_STATE: the active models have no valid order; with text */
MPS_API mps_status mps_verb_info_get(mps_sim *sim, int32_t index, mps_verb_info *info);

/** Pass number `index` of a step, including verbs of models, in the order of execution.
 *  @return MPS_E_STATE: the active models have no valid order; with text */
MPS_API mps_status mps_pass_info_get(mps_sim *sim, int32_t index, mps_pass_info *info);

/** Set calls, seconds and bytes of all passes to zero.
 *  @return MPS_E_STATE: the active models have no valid order; MPS_E_BUSY: called from a verb or a
 *          callback; a monitor may call it */
MPS_API mps_status mps_profile_reset(mps_sim *sim);

/** Preset number `index`, for mps_preset_use(). */
MPS_API mps_status mps_preset_info_get(const mps_sim *sim, int32_t index, mps_name_info *info);

/** Pressure solver number `index`, for mps_solver_use(). */
MPS_API mps_status mps_solver_info_get(const mps_sim *sim, int32_t index, mps_name_info *info);

/** Preconditioner number `index`, for mps_solver_use(). */
MPS_API mps_status mps_preconditioner_info_get(const mps_sim *sim, int32_t index,
                                               mps_name_info *info);

/** Kernel number `index`, for mps_config.kernel. */
MPS_API mps_status mps_kernel_info_get(const mps_sim *sim, int32_t index, mps_name_info *info);

MPS_END_DECLS

#endif
