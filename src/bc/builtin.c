/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of boundaries. */
#include "builtin.h"

static const mps_model_ops *const all[] = {&mps__surface_asymmetry,
                                           &mps__surface_detached,
                                           &mps__surface_original,
                                           &mps__wall_half,
                                           &mps__wall_extrapolate,
                                           &mps__body_free,
                                           &mps__reference_gas,
                                           &mps__reference_lid,
                                           &mps__load_reaction,
                                           &mps__separation_void,
                                           NULL};

bool mps__upward(const mps_stage *s, double up[3])
{
    double size = 0;
    for (int d = 0; d < s->dim; d++) size += s->g[d] * s->g[d];
    for (int d = 0; d < s->dim; d++) up[d] = -s->g[d] / sqrt(size);
    return size > 0;
}

double mps__height(const mps_stage *s, const double up[3], int64_t i)
{
    double height = 0;
    for (int d = 0; d < s->dim; d++) height += up[d] * s->x[i * s->dim + d];
    return height;
}

double mps__density_beside(const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    double density = s->density[i], nearest = INFINITY;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->region[j] == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair(t, i, p);
        if (q.r2 >= nearest) continue;
        nearest = q.r2;
        density = s->density[j];
    }
    return density;
}

const mps_model_ops *const *mps__builtin_bc(void)
{
    return all;
}
