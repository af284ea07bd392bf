/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of mps/geometry.h: argument checks, then solid.c. */
#include "geometry.h"
#include "angles.h"
#include "solid.h"
#include "stl.h"
#include <math.h>
#include <string.h>

/* Widest gap of a surface that is closed automatically [dp]. */
static const double gap_share = 0.01;

static const mps_solid solid_defaults = {.name = "solid", .dummy_layers = 2};
static const mps_stl stl_defaults = {.name = "solid", .dummy_layers = 2, .scale = 1};

/* Lattice points of the box must be distinguishable. */
static mps_status check_corner(mps_sim *sim, const char *what, const double *lo)
{
    for (int d = 0; d < sim->world.setup.dim; d++)
        MPS__TRY(mps__place_resolved(sim, what, d, lo[d]));
    return MPS_OK;
}

static mps_status check_name(mps_sim *sim, const char *type, const char *name, int32_t layers,
                             char *copy)
{
    MPS__CHECK(&sim->context, mps__name_copy(copy, MPS__PART_NAME, name),
               "%s.name \"%.40s\": must have 1..%d characters", type, name, MPS__PART_NAME - 1);
    MPS__CHECK(&sim->context, layers >= 1 && layers <= 8, "%s.dummy_layers is %d: must be 1..8",
               type, (int)layers);
    return MPS_OK;
}

static mps_status check_solid(mps_sim *sim, const mps_solid *s)
{
    mps__context *c = &sim->context;
    MPS__CHECK(c, s->distance || s->inside, "solid \"%s\" has neither a distance nor an inside",
               s->name);
    MPS__CHECK(c, !s->distance || !s->inside,
               "solid \"%s\" has both a distance and an inside: must be one of them", s->name);
    MPS__CHECK(c, s->invert == 0 || s->invert == 1, "solid.invert is %d: must be 0 or 1",
               (int)s->invert);
    for (int d = 0; d < sim->world.setup.dim; d++) {
        MPS__CHECK(c, isfinite(s->lo[d]) && isfinite(s->hi[d]),
                   "the solid's box [%d] is %g .. %g: must be finite", d, s->lo[d], s->hi[d]);
        MPS__CHECK(c, s->hi[d] - s->lo[d] >= (1 - 1e-6) * sim->world.setup.dp,
                   "the solid's box [%d] is %g .. %g: must be at least dp = %g m long", d, s->lo[d],
                   s->hi[d], sim->world.setup.dp);
    }
    return check_corner(sim, "solid.lo", s->lo);
}

mps_status mps_solid_init(mps_solid *solid, size_t size)
{
    return mps__struct_init("mps_solid", solid, size, &solid_defaults, sizeof solid_defaults);
}

mps_status mps_solid_add(mps_sim *sim, const mps_solid *solid)
{
    MPS__BUILDS(sim);
    mps_solid s = solid_defaults;
    char name[MPS__PART_NAME];
    MPS__TRY(mps__solids_allowed(sim));
    MPS__TRY(mps__struct_in(&sim->context, "mps_solid", &s, sizeof s, solid));
    if (s.name == NULL) s.name = solid_defaults.name;
    if (s.dummy_layers == 0) s.dummy_layers = solid_defaults.dummy_layers;
    MPS__TRY(check_name(sim, "solid", s.name, s.dummy_layers, name));
    MPS__TRY(check_solid(sim, &s));
    mps__solid add = {.name = name, .layers = s.dummy_layers};
    add.shape = (mps__shape){.dim = sim->world.setup.dim,
                             .dp = sim->world.setup.dp,
                             .sign = s.invert ? -1 : 1,
                             .distance = s.distance,
                             .inside = s.inside,
                             .user = s.user};
    memcpy(add.lo, s.lo, (size_t)sim->world.setup.dim * sizeof(double));
    memcpy(add.hi, s.hi, (size_t)sim->world.setup.dim * sizeof(double));
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "a callback of a solid");
    const mps_status status = mps__solid_add(sim, &add);
    sim->context.lock = before;
    return status;
}

/* ---- STL ---- */

mps_status mps_stl_init(mps_stl *stl, size_t size)
{
    return mps__struct_init("mps_stl", stl, size, &stl_defaults, sizeof stl_defaults);
}

