/* SPDX-License-Identifier: BSD-3-Clause */
/* Dual contouring (Ju, Losasso, Schaefer and Warren 2002). Each cell that the surface intersects
 * has a vertex at the intersection of the tangent planes at the cell's edges, so that edges and
 * corners of the solid stay sharp; each intersected grid edge has a patch. */
#include "contour.h"
#include <math.h>
#include <mps/operators.h>
#include <string.h>

enum { MARGIN = 2, SPLIT_2D = 6, SPLIT_3D = 4 };
static const double most_nodes = 1e9, flat = 0.97, corner_volume = 0.005;

/* Sums over the intersections of one cell, relative to its centre, in sides of cells. */
typedef struct cell_sum {
    int64_t cell;
    double count, at[3], n[3], m[9], rhs[3];
} cell_sum;

/* A grid edge intersected by the surface. */
typedef struct cut {
    int64_t node; /* its lower end */
    int32_t axis;
    int32_t up; /* 1: the liquid is at its upper end, else -1 */
} cut;

typedef struct grid {
    mps__context *context;
    const mps__shape *shape;
    const mps__contour_box *box;
    int dim;
    double lo[3], h; /* of the first node */
    int64_t n[3], nodes;
    double *value;   /* [nodes] */
    int32_t *number; /* [nodes] 1 + vertex of the cell above a node, 0: none */
    cut *cuts;
    cell_sum *sums;
    int64_t cut_count, cut_capacity, sum_count, sum_capacity;
} grid;

static void grid_free(grid *g)
{
    mps__free(g->context, g->value);
    mps__free(g->context, g->number);
    mps__free(g->context, g->cuts);
    mps__free(g->context, g->sums);
}

static void node_place(const grid *g, int64_t node, double x[3])
{
    for (int d = 0; d < 3; d++) {
        x[d] = d < g->dim ? g->lo[d] + g->h * (double)(node % g->n[d]) : 0;
        node /= g->n[d];
    }
}

static void node_index(const grid *g, int64_t node, int64_t k[3])
{
    for (int d = 0; d < 3; d++) {
        k[d] = node % g->n[d];
        node /= g->n[d];
    }
}

static int64_t step_along(const grid *g, int d)
{
    return d == 0 ? 1 : d == 1 ? g->n[0] : g->n[0] * g->n[1];
}

/* Far from a surface with exact distances, the surrounding lattice points are sufficient. */
static bool is_far(const grid *g, const double x[3], double *value)
{
    const double dp = g->shape->dp;
    return g->shape->known && mps__distances_at(g->shape->known, x, value) && fabs(*value) > 3 * dp;
}

static mps_status grid_values(grid *g)
{
    double x[3];
    for (int64_t i = 0; i < g->nodes; i++) {
        node_place(g, i, x);
        if (is_far(g, x, &g->value[i])) continue;
        g->value[i] = mps__shape_at(g->shape, x);
        MPS__CHECK(g->context, isfinite(g->value[i]),
                   "the solid's distance is %g at (%g, %g, %g) m: must be finite", g->value[i],
                   x[0], x[1], x[2]);
    }
    return MPS_OK;
}

static mps_status grid_init(grid *g, mps__context *context, const mps__shape *shape,
                            const mps__contour_box *box)
{
    *g = (grid){.context = context,
                .shape = shape,
                .box = box,
                .dim = shape->dim,
                .h = 0.5 * shape->dp,
                .n = {1, 1, 1}};
    double cells[3], nodes = 1;
    for (int d = 0; d < g->dim; d++) {
        cells[d] = ceil((box->hi[d] - box->anchor[d]) / g->h - 1e-6) + 2 * MARGIN + 2;
        nodes *= cells[d];
    }
    const int most = mps__longest(cells, g->dim);
    MPS__CHECK(context, nodes < most_nodes,
               "the solid's box is %g m long along axis %d: too many cells of %g m",
               box->hi[most] - box->lo[most], most, g->h);
    for (int d = 0; d < g->dim; d++) {
        g->n[d] = (int64_t)cells[d];
        g->lo[d] = box->anchor[d] - (MARGIN + 0.5) * g->h;
    }
    g->nodes = g->n[0] * g->n[1] * g->n[2];
    g->value = mps__alloc(context, g->nodes, sizeof *g->value);
    g->number = mps__alloc(context, g->nodes, sizeof *g->number);
    if (!g->value || !g->number) return MPS_E_NOMEM;
    return grid_values(g);
}

/* ---- cells and their vertices ---- */

