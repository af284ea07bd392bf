/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids in the tank: plates with holes, boxes, cylinders, spheres, prisms, files. */
#include "build.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* [dp]: largest change of the faces of a box by the lattice; thinner boxes are no bodies of
 * arbitrary shape. */
static const double off_lattice = 0.1, thin_box = 3;

/* The solid being read. */
typedef struct reading {
    build *b;
    const tree_node *map;
    const char *name;
    build_solid *out;
} reading;

static void log_error(const reading *r, const char *key, const char *text)
{
    const tree_node *at = mps__tree_find(r->map, key);
    mps__case_log(r->b->c, at ? at : r->map, false, "solids.%s.%s: %s", r->name, key, text);
}

/* ---- plates ---- */

/* Slots of a plate: one of length `gap` in the middle of each `pitch` along its first side;
 * fractions of the side. */
typedef struct openings {
    int32_t count;
    double pitch, gap;
} openings;

/* A plate: a corner and one or two edges. */
typedef struct plate {
    double corner[3], edge[2][3], length[2];
    int32_t axis; /* normal axis of a plate on the lattice; -1: inclined */
    double thickness;
} plate;

/* The pitch is changed to the nearest one that divides the side. */
static openings read_openings(reading *r, const plate *p)
{
    openings o = {0};
    const tree_node *node = mps__tree_find(r->map, "holes");
    if (!node) return o;
    const double pitch = mps__read_number(r->b->c, node, "pitch", NAN),
                 open = mps__read_number(r->b->c, node, "open", NAN);
    if (mps__case_failed(r->b->c)) return o;
    o.count = (int32_t)fmax(1, round(p->length[0] / pitch));
    o.pitch = 1.0 / o.count;
    o.gap = open * o.pitch;
    r->out->slots = o.count;
    r->out->pitch = o.pitch * p->length[0];
    r->out->gap = o.gap * p->length[0];
    if (fmin(o.gap, o.pitch - o.gap) * p->length[0] < 2 * r->b->dp * (1 - 1e-9)) {
        char text[BUILD_TEXT];
        snprintf(text, sizeof text,
                 "slots of %.4g m with %.4g m between them: each must be at least 2 dp wide, %.4g "
                 "m; take a smaller dp or a larger pitch",
                 r->out->gap, r->out->pitch - r->out->gap, 2 * r->b->dp);
        log_error(r, "holes", text);
    }
    return o;
}

static int32_t flat_across(const plate *p, int dim)
{
    for (int d = 0; d < dim; d++) {
        const double off = fabs(p->edge[0][d]) + fabs(p->edge[1][d]);
        if (off < 1e-9 * (p->length[0] + p->length[1])) {
            int along = 0; /* number of edges along axes of the lattice */
            for (int e = 0; e < dim - 1; e++)
                for (int k = 0; k < dim; k++)
                    along += fabs(fabs(p->edge[e][k]) - p->length[e]) < 1e-9 * p->length[e];
            return along >= dim - 1 ? d : -1;
        }
    }
    return -1;
}

/* From two points in 2-D, two opposite corners or three corners in 3-D. Points without z span the
 * width. */
static bool read_plate(reading *r, plate *p)
{
    build *b = r->b;
    const tree_node *node = mps__tree_find(r->map, "plate");
    double x[3][3];
    *p = (plate){.axis = -1};
    const int32_t count = mps__build_points(b, node, NAN, 3, x);
    if (count < 2) return false; /* there is a message */
    const form *t = &b->tank.form;
    for (int32_t i = 0; i < count; i++)
        if (isnan(x[i][2])) x[i][2] = b->dim == 2 ? 0 : i == 0 ? t->lo[2] : t->hi[2];
    memcpy(p->corner, x[0], sizeof p->corner);
    for (int d = 0; d < 3; d++) {
        const double across = x[1][d] - x[0][d];
        if (count == 3) {
            p->edge[0][d] = across;
            p->edge[1][d] = x[2][d] - x[0][d];
        } else { /* opposite corners, edges along z and in x, y, or along x and y */
            const bool first = b->dim == 2 || (x[1][2] == x[0][2] ? d == 0 : d != 2);
            p->edge[first ? 0 : 1][d] = across;
        }
    }
    for (int e = 0; e < 2; e++)
        p->length[e] = sqrt(p->edge[e][0] * p->edge[e][0] + p->edge[e][1] * p->edge[e][1] +
                            p->edge[e][2] * p->edge[e][2]);
    if (!(p->length[0] > 0) || (b->dim == 3 && !(p->length[1] > 0))) {
        log_error(r, "plate", "has no area: its points are on one line");
        return false;
    }
    p->axis = flat_across(p, b->dim);
    p->thickness = mps__read_number(b->c, r->map, "thickness", 0);
    return !mps__case_failed(b->c);
}

