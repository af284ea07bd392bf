/* SPDX-License-Identifier: BSD-3-Clause */
/* Artificial dissipation: damps pairs of fluid particles along their line of centres,
 *   a_i = 2(D+2)/n0 sum (alpha l U_g + beta l max(0, -u_n)) w u_n/r r_ij,
 * l the spacing, U_g the mps_view.velocity_scale, u_n the rate of separation, w = W/r^2. The force
 * of a pair conserves momentum. alpha reduces lattice noise; beta dissipates the energy of violent
 * impacts. On a shear flow alpha acts as a kinematic viscosity alpha l U_g/D. The viscosity nu of
 * the fluid reduces this noise too. So `viscous` D nu (mean of the pair) is subtracted from alpha l
 * U_g, down to 0: the total is the larger of the two, and a viscous liquid keeps its own
 * viscosity. */
#include "helpers.h"

enum { PAIRS = MPS_PAIRS(32) };

enum { ALPHA, BETA, VISCOUS, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [ALPHA] = {"alpha", "-", "Damping of all pairs", MPS_TYPE_REAL, 0.1, 0.0, 10.0},
    [BETA] = {"beta", "-", "Damping of pairs that approach", MPS_TYPE_REAL, 1.0, 0.0, 10.0},
    [VISCOUS] = {"viscous", "-", "Share of the fluid's viscosity that is subtracted from alpha",
                 MPS_TYPE_REAL, 1.0, 0.0, 1.0}};

enum { VELOCITY, DENSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *velocity, *density;
    double *acceleration;
    double half[MPS_PHASES]; /* half of the contribution of a phase to alpha U_g of a pair [m/s] */
} fields;

/* Fluid neighbours of a particle as arrays: vectorises roots and divisions. */
typedef struct block {
    int count;
    double d[3][PAIRS], r2[PAIRS], rate[PAIRS], w_r2[PAIRS], rho[PAIRS]; /* rate: u_n r */
    double calm[PAIRS];
} block;

MPS_ROW void collect(const int dim, const mps_view *v, const fields *f, int64_t i,
                     const int64_t pairs[2], block *b)
{
    const mps_stencil *t = &v->near;
    const double *all = f->velocity, *rho = f->density, *half = f->half;
    const double *u = all + i * dim;
    int n = 0;
    for (int64_t p = pairs[0]; p < pairs[1]; p++) {
        if (!mps_is_fluid(v, mps_stencil_column(t, p))) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double rate = 0;
        for (int d = 0; d < dim; d++) {
            b->d[d][n] = q.d[d];
            rate += (all[q.j * dim + d] - u[d]) * q.d[d];
        }
        b->r2[n] = q.r2;
        b->rate[n] = rate;
        b->w_r2[n] = q.w_r2;
        b->calm[n] = half[v->phase[q.j]];
        b->rho[n++] = rho[q.j];
    }
    b->count = n;
}

MPS_ROW void damp(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    const mps_stencil *t = &v->near;
    const double c = 2.0 * (dim + 2) / t->n0, own = f->half[v->phase[i]], rho = f->density[i];
    const double beta = v->setting[BETA], dp = v->dp;
    /* a larger viscosity would reverse velocities within a step; the limit decreases below
     * r = dp */
    const double most = 0.15 * dp / v->dt, most_near = most / (dp * dp * dp);
    double sum[3] = {0}, share[PAIRS];
    block b;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p += PAIRS) {
        const int64_t end = p + PAIRS < mps_stencil_end(t, i) ? p + PAIRS : mps_stencil_end(t, i);
        collect(dim, v, f, i, (const int64_t[]){p, end}, &b);
        for (int n = 0; n < b.count; n++) {
            const double r = sqrt(b.r2[n]), over = 1.0 / r, less = most_near * b.r2[n] * r;
            const double limit = r < dp ? less : most, closing = b.rate[n] < 0 ? b.rate[n] : 0.0;
            const double calm = own + b.calm[n];
            const double nu = (calm > 0 ? calm : 0.0) - beta * closing * over;
            share[n] = b.rho[n] / (rho + b.rho[n]) * over * over * (nu < limit ? nu : limit) *
                       b.w_r2[n] * b.rate[n];
        }
        for (int n = 0; n < b.count; n++)
            for (int d = 0; d < dim; d++) sum[d] += share[n] * b.d[d][n];
    }
    for (int d = 0; d < dim; d++) f->acceleration[i * dim + d] += 2.0 * dp * c * sum[d];
}
MPS_ROWS(damp_rows, damp, fields)

static int damp_pairs(mps_stage *s)
{
    const mps_view *v = s->view;
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .acceleration = s->data[ACCELERATION]};
    const double *k = v->setting;
    double rho[MPS_PHASES];
    mps_stage_densities(s, rho, NULL);
    for (int p = 0; p < MPS_PHASES; p++) {
        const double viscous = k[VISCOUS] * v->dim * v->viscosity[p];
        f.half[p] = 0.5 * (k[ALPHA] * v->velocity_scale -
                           (rho[p] > 0 ? viscous / (rho[p] * v->dp) : 0.0));
    }
    mps_stage_rows(s, &damp_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "viscosity",
                                  .before = "tension",
                                  .run = damp_pairs,
                                  .device = 1}};

const mps_model_ops mps__dissipation_radial = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "dissipation.radial",
    .help = "Artificial dissipation: damps pairs of fluid particles along their line",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};
