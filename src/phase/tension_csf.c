/* SPDX-License-Identifier: BSD-3-Clause */
/* Surface tension, contoured continuum surface force, W22 (19)-(23), W22: Wen, Zhao & Wan 2022:
 * force per volume F_S = -sigma kappa <grad C>,
 *   <grad C>_i = D/n0 sum C_ij r_ij/|r_ij|^2 W  (near radius),
 *   C_ij = 2 rho_i/(rho_i + rho_j) for another phase, else 0,
 * kappa as in tension.c. <grad C> is summed with the sigma of each pair: that of
 * mps_tension_set() for two phases, else the setting. */
#include "tension.h"

enum { SIGMA, RADIUS, THRESHOLD, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [SIGMA] = {"sigma", "N/m", "Surface tension of phases without mps_tension_set()", MPS_TYPE_REAL,
               7.27e-2, 0.0, 100.0},
    [RADIUS] = {"radius", "dp", "Radius r_s of the curvature: larger is smoother", MPS_TYPE_REAL,
                8.1, 2.1, 20.0},
    [THRESHOLD] = {"threshold", "1/dp", "Smallest magnitude of grad f at an interface",
                   MPS_TYPE_REAL, 0.02, 1e-6, 1.0}};

enum { DENSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {
    [DENSITY] = {"density", MPS_USE_NEIGHBOURS}, [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *density;
    double *acceleration;
    double *kappa; /* [n] curvatures */
} fields;

/* grad: out, sigma <grad C>_i / rho_i */
MPS_ROW void colour_gradient(const int dim, const mps_view *v, const fields *f, int64_t i,
                             double grad[3])
{
    const mps_stencil *t = &v->near;
    for (int d = 0; d < dim; d++) grad[d] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || v->phase[j] == v->phase[i]) continue;
        const double own = mps__pair_sigma(v, v->phase[i], v->phase[j], v->setting[SIGMA]);
        if (own == 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double sum = f->density[i] + f->density[j];
        const double share = own * dim / t->n0 * q.w_r2 * 2.0 / sum;
        for (int d = 0; d < dim; d++) grad[d] += share * q.d[d];
    }
}

MPS_ROW void pull(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double grad[3];
    if (f->kappa[i] == 0) return;
    colour_gradient(dim, v, f, i, grad);
    for (int d = 0; d < dim; d++) f->acceleration[i * dim + d] -= f->kappa[i] * grad[d];
}
MPS_ROWS(pull_rows, pull, fields)

static int pull_interfaces(mps_stage *s)
{
    const double *k = s->view->setting;
    fields f = {.density = s->data[DENSITY],
                .acceleration = s->data[ACCELERATION],
                .kappa = mps_stage_scratch(s, s->view->n)};
    if (!f.kappa || mps__curvatures(s, MPS_NEAR, k[RADIUS], k[THRESHOLD], f.kappa)) return 1;
    mps_stage_rows(s, &pull_rows, &f);
    return 0;
}

static double reach(const double *setting, double dp)
{
    return setting[RADIUS] * dp;
}

static int limit_step(mps_stage *s)
{
    mps__tension_limit(s, s->view->setting[SIGMA]);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_LIMIT, .run = limit_step, .device = 1},
                                 {.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "viscosity",
                                  .before = "friction",
                                  .run = pull_interfaces,
                                  .device = 1}};

const mps_model_ops mps__tension_csf = {.struct_size = sizeof(mps_model_ops),
                                        .api = MPS_MODEL_API,
                                        .name = "tension.csf",
                                        .help = "Surface tension as a force at interfaces",
                                        .setting_count = SETTINGS,
                                        .settings = settings,
                                        .verb_count = 2,
                                        .verbs = verbs,
                                        .reach = reach};
