/* SPDX-License-Identifier: BSD-3-Clause */
/* Viscous acceleration of several phases, W22 (14)(15), W22: Wen, Zhao & Wan 2022, over all pairs:
 *   a_i = 2D/(n0 lambda rho_i) sum mu_ij (u_j - u_i) W,
 *   mu_ij = [(mu_i^theta + mu_j^theta)/2]^(1/theta),
 * theta -1: harmonic mean, 1: arithmetic, 0: geometric. This is div(mu grad u). It lacks the other
 * part of the stress, grad u . grad mu, which is 0 in one fluid, but not where mu jumps. A droplet
 * that rotates with the liquid around it would have friction. With `stress` 1 pairs act along e =
 * r_ij/|r_ij|,
 *   a_i = 2D (D + 2)/(n0 lambda rho_i) sum mu_ij [(u_j - u_i).e] e W,
 * which is div(mu (grad u + grad u^T)) if div u = 0. In a square lattice (far radius 3.1 dp) shear
 * along the lattice and across it differs by 1.2 %.
 *
 * mu_ij is symmetric, so pairs of fluid conserve momentum; with `stress` 1 also angular momentum. A
 * solid has the viscosity of the fluid particle. If a model has the channel "viscosity" [Pa s],
 * mu_i is its value instead of the viscosity of the phase.
 *
 * Walls do not slip: they have the velocity of the tank.
 *   mirror 1 (default): dummies have mirrored velocities (friction.h)
 *   mirror 0, W22: dummies have the velocity of the tank too; a linear profile is 0 at 0.2 dp
 *     behind the wall with a far radius of 3.1 dp, at 0.4 dp with 4.1 dp (with `stress` 1 half)
 *   slip: walls without friction, by the axis of the lab nearest to their normal */
#include "friction.h"
#include <mps/reaction.h>

enum { THETA, SLIP, STRESS, MIRROR, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [THETA] = {"theta", "-", "Mean viscosity of a pair; -1: harmonic, 0: geometric, 1: arithmetic",
               MPS_TYPE_REAL, -1.0, -1.0, 1.0},
    [SLIP] = {"slip", "-",
              "Walls without friction, by the axis of their normal: sum of 1 x, 2 y, 4 z",
              MPS_TYPE_INTEGER, 0.0, 0.0, 7.0},
    [STRESS] = {"stress", "-", "1: the whole viscous stress; 0: div(mu grad u), as in W22",
                MPS_TYPE_FLAG, 0.0, 0.0, 1.0},
    [MIRROR] = {"mirror", "-", "1: no slip at the face of walls; 0: behind it, as in W22",
                MPS_TYPE_FLAG, 1.0, 0.0, 1.0}};

