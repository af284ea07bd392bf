/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance to a surface, with a tree of boxes over its elements. The sign is that of the
 * pseudonormal of the nearest feature - face, edge or corner. At corners the normals are weighted
 * by angle (Baerentzen and Aanaes 2005), the only weight with the correct sign. */
#include "mesh.h"
#include "angles.h"
#include "buckets.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, DEEPEST = 64 };

/* ---- small vectors ---- */

static void difference(const double *a, const double *b, double out[3])
{
    for (int d = 0; d < 3; d++) out[d] = a[d] - b[d];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static const double *corner_of(const mps__mesh *m, int64_t e, int k)
{
    return m->x + 3 * (int64_t)m->corner[3 * e + k];
}

/* Unit normal times twice the area; of a segment, times its length. */
static void face_normal(const mps__mesh *m, int64_t e, double n[3])
{
    double a[3], b[3];
    difference(corner_of(m, e, 1), corner_of(m, e, 0), a);
    if (m->dim == 2) {
        n[0] = a[1];
        n[1] = -a[0];
        n[2] = 0;
        return;
    }
    difference(corner_of(m, e, 2), corner_of(m, e, 0), b);
    cross(a, b, n);
}

static void unit(double n[3])
{
    const double length = sqrt(dot(n, n));
    for (int d = 0; d < 3; d++) n[d] = length > 0 ? n[d] / length : 0;
}

/* ---- the arrays ---- */

void mps__mesh_init(mps__mesh *m, mps__context *context, int32_t dim)
{
    *m = (mps__mesh){.context = context, .dim = dim};
}

void mps__mesh_free(mps__mesh *m)
{
    void *all[] = {m->x, m->corner, m->point_normal, m->edge_normal, m->node, m->order};
    for (size_t k = 0; m->context && k < sizeof all / sizeof all[0]; k++)
        mps__free(m->context, all[k]);
    *m = (mps__mesh){0};
}

mps_status mps__mesh_reserve(mps__mesh *m, int64_t points, int64_t elements)
{
    MPS__CHECK(m->context,
               m->points + points < INT32_MAX / 3 && m->elements + elements < INT32_MAX / 3,
               "a surface of %lld elements: at most %d", (long long)(m->elements + elements),
               INT32_MAX / 3);
    MPS__TRY(mps__grow(m->context, (void **)&m->x, &m->point_capacity, 3 * m->points,
                       3 * (m->points + points), sizeof *m->x));
    return mps__grow(m->context, (void **)&m->corner, &m->element_capacity, 3 * m->elements,
                     3 * (m->elements + elements), sizeof *m->corner);
}

/* ---- welding ---- */

/* A point and its original index. */
typedef struct place {
    double x[3];
    int32_t index;
} place;

static int compare_coordinates(const double *a, const double *b)
{
    for (int d = 0; d < 3; d++)
        if (a[d] != b[d]) return a[d] < b[d] ? -1 : 1;
    return 0;
}

static int compare_places(const void *a, const void *b)
{
    const place *p = a, *q = b;
    const int order = compare_coordinates(p->x, q->x);
    return order ? order : (p->index > q->index) - (p->index < q->index);
}

/* Merge points with equal coordinates. */
static mps_status weld_points(mps__mesh *m)
{
    place *p = mps__alloc(m->context, m->points, sizeof *p);
    int32_t *number = mps__alloc(m->context, m->points, sizeof *number);
    if (p && number) {
        for (int64_t i = 0; i < m->points; i++) {
            for (int d = 0; d < 3; d++) p[i].x[d] = m->x[3 * i + d] + 0.0; /* no negative zero */
            p[i].index = (int32_t)i;
        }
        qsort(p, (size_t)m->points, sizeof *p, compare_places);
        int64_t kept = 0;
        for (int64_t i = 0; i < m->points; i++) {
            if (i == 0 || compare_coordinates(p[i].x, p[i - 1].x) != 0)
                memcpy(m->x + 3 * kept++, p[i].x, sizeof p[i].x);
            number[p[i].index] = (int32_t)(kept - 1);
        }
        m->points = kept;
        /* unused third corner in 2-D */
        for (int64_t k = 0; k < 3 * m->elements; k++) m->corner[k] = number[m->corner[k]];
    }
    mps__free(m->context, p);
    mps__free(m->context, number);
    return p && number ? MPS_OK : MPS_E_NOMEM;
}

/* Triangles with two equal corners, or with a height negligible relative to their longest side. */
static bool is_degenerate(const mps__mesh *m, int64_t e)
{
    double n[3], longest2 = 0;
    if (m->dim == 2) return m->corner[3 * e] == m->corner[3 * e + 1];
    face_normal(m, e, n);
    for (int k = 0; k < 3; k++) {
        double a[3];
        difference(corner_of(m, e, (k + 1) % 3), corner_of(m, e, k), a);
        longest2 = fmax(longest2, dot(a, a));
        if (m->corner[3 * e + k] == m->corner[3 * e + (k + 1) % 3]) return true;
    }
    return !(sqrt(dot(n, n)) > 1e-12 * longest2);
}

/* Triangles with two equal corners are lines: their removal leaves no hole. The removal of a
 * triangle with three collinear corners leaves one, so that it is kept for the check of edges and
 * has no normal. */
static int64_t remove_degenerate(mps__mesh *m)
{
    int64_t kept = 0, lost = 0;
    for (int64_t e = 0; e < m->elements; e++) {
        const int32_t *c = m->corner + 3 * e;
        lost += is_degenerate(m, e);
        if (c[0] == c[1] || (m->dim == 3 && (c[1] == c[2] || c[2] == c[0]))) continue;
        memmove(m->corner + 3 * kept++, c, 3 * sizeof *c);
    }
    m->elements = kept;
    return lost;
}

/* A triangle by its corners, rotated so that the lowest is first. */
typedef struct triangle {
    int32_t corner[3], element;
} triangle;

static int compare_faces(const void *a, const void *b)
{
    const triangle *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->corner[k] != q->corner[k]) return p->corner[k] < q->corner[k] ? -1 : 1;
    return (p->element > q->element) - (p->element < q->element);
}

