/* SPDX-License-Identifier: BSD-3-Clause */
/* Surface tension, contoured continuum surface force, W22 (19)-(23): F_S = -sigma kappa <grad C>, per volume, with
 *   <grad C>_i = D/n0 sum C_ij r_ij/|r_ij|^2 W,  C_ij = 2 rho_i/(rho_i + rho_j) for another phase, else 0  (near radius),
 * kappa as in tension.c. sigma is that of mps_sim_set_tension() for a pair of phases, else the setting; <grad C> is summed with the sigma
 * of each pair. `radius` is rs in dp, `threshold` the least |grad f| dp. */
#include "tension.h"

enum { SIGMA, RADIUS, THRESHOLD };
static const mps_setting settings[] = {{"sigma", 7.27e-2, 0.0, 100.0}, {"radius", 8.1, 2.1, 20.0}, {"threshold", 0.02, 1e-6, 1.0}};

/* sigma <grad C>_i / rho_i */
MPS__ROW void colour_gradient(const int dim, const mps_stage *s, double sigma, int64_t i, double grad[3])
{
    const mps_stencil *t = s->near;
    for (int d = 0; d < dim; d++) grad[d] = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->phase[j] == s->phase[i]) continue;
        const double own = mps__pair_sigma(s, s->phase[i], s->phase[j], sigma);
        if (own == 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double share = own * dim / t->n0 * q.w_r2 * 2.0 / (s->density[i] + s->density[j]);
        for (int d = 0; d < dim; d++) grad[d] += share * q.d[d];
    }
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
    double *kappa = mps_stage_scratch(s, s->n);
    if (!kappa || !mps__curvatures(s, s->near, k[RADIUS], k[THRESHOLD], kappa)) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        double grad[3];
        if (kappa[i] == 0) continue;
        MPS__ROW_CALL(s, colour_gradient, s, k[SIGMA], i, grad);
        for (int d = 0; d < s->dim; d++) a[i * s->dim + d] -= kappa[i] * grad[d];
    }
    return 0;
}

static double dt_limit(void *self, const double *k, const mps_stage *s)
{
    (void)self;
    return mps__tension_dt(s, k[SIGMA]);
}

const mps_model_ops mps__tension_csf = {.struct_size = sizeof(mps_model_ops),
                                        .api = MPS_MODEL_API,
                                        .name = "tension.csf",
                                        .order = 320,
                                        .setting_count = 3,
                                        .settings = settings,
                                        .force = force,
                                        .dt_limit = dt_limit};
