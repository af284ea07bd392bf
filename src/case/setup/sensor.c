/* SPDX-License-Identifier: BSD-3-Clause */
/* Sensors: columns of probes.csv, in the order of the case. */
#include "run.h"
#include "sensor_load.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- columns ---- */

void mps__sensor_log(const sensing *s, const char *key, const char *text)
{
    const tree_node *at = mps__tree_find(s->map, key);
    mps__case_log(s->b->c, at ? at : s->map, false, "sensors.%s.%s: %s", s->map->key, key, text);
}

static build_sensor *note(build *b, const char *name, sensor_kind kind)
{
    if (b->sensors == BUILD_SENSORS) {
        b->unlisted++;
        return NULL;
    }
    build_sensor *s = &b->sensor[b->sensors++];
    *s = (build_sensor){.kind = kind};
    snprintf(s->name, sizeof s->name, "%s", name);
    return s;
}

/* Record the final position of the probe of this name. */
static void note_probe(build *b, const char *name, const mps_probe *probe, int32_t component)
{
    static const sensor_kind kind[] = {SENSOR_WALL, SENSOR_FLUID, SENSOR_GAUGE, SENSOR_FORCE};
    build_sensor *s = note(b, name, kind[probe->type]);
    mps_probe_info info;
    mps_probe_info_init(&info, sizeof info);
    const int32_t id = mps__sensor_id(b, name);
    if (!s || id < 0) return;
    mps_probe_info_get(b->sim, id, &info);
    memcpy(s->at, info.at, sizeof s->at);
    memcpy(s->normal, info.normal, sizeof s->normal);
    s->diameter = info.diameter;
    s->component = component;
    snprintf(s->part, sizeof s->part, "%s", info.part);
}

int32_t mps__sensor_id(build *b, const char *name)
{
    mps_probe_info info;
    mps_probe_info_init(&info, sizeof info);
    for (int32_t id = 0; mps_probe_info_get(b->sim, id, &info) == MPS_OK; id++)
        if (strcmp(info.name, name) == 0) return id;
    return -1;
}

bool mps__sensor_add(const sensing *s, mps_probe *probe, int32_t component, double zero,
                     const char *name)
{
    build *b = s->b;
    mps_status status;
    int32_t id;
    if (b->job)
        status = mps_job_probe_add(b->job, b->sim, probe, component, zero, name, NULL);
    else {
        probe->name = name;
        status = mps_probe_add(b->sim, probe, &id);
    }
    char what[64];
    snprintf(what, sizeof what, "sensors.%s", name);
    if (b->job ? !mps__build_try_job(b, status, s->map, what)
               : !mps__build_try(b, status, s->map, what))
        return false;
    mps__build_column(b, name, mps__job_probe_unit(b->dim, probe, component));
    if (s->between && b->unlisted == 0)
        b->sensor[b->sensors - 1].further++;
    else
        note_probe(b, name, probe, component);
    return true;
}

bool mps__sensor_value(const sensing *s, const char *name, const char *unit, const char *about,
                       mps_job_value_fn value, void *user)
{
    build *b = s->b;
    build_sensor *noted = note(b, name, SENSOR_VALUE);
    if (noted) snprintf(noted->about, sizeof noted->about, "%s", about);
    mps__build_column(b, name, unit);
    if (!b->job) return true;
    const mps_status status = mps_job_value_add(b->job, name, unit, about, MPS_JOB_PRESSURE, value,
                                                user);
    return mps__build_try_job(b, status, s->map, name);
}

/* ---- kinds ---- */

/* Diameter, mean, rate and normal, if the probe has them. */
static void read_common(const sensing *s, mps_probe *probe)
{
    build *b = s->b;
    const tree_node *run = mps__tree_find(b->root, "run");
    probe->diameter = mps__read_number(b->c, s->map, "diameter", probe->diameter);
    if (probe->type != MPS_PROBE_GAUGE)
        probe->average = mps__read_number(b->c, run, "average", probe->average);
    probe->average = mps__read_number(b->c, s->map, "average", probe->average);
    probe->rate = mps__read_number(b->c, s->map, "rate", probe->rate);
    mps__read_numbers(b->c, s->map, "normal", 3, probe->normal);
}

static void begin(const sensing *s, mps_probe *probe, int32_t type)
{
    mps_probe_init(probe, sizeof *probe);
    probe->type = type;
    read_common(s, probe);
}

/* As filled to a depth, or the highest particle of the liquid. */
double mps__still_level(build *b)
{
    if (!isnan(b->level)) return b->level;
    double level = -INFINITY;
    mps_lease x = {.struct_size = sizeof x}, kind = x, phase = x;
    bool good = mps_lease_begin(b->sim, "position", MPS_READ, &x) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "kind", MPS_READ, &kind) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "phase", MPS_READ, &phase) == MPS_OK;
    for (int64_t i = 0; good && i < x.count; i++)
        if (kind.integers[i] == MPS_FLUID && phase.integers[i] == 0)
            level = fmax(level, x.data[i * x.stride + 1]);
    mps_lease_end(b->sim, &phase);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &x);
    return b->level = level;
}

