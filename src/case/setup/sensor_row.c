/* SPDX-License-Identifier: BSD-3-Clause */
/* Sensors of several probes: panels, rows, forces. */
#include "ship_motion.h"
#include "sensor.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS_MOST = 1000, CELLS_LISTED = 16 };

/* Words of sensors.*.take. */
enum { TAKE_LARGEST, TAKE_MEAN, TAKE_PLACE };

/* Probes that are reduced to one value, in the memory of the case. */
typedef struct row {
    int32_t count, take;
    double spacing; /* of a row [m] */
    int32_t id[CELLS_MOST];
} row;

static double row_value(void *user, mps_sim *sim)
{
    const row *r = user;
    double sum = 0, most = 0, place = NAN;
    for (int32_t i = 0; i < r->count; i++) {
        double value;
        if (mps_probe_read(sim, r->id[i], &value) < 0) return NAN;
        if (i == 0 || value > most) place = (i + 0.5) * r->spacing;
        most = i == 0 ? value : fmax(most, value);
        sum += value;
    }
    return r->take == TAKE_MEAN ? sum / r->count : r->take == TAKE_PLACE ? place : most;
}

/* The row of cell i of a panel with `across` cells per row. */
static int32_t row_of(int32_t i, int32_t across)
{
    return i / across;
}

/* Wall probes at positions; those with names are columns too. */
static bool add_cells(const sensing *s, mps_probe *probe, double (*at)[3], row *r, bool columns)
{
    build *b = s->b;
    char name[2 * BUILD_NAME];
    bool done = true;
    for (int32_t i = 0; done && i < r->count; i++) {
        const bool between = r->count > CELLS_LISTED && i > 0 && i < r->count - 1;
        memcpy(probe->at, at[i], sizeof probe->at);
        snprintf(name, sizeof name, "%s_%d", s->map->key, (int)i + 1);
        if (columns) {
            done = mps__sensor_add(&(sensing){b, s->map, between}, probe, 0, 0, name);
            if (done) r->id[i] = mps__sensor_id(b, name);
        } else {
            probe->name = name;
            done = mps__build_try(b, mps_probe_add(b->sim, probe, &r->id[i]), s->map, s->map->key);
        }
    }
    probe->name = NULL; /* still points to the name of the last one */
    return done;
}

static double distance(const double *a, const double *b)
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static void begin(const sensing *s, mps_probe *probe)
{
    mps_case *c = s->b->c;
    mps_probe_init(probe, sizeof *probe);
    probe->type = MPS_PROBE_WALL_PRESSURE;
    probe->average = mps__read_number(c, mps__tree_find(s->b->root, "run"), "average",
                                      probe->average);
    probe->average = mps__read_number(c, s->map, "average", probe->average);
    probe->rate = mps__read_number(c, s->map, "rate", probe->rate);
    mps__read_numbers(c, s->map, "normal", 3, probe->normal);
}

/* ---- panels ---- */

/* Whether each corner of a panel in 3-D has three coordinates: a place without z would be in the
 * middle of the tank, and the panel a line or across the tank. */
static bool has_depth(const sensing *s)
{
    const tree_node *list = mps__tree_find(s->map, "panel");
    double x[3];
    for (const tree_node *n = list ? list->first : NULL; n; n = n->next)
        if (mps__read_values(s->b->c, n, 3, x) < 3) {
            mps__sensor_log(s, "panel", "a corner needs x, y and z in 3-D");
            return false;
        }
    return true;
}

/* Corners and sides of a panel: 2 points in 2-D; 3 or 4 corners in order in 3-D, or 2 opposite
 * corners of a panel along the axes. */
static bool read_panel(const sensing *s, double *corner, double (*side)[3])
{
    build *b = s->b;
    double x[4][3];
    const int32_t count = mps__build_points(b, mps__tree_find(s->map, "panel"),
                                            mps__build_middle(b), 4, x);
    if (mps__case_failed(b->c)) return false;
    if (b->dim == 2 && count != 2) {
        mps__sensor_log(s, "panel", "needs its two ends");
        return false;
    }
    if (b->dim == 3 && !has_depth(s)) return false;
    memcpy(corner, x[0], 3 * sizeof *corner);
    memset(side, 0, 6 * sizeof **side);
    int used = 0;
    for (int d = 0; d < 3; d++) used += b->dim == 3 && count == 2 && x[1][d] != x[0][d];
    if (b->dim == 3 && count == 2 && used != 2) {
        mps__sensor_log(s, "panel",
                        used == 3
                            ? "two points are opposite corners of a panel along the axes; of "
                              "an inclined one give three corners in turn"
                            : "two points in 3-D are opposite corners, which differ along two "
                              "axes");
        return false;
    }
    used = 0;
    for (int d = 0; d < 3; d++) {
        if (b->dim == 2) side[0][d] = x[1][d] - x[0][d];
        if (b->dim == 3 && count > 2) {
            side[0][d] = x[1][d] - x[0][d];
            side[1][d] = x[2][d] - x[1][d];
        }
        if (b->dim == 3 && count == 2 && x[1][d] != x[0][d]) side[used++][d] = x[1][d] - x[0][d];
    }
    return true;
}

