/* SPDX-License-Identifier: BSD-3-Clause */
/* Viscous acceleration a = nu <lap u>, W22 (2)(6), over all pairs: solids are seen with their own velocity (no slip). */
#include "builtin.h"

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self, (void)k;
    const mps_stencil *t = s->far;
    const double c = 2.0 * s->dim / (t->n0 * t->lambda);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        const double nu = s->viscosity[s->phase[i]] / s->density[i];
        if (nu == 0) continue;
        double sum[3] = {0};
        for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
            const mps_pair q = mps_stencil_pair(t, i, p);
            for (int d = 0; d < s->dim; d++) sum[d] += (s->u[q.j * s->dim + d] - s->u[i * s->dim + d]) * q.w;
        }
        for (int d = 0; d < s->dim; d++) a[i * s->dim + d] += c * nu * sum[d];
    }
    return 0;
}

const mps_model_ops mps__viscosity_laplacian = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "viscosity.laplacian", .order = 300, .force = force};