/* The nearest plane of the lattice, including the walls of the tank. */
static double on_lattice(const double *origin, const double *h, int d, double x)
{
    /* midway between two planes the choice is independent of rounding */
    return origin[d] + floor((x - origin[d]) / h[d] + 0.5 + 1e-6) * h[d];
}

/* Ends of an edge of a plate on the lattice, as fractions of the requested edge. */
static void edge_built(const plate *p, int e, int dim, const double *built, double along[2])
{
    along[0] = along[1] = 0;
    for (int d = 0; d < dim; d++) {
        const double way = p->edge[e][d] / (p->length[e] * p->length[e]);
        const int near = way < 0;
        along[0] += way * (built[near * dim + d] - p->corner[d]);
        along[1] += way * (built[!near * dim + d] - p->corner[d]);
    }
}

/* Record a plate as built on the lattice: the part between two slots as fractions of the first
 * side, its second side, and its position along its normal. */
static void note_piece(reading *r, const plate *p, const double *built)
{
    build_solid *out = r->out;
    const int dim = r->b->dim;
    double along[2], second[2];
    edge_built(p, 0, dim, built, along);
    if (dim == 3) {
        edge_built(p, 1, dim, built, second);
        for (int end = 0; end < 2; end++)
            for (int d = 0; d < 3; d++) out->second[end][d] = second[end] * p->edge[1][d];
    }
    for (int end = 0; end < 2; end++)
        for (int d = 0; d < dim; d++)
            if (d == p->axis) out->end[end][d] = 0.5 * (built[d] + built[dim + d]);
    if (out->pieces == BUILD_PIECES) return;
    memcpy(out->piece[out->pieces++], along, sizeof along);
}

/* Round to whole columns of the lattice nearest to its position: n columns are n - 1 cells
 * thick. */
static bool add_flat(reading *r, const plate *p, const double *from, const double *to)
{
    build *b = r->b;
    double lo[3], hi[3], h[3], origin[3], built[6];
    if (!mps__build_try(b, mps_lattice_get(b->sim, origin, h), r->map, r->name)) return false;
    const int a = p->axis;
    const double columns = round(p->thickness / h[a]) + 1;
    for (int d = 0; d < b->dim; d++) {
        lo[d] = on_lattice(origin, h, d, fmin(from[d], to[d]));
        hi[d] = on_lattice(origin, h, d, fmax(from[d], to[d]));
    }
    lo[a] = origin[a] +
            floor((from[a] - origin[a]) / h[a] - 0.5 * (columns - 1) + 0.5 + 1e-6) * h[a];
    hi[a] = lo[a] + (columns - 1) * h[a];
    if (!mps__build_try(b, mps_baffle_add(b->sim, r->name, lo, hi, built), r->map, r->name))
        return false;
    note_piece(r, p, built);
    return true;
}

static bool add_piece(reading *r, const plate *p, const double *at, const double *size)
{
    double from[3], to[3], edge[2][3];
    for (int d = 0; d < 3; d++) {
        from[d] = to[d] = p->corner[d];
        for (int e = 0; e < 2 && p->length[e] > 0; e++) {
            from[d] += at[e] * p->edge[e][d];
            edge[e][d] = size[e] * p->edge[e][d];
            to[d] += (at[e] + size[e]) * p->edge[e][d];
        }
    }
    if (p->axis >= 0) return add_flat(r, p, from, to);
    return mps__build_try(
        r->b, mps_plate_add(r->b->sim, r->name, from, edge[0], r->b->dim == 3 ? edge[1] : NULL),
        r->map, r->name);
}

