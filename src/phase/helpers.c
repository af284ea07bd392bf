/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers that several models of the fluid share. */
#include "helpers.h"

typedef struct fields {
    const double *density;
} fields;

/* Raises most[phase] to the negative of the density. */
MPS_ROW void raise_lightest(const int dim, const mps_view *v, const fields *f, int64_t i,
                            double *most)
{
    (void)dim;
    if (!mps_is_fluid(v, i)) return;
    double *own = &most[v->phase[i]];
    if (-f->density[i] > *own) *own = -f->density[i];
}
MPS_SUMS(raise_lightest_rows, raise_lightest, fields)

void mps__phase_densities(const mps_stage *s, const double *density, double rho[MPS__PHASE_LIMIT])
{
    fields f = {density};
    mps_stage_max(s, MPS__PHASE_LIMIT, &raise_lightest_rows, &f, rho);
    for (int p = 0; p < MPS__PHASE_LIMIT; p++) rho[p] = isinf(rho[p]) ? 0 : -rho[p];
}

/* Maxima over the fluid: of the negative of the density, of the density. */
MPS_ROW void raise_density(const int dim, const mps_view *v, const fields *f, int64_t i,
                           double *most)
{
    (void)dim;
    if (!mps_is_fluid(v, i)) return;
    most[0] = mps_larger(most[0], -f->density[i]);
    most[1] = mps_larger(most[1], f->density[i]);
}
MPS_SUMS(raise_density_rows, raise_density, fields)

void mps__density_range(const mps_stage *s, const double *density, double range[2])
{
    fields f = {density};
    mps_stage_max(s, 2, &raise_density_rows, &f, range);
    range[0] = -range[0];
}