/* Cells around a grid edge, in order. @return their number: 2 in 2-D, 4 in 3-D */
static int cells_around(const grid *g, const cut *c, int64_t cell[4])
{
    if (g->dim == 2) {
        cell[0] = c->node - step_along(g, 1 - c->axis);
        cell[1] = c->node;
        return 2;
    }
    const int64_t b = step_along(g, (c->axis + 1) % 3), e = step_along(g, (c->axis + 2) % 3);
    cell[0] = c->node - b - e;
    cell[1] = c->node - e;
    cell[2] = c->node;
    cell[3] = c->node - b;
    return 4;
}

/* Whether a cell extends into the box. */
static bool in_box(const grid *g, int64_t cell)
{
    double x[3];
    node_place(g, cell, x);
    for (int d = 0; d < g->dim; d++) {
        const double centre = x[d] + 0.5 * g->h, slack = (0.5 + 1e-6) * g->h;
        if (centre < g->box->lo[d] - slack || centre > g->box->hi[d] + slack) return false;
    }
    return true;
}

/* Intersection of the surface with an edge: bisection with secants, so that jumps are found as
 * well. */
static void cut_place(const grid *g, const cut *c, double x[3])
{
    double from = 0, to = 1, at = 0.5, low = g->value[c->node],
           high = g->value[c->node + step_along(g, c->axis)];
    node_place(g, c->node, x);
    const double start = x[c->axis];
    for (int k = 0; k < 40 && to - from > 1e-9; k++) {
        const double secant = from + (to - from) * low / (low - high);
        at = k % 3 == 2 || !(secant > from && secant < to) ? 0.5 * (from + to) : secant;
        x[c->axis] = start + g->h * at;
        const double v = mps__shape_at(g->shape, x);
        if (fabs(v) < 1e-9 * g->h) break;
        if ((v > 0) == (low > 0)) {
            from = at;
            low = v;
        } else {
            to = at;
            high = v;
        }
    }
}

static mps_status sum_of(grid *g, int64_t cell, cell_sum **out)
{
    if (g->number[cell] == 0) {
        MPS__TRY(mps__grow(g->context, (void **)&g->sums, &g->sum_capacity, g->sum_count,
                           g->sum_count + 1, sizeof *g->sums));
        g->sums[g->sum_count] = (cell_sum){.cell = cell};
        g->number[cell] = (int32_t)++g->sum_count;
    }
    *out = &g->sums[g->number[cell] - 1];
    return MPS_OK;
}

static mps_status add_to_cell(grid *g, int64_t cell, const double x[3], const double n[3])
{
    double centre[3], r[3] = {0, 0, 0}, height = 0;
    cell_sum *s;
    MPS__TRY(sum_of(g, cell, &s));
    node_place(g, cell, centre);
    for (int d = 0; d < g->dim; d++) {
        r[d] = (x[d] - centre[d]) / g->h - 0.5;
        height += r[d] * n[d];
    }
    s->count++;
    for (int d = 0; d < g->dim; d++) {
        s->at[d] += r[d];
        s->n[d] += n[d];
        s->rhs[d] += height * n[d];
        for (int e = 0; e < g->dim; e++) s->m[d * g->dim + e] += n[d] * n[e];
    }
    return MPS_OK;
}

static mps_status add_cut(grid *g, mps__contour *out, const cut *c)
{
    int64_t cell[4];
    const int around = cells_around(g, c, cell);
    int within = 0;
    for (int k = 0; k < around; k++) within += in_box(g, cell[k]);
    if (within == 0) return MPS_OK;
    double x[3], n[3] = {0, 0, 0};
    cut_place(g, c, x);
    bool kept = true;
    for (int d = 0; d < g->dim; d++)
        kept = kept && x[d] > g->box->keep_lo[d] && x[d] < g->box->keep_hi[d];
    if (within < around) {
        if (kept && !out->open) memcpy(out->open_at, x, sizeof x);
        out->open = out->open || kept;
        return MPS_OK;
    }
    if (g->shape->distance || g->shape->mesh) mps__shape_true(g->shape, x, n);
    for (int k = 0; k < around; k++) MPS__TRY(add_to_cell(g, cell[k], x, n));
    MPS__TRY(mps__grow(g->context, (void **)&g->cuts, &g->cut_capacity, g->cut_count,
                       g->cut_count + 1, sizeof *g->cuts));
    g->cuts[g->cut_count++] = *c;
    return MPS_OK;
}

