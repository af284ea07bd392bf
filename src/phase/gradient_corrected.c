/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure gradient with moment matrices, over fluid and wetted walls:
 *   G_i = D/n0 B_i sum w [(P_j - P_i + jump_ij)/rho_ij - b_ij.r_ij] r_ij,  a_i = -b - G_i,
 * w = W/r^2. b, jump_ij and rho_ij are those of the pressure equation (mps/flux.h). With
 * b = g - a_tank, b_ij.r_ij is the pressure difference of a fluid that moves with the tank, and -b
 * adds only the acceleration of the tank, because u* already contains gravity. Surface particles
 * have neighbours on one side only. `second_order` adds a second pass for them, with 2 (P_j - P_i)
 * - G_j.r_ij instead of P_j - P_i. */
#include "helpers.h"

enum { SECOND, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [SECOND] = {"second_order", "-", "1: surface particles are of second order", MPS_TYPE_FLAG, 0.0,
                0.0, 1.0}};

enum { PRESSURE, REGION, TANK_ACCELERATION, CORRECTION, ACCELERATION, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [TANK_ACCELERATION] = {"tank_acceleration", MPS_USE_READ},
                                   [CORRECTION] = {"correction", MPS_USE_READ},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *pressure, *tank_acceleration, *correction;
    const int32_t *region;
    double *acceleration;
    double *first; /* [n*dim] G of the first pass */
} fields;

/* G_i; second pass if `first` is not NULL. */
MPS_ROW void gradient(const int dim, const mps_view *v, const fields *f, int64_t i,
                      const double *first, double *g)
{
    const mps_flux *flux = &v->flux;
    const mps_stencil *t = &v->near;
    const double *b = f->correction + i * dim * dim, pi = f->pressure[i];
    double sum[3] = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double body = mps_flux_body(flux, dim, i, q.j, q.d);
        const double rho = mps_flux_density(flux, i, q.j), jump = mps_flux_jump(flux, i, q.j);
        double difference = (f->pressure[q.j] - pi + jump) / rho - body;
        if (first && mps_is_fluid(v, q.j)) {
            double slope = 0;
            for (int d = 0; d < dim; d++) slope += first[q.j * dim + d] * q.d[d];
            difference = 2.0 * difference - slope;
        }
        for (int d = 0; d < dim; d++) sum[d] += q.w_r2 * difference * q.d[d];
    }
    for (int d = 0; d < dim; d++) {
        g[d] = 0;
        for (int e = 0; e < dim; e++) g[d] += dim / t->n0 * b[d * dim + e] * sum[e];
    }
}

MPS_ROW void find_first(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i) || mps_region_of(f->region, i) == MPS_REGION_SPRAY) return;
    gradient(dim, v, f, i, NULL, f->first + i * dim);
}
MPS_ROWS(find_first_rows, find_first, fields)

MPS_ROW void accelerate(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i) || mps_region_of(f->region, i) == MPS_REGION_SPRAY) return;
    const double *tank = f->tank_acceleration + i * dim;
    double own[3];
    for (int d = 0; d < dim; d++) own[d] = f->first[i * dim + d];
    if (v->setting[SECOND] > 0 && mps_region_of(f->region, i) == MPS_REGION_SURFACE)
        gradient(dim, v, f, i, f->first, own);
    for (int d = 0; d < dim; d++)
        f->acceleration[i * dim + d] -= (v->flux.body ? v->g[d] - tank[d] : 0) + own[d];
}
MPS_ROWS(accelerate_rows, accelerate, fields)

static int accelerate_fluid(mps_stage *s)
{
    fields f = {.pressure = s->data[PRESSURE],
                .tank_acceleration = s->data[TANK_ACCELERATION],
                .correction = s->data[CORRECTION],
                .region = s->data[REGION],
                .acceleration = s->data[ACCELERATION],
                .first = mps_stage_scratch(s, s->view->n * s->view->dim)};
    if (!f.first) return 1;
    mps_stage_rows(s, &find_first_rows, &f);
    if (s->view->setting[SECOND] > 0 &&
        mps_stage_refresh(s, 1, &(mps_shared){f.first, s->view->dim, MPS_TYPE_REAL}))
        return 1;
    mps_stage_rows(s, &accelerate_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_GRADIENT, .use_count = USES, .uses = uses, .run = accelerate_fluid, .device = 1}};

const mps_model_ops mps__gradient_corrected = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "gradient.corrected",
    .help = "Pressure gradient that is exact for linear pressures",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};
