/* SPDX-License-Identifier: BSD-3-Clause */
/* Describes a case in a text for users. */
#include "picture_scene.h"
#include "check.h"
#include "run.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STEPS = 3 }; /* timed steps, after the first */

void mps__check_heading(const writer *w, const char *name)
{
    fprintf(w->file, "%-9s ", name);
}

/* A number with few digits and a convenient prefix: 0.25 m is "250 mm". */
static const char *length_text(double x, char *out, size_t size)
{
    const double a = fabs(x);
    if (a > 0 && a < 1e-3)
        snprintf(out, size, "%.4g um", x * 1e6);
    else if (a > 0 && a < 0.1)
        snprintf(out, size, "%.4g mm", x * 1e3);
    else
        snprintf(out, size, "%.4g m", x);
    return out;
}

/* Coordinates to a hundredth of dp, without trailing zeros: also for a tank far from the origin. */
void mps__check_place(const writer *w, const build *b, const double *x)
{
    const int decimals = (int)fmin(12, fmax(0, ceil(2 - log10(b->dp))));
    for (int32_t d = 0; d < b->dim; d++) {
        char text[400];
        snprintf(text, sizeof text, "%.*f", decimals, x[d]);
        size_t length = strlen(text);
        while (strchr(text, '.') && strchr("0.", text[length - 1])) {
            const bool point = text[--length] == '.';
            text[length] = '\0';
            if (point) break;
        }
        fprintf(w->file, "%s%s", d ? ", " : "(", strcmp(text, "-0") == 0 ? "0" : text);
    }
    fprintf(w->file, ") m");
}

/* ---- contents ---- */

/* dp as requested; as built, and the cells of the lattice, if these differ. */
static void write_spacing(const writer *w, const build *b)
{
    char text[32];
    int32_t dim;
    double dp = b->dp, h[3] = {0, 0, 0};
    bool cubes = true;
    fprintf(w->file, "dp %s", length_text(b->dp, text, sizeof text));
    if (mps_sim_shape(b->sim, &dim, &dp) == MPS_OK && fabs(dp - b->dp) > 1e-6 * dp)
        fprintf(w->file, " requested, %s built", length_text(dp, text, sizeof text));
    if (mps_lattice_get(b->sim, NULL, h) != MPS_OK) return;
    for (int32_t d = 0; d < b->dim; d++) cubes = cubes && fabs(h[d] - dp) <= 1e-6 * dp;
    if (cubes) return;
    fprintf(w->file, " in cells of");
    for (int32_t d = 0; d < b->dim; d++)
        fprintf(w->file, "%s %s", d ? " x" : "", length_text(h[d], text, sizeof text));
}

/* Write corners of a box, or ends of a plate. */
static void write_corners(const writer *w, const build *b, const double *from, const double *to)
{
    mps__check_place(w, b, from);
    fprintf(w->file, " to ");
    mps__check_place(w, b, to);
}

/* Write openings of a plate with their extent along its first side, from the first point. */
static void write_slots(const writer *w, const build *b, const build_solid *s)
{
    const double length = s->slots * s->pitch;
    double widest = 0, narrowest = INFINITY;
    fprintf(w->file, ", %d slot%s from the first point at", (int)s->slots,
            s->slots == 1 ? "" : "s");
    for (int32_t i = 0; i < s->slots; i++) {
        double before[2], after[2];
        mps__solid_piece(s, i, before);
        mps__solid_piece(s, i + 1, after);
        const double gap = (after[0] - before[1]) * length;
        widest = fmax(widest, gap);
        narrowest = fmin(narrowest, gap);
        if (i < 4 || s->slots == 5 || i + 1 == s->slots)
            fprintf(w->file, " %.4g..%.4g%s", before[1] * length, after[0] * length,
                    i + 1 < s->slots ? "," : " m");
        else if (i == 4)
            fprintf(w->file, " ..,");
    }
    fprintf(w->file, ", %.4g", narrowest);
    if (widest - narrowest > 1e-6 * b->dp) fprintf(w->file, " to %.4g", widest);
    fprintf(w->file, " m wide = %.3g dp, requested %.4g m", narrowest / b->dp, s->gap);
}