/* Whether a position is in the tank, by its shape or, for a file, by its walls as built. */
static bool in_tank(build *b, const double *x)
{
    int32_t part;
    if (!b->tank.file) return mps__form_inside(&b->tank.form, x) > 0;
    return !mps__wall_behind(b, x, &part) || part != mps_part_find(b->sim, "tank");
}

/* Height of the floor below a position: where a vertical line enters the tank. */
static double floor_below(build *b, const double *x)
{
    const form *t = &b->tank.form;
    double at[3] = {x[0], t->lo[1], x[2]};
    if (!b->tank.file && t->kind == FORM_BOX) return t->lo[1];
    while (at[1] < t->hi[1] && !in_tank(b, at)) at[1] += 0.25 * b->dp;
    return at[1] < t->hi[1] ? at[1] : t->lo[1];
}

/* Name of the solid that contains this position, or NULL. */
static const char *solid_at(build *b, const double *x)
{
    for (int32_t i = 0; i < b->solids; i++) {
        const build_solid *o = &b->solid[i];
        int32_t part;
        if (o->plate) continue;
        if (o->file ? mps__wall_behind(b, x, &part) && part == mps_part_find(b->sim, o->name)
                    : mps__form_inside(&o->form, x) > 1e-6 * b->dp)
            return o->name;
    }
    return NULL;
}

static bool is_outside(build *b, const double *x)
{
    const form *t = &b->tank.form;
    const double slack = 1e-6 * b->dp;
    bool outside = b->tank.file ? !in_tank(b, x) : mps__form_inside(t, x) < -slack;
    for (int32_t d = 0; d < b->dim; d++)
        outside = outside || x[d] < t->lo[d] - slack || x[d] > t->hi[d] + slack;
    return outside;
}

/* A sensor in the liquid is in the tank or on its wall, and not inside a solid: otherwise it never
 * meets the liquid.
 * @param what   "the line begins": with the verb
 * @param above  height above `x` that must be free: the foot of a line may be on a face [m] */
static void check_place(const sensing *s, const char *key, const char *what, const double *x,
                        double above)
{
    build *b = s->b;
    const form *t = &b->tank.form;
    const tree_node *at = mps__tree_find(s->map, key);
    const double free[3] = {x[0], x[1] + above, x[2]};
    if (is_outside(b, x)) {
        char text[3][80];
        const double *place[] = {x, t->lo, t->hi};
        for (int k = 0; k < 3; k++)
            snprintf(text[k], sizeof text[k], b->dim == 3 ? "(%g, %g, %g)" : "(%g, %g)",
                     place[k][0], place[k][1], place[k][2]);
        mps__case_log(b->c, at, false,
                      "sensors.%s.%s: %s at %s m, outside of the tank, whose box reaches from %s "
                      "to %s m",
                      s->map->key, key, what, text[0], text[1], text[2]);
        return;
    }
    const char *solid = solid_at(b, free);
    if (solid)
        mps__case_log(
            b->c, at, false,
            "sensors.%s.%s: %s within solid '%s'; give a whole point outside of it, 'x y%s'",
            s->map->key, key, what, solid, b->dim == 3 ? " z" : "");
}

static void add_point(const sensing *s, const char *key, int32_t type)
{
    mps_probe probe;
    begin(s, &probe, type);
    probe.at[2] = mps__build_middle(s->b);
    mps__read_numbers(s->b->c, s->map, key, 3, probe.at);
    if (type == MPS_PROBE_FLUID_PRESSURE) check_place(s, key, "the point lies", probe.at, 0);
    if (!mps__case_failed(s->b->c)) mps__sensor_add(s, &probe, 0, 0, s->map->key);
}

static void add_wall(const sensing *s)
{
    add_point(s, "wall", MPS_PROBE_WALL_PRESSURE);
}

static void add_fluid(const sensing *s)
{
    add_point(s, "pressure", MPS_PROBE_FLUID_PRESSURE);
}

/* "x", in 3-D "x z", or a whole point: the foot of the line. Coordinates are those of the case, as
 * for all sensors. */
