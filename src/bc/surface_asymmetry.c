/* SPDX-License-Identifier: BSD-3-Clause */
/* Free surface, W22 (11)(12), Z14 (16)(17): n < low n0, or n < high n0 and |A| > share |A|0, where |A|0 belongs to the
 * surface row of a lattice. Particles with too little fluid about them are spray.
 * The papers test wall particles too (walls = 1): dry walls have p = 0. */
#include "builtin.h"

enum { LOW, HIGH, SHARE, SPRAY, WALLS };
static const mps_setting settings[] = {{"low", 0.8, 0.0, 1.0}, {"high", 0.97, 0.5, 1.0}, {"share", 0.9, 0.0, 2.0}, {"spray", 0.25, 0.0, 1.0}, {"walls", 0.0, 0.0, 1.0}};

/* |A| of a particle in the top row of a lattice that fills the half space below it. */
static double lattice_asymmetry(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, depth = t->dim == 3 ? reach : 0;
    double sum = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = -reach; j < 0; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum -= j * t->dp / r * mps_kernel_weight(&t->kernel, r, t->re);
            }
    return t->dim * sum / t->n0;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    const mps_stencil *t = s->near;
    const double a0 = k[SHARE] * lattice_asymmetry(t);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID && !(s->kind[i] == MPS_WALL && k[WALLS] > 0)) continue;
        double a[3] = {0}, fluid = 0;
        for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
            const mps_pair q = mps_stencil_pair(t, i, p);
            for (int d = 0; d < 3; d++) a[d] -= q.w * q.d[d] / q.r;
            if (s->kind[q.j] == MPS_FLUID) fluid += q.w;
        }
        const double n = s->number_density[i] / t->n0, size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * t->dim / t->n0;
        if (s->kind[i] == MPS_FLUID && fluid < k[SPRAY] * t->n0)
            s->region[i] = MPS_REGION_SPRAY;
        else if (n < k[LOW] || (n < k[HIGH] && size > a0))
            s->region[i] = MPS_REGION_SURFACE;
    }
    return 0;
}

const mps_model_ops mps__surface_asymmetry = {.struct_size = sizeof(mps_model_ops),
                                              .api = MPS_MODEL_API,
                                              .name = "surface.asymmetry",
                                              .order = 100,
                                              .setting_count = 5,
                                              .settings = settings,
                                              .classify = classify};