static mps_status find_cuts(grid *g, mps__contour *out)
{
    for (int64_t i = 0; i < g->nodes; i++) {
        int64_t k[3];
        node_index(g, i, k);
        for (int d = 0; d < g->dim; d++) {
            if (k[d] + 1 >= g->n[d]) continue;
            const bool here = g->value[i] > 0, there = g->value[i + step_along(g, d)] > 0;
            bool border = false; /* true: fewer than four cells around it */
            for (int e = 0; e < g->dim; e++)
                border = border || (e != d && (k[e] == 0 || k[e] + 1 >= g->n[e]));
            if (here == there || border) continue;
            const cut c = {i, d, there ? 1 : -1};
            MPS__TRY(add_cut(g, out, &c));
        }
    }
    return MPS_OK;
}

/* Sharpness of the surface within a cell: the normals of a face are parallel, those at an edge are
 * coplanar. */
static int32_t feature_of(const grid *g, const cell_sum *s)
{
    const double mean = sqrt(mps__dot(s->n, s->n, g->dim)) / s->count,
                 c3 = s->count * s->count * s->count, *m = s->m;
    if (mean > flat || mean == 0) return MPS__FACE;
    if (g->dim == 2) return MPS__CORNER;
    const double volume = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                          m[2] * (m[3] * m[7] - m[4] * m[6]);
    return volume > corner_volume * c3 ? MPS__CORNER : MPS__EDGE;
}

/* Intersection of the tangent planes, iterated from the mean of the edge intersections; that mean
 * if it is outside the cell. */
static void vertex_place(const grid *g, const cell_sum *s, double r[3])
{
    const int dim = g->dim;
    double m[9], b[9], mean[3] = {0, 0, 0}, rhs[3];
    for (int d = 0; d < dim * dim; d++) m[d] = s->m[d] / s->count;
    for (int d = 0; d < dim; d++) mean[d] = s->at[d] / s->count;
    for (int d = 0; d < dim; d++) {
        rhs[d] = s->rhs[d] / s->count;
        for (int e = 0; e < dim; e++) rhs[d] -= m[d * dim + e] * mean[e];
    }
    mps_matrix_inverse_bounded(dim, m, 0.1, b);
    bool within = true;
    for (int d = 0; d < dim; d++) {
        r[d] = mean[d];
        for (int e = 0; e < dim; e++) r[d] += b[d * dim + e] * rhs[e];
        within = within && fabs(r[d]) <= 0.6;
    }
    if (!within) memcpy(r, mean, sizeof mean);
}

static mps_status make_vertices(grid *g, mps__contour *out)
{
    const bool true_surface = g->shape->distance || g->shape->mesh;
    MPS__TRY(mps__grow(g->context, (void **)&out->vertex, &out->vertex_capacity, 0, g->sum_count,
                       sizeof *out->vertex));
    out->vertices = g->sum_count;
    for (int64_t v = 0; v < g->sum_count; v++) {
        const cell_sum *s = &g->sums[v];
        mps__vertex *to = &out->vertex[v];
        double r[3] = {0, 0, 0}, at[3];
        int64_t k[3];
        *to = (mps__vertex){.feature = feature_of(g, s)};
        vertex_place(g, s, r);
        node_place(g, s->cell, to->x);
        node_index(g, s->cell, k);
        for (int d = 0; d < g->dim; d++) {
            to->x[d] += (0.5 + r[d]) * g->h;
            to->odd += (int32_t)((k[d] - MARGIN) & 1);
        }
        memcpy(at, to->x, sizeof at);
        if (true_surface && to->feature == MPS__FACE && mps__shape_project(g->shape, at, g->h))
            memcpy(to->x, at, sizeof at);
    }
    return MPS_OK;
}

/* ---- patches ---- */

static void bilinear(const double *const v[4], double s, double t, double x[3])
{
    for (int d = 0; d < 3; d++)
        x[d] = (1 - t) * ((1 - s) * v[0][d] + s * v[1][d]) + t * ((1 - s) * v[3][d] + s * v[2][d]);
}

static void segment_patch(const grid *g, const cut *c, const double *const v[4], int part,
                          mps__patch *out)
{
    *out = (mps__patch){.x = {0}};
    const double t = (part + 0.5) / SPLIT_2D, sign = c->axis == 0 ? c->up : -c->up;
    for (int d = 0; d < 2; d++) out->x[d] = (1 - t) * v[0][d] + t * v[1][d];
    out->area[0] = sign * (v[1][1] - v[0][1]) / SPLIT_2D;
    out->area[1] = -sign * (v[1][0] - v[0][0]) / SPLIT_2D;
    (void)g;
}