/* Remove duplicate triangles (same corners, same orientation), keeping the first one. */
static mps_status remove_twice(mps__mesh *m, int64_t *lost)
{
    triangle *f = mps__alloc(m->context, m->elements, sizeof *f);
    if (!f) return MPS_E_NOMEM;
    for (int64_t e = 0; e < m->elements; e++) {
        const int32_t *c = m->corner + 3 * e;
        const int low = c[0] < c[1] ? (c[0] < c[2] ? 0 : 2) : c[1] < c[2] ? 1 : 2;
        f[e].element = (int32_t)e;
        for (int k = 0; k < 3; k++) f[e].corner[k] = c[(low + k) % 3];
    }
    qsort(f, (size_t)m->elements, sizeof *f, compare_faces);
    for (int64_t k = 1; k < m->elements; k++)
        if (memcmp(f[k].corner, f[k - 1].corner, sizeof f[k].corner) == 0)
            m->corner[3 * (int64_t)f[k].element] = -1;
    int64_t kept = 0;
    for (int64_t e = 0; e < m->elements; e++)
        if (m->corner[3 * e] >= 0)
            memmove(m->corner + 3 * kept++, m->corner + 3 * e, 3 * sizeof *m->corner);
    *lost = m->elements - kept;
    m->elements = kept;
    mps__free(m->context, f);
    return MPS_OK;
}

/* An edge of a triangle, from its lower to its higher point. */
typedef struct side {
    int32_t low, high, place; /* place: 3 * element + index of the edge */
    int32_t direction;        /* 1: the triangle traverses the edge from low to high, else -1 */
} side;

static int compare_sides(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return (p->place > q->place) - (p->place < q->place);
}

