/* SPDX-License-Identifier: BSD-3-Clause */
/* Viscous acceleration of several phases, W22 (14)(15): a_i = 2D/(n0 lambda rho_i) sum mu_ij (u_j - u_i) W over all pairs,
 *   mu_ij = [(mu_i^theta + mu_j^theta)/2]^(1/theta), theta -1: harmonic mean, 1: arithmetic, 0: geometric.
 * That is div(mu grad u) and lacks the rest of the stress, grad u . grad mu, which is nothing in one fluid but not where mu jumps: a drop
 * that turns with the liquid about it would feel friction. With `stress` 1 pairs act along e = r_ij/|r_ij|,
 *   a_i = 2D (D + 2)/(n0 lambda rho_i) sum mu_ij [(u_j - u_i).e] e W,
 * which is div(mu (grad u + grad u^T)) wherever div u = 0. In a square lattice (far radius 3.1 dp) shear along and across it differs by 1.2 %.
 * mu_ij is symmetric, so pairs of fluid exchange momentum and lose none; with `stress` 1 no moment of momentum either. Solids have
 * the fluid's own viscosity. Walls do not slip: they have the tank's velocity, and with `mirror` 1 (default) dummies are seen mirrored
 * (friction.h). With `mirror` 0, W22, dummies have the tank's velocity too: a linear profile is 0 at 0.2 dp behind the wall with a far radius of
 * 3.1 dp, at 0.4 dp with 4.1 dp (half of that with `stress` 1). `slip` names walls that exert no friction, by the axis of the lab their normal
 * is closest to: 1 x, 2 y, 4 z, or the sum of several; 7: all. */
#include "friction.h"

enum { THETA, SLIP, STRESS, MIRROR };
static const mps_setting settings[] = {
    {"theta", -1.0, -1.0, 1.0}, {"slip", 0.0, 0.0, 7.0}, {"stress", 0.0, 0.0, 1.0}, {"mirror", 1.0, 0.0, 1.0}};

/* W22 (15), the last of its expressions. */
static double mean_viscosity(double theta, double a, double b)
{
    if (a == b) return a;
    if (theta <= 0 && (a == 0 || b == 0)) return 0;
    if (fabs(theta) < 1e-6) return sqrt(a * b);
    if (theta == -1.0) return 2.0 * a * b / (a + b);
    return pow(0.5 * (pow(a, theta) + pow(b, theta)), 1.0 / theta);
}

/* The axis along which the wetted side of a solid particle looks; of dummies that of their wall. -1: it has none. */
static int wall_axis(const mps_stage *s, int64_t i)
{
    const int64_t wall = s->kind[i] == MPS_DUMMY ? s->wall_of[i] : i;
    int axis = -1;
    double most = 0;
    for (int d = 0; wall >= 0 && d < s->dim; d++) {
        const double area = fabs(s->area[wall * s->dim + d]);
        if (area <= most) continue;
        most = area;
        axis = d;
    }
    return axis;
}

/* 1 for solid particles without friction; NULL when memory is out. */
static double *find_slippery(mps_stage *s, int axes)
{
    double *slippery = mps_stage_scratch(s, s->n);
    for (int64_t i = 0; slippery && i < s->n; i++) {
        if (s->kind[i] == MPS_FLUID) continue;
        const int axis = wall_axis(s, i);
        slippery[i] = axis >= 0 && (axes >> axis & 1);
    }
    return slippery;
}

typedef struct law {
    double mean[MPS__PHASE_LIMIT * MPS__PHASE_LIMIT]; /* mu of pairs of phases */
    const double *slippery;                           /* NULL if no wall is */
    bool whole;                                       /* pairs act along their line */
    bool mirror;                                      /* dummies are seen mirrored */
} law;

MPS__ROW void diffuse(const int dim, const mps_stage *s, const law *k, int64_t i, double *a)
{
    const mps_stencil *t = s->far;
    const double *u = s->u + i * dim, *mu = k->mean + MPS__PHASE_LIMIT * s->phase[i];
    const double c = 2.0 * dim / (t->n0 * t->lambda * s->density[i]);
    double sum[3] = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (k->slippery && k->slippery[t->col[p]] > 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double w = q.w * mu[s->kind[q.j] == MPS_FLUID ? s->phase[q.j] : s->phase[i]];
        double du[3], along = 0;
        if (k->mirror && s->kind[q.j] == MPS_DUMMY)
            mps__mirror_velocity(dim, s, i, q.j, du);
        else
            for (int d = 0; d < dim; d++) du[d] = s->u[q.j * dim + d] - u[d];
        for (int d = 0; d < dim; d++) along += du[d] * q.d[d];
        along *= (dim + 2) / (q.r * q.r);
        for (int d = 0; d < dim; d++) sum[d] += w * (k->whole ? along * q.d[d] : du[d]);
    }
    for (int d = 0; d < dim; d++) a[i * dim + d] += c * sum[d];
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
    law how = {.whole = k[STRESS] >= 0.5, .mirror = k[MIRROR] >= 0.5};
    if (k[SLIP] >= 1 && !(how.slippery = find_slippery(s, (int)k[SLIP]))) return 1;
    for (int p = 0; p < MPS__PHASE_LIMIT; p++)
        for (int q = 0; q < MPS__PHASE_LIMIT; q++)
            how.mean[MPS__PHASE_LIMIT * p + q] = mean_viscosity(k[THETA], s->viscosity[p], s->viscosity[q]);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, diffuse, s, &how, i, a);
    return 0;
}

/* A light fluid beside a viscous one; what a phase does to itself is the limit of the time control. The whole stress acts along a pair only, and
 * more strongly: steps are stable below lambda/(2 (D + 2) nu), 0.18 dp^2/nu with a far radius of 2.1 dp. */
static double dt_limit(void *self, const double *k, const mps_stage *s)
{
    (void)self;
    double rho[MPS__PHASE_LIMIT], nu = 0, own = 0;
    mps__phase_densities(s, rho);
    for (int p = 0; p < MPS__PHASE_LIMIT; p++)
        if (rho[p] > 0) own = fmax(own, s->viscosity[p] / rho[p]);
    for (int p = 0; p < MPS__PHASE_LIMIT; p++)
        for (int q = 0; q < MPS__PHASE_LIMIT; q++)
            if (p != q && rho[p] > 0 && rho[q] > 0) nu = fmax(nu, mean_viscosity(k[THETA], s->viscosity[p], s->viscosity[q]) / rho[p]);
    const double mixed = nu > 0 ? 0.2 * s->dp * s->dp / nu : INFINITY;
    if (k[STRESS] < 0.5 || own == 0) return mixed;
    return fmin(mixed, 0.7 * s->far->lambda / (2 * (s->dim + 2) * fmax(nu, own)));
}

const mps_model_ops mps__viscosity_pair = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "viscosity.pair",
                                           .order = 300,
                                           .setting_count = 4,
                                           .settings = settings,
                                           .force = force,
                                           .dt_limit = dt_limit};
