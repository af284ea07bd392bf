/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure gradient for high ratios of density, W22 (18), W22: Wen, Zhao & Wan 2022:
 *   a_i = -D/n0 sum [2 (P_j - P_i)/(rho_i + rho_j) + (P_i - P'_i)/rho_i] r_ij/|r_ij|^2 W,
 * P'_i the smallest pressure of i and its neighbours of the same phase; the second term is
 * repulsive. Densities are the smoothed ones. Solids have the density of the fluid beside them:
 * with the density of the gas, a wall below the contact line would repel the gas. Dummies need
 * pressures and densities: `wall.extrapolate`. */
#include "helpers.h"

enum { PRESSURE, DENSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"pressure_density", MPS_USE_NEIGHBOURS},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *pressure, *density;
    double *acceleration;
} fields;

/* P'_i */
static double least_pressure(const mps_view *v, const double *pressure, int64_t i)
{
    const mps_stencil *t = &v->near;
    double least = pressure[i];
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || v->phase[j] != v->phase[i]) continue;
        if (pressure[j] < least) least = pressure[j];
    }
    return least;
}

MPS_ROW void accelerate(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    const mps_stencil *t = &v->near;
    const double *all = f->pressure, rho = f->density[i];
    const double apart = (all[i] - least_pressure(v, all, i)) / rho;
    double sum[3] = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double difference = 2.0 * (all[q.j] - all[i]) / (rho + f->density[q.j]);
        const double share = q.w_r2 * (difference + apart);
        for (int d = 0; d < dim; d++) sum[d] += share * q.d[d];
    }
    for (int d = 0; d < dim; d++) f->acceleration[i * dim + d] -= dim / t->n0 * sum[d];
}
MPS_ROWS(accelerate_rows, accelerate, fields)

static int accelerate_fluid(mps_stage *s)
{
    fields f = {s->data[PRESSURE], s->data[DENSITY], s->data[ACCELERATION]};
    mps_stage_rows(s, &accelerate_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_GRADIENT, .use_count = USES, .uses = uses, .run = accelerate_fluid, .device = 1}};

const mps_model_ops mps__gradient_density = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "gradient.density",
                                             .help = "Pressure gradient for high ratios of density",
                                             .verb_count = 1,
                                             .verbs = verbs};
