/* SPDX-License-Identifier: BSD-3-Clause */
/* Particle shifting toward an even lattice: s_i = -c dt (U_g + max_j |u_j - u_i|) l D/n0 sum w r_ij over all kinds, at most
 * `limit` l. In the first two rows of a free surface the part along its normal is taken away: it would expand the fluid.
 * In calm water the sum w r_ij would push the fluid toward walls and corners for ever, against the volume term: a disordered lattice
 * presses on an ordered one. So the U_g part keeps what varies from particle to particle and loses the share `filter` of its kernel
 * mean. The part of the strain rate stays whole: it repairs what a violent flow tears.
 * With `transport` the velocity goes along: u += s.grad u over fluid of the same phase, within the range of its neighbours'
 * velocities (over all neighbours, or unbounded, a lone drop would accelerate itself). */
#include "walls.h"

enum { STRENGTH, LIMIT, TRANSPORT, FILTER };
static const mps_setting settings[] = {
    {"strength", 1.0, 0.0, 10.0}, {"limit", 0.05, 0.0, 0.5}, {"transport", 1.0, 0.0, 1.0}, {"filter", 0.8, 0.0, 1.0}};

/* Nearer to a wall [dp] it does not carry anybody on towards it, and out of the nearer half it brings all, spray as well. */
static const double wall_distance = 0.5;

/* fmax() and fmin() as one instruction: `b` may be NaN and does not count then. */
static inline double larger(double a, double b)
{
    return b > a ? b : a;
}
static inline double smaller(double a, double b)
{
    return b < a ? b : a;
}

/* Normal of the free surface near i: its own asymmetry, or the mean of its surface neighbours'. Not unit. */
static void surface_normal(const mps_stage *s, int64_t i, double n[3])
{
    const mps_stencil *t = s->near;
    for (int d = 0; d < s->dim; d++) n[d] = s->region[i] == MPS_REGION_SURFACE ? s->asymmetry[i * s->dim + d] : 0.0;
    if (s->region[i] != MPS_REGION_NEAR) return;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->region[j] != MPS_REGION_SURFACE) continue;
        const double w = mps_stencil_pair(t, i, p).w;
        for (int d = 0; d < s->dim; d++) n[d] += w * s->asymmetry[j * s->dim + d];
    }
}

/* What one pass over the pairs of a particle collects. */
typedef struct pair_sums {
    double mean[3], weight; /* kernel sums over inner fluid: of the unevenness, and of 1 */
    double most;            /* largest |u_j - u_i|^2 of the fluid */
    double m[9], g[9];      /* sum w r_ij (x) r_ij and (u_j - u_i) (x) r_ij over fluid of the same phase */
    double low[3], high[3]; /* range of u_j - u_i there */
    double even[3];         /* own unevenness */
    bool solids;            /* among the pairs */
} pair_sums;

/* sum w r_ij over all kinds */
MPS__ROW void unevenness(const int dim, const mps_stage *s, int64_t i, double *even)
{
    const mps_stencil near = *s->near, *t = &near;
    double sum[3] = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++) sum[d] += q.w_r2 * q.d[d];
    }
    for (int d = 0; d < dim; d++) even[i * dim + d] = sum[d];
}

MPS__ROW void collect(const int dim, const mps_stage *stage, const double *even, int64_t i, pair_sums *c)
{
    const mps_stage copy = *stage, *s = &copy;
    const mps_stencil near = *s->near, *t = &near;
    const double *u = s->u + i * dim;
    *c = (pair_sums){0};
    for (int d = 0; d < dim; d++) c->even[d] = even[i * dim + d];
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_FLUID) {
            c->solids = true;
            continue;
        }
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double v[3], v2 = 0;
        for (int d = 0; d < dim; d++) {
            v[d] = s->u[q.j * dim + d] - u[d];
            v2 += v[d] * v[d];
        }
        c->most = larger(c->most, v2);
        if (s->region[q.j] < MPS_REGION_SURFACE) {
            c->weight += q.w;
            for (int d = 0; d < dim; d++) c->mean[d] += q.w * even[q.j * dim + d];
        }
        if (s->phase[q.j] != s->phase[i] || s->region[q.j] == MPS_REGION_SPRAY) continue;
        for (int d = 0; d < dim; d++) {
            c->low[d] = smaller(c->low[d], v[d]);
            c->high[d] = larger(c->high[d], v[d]);
            for (int e = 0; e < dim; e++) c->g[d * dim + e] += q.w_r2 * v[d] * q.d[e];
            for (int e = d; e < dim; e++) c->m[d * dim + e] += q.w_r2 * q.d[d] * q.d[e];
        }
    }
}

