/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates. Each side has its own walls and shadows; walls at the foot of the plate are divided
 * between the sides. */
#include "geometry.h"
#include "angles.h"
#include <math.h>
#include <string.h>

/* Edges: in the liquid, on a wall with dummies behind it, on another plate. */
enum { EDGE_FREE = 0, EDGE_WALL = 1, EDGE_PLATE = 2 };

/* Nodes replace walls nearer than `same` [dp] along the plate and `in_plane` across it. The end of
 * a plate is on a wall nearer than `touching`; nodes that are not on the lattice keep the distance
 * `apart` from it. */
static const double same = 0.3, in_plane = 0.05, touching = 0.75, apart = 0.5;

/* Depth to which a plate occludes particles beside it in a wall at its foot [dp]; also the gap it
 * may leave there. */
static const double foot_depth = 2.5;

/* Area of an edge without thickness, relative to that of a particle: only its direction is
 * significant. */
static const double edge_area = 1e-6;

/* An existing particle: its position along the plate and above it [m]. */
typedef struct resident {
    int64_t i;
    double at[2], height;
} resident;

/* The particle of a node. */
typedef struct place {
    double X[3], area[3];
    int32_t kind, part, plate;
    int64_t resident; /* existing particle to be changed, -1: a new one */
} place;

typedef struct builder {
    mps_sim *sim;
    mps__plate_shape shape;
    int32_t dim, part, number; /* number: of the plate as occluder, + 1 */
    double dp;
    int32_t edge[2][2];
    bool closed[2][2]; /* the plate was extended by a node, up to the wall */
    resident *residents;
    place *places;
    int64_t resident_count, resident_capacity, place_count, place_capacity, fresh, taken;
} builder;

/* ---- existing particles ---- */

static double component(const double *v, const double *X, const double *corner, int dim)
{
    double sum = 0;
    for (int d = 0; d < dim; d++) sum += v[d] * (X[d] - corner[d]);
    return sum;
}

static bool locate(const builder *b, int64_t i, resident *out)
{
    const mps__world *w = &b->sim->world;
    const mps__plate_shape *s = &b->shape;
    const double reach = 4 * b->dp;
    double X[3];
    if (w->particles.kind[i] == MPS_FLUID)
        mps__motion_to_tank(&w->motion, &w->motion.now, w->particles.x + i * b->dim, X);
    else
        memcpy(X, w->particles.ref + i * b->dim, (size_t)b->dim * sizeof *X);
    *out = (resident){.i = i, .height = component(s->normal, X, s->corner, b->dim)};
    if (fabs(out->height) > reach) return false;
    for (int e = 0; e < 2; e++) {
        out->at[e] = component(s->along[e], X, s->corner, b->dim);
        if (out->at[e] < -reach || out->at[e] > (double)s->nodes[e] * s->spacing[e] + reach)
            return false;
    }
    return true;
}

static mps_status find_residents(builder *b)
{
    const mps__particles *s = &b->sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        resident r;
        if (mps__is_shadow(s, i) || !locate(b, i, &r)) continue;
        MPS__TRY(mps__grow(&b->sim->context, (void **)&b->residents, &b->resident_capacity,
                           b->resident_count, b->resident_count + 1, sizeof r));
        b->residents[b->resident_count++] = r;
    }
    return MPS_OK;
}

/* Distance along the plate, and above it, of an existing particle from a node of a column at
 * `height` [m]. */
static void distances(const builder *b, const resident *r, const int64_t node[2], double height,
                      double *along, double *above)
{
    *along = mps__hypot(r->at[0] - (double)node[0] * b->shape.spacing[0],
                        r->at[1] - (double)node[1] * b->shape.spacing[1]);
    *above = fabs(r->height - height);
}

static bool at_node(const builder *b, const resident *r, const int64_t node[2], double height)
{
    double along, above;
    distances(b, r, node, height, &along, &above);
    return along < same * b->dp && above < in_plane * b->dp;
}

/* Height of column c [m]. */
static double column_height(const builder *b, int32_t c)
{
    return (c - 0.5 * (b->shape.columns - 1)) * b->shape.across;
}

