/* SPDX-License-Identifier: BSD-3-Clause */
/* Moment matrices of the pressure operators: B_i = M_i^-1, M_i = D/n0 sum w r_ij (x) r_ij, w = W/r^2, over fluid and wet walls, the
 * eigenvalues of M raised to `floor`. With it gradient and divergence are exact for linear fields at walls and surface. */
#include "builtin.h"

enum { FLOOR };
static const mps_setting settings[] = {{"floor", 0.5, 0.01, 1.0}};

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    const mps_stencil *t = s->near;
    const int dim = s->dim;
    const double c = dim / t->n0;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->region[i] == MPS_REGION_SPRAY) continue;
        double m[9] = {0};
        for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
            const mps_pair q = mps_stencil_pair(t, i, p);
            if (s->region[q.j] >= MPS_REGION_SPRAY) continue;
            for (int d = 0; d < dim; d++)
                for (int e = 0; e < dim; e++) m[d * dim + e] += c * q.w / q.r2 * q.d[d] * q.d[e];
        }
        mps_matrix_inverse_bounded(dim, m, k[FLOOR], s->correction + i * dim * dim);
    }
    return 0;
}

const mps_model_ops mps__moments_bounded = {.struct_size = sizeof(mps_model_ops),
                                            .api = MPS_MODEL_API,
                                            .name = "moments.bounded",
                                            .order = 250,
                                            .setting_count = 1,
                                            .settings = settings,
                                            .classify = classify};