static side *collect_sides(const mps__mesh *m)
{
    side *s = mps__alloc(m->context, 3 * m->elements, sizeof *s);
    if (!s) return NULL;
    for (int64_t k = 0; k < 3 * m->elements; k++) {
        const int32_t a = m->corner[k], b = m->corner[k % 3 == 2 ? k - 2 : k + 1];
        s[k] = (side){a < b ? a : b, a < b ? b : a, (int32_t)k, a < b ? 1 : -1};
    }
    qsort(s, (size_t)(3 * m->elements), sizeof *s, compare_sides);
    return s;
}

static void middle_of(const mps__mesh *m, const side *s, double out[3])
{
    for (int d = 0; d < 3; d++)
        out[d] = 0.5 * (m->x[3 * (int64_t)s->low + d] + m->x[3 * (int64_t)s->high + d]);
}

/* Edge normals, and faults of the `count` triangles at one edge. Points of open edges are marked in
 * `border`. */
static void look_at_edge(mps__mesh *m, const side *s, int64_t count, mps__mesh_faults *faults,
                         unsigned char *border)
{
    double sum[3] = {0, 0, 0};
    int64_t balance = 0;
    for (int64_t k = 0; k < count; k++) {
        double n[3];
        face_normal(m, s[k].place / 3, n);
        unit(n);
        for (int d = 0; d < 3; d++) sum[d] += n[d];
        balance += s[k].direction;
    }
    for (int64_t k = 0; k < count; k++)
        memcpy(m->edge_normal + 3 * (int64_t)s[k].place, sum, sizeof sum);
    if (balance == 0) return;
    border[s->low] = border[s->high] = 1;
    if (count % 2 == 1 && faults->open++ == 0) middle_of(m, s, faults->open_at);
    if (count % 2 == 0 && faults->turned++ == 0) middle_of(m, s, faults->turned_at);
}

static void add_point_normals(mps__mesh *m)
{
    for (int64_t e = 0; e < m->elements; e++) {
        double n[3];
        face_normal(m, e, n);
        unit(n);
        for (int k = 0; k < m->dim; k++) {
            double a[3], b[3], turn[3], *sum = m->point_normal + 3 * (int64_t)m->corner[3 * e + k];
            if (m->dim == 2) {
                for (int d = 0; d < 2; d++) sum[d] += n[d];
                continue;
            }
            difference(corner_of(m, e, (k + 1) % 3), corner_of(m, e, k), a);
            difference(corner_of(m, e, (k + 2) % 3), corner_of(m, e, k), b);
            cross(a, b, turn);
            const double angle = mps__atan2(sqrt(dot(turn, turn)), dot(a, b));
            for (int d = 0; d < 3; d++) sum[d] += angle * n[d];
        }
    }
}

static mps_status look_at_edges(mps__mesh *m, mps__mesh_faults *faults, unsigned char *border)
{
    mps__free(m->context, m->edge_normal);
    m->edge_normal = mps__alloc(m->context, 9 * m->elements, sizeof *m->edge_normal);
    side *s = m->edge_normal ? collect_sides(m) : NULL;
    if (!s) return MPS_E_NOMEM;
    for (int64_t k = 0, next; k < 3 * m->elements; k = next) {
        for (next = k + 1;
             next < 3 * m->elements && s[next].low == s[k].low && s[next].high == s[k].high;
             next++) {
        }
        look_at_edge(m, s + k, next - k, faults, border);
    }
    mps__free(m->context, s);
    return MPS_OK;
}

/* ---- gaps ---- */

void mps__mesh_box(const mps__mesh *m, double lo[3], double hi[3])
{
    for (int d = 0; d < 3; d++) {
        lo[d] = INFINITY;
        hi[d] = -INFINITY;
    }
    for (int64_t k = 0; k < 3 * m->points; k++) {
        lo[k % 3] = fmin(lo[k % 3], m->x[k]);
        hi[k % 3] = fmax(hi[k % 3], m->x[k]);
    }
}

