/* SPDX-License-Identifier: BSD-3-Clause */
/* Viscous acceleration a = nu <lap u>, W22 (2)(6), over all pairs: solids are seen with their own velocity (no slip). */
#include "builtin.h"

MPS__ROW void diffuse(const int dim, const mps_stage *s, int64_t i, double nu, double *a)
{
    const mps_stencil *t = s->far;
    const double *u = s->u + i * dim, c = 2.0 * dim / (t->n0 * t->lambda);
    double sum[3] = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++) sum[d] += (s->u[q.j * dim + d] - u[d]) * q.w;
    }
    for (int d = 0; d < dim; d++) a[i * dim + d] += c * nu * sum[d];
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self, (void)k;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        const double nu = s->viscosity[s->phase[i]] / s->density[i];
        if (nu != 0) MPS__ROW_CALL(s, diffuse, s, i, nu, a);
    }
    return 0;
}

const mps_model_ops mps__viscosity_laplacian = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "viscosity.laplacian", .order = 300, .force = force};