/* Kind of the edge at one of its nodes. */
static int32_t node_stands_on(const builder *b, const int64_t node[2], double height)
{
    const mps__particles *s = &b->sim->world.particles;
    for (int64_t k = 0; k < b->resident_count; k++) {
        const resident *r = &b->residents[k];
        double along, above;
        if (s->kind[r->i] != MPS_WALL) continue;
        distances(b, r, node, height, &along, &above);
        if (at_node(b, r, node, height) || mps__hypot(along, above) < touching * b->dp)
            return s->plate[r->i] ? EDGE_PLATE : EDGE_WALL;
    }
    return EDGE_FREE;
}

/* Kind of the whole edge at one end of direction e, evaluated `beyond` nodes further out. */
static int32_t edge_stands_on(const builder *b, int e, int end, int64_t beyond)
{
    const int64_t across = b->shape.nodes[1 - e];
    int32_t kind = EDGE_FREE;
    for (int64_t k = 0; k < across; k++)
        for (int32_t c = 0; c < b->shape.columns; c++) {
            int64_t node[2];
            node[e] = end ? b->shape.nodes[e] - 1 + beyond : -beyond;
            node[1 - e] = k;
            kind = node_stands_on(b, node, column_height(b, c));
            if (kind == EDGE_FREE) return EDGE_FREE;
        }
    return kind;
}

/* A plate on the lattice whose last node is next to a wall is extended to it. */
static void reach_wall(builder *b, int e, int end)
{
    if (b->shape.axis < 0 || edge_stands_on(b, e, end, 0) != EDGE_FREE ||
        edge_stands_on(b, e, end, 1) == EDGE_FREE)
        return;
    b->shape.nodes[e]++;
    b->closed[e][end] = true;
    if (end) return;
    for (int d = 0; d < b->dim; d++)
        b->shape.corner[d] -= b->shape.spacing[e] * b->shape.along[e][d];
    for (int64_t k = 0; k < b->resident_count; k++) b->residents[k].at[e] += b->shape.spacing[e];
}

static void find_edges(builder *b)
{
    for (int e = 0; e < b->dim - 1; e++)
        for (int end = 0; end < 2; end++) reach_wall(b, e, end);
    for (int e = 0; e < b->dim - 1; e++)
        for (int end = 0; end < 2; end++) b->edge[e][end] = edge_stands_on(b, e, end, 0);
}

/* ---- nodes ---- */

static mps_status add_place(builder *b, const place *p)
{
    MPS__TRY(mps__grow(&b->sim->context, (void **)&b->places, &b->place_capacity, b->place_count,
                       b->place_count + 1, sizeof *p));
    b->places[b->place_count++] = *p;
    return MPS_OK;
}

static void node_place(const builder *b, const int64_t node[2], double height, double X[3])
{
    for (int d = 0; d < b->dim; d++)
        X[d] = b->shape.corner[d] + height * b->shape.normal[d] +
               (double)node[0] * b->shape.spacing[0] * b->shape.along[0][d] +
               (double)node[1] * b->shape.spacing[1] * b->shape.along[1][d];
}

static bool on_edge(const builder *b, const int64_t node[2], int e, int end)
{
    return node[e] == (end ? b->shape.nodes[e] - 1 : 0);
}

/* Trapezoidal rule along direction e. */
static double share_along(const builder *b, const int64_t node[2], int e)
{
    if (e == 1 && b->dim == 2) return 1;
    return b->shape.spacing[e] *
           (b->shape.nodes[e] > 1 && (on_edge(b, node, e, 0) || on_edge(b, node, e, 1)) ? 0.5
                                                                                        : 1.0);
}

/* Area vector of the edges of the plate in the liquid; negligible for a plate of one column. */
static bool free_edges(const builder *b, const int64_t node[2], int32_t c, double area[3])
{
    const double thickness = b->shape.columns == 1
                                 ? edge_area * b->dp
                                 : b->shape.across *
                                       (c == 0 || c == b->shape.columns - 1 ? 0.5 : 1.0);
    bool any = false;
    for (int d = 0; d < 3; d++) area[d] = 0;
    for (int e = 0; e < b->dim - 1; e++)
        for (int end = 0; end < 2; end++) {
            if (b->edge[e][end] != EDGE_FREE || !on_edge(b, node, e, end)) continue;
            any = true;
            for (int d = 0; d < b->dim; d++)
                area[d] += (end ? 1 : -1) * thickness * share_along(b, node, 1 - e) *
                           b->shape.along[e][d];
        }
    return any;
}

