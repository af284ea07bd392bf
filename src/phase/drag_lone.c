/* SPDX-License-Identifier: BSD-3-Clause */
/* Drag of a dense fluid on single particles of a lighter one. Gas among drops, or between water and a wall, with less of its own phase about it
 * than a row of particles has (`company` n0) is smaller than the operators resolve, and the pressures of the water throw it about.
 * Of its velocity against the mean of the denser fluid about it more than `times` U is taken, times its lone share max(0, 1 - c_i/company),
 * c_i = sum W/n0 over its own phase. U is the largest velocity of that fluid and of the walls about it against the same mean, at least U_g.
 * Pairs with the denser fluid exchange momentum, with weights that leave no particle more to lose than its relative velocity: momentum is
 * conserved, kinetic energy falls and is booked with the collisions. */
#include "builtin.h"

enum { COMPANY, TIMES };
/* 1/3: in a row of particles it is 0.34 */
static const mps_setting settings[] = {{"company", 1.0 / 3.0, 0.01, 1.0}, {"times", 3.0, 0.0, 100.0}};

static inline bool apart(const mps_stage *s, int64_t i, int64_t j)
{
    return s->kind[j] == MPS_FLUID && s->density[j] != s->density[i];
}

/* Sum of W m_j/(m_i + m_j) over lighter and denser fluid about i. */
MPS__ROW double weigh(const int dim, const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    double sum = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (apart(s, i, j)) sum += mps_stencil_pair_dim(dim, t, i, p).w * s->density[j] / (s->density[i] + s->density[j]);
    }
    return sum;
}

/* Lone share of i; mean velocity of the denser fluid about it. */
MPS__ROW double look_round(const int dim, const double *k, const mps_stage *s, int64_t i, double mean[3])
{
    const mps_stencil *t = s->near;
    double own = 0, dense = 0;
    for (int d = 0; d < dim; d++) mean[d] = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        if (s->phase[j] == s->phase[i]) own += w;
        if (s->density[j] <= s->density[i]) continue;
        dense += w;
        for (int d = 0; d < dim; d++) mean[d] += w * s->u[j * dim + d];
    }
    for (int d = 0; d < dim && dense > 0; d++) mean[d] /= dense;
    return dense > 0 ? fmax(0.0, 1.0 - own / (k[COMPANY] * t->n0)) : 0.0;
}

/* Share of its velocity against the denser fluid about it that i loses. */
MPS__ROW double excess(const int dim, const double *k, const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    double mean[3], fastest = s->velocity_scale * s->velocity_scale, own = 0;
    const double lone = look_round(dim, k, s, i, mean);
    if (lone == 0) return 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] == MPS_FLUID ? s->density[j] <= s->density[i] : s->region[j] == MPS_REGION_DRY) continue;
        double square = 0;
        for (int d = 0; d < dim; d++) square += (s->u[j * dim + d] - mean[d]) * (s->u[j * dim + d] - mean[d]);
        fastest = fmax(fastest, square);
    }
    for (int d = 0; d < dim; d++) own += (s->u[i * dim + d] - mean[d]) * (s->u[i * dim + d] - mean[d]);
    const double limit = k[TIMES] * sqrt(fastest);
    return own > limit * limit ? lone * (1.0 - limit / sqrt(own)) : 0.0;
}

MPS__ROW void drag(const int dim, const mps_stage *s, const double *share, const double *weight, int64_t i, double *change)
{
    const mps_stencil *t = s->near;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (!apart(s, i, j)) continue;
        const double part = share[s->density[i] < s->density[j] ? i : j];
        if (part == 0) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w / fmax(weight[i], weight[j]), mass = s->density[i] + s->density[j];
        for (int d = 0; d < dim; d++) change[i * dim + d] += part * w * s->density[j] / mass * (s->u[j * dim + d] - s->u[i * dim + d]);
    }
}

static int velocity(void *self, const double *k, mps_stage *s)
{
    (void)self;
    double *share = mps_stage_scratch(s, s->n), *weight = mps_stage_scratch(s, s->n), *change = mps_stage_scratch(s, s->n * s->dim);
    if (!share || !weight || !change) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        share[i] = MPS__ROW_CALL(s, excess, k, s, i);
        weight[i] = MPS__ROW_CALL(s, weigh, s, i);
    }
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, drag, s, share, weight, i, change);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n * s->dim; i++) s->u[i] += change[i];
    return 0;
}

const mps_model_ops mps__drag_lone = {.struct_size = sizeof(mps_model_ops),
                                      .api = MPS_MODEL_API,
                                      .name = "drag.lone",
                                      .order = 690,
                                      .setting_count = 2,
                                      .settings = settings,
                                      .velocity = velocity};
