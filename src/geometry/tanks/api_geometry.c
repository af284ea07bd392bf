/* SPDX-License-Identifier: BSD-3-Clause */
/* The public functions of mps/geometry.h: argument checks, then geometry.c. */
#include "geometry.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const mps_tank tank_defaults = {.name = "tank", .dummy_layers = 2};

static mps_status has_tank(mps_sim *sim)
{
    if (!sim->has_tank)
        return mps__fail(&sim->context, MPS_E_STATE,
                         "there is no lattice yet: call mps_tank_add() first");
    return MPS_OK;
}

/* Whole spacings of every side. The lattice with its dummies must stay countable. */
static mps_status tank_cells(mps_sim *sim, const mps_tank *tank, int64_t cells[3])
{
    const double dp = sim->world.setup.dp;
    const int dim = sim->world.setup.dim;
    double along[3], points = 1;
    for (int d = 0; d < dim; d++) {
        const double n = round(tank->size[d] / dp);
        MPS__CHECK(&sim->context, isfinite(tank->lo[d]), "tank.lo[%d] is %g: must be finite", d,
                   tank->lo[d]);
        MPS__CHECK(&sim->context, isfinite(n) && tank->size[d] >= (3 - 1e-6) * dp,
                   "tank.size[%d] is %g m: at least 3 spacings of %g m", d, tank->size[d], dp);
        MPS__TRY(mps__place_resolved(sim, "tank.lo", d, tank->lo[d]));
        MPS__TRY(mps__place_resolved(sim, "tank.size", d, tank->lo[d] + tank->size[d]));
        along[d] = n;
        points *= n + 1 + 2 * tank->dummy_layers;
    }
    const int most = mps__longest(along, dim);
    MPS__CHECK(&sim->context, points < INT32_MAX,
               "tank.size[%d] is %g m: too many lattice points of spacing %g m", most,
               tank->size[most], dp);
    for (int d = 0; d < dim; d++) cells[d] = (int64_t)along[d];
    return MPS_OK;
}

static void report_size(mps_sim *sim, const mps_tank *tank, const int64_t cells[3], double *built)
{
    static const char axis[3] = {'x', 'y', 'z'};
    for (int d = 0; d < 3; d++) {
        double size = (double)cells[d] * sim->world.setup.dp;
        if (built) built[d] = size;
        if (d < sim->world.setup.dim && fabs(size - tank->size[d]) > 1e-6 * sim->world.setup.dp)
            mps__log(&sim->context, MPS_LOG_INFO,
                     "tank \"%s\": size %g m in %c rounded to %g m, %lld spacings", tank->name,
                     tank->size[d], axis[d], size, (long long)cells[d]);
    }
}

static mps_status corners(mps_sim *sim, const double *lo, const double *hi)
{
    mps__context *c = &sim->context;
    MPS__CHECK(c, lo && hi, "a corner of the box is NULL");
    for (int d = 0; d < sim->world.setup.dim; d++) {
        MPS__CHECK(c, isfinite(lo[d]) && isfinite(hi[d]),
                   "box corner [%d] is %g .. %g: must be finite", d, lo[d], hi[d]);
        MPS__CHECK(c, lo[d] <= hi[d], "box corners [%d] are inverted: lo %g > hi %g", d, lo[d],
                   hi[d]);
    }
    return MPS_OK;
}

static mps_status box_points(mps_sim *sim, const double *lo, const double *hi,
                             mps__lattice_box *box)
{
    MPS__TRY(has_tank(sim));
    MPS__TRY(corners(sim, lo, hi));
    MPS__CHECK(&sim->context, mps__lattice_clip(sim, lo, hi, box),
               "the box contains no lattice point of the tank: spacing is %g m, the first point "
               "(%g, %g%s)",
               sim->world.setup.dp, sim->lattice_lo[0], sim->lattice_lo[1],
               sim->world.setup.dim == 3 ? ", ..." : "");
    return MPS_OK;
}

