/* SPDX-License-Identifier: BSD-3-Clause */
/* Particle shifting toward an even lattice:
 *   s_i = -c dt (U_g + max_j |u_j - u_i|) l D/n0 sum w r_ij  over all kinds,  w = W/r^2,
 * at most `limit` l, l the spacing, U_g the mps_view.velocity_scale. In the first two layers of a
 * free surface the part along the normal of the surface is removed: it would expand the fluid.
 *
 * Near walls and in corners of calm water, sum w r_ij would push the fluid forever, against the
 * volume term: a disordered lattice presses on an ordered one. So the fraction `filter` of its
 * kernel mean is subtracted from the part with U_g, which keeps its variation from particle to
 * particle. The part with the strain rate is not filtered: it repairs the lattice in violent flow.
 * With `calm` U_g is at most that many relative speeds max_j |u_j - u_i|: in fluid at rest the
 * lattice does not degrade, and a shift only drives a flow that reverses it.
 *
 * Beside another density the component normal to the interface is removed from the U_g part too:
 * otherwise the lattices of both fluids would press on each other, lift the heavy one, and work
 * against interface waves.
 *
 * With `transport` the velocity is advected by the shift: u += s.grad u over fluid of the same
 * phase, within the range of the velocities of its neighbours. Over all neighbours, or without
 * bounds, a single droplet would accelerate itself. */
#include "helpers.h"
#include "walls.h"

enum { STRENGTH, LIMIT, TRANSPORT, FILTER, CALM, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [STRENGTH] = {"strength", "-", "c, strength of the shifting", MPS_TYPE_REAL, 1.0, 0.0, 10.0},
    [LIMIT] = {"limit", "dp", "Largest shift of a step", MPS_TYPE_REAL, 0.05, 0.0, 0.5},
    [TRANSPORT] = {"transport", "-", "1: shifts move the velocity along", MPS_TYPE_FLAG, 1.0, 0.0,
                   1.0},
    [FILTER] = {"filter", "-", "Share of the mean over neighbours that is removed in calm water",
                MPS_TYPE_REAL, 0.8, 0.0, 1.0},
    [CALM] = {"calm", "-", "Most that U_g counts, in relative speeds of the neighbours; 0: whole",
              MPS_TYPE_REAL, 0.0, 0.0, 1000.0}};

enum { VELOCITY, DENSITY, REGION, ASYMMETRY, DISPLACEMENT, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
                                   [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [ASYMMETRY] = {"asymmetry", MPS_USE_NEIGHBOURS},
                                   [DISPLACEMENT] = {"displacement", MPS_USE_CHANGE}};

/* Distance from a wall [dp] below which shifts do not move particles towards it. Particles in the
 * nearer half, including spray, are moved out of it. */
static const double wall_distance = 0.5;

typedef struct fields {
    double *velocity, *displacement;
    const double *asymmetry, *density;
    const int32_t *region;
    double *even; /* [n*dim] sum w r_ij over all kinds */
    double *du;   /* [n*dim] change of the velocity */
} fields;

/* Sums of one pass over the pairs of a particle. */
typedef struct pair_sums {
    double mean[3], weight; /* kernel sums over inner fluid: of `even`, of 1 */
    double most;            /* largest |u_j - u_i|^2 of the fluid */
    double m[9], g[9];      /* sums of w r_ij (x) r_ij and w (u_j - u_i) (x) r_ij, same phase */
    double low[3], high[3]; /* range of u_j - u_i, same phase */
    double even[3];         /* of i itself */
    bool solids;            /* solids are among the pairs */
} pair_sums;

/* Normal of the free surface near i: its own asymmetry, or the mean over its surface neighbours.
 * Not a unit vector. */
MPS_ROW void surface_normal(const int dim, const mps_view *view, const fields *f, int64_t i,
                            double n[3])
{
    const mps_stencil *t = &view->near;
    const double *a = f->asymmetry;
    const int32_t *region = f->region;
    for (int d = 0; d < dim; d++)
        n[d] = mps_region_of(region, i) == MPS_REGION_SURFACE ? a[i * dim + d] : 0.0;
    if (mps_region_of(region, i) != MPS_REGION_NEAR) return;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_region_of(region, j) != MPS_REGION_SURFACE) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        for (int d = 0; d < dim; d++) n[d] += w * a[j * dim + d];
    }
}

