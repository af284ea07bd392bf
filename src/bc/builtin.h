/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in models of boundaries, in one place. */
#ifndef MPS_BC_BUILTIN_H
#define MPS_BC_BUILTIN_H

#include <mps/model.h>

extern const mps_model_ops mps__surface_asymmetry, mps__surface_original;
extern const mps_model_ops mps__wall_half, mps__wall_extrapolate;

/* All of them; the last entry is NULL. */
const mps_model_ops *const *mps__builtin_bc(void);

#endif