/* Write a solid in one line: as built, and as requested if that differs. */
static void write_solid(const writer *w, const build *b, const build_solid *s)
{
    double from[3], to[3], part[2], off = 0;
    fprintf(w->file, "%s", s->name);
    if (!s->box && !s->plate) return;
    for (int d = 0; d < 3; d++) {
        const double a = s->end[0][d], e = s->end[1][d];
        mps__solid_piece(s, 0, part);
        from[d] = s->box ? s->form.lo[d] : a + part[0] * (e - a) + s->second[0][d];
        mps__solid_piece(s, s->slots, part);
        to[d] = s->box ? s->form.hi[d] : a + part[1] * (e - a) + s->second[1][d];
        if (d < b->dim)
            off = fmax(off, fmax(fabs(from[d] - s->asked[0][d]), fabs(to[d] - s->asked[1][d])));
    }
    fprintf(w->file, ": %s as built ", s->box ? "box" : "plate");
    write_corners(w, b, from, to);
    if (off > 1e-6 * b->dp) {
        fprintf(w->file, ", requested ");
        write_corners(w, b, s->asked[0], s->asked[1]);
        if (s->why) fprintf(w->file, " (%s)", s->why);
    }
    if (s->slots > 0) write_slots(w, b, s);
}

static void write_tank(const writer *w, const build *b)
{
    static const char *const kind[] = {"box", "polygon", "body", "cylinder", "ball"};
    const form *t = &b->tank.form;
    mps__check_heading(w, "case");
    fprintf(w->file, "%d-D, ", (int)b->dim);
    write_spacing(w, b);
    fprintf(w->file, ", gravity %g m/s2, model %s\n", b->gravity, b->model);
    mps__check_heading(w, "tank");
    fprintf(w->file, "%s, %.4g x %.4g", b->tank.file ? "file" : kind[t->kind], t->hi[0] - t->lo[0],
            t->hi[1] - t->lo[1]);
    if (b->dim == 3) fprintf(w->file, " x %.4g", t->hi[2] - t->lo[2]);
    fprintf(w->file, " m, lower corner ");
    mps__check_place(w, b, t->lo);
    if (!b->tank.file)
        fprintf(w->file, ", %.5g %s inside", mps__form_volume(t), b->dim == 3 ? "m3" : "m2");
    for (int d = 0; d < b->dim && b->tank.built[0] > 0; d++)
        if (fabs(b->tank.built[d] - b->tank.size[d]) > 1e-6 * b->dp)
            fprintf(w->file, "; built %.5g m along %c", b->tank.built[d], "xyz"[d]);
    if (b->dim == 2 && b->tank.size[2] > 0 && !mps__tree_find(b->root, "dim"))
        fprintf(w->file, "; in 2-D the third number of 'size' is not used, 'dim: 3' uses it");
    fprintf(w->file, "\n");
    for (int32_t i = 0; i < b->solids; i++) {
        mps__check_heading(w, i ? "" : "solids");
        write_solid(w, b, &b->solid[i]);
        fprintf(w->file, "\n");
    }
}

/* Write the log of the library. If a fill has whole layers beside inclined walls, its cells
 * overlap: its volume, counted in cells, is left out. */
static void write_log(const writer *w, const build *b)
{
    const bool straight = b->tank.form.kind == FORM_BOX && !b->tank.file,
               whole = b->several || b->paper;
    bool first = true;
    for (int32_t i = 0; i < b->log->count; i++) {
        const bool fill = strncmp(b->log->text[i], "fill of phase", 13) == 0;
        if (fill && whole && !straight) continue;
        mps__check_heading(w, first ? "library" : "");
        first = false;
        fprintf(w->file, "%s%s\n", b->log->level[i] ? "warning: " : "", b->log->text[i]);
    }
    if (b->log->further == 0) return;
    mps__check_heading(w, "");
    fprintf(w->file, ".. and %d more messages like these\n", (int)b->log->further);
}

