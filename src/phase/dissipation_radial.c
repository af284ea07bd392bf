/* SPDX-License-Identifier: BSD-3-Clause */
/* Named dissipation: fluid pairs are damped along their line,
 *   a_i = 2(D+2)/n0 sum (alpha l U_g + beta l max(0, -u_n)) w u_n/r r_ij, u_n the rate of separation, w = W/r^2.
 * Pairwise, so momentum is conserved. alpha calms the lattice, beta takes the energy of violent impacts.
 * On a shear flow alpha acts as a kinematic viscosity alpha l U_g/D. The fluid's own viscosity nu calms the lattice as well, so `viscous` D nu (mean
 * of the pair) is taken off alpha l U_g, down to 0: together they have the larger of the two, and a viscous liquid has its own viscosity. */
#include "builtin.h"

enum { PAIRS = 32 };
enum { ALPHA, BETA, VISCOUS };
static const mps_setting settings[] = {{"alpha", 0.1, 0.0, 10.0}, {"beta", 1.0, 0.0, 10.0}, {"viscous", 1.0, 0.0, 1.0}};

/* Fluid neighbours of a particle, one quantity after the other, so that roots and divisions are taken several at a time. */
typedef struct block {
    int count;
    double d[3][PAIRS], r2[PAIRS], rate[PAIRS], w_r2[PAIRS], rho[PAIRS], calm[PAIRS]; /* rate: u_n r */
} block;

/* Half of what each phase adds to alpha U_g of a pair [m/s]. */
typedef struct calming {
    double half[MPS__PHASE_LIMIT];
} calming;

MPS__ROW void gather(const int dim, const mps_stage *stage, int64_t i, const int64_t pairs[2], const calming *c, block *b)
{
    const mps_stage copy = *stage, *s = &copy;
    const mps_stencil near = *s->near, *t = &near;
    const double *u = s->u + i * dim;
    int n = 0;
    for (int64_t p = pairs[0]; p < pairs[1]; p++) {
        if (s->kind[t->col[p]] != MPS_FLUID) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double rate = 0;
        for (int d = 0; d < dim; d++) {
            b->d[d][n] = q.d[d];
            rate += (s->u[q.j * dim + d] - u[d]) * q.d[d];
        }
        b->r2[n] = q.r2;
        b->rate[n] = rate;
        b->w_r2[n] = q.w_r2;
        b->calm[n] = c->half[s->phase[q.j]];
        b->rho[n++] = s->density[q.j];
    }
    b->count = n;
}

MPS__ROW void damp(const int dim, const double *k, const mps_stage *s, const calming *phases, int64_t i, double *a)
{
    const mps_stencil *t = s->near;
    const double c = 2.0 * (dim + 2) / t->n0, own = phases->half[s->phase[i]], beta = k[BETA], rho = s->density[i], dp = s->dp;
    const double most = 0.15 * dp / s->dt, most_near = most / (dp * dp * dp); /* more would turn velocities round in a step */
    double sum[3] = {0}, share[PAIRS];
    block b;
    for (int64_t p = t->begin[i]; p < t->end[i]; p += PAIRS) {
        gather(dim, s, i, (const int64_t[]){p, p + PAIRS < t->end[i] ? p + PAIRS : t->end[i]}, phases, &b);
        for (int n = 0; n < b.count; n++) {
            const double r = sqrt(b.r2[n]), over = 1.0 / r, less = most_near * b.r2[n] * r; /* nearer than dp still less */
            const double limit = r < dp ? less : most, closing = b.rate[n] < 0 ? b.rate[n] : 0.0;
            const double calm = own + b.calm[n], nu = (calm > 0 ? calm : 0.0) - beta * closing * over;
            share[n] = b.rho[n] / (rho + b.rho[n]) * over * over * (nu < limit ? nu : limit) * b.w_r2[n] * b.rate[n];
        }
        for (int n = 0; n < b.count; n++)
            for (int d = 0; d < dim; d++) sum[d] += share[n] * b.d[d][n];
    }
    for (int d = 0; d < dim; d++) a[i * dim + d] += 2.0 * dp * c * sum[d];
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
    calming c;
    double rho[MPS__PHASE_LIMIT];
    mps__phase_densities(s, rho);
    for (int p = 0; p < MPS__PHASE_LIMIT; p++)
        c.half[p] = 0.5 * (k[ALPHA] * s->velocity_scale - (rho[p] > 0 ? k[VISCOUS] * s->dim * s->viscosity[p] / (rho[p] * s->dp) : 0.0));
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, damp, k, s, &c, i, a);
    return 0;
}

const mps_model_ops mps__dissipation_radial = {.struct_size = sizeof(mps_model_ops),
                                               .api = MPS_MODEL_API,
                                               .name = "dissipation.radial",
                                               .order = 310,
                                               .setting_count = 3,
                                               .settings = settings,
                                               .force = force};