static void add_plate(reading *r)
{
    plate p;
    if (!read_plate(r, &p)) return;
    const openings o = read_openings(r, &p);
    if (mps__case_failed(r->b->c)) return;
    r->out->plate = true;
    for (int d = 0; d < 3; d++) {
        r->out->asked[0][d] = r->out->end[0][d] = p.corner[d];
        r->out->end[1][d] = p.corner[d] + p.edge[0][d];
        r->out->second[1][d] = p.edge[1][d];
        r->out->asked[1][d] = r->out->end[1][d] + p.edge[1][d];
    }
    if (p.axis >= 0) r->out->why = "plates along axes are on the lattice";
    double begin = 0;
    for (int32_t i = 0; i <= o.count && !mps__case_failed(r->b->c); i++) {
        const double end = i < o.count ? (i + 0.5) * o.pitch - 0.5 * o.gap : 1;
        const double at[2] = {begin, 0}, size[2] = {end - begin, 1};
        add_piece(r, &p, at, size);
        begin = end + o.gap;
    }
}

void mps__solid_piece(const build_solid *s, int32_t i, double part[2])
{
    const double pitch = s->slots > 0 ? 1.0 / s->slots : 1,
                 gap = s->slots > 0 ? pitch * s->gap / s->pitch : 0;
    part[0] = i > 0 ? (i - 0.5) * pitch + 0.5 * gap : 0;
    part[1] = i < s->slots ? (i + 0.5) * pitch - 0.5 * gap : 1;
    if (i < s->pieces) memcpy(part, s->piece[i], sizeof s->piece[i]);
}

/* ---- bodies ---- */

/* Faces of a box that touch walls of a rectangular tank are extended through them: walls below the
 * box are then inside it, and not wetted. */
static void enter_walls(const build *b, form *s)
{
    const form *t = &b->tank.form;
    if (t->kind != FORM_BOX || b->tank.file) return;
    for (int d = 0; d < b->dim; d++) {
        if (s->lo[d] < t->lo[d] + 0.5 * b->dp) s->lo[d] = t->lo[d] - thin_box * b->dp;
        if (s->hi[d] > t->hi[d] - 0.5 * b->dp) s->hi[d] = t->hi[d] + thin_box * b->dp;
    }
}

/* A body of arbitrary shape. Its bounding box extends slightly beyond its surface, and is clipped
 * near the tank. */
static void add_body(reading *r, const char *key)
{
    mps_solid solid;
    if (mps__case_failed(r->b->c)) return;
    mps__form_box(&r->out->form);
    form s = r->out->form;
    if (s.kind == FORM_BOX) enter_walls(r->b, &s);
    mps_solid_init(&solid, sizeof solid);
    solid.name = r->name;
    solid.distance = mps__form_body;
    solid.user = &s;
    for (int d = 0; d < 3; d++) {
        solid.lo[d] = s.lo[d] - r->b->dp;
        solid.hi[d] = s.hi[d] + r->b->dp;
    }
    mps__build_try(r->b, mps_solid_add(r->b->sim, &solid), mps__tree_find(r->map, key), r->name);
}

/* Whether a box on the lattice has its size within a tenth of a spacing, or is too thin for a body;
 * then its corners on the lattice. */
static bool box_on_lattice(const reading *r, const form *box, double *lo, double *hi)
{
    const build *b = r->b;
    double h[3], origin[3];
    bool near = true, thin = false;
    if (mps_lattice_get(b->sim, origin, h) != MPS_OK) return true; /* the baffle is refused */
    for (int d = 0; d < b->dim; d++) {
        const double from = box->lo[d], to = box->hi[d];
        lo[d] = fmax(b->tank.form.lo[d], on_lattice(origin, h, d, from));
        hi[d] = fmin(b->tank.form.hi[d], on_lattice(origin, h, d, to));
        near = near && (from <= b->tank.form.lo[d] || fabs(lo[d] - from) <= off_lattice * b->dp);
        near = near && (to >= b->tank.form.hi[d] || fabs(hi[d] - to) <= off_lattice * b->dp);
        thin = thin || to - from < thin_box * b->dp;
    }
    if (!near && thin) r->out->why = "boxes thinner than 3 dp are on the lattice";
    return near || thin;
}