/* A text that is incomplete because memory was exhausted is discarded. @return status is MPS_OK */
static bool is_done(build *b, mps_status status)
{
    if (status == MPS_E_NOMEM) b->status = status;
    return status == MPS_OK;
}

/* Particles of the liquid in the top layer of the lattice, and in the layer below. */
typedef struct top_rows {
    double y;
    int64_t top, below;
} top_rows;

static bool find_rows(build *b, top_rows *r)
{
    mps_lease x = {.struct_size = sizeof x}, kind = x;
    double h[3] = {0, b->dp, 0};
    if (mps_lattice_get(b->sim, NULL, h) != MPS_OK) h[1] = b->dp;
    *r = (top_rows){.y = -INFINITY};
    bool good = is_done(b, mps_lease_begin(b->sim, "position", MPS_READ, &x));
    good = good && is_done(b, mps_lease_begin(b->sim, "kind", MPS_READ, &kind));
    for (int64_t i = 0; good && i < x.count; i++)
        if (kind.integers[i] == MPS_FLUID) r->y = fmax(r->y, x.data[i * x.stride + 1]);
    for (int64_t i = 0; good && i < x.count; i++) {
        const double below = (r->y - x.data[i * x.stride + 1]) / h[1];
        if (kind.integers[i] != MPS_FLUID || below > 1.5) continue;
        *(below > 0.5 ? &r->below : &r->top) += 1;
    }
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &x);
    return good && r->top > 0 && r->below > 0;
}

/* A level between two rows leaves the uppermost one with the particles that the volume asks for,
 * in groups or beside walls: steps in the surface. Measured in boxes of 4 and 20 rows, 2-D and 3-D,
 * and in a polygon of 3.6 rows: the level of the pressures is off by up to .39 rows at the start
 * and by up to .2 rows later.
 * @return whether it was written */
static bool write_top(const writer *w, build *b, double percent)
{
    top_rows r;
    if (b->fluids != 1 || !mps__build_filled(b) || !find_rows(b, &r)) return false;
    const double share = (double)r.top / (double)r.below;
    if (share > 0.9) return false; /* complete, or narrower because of a slope */
    mps__check_heading(w, "");
    fprintf(w->file,
            "the uppermost row has %.2g %% of the particles of the row below: steps of one spacing "
            "in the surface, which become waves of less than half of it; the pressures' "
            "level is off by up to half a spacing, %.2g %% at the bottom\n",
            100 * share, percent);
    return true;
}

/* A liquid of less than three layers has no waves: usually its unit, or that of dp, is wrong. With
 * few layers, cells beside slopes and solids are a large part of the liquid: loads at rest of
 * random tanks of 4 to 6 rows with solids or chamfers were off by up to 9 %. */
static void write_rows(const writer *w, build *b)
{
    const double rows = (b->level - b->tank.form.lo[1]) / b->dp, percent = 50 / rows;
    if (b->depth < 3 * b->dp) {
        mps__check_heading(w, "");
        fprintf(w->file,
                "the liquid is only %.2g spacings deep: no wave is resolved; give a finer dp\n",
                b->depth / b->dp);
    }
    if (write_top(w, b, percent) || !(rows < 6) || b->fluids != 1) return;
    if (b->tank.form.kind == FORM_BOX && !b->tank.file && b->solids == 0) return;
    mps__check_heading(w, "");
    fprintf(
        w->file,
        "the liquid has about %.2g rows of particles: the pressures' level is off by up to half "
        "a spacing, %.2g %% at the bottom\n",
        rows, percent);
}

