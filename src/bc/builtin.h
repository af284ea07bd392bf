/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in models of boundaries, in one place. */
#ifndef MPS_BC_BUILTIN_H
#define MPS_BC_BUILTIN_H

#include <mps/model.h>
#include <stdbool.h>

/* Loops over the pairs of one row take dim as their first argument and are compiled for 2 and 3, so that loops over d unroll. */
#define MPS__ROW                 static inline __attribute__((always_inline))
#define MPS__ROW_CALL(s, f, ...) ((s)->dim == 2 ? f(2, __VA_ARGS__) : f(3, __VA_ARGS__))

extern const mps_model_ops mps__surface_asymmetry, mps__surface_detached, mps__surface_original;
extern const mps_model_ops mps__wall_half, mps__wall_extrapolate, mps__body_free;
extern const mps_model_ops mps__load_reaction, mps__separation_void;
extern const mps_model_ops mps__reference_gas, mps__reference_lid;

/* Unit vector against gravity; false without gravity. */
bool mps__upward(const mps_stage *s, double up[3]);
/* Height of particle i along it [m]. */
double mps__height(const mps_stage *s, const double up[3], int64_t i);

/* Density of the fluid nearest to a solid particle, spray aside; its own without any near. */
double mps__density_beside(const mps_stage *s, int64_t i);

/* All of them; the last entry is NULL. */
const mps_model_ops *const *mps__builtin_bc(void);

#endif
