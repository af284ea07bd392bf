/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of the tank in 3-D, for pictures and the film of the page. A cylinder and a sphere have no
 * edges: lines on them show their shape. */
#include "build.h"
#include <math.h>
#include <string.h>

enum { EDGES_MOST = 3000, ARC = 48 /* lines per circle */ };

static const double SHARP = 20; /* degrees between the normals at an edge */

/* Edges that are collected. */
typedef struct edges {
    int32_t count;
    double x[EDGES_MOST][6];
} edges;

static void add_edge(edges *e, const double from[3], const double to[3])
{
    if (e->count == EDGES_MOST) return;
    memcpy(e->x[e->count], from, 3 * sizeof *from);
    memcpy(e->x[e->count++] + 3, to, 3 * sizeof *to);
}

/* Add an arc of an ellipse about m with two half axes, between two angles. */
static void add_arc(edges *e, const double m[3], const double a[3], const double b[3], double from,
                    double to)
{
    const int lines = (int)fmax(1, ceil(ARC * fabs(to - from) / (2 * acos(-1.0)) - 1e-9));
    double before[3] = {0};
    for (int k = 0; k <= lines; k++) {
        const double angle = from + (to - from) * k / lines;
        double x[3];
        for (int d = 0; d < 3; d++) x[d] = m[d] + cos(angle) * a[d] + sin(angle) * b[d];
        if (k > 0) add_edge(e, before, x);
        memcpy(before, x, sizeof x);
    }
}

/* Angle between the sides of the outline at point i [degrees]. */
static double turn_at(const form *t, int32_t i)
{
    const double *a = t->point[(i + t->points - 1) % t->points], *b = t->point[i],
                 *c = t->point[(i + 1) % t->points];
    const double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - b[0], c[1] - b[1]};
    return fabs(atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1])) * 180 / acos(-1.0);
}

/* Both end faces, and the lines between their sharp corners. */
static void polygon_edges(edges *e, const form *t)
{
    const int k = t->sideways ? 2 : 0;
    for (int32_t i = 0; i < t->points; i++) {
        const double *p = t->point[i], *q = t->point[(i + 1) % t->points];
        double x[2][3], y[2][3];
        for (int side = 0; side < 2; side++) {
            x[side][k] = p[0];
            y[side][k] = q[0];
            x[side][1] = p[1];
            y[side][1] = q[1];
            x[side][2 - k] = y[side][2 - k] = side ? t->hi[2 - k] : t->lo[2 - k];
            add_edge(e, x[side], y[side]);
        }
        if (turn_at(t, i) > SHARP) add_edge(e, x[0], x[1]);
    }
}

/* Circles at the ends of the straight part, and the sections along two planes through the axis. */
static void tube_edges(edges *e, const form *t)
{
    const double half = 0.5 * acos(-1.0), r = t->radius;
    double m[2][3], along[3] = {0};
    for (int end = 0; end < 2; end++) {
        for (int d = 0; d < 3; d++) m[end][d] = 0.5 * (t->lo[d] + t->hi[d]);
        m[end][t->axis] = t->lo[t->axis] + t->heads + end * t->length;
    }
    along[t->axis] = t->heads;
    for (int plane = 1; plane < 3; plane++) {
        double across[3] = {0}, other[3] = {0}, from[2][3];
        across[(t->axis + plane) % 3] = other[(t->axis + 3 - plane) % 3] = r;
        for (int end = 0; end < 2; end++) {
            if (plane == 1) add_arc(e, m[end], across, other, 0, 4 * half);
            if (t->heads > 0)
                add_arc(e, m[end], along, across, end ? -half : half, end ? half : 3 * half);
        }
        for (int side = -1; side < 2; side += 2) {
            for (int end = 0; end < 2; end++)
                for (int d = 0; d < 3; d++) from[end][d] = m[end][d] + side * across[d];
            add_edge(e, from[0], from[1]);
        }
    }
}

static void ball_edges(edges *e, const form *t)
{
    for (int d = 0; d < 3; d++) {
        double a[3] = {0}, b[3] = {0};
        a[(d + 1) % 3] = b[(d + 2) % 3] = t->radius;
        add_arc(e, t->end[0], a, b, 0, 4 * acos(0.0));
    }
}

/* If a file has too many edges, add the sharper ones. */
static void file_edges(build *b, edges *e)
{
    const tree_node *map = b->tank.at;
    const char *path = mps__read_path(b->c, map, "stl");
    mps_stl stl;
    if (!path || !mps__build_stl(b, map, &stl)) return;
    stl.container = 1;
    for (double angle = SHARP; angle < 180; angle *= 1.5) {
        int64_t count = 0;
        if (!mps__build_try(b,
                            mps_stl_edges(b->sim, path, &stl, angle * acos(-1.0) / 180, EDGES_MOST,
                                          e->x[0], &count),
                            mps__tree_find(map, "stl"), "tank"))
            return;
        if (count > EDGES_MOST) continue;
        e->count = (int32_t)count;
        return;
    }
}

void mps__build_edges(build *b)
{
    if (b->dim != 3 || !b->job || mps__case_failed(b->c)) return;
    edges *e = mps__build_alloc(b, sizeof *e);
    if (!e) return;
    e->count = 0;
    const form *t = &b->tank.form;
    if (b->tank.file)
        file_edges(b, e);
    else if (t->kind == FORM_POLYGON)
        polygon_edges(e, t);
    else if (t->kind == FORM_TUBE)
        tube_edges(e, t);
    else if (t->kind == FORM_BALL)
        ball_edges(e, t);
    if (e->count > 0)
        mps__build_try_job(b, mps_job_edges_add(b->job, e->count, e->x[0]), b->tank.at, "tank");
}