static void write_fluids(const writer *w, build *b)
{
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    mps__check_heading(w, "particles");
    fprintf(w->file, "%lld of fluid, %lld of walls, %lld behind walls\n",
            (long long)mps_particles_count(b->sim, MPS_FLUID),
            (long long)mps_particles_count(b->sim, MPS_WALL),
            (long long)mps_particles_count(b->sim, MPS_DUMMY));
    for (int32_t i = 0; i < b->fluids; i++) {
        mps__check_heading(w, i ? "" : "fluids");
        fprintf(w->file, "phase %d: %s, %g kg/m3, %g Pa s\n", (int)i, b->fluid[i].name,
                b->fluid[i].density, b->fluid[i].viscosity);
    }
    write_log(w, b);
    if (is_done(b, mps_energy_get(b->sim, &e))) {
        const char *unit = b->dim == 3 ? "m3" : "m2";
        const form *t = &b->tank.form;
        const double exact = b->tank.file || isnan(b->depth)
                                 ? NAN
                                 : mps__form_volume_below(t, t->lo[1] + b->depth);
        mps__check_heading(w, "volume");
        fprintf(w->file, "%.5g %s of all fluid, %.5g kg", e.volume_filled, unit, e.mass_filled);
        if (b->fluids == 1 && isfinite(exact))
            fprintf(w->file, "; the tank alone holds %.5g %s up to the level", exact, unit);
        fprintf(w->file, "\n");
    }
    if (mps__build_filled(b)) {
        mps__check_heading(w, "level");
        fprintf(w->file, "y = %.5g m as filled, %.5g m requested\n", b->level,
                b->tank.form.lo[1] + b->depth);
        write_rows(w, b);
    }
}

/* Write which solids pierce the surface, and the periods of the open part if no liquid passes below
 * them. */
static void write_blocks(const writer *w, const build *b)
{
    const build_modes *m = &b->modes;
    bool closed = false;
    for (int32_t k = 0; k < m->blocks; k++) {
        const build_block *s = &m->block[k];
        mps__check_heading(w, k ? "" : "surface");
        fprintf(w->file, "solid '%s' stands in it, %c = %.4g", b->solid[s->solid].name,
                "xyz"[m->axis], s -> lo);
        if (s->hi - s->lo > 0.01 * b->dp) fprintf(w->file, " .. %.4g", s->hi);
        fprintf(w->file, " m%s\n", s->across ? "" : ", not from side to side");
        closed = closed || s->across;
    }
    if (!closed || !(m->open > 0)) return;
    mps__check_heading(w, "");
    fprintf(w->file,
            "if no liquid passes below or through them, the first period of the longest open "
            "stretch, %.4g m, is %.4g s\n",
            m->open, mps__modes_period(b, m->open));
}

/* The first wave along the other horizontal axis: a motion of a file may have all degrees of
 * freedom. */
static void write_other_axis(const writer *w, const build *b)
{
    const build_modes *m = &b->modes;
    const int other = 2 - m->axis;
    const form *t = &b->tank.form;
    const double k = acos(-1.0) / (t->hi[other] - t->lo[other]);
    mps__check_heading(w, "");
    fprintf(w->file, "along %c: T1 %.4g s, estimated by length %.4g m and depth %.4g m\n",
            "xyz"[other], 2 * acos(-1.0) / sqrt(b->gravity * k * tanh(k * m->depth)),
            t->hi[other] - t->lo[other], m->depth);
}

static void write_modes(const writer *w, const build *b)
{
    const build_modes *m = &b->modes;
    if (m->count == 0) return;
    mps__check_heading(w, "periods");
    for (int32_t i = 0; i < m->count; i++)
        fprintf(w->file, "%sT%d %.4g s", i ? ", " : "", (int)i + 1, m->period[i]);
    fprintf(w->file, " (waves along %c)\n", "xyz"[m->axis]);
    mps__check_heading(w, "");
    fprintf(w->file, "by %s%s\n", m->how, mps__modes_without(b));
    if (b->dim == 3) write_other_axis(w, b);
    write_blocks(w, b);
}