/* Side of the wall of a column: -1, 1, or 0 between them. */
static int column_side(const builder *b, int32_t c)
{
    return c == b->shape.columns - 1 ? 1 : c == 0 ? -1 : 0;
}

static void add_face(const builder *b, const int64_t node[2], int side, double area[3])
{
    const double size = share_along(b, node, 0) * share_along(b, node, 1);
    for (int d = 0; d < b->dim; d++) area[d] += side * size * b->shape.normal[d];
}

/* Whether a wall at the plate's foot is in contact with liquid: its normal is along the plate.
 * Walls in its middle belong to a plate that it crosses. */
static bool looks_along(const builder *b, const int64_t node[2], const double *area)
{
    double inward = 0;
    bool foot = false;
    for (int e = 0; e < b->dim - 1; e++)
        for (int end = 0; end < 2; end++) {
            if (b->edge[e][end] == EDGE_FREE || !on_edge(b, node, e, end)) continue;
            foot = true;
            for (int d = 0; d < b->dim; d++)
                inward += (end ? -1 : 1) * b->shape.along[e][d] * area[d];
        }
    return !foot || inward > 0;
}

/* A wall at the foot of the plate: one column divides it into two; with more columns the outer ones
 * keep half of it and the middle is covered. */
static mps_status divide(builder *b, const int64_t node[2], int32_t c, int64_t i)
{
    const mps__particles *s = &b->sim->world.particles;
    const bool single = b->shape.columns == 1;
    double edges[3];
    const bool tip = free_edges(b, node, c, edges);
    place p = {.kind = MPS_WALL,
               .part = s->part[i],
               .plate = s->plate[i] ? s->plate[i] : b->number,
               .resident = i};
    if (!looks_along(b, node, s->area + i * b->dim) || (single && tip)) return MPS_OK;
    memcpy(p.X, s->ref + i * b->dim, (size_t)b->dim * sizeof *p.X);
    for (int side = single ? -1 : column_side(b, c); side <= (single ? 1 : column_side(b, c));
         side += single ? 2 : 1) {
        for (int d = 0; d < b->dim; d++)
            p.area[d] = (tip && side != 0 ? 0.75 : 0.5) * s->area[i * b->dim + d] +
                        (tip ? edges[d] : 0);
        add_face(b, node, side, p.area);
        if (side == 0 && !tip) {
            p.kind = MPS_DUMMY;
            p.plate = 0;
            memset(p.area, 0, sizeof p.area);
        }
        MPS__TRY(add_place(b, &p));
        p.resident = -1; /* the second half is new */
    }
    return MPS_OK;
}

/* A column's node at a position without a particle. */
static mps_status stand_free(builder *b, const int64_t node[2], int32_t c)
{
    place p = {.kind = MPS_WALL, .part = b->part, .plate = b->number, .resident = -1};
    double edges[3];
    const bool tip = free_edges(b, node, c, edges);
    node_place(b, node, column_height(b, c), p.X);
    b->fresh++;
    if (b->shape.columns == 1) {
        memcpy(p.area, edges, sizeof edges);
        if (tip) return add_place(b, &p);
        add_face(b, node, -1, p.area);
        MPS__TRY(add_place(b, &p));
        memset(p.area, 0, sizeof p.area);
        add_face(b, node, 1, p.area);
        return add_place(b, &p);
    }
    memcpy(p.area, edges, sizeof edges);
    add_face(b, node, column_side(b, c), p.area);
    if (column_side(b, c) == 0 && !tip) {
        p.kind = MPS_DUMMY;
        p.plate = 0; /* no shadow: visible from both sides */
    }
    return add_place(b, &p);
}

static mps_status fill_node(builder *b, const int64_t node[2], int32_t c)
{
    const mps__particles *s = &b->sim->world.particles;
    const double height = column_height(b, c);
    bool taken = false;
    for (int64_t k = 0; k < b->resident_count; k++) {
        const resident *r = &b->residents[k];
        double along, above;
        distances(b, r, node, height, &along, &above);
        taken = taken ||
                mps__hypot(along, above) < (b->shape.axis < 0 ? apart : 0.5 * (1 - 1e-9)) * b->dp;
        if (s->kind[r->i] == MPS_WALL && at_node(b, r, node, height))
            MPS__TRY(divide(b, node, c, r->i));
    }
    b->taken += taken;
    return taken ? MPS_OK : stand_free(b, node, c);
}

