/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of boundaries, and what several of them need. */
#include "builtin.h"

static const mps_model_ops *const all[] = {&mps__surface_asymmetry,
                                           &mps__surface_detached,
                                           &mps__surface_original,
                                           &mps__reference_lid,
                                           &mps__wall_half,
                                           &mps__wall_extrapolate,
                                           &mps__body_free,
                                           &mps__reference_gas,
                                           &mps__separation_void,
                                           &mps__load_reaction,
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

const mps_model_ops *const *mps__builtin_bc(void)
{
    return all;
}
