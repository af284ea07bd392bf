/* SPDX-License-Identifier: BSD-3-Clause */
/* Density smoothing, W22 (13): rho_i = (rho_i W_self + sum rho_j W)/(W_self + sum W) over the fluid within the near radius, for fluid
 * that has another density there: a region two radii wide about an interface. W22 does not give W_self; it is `self` times W(0),
 * and the larger it is, the less is smoothed. The mass of a particle stays its phase's: only `density_smooth` is written. */
#include "builtin.h"

enum { SELF };
static const mps_setting settings[] = {{"self", 100.0, 0.0, 1e6}};

MPS__ROW double smoothed(const int dim, const mps_stage *s, double self, int64_t i)
{
    const mps_stencil *t = s->near;
    const double rho = s->density[i];
    double sum = 0, weight = self; /* of the differences: without any the density is kept to the bit */
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_FLUID) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        sum += q.w * (s->density[q.j] - rho);
        weight += q.w;
    }
    return sum == 0 ? rho : rho + sum / weight;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    const mps_kernel *kernel = &s->near->kernel; /* only the improved one is finite at 0 for certain */
    const double own = k[SELF] * mps_kernel_weight(kernel, kernel->id == MPS_KERNEL_IMPROVED ? 0.0 : 0.5 * s->dp, s->near->re);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) s->density_smooth[i] = MPS__ROW_CALL(s, smoothed, s, own, i);
    return 0;
}

const mps_model_ops mps__density_smooth = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "density.smooth",
                                           .order = 260,
                                           .setting_count = 1,
                                           .settings = settings,
                                           .classify = classify};