/* A force is along an axis; a moment is about an axis through a point. */
static void write_force(const writer *w, const build *b, const build_sensor *s)
{
    const bool moment = s->component >= b->dim;
    const int axis = !moment ? s->component : b->dim == 3 ? s->component - 3 : 2;
    fprintf(w->file, moment ? "moment about %c through " : "force along %c", "xyz"[axis]);
    if (moment) mps__check_place(w, b, s->at);
}

static void write_sensor(const writer *w, build *b, const build_sensor *s)
{
    static const char *const kind[] = {"wall pressure", "pressure", "gauge"};
    fprintf(w->file, "%s: ", s->name);
    if (s->kind == SENSOR_VALUE)
        fprintf(w->file, "%s", s->about);
    else if (s->kind == SENSOR_MEASURE)
        fprintf(w->file, "measure");
    else if (s->kind == SENSOR_FORCE)
        write_force(w, b, s);
    else {
        fprintf(w->file, "%s at ", kind[s->kind]);
        mps__check_place(w, b, s->at);
    }
    if (s->part[0]) fprintf(w->file, " on '%s'", s->part);
    if (s->kind == SENSOR_WALL) fprintf(w->file, ", %.4g m wide", s->diameter);
    const double off = s->kind == SENSOR_WALL && strncmp(s->part, "tank", 4) == 0
                           ? fabs(mps__form_inside(&b->tank.form, s->at))
                           : 0;
    if (!b->tank.file && off > 1e-6 * b->dp)
        fprintf(w->file, "; its place is %.3g m off the wall", off);
    const double above = s->at[1] - mps__still_level(b);
    if ((s->kind == SENSOR_WALL || s->kind == SENSOR_FLUID) && above > 0)
        fprintf(w->file, "; %.3g m above the liquid at rest: 0 Pa until liquid comes there", above);
    fprintf(w->file, "\n");
}

/* If there is gas above the liquid, the interface is half a spacing above the top layer; a free
 * surface is at that layer. */
static void write_static_excess(const writer *w, const build *b)
{
    double dp = b->dp;
    if (!b->several || b->fluids < 2 || !(b->gravity > 0) || b->sensors == 0) return;
    mps_sim_shape(b->sim, NULL, &dp);
    const double step = b->fluid[0].density - b->fluid[b->fluids - 1].density;
    mps__check_heading(w, "");
    fprintf(w->file,
            "static pressures in the liquid are %.3g Pa too high: with gas above it the interface "
            "is half a spacing above the upper row. Take them off, or use a finer spacing\n",
            0.5 * step * b->gravity * dp);
}

static void write_sensors(const writer *w, build *b)
{
    for (int32_t i = 0; i < b->sensors; i++) {
        mps__check_heading(w, i ? "" : "sensors");
        write_sensor(w, b, &b->sensor[i]);
        if (b->sensor[i].further == 0) continue;
        mps__check_heading(w, "");
        fprintf(w->file, ".. and %d more cells, to\n", (int)b->sensor[i].further);
    }
    if (b->unlisted > 0) {
        mps__check_heading(w, "");
        fprintf(w->file, ".. and %d more columns, which the drawing leaves out too\n",
                (int)b->unlisted);
    }
    write_static_excess(w, b);
}

static void write_plugins(const writer *w, const build *b)
{
    static const char *const kind[] = {"model", "solver", "preconditioner", "load", "motion"};
    const mps_plugin_file *p;
    mps_plugin_info info;
    mps_plugin_item item;
    mps_plugin_info_init(&info, sizeof info);
    mps_plugin_item_init(&item, sizeof item);
    for (int32_t k = 0; (p = mps_case_plugin(b->c, k)) != NULL; k++) {
        if (mps_plugin_info_get(p, &info) != MPS_OK) continue;
        mps__check_heading(w, k ? "" : "plug-ins");
        fprintf(w->file, "%s %s: %s, SHA-256 %.16s..\n", info.name, info.version, info.path,
                info.sha256);
        for (int32_t i = 0; mps_plugin_item_get(p, i, &item) == MPS_OK; i++) {
            mps__check_heading(w, "");
            fprintf(w->file, "%s %s%s%s\n", kind[item.kind], item.name, item.help[0] ? ": " : "",
                    item.help);
        }
    }
}

