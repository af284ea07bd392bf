/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in models of the fluid, in one place. */
#ifndef MPS_PHASE_BUILTIN_H
#define MPS_PHASE_BUILTIN_H

#include <mps/model.h>
#include <mps/ppe.h>
#include <stdbool.h>

/* Loops over the pairs of one row take dim as their first argument and are compiled for 2 and 3, so that loops over d unroll. */
#define MPS__ROW                 static inline __attribute__((always_inline))
#define MPS__ROW_CALL(s, f, ...) ((s)->dim == 2 ? f(2, __VA_ARGS__) : f(3, __VA_ARGS__))

extern const mps_model_ops mps__moments_bounded;
extern const mps_model_ops mps__viscosity_laplacian, mps__dissipation_radial, mps__friction_sides;
extern const mps_model_ops mps__drag_lone;
extern const mps_model_ops mps__source_mixed, mps__source_volume;
extern const mps_model_ops mps__gradient_conservative, mps__gradient_corrected;
extern const mps_model_ops mps__collision_pair, mps__shift_tangential;
extern const mps_model_ops mps__density_smooth, mps__density_interface, mps__viscosity_pair, mps__tension_csf, mps__tension_jump,
    mps__gradient_density;
extern const mps_model_ops mps__gas_compressible, mps__gas_isentropic;

/* Phases of mps_stage.viscosity. */
enum { MPS__PHASE_LIMIT = 16 };

/* Least density of the fluid of each phase [kg/m3]; 0 without any. */
void mps__phase_densities(const mps_stage *s, double rho[MPS__PHASE_LIMIT]);

/* Whether particle i is fluid of the phase of a setting. */
static inline bool mps__is_gas(const mps_stage *s, int64_t i, double phase)
{
    return s->kind[i] == MPS_FLUID && s->phase[i] == (int32_t)phase;
}

/* Fail unless there is fluid of this phase and all of it moves below the speed of sound. Non-zero: failed. */
int mps__gas_check(mps_stage *s, double phase, double sound);
/* The equation of state wants particles denser by the shares `denser` [n] (0: a lattice as it was), which become scratch. What is left of
 * the deviations of all particles is error. Non-zero: failed. */
int mps__gas_expect(mps_stage *s, double *denser);
/* Share of the cell of particle i that holds gas; of a wall particle's, where walls are parts of cells (wall_factor > 0). */
double mps__gas_share(const mps_stage *s, int64_t i, double phase, double wall_factor);
/* In a tank that no fixed pressure opens, keep the volume of the gas: `surplus`, what its particles' volumes by the law are above their
 * share (sum, in cells of the lattice), and the sum of all sources are taken off. Call it before the gas adds its own terms. */
void mps__gas_conserve(const mps_stage *s, mps_ppe_terms *terms, double phase, double surplus);

/* All of them; the last entry is NULL. */
const mps_model_ops *const *mps__builtin_phase(void);

#endif
