/* SPDX-License-Identifier: BSD-3-Clause */
/* Built-in models and presets. */
#ifndef MPS_CORE_BUILT_IN_H
#define MPS_CORE_BUILT_IN_H

#include <mps/model.h>

extern const mps_model_ops mps__surface_asymmetry;
extern const mps_model_ops mps__surface_detached;
extern const mps_model_ops mps__surface_original;
extern const mps_model_ops mps__reference_lid;
extern const mps_model_ops mps__wall_half;
extern const mps_model_ops mps__wall_extrapolate;
extern const mps_model_ops mps__body_free;
extern const mps_model_ops mps__moments_bounded;
extern const mps_model_ops mps__density_smooth;
extern const mps_model_ops mps__density_interface;
extern const mps_model_ops mps__viscosity_laplacian;
extern const mps_model_ops mps__viscosity_pair;
extern const mps_model_ops mps__dissipation_radial;
extern const mps_model_ops mps__tension_csf;
extern const mps_model_ops mps__tension_jump;
extern const mps_model_ops mps__friction_history;
extern const mps_model_ops mps__layer_history;
extern const mps_model_ops mps__reference_gas;
extern const mps_model_ops mps__source_mixed;
extern const mps_model_ops mps__source_volume;
extern const mps_model_ops mps__gas_compressible;
extern const mps_model_ops mps__gas_isentropic;
extern const mps_model_ops mps__gas_pocket;
extern const mps_model_ops mps__separation_void;
extern const mps_model_ops mps__cavitation_vapour;
extern const mps_model_ops mps__gradient_conservative;
extern const mps_model_ops mps__gradient_corrected;
extern const mps_model_ops mps__gradient_density;
extern const mps_model_ops mps__load_reaction;
extern const mps_model_ops mps__drag_lone;
extern const mps_model_ops mps__collision_pair;
extern const mps_model_ops mps__shift_tangential;

/* All built-in models, terminated by NULL. */
extern const mps_model_ops *const mps__built_in_models[];

/* Line of a preset: activate a model (key NULL), or change a setting of the model activated
 * last. */
typedef struct mps__preset_line {
    const char *model, *key;
    double value;
} mps__preset_line;

/* A list of models and settings that a user could also write. */
typedef struct mps__preset {
    const char *name, *help;
    const mps__preset_line *lines; /* terminated by a line without a model */
} mps__preset;

enum { MPS__PRESETS = 4 };
extern const mps__preset mps__presets[MPS__PRESETS];

#endif
