/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of boxes, polygons, cylinders and spheres. */
#include "form.h"
#include <math.h>
#include <string.h>

/* Combine the distances to two surfaces that bound a convex body, > 0 inside. */
static double meet(double a, double b)
{
    if (a < 0 && b < 0) return -hypot(a, b);
    return fmin(a, b);
}

static double in_box(const form *s, const double *x)
{
    double inside = INFINITY, outside = 0;
    for (int d = 0; d < s->dim; d++) {
        const double gap = fmin(x[d] - s->lo[d], s->hi[d] - x[d]);
        inside = fmin(inside, gap);
        if (gap < 0) outside += gap * gap;
    }
    return outside > 0 ? -sqrt(outside) : inside;
}

/* Squared distance of a point from an edge of a polygon. */
static double edge_distance2(const double *a, const double *b, const double *x)
{
    const double ex = b[0] - a[0], ey = b[1] - a[1], px = x[0] - a[0], py = x[1] - a[1];
    const double t = fmin(1, fmax(0, (px * ex + py * ey) / (ex * ex + ey * ey)));
    const double dx = px - t * ex, dy = py - t * ey;
    return dx * dx + dy * dy;
}

/* From the nearest edge, and the number of edges that a ray crosses. */
static double in_polygon(const form *s, const double *x)
{
    double least = INFINITY;
    bool inside = false;
    for (int32_t i = 0; i < s->points; i++) {
        const double *a = s->point[i], *b = s->point[(i + 1) % s->points];
        least = fmin(least, edge_distance2(a, b, x));
        if ((a[1] > x[1]) != (b[1] > x[1]) &&
            x[0] < a[0] + (x[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
            inside = !inside;
    }
    return inside ? sqrt(least) : -sqrt(least);
}

static double in_rod(const form *s, const double *x)
{
    double along = 0, length2 = 0, r2 = 0;
    for (int d = 0; d < 3; d++) {
        const double e = s->end[1][d] - s->end[0][d];
        length2 += e * e;
        along += e * (x[d] - s->end[0][d]);
    }
    const double length = sqrt(length2), t = along / length;
    for (int d = 0; d < 3; d++)
        r2 += pow(x[d] - s->end[0][d] - t * (s->end[1][d] - s->end[0][d]) / length, 2);
    return meet(s->radius - sqrt(r2), fmin(t, length - t));
}

static double in_tube(const form *s, const double *x)
{
    const int a = s->axis, i = a == 1 ? 0 : 1, j = a == 2 ? 0 : 2;
    const double along = x[a] - s->lo[a], u = x[i] - s->lo[i] - s->radius,
                 v = x[j] - 0.5 * (s->lo[j] + s->hi[j]);
    const double r = sqrt(u * u + v * v),
                 out = fmax(s->heads - along, along - s->heads - s->length);
    if (s->heads <= 0) return meet(s->radius - r, -out);
    if (out <= 0) return s->radius - r;
    /* value over gradient of the ellipsoid */
    const double value = hypot(out / s->heads, r / s->radius),
                 slope = hypot(out / (s->heads * s->heads), r / (s->radius * s->radius));
    return value * (1 - value) / slope;
}

static double in_ball(const form *s, const double *x)
{
    double r2 = 0;
    for (int d = 0; d < s->dim; d++) r2 += (x[d] - s->end[0][d]) * (x[d] - s->end[0][d]);
    return s->radius - sqrt(r2);
}

double mps__form_inside(const form *s, const double *x)
{
    double d;
    int k;
    switch (s->kind) {
    case FORM_POLYGON:
        k = s->sideways ? 2 : 0;
        d = in_polygon(s, (const double[]){x[k], x[1]});
        return s->dim == 3 ? meet(d, fmin(x[2 - k] - s->lo[2 - k], s->hi[2 - k] - x[2 - k])) : d;
    case FORM_ROD:
        return in_rod(s, x);
    case FORM_TUBE:
        return in_tube(s, x);
    case FORM_BALL:
        return in_ball(s, x);
    default:
        return in_box(s, x);
    }
}

double mps__form_container(void *user, const double *x)
{
    return mps__form_inside(user, x);
}

double mps__form_body(void *user, const double *x)
{
    return -mps__form_inside(user, x);
}

static void rod_box(form *s)
{
    double e[3], length2 = 0;
    for (int d = 0; d < 3; d++) e[d] = s->end[1][d] - s->end[0][d];
    for (int d = 0; d < 3; d++) length2 += e[d] * e[d];
    for (int d = 0; d < 3; d++) { /* half width of a disc along each axis */
        const double reach = s->radius * sqrt(fmax(0, 1 - e[d] * e[d] / length2));
        s->lo[d] = fmin(s->end[0][d], s->end[1][d]) - reach;
        s->hi[d] = fmax(s->end[0][d], s->end[1][d]) + reach;
    }
}

void mps__form_box(form *s)
{
    if (s->kind == FORM_ROD) rod_box(s);
    if (s->kind == FORM_BALL)
        for (int d = 0; d < 3; d++) {
            s->lo[d] = s->end[0][d] - s->radius;
            s->hi[d] = s->end[0][d] + s->radius;
        }
    for (int d = 0; s->kind == FORM_POLYGON && d < 2; d++) {
        const int k = d == 0 && s->sideways ? 2 : d;
        s->lo[k] = s->hi[k] = s->point[0][d];
        for (int32_t i = 1; i < s->points; i++) {
            s->lo[k] = fmin(s->lo[k], s->point[i][d]);
            s->hi[k] = fmax(s->hi[k], s->point[i][d]);
        }
    }
}

double mps__form_polygon_area(const form *s)
{
    double twice = 0;
    for (int32_t i = 0; i < s->points; i++) {
        const double *a = s->point[i], *b = s->point[(i + 1) % s->points];
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return 0.5 * twice;
}

void mps__form_polygon_clean(form *s)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < s->points; i++) {
        const double *last = kept ? s->point[kept - 1] : s->point[s->points - 1];
        if (s->points > 1 && last[0] == s->point[i][0] && last[1] == s->point[i][1]) continue;
        memmove(s->point[kept++], s->point[i], sizeof s->point[0]);
    }
    s->points = kept;
}

/* Twice the area of a triangle. */
static double turn(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Whether c is on the line segment from a to b. */
static bool is_on(const double *a, const double *b, const double *c, double area)
{
    return fabs(area) <= 1e-12 * (pow(b[0] - a[0], 2) + pow(b[1] - a[1], 2)) &&
           (c[0] - a[0]) * (c[0] - b[0]) + (c[1] - a[1]) * (c[1] - b[1]) <= 0;
}

/* Sides with a common point also meet elsewhere if one is on the other. */
static bool sides_meet(const form *s, int32_t i, int32_t j, double *at)
{
    const double *a = s->point[i], *b = s->point[(i + 1) % s->points], *c = s->point[j],
                 *d = s->point[(j + 1) % s->points];
    const double ca = turn(c, d, a), cb = turn(c, d, b), ac = turn(a, b, c), ad = turn(a, b, d);
    const double *touch = NULL;
    if (b != c && is_on(c, d, b, cb)) touch = b;
    if (b != c && is_on(a, b, c, ac)) touch = c;
    if (d != a && is_on(c, d, a, ca)) touch = a;
    if (d != a && is_on(a, b, d, ad)) touch = d;
    if (touch) memcpy(at, touch, 2 * sizeof *at);
    if (touch || b == c || d == a) return touch != NULL;
    if (!(ca * cb < 0 && ac * ad < 0)) return false;
    for (int k = 0; k < 2; k++) at[k] = a[k] + ca / (ca - cb) * (b[k] - a[k]);
    return true;
}

bool mps__form_polygon_crosses(const form *s, int32_t *side, double *at)
{
    for (int32_t i = 0; i < s->points; i++)
        for (int32_t j = i + 1; j < s->points; j++)
            if (sides_meet(s, i, j, at)) {
                side[0] = i;
                side[1] = j;
                return true;
            }
    return false;
}

double mps__form_volume(const form *s)
{
    const double pi = acos(-1.0), r = s->radius, disc = pi * r * r;
    const int across = s->kind == FORM_POLYGON && s->sideways ? 0 : 2;
    const double depth = s->dim == 3 ? s->hi[across] - s->lo[across] : 1;
    switch (s->kind) {
    case FORM_POLYGON:
        return fabs(mps__form_polygon_area(s)) * depth;
    case FORM_TUBE:
        return disc * (s->length + 4.0 / 3 * s->heads);
    case FORM_BALL:
        return s->dim == 3 ? 4.0 / 3 * disc * r : disc;
    default:
        return (s->hi[0] - s->lo[0]) * (s->hi[1] - s->lo[1]) * depth;
    }
}

/* Integral of min(y, level) dx along an edge. */
static double below_edge(const double *a, const double *b, double level)
{
    const double low = fmin(a[1], b[1]), high = fmax(a[1], b[1]), width = b[0] - a[0];
    if (high <= level) return 0.5 * (low + high) * width;
    if (low >= level) return level * width;
    const double share = (level - low) / (high - low); /* fraction of the edge below the level */
    return (share * 0.5 * (low + level) + (1 - share) * level) * width;
}

/* By Green's theorem: min(y, level) has the slope 1 below the level and 0 above it. */
double mps__form_volume_below(const form *s, double y)
{
    const int across = s->kind == FORM_POLYGON && s->sideways ? 0 : 2;
    const double depth = s->dim == 3 ? s->hi[across] - s->lo[across] : 1;
    double area = 0;
    if (s->kind == FORM_BOX)
        return fmax(0, fmin(y, s->hi[1]) - s->lo[1]) * (s->hi[0] - s->lo[0]) * depth;
    if (s->kind != FORM_POLYGON) return NAN;
    for (int32_t i = 0; i < s->points; i++)
        area += below_edge(s->point[i], s->point[(i + 1) % s->points], y);
    return fabs(area) * depth;
}
