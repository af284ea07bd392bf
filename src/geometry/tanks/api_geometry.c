/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/geometry.h: argument checks, then geometry.c. */
#include "geometry.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const mps_tank tank_defaults = {.name = "tank", .dummy_layers = 2};

static mps_status has_tank(const mps_sim *sim)
{
    if (!sim->has_tank)
        return mps__fail(mps__sim_context(sim), MPS_E_STATE,
                         "there is no lattice yet: call mps_tank_add() first");
    return MPS_OK;
}

/* Whole cells along every side, the same for tanks of the same size. The number of lattice points
 * including dummies must not overflow. */
static mps_status tank_cells(mps_sim *sim, const mps_tank *tank, int64_t cells[3])
{
    const double dp = sim->world.setup.dp_given;
    const int dim = sim->world.setup.dim;
    double along[3], points = 1;
    for (int d = 0; d < dim; d++) {
        const double n = round(tank->size[d] / dp);
        MPS__CHECK(&sim->context, isfinite(tank->lo[d]), "tank.lo[%d] is %g: must be finite", d,
                   tank->lo[d]);
        MPS__CHECK(&sim->context, isfinite(n) && tank->size[d] >= (3 - 1e-6) * dp,
                   "tank.size[%d] is %g m: must be at least 3 spacings of %g m", d, tank->size[d],
                   dp);
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

/* Cells that fill the tank. A cell has the volume of a particle: before the first particle the
 * spacing is adapted to the cells, later a tank whose cells have another volume is rounded. */
static void fit_lattice(const mps_sim *sim, const mps_tank *tank, mps__tank_lattice *l)
{
    static const double same_volume = 1e-3;
    const int dim = sim->world.setup.dim;
    const double dp = sim->world.setup.dp;
    const bool first = sim->world.particles.next_id == 0;
    double volume = 1;
    for (int d = 0; d < dim; d++) {
        const double whole = (double)l->cells[d] * dp;
        l->h[d] = fabs(tank->size[d] - whole) > 1e-6 * dp ? tank->size[d] / (double)l->cells[d]
                                                          : dp;
        volume *= l->h[d] / dp;
    }
    l->dp = first && volume != 1 ? dp * mps_pow(volume, 1.0 / dim) : dp;
    if (first || fabs(volume - 1) < same_volume) return;
    for (int d = 0; d < dim; d++) {
        l->cells[d] = (int64_t)round(tank->size[d] / dp);
        l->h[d] = dp;
    }
}

static void report_size(mps_sim *sim, const mps_tank *tank, const mps__tank_lattice *l, double dp,
                        double *built)
{
    static const char axis[3] = {'x', 'y', 'z'};
    if (l->dp != dp)
        mps__log(&sim->context, MPS_LOG_INFO,
                 "tank \"%s\": dp is %g m instead of %g m, so that whole cells fill the tank",
                 tank->name, l->dp, dp);
    for (int d = 0; d < 3; d++) {
        const double size = (double)l->cells[d] * l->h[d];
        if (built) built[d] = size;
        if (d >= sim->world.setup.dim) continue;
        if (fabs(size - tank->size[d]) > 1e-6 * dp)
            mps__log(&sim->context, MPS_LOG_WARNING,
                     "tank \"%s\": size %g m in %c rounded to %g m, %lld spacings: only before the "
                     "first particle the spacing is fitted to a tank",
                     tank->name, tank->size[d], axis[d], size, (long long)l->cells[d]);
        else if (l->h[d] != dp)
            mps__log(&sim->context, MPS_LOG_INFO,
                     "tank \"%s\": size %g m in %c has %lld cells of %g m, %+.2g %% of dp",
                     tank->name, tank->size[d], axis[d], (long long)l->cells[d], l->h[d],
                     100 * (l->h[d] / l->dp - 1));
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

/* Missing fraction of a layer. */
static double missing(double share)
{
    return share > 0 ? 1 - share : 0;
}

/* Corners of the points of a box, and a log of the differences from the requested box. */
static void report_box(mps_sim *sim, const char *what, const double *lo, const double *hi,
                       const mps__lattice_box *box, double *built)
{
    static const char axis[3] = {'x', 'y', 'z'};
    const int dim = sim->world.setup.dim;
    const double dp = sim->world.setup.dp;
    for (int d = 0; d < dim; d++) {
        const double h = box->h[d],
                     first = box->lo[d] + ((double)box->first[d] + missing(box->share[d][0])) * h;
        const double last = box->lo[d] + ((double)box->last[d] - missing(box->share[d][1])) * h;
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
    char name[MPS__PART_NAME - 3]; /* capacity for ".x0" */
    const double dp = sim->world.setup.dp;
    mps__tank_lattice lattice = {.h = {dp, dp, dp}};
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
    MPS__TRY(tank_cells(sim, &t, lattice.cells));
    fit_lattice(sim, &t, &lattice);
    MPS__TRY(mps__geometry_tank(sim, &t, &lattice));
    report_size(sim, &t, &lattice, dp, built);
    return MPS_OK;
}

mps_status mps_lattice_get(const mps_sim *sim, double *lo, double *h)
{
    if (!sim) return MPS_E_ARG;
    MPS__TRY(has_tank(sim));
    const size_t bytes = (size_t)sim->world.setup.dim * sizeof *h;
    if (lo) memcpy(lo, sim->lattice_lo, bytes);
    if (h) memcpy(h, sim->lattice_h, bytes);
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

/* Checks one edge of a plate. */
static mps_status plate_edge(mps_sim *sim, mps__plate_shape *s, int e, const double *edge)
{
    const int dim = sim->world.setup.dim;
    const double dp = sim->world.setup.dp;
    MPS__CHECK(&sim->context, edge, "edge%s of the plate is NULL", e ? "2" : "");
    MPS__CHECK(&sim->context, mps__finite(edge, dim), "edge%s of the plate is not finite",
               e ? "2" : "");
    const double length = sqrt(mps__dot(edge, edge, dim));
    double h = dp;
    for (int d = 0; d < dim; d++)
        if (fabs(edge[d]) > (1 - 1e-6) * length) h = sim->lattice_h[d];
    const double cells = round(length / h);
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
    const double small = 1e-6;
    int32_t axis = -1;
    for (int d = 0; d < sim->world.setup.dim; d++) {
        const double q = (s->corner[d] - sim->lattice_lo[d]) / sim->lattice_h[d];
        if (fabs(q - round(q)) > small) return -1;
        if (fabs(s->normal[d]) > 1 - small) axis = d;
    }
    for (int e = 0; e < sim->world.setup.dim - 1; e++) {
        bool on_axis = false;
        for (int d = 0; d < sim->world.setup.dim; d++)
            on_axis = on_axis || (fabs(s->along[e][d]) > 1 - small &&
                                  fabs(s->spacing[e] / sim->lattice_h[d] - 1) < small);
        if (!on_axis) return -1;
    }
    return axis;
}

/* All four corners are in the tank. */
static mps_status plate_inside(mps_sim *sim, const mps__plate_shape *s)
{
    for (int corner = 0; corner < 2 * (sim->world.setup.dim - 1); corner++)
        for (int d = 0; d < sim->world.setup.dim; d++) {
            double at = s->corner[d];
            for (int e = 0; e < 2; e++)
                at += (corner >> e & 1) * (double)(s->nodes[e] - 1) * s->spacing[e] *
                      s->along[e][d];
            const double lo = sim->lattice_lo[d],
                         hi = lo + (double)sim->lattice_cells[d] * sim->lattice_h[d],
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
    const double dp = sim->world.setup.dp;
    mps__plate_shape s = {.nodes = {1, 1}, .spacing = {dp, dp}, .across = dp, .columns = 1};
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
    if (s.axis >= 0) s.across = sim->lattice_h[s.axis];
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
    MPS__TRY(mps__geometry_fill(sim, &(mps__fill){phase, false, lo, hi, NULL, NULL}, &box, added));
    report_box(sim, "fill", lo, hi, &box, built);
    return MPS_OK;
}

/* Add the layers of the box that are partly in lo..hi, where the lattice has them. */
static void add_layers(const mps_sim *sim, const double *lo, const double *hi,
                       mps__lattice_box *box)
{
    static const double small = 1e-6;
    for (int d = 0; d < sim->world.setup.dim; d++) {
        const double from = (lo[d] - sim->lattice_lo[d]) / sim->lattice_h[d],
                     to = (hi[d] - sim->lattice_lo[d]) / sim->lattice_h[d],
                     below = (double)box->first[d] - from, above = to - (double)box->last[d];
        if (below > small && box->first[d] > 0) {
            box->share[d][0] = below;
            box->first[d]--;
        }
        if (above > small && box->last[d] < sim->lattice_cells[d]) {
            box->share[d][1] = above;
            box->last[d]++;
        }
    }
}

mps_status mps_fill_level_add(mps_sim *sim, int32_t phase, const double *lo, const double *hi,
                              int64_t *added, double *built)
{
    MPS__BUILDS(sim);
    mps__lattice_box box;
    MPS__TRY(fill_points(sim, phase, lo, hi, &box));
    add_layers(sim, lo, hi, &box);
    MPS__TRY(mps__geometry_fill(sim, &(mps__fill){phase, true, lo, hi, NULL, NULL}, &box, added));
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
        box.h[d] = sim->lattice_h[d];
        box.last[d] = sim->lattice_cells[d];
    }
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "an inside callback");
    const mps_status status = mps__geometry_fill(
        sim, &(mps__fill){phase, false, NULL, NULL, inside, user}, &box, added);
    sim->context.lock = before;
    return status;
}