/* Unit normal of the interface between two densities beside i. @return 0: no interface, 1:
 * practically plane */
MPS_ROW double interface_normal(const int dim, const mps_view *view, const fields *f, int64_t i,
                                double n[3])
{
    const mps_stencil *t = &view->near;
    double size = 0, length = 0;
    for (int d = 0; d < dim; d++) n[d] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(view, j) || f->density[j] == f->density[i]) continue;
        if (mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        length += q.w * q.r;
        for (int d = 0; d < dim; d++) n[d] += q.w * q.d[d];
    }
    for (int d = 0; d < dim; d++) size += n[d] * n[d];
    if (!(size > 0)) return 0;
    for (int d = 0; d < dim; d++) n[d] /= sqrt(size);
    return mps_smaller(1.0, 2.0 * sqrt(size) / length);
}

/* Fills `even`. */
MPS_ROW void add_even(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    if (!mps_is_fluid(view, i) || mps_region_of(f->region, i) == MPS_REGION_SPRAY) return;
    const mps_stencil *t = &view->near;
    double sum[3] = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++) sum[d] += q.w_r2 * q.d[d];
    }
    for (int d = 0; d < dim; d++) f->even[i * dim + d] = sum[d];
}
MPS_ROWS(add_even_rows, add_even, fields)

MPS_ROW void collect(const int dim, const mps_view *view, const fields *f, int64_t i, pair_sums *c)
{
    const mps_stencil *t = &view->near;
    const double *all = f->velocity, *u = all + i * dim, *even = f->even;
    *c = (pair_sums){0};
    for (int d = 0; d < dim; d++) c->even[d] = even[i * dim + d];
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (!mps_is_fluid(view, mps_stencil_column(t, p))) {
            c->solids = true;
            continue;
        }
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double v[3], v2 = 0;
        for (int d = 0; d < dim; d++) {
            v[d] = all[q.j * dim + d] - u[d];
            v2 += v[d] * v[d];
        }
        c->most = mps_larger(c->most, v2);
        if (mps_region_of(f->region, q.j) < MPS_REGION_SURFACE) {
            c->weight += q.w;
            for (int d = 0; d < dim; d++) c->mean[d] += q.w * even[q.j * dim + d];
        }
        if (view->phase[q.j] != view->phase[i] || mps_region_of(f->region, q.j) == MPS_REGION_SPRAY)
            continue;
        for (int d = 0; d < dim; d++) {
            c->low[d] = mps_smaller(c->low[d], v[d]);
            c->high[d] = mps_larger(c->high[d], v[d]);
            for (int e = 0; e < dim; e++) c->g[d * dim + e] += q.w_r2 * v[d] * q.d[e];
            for (int e = d; e < dim; e++) c->m[d * dim + e] += q.w_r2 * q.d[d] * q.d[e];
        }
    }
}

/* Removes from v its part normal to the interface, except that of the strain rate, torn * even. */
MPS_ROW void along_interface(const int dim, const mps_view *view, const fields *f, int64_t i,
                             double torn, const double *even, double v[3])
{
    double n[3], across = 0;
    const double share = interface_normal(dim, view, f, i, n);
    if (share == 0) return;
    for (int d = 0; d < dim; d++) across += n[d] * (v[d] - torn * even[d]);
    for (int d = 0; d < dim; d++) v[d] -= share * across * n[d];
}