static void add_gauge(const sensing *s)
{
    build *b = s->b;
    double x[3] = {0};
    mps_probe probe;
    begin(s, &probe, MPS_PROBE_GAUGE);
    const int32_t given = mps__read_numbers(b->c, s->map, "gauge", 3, x);
    const bool whole = given == 3 || (given == 2 && b->dim == 2);
    if (mps__case_failed(b->c)) return;
    probe.at[0] = x[0];
    probe.at[2] = mps__build_middle(b);
    if (b->dim == 3 && given > 1) probe.at[2] = whole ? x[2] : x[1];
    probe.at[1] = whole ? x[1] : floor_below(b, probe.at);
    check_place(s, "gauge", "the line begins", probe.at, 0.25 * b->dp);
    mps__read_numbers(b->c, s->map, "direction", 3, probe.direction);
    probe.length = mps__read_number(b->c, s->map, "length", probe.length);
    probe.count_drops = mps__read_flag(b->c, s->map, "drops", false);
    const char *fluid = mps__read_text(b->c, s->map, "fluid", "");
    const int32_t phase = fluid[0] ? mps__build_phase(b, s->map, fluid) : -1;
    if (phase >= 0) probe.phases = 1u << phase;
    const double level = mps__read_number(b->c, s->map, "level", mps__still_level(b));
    if (!mps__case_failed(b->c)) mps__sensor_add(s, &probe, 0, level - probe.at[1], s->map->key);
}

/* Record the column of a measure. */
static void note_measure(build *b, const mps_measure *m)
{
    mps_measure_info info;
    mps_measure_info_init(&info, sizeof info);
    for (int32_t k = 0; !m->at_end && mps_measure_info_get(k, &info) == MPS_OK; k++)
        if (strcmp(info.name, m->measure) == 0)
            mps__build_column(b, m->name, b->dim == 3 ? info.unit_3d : info.unit);
}

/* Names of measures have '_' instead of blanks. */
static void add_measure(const sensing *s)
{
    build *b = s->b;
    double box[2][3] = {{0}};
    char name[64];
    mps_measure m;
    mps_measure_init(&m, sizeof m);
    snprintf(name, sizeof name, "%s", mps__read_text(b->c, s->map, "measure", ""));
    for (char *p = name; *p; p++)
        if (*p == ' ') *p = '_';
    m.measure = name;
    m.name = s->map->key;
    const char *fluid = mps__read_text(b->c, s->map, "fluid", ""),
               *part = mps__read_text(b->c, s->map, "part", "");
    m.phase = fluid[0] ? mps__build_phase(b, mps__tree_find(s->map, "fluid"), fluid) : 0;
    m.part = part[0] ? part : NULL;
    m.axis = mps__read_choice(b->c, s->map, "axis", 1);
    m.change = mps__read_flag(b->c, s->map, "change", false);
    m.at_end = mps__read_flag(b->c, s->map, "at_end", false);
    m.radius = mps__read_number(b->c, s->map, "radius", 0);
    m.level = mps__read_number(b->c, s->map, "level", 0);
    m.smoothing = mps__read_number(b->c, s->map, "smoothing", m.smoothing * b->dp) / b->dp;
    m.centre[2] = mps__build_middle(b);
    mps__read_numbers(b->c, s->map, "about", 3, m.centre);
    const tree_node *given = mps__tree_find(s->map, "box");
    if (given) mps__build_points(b, given, NAN, 2, box);
    mps__sensor_box(b, name, given != NULL, box, m.box);
    if (mps__case_failed(b->c)) return;
    note(b, s->map->key, SENSOR_MEASURE);
    note_measure(b, &m);
    if (b->job) mps__build_try_job(b, mps_job_measure_add(b->job, b->sim, &m), s->map, s->map->key);
}

/* The box of a measure: as given, or that of the tank; for the front as built. */
void mps__sensor_box(const build *b, const char *measure, bool given, double (*box)[3], double *out)
{
    const build_tank *t = &b->tank;
    const bool front = strcmp(measure, "front") == 0 && t->built[0] > 0;
    for (int d = 0; d < 3; d++) {
        const bool own = given && !isnan(box[0][d]);
        out[d] = own ? fmin(box[0][d], box[1][d]) : t->form.lo[d];
        out[3 + d] = own     ? fmax(box[0][d], box[1][d])
                     : front ? t->form.lo[d] + t->built[d]
                             : t->form.hi[d];
    }
}

/* ---- all ---- */

static void add_sensor(build *b, const tree_node *map)
{
    static const char *const kind[] = {"wall",  "panel", "row",  "pressure",
                                       "gauge", "force", "load", "measure"};
    static void (*const add[])(const sensing *) = {
        add_wall,  mps__sensor_panel, mps__sensor_row,  add_fluid,
        add_gauge, mps__sensor_force, mps__sensor_load, add_measure};
    const sensing s = {b, map, false};
    add[mps__build_kind(map, kind, 8)](&s);
}

void mps__build_sensors(build *b)
{
    const tree_node *map = mps__tree_find(b->root, "sensors");
    if (b->status < 0) return;
    for (const tree_node *at = map ? map->first : NULL; at; at = at->next) {
        /* sensors are independent of each other */
        if (mps__case_failed(b->c)) mps__case_continue(b->c, true);
        add_sensor(b, at);
    }
}
