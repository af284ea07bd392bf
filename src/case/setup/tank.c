/* SPDX-License-Identifier: BSD-3-Clause */
/* Tanks: boxes, chamfered boxes, polygons, cylinders, spheres, files. */
#include "build.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

int32_t mps__build_points(build *b, const tree_node *node, double z, int32_t most, double (*out)[3])
{
    int32_t count = 0;
    const tree_node *at = node && node->kind == TREE_LIST ? node->first : node;
    mps__read_all(node);
    for (; at; at = at->next) {
        if (count == most) {
            mps__case_log(b->c, at, false, "one point too many: at most %d", (int)most);
            return 0;
        }
        double *x = out[count++];
        x[2] = z;
        if (mps__read_values(b->c, at, 3, x) < 3) x[2] = z;
        if (at == node) break;
    }
    return mps__case_failed(b->c) ? 0 : count;
}

void mps__build_polygon(build *b, const tree_node *node, form *s)
{
    double point[FORM_POINTS][3], at[2];
    int32_t side[2];
    char path[PATH_CAPACITY];
    s->kind = FORM_POLYGON;
    const int32_t given = s->points = mps__build_points(b, node, 0, FORM_POINTS, point);
    for (int32_t i = 0; i < s->points; i++) memcpy(s->point[i], point[i], sizeof s->point[i]);
    if (mps__case_failed(b->c)) return;
    mps__form_polygon_clean(s);
    mps__tree_path(node, path, sizeof path);
    if (s->points < 3) {
        mps__case_log(b->c, node, false, "%s: %d of %d points differ; at least 3 are needed", path,
                      (int)s->points, (int)given);
    } else if (mps__form_polygon_crosses(s, side, at)) {
        const double *p = s->point[side[0]], *q = s->point[(side[0] + 1) % s->points],
                     *r = s->point[side[1]], *t = s->point[(side[1] + 1) % s->points];
        const tree_node *line = node->first; /* line of the point where the first side begins */
        for (int32_t i = 0; i < given && (point[i][0] != p[0] || point[i][1] != p[1]); i++)
            line = line->next;
        mps__case_log(b->c, line, false,
                      "%s: the side from (%g, %g) to (%g, %g) m meets the side from (%g, %g) to "
                      "(%g, %g) m at (%.4g, %.4g) m; list the points in their order along the "
                      "outline",
                      path, p[0], p[1], q[0], q[1], r[0], r[1], t[0], t[1], at[0], at[1]);
    }
}

int mps__build_kind(const tree_node *map, const char *const *kind, int count)
{
    int k = 0;
    while (k + 1 < count && !mps__tree_find(map, kind[k])) k++;
    return k;
}

double mps__build_middle(const build *b)
{
    return b->dim == 3 ? 0.5 * (b->tank.form.lo[2] + b->tank.form.hi[2]) : 0;
}

/* ---- shapes ---- */

static void read_size(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    double size[3] = {0};
    const int32_t given = mps__read_numbers(b->c, map, "size", 3, size);
    mps__read_numbers(b->c, map, "at", 3, s->lo);
    if (given < b->dim)
        mps__case_log(b->c, mps__tree_find(map, "size"), false,
                      "tank.size: %d numbers are needed in %d-D", (int)b->dim, (int)b->dim);
    memcpy(b->tank.size, size, sizeof size);
    for (int d = 0; d < 3; d++) s->hi[d] = s->lo[d] + size[d];
}

/* Height of the layers: in a tank of arbitrary shape cells divide its box along the horizontal axes
 * and keep the volume of a particle. */
static double row_height(const build *b, const tree_node *map)
{
    double height = b->dp;
    if (!mps__tree_find(map, "chamfer")) return height;
    for (int d = 0; d < b->dim; d += 2)
        height *= round(b->tank.size[d] / b->dp) * b->dp / b->tank.size[d];
    return height;
}

/* Two fluids meet at this height: it is midway between two layers of the lattice, and the tank
 * extends as far up as down from it. */