/* Merge points of `border` with the first near one. @param number  [points] out: new index */
static mps_status find_near(const mps__mesh *m, const unsigned char *border, double tolerance,
                            int32_t *number, mps__mesh_faults *faults)
{
    double lo[3], hi[3], cell = tolerance;
    mps__buckets kept;
    mps__mesh_box(m, lo, hi);
    for (int d = 0; d < 3; d++) cell = fmax(cell, (hi[d] - lo[d]) / 64);
    int32_t *point = mps__alloc(m->context, m->points, sizeof *point);
    mps_status status = point ? mps__buckets_init(&kept, m->context, 3, lo, hi, cell) : MPS_E_NOMEM;
    if (status < 0) {
        mps__free(m->context, point);
        return status;
    }
    for (int64_t i = 0; i < m->points && status == MPS_OK; i++) {
        double r;
        number[i] = (int32_t)i;
        if (!border[i]) continue;
        const int64_t near = mps__buckets_nearest(&kept, m->x + 3 * i, tolerance, &r);
        if (near < 0) {
            point[kept.count] = (int32_t)i;
            status = mps__buckets_add(&kept, m->x + 3 * i);
            continue;
        }
        number[i] = point[near];
        faults->joined++;
        faults->gap = fmax(faults->gap, r);
    }
    mps__buckets_free(&kept);
    mps__free(m->context, point);
    return status;
}

static mps_status close_gaps(mps__mesh *m, const unsigned char *border, double tolerance,
                             mps__mesh_faults *faults)
{
    int32_t *number = mps__alloc(m->context, m->points, sizeof *number);
    if (!number) return MPS_E_NOMEM;
    const mps_status status = find_near(m, border, tolerance, number, faults);
    for (int64_t k = 0; status == MPS_OK && k < 3 * m->elements; k++)
        m->corner[k] = number[m->corner[k]];
    mps__free(m->context, number);
    if (status == MPS_OK) faults->degenerate += remove_degenerate(m);
    return status;
}

static mps_status look_at_surface(mps__mesh *m, double tolerance, mps__mesh_faults *faults)
{
    unsigned char *border = mps__alloc(m->context, m->points, 1);
    if (!border) return MPS_E_NOMEM;
    mps_status status = remove_twice(m, &faults->twice);
    if (status == MPS_OK) status = look_at_edges(m, faults, border);
    if (status == MPS_OK && faults->open > 0 && tolerance > 0) {
        status = close_gaps(m, border, tolerance, faults);
        faults->open = faults->turned = 0;
        if (status == MPS_OK) status = look_at_edges(m, faults, border);
    }
    mps__free(m->context, border);
    return status;
}

mps_status mps__mesh_weld(mps__mesh *m, double tolerance, mps__mesh_faults *faults)
{
    *faults = (mps__mesh_faults){0};
    MPS__TRY(weld_points(m));
    faults->degenerate = remove_degenerate(m);
    m->point_normal = mps__alloc(m->context, 3 * m->points, sizeof *m->point_normal);
    if (!m->point_normal) return MPS_E_NOMEM;
    if (m->dim == 3) MPS__TRY(look_at_surface(m, tolerance, faults));
    add_point_normals(m);
    return MPS_OK;
}

double mps__mesh_area(const mps__mesh *m)
{
    double area = 0;
    for (int64_t e = 0; e < m->elements; e++) {
        double n[3];
        face_normal(m, e, n);
        area += 0.5 * sqrt(dot(n, n));
    }
    return area;
}

double mps__mesh_volume(const mps__mesh *m)
{
    double volume = 0;
    for (int64_t e = 0; e < m->elements; e++) {
        double n[3], r[3];
        face_normal(m, e, n);
        difference(corner_of(m, e, 0), m->x, r); /* relative to a near point, to reduce rounding */
        volume += dot(r, n) / 6;
    }
    return volume;
}

void mps__mesh_turn(mps__mesh *m)
{
    for (int64_t e = 0; e < m->elements; e++) {
        int32_t *c = m->corner + 3 * e, first = c[0];
        double *n = m->edge_normal + 9 * e, kept[3];
        c[0] = c[1];
        c[1] = first;
        /* edges 1-2 and 2-0 are swapped */
        memcpy(kept, n + 3, sizeof kept);
        memcpy(n + 3, n + 6, sizeof kept);
        memcpy(n + 6, kept, sizeof kept);
    }
    for (int64_t k = 0; k < 9 * m->elements; k++) m->edge_normal[k] = -m->edge_normal[k];
    for (int64_t k = 0; k < 3 * m->points; k++) m->point_normal[k] = -m->point_normal[k];
}

