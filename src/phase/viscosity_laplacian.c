/* SPDX-License-Identifier: BSD-3-Clause */
/* Viscous acceleration a = nu <lap u>, W22 (2)(6), over all pairs. Walls do not slip: they have the tank's velocity, and with `mirror` 1
 * (default) dummies are seen mirrored (friction.h). `mirror` 0, W22: dummies have the tank's velocity too. */
#include "friction.h"

enum { MIRROR };
static const mps_setting settings[] = {{"mirror", 1.0, 0.0, 1.0}};

enum { PAIRS = 64 };

/* W of the pairs from..from+count-1 of row i, roots and divisions several at a time. */
MPS__ROW void weights(const int dim, const mps_stencil *t, int64_t i, int64_t from, int count, double *w)
{
    for (int k = 0; k < count; k++) {
        const double *a = t->x + i * dim, *b = t->x + (int64_t)t->col[from + k] * dim;
        const double x = b[0] - a[0], y = b[1] - a[1], z = dim == 3 ? b[2] - a[2] : 0;
        w[k] = dim == 3 ? x * x + y * y + z * z : x * x + y * y;
    }
    for (int k = 0; k < count; k++) w[k] = sqrt(w[k]);
    mps_kernel_weights(&t->kernel, t->re, count, w, w);
}

MPS__ROW void diffuse(const int dim, const mps_stage *s, int64_t i, double nu, bool mirror, double *a)
{
    const mps_stencil far = *s->far, *t = &far;
    const double *all = s->u, *u = all + i * dim, c = 2.0 * dim / (t->n0 * t->lambda);
    double sum[3] = {0}, w[PAIRS];
    for (int64_t from = t->begin[i]; from < t->end[i]; from += PAIRS) {
        const int count = t->end[i] - from < PAIRS ? (int)(t->end[i] - from) : PAIRS;
        weights(dim, t, i, from, count, w);
        for (int k = 0; k < count; k++) {
            const int64_t j = t->col[from + k];
            double du[3];
            if (mirror && s->kind[j] == MPS_DUMMY)
                mps__mirror_velocity(dim, s, i, j, du);
            else
                for (int d = 0; d < dim; d++) du[d] = all[j * dim + d] - u[d];
            for (int d = 0; d < dim; d++) sum[d] += du[d] * w[k];
        }
    }
    for (int d = 0; d < dim; d++) a[i * dim + d] += c * nu * sum[d];
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
    const bool mirror = k[MIRROR] >= 0.5;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        const double nu = s->viscosity[s->phase[i]] / s->density[i];
        if (nu != 0) MPS__ROW_CALL(s, diffuse, s, i, nu, mirror, a);
    }
    return 0;
}

const mps_model_ops mps__viscosity_laplacian = {.struct_size = sizeof(mps_model_ops),
                                                .api = MPS_MODEL_API,
                                                .name = "viscosity.laplacian",
                                                .order = 300,
                                                .setting_count = 1,
                                                .settings = settings,
                                                .force = force};