/* Corners of the points of a box, and the log of what differs from what was asked for. */
static void report_box(mps_sim *sim, const char *what, const double *lo, const double *hi,
                       const mps__lattice_box *box, double *built)
{
    static const char axis[3] = {'x', 'y', 'z'};
    const int dim = sim->world.setup.dim;
    const double dp = sim->world.setup.dp;
    for (int d = 0; d < dim; d++) {
        const double first = box->lo[d] + (double)box->first[d] * dp;
        const double last = box->lo[d] +
                            ((double)box->last[d] - (d == 1 && box->top > 0 ? 1 - box->top : 0)) *
                                dp;
        if (built) {
            built[d] = first;
            built[dim + d] = last;
        }
        if (fabs(first - lo[d]) > 1e-6 * dp || fabs(last - hi[d]) > 1e-6 * dp)
            mps__log(&sim->context, MPS_LOG_INFO,
                     "%s: %g .. %g m in %c became %g .. %g m, on the lattice in the tank", what,
                     lo[d], hi[d], axis[d], first, last);
    }
}

static mps_status phase_ok(mps_sim *sim, int32_t phase)
{
    MPS__CHECK(&sim->context, phase >= 0 && phase < MPS__PHASES, "phase %d: must be 0..%d",
               (int)phase, MPS__PHASES - 1);
    MPS__CHECK(&sim->context, sim->world.setup.phase_defined[phase],
               "phase %d is not defined: call mps_phase_set() first", (int)phase);
    return MPS_OK;
}

mps_status mps_tank_init(mps_tank *tank, size_t size)
{
    return mps__struct_init("mps_tank", tank, size, &tank_defaults, sizeof tank_defaults);
}

mps_status mps_tank_add(mps_sim *sim, const mps_tank *tank, double *built)
{
    MPS__BUILDS(sim);
    mps_tank t = tank_defaults;
    char name[MPS__PART_NAME - 3]; /* room for ".x0" */
    int64_t cells[3] = {0, 0, 0};
    MPS__TRY(mps__solids_allowed(sim));
    MPS__TRY(mps__struct_in(&sim->context, "mps_tank", &t, sizeof t, tank));
    if (t.name == NULL) t.name = tank_defaults.name;
    if (t.dummy_layers == 0) t.dummy_layers = tank_defaults.dummy_layers;
    MPS__CHECK(&sim->context, mps__name_copy(name, sizeof name, t.name),
               "tank.name \"%.40s\": must have 1..%d characters", t.name, (int)sizeof name - 1);
    MPS__CHECK(&sim->context, t.dummy_layers >= 1 && t.dummy_layers <= 8,
               "tank.dummy_layers is %d: must be 1..8", (int)t.dummy_layers);
    MPS__CHECK(&sim->context, t.open_top == 0 || t.open_top == 1,
               "tank.open_top is %d: must be 0 or 1", (int)t.open_top);
    MPS__TRY(tank_cells(sim, &t, cells));
    MPS__TRY(mps__geometry_tank(sim, &t, cells));
    report_size(sim, &t, cells, built);
    return MPS_OK;
}

mps_status mps_baffle_add(mps_sim *sim, const char *name, const double *lo, const double *hi,
                          double *built)
{
    MPS__BUILDS(sim);
    mps__lattice_box box;
    char copy[MPS__PART_NAME];
    MPS__TRY(mps__solids_allowed(sim));
    MPS__CHECK(&sim->context, mps__name_copy(copy, sizeof copy, name),
               "the baffle's name must have 1..%d characters", MPS__PART_NAME - 1);
    MPS__TRY(box_points(sim, lo, hi, &box));
    MPS__TRY(mps__geometry_baffle(sim, copy, &box));
    char what[MPS__PART_NAME + 16];
    snprintf(what, sizeof what, "baffle \"%s\"", copy);
    report_box(sim, what, lo, hi, &box, built);
    return MPS_OK;
}

