/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall particles: vertices of the contour - corners first, then edges, then vertices on the
 * lattice - are thinned to a distance, then moved apart along the surface. A flat face on the
 * lattice gets exactly the lattice points. Each patch of area is assigned to the nearest
 * particle. */
#include "sampling.h"
#include <math.h>
#include <mps/numbers.h>
#include <string.h>

enum { SWEEPS = 40, ROUNDS = 4, ODD = 4 };

/* In spacings: distance to existing particles, and the part of the surface that they occupy; first
 * distance tried for thinning, and its limits; range and length of the repulsion; half the width of
 * a gap that gets a particle, in 2-D and 3-D. */
static const double clearance = 0.7, beside = 0.5, widest = 0.9, longest = 1.1, narrowest = 0.6,
                    step = 0.02, range = 1.6, push = 0.35, hole[2] = {0.5, 0.7};
/* Target number of wall particles, relative to the surface over dp^(dim-1). */
static const double least = 0.98, most = 1.05;
/* Distance of dummies to walls and to each other; depth to which a wall must be solid. */
static const double wall_clearance = 0.7, layer_clearance = 0.75, gap_clearance = 0.8,
                    thin_depth = 2.99;

static bool is_kept(const mps__samples *s, const double x[3])
{
    for (int d = 0; d < s->shape->dim; d++)
        if (x[d] < s->keep_lo[d] || x[d] > s->keep_hi[d]) return false;
    return true;
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* ---- thinning ---- */

static mps_status add_wall(mps__samples *s, const mps__vertex *v)
{
    MPS__TRY(mps__grow(s->context, (void **)&s->feature, &s->feature_capacity, s->wall.count,
                       s->wall.count + 1, sizeof *s->feature));
    s->feature[s->wall.count] = v->feature;
    return mps__buckets_add(&s->wall, v->x);
}

/* Accept vertices of one feature whose cells are off the lattice along `odd` axes. */
static mps_status take_vertices(mps__samples *s, int32_t feature, int32_t odd, double distance)
{
    const double dp = s->shape->dp;
    for (int64_t k = 0; k < s->contour->vertices; k++) {
        const mps__vertex *v = &s->contour->vertex[k];
        if (v->feature != feature || v->odd != odd || !is_kept(s, v->x)) continue;
        if (s->others && mps__buckets_nearest(s->others, v->x, clearance * dp, NULL) >= 0) continue;
        if (mps__buckets_nearest(&s->wall, v->x, distance * dp, NULL) < 0) MPS__TRY(add_wall(s, v));
    }
    return MPS_OK;
}

/* A point between the vertices, if it is far enough from all particles. */
static mps_status take_patch(mps__samples *s, int64_t k, double distance)
{
    const double dp = s->shape->dp;
    mps__vertex v = {.feature = MPS__FACE};
    memcpy(v.x, s->contour->patch[k].x, sizeof v.x);
    if (!is_kept(s, v.x) || mps__buckets_nearest(&s->wall, v.x, distance * dp, NULL) >= 0)
        return MPS_OK;
    if (s->others && mps__buckets_nearest(s->others, v.x, clearance * dp, NULL) >= 0) return MPS_OK;
    return mps__shape_project(s->shape, v.x, dp) ? add_wall(s, &v) : MPS_OK;
}

/* In 2-D the vertices are too far apart: points between those on the lattice are tried as well. */
static mps_status take_patches(mps__samples *s, double distance)
{
    for (int64_t k = 0; k < s->contour->patches; k++) MPS__TRY(take_patch(s, k, distance));
    return MPS_OK;
}

/* Area for wall particles, and their number; existing particles nearby occupy a part of it. */
static void find_surface(mps__samples *s)
{
    const double dp = s->shape->dp;
    double taken = 0;
    s->surface = 0;
    for (int64_t k = 0; k < s->contour->patches; k++) {
        const mps__patch *p = &s->contour->patch[k];
        if (!is_kept(s, p->x)) continue;
        s->surface += length_of(p->area);
        if (s->others && mps__buckets_nearest(s->others, p->x, beside * dp, NULL) >= 0)
            taken += length_of(p->area);
    }
    /* in 2-D the ends of a surface need particles: its faces extend to their feet on existing
     * ones */
    if (s->shape->dim == 2) taken = fmax(0, taken - 2 * beside * dp);
    s->wanted = (s->surface - taken) / mps_pow(dp, s->shape->dim - 1);
}

/* Thin the vertices to a distance. */
static mps_status thin_to(mps__samples *s, const double *lo, const double *hi, double distance)
{
    const int dim = s->shape->dim;
    mps__buckets_free(&s->wall);
    MPS__TRY(mps__buckets_init(&s->wall, s->context, dim, lo, hi, s->shape->dp));
    for (int32_t feature = MPS__CORNER; feature <= MPS__FACE; feature++)
        for (int32_t odd = 0; odd < (dim == 3 || feature < MPS__FACE ? ODD : 1); odd++)
            MPS__TRY(take_vertices(s, feature, odd, distance));
    return dim == 2 ? take_patches(s, distance) : MPS_OK;
}

/* The largest distance that leaves one particle for every dp^(dim-1) of the surface. Vertices are
 * dp/2 apart: at some distance the number of particles jumps, because all vertices of a face are
 * accepted; the distance before it leaves gaps for fill_holes(). */
static mps_status thin_out(mps__samples *s, const double *lo, const double *hi)
{
    double distance = widest;
    MPS__TRY(thin_to(s, lo, hi, distance));
    while ((double)s->wall.count > most * s->wanted && distance < longest) {
        distance += step;
        MPS__TRY(thin_to(s, lo, hi, distance));
    }
    while ((double)s->wall.count < least * s->wanted && distance > narrowest) {
        distance -= step;
        MPS__TRY(thin_to(s, lo, hi, distance));
        if ((double)s->wall.count <= most * s->wanted) continue;
        return thin_to(s, lo, hi, distance + step);
    }
    return MPS_OK;
}

/* A step near the golden section of n that visits all of 0 .. n - 1, each far from the previous
 * ones. */
static int64_t spread_step(int64_t n)
{
    for (int64_t k = (int64_t)(0.618 * (double)n); k > 1; k--) {
        int64_t a = n, b = k;
        while (b > 0) {
            const int64_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1) return k;
    }
    return 1;
}

/* Fill the largest gaps first, spread over the surface, until the number is reached. */
static mps_status fill_holes(mps__samples *s)
{
    const int64_t n = s->contour->patches, step_of = spread_step(n);
    for (double distance = widest; distance > hole[s->shape->dim - 2]; distance -= step)
        for (int64_t k = 0, at = 0; k < n; k++, at = (at + step_of) % n) {
            if ((double)s->wall.count >= s->wanted) return MPS_OK;
            MPS__TRY(take_patch(s, at, distance));
        }
    return MPS_OK;
}

/* ---- moving apart ---- */

/* Sum of the repulsion on one particle: corners are fixed, edges are pushed by corners and edges,
 * faces by all. */
typedef struct pushes {
    const mps__samples *s;
    int64_t self;
    double range, sum[3];
} pushes;

static void add_push(void *user, int64_t point, const double d[3], double r2)
{
    pushes *p = user;
    if (point == p->self || (p->self >= 0 && p->s->feature[point] > p->s->feature[p->self])) return;
    const double r = sqrt(r2), q = 1 - r / p->range;
    for (int a = 0; a < 3 && r > 0; a++) p->sum[a] -= q * q * d[a] / r;
}

static bool move_apart(const mps__samples *s, int64_t i, double x[3])
{
    const double dp = s->shape->dp;
    pushes p = {s, i, range * dp, {0, 0, 0}};
    memcpy(x, s->wall.x + 3 * i, 3 * sizeof *x);
    if (s->feature[i] == MPS__CORNER) return false;
    mps__buckets_visit(&s->wall, x, p.range, add_push, &p);
    p.self = -1;
    if (s->others) mps__buckets_visit(s->others, x, p.range, add_push, &p);
    double moved[3];
    for (int d = 0; d < 3; d++) moved[d] = x[d] + push * dp * p.sum[d];
    const bool found = s->feature[i] == MPS__EDGE ? mps__shape_project_feature(s->shape, moved)
                                                  : mps__shape_project(s->shape, moved, dp);
    double way[3];
    for (int d = 0; d < 3; d++) way[d] = moved[d] - x[d];
    if (!found || !(length_of(way) < 0.5 * dp) || !is_kept(s, moved)) return false;
    memcpy(x, moved, sizeof moved);
    return true;
}

/* One sweep: all particles use the positions before it. */
static mps_status sweep(mps__samples *s, const double *lo, const double *hi)
{
    mps__buckets next;
    mps_status status = mps__buckets_init(&next, s->context, s->shape->dim, lo, hi, s->shape->dp);
    if (status == MPS_OK) status = mps__buckets_reserve(&next, s->wall.count);
    for (int64_t i = 0; i < s->wall.count && status == MPS_OK; i++) {
        double x[3];
        move_apart(s, i, x);
        status = mps__buckets_add(&next, x);
    }
    if (status < 0) {
        mps__buckets_free(&next);
        return status;
    }
    mps__buckets_free(&s->wall);
    s->wall = next;
    return MPS_OK;
}

/* ---- areas and thickness ---- */

static mps_status share_area(mps__samples *s)
{
    s->area = mps__alloc(s->context, 3 * s->wall.count, sizeof *s->area);
    if (!s->area) return MPS_E_NOMEM;
    for (int64_t k = 0; k < s->contour->patches; k++) {
        const mps__patch *p = &s->contour->patch[k];
        if (!is_kept(s, p->x)) continue;
        const int64_t i = mps__buckets_nearest(&s->wall, p->x, 2 * s->shape->dp, NULL);
        for (int d = 0; d < 3 && i >= 0; d++) s->area[3 * i + d] += p->area[d];
    }
    return MPS_OK;
}

/* Whether the solid ends within 3 dp behind a wall particle. */
static void look_behind(mps__samples *s, int64_t i)
{
    const double dp = s->shape->dp, *x = s->wall.x + 3 * i;
    double n[3];
    if (s->feature[i] != MPS__FACE) return;
    mps__shape_true(s->shape, x, n);
    for (double depth = 0.5; depth < thin_depth + 0.5; depth += 0.5) {
        double at[3];
        for (int d = 0; d < 3; d++) at[d] = x[d] - fmin(depth, thin_depth) * dp * n[d];
        if (!(mps__shape_at(s->shape, at) > 0) || !is_kept(s, at)) continue;
        if (s->thin++ == 0) memcpy(s->thin_at, x, sizeof s->thin_at);
        return;
    }
}

mps_status mps__samples_walls(mps__samples *s, const double *lo, const double *hi)
{
    find_surface(s);
    MPS__TRY(thin_out(s, lo, hi));
    for (int k = 0; k < SWEEPS; k++) MPS__TRY(sweep(s, lo, hi));
    for (int round = 0; round < ROUNDS && (double)s->wall.count < least * s->wanted; round++) {
        MPS__TRY(fill_holes(s));
        for (int k = 0; k < SWEEPS; k++) MPS__TRY(sweep(s, lo, hi));
    }
    MPS__TRY(share_area(s));
    for (int64_t i = 0; i < s->wall.count; i++) look_behind(s, i);
    return mps__buckets_init(&s->dummy, s->context, s->shape->dim, lo, hi, s->shape->dp);
}

/* ---- dummies ---- */

/* Add a dummy if its distance to others is large enough. */
static mps_status offer_dummy(mps__samples *s, const double x[3], double spacing)
{
    const double dp = s->shape->dp;
    if (s->others && mps__buckets_nearest(s->others, x, clearance * dp, NULL) >= 0) return MPS_OK;
    if (!is_kept(s, x) || mps__buckets_nearest(&s->wall, x, wall_clearance * dp, NULL) >= 0)
        return MPS_OK;
    if (mps__buckets_nearest(&s->dummy, x, spacing * dp, NULL) >= 0) return MPS_OK;
    return mps__buckets_add(&s->dummy, x);
}

/* Straight behind the wall particles of faces, where the depth is correct. */
static mps_status place_layer(mps__samples *s, int32_t layer)
{
    const double dp = s->shape->dp;
    for (int64_t i = 0; i < s->wall.count; i++) {
        double n[3], at[3];
        if (s->feature[i] != MPS__FACE) continue;
        mps__shape_true(s->shape, s->wall.x + 3 * i, n);
        for (int d = 0; d < 3; d++) at[d] = s->wall.x[3 * i + d] - layer * dp * n[d];
        const double depth = -mps__shape_true(s->shape, at, NULL);
        if (fabs(depth - layer * dp) < 0.3 * dp) MPS__TRY(offer_dummy(s, at, layer_clearance));
    }
    return MPS_OK;
}

/* Lattice points at the correct depth that belong to the placed particles, if their distance to
 * others is large enough. */
static mps_status fill_gaps(mps__samples *s, int32_t layers, const mps__distances *lattice)
{
    const double dp = s->shape->dp, reach = (layers + 1) * dp;
    const int64_t points = lattice->n[0] * lattice->n[1] * lattice->n[2];
    for (int64_t k = 0; k < points; k++) {
        double x[3];
        if (lattice->value[k] > -0.5 * dp || lattice->value[k] < -(layers + 0.5) * dp) continue;
        mps__distances_place(lattice, k, x);
        if (mps__buckets_nearest(&s->wall, x, reach, NULL) >= 0)
            MPS__TRY(offer_dummy(s, x, gap_clearance));
    }
    return MPS_OK;
}

mps_status mps__samples_dummies(mps__samples *s, int32_t layers, const mps__distances *lattice)
{
    for (int32_t k = 1; k <= layers; k++) MPS__TRY(place_layer(s, k));
    return fill_gaps(s, layers, lattice);
}

void mps__samples_free(mps__samples *s)
{
    mps__buckets_free(&s->wall);
    mps__buckets_free(&s->dummy);
    mps__free(s->context, s->feature);
    mps__free(s->context, s->area);
}