static mps_status check_stl(mps_sim *sim, const char *path, const mps_stl *s)
{
    mps__context *c = &sim->context;
    MPS__CHECK(c, sim->world.setup.dim == 3, "an STL file needs 3-D: this simulation is 2-D");
    MPS__CHECK(c, path && path[0], "the path of the STL file is %s", path ? "empty" : "NULL");
    MPS__CHECK(c, isfinite(s->scale) && s->scale > 0, "stl.scale is %g: must be > 0", s->scale);
    MPS__CHECK(c, mps__finite(s->shift, 3), "stl.shift is (%g, %g, %g) m: must be finite",
               s->shift[0], s->shift[1], s->shift[2]);
    MPS__CHECK(c, mps__finite(s->rotation, 3), "stl.rotation is (%g, %g, %g) rad: must be finite",
               s->rotation[0], s->rotation[1], s->rotation[2]);
    MPS__CHECK(c, s->container == 0 || s->container == 1, "stl.container is %d: must be 0 or 1",
               (int)s->container);
    MPS__CHECK(c, s->open_side >= MPS_SIDE_NONE && s->open_side <= MPS_SIDE_Z1,
               "stl.open_side is %d: must be MPS_SIDE_NONE (0) .. MPS_SIDE_Z1 (%d)",
               (int)s->open_side, MPS_SIDE_Z1);
    MPS__CHECK(c, s->container || s->open_side == MPS_SIDE_NONE,
               "stl.open_side is %d: a body has none, set container to 1 or open_side to 0",
               (int)s->open_side);
    return MPS_OK;
}

/* Quarter turns have exact zeros. */
static void cosine_sine(double angle, double *cosine, double *sine)
{
    const double quarters = angle / (0.5 * MPS__PI), whole = round(quarters);
    static const double table[] = {1, 0, -1, 0};
    *cosine = mps__cos(angle);
    *sine = mps__sin(angle);
    if (fabs(quarters - whole) > 1e-12 || fabs(whole) > 1e6) return;
    const int k = (int)((int64_t)whole & 3);
    *cosine = table[k];
    *sine = table[(k + 3) % 4];
}

/* Rotate a point about the axes x, y and z, in this order. */
static void turn_point(const double rotation[3], double *x)
{
    for (int axis = 0; axis < 3; axis++) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double first = x[a], second = x[b];
        double cosine, sine;
        if (rotation[axis] == 0) continue;
        cosine_sine(rotation[axis], &cosine, &sine);
        x[a] = cosine * first - sine * second;
        x[b] = sine * first + cosine * second;
    }
}

/* Scale, rotate and shift; lo and hi become the bounding box. */
static void place_mesh(mps__mesh *m, const mps_stl *s, double *lo, double *hi)
{
    for (int64_t k = 0; k < m->points; k++) turn_point(s->rotation, m->x + 3 * k);
    for (int64_t k = 0; k < 3 * m->points; k++) m->x[k] = m->x[k] * s->scale + s->shift[k % 3];
    mps__mesh_box(m, lo, hi);
}

static void log_notes(mps__context *c, const char *path, const mps__stl_notes *n)
{
    if (n->tail > 0)
        mps__log(c, MPS_LOG_WARNING, "\"%.200s\": %lld bytes behind the last triangle are ignored",
                 path, (long long)n->tail);
    if (n->no_end) mps__log(c, MPS_LOG_WARNING, "\"%.200s\" has no \"endsolid\" at its end", path);
}

static void log_faults(mps__context *c, const char *path, const mps__mesh_faults *f,
                       double tolerance)
{
    if (f->degenerate > 0)
        mps__log(c, MPS_LOG_INFO, "\"%.200s\": %lld triangles have no area", path,
                 (long long)f->degenerate);
    if (f->twice > 0)
        mps__log(c, MPS_LOG_WARNING,
                 "\"%.200s\": %lld triangles are there twice: each is used once", path,
                 (long long)f->twice);
    if (f->joined > 0)
        mps__log(c, MPS_LOG_WARNING,
                 "\"%.200s\" has gaps of up to %.2g m: %lld point%s at open edges joined with a "
                 "point nearby; gaps of up to %g m, 0.01 dp, are closed",
                 path, f->gap, (long long)f->joined, f->joined == 1 ? " is" : "s are", tolerance);
}