/* Of one edge of a plate. */
static mps_status plate_edge(mps_sim *sim, mps__plate_shape *s, int e, const double *edge)
{
    const int dim = sim->world.setup.dim;
    const double dp = sim->world.setup.dp;
    MPS__CHECK(&sim->context, edge, "edge%s of the plate is NULL", e ? "2" : "");
    MPS__CHECK(&sim->context, mps__finite(edge, dim), "edge%s of the plate is not finite",
               e ? "2" : "");
    const double length = sqrt(mps__dot(edge, edge, dim)), cells = round(length / dp);
    MPS__CHECK(&sim->context, length >= (2 - 1e-6) * dp && cells < INT32_MAX,
               "edge%s of the plate is %g m long: at least 2 spacings of %g m", e ? "2" : "",
               length, dp);
    for (int d = 0; d < dim; d++) s->along[e][d] = edge[d] / length;
    s->nodes[e] = (int64_t)cells + 1;
    s->spacing[e] = length / cells;
    return MPS_OK;
}

static void plate_normal(mps__plate_shape *s, int dim)
{
    const double *a = s->along[0], *b = s->along[1];
    s->normal[0] = dim == 2 ? -a[1] : a[1] * b[2] - a[2] * b[1];
    s->normal[1] = dim == 2 ? a[0] : a[2] * b[0] - a[0] * b[2];
    s->normal[2] = dim == 2 ? 0 : a[0] * b[1] - a[1] * b[0];
}

/* Axis of the normal of a plate whose nodes are lattice points, else -1. */
static int32_t plate_axis(const mps_sim *sim, const mps__plate_shape *s)
{
    const double dp = sim->world.setup.dp, small = 1e-6;
    int32_t axis = -1;
    for (int d = 0; d < sim->world.setup.dim; d++) {
        const double q = (s->corner[d] - sim->lattice_lo[d]) / dp;
        if (fabs(q - round(q)) > small) return -1;
        if (fabs(s->normal[d]) > 1 - small) axis = d;
    }
    for (int e = 0; e < sim->world.setup.dim - 1; e++) {
        double largest = 0;
        for (int d = 0; d < sim->world.setup.dim; d++)
            largest = fmax(largest, fabs(s->along[e][d]));
        if (largest < 1 - small || fabs(s->spacing[e] - dp) > small * dp) return -1;
    }
    return axis;
}

/* All four corners lie in the tank. */
static mps_status plate_inside(mps_sim *sim, const mps__plate_shape *s)
{
    for (int corner = 0; corner < 2 * (sim->world.setup.dim - 1); corner++)
        for (int d = 0; d < sim->world.setup.dim; d++) {
            double at = s->corner[d];
            for (int e = 0; e < 2; e++)
                at += (corner >> e & 1) * (double)(s->nodes[e] - 1) * s->spacing[e] *
                      s->along[e][d];
            const double lo = sim->lattice_lo[d],
                         hi = lo + (double)sim->lattice_cells[d] * sim->world.setup.dp,
                         slack = 1e-6 * sim->world.setup.dp;
            MPS__CHECK(
                &sim->context, at >= lo - slack && at <= hi + slack,
                "the plate leaves the tank: coordinate [%d] of a corner is %g, allowed %g..%g", d,
                at, lo, hi);
        }
    return MPS_OK;
}