void mps__sensor_panel(const sensing *s)
{
    static const double zero[3] = {0};
    build *b = s->b;
    double corner[3], side[2][3], cells[2] = {1, 1}, (*at)[3];
    mps_probe probe;
    row *r = mps__build_alloc(b, sizeof *r);
    begin(s, &probe);
    const int32_t given = mps__read_numbers(b->c, s->map, "cells", 2, cells);
    if (b->dim == 2) cells[1] = 1;
    if (b->dim == 3 && given == 1) cells[1] = cells[0];
    if (!r || mps__case_failed(b->c) || !read_panel(s, corner, side)) return;
    r->count = (int32_t)(cells[0] * cells[1]);
    r->take = TAKE_MEAN;
    if (r->count > CELLS_MOST) {
        mps__sensor_log(s, "cells", "more than 1000 in all");
        return;
    }
    const double a = distance(side[0], zero) / cells[0], c = distance(side[1], zero) / cells[1];
    probe.diameter = b->dim == 2 ? a : 2 * sqrt(a * c / acos(-1.0)); /* a disc of the cell's area */
    at = mps__build_alloc(b, (size_t)r->count * sizeof *at);
    const int32_t across = (int32_t)cells[0];
    for (int32_t i = 0; at && i < r->count; i++)
        for (int d = 0; d < 3; d++)
            at[i][d] = corner[d] + (i % across + 0.5) / cells[0] * side[0][d] +
                       (b->dim == 3 ? (row_of(i, across) + 0.5) / cells[1] * side[1][d] : 0);
    if (!at) return;
    if (r->count == 1) {
        memcpy(probe.at, at[0], sizeof probe.at);
        mps__sensor_add(s, &probe, 0, 0, s->map->key);
    } else if (add_cells(s, &probe, at, r, true))
        mps__sensor_value(s, s->map->key, "Pa", "Wall pressure: mean of the cells of the panel",
                          row_value, r);
}

/* ---- rows ---- */

void mps__sensor_row(const sensing *s)
{
    static const char *const about[] = {"Largest wall pressure: of the sensors of a row",
                                        "Wall pressure: mean of the sensors of a row",
                                        "Place of the largest wall pressure: distance from the "
                                        "beginning of the row"};
    build *b = s->b;
    double x[2][3], cells = 1, (*at)[3];
    mps_probe probe;
    row *r = mps__build_alloc(b, sizeof *r);
    begin(s, &probe);
    probe.diameter = mps__read_number(b->c, s->map, "diameter", probe.diameter);
    mps__read_numbers(b->c, s->map, "cells", 1, &cells);
    const tree_node *node = mps__tree_find(s->map, "row");
    mps__build_points(b, node, mps__build_middle(b), 2, x);
    if (!r || mps__case_failed(b->c)) return;
    r->count = (int32_t)cells;
    r->take = mps__read_choice(b->c, s->map, "take", TAKE_LARGEST);
    r->spacing = distance(x[0], x[1]) / cells;
    at = mps__build_alloc(b, (size_t)r->count * sizeof *at);
    for (int32_t i = 0; at && i < r->count; i++)
        for (int d = 0; d < 3; d++) at[i][d] = x[0][d] + (i + 0.5) / cells * (x[1][d] - x[0][d]);
    if (at && add_cells(s, &probe, at, r, false))
        mps__sensor_value(s, s->map->key, r->take == TAKE_PLACE ? "m" : "Pa", about[r->take],
                          row_value, r);
}

/* ---- forces ---- */

/* Force or moment along an axis of the ship, in the memory of the case. */
typedef struct ship_load {
    mps_ship ship;
    int32_t probe, axes, component;
    double at[3], sign;
} ship_load;

