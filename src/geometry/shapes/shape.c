/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of solids: value, slope, and projection onto the surface, its edges and
 * corners. */
#include "contour.h"
#include <math.h>
#include <mps/operators.h>
#include <string.h>

/* Half the step of central differences [dp]; distance within which edges are searched [dp];
 * distance from the surface up to which the slope is used [dp]. */
static const double span = 0.02, look = 0.3, band = 4.0;
static const double most_points = 1e8;

double mps__shape_at(const mps__shape *s, const double x[3])
{
    if (s->distance) return s->sign * s->distance(s->user, x);
    const double r = s->mesh ? mps__mesh_distance(s->mesh, x, NULL, NULL) : s->dp;
    /* a mesh made from `inside` may have open ends: away from it `inside` is more reliable than the
     * mesh */
    if (!s->inside || (s->mesh && fabs(r) < 0.5 * s->dp)) return r;
    return (s->inside(s->user, x) != 0) == (s->sign < 0) ? fabs(r) : -fabs(r);
}

double mps__shape_true(const mps__shape *s, const double x[3], double n[3])
{
    double g[3] = {0, 0, 0}, size2 = 0, at[3] = {x[0], x[1], x[2]};
    if (s->mesh && n) {
        const double r = mps__mesh_distance(s->mesh, x, NULL, n), given = mps__shape_at(s, x);
        for (int d = 0; d < 3 && r * given < 0; d++) n[d] = -n[d];
        return given;
    }
    if (s->mesh) return mps__shape_at(s, x);
    const double h = span * s->dp;
    for (int d = 0; d < s->dim; d++) {
        at[d] = x[d] + h;
        g[d] = mps__shape_at(s, at);
        at[d] = x[d] - h;
        g[d] = (g[d] - mps__shape_at(s, at)) / (2 * h);
        at[d] = x[d];
        size2 += g[d] * g[d];
    }
    const double size = sqrt(size2), value = mps__shape_at(s, x);
    for (int d = 0; n && d < 3; d++) n[d] = size > 0 ? g[d] / size : 0;
    return value / fmax(size, 1e-3); /* at ridges the differences are too small */
}

bool mps__shape_project(const mps__shape *s, double x[3], double reach)
{
    double from[3], n[3];
    memcpy(from, x, sizeof from);
    if (s->mesh) return fabs(mps__mesh_distance(s->mesh, from, x, NULL)) <= reach;
    for (int k = 0; k < 8; k++) {
        const double r = mps__shape_true(s, x, n);
        if (!isfinite(r)) return false;
        if (fabs(r) < 1e-7 * s->dp) break;
        for (int d = 0; d < 3; d++) x[d] -= r * n[d];
    }
    double moved2 = 0;
    for (int d = 0; d < 3; d++) moved2 += (x[d] - from[d]) * (x[d] - from[d]);
    return moved2 <= reach * reach;
}

/* One step towards the common point of all tangent planes around x. */
static bool feature_step(const mps__shape *s, double x[3])
{
    double m[9] = {0}, b[9], rhs[3] = {0, 0, 0};
    const double share = 1.0 / (2 * s->dim);
    for (int k = 0; k < 2 * s->dim; k++) {
        double n[3], at[3] = {x[0], x[1], x[2]}, away = 0;
        at[k / 2] += (k % 2 ? 1 : -1) * look * s->dp;
        const double r = mps__shape_true(s, at, n);
        if (!isfinite(r)) return false;
        for (int d = 0; d < s->dim; d++) away += n[d] * (x[d] - at[d]);
        for (int d = 0; d < s->dim; d++) {
            rhs[d] -= share * n[d] * (r + away);
            for (int e = 0; e < s->dim; e++) m[d * s->dim + e] += share * n[d] * n[e];
        }
    }
    mps_matrix_inverse_bounded(s->dim, m, 0.1, b);
    for (int d = 0; d < s->dim; d++)
        for (int e = 0; e < s->dim; e++) x[d] += b[d * s->dim + e] * rhs[e];
    return true;
}

bool mps__shape_project_feature(const mps__shape *s, double x[3])
{
    for (int k = 0; k < 4; k++)
        if (!feature_step(s, x)) return false;
    return true;
}

/* ---- distances on a lattice ---- */

/* On a ridge, e.g. on the diagonal of a corner, central differences give too small a slope: the
 * steeper of two positions is used. */
static double off_ridges(const mps__shape *s, const double x[3], double raw)
{
    const double aside[3] = {x[0] + 0.13 * s->dp, x[1] + 0.05 * s->dp,
                             s->dim == 3 ? x[2] - 0.09 * s->dp : 0};
    const double here = mps__shape_true(s, x, NULL), given = mps__shape_at(s, aside),
                 there = mps__shape_true(s, aside, NULL);
    if (given == 0 || s->mesh) return here;
    return fabs(raw * there / given) < fabs(here) ? raw * there / given : here;
}

