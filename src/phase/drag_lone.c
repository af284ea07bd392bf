/* SPDX-License-Identifier: BSD-3-Clause */
/* Drag of a dense fluid on single particles of a lighter fluid: gas among droplets, or gas between
 * water and a wall. If a particle has less of its own phase around it than a particle in a line of
 * particles (`company` n0), it is too small for the operators to resolve, and the pressures of the
 * water accelerate it irregularly.
 *
 * Let v be its velocity relative to the mean velocity of the denser fluid around it. The part of v
 * above `times` U is removed, times its isolation max(0, 1 - c_i/company), c_i = sum W/n0 over its
 * own phase. U is the largest velocity, relative to the same mean, of the denser fluid and of the
 * walls around it, and at least U_g (mps_view.velocity_scale).
 *
 * Pairs with the denser fluid exchange the momentum. Their weights are such that no particle loses
 * more than its relative velocity: momentum is conserved and kinetic energy decreases (it is
 * counted with the collisions). */
#include "helpers.h"

enum { COMPANY, TIMES, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [COMPANY] = {"company", "n0",
                 "Number density of its own phase below which gas is lone; "
                 "a row of particles has 0.34",
                 MPS_TYPE_REAL, 1.0 / 3.0, 0.01, 1.0},
    [TIMES] = {"times", "-", "Largest speed of lone gas over that of the denser fluid about it",
               MPS_TYPE_REAL, 3.0, 0.0, 100.0}};

enum { VELOCITY, DENSITY, REGION, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
                                   [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS}};

typedef struct fields {
    double *velocity;
    const double *density;
    const int32_t *region;
    double *share;  /* [n] excess() */
    double *weight; /* [n] weigh() */
    double *change; /* [n*dim] of the velocity */
} fields;

/* True if j is fluid of another density than i. */
static inline bool apart(const mps_view *v, const double *rho, int64_t i, int64_t j)
{
    return mps_is_fluid(v, j) && rho[j] != rho[i];
}

/* Sum of W m_j/(m_i + m_j) over the fluid of other densities around i. */
MPS_ROW double weigh(const int dim, const mps_view *v, const double *rho, int64_t i)
{
    const mps_stencil *t = &v->near;
    double sum = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!apart(v, rho, i, j)) continue;
        sum += mps_stencil_pair_dim(dim, t, i, p).w * rho[j] / (rho[i] + rho[j]);
    }
    return sum;
}

/* Isolation of i. mean: out, mean velocity of the denser fluid around it. */
MPS_ROW double look_round(const int dim, const mps_view *v, const fields *f, int64_t i,
                          double mean[3])
{
    const mps_stencil *t = &v->near;
    const double *u = f->velocity, *rho = f->density;
    double own = 0, dense = 0;
    for (int d = 0; d < dim; d++) mean[d] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j)) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        if (v->phase[j] == v->phase[i]) own += w;
        if (rho[j] <= rho[i]) continue;
        dense += w;
        for (int d = 0; d < dim; d++) mean[d] += w * u[j * dim + d];
    }
    for (int d = 0; d < dim && dense > 0; d++) mean[d] /= dense;
    return dense > 0 ? mps_larger(0.0, 1.0 - own / (v->setting[COMPANY] * t->n0)) : 0.0;
}

/* Fraction of its velocity relative to the denser fluid that i loses. */
MPS_ROW double excess(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const double *u = f->velocity, *rho = f->density;
    double mean[3], fastest = v->velocity_scale * v->velocity_scale, own = 0;
    const double lone = look_round(dim, v, f, i, mean);
    if (lone == 0) return 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_is_fluid(v, j) ? rho[j] <= rho[i] : mps_region_of(f->region, j) == MPS_REGION_DRY)
            continue;
        double square = 0;
        for (int d = 0; d < dim; d++)
            square += (u[j * dim + d] - mean[d]) * (u[j * dim + d] - mean[d]);
        fastest = mps_larger(fastest, square);
    }
    for (int d = 0; d < dim; d++) own += (u[i * dim + d] - mean[d]) * (u[i * dim + d] - mean[d]);
    const double limit = v->setting[TIMES] * sqrt(fastest);
    return own > limit * limit ? lone * (1.0 - limit / sqrt(own)) : 0.0;
}

MPS_ROW void judge(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    f->share[i] = excess(dim, v, f, i);
    f->weight[i] = weigh(dim, v, f->density, i);
}
MPS_ROWS(judge_rows, judge, fields)

MPS_ROW void drag(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    const mps_stencil *t = &v->near;
    const double *u = f->velocity, *rho = f->density;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!apart(v, rho, i, j)) continue;
        const double part = f->share[rho[i] < rho[j] ? i : j];
        if (part == 0) continue;
        const double most = mps_larger(f->weight[i], f->weight[j]), mass = rho[i] + rho[j];
        const double w = mps_stencil_pair_dim(dim, t, i, p).w / most;
        for (int d = 0; d < dim; d++)
            f->change[i * dim + d] += part * w * rho[j] / mass * (u[j * dim + d] - u[i * dim + d]);
    }
}
MPS_ROWS(drag_rows, drag, fields)

MPS_ROW void add_change(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)v;
    for (int d = 0; d < dim; d++) f->velocity[i * dim + d] += f->change[i * dim + d];
}
MPS_ROWS(add_change_rows, add_change, fields)

static int drag_lone_gas(mps_stage *s)
{
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .region = s->data[REGION],
                .share = mps_stage_scratch(s, s->view->n),
                .weight = mps_stage_scratch(s, s->view->n),
                .change = mps_stage_scratch(s, s->view->n * s->view->dim)};
    if (!f.share || !f.weight || !f.change) return 1;
    const mps_shared judged[] = {{f.share, 1, MPS_TYPE_REAL}, {f.weight, 1, MPS_TYPE_REAL}};
    mps_stage_rows(s, &judge_rows, &f);
    if (mps_stage_refresh(s, 2, judged)) return 1;
    mps_stage_rows(s, &drag_rows, &f);
    mps_stage_rows(s, &add_change_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_VELOCITY,
                                  .use_count = USES,
                                  .uses = uses,
                                  .before = "collision",
                                  .run = drag_lone_gas,
                                  .device = 1}};

const mps_model_ops mps__drag_lone = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "drag.lone",
    .help = "Drag of a dense fluid on single particles of a lighter one",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};
