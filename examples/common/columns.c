/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns of probes.csv: adding them, and what each one is and where, for the report and summary.json. */
#include "outputs.h"
#include "view.h"
#include "ranks.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Append to the text about a column. */
static void about_add(run_column *c, const char *format, ...)
{
    const size_t used = strlen(c->about);
    va_list values;
    va_start(values, format);
    vsnprintf(c->about + used, sizeof c->about - used, format, values);
    va_end(values);
}

/* "(x, y) m", in 3-D "(x, y, z) m". */
static void about_place(const run *r, run_column *c, const double *x)
{
    about_add(c, "(%g, %g", x[0], x[1]);
    if (r->options.dim == 3) about_add(c, ", %g", x[2]);
    about_add(c, ") m");
}

static void about_average(const run *r, run_column *c)
{
    const double average = r->options.sensor_average;
    if (average == MPS_AVERAGE_AUTO)
        about_add(c, "; mean over the time in which liquid crosses a spacing");
    else if (average > 0)
        about_add(c, "; mean of the last %g s", average);
    else
        about_add(c, "; no mean over time");
}

static run_column *run_column_add(run *r, const char *name, const char *unit)
{
    if (r->columns == RUN_COLUMNS) {
        fprintf(ranks_messages(), "%s: more than %d columns\n", r->options.program, RUN_COLUMNS);
        ranks_exit(CLI_FAILED);
    }
    run_column *c = &r->column[r->columns++];
    *c = (run_column){.probe = -1, .type = "value"};
    snprintf(c->name, sizeof c->name, "%s", name);
    snprintf(c->unit, sizeof c->unit, "%s", unit);
    return c;
}

static run_column *run_probe_add(run *r, const char *name, const char *unit, const mps_probe *probe,
                                 double zero)
{
    int32_t id;
    mps_probe named = *probe;
    mps_probe_info info;
    named.name = name;
    run_check(r, mps_probe_add(r->sim, &named, &id), name);
    mps_probe_info_init(&info, sizeof info);
    run_check(r, mps_probe_info_get(r->sim, id, &info), name);
    run_column *c = run_column_add(r, name, unit);
    c->probe = id;
    c->zero = zero;
    c->diameter = info.diameter;
    memcpy(c->at, info.at, sizeof c->at);
    memcpy(c->normal, info.normal, sizeof c->normal);
    snprintf(c->part, sizeof c->part, "%s", info.part);
    return c;
}

void run_wall_sensor(run *r, const char *name, double x, double y, double z, double diameter)
{
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_WALL_PRESSURE;
    probe.at[0] = x;
    probe.at[1] = y;
    probe.at[2] = z;
    probe.diameter = diameter;
    probe.average = r->options.sensor_average;
    run_column *c = run_probe_add(r, name, "Pa", &probe, 0);
    c->pressure = true;
    c->type = "wall_pressure";
    about_add(c, "Wall pressure: sensor at ");
    about_place(r, c, c->at);
    about_add(c, " on '%s', face %g m wide", c->part, c->diameter);
    about_average(r, c);
}

void run_wall_pressure(run *r, const char *name, double x, double y, double z)
{
    run_wall_sensor(r, name, x, y, z, 0);
}

void run_gauge_from(run *r, const char *name, const double *foot, double level)
{
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_GAUGE;
    memcpy(probe.at, foot, sizeof probe.at);
    run_column *c = run_probe_add(r, name, "m", &probe, level - foot[1]);
    c->type = "gauge";
    about_add(c,
              "Elevation of the surface: above the still level y = %g m, on the line upwards from ",
              level);
    about_place(r, c, c->at);
}

void run_gauge(run *r, const char *name, double x, double z, double level)
{
    run_gauge_from(r, name, (const double[]){x, 0, z}, level);
}

void run_force(run *r, const char *name, const char *part, int32_t component)
{
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_FORCE;
    probe.part = part;
    probe.average = r->options.sensor_average;
    run_column *c = run_probe_add(r, name, r->options.dim == 3 ? "N" : "N/m", &probe, 0);
    c->component = component;
    c->pressure = true;
    c->type = "force";
    about_add(c, "Force along %c: of the liquid on ", "xyz"[component]);
    if (part)
        about_add(c, "the part '%s'", part);
    else
        about_add(c, "all solids");
    about_average(r, c);
}

