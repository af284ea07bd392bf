/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of the fluid. Verbs that nothing else orders run in this order. */
#include "builtin.h"

static const mps_model_ops *const all[] = {&mps__moments_bounded,    &mps__density_smooth,
                                           &mps__density_interface,  &mps__viscosity_laplacian,
                                           &mps__viscosity_pair,     &mps__dissipation_radial,
                                           &mps__tension_csf,        &mps__tension_jump,
                                           &mps__friction_sides,     &mps__source_mixed,
                                           &mps__source_volume,      &mps__gas_compressible,
                                           &mps__gas_isentropic,     &mps__gradient_conservative,
                                           &mps__gradient_corrected, &mps__gradient_density,
                                           &mps__drag_lone,          &mps__collision_pair,
                                           &mps__shift_tangential,   NULL};

const mps_model_ops *const *mps__builtin_phase(void)
{
    return all;
}

typedef struct fields {
    const double *density;
} fields;

/* Raises most[phase] to the negative of the density. */
MPS_ROW void raise_lightest(const int dim, const mps_stage *s, const fields *f, int64_t i,
                            double *most)
{
    (void)dim;
    if (s->kind[i] != MPS_FLUID) return;
    double *own = &most[s->phase[i]];
    if (-f->density[i] > *own) *own = -f->density[i];
}
MPS_SUMS(raise_lightest_rows, raise_lightest, fields)

void mps__phase_densities(const mps_stage *s, const double *density, double rho[MPS__PHASE_LIMIT])
{
    fields f = {density};
    mps_stage_max(s, MPS__PHASE_LIMIT, raise_lightest_rows, &f, rho);
    for (int p = 0; p < MPS__PHASE_LIMIT; p++) rho[p] = isinf(rho[p]) ? 0 : -rho[p];
}