enum { VELOCITY, DENSITY, VISCOSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {
    [VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
    [DENSITY] = {"density", MPS_USE_READ},
    [VISCOSITY] = {"viscosity", MPS_USE_NEIGHBOURS | MPS_USE_OPTIONAL},
    [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *velocity, *density, *viscosity;
    double *acceleration;
    double *friction;                     /* [n*dim] the part due to solids */
    const int32_t *slippery;              /* NULL: no slip at any wall */
    double theta;                         /* exponent of mean_viscosity() */
    bool whole;                           /* pairs act along their line of centres */
    bool mirror;                          /* dummies have mirrored velocities */
    double mean[MPS_PHASES * MPS_PHASES]; /* mu of pairs of phases */
} fields;

/* W22 (15), the last of its expressions. */
static double mean_viscosity(double theta, double a, double b)
{
    if (a == b) return a;
    if (theta <= 0 && (a == 0 || b == 0)) return 0;
    if (fabs(theta) < 1e-6) return sqrt(a * b);
    if (theta == -1.0) return 2.0 * a * b / (a + b);
    return mps_pow(0.5 * (mps_pow(a, theta) + mps_pow(b, theta)), 1.0 / theta);
}

/* Axis nearest to the normal of a solid particle; for dummies to that of their wall. -1: no
 * normal. */
static inline int wall_axis(const int dim, const mps_view *v, int64_t i)
{
    const int64_t wall = mps_is_dummy(v, i) ? v->wall_of[i] : i;
    int axis = -1;
    double most = 0;
    for (int d = 0; wall >= 0 && d < dim; d++) {
        const double area = fabs(v->area[wall * dim + d]);
        if (area <= most) continue;
        most = area;
        axis = d;
    }
    return axis;
}

typedef struct slips {
    int32_t *slippery; /* [n] 1 for solid particles without friction */
} slips;

MPS_ROW void find_slippery(const int dim, const mps_view *v, const slips *f, int64_t i)
{
    if (mps_is_fluid(v, i)) return;
    const int axis = wall_axis(dim, v, i);
    f->slippery[i] = axis >= 0 && ((int)v->setting[SLIP] >> axis & 1);
}
MPS_ROWS(find_slippery_rows, find_slippery, slips)

/* given: whether the channel "viscosity" exists. */
MPS_ROW void diffuse(const int dim, const mps_view *v, const fields *f, int64_t i, const bool given)
{
    if (!mps_is_fluid(v, i)) return;
    const mps_stencil *t = &v->far;
    const double *all = f->velocity, *u = all + i * dim;
    const double *mu = f->mean + MPS_PHASES * v->phase[i];
    const double c = 2.0 * dim / (t->n0 * t->lambda * f->density[i]);
    double sum[3] = {0}, wall[3] = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (f->slippery && f->slippery[mps_stencil_column(t, p)] > 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        /* the particle whose mu is used for j */
        const int64_t like = mps_is_fluid(v, q.j) ? q.j : i;
        const double w = q.w * (given
                                    ? mean_viscosity(f->theta, f->viscosity[i], f->viscosity[like])
                                    : mu[v->phase[like]]);
        double du[3], along = 0;
        if (f->mirror && mps_is_dummy(v, q.j))
            mps__mirror_velocity(dim, v, all, i, q.j, du);
        else
            for (int d = 0; d < dim; d++) du[d] = all[q.j * dim + d] - u[d];
        for (int d = 0; d < dim; d++) along += du[d] * q.d[d];
        along *= (dim + 2) / (q.r * q.r);
        for (int d = 0; d < dim; d++) {
            const double term = w * (f->whole ? along * q.d[d] : du[d]);
            sum[d] += term;
            if (!mps_is_fluid(v, q.j)) wall[d] += term;
        }
    }
    for (int d = 0; d < dim; d++) {
        f->acceleration[i * dim + d] += c * sum[d];
        f->friction[i * dim + d] = c * wall[d];
    }
}

MPS_ROW void diffuse_phase(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    diffuse(dim, v, f, i, false);
}
MPS_ROWS(diffuse_phase_rows, diffuse_phase, fields)

MPS_ROW void diffuse_given(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    diffuse(dim, v, f, i, true);
}
MPS_ROWS(diffuse_given_rows, diffuse_given, fields)

static int diffuse_velocity(mps_stage *s)
{
    const double *k = s->view->setting;
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .viscosity = s->data[VISCOSITY],
                .acceleration = s->data[ACCELERATION],
                .friction = mps_stage_scratch(s, s->view->n * s->view->dim),
                .theta = k[THETA],
                .whole = k[STRESS] >= 0.5,
                .mirror = k[MIRROR] >= 0.5};
    if (!f.friction) return 1;
    if (k[SLIP] >= 1) {
        int32_t *slippery = mps_stage_scratch_integers(s, s->view->n);
        if (!slippery) return 1;
        mps_stage_rows(s, &find_slippery_rows, &(slips){slippery});
        if (mps_stage_refresh(s, 1, &(mps_shared){slippery, 1, MPS_TYPE_INTEGER})) return 1;
        f.slippery = slippery;
    }
    for (int p = 0; p < MPS_PHASES; p++)
        for (int q = 0; q < MPS_PHASES; q++)
            f.mean[MPS_PHASES * p + q] = mean_viscosity(k[THETA], s->view->viscosity[p],
                                                        s->view->viscosity[q]);
    mps_stage_rows(s, f.viscosity ? &diffuse_given_rows : &diffuse_phase_rows, &f);
    return mps_stage_reaction(s, NULL, f.friction);
}

/* Limits of a light fluid beside a viscous one, by the viscosities of the phases; the limit of a
 * single phase is that of the time control. With the full stress, pairs act only along their line
 * of centres, and more strongly: steps are stable below lambda/(2 (D + 2) nu), 0.18 dp^2/nu with a
 * far radius of 2.1 dp. */
static int limit_step(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *k = v->setting;
    double rho[MPS_PHASES], nu = 0, own = 0;
    mps_stage_densities(s, rho, NULL);
    for (int p = 0; p < MPS_PHASES; p++)
        if (rho[p] > 0) own = mps_larger(own, v->viscosity[p] / rho[p]);
    for (int p = 0; p < MPS_PHASES; p++)
        for (int q = 0; q < MPS_PHASES; q++) {
            if (p == q || !(rho[p] > 0 && rho[q] > 0)) continue;
            nu = mps_larger(nu,
                            mean_viscosity(k[THETA], v->viscosity[p], v->viscosity[q]) / rho[p]);
        }
    double limit = nu > 0 ? 0.2 * v->dp * v->dp / nu : INFINITY;
    if (k[STRESS] >= 0.5 && own != 0)
        limit = mps_smaller(limit, 0.7 * v->far.lambda / (2 * (v->dim + 2) * mps_larger(nu, own)));
    if (limit < s->dt_limit) s->dt_limit = limit;
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_LIMIT, .run = limit_step, .device = 1},
                                 {.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .before = "friction",
                                  .run = diffuse_velocity,
                                  .device = 1}};

const mps_model_ops mps__viscosity_pair = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "viscosity.pair",
                                           .help = "Viscous acceleration of several phases",
                                           .setting_count = SETTINGS,
                                           .settings = settings,
                                           .verb_count = 2,
                                           .verbs = verbs};