void run_value(run *r, const char *name, const char *unit, const char *about, run_value_fn value,
               void *user)
{
    run_column *c = run_column_add(r, name, unit);
    about_add(c, "%s", about);
    c->value = value;
    c->user = user;
}

void run_particle_value(run *r, const char *name, const char *unit, const char *about,
                        run_value_fn value, void *user)
{
    run_value(r, name, unit, about, value, user);
    r->column[r->columns - 1].particles = true;
}

/* ---- the common columns, names and texts ------------------------------------------------------------------------ */

/* Those of every driver, behind its own, in the order of COLUMN_KE and on. The energy's unit is J, J/m in 2-D. */
static const run_column COMMON[RUN_COMMON] = {
    {.name = "ke", .unit = "J", .about = "Kinetic energy: of all fluid"},
    {.name = "x_tank", .unit = "m", .about = "Displacement of the tank along x"},
    {.name = "pe", .unit = "J", .about = "Potential energy: of all fluid, 0 at the lab's origin"},
    {.name = "wall_work_momentum",
     .unit = "J",
     .about = "Work of the walls, by momentum: that the fluid received, since the start"},
    {.name = "wall_work_probes",
     .unit = "J",
     .about = "Work of the walls, by probes: of the forces that probes show, since the start"},
    {.name = "viscous", .unit = "J", .about = "Energy lost by viscosity: since the start"},
    {.name = "plugins",
     .unit = "J",
     .about = "Energy lost in plug-ins: in models that are not the library's, since the start"},
    {.name = "collision", .unit = "J", .about = "Energy lost in collisions: since the start"},
    {.name = "shift", .unit = "J", .about = "Energy lost in shifting: since the start"},
    {.name = "numerical",
     .unit = "J",
     .about = "Energy lost otherwise: what closes the budget, since the start"},
    {.name = "added",
     .unit = "J",
     .about = "Energy from outside: of particles added or lost, since the start"},
    {.name = "volume_error",
     .about = "Error of volume: growth of the fluid below the surface since the first step, as a "
              "share"}};

int run_columns_all(const run *r)
{
    return r->own_columns + RUN_COMMON;
}

run_column run_column_at(const run *r, int k)
{
    if (k < r->own_columns) return r->column[k];
    run_column c = COMMON[k - r->own_columns];
    if (strcmp(c.unit, "J") == 0 && r->options.dim != 3) memcpy(c.unit, "J/m", sizeof "J/m");
    c.type = "value";
    return c;
}

void run_column_title(const run_column *c, char *title, size_t size)
{
    snprintf(title, size, "%.*s", (int)strcspn(c->about, ":"), c->about);
}

/* ---- tank and liquid -------------------------------------------------------------------------------------------- */

/* Rounding of 0 becomes 0. */
static void box_tidy(run_box *b, double dp)
{
    for (int d = 0; d < 3; d++) {
        if (fabs(b->lo[d]) < 1e-9 * dp) b->lo[d] = 0;
        if (fabs(b->hi[d]) < 1e-9 * dp) b->hi[d] = 0;
    }
}

static void box_take(run_box *b, const double *x, int dim)
{
    for (int d = 0; d < dim; d++) {
        b->lo[d] = b->count ? fmin(b->lo[d], x[d]) : x[d];
        b->hi[d] = b->count ? fmax(b->hi[d], x[d]) : x[d];
    }
    b->count++;
}

void run_boxes(run *r)
{
    view v;
    r->walls = r->liquid = (run_box){0};
    if (!run_note(r, view_open(r->sim, &v) ? MPS_OK : MPS_E_BUSY, "size of the tank")) return;
    for (int64_t i = 0; i < v.x.count; i++) {
        const double *x = v.x.data + i * v.x.stride;
        if (v.kind.integers[i] == MPS_WALL) box_take(&r->walls, x, r->options.dim);
        if (v.kind.integers[i] == MPS_FLUID && v.phase.integers[i] == 0)
            box_take(&r->liquid, x, r->options.dim);
    }
    box_tidy(&r->walls, r->options.dp);
    box_tidy(&r->liquid, r->options.dp);
    view_close(r->sim, &v);
}

double run_depth(const run *r)
{
    const double floor = r->walls.lo[1], top = r->level > 0 ? r->level : r->liquid.hi[1];
    const bool stands = r->walls.count > 0 && r->liquid.count > 0 &&
                        r->liquid.lo[1] - floor < 1.5 * r->options.dp;
    return stands ? top - floor : NAN;
}