/* ---- the tree ---- */

/* An element while the tree is built. */
typedef struct leaf {
    double key; /* centre along the axis of the current split */
    int32_t element;
} leaf;

static int compare_leaves(const void *a, const void *b)
{
    const leaf *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return (p->element > q->element) - (p->element < q->element);
}

static double centre_along(const mps__mesh *m, int64_t e, int d)
{
    double sum = 0;
    for (int k = 0; k < m->dim; k++) sum += corner_of(m, e, k)[d];
    return sum / m->dim;
}

static void bound(const mps__mesh *m, mps__mesh_node *node, const leaf *l, int32_t count)
{
    for (int d = 0; d < 3; d++) {
        node->lo[d] = INFINITY;
        node->hi[d] = -INFINITY;
        for (int32_t k = 0; k < count; k++)
            for (int c = 0; c < m->dim; c++) {
                const double x = corner_of(m, l[k].element, c)[d];
                node->lo[d] = fmin(node->lo[d], x);
                node->hi[d] = fmax(node->hi[d], x);
            }
    }
}

/* Split the elements into halves along the longest side of their box. The depth is log2 of their
 * number. */
static void build(mps__mesh *m, leaf *all, int32_t first, int32_t count)
{
    const int64_t self = m->nodes++;
    mps__mesh_node *node = &m->node[self];
    leaf *l = all + first;
    *node = (mps__mesh_node){.first = first, .count = count};
    bound(m, node, l, count);
    if (count <= LEAF) return;
    int axis = 0;
    for (int d = 1; d < 3; d++)
        if (node->hi[d] - node->lo[d] > node->hi[axis] - node->lo[axis]) axis = d;
    for (int32_t k = 0; k < count; k++) l[k].key = centre_along(m, l[k].element, axis);
    qsort(l, (size_t)count, sizeof *l, compare_leaves);
    node->count = 0;
    build(m, all, first, count / 2);
    node->right = (int32_t)m->nodes;
    build(m, all, first + count / 2, count - count / 2);
}

mps_status mps__mesh_finish(mps__mesh *m)
{
    leaf *l = mps__alloc(m->context, m->elements, sizeof *l);
    m->order = mps__alloc(m->context, m->elements, sizeof *m->order);
    m->node = mps__alloc(m->context, 2 * m->elements, sizeof *m->node);
    if (l && m->order && m->node) {
        for (int64_t e = 0; e < m->elements; e++) l[e].element = (int32_t)e;
        if (m->elements > 0) build(m, l, 0, (int32_t)m->elements);
        for (int64_t e = 0; e < m->elements; e++) m->order[e] = l[e].element;
    }
    for (int d = 0; d < 3 && m->node && m->nodes > 0; d++)
        m->size = fmax(m->size, m->node[0].hi[d] - m->node[0].lo[d]);
    mps__free(m->context, l);
    return l && m->order && m->node ? MPS_OK : MPS_E_NOMEM;
}

/* ---- the distance ---- */

/* The nearest element so far. */
typedef struct hit {
    double r2, to[3]; /* from the nearest point to x */
    int64_t element;
    int feature; /* 0: face, 1 2 3: edges, 4 5 6: corners */
} hit;

/* The nearest point between two corners of an element, as a fraction of their distance. */
static double along_edge(const mps__mesh *m, int64_t e, int from, int to, const double x[3])
{
    double a[3], r[3];
    difference(corner_of(m, e, to), corner_of(m, e, from), a);
    difference(x, corner_of(m, e, from), r);
    const double length2 = dot(a, a), t = length2 > 0 ? dot(a, r) / length2 : 0;
    return fmin(fmax(t, 0), 1);
}

