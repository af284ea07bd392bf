/* SPDX-License-Identifier: BSD-3-Clause */
/* Viscous acceleration a = nu <lap u>, W22 (2)(6), over all pairs; W22: Wen, Zhao & Wan 2022. Walls
 * do not slip: they have the velocity of the tank.
 *   mirror 1 (default): dummies have mirrored velocities (friction.h)
 *   mirror 0, W22: dummies have the velocity of the tank too
 * If a model has the channel "viscosity" [Pa s], its value replaces the viscosity of the phase. */
#include "friction.h"
#include <mps/reaction.h>

enum { MIRROR, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [MIRROR] = {"mirror", "-", "1: no slip at the face of walls; 0: behind it, as in W22",
                MPS_TYPE_FLAG, 1.0, 0.0, 1.0}};

enum { VELOCITY, DENSITY, VISCOSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_READ},
                                   [VISCOSITY] = {"viscosity", MPS_USE_READ | MPS_USE_OPTIONAL},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

enum { PAIRS = MPS_PAIRS(64) };

typedef struct fields {
    const double *velocity, *density;
    const double *viscosity; /* NULL: of the phases */
    double *acceleration;
    double *friction; /* [n*dim] the part due to solids */
    bool mirror;
} fields;

/* W of the pairs from..from+count-1 of row i: vectorises roots and divisions. */
MPS_ROW void weights(const int dim, const mps_stencil *t, int64_t i, int64_t from, int count,
                     double *w)
{
    for (int k = 0; k < count; k++) {
        const double *a = t->x + i * dim,
                     *b = t->x + (int64_t)mps_stencil_column(t, from + k) * dim;
        const double x = b[0] - a[0], y = b[1] - a[1], z = dim == 3 ? b[2] - a[2] : 0;
        w[k] = dim == 3 ? x * x + y * y + z * z : x * x + y * y;
    }
    for (int k = 0; k < count; k++) w[k] = sqrt(w[k]);
    mps_kernel_weights(&t->kernel, t->re, count, w, w);
}

MPS_ROW void diffuse(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    const double mu = f->viscosity ? f->viscosity[i] : v->viscosity[v->phase[i]];
    const double nu = mu / f->density[i];
    if (nu == 0) return;
    const mps_stencil *t = &v->far;
    const double *all = f->velocity, *u = all + i * dim, c = 2.0 * dim / (t->n0 * t->lambda);
    const bool mirror = f->mirror;
    double sum[3] = {0}, wall[3] = {0}, w[PAIRS];
    for (int64_t from = mps_stencil_begin(t, i); from < mps_stencil_end(t, i); from += PAIRS) {
        const int count = mps_stencil_end(t, i) - from < PAIRS ? (int)(mps_stencil_end(t, i) - from)
                                                               : PAIRS;
        weights(dim, t, i, from, count, w);
        for (int k = 0; k < count; k++) {
            const int64_t j = mps_stencil_column(t, from + k);
            double du[3];
            if (mirror && mps_is_dummy(v, j))
                mps__mirror_velocity(dim, v, all, i, j, du);
            else
                for (int d = 0; d < dim; d++) du[d] = all[j * dim + d] - u[d];
            for (int d = 0; d < dim; d++) sum[d] += du[d] * w[k];
            for (int d = 0; d < dim && !mps_is_fluid(v, j); d++) wall[d] += du[d] * w[k];
        }
    }
    for (int d = 0; d < dim; d++) {
        f->acceleration[i * dim + d] += c * nu * sum[d];
        f->friction[i * dim + d] = c * nu * wall[d];
    }
}
MPS_ROWS(diffuse_rows, diffuse, fields)

static int diffuse_velocity(mps_stage *s)
{
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .viscosity = s->data[VISCOSITY],
                .acceleration = s->data[ACCELERATION],
                .friction = mps_stage_scratch(s, s->view->n * s->view->dim),
                .mirror = s->view->setting[MIRROR] >= 0.5};
    if (!f.friction) return 1;
    mps_stage_rows(s, &diffuse_rows, &f);
    return mps_stage_reaction(s, NULL, f.friction);
}

static const mps_verb verbs[] = {{.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .before = "friction",
                                  .run = diffuse_velocity,
                                  .device = 1}};

const mps_model_ops mps__viscosity_laplacian = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "viscosity.laplacian",
    .help = "Viscous acceleration of one fluid, nu lap u",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};
