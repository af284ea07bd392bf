/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure gradient that conserves momentum, W22 (9): a_i = -D/(n0 rho) sum (P_j + P_i) r_ij/|r_ij|^2 W. */
#include "builtin.h"

static int gradient(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self, (void)k;
    double *g = mps_stage_scratch(s, s->n * s->dim);
    if (!g || mps_op_gradient_conservative(s->near, s->p, g) != MPS_OK) return 1;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID)
            for (int d = 0; d < s->dim; d++) a[i * s->dim + d] -= g[i * s->dim + d] / s->density[i];
    return 0;
}

const mps_model_ops mps__gradient_conservative = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "gradient.conservative", .order = 600, .gradient = gradient};
