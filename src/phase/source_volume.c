/* SPDX-License-Identifier: BSD-3-Clause */
/* Source of the pressure equation for the scheme "imps":
 *   gain (delta/tau - Div(v))/dt,  Div_i = D/n0 sum w (v_j - v_i).B_i r_ij,
 * v the velocities relative to the reference motion: gravity and the tank's acceleration are in the body field b = g - a_tank, so
 * that hydrostatic and rigidly accelerated fluid is exact on any arrangement. Walls are free-slip: no-slip walls double the noise.
 *
 * The gradient and this divergence are not made to undo each other exactly. In films of one or two particles on a wall, where B is
 * large in both, a full step overshoots more than twice and the error grows from step to step with changing sign: hence the gain below 1.
 * A steady pressure does not feel it, a change arrives 1/gain steps later. But the strain of the flow adds -dt T to Div(v) in every step,
 * T = tr((grad v)^2): if that waits too, every strained particle is compressed at the rate (1/gain - 1) dt T, and delta blows it up
 * again against the pressure of another time and place. It is known beforehand, so the share `forward` of it is asked for whole.
 *
 * delta is the volume deviation of mps_op_volume_deviation(), clipped and averaged. Its error follows the waves, so tau is long (20 tau_g):
 * a short one feeds them. What an impact compressed by per cents has to come back before the next: beyond `firm` the time falls to tau_g.
 * Gas that is torn or piled up by tens of per cents (`torn`) comes back in dt/`rapid`. The set-up itself has a delta beside walls that are not on
 * the lattice, 10 % where they slope by 45 degrees. Asked for at once it took twice the hydrostatic pressure in the first step; it comes on
 * over the first `start` tau_g instead.
 *
 * Beside another density velocities of neighbours count by mass: the face between water and air moves with the water.
 *
 * A velocity that must go within a step takes a pressure ~ 1/dt. Gas squeezed out of a closing gap is ten times as fast as the water that
 * drives it, and makes the steps as short; so `pace` lets the denser fluids ask, in each step, for the share only that the step is of the
 * one their own speed would allow. Their pressures are then those of steps of that length. */
#include "builtin.h"
#include <stdbool.h>

enum { TAU, CLIP, STRAIN, GAIN, FIRM, RAPID, TORN, FORWARD, PACE, ASIDE, START };
static const mps_setting settings[] = {{"tau", 20.0, 0.1, 1e6},    {"clip", 0.1, 0.0, 1.0},    {"strain", 1.0, 0.0, 1.0},
                                       {"gain", 0.7, 0.05, 1.0},   {"firm", 0.03, 1e-3, 1.0},  {"rapid", 0.0, 0.0, 1.0},
                                       {"torn", 0.15, 1e-3, 10.0}, {"forward", 0.0, 0.0, 1.0}, {"pace", 1.0, 0.0, 1.0},
                                       {"aside", 1.0, 0.0, 1.0},   {"start", 5.0, 0.0, 1e6}};

/* fmax() and fmin() as one instruction: `b` may be NaN and does not count then. */
static inline double larger(double a, double b)
{
    return b > a ? b : a;
}
static inline double smaller(double a, double b)
{
    return b < a ? b : a;
}

/* delta of each fluid particle, never negative near the surface, where the kernel is cut. The second band has no surface particle within the near
 * radius: a kernel that reaches half a spacing farther at most is whole there. */
static void volume_deviation(const double *k, const mps_stage *s, double *delta)
{
    const int32_t whole = s->far->re <= s->near->re + 0.5 * s->dp ? MPS_REGION_SECOND : MPS_REGION_INNER;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->region[i] >= MPS_REGION_SURFACE) continue;
        double v = s->volume[i];
        if (s->region[i] > whole && v < 0) v = 0;
        delta[i] = smaller(k[CLIP], larger(-k[CLIP], v));
    }
}