mps_status mps_plate_add(mps_sim *sim, const char *name, const double *corner, const double *edge,
                         const double *edge2)
{
    MPS__BUILDS(sim);
    const int dim = sim->world.setup.dim;
    mps__plate_shape s = {
        .nodes = {1, 1}, .spacing = {sim->world.setup.dp, sim->world.setup.dp}, .columns = 1};
    char copy[MPS__PART_NAME];
    MPS__TRY(mps__solids_allowed(sim));
    MPS__CHECK(&sim->context, mps__name_copy(copy, sizeof copy, name),
               "the plate's name must have 1..%d characters", MPS__PART_NAME - 1);
    MPS__TRY(has_tank(sim));
    MPS__CHECK(&sim->context, corner && mps__finite(corner, dim),
               "the plate's corner is NULL or not finite");
    memcpy(s.corner, corner, (size_t)dim * sizeof *corner);
    MPS__TRY(plate_edge(sim, &s, 0, edge));
    MPS__CHECK(&sim->context, dim == 3 || !edge2,
               "edge2 of the plate is given: in 2-D a plate has one edge");
    if (dim == 3) {
        MPS__TRY(plate_edge(sim, &s, 1, edge2));
        MPS__CHECK(&sim->context, fabs(mps__dot(s.along[0], s.along[1], 3)) < 1e-6,
                   "the edges of the plate are not at right angles: the cosine between them is %g",
                   mps__dot(s.along[0], s.along[1], 3));
    }
    plate_normal(&s, dim);
    s.axis = plate_axis(sim, &s);
    MPS__TRY(plate_inside(sim, &s));
    return mps__geometry_plate(sim, copy, &s);
}

static mps_status fill_points(mps_sim *sim, int32_t phase, const double *lo, const double *hi,
                              mps__lattice_box *box)
{
    MPS__TRY(mps__fill_allowed(sim));
    MPS__TRY(phase_ok(sim, phase));
    return box_points(sim, lo, hi, box);
}

mps_status mps_fill_box_add(mps_sim *sim, int32_t phase, const double *lo, const double *hi,
                            int64_t *added, double *built)
{
    MPS__BUILDS(sim);
    mps__lattice_box box;
    MPS__TRY(fill_points(sim, phase, lo, hi, &box));
    MPS__TRY(mps__geometry_fill(sim, &(mps__fill){phase, lo, hi, NULL, NULL}, &box, added));
    report_box(sim, "fill", lo, hi, &box, built);
    return MPS_OK;
}

mps_status mps_fill_level_add(mps_sim *sim, int32_t phase, const double *lo, const double *hi,
                              int64_t *added, double *built)
{
    MPS__BUILDS(sim);
    mps__lattice_box box;
    MPS__TRY(has_tank(sim));
    MPS__TRY(corners(sim, lo, hi));
    const int dim = sim->world.setup.dim;
    const double rows = (hi[1] - sim->lattice_lo[1]) / sim->world.setup.dp,
                 part = rows - floor(rows + 1e-6);
    double top[3] = {0, 0, 0};
    memcpy(top, hi, (size_t)dim * sizeof *top);
    if (part > 1e-6) top[1] = sim->lattice_lo[1] + (floor(rows) + 1) * sim->world.setup.dp;
    MPS__TRY(fill_points(sim, phase, lo, top, &box));
    if (part > 1e-6 && (double)box.last[1] > rows) box.top = part;
    MPS__TRY(mps__geometry_fill(sim, &(mps__fill){phase, lo, hi, NULL, NULL}, &box, added));
    report_box(sim, "fill", lo, hi, &box, built);
    return MPS_OK;
}

mps_status mps_fill_add(mps_sim *sim, int32_t phase, mps_inside_fn inside, void *user,
                        int64_t *added)
{
    MPS__BUILDS(sim);
    MPS__TRY(mps__fill_allowed(sim));
    MPS__TRY(phase_ok(sim, phase));
    MPS__TRY(has_tank(sim));
    MPS__CHECK(&sim->context, inside, "inside is NULL: use mps_fill_box_add() to fill a box");
    mps__lattice_box box = {.lo = {0}};
    for (int d = 0; d < sim->world.setup.dim; d++) {
        box.lo[d] = sim->lattice_lo[d];
        box.last[d] = sim->lattice_cells[d];
    }
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "an inside callback");
    const mps_status status = mps__geometry_fill(sim, &(mps__fill){phase, NULL, NULL, inside, user},
                                                 &box, added);
    sim->context.lock = before;
    return status;
}