static void quad_patch(const cut *c, const double *const v[4], int part, mps__patch *out)
{
    const int column = part % SPLIT_3D, row = part / SPLIT_3D;
    const double step = 1.0 / SPLIT_3D, s = step * column, t = step * row;
    double a[4][3], p[3], q[3];
    bilinear(v, s, t, a[0]);
    bilinear(v, s + step, t, a[1]);
    bilinear(v, s + step, t + step, a[2]);
    bilinear(v, s, t + step, a[3]);
    for (int d = 0; d < 3; d++) {
        out->x[d] = 0.25 * (a[0][d] + a[1][d] + a[2][d] + a[3][d]);
        p[d] = a[2][d] - a[0][d];
        q[d] = a[3][d] - a[1][d];
    }
    for (int d = 0; d < 3; d++)
        out->area[d] = 0.5 * c->up *
                       (p[(d + 1) % 3] * q[(d + 2) % 3] - p[(d + 2) % 3] * q[(d + 1) % 3]);
}

static mps_status make_patches(grid *g, mps__contour *out)
{
    const int split = g->dim == 2 ? SPLIT_2D : SPLIT_3D * SPLIT_3D;
    MPS__TRY(mps__grow(g->context, (void **)&out->patch, &out->patch_capacity, 0,
                       g->cut_count * split, sizeof *out->patch));
    for (int64_t k = 0; k < g->cut_count; k++) {
        int64_t cell[4];
        const double *v[4] = {NULL, NULL, NULL, NULL};
        const int around = cells_around(g, &g->cuts[k], cell);
        for (int a = 0; a < around; a++) v[a] = out->vertex[g->number[cell[a]] - 1].x;
        for (int p = 0; p < split; p++) {
            mps__patch *to = &out->patch[out->patches++];
            if (g->dim == 2)
                segment_patch(g, &g->cuts[k], v, p, to);
            else
                quad_patch(&g->cuts[k], v, p, to);
        }
    }
    return MPS_OK;
}

/* Segments, or two triangles for each quadrilateral. */
static mps_status fill_mesh(const grid *g, const mps__contour *c, mps__mesh *mesh)
{
    MPS__TRY(mps__mesh_reserve(mesh, c->vertices, 2 * g->cut_count));
    for (int64_t v = 0; v < c->vertices; v++)
        memcpy(mesh->x + 3 * v, c->vertex[v].x, sizeof c->vertex[v].x);
    mesh->points = c->vertices;
    for (int64_t k = 0; k < g->cut_count; k++) {
        int64_t cell[4];
        const int around = cells_around(g, &g->cuts[k], cell);
        for (int second = 0; second < around / 2; second++) {
            int32_t *corner = mesh->corner + 3 * mesh->elements++;
            for (int a = 0; a < around - 1; a++)
                corner[a] = g->number[cell[a == 0 ? 0 : a + second]] - 1;
            if (around == 2) corner[1] = g->number[cell[1]] - 1;
            const bool turned = (around == 2 && g->cuts[k].axis == 1) != (g->cuts[k].up < 0);
            const int32_t first = corner[0];
            if (turned) corner[0] = corner[1];
            if (turned) corner[1] = first;
        }
    }
    return MPS_OK;
}

static mps_status find_vertices(grid *g, mps__contour *c, mps__context *context,
                                const mps__shape *shape, const mps__contour_box *box)
{
    MPS__TRY(grid_init(g, context, shape, box));
    MPS__TRY(find_cuts(g, c));
    return make_vertices(g, c);
}

mps_status mps__contour_find(mps__contour *c, mps__context *context, const mps__shape *shape,
                             const mps__contour_box *box)
{
    grid g = {.context = context};
    *c = (mps__contour){0};
    mps_status status = find_vertices(&g, c, context, shape, box);
    if (status == MPS_OK) status = make_patches(&g, c);
    grid_free(&g);
    return status;
}

mps_status mps__contour_mesh(const mps__shape *shape, const mps__contour_box *box, mps__mesh *mesh)
{
    grid g = {.context = mesh->context};
    mps__contour c = {0};
    mps_status status = find_vertices(&g, &c, mesh->context, shape, box);
    if (status == MPS_OK) status = fill_mesh(&g, &c, mesh);
    mps__mesh_faults faults; /* the surface may end at the box */
    if (status == MPS_OK) status = mps__mesh_weld(mesh, 0, &faults);
    if (status == MPS_OK) status = mps__mesh_finish(mesh);
    mps__contour_free(&c, mesh->context);
    grid_free(&g);
    return status;
}

void mps__contour_free(mps__contour *c, mps__context *context)
{
    mps__free(context, c->vertex);
    mps__free(context, c->patch);
    *c = (mps__contour){0};
}
