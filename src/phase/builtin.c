/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of the fluid. */
#include "builtin.h"

static const mps_model_ops *const all[] = {
    &mps__moments_bounded,       &mps__viscosity_laplacian, &mps__dissipation_radial, &mps__source_mixed,     &mps__source_volume,
    &mps__gradient_conservative, &mps__gradient_corrected,  &mps__collision_pair,     &mps__shift_tangential, &mps__density_smooth,
    &mps__density_interface,     &mps__viscosity_pair,      &mps__tension_csf,        &mps__tension_jump,     &mps__gas_compressible,
    &mps__gas_isentropic,        &mps__gradient_density,    &mps__friction_sides,     &mps__drag_lone,        NULL};

void mps__phase_densities(const mps_stage *s, double rho[MPS__PHASE_LIMIT])
{
    for (int p = 0; p < MPS__PHASE_LIMIT; p++) rho[p] = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double *least = &rho[s->phase[i]];
        if (s->kind[i] == MPS_FLUID && (*least == 0 || s->density[i] < *least)) *least = s->density[i];
    }
}

const mps_model_ops *const *mps__builtin_phase(void)
{
    return all;
}