static double load_value(void *user, mps_sim *sim)
{
    const ship_load *l = user;
    double lab[6], load[6];
    mps_motion_state pose = {.struct_size = sizeof pose};
    if (mps_probe_read(sim, l->probe, lab) < 0 || mps_motion_state_get(sim, &pose) < 0) return NAN;
    const mps_status status = mps_ship_load_from_lab(&l->ship, &pose, l->axes, l->at, lab, load);
    return status < 0 ? NAN : l->sign * load[l->component];
}

/* Columns along the axes of the ship; the probe itself has no column. */
static void add_ship_loads(const sensing *s, mps_probe *probe, int32_t chosen, int32_t axes)
{
    static const char *const name[] = {"surge", "sway", "heave", "roll", "pitch", "yaw"};
    build *b = s->b;
    char text[2 * BUILD_NAME], about[BUILD_TEXT];
    int32_t id;
    if (b->dim == 2 || (!mps__tree_find(b->root, "motion") && !mps__tree_find(b->root, "body"))) {
        mps__sensor_log(s, "axes", "are for 3-D and a motion");
        return;
    }
    if (!b->motion) return; /* it has errors of its own */
    snprintf(text, sizeof text, "%s.lab", s->map->key);
    probe->name = text;
    const bool added = mps__build_try(b, mps_probe_add(b->sim, probe, &id), s->map, s->map->key);
    probe->name = NULL;
    if (!added) return;
    for (int32_t k = 0; k < 6; k++) {
        if (chosen > 0 && chosen - 1 != k) continue;
        ship_load *l = mps__build_alloc(b, sizeof *l);
        if (!l) return;
        *l = (ship_load){
            b->motion->ship, id, axes - 1, k, {probe->at[0], probe->at[1], probe->at[2]}, 1};
        if (b->motion->flipped && k % 3 == 1) l->sign = -1;
        memcpy(l->ship.origin, probe->at, sizeof l->ship.origin);
        snprintf(text, sizeof text, "%s%s%s", s->map->key, chosen > 0 ? "" : "_",
                 chosen > 0 ? "" : name[k]);
        snprintf(about, sizeof about, "%s of the liquid, %s: along axes of the ship %s",
                 k < 3 ? "Force" : "Moment", name[k], axes == 1 ? "at rest" : "that turn with it");
        if (!mps__sensor_value(s, text, k < 3 ? "N" : "N m", about, load_value, l)) return;
    }
}

/* A tank on a lattice has one part per face, with the common prefix "tank."; a body has its
 * name. */
static const char *find_part(const build *b, const char *name, char *buffer, size_t size)
{
    if (strcmp(name, "all") == 0) return NULL;
    if (mps_part_find(b->sim, name) >= 0 || strchr(name, '.')) return name;
    if (strcmp(name, "tank") != 0) return name;
    snprintf(buffer, size, "%s.", name);
    return buffer;
}

void mps__sensor_force(const sensing *s)
{
    static const char *const ending[2][6] = {{"x", "y", "m"}, {"x", "y", "z", "mx", "my", "mz"}};
    build *b = s->b;
    char part[BUILD_NAME], name[2 * BUILD_NAME];
    mps_probe probe;
    begin(s, &probe);
    probe.type = MPS_PROBE_FORCE;
    probe.part = find_part(b, mps__read_text(b->c, s->map, "force", "all"), part, sizeof part);
    mps__read_numbers(b->c, s->map, "about", 3, probe.at);
    /* all, x, y, z, mx, my, mz */
    const int32_t chosen = mps__read_choice(b->c, s->map, "component", 0),
                  axes = mps__read_choice(b->c, s->map, "axes", 0);
    if (mps__case_failed(b->c)) return;
    if (b->dim == 2 && (chosen == 3 || chosen == 4 || chosen == 5)) {
        mps__sensor_log(s, "component", "in 2-D there are x, y and mz");
        return;
    }
    if (axes > 0) {
        add_ship_loads(s, &probe, chosen, axes);
        return;
    }
    for (int32_t k = 0; k < (b->dim == 3 ? 6 : 3); k++) {
        const int32_t component = b->dim == 2 && k == 2 ? 5 : k;
        if (chosen > 0 && chosen - 1 != component) continue;
        snprintf(name, sizeof name, "%s%s%s", s->map->key, chosen > 0 ? "" : "_",
                 chosen > 0 ? "" : ending[b->dim - 2][k]);
        if (!mps__sensor_add(s, &probe, k, 0, name)) return;
    }
}