static void lay_about(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    if (!mps__tree_find(map, "between_rows")) return;
    const double h = row_height(b, map);
    const double middle = mps__read_number(b->c, map, "between_rows", NAN),
                 size = s->hi[1] - s->lo[1];
    const double half = (floor(size / 2 / h + 1e-6) + 0.5) * h;
    s->lo[1] = middle - half;
    b->tank.size[1] = 2 * half;
    s->hi[1] = s->lo[1] + b->tank.size[1];
}

/* Chamfer the corners of the box: run along x, rise along y. */
static void read_chamfer(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    const tree_node *node = mps__tree_find(map, "chamfer");
    if (!node) return;
    double cut[2][2] = {{0}};
    static const char *const key[] = {"bottom", "top"};
    for (int i = 0; i < 2; i++)
        if (mps__read_numbers(b->c, node, key[i], 2, cut[i]) == 1) cut[i][1] = cut[i][0];
    s->sideways = b->dim == 3 && mps__read_choice(b->c, node, "across", 0) == 1;
    const int k = s->sideways ? 2 : 0;
    const double x0 = s->lo[k], x1 = s->hi[k], y0 = s->lo[1], y1 = s->hi[1];
    if (2 * fmax(cut[0][0], cut[1][0]) > x1 - x0 || cut[0][1] + cut[1][1] > y1 - y0)
        mps__case_log(b->c, node, false, "tank.chamfer: larger than the tank, %g x %g m", x1 - x0,
                      y1 - y0);
    const double corner[8][2] = {{x0 + cut[0][0], y0}, {x1 - cut[0][0], y0}, {x1, y0 + cut[0][1]},
                                 {x1, y1 - cut[1][1]}, {x1 - cut[1][0], y1}, {x0 + cut[1][0], y1},
                                 {x0, y1 - cut[1][1]}, {x0, y0 + cut[0][1]}};
    for (int i = 0; i < 8; i++) { /* without coincident points where a chamfer is 0 */
        const double *last = s->points ? s->point[s->points - 1] : corner[7];
        if (hypot(corner[i][0] - last[0], corner[i][1] - last[1]) < 1e-9 * (x1 - x0)) continue;
        memcpy(s->point[s->points++], corner[i], sizeof corner[i]);
    }
    s->kind = FORM_POLYGON;
}

static void read_polygon(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    const tree_node *node = mps__tree_find(map, "polygon");
    mps__build_polygon(b, node, s);
    s->hi[2] = mps__read_number(b->c, map, "width", 0);
    if (mps__case_failed(b->c)) return;
    mps__form_box(s);
    if (b->dim == 3 && !(s->hi[2] > 0))
        mps__case_log(b->c, node, false, "tank.width: is needed in 3-D, e.g. '2 m'");
}

/* Lowest point at y = 0, one end at 0 of its axis, the middle at 0 of the third. */
static void read_cylinder(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    const tree_node *node = mps__tree_find(map, "cylinder");
    s->kind = b->dim == 3 ? FORM_TUBE : FORM_BALL;
    s->radius = mps__read_number(b->c, node, "radius", NAN);
    s->length = mps__read_number(b->c, node, "length", 0);
    s->heads = mps__read_number(b->c, node, "heads", 0);
    s->axis = mps__read_choice(b->c, node, "axis", 0);
    for (int d = 0; d < 3; d++) {
        const bool along = d == s->axis, up = d == 1;
        s->lo[d] = along || up ? 0 : -s->radius;
        s->hi[d] = along ? s->length + 2 * s->heads : up ? 2 * s->radius : s->radius;
    }
    if (b->dim == 3 && !mps__case_failed(b->c) && !(s->hi[s->axis] > 0))
        mps__case_log(b->c, node, false, "tank.cylinder.length: is needed in 3-D");
    for (int d = 0; b->dim == 2 && d < 2; d++) s->end[0][d] = s->lo[d] = s->radius;
    if (b->dim == 2) mps__form_box(s);
}

static void read_ball(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    s->kind = FORM_BALL;
    s->radius = mps__read_number(b->c, mps__tree_find(map, "sphere"), "radius", NAN);
    for (int d = 0; d < 2; d++) s->end[0][d] = s->radius;
    mps__form_box(s);
}

/* ---- files ---- */

