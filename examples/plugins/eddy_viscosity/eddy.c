/* SPDX-License-Identifier: BSD-3-Clause */
/* Eddy viscosity of a large-eddy simulation, Smagorinsky (1963):
 *   nu_t = (C_s dp)^2 |S|,  |S| = sqrt(2 S:S),  S = (grad u + grad u^T)/2,
 *   mu = mu_phase + rho nu_t,
 *   grad u_i = M_i^-1 sum w (u_j - u_i) (x) r_ij,  M_i = sum w r_ij (x) r_ij,  w = W/r^2
 * over near fluid neighbours. The gradient is exact for linear fields if M is regular; a row with
 * too few or collinear neighbours keeps the viscosity of the phase. Walls are omitted, because slip
 * would count as shear; there is no wall law. cs = 0 gives the viscosity of the phase. */
#include "eddy.h"
#include <mps/plugin.h>
#include <stdbool.h>

enum { CS, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [CS] = {"cs", "-", "Smagorinsky constant C_s", MPS_TYPE_REAL, 0.15, 0.0, 1.0}};

static const mps_channel channels[] = {
    {.name = "viscosity",
     .unit = "Pa s",
     .help = "dynamic viscosity",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP,
     .initial = 0.0},
    {.name = "strain_rate",
     .unit = "1/s",
     .help = "|S| in the last step; fluid that comes begins at 0",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_PARTICLE,
     .initial = 0.0}};

/* Arrays of particles that the loops use. */
typedef struct fields {
    const double *velocity, *density;
    double *strain, *viscosity;
} fields;

/* mu of a row with strain rate `strain`. */
static double viscosity_of(const mps_view *v, double density, double strain, int64_t i)
{
    const double length = v->setting[CS] * v->dp;
    return v->viscosity[v->phase[i]] + density * length * length * strain;
}

/* ---- MPS_LIMIT ------------------------------------------------------------------------------- */

enum { LIMIT_STRAIN, LIMIT_DENSITY, LIMIT_USES };
static const mps_use limit_uses[LIMIT_USES] = {
    [LIMIT_STRAIN] = {"strain_rate", MPS_USE_READ}, [LIMIT_DENSITY] = {"density", MPS_USE_READ}};

MPS_ROW void raise(const int dim, const mps_view *v, const fields *f, int64_t i, double *most)
{
    (void)dim;
    if (v->kind[i] != MPS_FLUID) return;
    const double mu = viscosity_of(v, f->density[i], f->strain[i], i);
    most[0] = mps_larger(most[0], mu / f->density[i]);
}
MPS_SUMS(raise_rows, raise, fields)

/* Explicit diffusion has no new extremes below dt = lambda/(2 D nu); half of it is allowed, with
 * the strain rates of the last step. */
static int limit_step(mps_stage *s)
{
    const mps_view *v = s->view;
    const fields f = {.strain = s->data[LIMIT_STRAIN], .density = s->data[LIMIT_DENSITY]};
    double nu;
    mps_stage_max(s, 1, &raise_rows, &f, &nu);
    if (nu > 0) s->dt_limit = fmin(s->dt_limit, 0.5 * v->far.lambda / (2 * v->dim * nu));
    return 0;
}

/* ---- MPS_PREPARE ----------------------------------------------------------------------------- */

enum { VELOCITY, DENSITY, STRAIN, VISCOSITY, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_READ},
                                   [STRAIN] = {"strain_rate", MPS_USE_WRITE},
                                   [VISCOSITY] = {"viscosity", MPS_USE_WRITE}};

/* Smallest determinant of M over that of a sphere with the same trace at which M is inverted. */
static const double REGULAR = 1e-3;

/* Inverse of a symmetric matrix [dim*dim], with rows of 3. @return whether it is regular */
MPS_ROW bool invert(const int dim, double m[3][3], double inverse[3][3])
{
    double det = 0, trace = 0;
    if (dim == 2) m[2][2] = 0.5 * (m[0][0] + m[1][1]); /* a separate direction */
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, g = (d + 2) % 3;
        for (int c = 0; c < 3; c++) {
            const int h = (c + 1) % 3, k = (c + 2) % 3;
            inverse[c][d] = m[e][h] * m[g][k] - m[e][k] * m[g][h];
        }
        trace += m[d][d] / 3;
    }
    for (int d = 0; d < 3; d++) det += m[0][d] * inverse[d][0];
    if (!(det > REGULAR * trace * trace * trace)) return false;
    for (int d = 0; d < 9; d++) inverse[d / 3][d % 3] /= det;
    return true;
}

/* |S| of row i. */
MPS_ROW double strain_of(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double m[3][3] = {{0}}, g[3][3] = {{0}}, inverse[3][3], sum = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (v->kind[q.j] != MPS_FLUID) continue;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) {
                m[d][e] += q.w_r2 * q.d[d] * q.d[e];
                g[d][e] += q.w_r2 * q.d[e] *
                           (f->velocity[q.j * dim + d] - f->velocity[i * dim + d]);
            }
    }
    if (!invert(dim, m, inverse)) return 0;
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) {
            double twice = 0; /* 2 S_de */
            for (int c = 0; c < dim; c++)
                twice += g[d][c] * inverse[c][e] + g[e][c] * inverse[c][d];
            sum += 0.5 * twice * twice;
        }
    return sqrt(sum);
}

MPS_ROW void mix(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (v->kind[i] != MPS_FLUID) return;
    f->strain[i] = strain_of(dim, v, f, i);
    f->viscosity[i] = viscosity_of(v, f->density[i], f->strain[i], i);
}
MPS_ROWS(mix_rows, mix, fields)

static int mix_fluid(mps_stage *s)
{
    const fields f = {.velocity = s->data[VELOCITY],
                      .density = s->data[DENSITY],
                      .strain = s->data[STRAIN],
                      .viscosity = s->data[VISCOSITY]};
    mps_stage_rows(s, &mix_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LIMIT, .use_count = LIMIT_USES, .uses = limit_uses, .run = limit_step},
    {.hook = MPS_PREPARE, .use_count = USES, .uses = uses, .run = mix_fluid}};

const mps_model_ops eddy_smagorinsky = {.struct_size = sizeof(mps_model_ops),
                                        .api = MPS_MODEL_API,
                                        .name = "eddy.smagorinsky",
                                        .help = "Eddy viscosity of a large-eddy simulation",
                                        .setting_count = SETTINGS,
                                        .settings = settings,
                                        .channel_count = 2,
                                        .channels = channels,
                                        .verb_count = 2,
                                        .verbs = verbs};

/* As a plug-in of a case. */
mps_status mps_plugin(mps_registry *r)
{
    const mps_status status = mps_plugin_begin(r, "eddy_viscosity", "1.0");
    return status < 0 ? status : r->model(r->host, &eddy_smagorinsky);
}