/* Log possible mistakes: thick walls, several tanks in one file, overlapping parts. */
static mps_status log_shells(const mps__mesh *m, const char *path, bool container)
{
    mps__context *c = m->context;
    mps__mesh_shells s;
    MPS__TRY(mps__mesh_find_shells(m, &s));
    if (s.wrong > 0)
        mps__log(c, MPS_LOG_WARNING,
                 "\"%.200s\" encloses %.2g %% of its box not once, e.g. (%.4g, %.4g, %.4g) m %g "
                 "times: surfaces overlap or cross; unite the parts before the export",
                 path, 100 * (double)s.wrong / (double)s.places, s.wrong_at[0], s.wrong_at[1],
                 s.wrong_at[2], s.times);
    if (s.within > 0)
        mps__log(c, MPS_LOG_WARNING,
                 "\"%.200s\" has %lld closed surfaces, %lld of them within another one: %s is "
                 "between them, e.g. between %.4g and %.4g m3%s",
                 path, (long long)s.count, (long long)s.within,
                 container ? "the liquid" : "the solid", s.inner, s.outer,
                 container ? "; of a tank with thick walls export the inner surface alone" : "");
    else if (s.count > 1)
        mps__log(c, container ? MPS_LOG_WARNING : MPS_LOG_INFO,
                 "\"%.200s\" has %lld closed surfaces apart from each other%s", path,
                 (long long)s.count,
                 container ? ": the level is that of all of them, and natural periods are those of "
                             "one tank of the size of their box"
                           : "");
    return MPS_OK;
}

/* A closed surface whose normals point to the liquid, ready for distances. */
static mps_status prepare_mesh(mps_sim *sim, mps__mesh *m, const char *path, bool container)
{
    mps__context *c = &sim->context;
    mps__mesh_faults f;
    const double tolerance = gap_share * sim->world.setup.dp;
    MPS__TRY(mps__mesh_weld(m, tolerance, &f));
    MPS__CHECK(c, m->elements > 0, "\"%.200s\" has no triangle with an area", path);
    MPS__CHECK(c, f.open == 0,
               "\"%.200s\" is not closed: %lld edges have no second triangle, the first is at (%g, "
               "%g, %g) m; gaps of up to %g m, 0.01 dp, would be closed",
               path, (long long)f.open, f.open_at[0], f.open_at[1], f.open_at[2], tolerance);
    MPS__CHECK(c, f.turned == 0,
               "\"%.200s\" is not oriented: at %lld edges a triangle is turned over, the first is "
               "at (%g, %g, %g) m",
               path, (long long)f.turned, f.turned_at[0], f.turned_at[1], f.turned_at[2]);
    const double volume = mps__mesh_volume(m);
    log_faults(c, path, &f, tolerance);
    MPS__TRY(log_shells(m, path, container));
    if (volume < 0) mps__log(c, MPS_LOG_INFO, "\"%.200s\" is inside out: turned over", path);
    if ((volume < 0) != container) mps__mesh_turn(m);
    return mps__mesh_finish(m);
}