static void try_edge(const mps__mesh *m, int64_t e, int k, const double x[3], hit *best)
{
    const int next = (k + 1) % m->dim;
    const double t = along_edge(m, e, k, next, x), *a = corner_of(m, e, k),
                 *b = corner_of(m, e, next);
    double r[3], r2 = 0;
    for (int d = 0; d < 3; d++) {
        r[d] = x[d] - (a[d] + t * (b[d] - a[d]));
        r2 += r[d] * r[d];
    }
    if (r2 >= best->r2) return;
    *best = (hit){r2, {r[0], r[1], r[2]}, e, t <= 0 ? 4 + k : t >= 1 ? 4 + next : 1 + k};
}

/* The foot of the perpendicular, if it is within the triangle. @return whether it is */
static bool try_face(const mps__mesh *m, int64_t e, const double x[3], hit *best)
{
    double n[3], r[3];
    face_normal(m, e, n);
    const double n2 = dot(n, n);
    if (!(n2 > 0)) return false;
    for (int k = 0; k < 3; k++) {
        double a[3], q[3], in[3];
        difference(corner_of(m, e, (k + 1) % 3), corner_of(m, e, k), a);
        difference(x, corner_of(m, e, k), q);
        cross(n, a, in);
        if (dot(in, q) < 0) return false;
    }
    difference(x, corner_of(m, e, 0), r);
    const double height = dot(r, n) / n2;
    if (height * height * n2 < best->r2)
        *best = (hit){height * height * n2, {height * n[0], height * n[1], height * n[2]}, e, 0};
    return true;
}

static void try_element(const mps__mesh *m, int64_t e, const double x[3], hit *best)
{
    if (m->dim == 3 && try_face(m, e, x, best)) return;
    for (int k = 0; k < (m->dim == 3 ? 3 : 1); k++) try_edge(m, e, k, x, best);
}

static double box_distance2(const mps__mesh_node *node, const double x[3])
{
    double sum = 0;
    for (int d = 0; d < 3; d++) {
        const double out = fmax(fmax(node->lo[d] - x[d], x[d] - node->hi[d]), 0);
        sum += out * out;
    }
    return sum;
}

static void pseudonormal(const mps__mesh *m, const hit *h, double n[3])
{
    if (h->feature == 0 || (m->dim == 2 && h->feature < 4))
        face_normal(m, h->element, n);
    else if (h->feature < 4)
        memcpy(n, m->edge_normal + 9 * h->element + 3 * (h->feature - 1), 3 * sizeof *n);
    else
        memcpy(n, m->point_normal + 3 * (int64_t)m->corner[3 * h->element + h->feature - 4],
               3 * sizeof *n);
}

double mps__mesh_distance(const mps__mesh *m, const double x[3], double foot[3], double n[3])
{
    hit best = {.r2 = INFINITY};
    int32_t stack[DEEPEST] = {0};
    for (int depth = m->nodes > 0; depth > 0;) {
        const mps__mesh_node *node = &m->node[stack[--depth]];
        if (box_distance2(node, x) >= best.r2) continue;
        for (int32_t k = 0; k < node->count; k++)
            try_element(m, m->order[node->first + k], x, &best);
        if (node->count > 0) continue;
        const int32_t left = (int32_t)(node - m->node) + 1;
        const bool left_first = box_distance2(&m->node[left], x) <
                                box_distance2(&m->node[node->right], x);
        stack[depth++] = left_first ? node->right : left;
        stack[depth++] = left_first ? left : node->right;
    }
    double across[3];
    if (m->nodes == 0) return INFINITY;
    pseudonormal(m, &best, across);
    const double r = sqrt(best.r2), sign = dot(best.to, across) > 0 ? 1 : -1;
    unit(across);
    /* on the surface itself the direction is undefined */
    const bool on = !(r > 1e-9 * m->size);
    for (int d = 0; d < 3; d++) {
        if (foot) foot[d] = x[d] - best.to[d];
        if (n) n[d] = on ? across[d] : sign * best.to[d] / r;
    }
    return sign * r;
}