mps_status mps__distances_make(mps__distances *f, mps__context *context, const mps__shape *s,
                               const double *lo, const double *hi)
{
    double along[3], points = 1;
    *f = (mps__distances){.dp = s->dp, .dim = s->dim, .n = {1, 1, 1}};
    for (int d = 0; d < s->dim; d++) {
        along[d] = ceil((hi[d] - lo[d]) / s->dp - 1e-6) + 1;
        points *= along[d];
    }
    const int most = mps__longest(along, s->dim);
    MPS__CHECK(
        context, points < most_points,
        "the solid's box is %g m long along axis %d: too many lattice points of spacing %g m",
        hi[most] - lo[most], most, s->dp);
    for (int d = 0; d < s->dim; d++) {
        f->lo[d] = lo[d];
        f->n[d] = (int64_t)along[d];
    }
    f->value = mps__alloc(context, (int64_t)points, sizeof *f->value);
    if (!f->value) return MPS_E_NOMEM;
    for (int64_t k = 0; k < (int64_t)points; k++) {
        double x[3];
        mps__distances_place(f, k, x);
        const double raw = mps__shape_at(s, x);
        f->value[k] = fabs(raw) < band * s->dp ? off_ridges(s, x, raw) : raw;
        MPS__CHECK(context, isfinite(raw),
                   "the solid's distance is %g at (%g, %g, %g) m: must be finite", raw, x[0], x[1],
                   x[2]);
        MPS__CHECK(context, isfinite(f->value[k]),
                   "the solid's distance is not finite near (%g, %g, %g) m", x[0], x[1], x[2]);
    }
    return MPS_OK;
}

void mps__distances_free(mps__distances *f, mps__context *context)
{
    mps__free(context, f->value);
    f->value = NULL;
}

void mps__distances_place(const mps__distances *f, int64_t point, double x[3])
{
    for (int d = 0; d < 3; d++) {
        x[d] = d < f->dim ? f->lo[d] + f->dp * (double)(point % f->n[d]) : 0;
        point /= f->n[d];
    }
}

/* Lattice points around a position: the lowest one, and the relative position, 0..1. */
typedef struct between {
    int64_t k[3];
    double t[3];
} between;

static bool find_between(const mps__distances *f, const double x[3], between *b)
{
    *b = (between){.k = {0}};
    for (int d = 0; d < f->dim; d++) {
        const double q = (x[d] - f->lo[d]) / f->dp, last = (double)(f->n[d] - 1);
        if (!(q > -1e-6 && q < last + 1e-6)) return false;
        b->k[d] = (int64_t)fmin(fmax(floor(q), 0), last - 1);
        b->t[d] = fmin(fmax(q - (double)b->k[d], 0), 1);
    }
    return true;
}

/* Index of a corner of the cell at k, by bits. */
static int64_t corner_place(const mps__distances *f, const int64_t k[3], int corner)
{
    int64_t place = 0, stride = 1;
    for (int d = 0; d < f->dim; d++) {
        place += stride * (k[d] + (corner >> d & 1));
        stride *= f->n[d];
    }
    return place;
}

bool mps__distances_at(const mps__distances *f, const double x[3], double *value)
{
    between b;
    double sum = 0;
    if (!find_between(f, x, &b)) return false;
    for (int corner = 0; corner < 1 << f->dim; corner++) {
        double weight = 1;
        for (int d = 0; d < f->dim; d++) weight *= corner >> d & 1 ? b.t[d] : 1 - b.t[d];
        sum += weight * f->value[corner_place(f, b.k, corner)];
    }
    *value = sum;
    return true;
}

/* Sum of the second differences at the corners of a cell: < 0 where faces meet around the
 * liquid, > 0 where they meet around the solid. */
static double bend(const mps__distances *f, const int64_t k[3])
{
    double sum = 0;
    for (int corner = 0; corner < 1 << f->dim; corner++) {
        const int64_t place = corner_place(f, k, corner);
        int64_t stride = 1;
        for (int d = 0; d < f->dim; d++) {
            const int64_t at = k[d] + (corner >> d & 1);
            if (at > 0 && at < f->n[d] - 1)
                sum += f->value[place - stride] - 2 * f->value[place] + f->value[place + stride];
            stride *= f->n[d];
        }
    }
    return sum;
}

/* Linear in each of the simplices around the diagonal of the cell that begins at corner `from`. */
static double along_diagonal(const mps__distances *f, const between *b, int from)
{
    double t[3], value = f->value[corner_place(f, b->k, from)];
    int corner = from;
    for (int d = 0; d < f->dim; d++) t[d] = from >> d & 1 ? 1 - b->t[d] : b->t[d];
    /* next the axis with the largest remaining distance */
    for (int step = 0; step < f->dim; step++) {
        int axis = 0;
        double most = -1;
        for (int d = 0; d < f->dim; d++)
            if ((corner >> d & 1) == (from >> d & 1) && t[d] > most) most = t[axis = d];
        const int64_t here = corner_place(f, b->k, corner);
        corner ^= 1 << axis;
        value += t[axis] * (f->value[corner_place(f, b->k, corner)] - f->value[here]);
    }
    return value;
}

bool mps__distances_sharp(const mps__distances *f, const double x[3], double *value)
{
    between b;
    if (!find_between(f, x, &b)) return false;
    const bool about_liquid = bend(f, b.k) < 0;
    double best = about_liquid ? -INFINITY : INFINITY;
    for (int from = 0; from < 1 << (f->dim - 1); from++) {
        const double v = along_diagonal(f, &b, from);
        best = about_liquid ? fmax(best, v) : fmin(best, v);
    }
    *value = best;
    return true;
}
