/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure gradient with B_i: G_i = D/n0 B_i sum w [(P_j - P_i)/rho_ij - b_ij.r_ij] r_ij over fluid and wet walls, b_ij.r_ij that of a fluid
 * that moves with the tank, rho_ij as in the pressure equation; a_i = -b - G_i with b = g - a_tank
 * (gravity is in u* already). Surface particles see one side only: a second pass with 2 (P_j - P_i) - G_j.r_ij makes them second order. */
#include "builtin.h"
#include <stdbool.h>

enum { SECOND };
static const mps_setting settings[] = {{"second_order", 0.0, 0.0, 1.0}};

/* G_i; with `first` not NULL the second pass. */
MPS__ROW void corrected(const int dim, const mps_stage *stage, int64_t i, const double *first, double *g)
{
    const mps_stage copy = *stage, *s = &copy;
    const mps_stencil near = *s->near, *t = &near;
    const double *b = s->correction + i * dim * dim, pi = s->p[i];
    double sum[3] = {0}, own[3];
    for (int d = 0; d < dim; d++) own[d] = 2.0 * s->g[d] - s->tank_accel[i * dim + d];
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->region[t->col[p]] >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double body = 0, slope = 0;
        for (int d = 0; d < dim; d++) body += 0.5 * (own[d] - s->tank_accel[q.j * dim + d]) * q.d[d];
        const double rho = mps_stage_pair_density(s, i, q.j);
        const bool across = s->phase[q.j] != s->phase[i] && s->kind[q.j] == MPS_FLUID;
        const double jump = across ? 0.5 * (s->capillary[i] - s->capillary[q.j]) : 0.0;
        double difference = (s->p[q.j] - pi + jump) / rho - body;
        if (first && s->kind[q.j] == MPS_FLUID) {
            for (int d = 0; d < dim; d++) slope += first[q.j * dim + d] * q.d[d];
            difference = 2.0 * difference - slope;
        }
        for (int d = 0; d < dim; d++) sum[d] += q.w_r2 * difference * q.d[d];
    }
    for (int d = 0; d < dim; d++) {
        g[d] = 0;
        for (int e = 0; e < dim; e++) g[d] += dim / t->n0 * b[d * dim + e] * sum[e];
    }
}

static int gradient(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
    const int dim = s->dim;
    double *g = mps_stage_scratch(s, s->n * dim);
    if (!g) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->region[i] != MPS_REGION_SPRAY) MPS__ROW_CALL(s, corrected, s, i, NULL, g + i * dim);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->region[i] == MPS_REGION_SPRAY) continue;
        double own[3];
        for (int d = 0; d < dim; d++) own[d] = g[i * dim + d];
        if (k[SECOND] > 0 && s->region[i] == MPS_REGION_SURFACE) MPS__ROW_CALL(s, corrected, s, i, g, own);
        for (int d = 0; d < dim; d++) a[i * dim + d] -= s->g[d] - s->tank_accel[i * dim + d] + own[d];
    }
    return 0;
}

const mps_model_ops mps__gradient_corrected = {.struct_size = sizeof(mps_model_ops),
                                               .api = MPS_MODEL_API,
                                               .name = "gradient.corrected",
                                               .order = 600,
                                               .setting_count = 1,
                                               .settings = settings,
                                               .gradient = gradient};