/* v: fluid as if it moved with the tank during this step, without gravity and pressure; walls with the velocity of this step. */
static void relative_velocity(const mps_stage *s, double *v)
{
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        for (int d = 0; d < s->dim; d++) {
            const int64_t k = i * s->dim + d;
            v[k] = s->u[k] - (s->kind[i] == MPS_FLUID ? s->dt * (s->g[d] - s->tank_accel[k]) : 0.0);
        }
}

/* Share of a neighbour's velocity in that of the face between: by mass, so that water does not see what the air beside it does. With it
 * the divergence is the adjoint of a pressure gradient over rho_ij. */
static inline double face_share(const mps_stage *s, int64_t i, int64_t j)
{
    if (s->phase[i] == s->phase[j] || s->kind[j] != MPS_FLUID) return 1.0;
    return 2.0 * s->density[j] / (s->density[i] + s->density[j]);
}

/* Free slip: a wall particle keeps its velocity along its normal and takes that of the fluid about it along the face. */
MPS__ROW void slip_row(const int dim, const mps_stage *s, const double *v, int64_t i, double *slipped)
{
    const mps_stencil *t = s->near;
    double sum[3] = {0}, weight = 0, size = 0, largest = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_FLUID) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double mass = q.w * s->density[q.j];
        weight += mass;
        for (int d = 0; d < dim; d++) sum[d] += mass * (v[q.j * dim + d] - v[i * dim + d]);
    }
    const double *area = s->area + i * dim;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    for (int d = 0; d < dim; d++) largest = fmax(largest, fabs(area[d]));
    if (weight == 0 || size == 0) return;
    double normal = 0;
    for (int d = 0; d < dim; d++) normal += sum[d] / weight * area[d] / sqrt(size);
    /* where faces of the lattice meet (half a cell of each) there is no free direction in 2-D, and only the edge in 3-D */
    if (dim == 2 && size > 1.5 * largest * largest && size < 0.6 * s->dp * s->dp) return;
    for (int d = 0; d < dim; d++) slipped[i * dim + d] += sum[d] / weight - normal * area[d] / sqrt(size);
}

static void slip(const mps_stage *s, const double *v, double *slipped)
{
    const int dim = s->dim;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        for (int d = 0; d < dim; d++) slipped[i * dim + d] = v[i * dim + d];
        if (s->kind[i] == MPS_WALL && s->region[i] != MPS_REGION_DRY) MPS__ROW_CALL(s, slip_row, s, v, i, slipped);
    }
}

/* B_i with the shares of faces, for a particle beside another density. */
MPS__ROW void face_correction(const int dim, const mps_stage *s, int64_t i, double *b)
{
    const mps_stencil *t = s->near;
    double m[9] = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->region[t->col[p]] >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double share = dim / t->n0 * face_share(s, i, q.j) * q.w_r2;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) m[d * dim + e] += share * q.d[d] * q.d[e];
    }
    mps_matrix_inverse_bounded(dim, m, 0.5, b);
}

/* What the source of a fluid particle is made of. */
typedef struct fields {
    const double *v, *delta; /* [n*dim], [n] */
    double strain, own;      /* own: weight of a particle's own delta in the kernel mean */
} fields;

/* Divergence of a fluid particle, with B_i, less `strain` dt T: the move x + dt v changes volumes by dt div v - dt^2 T/2 + ..., so
 * div v = dt T/2 is wanted after the step; before it strain = 1/gain - 1/2 asks for T beyond the gain as well. With zero instead every
 * strained particle is compressed at the rate (1/gain - 1/2) dt T and blown up again by delta against the pressure. Also the kernel mean of delta over
 * the fluid: its noise at the grid scale must not reach the pressure. */
