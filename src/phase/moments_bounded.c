/* SPDX-License-Identifier: BSD-3-Clause */
/* Moment matrices of the pressure operators: B_i = M_i^-1, M_i = D/n0 sum w r_ij (x) r_ij, w = W/r^2, over fluid and wet walls, the
 * eigenvalues of M raised to `floor`, of surface particles to `surface`. With it gradient and divergence are exact for linear fields.
 * 0.5 is the eigenvalue along the normal of a flat surface, and in a disordered or stretched row it is less: a floor of 0.5 takes 4-11 % of the
 * gradient from most surface particles, the row then lags behind its pressure, and waves grow by 2-3 % a period. Inside the fluid, lower floors
 * make calm water noisy. */
#include "builtin.h"

enum { FLOOR, SURFACE };
static const mps_setting settings[] = {{"floor", 0.5, 0.01, 1.0}, {"surface", 0.4, 0.01, 1.0}};

MPS__ROW void moments(const int dim, const mps_stage *s, int64_t i, double m[9])
{
    const mps_stencil near = *s->near, *t = &near;
    for (int d = 0; d < dim * dim; d++) m[d] = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->region[t->col[p]] >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++)
            for (int e = d; e < dim; e++) m[d * dim + e] += q.w_r2 * q.d[d] * q.d[e];
    }
    for (int d = 0; d < dim; d++)
        for (int e = d; e < dim; e++) m[e * dim + d] = m[d * dim + e] *= dim / t->n0;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    const int dim = s->dim;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->region[i] == MPS_REGION_SPRAY) continue;
        double m[9];
        MPS__ROW_CALL(s, moments, s, i, m);
        mps_matrix_inverse_bounded(dim, m, k[s->region[i] == MPS_REGION_SURFACE ? SURFACE : FLOOR], s->correction + i * dim * dim);
    }
    return 0;
}

const mps_model_ops mps__moments_bounded = {.struct_size = sizeof(mps_model_ops),
                                            .api = MPS_MODEL_API,
                                            .name = "moments.bounded",
                                            .order = 250,
                                            .setting_count = 2,
                                            .settings = settings,
                                            .classify = classify};