/* ---- cost ---- */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Largest speed of the tank relative to uniform motion, at its corners: a uniform motion of tank
 * and liquid causes no flow. */
static double tank_speed(const build *b)
{
    const build_motion *m = b->motion;
    double most = 0;
    for (int32_t d = 0; m && d < 3; d++) most = fmax(most, 0.5 * (m->rate[d][1] - m->rate[d][0]));
    for (int32_t d = 3; m && d < 6; d++) {
        const form *t = &b->tank.form;
        const double reach = fmax(fabs(t->hi[0] - m->centre[0]), fabs(t->hi[1] - m->centre[1]));
        most = fmax(most, m->largest[d][1] * reach);
    }
    return most;
}

/* Expected steps of a run: with waves of half the depth, and with liquid that falls through the
 * tank all the time. */
typedef struct forecast {
    double calm, fast; /* length of steps [s] */
    double speed;      /* of the fast liquid [m/s] */
    double took;       /* wall clock of a step at rest [s] */
    double least, most;
} forecast;

/* A step at rest is the cheapest: the pressure solver starts from still water, no particle
 * collides. docs/performance.md: in runs the cost per particle and step is up to 1.75 times that of
 * the cheapest one. */
static forecast find_forecast(build *b, double dt, double took)
{
    const double slowest = 1.75;
    const tree_node *run = mps__tree_find(b->root, "run");
    const double depth = b->modes.count ? b->modes.depth : b->tank.form.hi[1] - b->tank.form.lo[1];
    const double wave = 2 * tank_speed(b) + 0.5 * sqrt(b->gravity * depth);
    const double fall = sqrt(2 * b->gravity * (b->tank.form.hi[1] - b->tank.form.lo[1]));
    const double factor = mps__read_number(b->c, run, "step_factor", 1);
    const double cfl = factor * mps__read_number(b->c, run, "cfl", 0.3);
    forecast f = {.calm = dt, .fast = dt, .speed = 2 * tank_speed(b) + fall, .took = took};
    if (!(mps__read_number(b->c, run, "dt", 0) > 0)) {
        if (wave > 0) f.calm = fmin(dt, cfl * b->dp / wave);
        if (f.speed > 0) f.fast = fmin(f.calm, cfl * b->dp / f.speed);
    }
    f.least = took * b->until / f.calm;
    f.most = slowest * took * b->until / f.fast;
    return f;
}

/* Write both in the unit of the larger one: "3.9 to 9.1 s". */
static void write_span(const writer *w, double least, double most)
{
    const double unit = most < 100 ? 1 : most < 6000 ? 60 : 3600;
    fprintf(w->file, "about %.2g to %.2g %s of wall clock", least / unit, most / unit,
            unit > 60  ? "h"
            : unit > 1 ? "min"
                       : "s");
}

/* Warn if several rows of probes.csv are within a step: they have interpolated values at the
 * requested rate. */
static void write_rate(const writer *w, const build *b, double dt)
{
    const tree_node *output = mps__tree_find(b->root, "output");
    const double rate = mps__read_number(b->c, output, "rate", 1000);
    if (dt * rate < 2) return;
    mps__check_heading(w, "rows");
    fprintf(
        w->file,
        "%.4g Hz: about %.2g rows of probes.csv in each step, with the same values; 'output.rate: "
        "%.2g Hz' has one\n",
        rate, dt * rate, 1 / dt);
}