/* v: out, shift of i without walls */
MPS_ROW void shift_of(const int dim, const mps_view *view, const fields *f, int64_t i,
                      const pair_sums *sums, double v[3])
{
    const double *k = view->setting;
    const double c = -k[STRENGTH] * view->dt * view->dp * dim / view->near.n0;
    const double relative = sqrt(sums->most), whole = view->velocity_scale;
    const double calm = c * (k[CALM] > 0 ? mps_smaller(whole, k[CALM] * relative) : whole);
    const double torn = c * relative;
    const double smooth = sums->weight > 0 ? k[FILTER] * calm / sums->weight : 0;
    double n[3] = {0}, n2 = 0, vn = 0, v2 = 0;
    for (int d = 0; d < dim; d++) v[d] = (calm + torn) * sums->even[d] - smooth * sums->mean[d];
    if (view->phases > 1) along_interface(dim, view, f, i, torn, sums->even, v);
    surface_normal(dim, view, f, i, n);
    for (int d = 0; d < dim; d++) {
        n2 += n[d] * n[d];
        vn += n[d] * v[d];
    }
    for (int d = 0; d < dim; d++) {
        if (n2 > 0) v[d] -= vn / n2 * n[d];
        v2 += v[d] * v[d];
    }
    const double limit = k[LIMIT] * view->dp;
    if (v2 > limit * limit)
        for (int d = 0; d < dim; d++) v[d] *= limit / sqrt(v2);
}

/* du = s.grad u at i, between the smallest and the largest difference of its neighbours. */
MPS_ROW void transport(const int dim, const mps_view *view, const pair_sums *sums,
                       const double *shift, double *du)
{
    const double c = dim / view->near.n0;
    double m[9], b[9];
    for (int d = 0; d < dim; d++)
        for (int e = d; e < dim; e++) m[d * dim + e] = m[e * dim + d] = c * sums->m[d * dim + e];
    mps_matrix_inverse_bounded(dim, m, 0.25, b);
    for (int d = 0; d < dim; d++) {
        double v = 0;
        for (int e = 0; e < dim; e++)
            for (int f = 0; f < dim; f++) v += c * sums->g[d * dim + e] * b[e * dim + f] * shift[f];
        du[d] = mps_smaller(sums->high[d], mps_larger(sums->low[d], v));
    }
}

/* Displacement of a particle, and with `transport` the change of its velocity. Everything is
 * inlined into one function, so that the sums stay in registers. */
MPS_ROW void move(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    if (!mps_is_fluid(view, i)) return;
    const double *k = view->setting;
    const bool spray = mps_region_of(f->region, i) == MPS_REGION_SPRAY;
    pair_sums sums = {.solids = true};
    double v[3] = {0};
    if (!spray) {
        collect(dim, view, f, i, &sums);
        shift_of(dim, view, f, i, &sums, v);
    }
    if (sums.solids)
        mps__walls_keep_off(dim, view, wall_distance * view->dp, k[LIMIT] * view->dp, NULL, i, v);
    if (k[TRANSPORT] > 0 && !spray) transport(dim, view, &sums, v, f->du + i * dim);
    for (int d = 0; d < dim; d++) f->displacement[i * dim + d] += v[d];
}
MPS_ROWS(move_rows, move, fields)

MPS_ROW void add_change(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    (void)view;
    for (int d = 0; d < dim; d++) f->velocity[i * dim + d] += f->du[i * dim + d];
}
MPS_ROWS(add_change_rows, add_change, fields)

static int shift_fluid(mps_stage *s)
{
    const mps_view *view = s->view;
    fields f = {.velocity = s->data[VELOCITY],
                .displacement = s->data[DISPLACEMENT],
                .asymmetry = s->data[ASYMMETRY],
                .density = s->data[DENSITY],
                .region = s->data[REGION],
                .even = mps_stage_scratch(s, view->n * view->dim),
                .du = mps_stage_scratch(s, view->n * view->dim)};
    if (!f.even || !f.du) return 1;
    mps_stage_rows(s, &add_even_rows, &f);
    if (mps_stage_refresh(s, 1, &(mps_shared){f.even, view->dim, MPS_TYPE_REAL})) return 1;
    mps_stage_rows(s, &move_rows, &f);
    mps_stage_rows(s, &add_change_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_SHIFT, .use_count = USES, .uses = uses, .run = shift_fluid, .device = 1}};

const mps_model_ops mps__shift_tangential = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "shift.tangential",
    .help = "Shifts particles toward an even lattice, along free surfaces only",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};