static mps_status fill_nodes(builder *b)
{
    int64_t node[2];
    for (node[1] = 0; node[1] < b->shape.nodes[1]; node[1]++)
        for (node[0] = 0; node[0] < b->shape.nodes[0]; node[0]++)
            for (int32_t c = 0; c < b->shape.columns; c++) MPS__TRY(fill_node(b, node, c));
    return MPS_OK;
}

/* Where walls displaced nodes, the other nodes get their area: the faces of a plate that is not on
 * the lattice keep its area. */
static void restore_area(builder *b)
{
    double sum = 0, wanted = 1;
    if (b->shape.axis >= 0) return;
    for (int e = 0; e < b->dim - 1; e++)
        wanted *= (double)(b->shape.nodes[e] - 1) * b->shape.spacing[e];
    for (int64_t k = 0; k < b->place_count; k++)
        sum += fmax(0, mps__dot(b->places[k].area, b->shape.normal, b->dim));
    for (int64_t k = 0; sum > 0 && k < b->place_count; k++) {
        const double across = mps__dot(b->places[k].area, b->shape.normal, b->dim);
        for (int d = 0; d < b->dim; d++)
            b->places[k].area[d] += across * (wanted / sum - 1) * b->shape.normal[d];
    }
}

/* Layers of shadows beyond an edge: those visible along a line that just passes it, and the depth
 * of a wall. */
static int64_t rows_beyond(const builder *b, int e, int end)
{
    if (e == 1 && b->dim == 2) return 0;
    return b->edge[e][end] == EDGE_WALL ? 2 : 1;
}

static mps_status cast_shadows(builder *b)
{
    const int64_t layers = (int64_t)fmax(2, floor(b->sim->world.setup.re_far / b->dp - 1 + 1e-6));
    place p = {.kind = MPS_DUMMY, .part = b->part, .plate = b->number, .resident = -1};
    int64_t node[2];
    for (node[1] = -rows_beyond(b, 1, 0); node[1] < b->shape.nodes[1] + rows_beyond(b, 1, 1);
         node[1]++)
        for (node[0] = -rows_beyond(b, 0, 0); node[0] < b->shape.nodes[0] + rows_beyond(b, 0, 1);
             node[0]++)
            for (int64_t k = 1; k <= layers; k++) {
                const double depth = (double)k * b->shape.across -
                                     column_height(b, b->shape.columns - 1);
                if (depth < 0.5 * in_plane * b->dp) continue; /* between the columns */
                for (int side = -1; side <= 1; side += 2) {
                    node_place(b, node, -side * depth, p.X);
                    MPS__TRY(add_place(b, &p));
                }
            }
    return MPS_OK;
}

/* ---- whole plate ---- */

static void set_occluder(const builder *b, mps__occluder *s)
{
    *s = (mps__occluder){
        .axis = b->shape.axis, .part = b->part, .columns = b->shape.columns, .active = true};
    memcpy(s->corner, b->shape.corner, sizeof s->corner);
    memcpy(s->normal, b->shape.normal, sizeof s->normal);
    memcpy(s->along, b->shape.along, sizeof s->along);
    for (int e = 0; e < 2; e++) {
        s->length[e] = (double)(b->shape.nodes[e] - 1) * b->shape.spacing[e];
        /* lines through the edge itself do not pass */
        s->from[e] = -(b->edge[e][0] == EDGE_WALL ? foot_depth : 1e-7) * b->dp;
        s->to[e] = s->length[e] + (b->edge[e][1] == EDGE_WALL ? foot_depth : 1e-7) * b->dp;
    }
}

static void put(builder *b, const place *p, int64_t i)
{
    mps__world *w = &b->sim->world;
    mps__particles *s = &w->particles;
    const bool fresh = p->resident < 0;
    memcpy(s->area + i * b->dim, p->area, (size_t)b->dim * sizeof *p->area);
    s->kind[i] = p->kind;
    s->part[i] = p->part;
    s->plate[i] = p->plate;
    if (!fresh) return;
    memcpy(s->ref + i * b->dim, p->X, (size_t)b->dim * sizeof *p->X);
    s->rho[i] = w->setup.phase_density[0];
    mps__motion_point(&w->motion, &w->motion.now, p->X, s->x + i * b->dim, NULL, NULL);
}

