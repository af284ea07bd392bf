/* SPDX-License-Identifier: BSD-3-Clause */
/** @file list.h  What there is: presets, models, settings, channels, verbs, solvers,
 *  preconditioners, kernels; built in or registered on the handle.
 *
 *  All functions named ..._info_get() take an index from 0 and return MPS_E_ARG beyond the last,
 *  without an error text: loop until they fail. Texts are valid until models or solvers change. */
#ifndef MPS_LIST_H
#define MPS_LIST_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A model. */
typedef struct mps_model_info {
    /** Set by mps_model_info_init(). */
    uint32_t struct_size;
    /** 1: switched on */
    int32_t active;
    /** "slot.variant" */
    const char *name;
    /** One line. */
    const char *help;
    /** Number of settings. */
    int32_t settings;
    /** Number of channels that it brings. */
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
    /** Present value; the default if the model is not active. */
    double value;
} mps_setting_info;

/** A channel: the library's own, or brought by an active model. */
typedef struct mps_channel_info {
    /** Set by mps_channel_info_init(). */
    uint32_t struct_size;
    /** Numbers per particle. */
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
    /** Moments in which verbs may read it: bits 1 << MPS_LIMIT .. 1 << MPS_SHIFT. */
    uint32_t reads;
    /** Moments in which verbs may write it. */
    uint32_t writes;
    /** 1: the library's own. */
    int32_t own;
} mps_channel_info;

/** A verb of an active model, in the order in which a step runs them. */
typedef struct mps_verb_info {
    /** Set by mps_verb_info_init(). */
    uint32_t struct_size;
    /** MPS_LIMIT .. MPS_SHIFT of mps/model.h */
    int32_t moment;
    /** e.g. "force" */
    const char *moment_name;
    /** Name of the model. */
    const char *model;
    /** Channels that it uses, "name:r", "name:n" (neighbours), "name:d" (of dummies too), "name:a"
     *  (and their neighbours), "name:w", "name:rw", "name:nw", with a "?" behind if the channel may
     *  be missing and a space between two. */
    const char *uses;
} mps_verb_info;

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
MPS_API mps_status mps_name_info_init(mps_name_info *info, size_t size);

/** Model number `index` of all that are known. */
MPS_API mps_status mps_model_info_get(const mps_sim *sim, int32_t index, mps_model_info *info);

/** Setting number `index` of a model. @param model  full name @return MPS_E_NAME */
MPS_API mps_status mps_setting_info_get(const mps_sim *sim, const char *model, int32_t index,
                                        mps_setting_info *info);

/** Channel number `index`. */
MPS_API mps_status mps_channel_info_get(const mps_sim *sim, int32_t index, mps_channel_info *info);

/** Verb number `index` of the active models, in the order of a step.
 *  @return MPS_E_STATE: the active models have no order, with text */
MPS_API mps_status mps_verb_info_get(mps_sim *sim, int32_t index, mps_verb_info *info);

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
