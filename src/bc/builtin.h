/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in models of boundaries: walls, free surface, level of the pressures. */
#ifndef MPS_BC_BUILTIN_H
#define MPS_BC_BUILTIN_H

#include <mps/model.h>
#include <stdbool.h>

extern const mps_model_ops mps__surface_asymmetry, mps__surface_detached, mps__surface_original;
extern const mps_model_ops mps__wall_half, mps__wall_extrapolate, mps__body_free;
extern const mps_model_ops mps__load_reaction, mps__separation_void;
extern const mps_model_ops mps__reference_gas, mps__reference_lid;

/* Unit vector against gravity; false without gravity. */
bool mps__upward(const mps_stage *s, double up[3]);

/* Height of particle i along it [m]. */
double mps__height(const mps_stage *s, const double up[3], int64_t i);

/* All of them, in the order in which verbs run where nothing else decides; ends with NULL. */
const mps_model_ops *const *mps__builtin_bc(void);

#endif
