/* SPDX-License-Identifier: BSD-3-Clause */
/* Particle shifting toward an even lattice: s_i = -c dt (U_g + max_j |u_j - u_i|) l D/n0 sum w r_ij over all kinds, at most
 * `limit` l. In the first two rows of a free surface the part along its normal is taken away: it would expand the fluid.
 * With `transport` the velocity goes along: u += s.grad u over fluid of the same phase, within the range of its neighbours'
 * velocities (over all neighbours, or unbounded, a lone drop would accelerate itself). */
#include "builtin.h"

enum { STRENGTH, LIMIT, TRANSPORT };
static const mps_setting settings[] = {{"strength", 1.0, 0.0, 10.0}, {"limit", 0.05, 0.0, 0.5}, {"transport", 1.0, 0.0, 1.0}};

/* fmax() and fmin() as one instruction; a NaN is found at the end of the step. */
static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

/* Normal of the free surface near i: its own asymmetry, or the mean of its surface neighbours'. Not unit. */
static void surface_normal(const mps_stage *s, int64_t i, double n[3])
{
    const mps_stencil *t = s->near;
    for (int d = 0; d < s->dim; d++) n[d] = s->region[i] == MPS_REGION_SURFACE ? s->asymmetry[i * s->dim + d] : 0.0;
    if (s->region[i] != MPS_REGION_NEAR) return;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->region[j] != MPS_REGION_SURFACE) continue;
        const double w = mps_stencil_pair(t, i, p).w;
        for (int d = 0; d < s->dim; d++) n[d] += w * s->asymmetry[j * s->dim + d];
    }
}

MPS__ROW void shift_of(const int dim, const double *k, const mps_stage *s, int64_t i, double v[3])
{
    const mps_stencil *t = s->near;
    const double *u = s->u + i * dim;
    double most = 0, n[3] = {0}, n2 = 0, vn = 0, v2 = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++) v[d] += q.w_r2 * q.d[d];
        if (s->kind[q.j] != MPS_FLUID) continue;
        double du2 = 0;
        for (int d = 0; d < dim; d++) du2 += (s->u[q.j * dim + d] - u[d]) * (s->u[q.j * dim + d] - u[d]);
        most = larger(most, du2);
    }
    const double c = -k[STRENGTH] * s->dt * (s->velocity_scale + sqrt(most)) * s->dp * dim / t->n0;
    for (int d = 0; d < dim; d++) v[d] *= c;
    surface_normal(s, i, n);
    for (int d = 0; d < dim; d++) {
        n2 += n[d] * n[d];
        vn += n[d] * v[d];
    }
    for (int d = 0; d < dim; d++) {
        if (n2 > 0) v[d] -= vn / n2 * n[d];
        v2 += v[d] * v[d];
    }
    const double limit = k[LIMIT] * s->dp;
    if (v2 > limit * limit)
        for (int d = 0; d < dim; d++) v[d] *= limit / sqrt(v2);
}

/* du = s.grad u at i, between the least and the greatest difference its neighbours have. */
MPS__ROW void transport(const int dim, const mps_stage *s, int64_t i, const double *shift, double *du)
{
    const mps_stencil *t = s->near;
    const double *u = s->u + i * dim;
    double m[9] = {0}, g[9] = {0}, b[9], low[3] = {0}, high[3] = {0};
    const double c = dim / t->n0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->phase[j] != s->phase[i] || s->region[j] == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double w = c * q.w_r2;
        for (int d = 0; d < dim; d++) {
            const double v = s->u[j * dim + d] - u[d];
            low[d] = smaller(low[d], v);
            high[d] = larger(high[d], v);
            for (int e = 0; e < dim; e++) g[d * dim + e] += w * v * q.d[e];
            for (int e = d; e < dim; e++) m[d * dim + e] += w * q.d[d] * q.d[e];
        }
    }
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < d; e++) m[d * dim + e] = m[e * dim + d];
    mps_matrix_inverse_bounded(dim, m, 0.25, b);
    for (int d = 0; d < dim; d++) {
        double v = 0;
        for (int e = 0; e < dim; e++)
            for (int f = 0; f < dim; f++) v += g[d * dim + e] * b[e * dim + f] * shift[f];
        du[d] = fmin(fmax(v, low[d]), high[d]);
    }
}

static int shift(void *self, const double *k, mps_stage *s, double *dx)
{
    (void)self;
    const int dim = s->dim;
    double *du = mps_stage_scratch(s, s->n * dim);
    if (!du) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->region[i] == MPS_REGION_SPRAY) continue;
        double v[3] = {0};
        MPS__ROW_CALL(s, shift_of, k, s, i, v);
        if (k[TRANSPORT] > 0) MPS__ROW_CALL(s, transport, s, i, v, du + i * dim);
        for (int d = 0; d < dim; d++) dx[i * dim + d] += v[d];
    }
    for (int64_t i = 0; i < s->n * dim; i++) s->u[i] += du[i];
    return 0;
}

const mps_model_ops mps__shift_tangential = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "shift.tangential",
                                             .order = 800,
                                             .setting_count = 3,
                                             .settings = settings,
                                             .shift = shift};
