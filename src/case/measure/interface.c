/* SPDX-License-Identifier: BSD-3-Clause */
/* Cell by cell: the part of a cell in the other phase is a polygon of corners of the cell and of
 * crossings on its edges. */
#include "interface.h"
#include <math.h>

enum { CORNERS = 4, POINTS = 8 };

typedef struct point {
    double x[2];
    bool crossing;
} point;

typedef struct polygon {
    int count;
    point at[POINTS];
} polygon;

/* Fraction of the other phase in the fluid around a node, minus one half. */
static double excess(const raster *g, int64_t node)
{
    const double other = g->share[RASTER_OTHER][node], both = other + g->share[RASTER_LIQUID][node];
    return both > 1e-6 ? other / both - 0.5 : -0.5;
}

static void polygon_add(polygon *p, const double *a, const double *b, double part, bool crossing)
{
    point *q = &p->at[p->count++];
    for (int d = 0; d < 2; d++) q->x[d] = a[d] + part * (b[d] - a[d]);
    q->crossing = crossing;
}

/* The part of cell (i, j) where the other phase prevails, anticlockwise. */
static polygon cell_polygon(const raster *g, int64_t i, int64_t j)
{
    static const int step[CORNERS + 1][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    polygon p = {0};
    double x[CORNERS + 1][2], f[CORNERS + 1];
    for (int k = 0; k <= CORNERS; k++) {
        x[k][0] = g->lo[0] + (double)(i + step[k][0]) * g->dp;
        x[k][1] = g->lo[1] + (double)(j + step[k][1]) * g->dp;
        f[k] = excess(g, (j + step[k][1]) * g->size[0] + i + step[k][0]);
    }
    for (int k = 0; k < CORNERS; k++) {
        if (f[k] >= 0) polygon_add(&p, x[k], x[k + 1], 0, false);
        if ((f[k] >= 0) != (f[k + 1] >= 0))
            polygon_add(&p, x[k], x[k + 1], f[k] / (f[k] - f[k + 1]), true);
    }
    return p;
}

static void contour_add(contour *c, const polygon *p)
{
    for (int k = 0; k < p->count; k++) {
        const point *a = &p->at[k], *b = &p->at[(k + 1) % p->count];
        c->area += 0.5 * (a->x[0] * b->x[1] - a->x[1] * b->x[0]);
        if (!a->crossing) continue;
        for (int d = 0; d < 2; d++) {
            c->lo[d] = fmin(c->lo[d], a->x[d]); /* fmin and fmax ignore a NAN */
            c->hi[d] = fmax(c->hi[d], a->x[d]);
        }
        /* between two consecutive crossings the line passes through the cell */
        if (b->crossing) c->length += hypot(b->x[0] - a->x[0], b->x[1] - a->x[1]);
    }
}

contour mps__contour_measure(const raster *g)
{
    contour c = {.lo = {NAN, NAN}, .hi = {NAN, NAN}};
    for (int64_t j = 0; j + 1 < g->size[1]; j++)
        for (int64_t i = 0; i + 1 < g->size[0]; i++) {
            const polygon p = cell_polygon(g, i, j);
            contour_add(&c, &p);
        }
    return c;
}