MPS__ROW double fluid_divergence(const int dim, const mps_stage *stage, const fields *of, int64_t i, double *deviation)
{
    const mps_stage copy = *stage, *s = &copy;
    const mps_stencil near = *s->near, *t = &near;
    const double *v = of->v, *delta = of->delta, self = of->own;
    double g[9] = {0}, sum = 0, own[9]; /* g = sum w (v_j - v_i) (x) r_ij */
    double deltas = self * delta[i], weight = self;
    bool mixed = false;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const bool fluid = s->kind[t->col[p]] == MPS_FLUID, apart = s->region[t->col[p]] >= MPS_REGION_SPRAY;
        if (apart && !fluid) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (fluid) {
            deltas += q.w * delta[q.j];
            weight += q.w;
        }
        if (apart) continue;
        const double share = face_share(s, i, q.j), w = share * q.w_r2;
        mixed = mixed || share != 1.0;
        for (int d = 0; d < dim; d++) {
            const double rate = w * (v[q.j * dim + d] - v[i * dim + d]);
            for (int e = 0; e < dim; e++) g[d * dim + e] += rate * q.d[e];
        }
    }
    *deviation = deltas / weight;
    const double *b = s->correction + i * dim * dim;
    if (mixed) {
        face_correction(dim, stage, i, own);
        b = own;
    }
    double a[9] = {0}, square = 0; /* a = grad v */
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++)
            for (int f = 0; f < dim; f++) a[d * dim + e] += dim / t->n0 * g[d * dim + f] * b[f * dim + e];
    for (int d = 0; d < dim; d++) {
        sum += a[d * dim + d];
        for (int e = 0; e < dim; e++) square += a[d * dim + e] * a[e * dim + d];
    }
    return sum - of->strain * s->dt * square;
}

/* Speed below which a step is 0.06 tau_g; beyond it 0.3 dp/u. */
static inline double calm_speed(const mps_stage *s)
{
    return 0.3 / 0.06 * s->velocity_scale;
}

/* Largest speed against a wall particle of the fluid about it that is as dense as the wall's row, calm water's at least. */
MPS__ROW double wall_speed(const int dim, const mps_stage *s, const double *v, int64_t i)
{
    const mps_stencil *t = s->near;
    double most = calm_speed(s) * calm_speed(s);
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->density[j] < 0.5 * s->density_smooth[i] || s->region[j] >= MPS_REGION_SPRAY) continue;
        double square = 0;
        for (int d = 0; d < dim; d++) square += (v[j * dim + d] - v[i * dim + d]) * (v[j * dim + d] - v[i * dim + d]);
        most = fmax(most, square);
    }
    return sqrt(most);
}

/* Divergence of the half cell of a wall particle; weights as in its row of the pressure equation. Where gas and water share the cell, gas
 * counts with the speed of the water at most: one that shoots along the wall would set the pressure of the water there. */
MPS__ROW double wall_divergence(const int dim, const mps_stage *s, const double *v, int64_t i, double wall_factor)
{
    const mps_stencil *t = s->near;
    double sum = 0, limit = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->region[t->col[p]] >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double flux = 0, square = 0, share = 1.0;
        for (int d = 0; d < dim; d++) {
            const double rate = v[q.j * dim + d] - v[i * dim + d];
            flux += rate * q.d[d];
            square += rate * rate;
        }
        if (s->kind[q.j] == MPS_FLUID && s->density[q.j] < 0.5 * s->density_smooth[i]) {
            if (limit == 0) limit = wall_speed(dim, s, v, i);
            if (square > limit * limit) share = limit / sqrt(square);
        }
        sum += q.w_r2 * flux * (s->kind[q.j] == MPS_WALL ? wall_factor * fmin(s->wet[i], s->wet[q.j]) : share);
    }
    return dim / t->n0 * sum;
}

/* 1/tau, up to 1/tau_g where delta is beyond `firm`, and up to `most` more where it is beyond `torn`. */
static inline double relaxation(const double *k, double delta, double open, double most)
{
    const double square = delta * delta / (k[FIRM] * k[FIRM]), torn = delta * delta / (k[TORN] * k[TORN]);
    return smaller(1.0, (open + square * square) / k[TAU]) + smaller(1.0, torn * torn) * most;
}