/* Fluid nearer than half a spacing to the rectangle of a column is an error. */
static mps_status check_fluid(const builder *b, const char *name)
{
    const mps__world *w = &b->sim->world;
    for (int64_t i = 0; i < w->particles.n; i++) {
        double X[3] = {0, 0, 0};
        if (w->particles.kind[i] != MPS_FLUID) continue;
        mps__motion_to_tank(&w->motion, &w->motion.now, w->particles.x + i * b->dim, X);
        const double above = component(b->shape.normal, X, b->shape.corner, b->dim);
        const double over = fmax(0, fabs(above) - column_height(b, b->shape.columns - 1));
        double square = over * over;
        for (int e = 0; e < b->dim - 1; e++) {
            const double at = component(b->shape.along[e], X, b->shape.corner, b->dim),
                         length = (double)(b->shape.nodes[e] - 1) * b->shape.spacing[e],
                         off = at < 0 ? at : fmax(0, at - length);
            square += off * off;
        }
        if (square < 0.25 * (1 - 1e-6) * b->dp * b->dp)
            return mps__in_the_way(b->sim, i, X, "plate", name);
    }
    return MPS_OK;
}

static mps_status build(builder *b, const char *name)
{
    mps__world *w = &b->sim->world;
    mps__context *c = &b->sim->context;
    int64_t fresh = 0;
    MPS__TRY(check_fluid(b, name));
    b->part = mps__part_number(&w->particles, name, true);
    MPS__CHECK(c, b->part >= 0, "part \"%s\" is one too many: at most %d", name, MPS__PARTS_MAX);
    MPS__TRY(find_residents(b));
    find_edges(b);
    MPS__TRY(fill_nodes(b));
    MPS__CHECK(c, b->fresh > 0, "all %lld points of plate \"%s\" are taken by other particles",
               (long long)b->taken, name);
    restore_area(b);
    MPS__TRY(cast_shadows(b));
    for (int64_t k = 0; k < b->place_count; k++) fresh += b->places[k].resident < 0;
    MPS__TRY(mps__occluders_reserve(&w->lists.occluders));
    MPS__TRY(mps__particles_reserve(&w->particles, fresh));
    int64_t next = mps__particles_append(&w->particles, fresh, MPS_WALL);
    for (int64_t k = 0; k < b->place_count; k++)
        put(b, &b->places[k], b->places[k].resident < 0 ? next++ : b->places[k].resident);
    mps__occluder occluder;
    set_occluder(b, &occluder);
    mps__occluders_add(&w->lists.occluders, &occluder);
    w->lists.neighbours.valid = false;
    return MPS_OK;
}

static void log_closed(const builder *b, const char *name)
{
    for (int e = 0; e < b->dim - 1; e++)
        for (int end = 0; end < 2; end++) {
            int64_t node[2] = {(b->shape.nodes[0] - 1) / 2, (b->shape.nodes[1] - 1) / 2};
            double X[3] = {0, 0, 0};
            if (!b->closed[e][end]) continue;
            node[e] = end ? b->shape.nodes[e] - 1 : 0;
            node_place(b, node, 0, X);
            mps__log(&b->sim->context, MPS_LOG_WARNING,
                     "the slot between \"%s\" and the wall at (%g, %g, %g) m is %g m wide, one "
                     "spacing: no particle fits in, the plate ends on the wall",
                     name, X[0], X[1], X[2], b->shape.spacing[e]);
        }
}

mps_status mps__geometry_plate(mps_sim *sim, const char *name, const mps__plate_shape *shape)
{
    const int32_t parts = sim->world.particles.parts;
    builder b = {.sim = sim,
                 .shape = *shape,
                 .dim = sim->world.setup.dim,
                 .dp = sim->world.setup.dp,
                 .number = sim->world.lists.occluders.count + 1};
    const mps_status status = build(&b, name);
    if (status >= 0) log_closed(&b, name);
    mps__free(&sim->context, b.residents);
    mps__free(&sim->context, b.places);
    if (status < 0) sim->world.particles.parts = parts;
    return status;
}
