/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in models of the fluid, in one place. */
#ifndef MPS_PHASE_BUILTIN_H
#define MPS_PHASE_BUILTIN_H

#include <mps/model.h>

extern const mps_model_ops mps__moments_bounded;
extern const mps_model_ops mps__viscosity_laplacian, mps__dissipation_radial;
extern const mps_model_ops mps__source_mixed, mps__source_volume;
extern const mps_model_ops mps__gradient_conservative, mps__gradient_corrected;
extern const mps_model_ops mps__collision_pair, mps__shift_tangential;

/* All of them; the last entry is NULL. */
const mps_model_ops *const *mps__builtin_phase(void);

#endif