bool mps__build_stl(build *b, const tree_node *map, mps_stl *stl)
{
    /* rotations of the axis of the file to +y */
    static const double turn[3][3] = {{0, 0, 1}, {0, 0, 0}, {-1, 0, 0}};
    const double quarter = 0.5 * acos(-1.0);
    double angle[3] = {0};
    mps_stl_init(stl, sizeof *stl);
    stl->scale = mps__read_unit(b->c, map, "unit", 1);
    const int32_t up = mps__read_choice(b->c, map, "up", 1);
    const bool turned = mps__read_numbers(b->c, map, "turn", 3, angle) > 0;
    if (turned && mps__tree_find(map, "up"))
        mps__case_log(b->c, mps__tree_find(map, "turn"), false, "give 'up' or 'turn', not both");
    for (int d = 0; d < 3; d++) stl->rotation[d] = turned ? angle[d] : quarter * turn[up][d];
    mps__read_numbers(b->c, map, "shift", 3, stl->shift);
    return !mps__case_failed(b->c);
}

static void add_file(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    const tree_node *node = mps__tree_find(map, "stl");
    static const int32_t side[] = {MPS_SIDE_NONE, MPS_SIDE_Y1, MPS_SIDE_X0, MPS_SIDE_X1,
                                   MPS_SIDE_Y0,   MPS_SIDE_Z0, MPS_SIDE_Z1};
    double box[6];
    mps_stl stl;
    b->tank.file = true;
    if (!mps__build_stl(b, map, &stl)) return;
    stl.name = "tank";
    stl.dummy_layers = (int32_t)mps__read_number(b->c, map, "dummies", stl.dummy_layers);
    stl.container = 1;
    stl.open_side = side[b->tank.open];
    const char *path = mps__read_path(b->c, map, "stl");
    if (!path || !mps__build_try(b, mps_stl_add(b->sim, path, &stl, box), node, "tank")) return;
    memcpy(s->lo, box, sizeof s->lo);
    memcpy(s->hi, box + 3, sizeof s->hi);
}

/* ---- all ---- */

static void add_box(build *b, const tree_node *map)
{
    const form *s = &b->tank.form;
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < 3; d++) {
        tank.lo[d] = s->lo[d];
        tank.size[d] = b->tank.size[d];
    }
    tank.open_top = b->tank.open == 1;
    tank.dummy_layers = (int32_t)mps__read_number(b->c, map, "dummies", tank.dummy_layers);
    if (b->tank.open > 1)
        mps__case_log(b->c, mps__tree_find(map, "open"), false,
                      "tank.open: of a box only the top can be open");
    else
        mps__build_try(b, mps_tank_add(b->sim, &tank, b->tank.built), map, "tank");
}

static void add_shape(build *b, const tree_node *map)
{
    form *s = &b->tank.form;
    mps_solid solid;
    if (b->tank.open) {
        mps__case_log(b->c, mps__tree_find(map, "open"), false,
                      "tank.open: only a rectangular tank can be open at its top");
        return;
    }
    mps_solid_init(&solid, sizeof solid);
    solid.dummy_layers = (int32_t)mps__read_number(b->c, map, "dummies", solid.dummy_layers);
    solid.name = "tank";
    solid.distance = mps__form_container;
    solid.user = s;
    memcpy(solid.lo, s->lo, sizeof solid.lo);
    memcpy(solid.hi, s->hi, sizeof solid.hi);
    mps__build_try(b, mps_solid_add(b->sim, &solid), map, "tank");
}

void mps__build_tank(build *b)
{
    static const char *const kind[] = {"size", "polygon", "cylinder", "sphere", "stl"};
    static void (*const read[])(build *, const tree_node *) = {read_size, read_polygon,
                                                               read_cylinder, read_ball, add_file};
    const tree_node *map = mps__tree_find(b->root, "tank");
    const int chosen = mps__build_kind(map, kind, 5);
    b->tank.at = map;
    b->tank.form.dim = b->dim;
    if (mps__case_failed(b->c)) return;
    b->tank.open = mps__read_choice(b->c, map, "open", 0);
    read[chosen](b, map);
    if (chosen == 0) lay_about(b, map);
    if (chosen == 0) read_chamfer(b, map);
    if (mps__case_failed(b->c) || b->tank.file) return;
    if (b->tank.form.kind == FORM_BOX)
        add_box(b, map);
    else
        add_shape(b, map);
}