/* Share of the source that a step asks for, by density: 1 for the lightest fluid, `heavy` for the heaviest. */
typedef struct pacing {
    double lightest, span, heavy;
} pacing;

static pacing set_pace(const mps_stage *s, double on)
{
    double lightest = INFINITY, heaviest = 0, dense = 0, any = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        lightest = smaller(lightest, s->density[i]);
        heaviest = larger(heaviest, s->density[i]);
    }
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->region[i] >= MPS_REGION_SURFACE) continue;
        double square = 0;
        for (int d = 0; d < s->dim; d++) square += s->u[i * s->dim + d] * s->u[i * s->dim + d];
        any = larger(any, square);
        if (s->density[i] > lightest) dense = larger(dense, square);
    }
    const double share = fmax(sqrt(dense), calm_speed(s)) / fmax(sqrt(any), calm_speed(s));
    return (pacing){lightest, heaviest - lightest, heaviest > lightest ? 1.0 - on * (1.0 - share) : 1.0};
}

static inline double row_pace(const pacing *p, const mps_stage *s, int64_t i)
{
    if (p->heavy == 1.0) return 1.0;
    const double rho = s->kind[i] == MPS_FLUID ? s->density[i] : s->density_smooth[i];
    return 1.0 - (1.0 - p->heavy) * (rho - p->lightest) / p->span;
}

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    double *delta = mps_stage_scratch(s, s->n), *v = mps_stage_scratch(s, s->n * s->dim), *w = mps_stage_scratch(s, s->n * s->dim);
    double *is = mps_stage_scratch(s, s->n), *solid = mps_stage_scratch(s, s->n);
    if (!delta || !v || !w || !is || !solid) return 1;
    for (int64_t i = 0; i < s->n; i++) is[i] = s->kind[i] != MPS_FLUID;
    mps_op_volume_sum(s->far, is, solid);
    const double rate = s->velocity_scale / s->dp, over = 1.0 / s->dt;
    const mps_stencil *t = s->near;
    const fields f = {.v = w,
                      .delta = delta,
                      .strain = k[STRAIN] * (0.5 + k[FORWARD] * (1.0 / k[GAIN] - 1.0)),
                      .own = 0.5 * mps_kernel_weight(&t->kernel, t->kernel.id == MPS_KERNEL_IMPROVED ? 0.0 : 0.5 * s->dp, t->re)};
    terms->gain = k[GAIN];
    terms->radius = MPS_NEAR;
    const pacing pace = set_pace(s, k[PACE]);
    const double on = k[START] > 0 ? smaller(1.0, s->t * rate / k[START]) : 1.0;
    volume_deviation(k, s, delta);
    relative_velocity(s, v);
    slip(s, v, w);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        for (int d = 0; d < s->dim; d++) terms->body[i * s->dim + d] += s->g[d] - s->tank_accel[i * s->dim + d];
        if (s->region[i] >= MPS_REGION_SURFACE) continue;
        const double share = row_pace(&pace, s, i);
        if (s->kind[i] == MPS_FLUID) {
            double mean;
            const double divergence = MPS__ROW_CALL(s, fluid_divergence, s, &f, i, &mean);
            const double back = on * rate *
                                relaxation(k, mean, larger(0.0, 1.0 - 2.0 * k[ASIDE] * solid[i]), share * k[RAPID] / (s->dt * rate)) * mean;
            terms->rhs[i] += share * over * (back - divergence);
        } else {
            terms->rhs[i] -= share * over * MPS__ROW_CALL(s, wall_divergence, s, w, i, terms->wall_factor);
        }
    }
    return 0;
}

const mps_model_ops mps__source_volume = {.struct_size = sizeof(mps_model_ops),
                                          .api = MPS_MODEL_API,
                                          .name = "source.volume",
                                          .order = 500,
                                          .setting_count = 11,
                                          .settings = settings,
                                          .source = source};
