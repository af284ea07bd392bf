/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure gradient for high ratios of density, W22 (18):
 *   a_i = -D/n0 sum [2 (P_j - P_i)/(rho_i + rho_j) + (P_i - P'_i)/rho_i] r_ij/|r_ij|^2 W,
 * P'_i the smallest pressure of i and its neighbours of the same phase; the second term keeps particles apart. Densities are the
 * smoothed ones; solids have that of the fluid beside them: with the gas's own a wall below the contact line would
 * throw the gas off. Dummies need pressures and densities: `wall.extrapolate`. */
#include "builtin.h"

/* P'_i */
static double least_pressure(const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    double least = s->p[i];
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] == MPS_FLUID && s->phase[j] == s->phase[i] && s->p[j] < least) least = s->p[j];
    }
    return least;
}

MPS__ROW void accelerate(const int dim, const mps_stage *s, int64_t i, double *a)
{
    const mps_stencil *t = s->near;
    const double rho = s->density_smooth[i], apart = (s->p[i] - least_pressure(s, i)) / rho;
    double sum[3] = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double share = q.w_r2 * (2.0 * (s->p[q.j] - s->p[i]) / (rho + s->density_smooth[q.j]) + apart);
        for (int d = 0; d < dim; d++) sum[d] += share * q.d[d];
    }
    for (int d = 0; d < dim; d++) a[i * dim + d] -= dim / t->n0 * sum[d];
}

static int gradient(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self, (void)k;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, accelerate, s, i, a);
    return 0;
}

const mps_model_ops mps__gradient_density = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "gradient.density", .order = 600, .gradient = gradient};