MPS__ROW void shift_of(const int dim, const double *k, const mps_stage *s, int64_t i, const pair_sums *sums, double v[3])
{
    double n[3] = {0}, n2 = 0, vn = 0, v2 = 0;
    const double c = -k[STRENGTH] * s->dt * s->dp * dim / s->near->n0, calm = c * s->velocity_scale, torn = c * sqrt(sums->most);
    const double smooth = sums->weight > 0 ? k[FILTER] * calm / sums->weight : 0;
    for (int d = 0; d < dim; d++) v[d] = (calm + torn) * sums->even[d] - smooth * sums->mean[d];
    surface_normal(s, i, n);
    for (int d = 0; d < dim; d++) {
        n2 += n[d] * n[d];
        vn += n[d] * v[d];
    }
    for (int d = 0; d < dim; d++) {
        if (n2 > 0) v[d] -= vn / n2 * n[d];
        v2 += v[d] * v[d];
    }
    const double limit = k[LIMIT] * s->dp;
    if (v2 > limit * limit)
        for (int d = 0; d < dim; d++) v[d] *= limit / sqrt(v2);
}

/* du = s.grad u at i, between the least and the greatest difference its neighbours have. */
MPS__ROW void transport(const int dim, const mps_stage *s, const pair_sums *sums, const double *shift, double *du)
{
    const double c = dim / s->near->n0;
    double m[9], b[9];
    for (int d = 0; d < dim; d++)
        for (int e = d; e < dim; e++) m[d * dim + e] = m[e * dim + d] = c * sums->m[d * dim + e];
    mps_matrix_inverse_bounded(dim, m, 0.25, b);
    for (int d = 0; d < dim; d++) {
        double v = 0;
        for (int e = 0; e < dim; e++)
            for (int f = 0; f < dim; f++) v += c * sums->g[d * dim + e] * b[e * dim + f] * shift[f];
        du[d] = smaller(sums->high[d], larger(sums->low[d], v));
    }
}

/* Displacement of a particle, and with k[TRANSPORT] the change of its velocity. All is one function, so that the sums stay in registers. */
MPS__ROW void move(const int dim, const double *k, const mps_stage *s, int64_t i, const double *even, double *const out[2])
{
    const bool spray = s->region[i] == MPS_REGION_SPRAY;
    pair_sums sums = {.solids = true};
    double v[3] = {0};
    if (!spray) {
        collect(dim, s, even, i, &sums);
        shift_of(dim, k, s, i, &sums, v);
    }
    if (sums.solids) mps__walls_keep_off(s, wall_distance * s->dp, k[LIMIT] * s->dp, NULL, i, v);
    if (k[TRANSPORT] > 0 && !spray) transport(dim, s, &sums, v, out[1] + i * dim);
    for (int d = 0; d < dim; d++) out[0][i * dim + d] += v[d];
}

static int shift(void *self, const double *k, mps_stage *s, double *dx)
{
    (void)self;
    const int dim = s->dim;
    double *du = mps_stage_scratch(s, s->n * dim), *even = mps_stage_scratch(s, s->n * dim);
    if (!du || !even) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->region[i] != MPS_REGION_SPRAY) MPS__ROW_CALL(s, unevenness, s, i, even);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, move, k, s, i, even, (double *[]){dx, du});
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n * dim; i++) s->u[i] += du[i];
    return 0;
}

const mps_model_ops mps__shift_tangential = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "shift.tangential",
                                             .order = 800,
                                             .setting_count = 4,
                                             .settings = settings,
                                             .shift = shift};
