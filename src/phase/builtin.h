/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in models of the fluid, in one place. */
#ifndef MPS_PHASE_BUILTIN_H
#define MPS_PHASE_BUILTIN_H

#include <mps/model.h>

extern const mps_model_ops mps__viscosity_laplacian;
extern const mps_model_ops mps__source_mixed;
extern const mps_model_ops mps__gradient_conservative;
extern const mps_model_ops mps__collision_pair;

/* All of them; the last entry is NULL. */
const mps_model_ops *const *mps__builtin_phase(void);

#endif