static mps_status add_mesh(mps_sim *sim, const char *path, const mps_stl *s, mps__mesh *m,
                           double built[6])
{
    mps__solid add = {.name = s->name, .layers = s->dummy_layers, .open = s->open_side};
    place_mesh(m, s, add.lo, add.hi);
    MPS__CHECK(&sim->context, mps__finite(add.lo, 3) && mps__finite(add.hi, 3),
               "\"%.200s\": a coordinate is not finite after scaling by %g", path, s->scale);
    MPS__TRY(check_corner(sim, "the STL file's lower corner ", add.lo));
    const double side[3] = {add.hi[0] - add.lo[0], add.hi[1] - add.lo[1], add.hi[2] - add.lo[2]};
    const double longest = side[mps__longest(side, 3)];
    MPS__CHECK(&sim->context, longest == 0 || longest >= sim->world.setup.dp,
               "\"%.200s\" is %.3g x %.3g x %.3g m, smaller than a spacing of %g m: is the unit "
               "of the file right?",
               path, side[0], side[1], side[2], sim->world.setup.dp);
    MPS__TRY(prepare_mesh(sim, m, path, s->container != 0));
    add.shape = (mps__shape){.dim = 3, .dp = sim->world.setup.dp, .sign = 1, .mesh = m};
    memcpy(built, add.lo, sizeof add.lo);
    memcpy(built + 3, add.hi, sizeof add.hi);
    const double volume = fabs(mps__mesh_volume(m));
    const int64_t triangles = m->elements;
    MPS__TRY(mps__solid_add(sim, &add));
    mps__log(&sim->context, MPS_LOG_INFO,
             "\"%.200s\": %lld triangles enclose %.6g m3 in a box of %.6g x %.6g x %.6g m", path,
             (long long)triangles, volume, add.hi[0] - add.lo[0], add.hi[1] - add.lo[1],
             add.hi[2] - add.lo[2]);
    return MPS_OK;
}

mps_status mps_stl_add(mps_sim *sim, const char *path, const mps_stl *stl, double *built)
{
    MPS__BUILDS(sim);
    mps_stl s = stl_defaults;
    char name[MPS__PART_NAME];
    double box[6];
    mps__mesh mesh;
    mps__stl_notes notes;
    MPS__TRY(mps__solids_allowed(sim));
    MPS__TRY(mps__struct_in(&sim->context, "mps_stl", &s, sizeof s, stl));
    if (s.name == NULL) s.name = stl_defaults.name;
    if (s.dummy_layers == 0) s.dummy_layers = stl_defaults.dummy_layers;
    if (s.scale == 0) s.scale = stl_defaults.scale;
    MPS__TRY(check_name(sim, "stl", s.name, s.dummy_layers, name));
    MPS__TRY(check_stl(sim, path, &s));
    s.name = name;
    mps__mesh_init(&mesh, &sim->context, 3);
    mps_status status = mps__stl_read(&mesh, path, &notes);
    if (status == MPS_OK) log_notes(&sim->context, path, &notes);
    if (status == MPS_OK) status = add_mesh(sim, path, &s, &mesh, box);
    mps__mesh_free(&mesh);
    if (status == MPS_OK && built) memcpy(built, box, sizeof box);
    return status;
}

/* ---- edges ---- */

static mps_status find_edges(mps_sim *sim, const char *path, const mps_stl *s, mps__mesh *m)
{
    double lo[3], hi[3];
    mps__mesh_faults faults;
    mps__stl_notes notes;
    MPS__TRY(mps__stl_read(m, path, &notes));
    place_mesh(m, s, lo, hi);
    MPS__CHECK(&sim->context, mps__finite(lo, 3) && mps__finite(hi, 3),
               "\"%.200s\": a coordinate is not finite after scaling by %g", path, s->scale);
    return mps__mesh_weld(m, gap_share * sim->world.setup.dp, &faults);
}

mps_status mps_stl_edges(mps_sim *sim, const char *path, const mps_stl *stl, double angle,
                         int64_t capacity, double *ends, int64_t *count)
{
    MPS__READS(sim);
    mps_stl s = stl_defaults;
    mps__mesh mesh;
    mps__context *c = &sim->context;
    MPS__TRY(mps__struct_in(c, "mps_stl", &s, sizeof s, stl));
    if (s.scale == 0) s.scale = stl_defaults.scale;
    MPS__TRY(check_stl(sim, path, &s));
    MPS__CHECK(c, angle >= 0 && angle <= MPS__PI, "angle is %g rad: must be 0..pi", angle);
    MPS__CHECK(c, capacity >= 0 && (ends || capacity == 0), "capacity is %lld, or ends is NULL",
               (long long)capacity);
    MPS__CHECK(c, count, "count is NULL");
    mps__mesh_init(&mesh, c, 3);
    const mps_status status = find_edges(sim, path, &s, &mesh);
    if (status == MPS_OK) *count = mps__mesh_edges(&mesh, angle, capacity, ends);
    mps__mesh_free(&mesh);
    return status;
}