static void add_box(reading *r)
{
    build *b = r->b;
    double x[2][3];
    const tree_node *node = mps__tree_find(r->map, "box");
    if (mps__build_points(b, node, NAN, 2, x) != 2) return;
    form *s = &r->out->form;
    for (int d = 0; d < 3; d++) {
        if (isnan(x[0][d])) x[0][d] = b->tank.form.lo[d];
        if (isnan(x[1][d])) x[1][d] = b->tank.form.hi[d];
        s->lo[d] = fmin(x[0][d], x[1][d]);
        s->hi[d] = fmax(x[0][d], x[1][d]);
    }
    memcpy(r->out->asked[0], s->lo, sizeof s->lo);
    memcpy(r->out->asked[1], s->hi, sizeof s->hi);
    r->out->box = true;
    double lo[3], hi[3], built[6];
    memcpy(lo, s->lo, sizeof lo);
    memcpy(hi, s->hi, sizeof hi);
    if (!box_on_lattice(r, s, lo, hi)) {
        add_body(r, "box");
        return;
    }
    if (!mps__build_try(b, mps_baffle_add(b->sim, r->name, lo, hi, built), node, r->name)) return;
    memcpy(s->lo, built, (size_t)b->dim * sizeof *built);
    memcpy(s->hi, built + b->dim, (size_t)b->dim * sizeof *built);
}

static void add_cylinder(reading *r)
{
    form *s = &r->out->form;
    const tree_node *node = mps__tree_find(r->map, "cylinder");
    s->kind = FORM_ROD;
    mps__read_numbers(r->b->c, node, "from", 3, s->end[0]);
    mps__read_numbers(r->b->c, node, "to", 3, s->end[1]);
    s->radius = mps__read_number(r->b->c, node, "radius", NAN);
    const double *from = s->end[0], *to = s->end[1];
    if (from[0] == to[0] && from[1] == to[1] && from[2] == to[2] && !mps__case_failed(r->b->c))
        log_error(r, "cylinder", "has no length: 'from' and 'to' are one point");
    if (r->b->dim == 2 && !mps__case_failed(r->b->c))
        log_error(r, "cylinder", "is for 3-D; in 2-D take 'sphere', a circle");
    add_body(r, "cylinder");
}

static void add_sphere(reading *r)
{
    form *s = &r->out->form;
    const tree_node *node = mps__tree_find(r->map, "sphere");
    s->kind = FORM_BALL;
    s->end[0][2] = mps__build_middle(r->b);
    mps__read_numbers(r->b->c, node, "centre", 3, s->end[0]);
    s->radius = mps__read_number(r->b->c, node, "radius", NAN);
    add_body(r, "sphere");
}

static void add_prism(reading *r)
{
    build *b = r->b;
    form *s = &r->out->form;
    double z[2] = {b->tank.form.lo[2], b->tank.form.hi[2]};
    mps__build_polygon(b, mps__tree_find(r->map, "prism"), s);
    mps__read_numbers(b->c, r->map, "between", 2, z);
    s->lo[2] = z[0];
    s->hi[2] = z[1];
    add_body(r, "prism");
}

static void add_file(reading *r)
{
    double box[6];
    mps_stl stl;
    if (!mps__build_stl(r->b, r->map, &stl)) return;
    stl.name = r->name;
    r->out->file = true;
    const char *path = mps__read_path(r->b->c, r->map, "stl");
    if (!path) return;
    if (!mps__build_try(r->b, mps_stl_add(r->b->sim, path, &stl, box),
                        mps__tree_find(r->map, "stl"), r->name))
        return;
    memcpy(r->out->form.lo, box, sizeof r->out->form.lo);
    memcpy(r->out->form.hi, box + 3, sizeof r->out->form.hi);
}

/* ---- all ---- */

/* The library refuses a part beyond the 64th, of which at least one is the tank: the array holds
 * all solids. */
static void add_solid(build *b, const tree_node *map)
{
    static const char *const kind[] = {"plate", "box", "cylinder", "sphere", "prism", "stl"};
    static void (*const add[])(reading *) = {add_plate,  add_box,   add_cylinder,
                                             add_sphere, add_prism, add_file};
    reading r = {b, map, map->key, &b->solid[b->solids++]};
    *r.out = (build_solid){.form.dim = b->dim};
    snprintf(r.out->name, sizeof r.out->name, "%s", map->key);
    add[mps__build_kind(map, kind, 6)](&r);
}

void mps__build_solids(build *b)
{
    const tree_node *map = mps__tree_find(b->root, "solids");
    for (const tree_node *at = map ? map->first : NULL; at && !mps__case_failed(b->c);
         at = at->next)
        add_solid(b, at);
}