/* Memory of a run [bytes]: of its steps, plus the larger one of its last picture and of its
 * page: a frame of all particles with eleven numbers each, their indices by id, and the packed
 * fluid. */
static double find_memory(build *b)
{
    const double steps = mps__job_peak_memory(), all = (double)mps_particles_count(b->sim, -1),
                 fluid = (double)mps_particles_count(b->sim, MPS_FLUID);
    const tree_node *output = mps__tree_find(b->root, "output");
    const bool page = mps__read_number(b->c, output, "page", 1) > 0 &&
                      mps__read_number(b->c, output, "frames", 1) > 0;
    is_done(b, mps__scene_rehearse(b->sim));
    return fmax(mps__job_peak_memory(), page ? steps + 100 * all + 80 * fluid : 0);
}

static void write_cost(const writer *w, build *b)
{
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps__check_heading(w, "run");
    fprintf(w->file, "%.5g s", b->until);
    if (b->modes.count) fprintf(w->file, " = %.3g T1", b->until / b->modes.period[0]);
    double took = 0;
    mps_status status = MPS_OK;
    for (int i = 0; i <= STEPS && status >= 0; i++) {
        const double before = seconds();
        status = mps_step(b->sim, b->until, &info);
        if (i > 0) took += (seconds() - before) / STEPS;
    }
    if (status < 0) {
        is_done(b, status);
        mps__case_log(b->c, mps__tree_find(b->root, "run"), false, "the first steps fail: %s",
                      mps_sim_error(b->sim));
        return;
    }
    const forecast f = find_forecast(b, info.dt, took);
    fprintf(w->file, ", steps of about %.2g s", f.calm);
    if (f.fast < 0.99 * f.calm) fprintf(w->file, ", %.2g s in liquid of %.2g m/s", f.fast, f.speed);
    fprintf(w->file, "\n");
    write_rate(w, b, f.calm);
    const double memory = find_memory(b);
    mps__check_heading(w, "cost");
    write_span(w, f.least, f.most);
    fprintf(w->file,
            ": calm to violent; outputs apart (%.2g s a step at rest, %d steps measured), %.0f MB "
            "of memory\n",
            f.took, STEPS, 1e-6 * memory);
    b->c->cost = (mps_case_cost){.struct_size = sizeof b->c->cost,
                                 .wall_least = f.least,
                                 .wall_most = f.most,
                                 .memory = memory};
}

/* Size of the frames on the disk: so many bytes per particle. */
static void write_frames(const writer *w, const build *b)
{
    static const double BYTES = 62;
    const double each = 2000 + BYTES * ((double)mps_particles_count(b->sim, MPS_FLUID) +
                                        (double)mps_particles_count(b->sim, MPS_WALL));
    const double apart = b->until / b->frames, omega = mps__build_omega(b);
    if (b->frames == 0) return;
    mps__check_heading(w, "frames");
    fprintf(w->file, "%d, every %.3g s", (int)b->frames, apart);
    if (isfinite(omega))
        fprintf(w->file, ", %.3g a period of the motion", 2 * acos(-1.0) / omega / apart);
    else if (b->modes.count > 0)
        fprintf(w->file, ", %.3g a period T1", b->modes.period[0] / apart);
    fprintf(w->file, "; %.2g MB each, %.2g MB on the disk; finer ones about the highest peaks\n",
            1e-6 * each, 1e-6 * each * (b->frames + 1));
}

char *mps__check_write(build *b)
{
    writer w = {NULL, 0, NULL};
    w.file = open_memstream(&w.text, &w.size);
    if (!w.file) return NULL;
    write_tank(&w, b);
    write_fluids(&w, b);
    write_modes(&w, b);
    mps__check_write_motion(&w, b);
    write_sensors(&w, b);
    write_plugins(&w, b);
    write_frames(&w, b);
    write_cost(&w, b);
    if (fclose(w.file) != 0) {
        free(w.text);
        return NULL;
    }
    return w.text;
}
