/* SPDX-License-Identifier: BSD-3-Clause */
/* Named dissipation: fluid pairs are damped along their line,
 *   a_i = 2(D+2)/n0 sum (alpha l U_g + beta l max(0, -u_n)) w u_n/r r_ij, u_n the rate of separation, w = W/r^2.
 * Pairwise, so momentum is conserved. alpha calms the lattice, beta takes the energy of violent impacts. */
#include "builtin.h"

enum { ALPHA, BETA };
static const mps_setting settings[] = {{"alpha", 0.1, 0.0, 10.0}, {"beta", 1.0, 0.0, 10.0}};

MPS__ROW void damp(const int dim, const double *k, const mps_stage *s, int64_t i, double *a)
{
    const mps_stencil *t = s->near;
    const double *u = s->u + i * dim, c = 2.0 * (dim + 2) / t->n0, calm = k[ALPHA] * s->velocity_scale, rho = s->density[i];
    const double most = 0.15 * s->dp / s->dt, most_near = most / (s->dp * s->dp * s->dp); /* more would turn velocities round in a step */
    double sum[3] = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double rate = 0; /* u_n r */
        for (int d = 0; d < dim; d++) rate += (s->u[j * dim + d] - u[d]) * q.d[d];
        const double over = 1.0 / q.r, limit = q.r < s->dp ? most_near * q.r2 * q.r : most; /* nearer than dp still less */
        double nu = rate < 0 ? calm - k[BETA] * rate * over : calm;
        nu = nu < limit ? nu : limit;
        const double share = s->density[j] / (rho + s->density[j]) * over * over * nu * q.w_r2 * rate;
        for (int d = 0; d < dim; d++) sum[d] += share * q.d[d];
    }
    for (int d = 0; d < dim; d++) a[i * dim + d] += 2.0 * s->dp * c * sum[d];
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, damp, k, s, i, a);
    return 0;
}

const mps_model_ops mps__dissipation_radial = {.struct_size = sizeof(mps_model_ops),
                                               .api = MPS_MODEL_API,
                                               .name = "dissipation.radial",
                                               .order = 310,
                                               .setting_count = 2,
                                               .settings = settings,
                                               .force = force};
