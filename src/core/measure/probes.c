/* SPDX-License-Identifier: BSD-3-Clause */
/* Probes: checks of new probes, forces. Wall sensors, fluid pressures, gauges and series have their
 * own files. */
#include "probes.h"
#include "collect.h"
#include "plates.h"
#include "probe_fluid.h"
#include "probe_gauge.h"
#include "rotation.h"
#include "terms.h"
#include <math.h>
#include <mps/couple.h>
#include <stdio.h>
#include <string.h>

/* Highest sampling rate [Hz], so that sample numbers stay exact. */
static const double RATE_MAX = 1e9;

void mps__probe_across(int32_t dim, const double d[3], double out[2][3])
{
    if (dim == 2) {
        out[0][0] = -d[1];
        out[0][1] = d[0];
        return;
    }
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(d[k]) < fabs(d[least])) least = k;
    double norm = sqrt(1 - d[least] * d[least]);
    for (int k = 0; k < 3; k++) out[0][k] = ((k == least) - d[least] * d[k]) / norm;
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        out[1][k] = d[a] * out[0][b] - d[b] * out[0][a];
    }
}

/* ---- forces ---- */

static bool part_matches(const char *wanted, const char *name)
{
    size_t length = strlen(wanted);
    if (length > 0 && wanted[length - 1] == '.') return strncmp(wanted, name, length) == 0;
    return strcmp(wanted, name) == 0;
}

/* Particles on an edge of a tank have area of two or three faces but one part: the component of the
 * area along axis d belongs to the face it points away from, "<name>.x0" if it points along +x; at
 * the foot of a thin plate it belongs to the plate. */
static bool face_wanted(const mps__world *w, const mps__probe *probe, int64_t i, int d)
{
    const mps__particles *s = &w->particles;
    char name[MPS__PART_NAME];
    if (!probe->config.part) return true;
    if (s->part[i] < 0) return false;
    const int32_t part = mps__plates_part(w, i, d);
    if (part >= 0) return part_matches(probe->part_name, s->part_name[part]);
    memcpy(name, s->part_name[s->part[i]], sizeof name);
    const size_t n = strlen(name);
    const double across = s->area[i * s->dim + d];
    if (across != 0 && n > 3 && name[n - 3] == '.' && strchr("xyz", name[n - 2]) &&
        strchr("01", name[n - 1])) {
        const char own[2] = {name[n - 2], name[n - 1]};
        name[n - 2] = "xyz"[d];
        name[n - 1] = across > 0 ? '0' : '1';
        if (mps__part_number((mps__particles *)s, name, false) < 0) memcpy(name + n - 2, own, 2);
    }
    return part_matches(probe->part_name, name);
}

/* Reported force on the fluid and its moment about `at`. */
static void add_reactions(const mps__world *w, const mps__probe *probe, const double at[3],
                          double total[6])
{
    const mps__particles *s = &w->particles;
    const mps__motion *m = &w->motion;
    double centre[3] = {0};
    mps__motion_point(m, &m->now, m->centre, centre, NULL, NULL);
    const double r[3] = {centre[0] - at[0], centre[1] - at[1], centre[2] - at[2]};
    for (int32_t k = 0; k <= s->parts; k++) {
        const mps__reaction *own = &w->state.reaction[k];
        double f[3] = {0}, about[3] = {0}, arm[3];
        if (probe->config.part && (k == 0 || !part_matches(probe->part_name, s->part_name[k - 1])))
            continue;
        for (int d = 0; d < 3; d++) {
            f[d] = mps__dot(m->now.rotation + 3 * d, own->force, 3);
            about[d] = mps__dot(m->now.rotation + 3 * d, own->moment, 3);
        }
        mps__cross(r, f, arm);
        for (int d = 0; d < 3; d++) {
            total[d] -= f[d];
            total[3 + d] -= about[d] + arm[d];
        }
    }
}

/* Sum of -p A over the wall particles of the part, A points into the fluid, and the reported
 * reactions of the part. */
static void measure_force(const mps__world *w, const mps__probe *probe, double *values)
{
    const mps__particles *s = &w->particles;
    double at[3] = {0, 0, 0}, total[6];
    mps_exact sums[6] = {{{0}, 0, 0}};
    mps__terms t;
    mps__motion_point(&w->motion, &w->motion.now, probe->config.at, at, NULL, NULL);
    mps__terms_begin(&t, sums, 6);
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        if (s->kind[i] != MPS_WALL || s->load[i] == 0) continue;
        double f[6] = {0}, r[3] = {0, 0, 0}, area[3] = {0, 0, 0}; /* f: force, moment */
        for (int32_t d = 0; d < w->setup.dim; d++)
            area[d] = face_wanted(w, probe, i, d) ? s->area[i * w->setup.dim + d] : 0;
        mps__motion_rotate(&w->motion, &w->motion.now, area, f);
        for (int32_t d = 0; d < w->setup.dim; d++) {
            f[d] *= -s->load[i];
            r[d] = s->x[i * w->setup.dim + d] - at[d];
        }
        for (int d = 0; d < 3; d++)
            f[3 + d] = r[(d + 1) % 3] * f[(d + 2) % 3] - r[(d + 2) % 3] * f[(d + 1) % 3];
        mps__terms_add(&t, f);
    }
    mps__terms_end(&t);
    mps__ranks_sum(w->ghosts.ranks, 6, sums);
    for (int k = 0; k < 6; k++) total[k] = mps_exact_value(&sums[k]);
    add_reactions(w, probe, at, total);
    memcpy(values, total, (size_t)w->setup.dim * sizeof *total);
    if (w->setup.dim == 2)
        values[2] = total[5];
    else
        memcpy(values + 3, total + 3, 3 * sizeof *total);
}

/* ---- adding ---- */

static bool solids_box(const mps__world *w, double lo[3], double hi[3])
{
    const mps__particles *s = &w->particles;
    bool any = false;
    for (int d = 0; d < 3; d++) {
        lo[d] = INFINITY;
        hi[d] = -INFINITY;
    }
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] == MPS_FLUID) continue;
        any = true;
        for (int32_t d = 0; d < w->setup.dim; d++) {
            lo[d] = fmin(lo[d], s->ref[i * w->setup.dim + d]);
            hi[d] = fmax(hi[d], s->ref[i * w->setup.dim + d]);
        }
    }
    return any;
}

static mps_status check_place(const mps__world *w, const mps_probe *c)
{
    /* sensors have their own limits, see check_wall() */
    const double slack = (c->type == MPS_PROBE_WALL_PRESSURE ? 2 : 1e-6) * w->setup.dp;
    double lo[3], hi[3];
    if (!solids_box(w, lo, hi))
        return mps__fail(w->context, MPS_E_STATE,
                         "a probe needs solids around it: add the tank first");
    for (int32_t d = 0; d < w->setup.dim; d++)
        MPS__CHECK(w->context, c->at[d] >= lo[d] - slack && c->at[d] <= hi[d] + slack,
                   "probe.at[%d] is %g: outside the solids, which reach from %g to %g", (int)d,
                   c->at[d], lo[d], hi[d]);
    return MPS_OK;
}

/* Normalise the face normal to unit length; 0 stays. */
static mps_status check_normal(const mps__world *w, mps_probe *c)
{
    const double *n = c->normal, z = w->setup.dim == 3 ? n[2] : 0,
                 size = sqrt(n[0] * n[0] + n[1] * n[1] + z * z);
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) return MPS_OK;
    MPS__CHECK(w->context, size > 0 && isfinite(size),
               "probe.normal is (%g, %g, %g): must be finite, and in 2-D not along z", n[0], n[1],
               n[2]);
    for (int d = 0; d < 3; d++) c->normal[d] = d < w->setup.dim ? n[d] / size : 0;
    return MPS_OK;
}

/* A sensor must be on its wall: rounding of a later tank moves it up to half a spacing behind a
 * face or beyond its end. */
static mps_status check_wall(mps__world *w, mps_probe *c, mps__sensor_place *place)
{
    MPS__TRY(check_normal(w, c));
    const double distance = mps__sensor_distance(w, c->at), half = 0.5 * w->setup.dp,
                 slack = 1e-6 * w->setup.dp;
    MPS__CHECK(w->context, isfinite(distance), "wall pressure: there is no wall particle");
    MPS__CHECK(
        w->context, distance <= 2 * w->setup.dp,
        "wall pressure: the nearest wall particle is %g m away, at most 2 dp = %g m are allowed",
        distance, 2 * w->setup.dp);
    const mps_status status = mps__sensor_place_find(w, c, place);
    if (status < 0) return status == MPS_E_STATE ? MPS_E_ARG : status; /* no such face */
    MPS__CHECK(w->context, place->off >= -half - slack,
               "wall pressure: probe.at lies %g m behind the face of its wall; allowed: on the "
               "liquid's side, or at most dp/2 = %g m behind",
               -place->off, half);
    MPS__CHECK(w->context, place->beyond <= half + slack,
               "wall pressure: probe.at lies %g m beyond the end of the face of its wall; allowed: "
               "at most dp/2 = %g m",
               place->beyond, half);
    return MPS_OK;
}

/* Distance from a point to where the line leaves the box of all solids, or the domain if one was
 * set. */
static double line_length(const mps__world *w, const mps_probe *c)
{
    double lo[3], hi[3], length = INFINITY;
    if (!mps__world_domain((mps__world *)w, lo, hi)) return 0;
    for (int32_t d = 0; d < w->setup.dim; d++)
        if (c->direction[d] != 0)
            length = fmin(length,
                          ((c->direction[d] > 0 ? hi[d] : lo[d]) - c->at[d]) / c->direction[d]);
    return length;
}

static mps_status check_gauge(const mps__world *w, mps_probe *c)
{
    for (int32_t k = 0; k < MPS__PHASES; k++)
        MPS__CHECK(w->context, !(c->phases >> k & 1) || w->setup.phase_defined[k],
                   "probe.phases is 0x%x: phase %d is not defined, call mps_phase_set() first",
                   (unsigned)c->phases, (int)k);
    const double *a = c->direction, norm = sqrt(mps__dot(a, a, w->setup.dim));
    MPS__CHECK(w->context, norm > 0 && isfinite(norm),
               "probe.direction is (%g, %g, %g): must be finite and not zero", a[0], a[1],
               w->setup.dim == 3 ? a[2] : 0);
    for (int d = 0; d < 3; d++) c->direction[d] = d < w->setup.dim ? c->direction[d] / norm : 0;
    if (c->length == 0) c->length = line_length(w, c);
    MPS__CHECK(w->context, isfinite(c->length) && c->length > 0,
               "probe.length is %g m: must be > 0, or 0 for the whole domain", c->length);
    return MPS_OK;
}

static mps_status check_part(mps__world *w, const char *part)
{
    const mps__particles *s = &w->particles;
    const char *names[MPS__PARTS_MAX];
    char hint[MPS__HINT_SIZE];
    for (int32_t k = 0; k < s->parts; k++) {
        if (part_matches(part, s->part_name[k])) return MPS_OK;
        names[k] = s->part_name[k];
    }
    return mps__fail(w->context, MPS_E_NAME, "no part is named \"%.40s\"; %s", part,
                     mps__hint(hint, '"', part, names, s->parts));
}

static mps_status check_numbers(const mps__world *w, const mps_probe *c)
{
    MPS__CHECK(w->context, c->type >= MPS_PROBE_WALL_PRESSURE && c->type <= MPS_PROBE_FORCE,
               "probe.type is %d: must be %d..%d", (int)c->type, MPS_PROBE_WALL_PRESSURE,
               MPS_PROBE_FORCE);
    for (int32_t d = 0; d < w->setup.dim; d++)
        MPS__CHECK(w->context, isfinite(c->at[d]), "probe.at[%d] is %g: must be finite", (int)d,
                   c->at[d]);
    MPS__CHECK(w->context, isfinite(c->diameter) && c->diameter >= 0,
               "probe.diameter is %g m: must be finite and >= 0", c->diameter);
    MPS__CHECK(w->context, isfinite(c->length) && c->length >= 0,
               "probe.length is %g m: must be finite and >= 0", c->length);
    MPS__CHECK(w->context,
               isfinite(c->average) && (c->average >= 0 || c->average == MPS_AVERAGE_AUTO),
               "probe.average is %g s: must be finite and >= 0, or MPS_AVERAGE_AUTO (%g)",
               c->average, MPS_AVERAGE_AUTO);
    MPS__CHECK(w->context, c->rate >= 0 && c->rate <= RATE_MAX, "probe.rate is %g Hz: 0..%g",
               c->rate, RATE_MAX);
    MPS__CHECK(w->context, c->phases >> MPS__PHASES == 0,
               "probe.phases is 0x%x: bits 0..%d are phases", (unsigned)c->phases, MPS__PHASES - 1);
    MPS__CHECK(w->context, c->count_drops == 0 || c->count_drops == 1,
               "probe.count_drops is %d: must be 0 or 1", (int)c->count_drops);
    return MPS_OK;
}

/* Check and complete a definition. */
static mps_status check_probe(mps__world *w, mps_probe *c, mps__sensor_place *place)
{
    MPS__TRY(check_numbers(w, c));
    if (c->type == MPS_PROBE_GAUGE && c->average == MPS_AVERAGE_AUTO) c->average = 0;
    if (c->diameter == 0) c->diameter = c->type == MPS_PROBE_GAUGE ? 3 * w->setup.dp : w->setup.dp;
    if (c->type == MPS_PROBE_FORCE) return c->part ? check_part(w, c->part) : MPS_OK;
    MPS__TRY(check_place(w, c));
    if (c->type == MPS_PROBE_WALL_PRESSURE) return check_wall(w, c, place);
    return c->type == MPS_PROBE_GAUGE ? check_gauge(w, c) : MPS_OK;
}

static void free_probe(mps__context *c, mps__probe *p)
{
    mps__sensor_free(c, &p->sensor);
    mps__series_free(c, &p->series);
}

void mps__probes_free(mps__context *c, mps__probes *p)
{
    for (int64_t k = 0; k < p->count; k++) free_probe(c, &p->list[k]);
    mps__free(c, p->list);
    *p = (mps__probes){0};
}

/* Copy the name into the probe; names are unique. */
static mps_status take_name(mps__context *c, const mps__probes *all, mps__probe *p)
{
    const char *name = p->config.name;
    if (!name) return MPS_OK;
    MPS__CHECK(c, mps__name_copy(p->name, sizeof p->name, name),
               "probe.name \"%.40s\": must have 1..%d characters", name, MPS__PART_NAME - 1);
    for (int64_t k = 0; k < all->count; k++)
        if (strcmp(all->list[k].name, name) == 0)
            return mps__fail(c, MPS_E_NAME,
                             "probe.name \"%s\" is that of probe %lld: names must differ", name,
                             (long long)k);
    p->config.name = NULL;
    return MPS_OK;
}

/* Allocate what a checked definition needs; the caller frees it on failure. */
static mps_status complete(mps__world *w, mps__probe *p)
{
    const char *part = p->config.part;
    if (part) {
        MPS__CHECK(w->context, mps__name_copy(p->part_name, sizeof p->part_name, part),
                   "probe.part must have 1..%d characters", MPS__PART_NAME - 1);
        /* only marks its existence: part_name stores it and may move with the list */
        p->config.part = "";
    }
    p->series.step = -1;
    p->series.size = mps__probe_values(w, p);
    return p->config.type == MPS_PROBE_WALL_PRESSURE ? mps__sensor_build(w, &p->config, &p->sensor)
                                                     : MPS_OK;
}

/* Ranks use the solids of all ranks. */
static mps_status prepare(mps__world *w, const mps__probes *all, mps__probe *p,
                          mps__sensor_place *place)
{
    MPS__TRY(take_name(w->context, all, p));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_REF));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_AREA));
    MPS__TRY(mps__collect_solids(w));
    mps_status status = check_probe(w, &p->config, place);
    if (status == MPS_OK) status = complete(w, p);
    mps__collect_end(w);
    return status;
}

const char *mps__probe_label(const mps__probes *p, int64_t id, char out[MPS__PROBE_LABEL])
{
    const char *name = p->list[id].name, *quote = name[0] ? "'" : "";
    snprintf(out, MPS__PROBE_LABEL, "%lld%s%s%s%s", (long long)id, name[0] ? " " : "", quote, name,
             quote);
    return out;
}

/* Log which of two faces a sensor reads if both are about as near. */
static void note_face(const mps__world *w, const mps__probes *p, int64_t k,
                      const mps__sensor_place *place)
{
    const mps__sensor_face *f[2] = {&place->face, &place->rival};
    const char *part[2];
    double n[2][3];
    char label[MPS__PROBE_LABEL];
    if (!place->has_rival) return;
    for (int a = 0; a < 2; a++) part[a] = f[a]->part >= 0 ? w->particles.part_name[f[a]->part] : "";
    for (int a = 0; a < 2; a++) /* without the rounding error of 0 */
        for (int d = 0; d < 3; d++) n[a][d] = fabs(f[a]->normal[d]) > 1e-9 ? f[a]->normal[d] : 0;
    mps__log(w->context, MPS_LOG_INFO,
             "probe %s reads the face with the normal (%.4g, %.4g, %.4g), part \"%s\"; another is "
             "as near, with (%.4g, %.4g, %.4g), part \"%s\": probe.normal chooses",
             mps__probe_label(p, k, label), n[0][0], n[0][1], n[0][2], part[0], n[1][0], n[1][1],
             n[1][2], part[1]);
}

mps_status mps__probes_add(mps__world *w, mps__probes *p, const mps_probe *probe, int32_t *id)
{
    mps__probe added = {.config = *probe};
    mps__sensor_place place = {.has_rival = false};
    MPS__CHECK(w->context, p->count < INT32_MAX, "too many probes");
    mps_status status = prepare(w, p, &added, &place);
    if (status == MPS_OK)
        status = mps__grow(w->context, (void **)&p->list, &p->capacity, p->count, p->count + 1,
                           sizeof added);
    if (status < 0) {
        free_probe(w->context, &added);
        return status;
    }
    p->list[p->count] = added;
    *id = (int32_t)p->count++;
    if (mps__dot(probe->normal, probe->normal, 3) == 0) note_face(w, p, *id, &place);
    return MPS_OK;
}

void mps__probe_remove(mps__context *c, mps__probe *p)
{
    free_probe(c, p);
    *p = (mps__probe){.removed = true};
}

int32_t mps__probe_values(const mps__world *w, const mps__probe *p)
{
    if (p->config.type != MPS_PROBE_FORCE) return 1;
    return w->setup.dim == 2 ? 3 : 6;
}

/* ---- reading ---- */

mps_status mps__probe_measure(mps__world *w, mps__probe *p, double *values)
{
    MPS__TRY(mps__world_adopt(w));
    switch (p->config.type) {
    case MPS_PROBE_WALL_PRESSURE:
        return mps__sensor_read(w, &p->config, &p->sensor, values);
    case MPS_PROBE_GAUGE:
        return mps__gauge_measure(w, &p->config, values);
    case MPS_PROBE_FLUID_PRESSURE:
        return mps__fluid_measure(w, &p->config, values);
    default:
        MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_POSITION));
        MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_AREA));
        MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_WALL_PRESSURE));
        measure_force(w, p, values);
        return MPS_OK;
    }
}

/* Present averaging interval of a probe [s]. */
static double window(const mps__world *w, const mps_probe *c)
{
    return c->average == MPS_AVERAGE_AUTO ? w->state.crossing_time : c->average;
}

/* Warn once that a pressure is averaged over less than the resolution allows. A force without
 * averaging is not evaluated for peaks: it is the load of the step, for an application that moves a
 * rigid body with it or averages it itself. */
static void note_window(mps__world *w, const mps__probes *p, int64_t k)
{
    const mps_probe *c = &p->list[k].config;
    char label[MPS__PROBE_LABEL];
    if (w->state.window_told || c->type == MPS_PROBE_GAUGE ||
        (c->type == MPS_PROBE_FORCE && c->average == 0) || window(w, c) >= w->state.crossing_time)
        return;
    w->state.window_told = true;
    mps__log(w->context, MPS_LOG_WARNING,
             "t = %.6g s: probe %s averages over %g s; liquid crosses a spacing in %g s, and "
             "pressures of impacts over less than that depend "
             "on the time step (average = MPS_AVERAGE_AUTO follows it)",
             w->state.t, mps__probe_label(p, k, label), c->average, w->state.crossing_time);
}

/* Warn once that a force lags, if the application moves the tank step by step and does not request
 * its load otherwise. */
static void note_lag(mps__world *w, mps__probes *p, int64_t k)
{
    mps__probe *f = &p->list[k];
    char label[MPS__PROBE_LABEL];
    if (f->lag_logged || f->config.type != MPS_PROBE_FORCE || !w->motion.posed ||
        w->load.watch != MPS_LOAD_NONE || window(w, &f->config) == 0)
        return;
    f->lag_logged = true;
    mps__log(w->context, MPS_LOG_WARNING,
             "t = %.6g s: probe %s averages a force over the last %.3g s, so it lags and must not "
             "drive a body: that is what mps_load_watch() and mps_load_get() are for",
             w->state.t, mps__probe_label(p, k, label), window(w, &f->config));
}

mps_status mps__probe_take(mps__world *w, mps__probe *p)
{
    double values[MPS__PROBE_VALUES];
    if ((p->config.average == 0 && p->config.rate == 0) || p->series.step == w->state.step)
        return MPS_OK;
    if (w->state.step == 0 && p->config.type != MPS_PROBE_GAUGE) {
        /* there is no pressure before the first step: its value applies from the beginning */
        p->series.waits = true;
        p->series.start = w->state.t;
        return MPS_OK;
    }
    MPS__TRY(mps__probe_measure(w, p, values));
    const mps__window now = {window(w, &p->config),
                             p->config.average == MPS_AVERAGE_AUTO ? mps__crossing_limit(w)
                                                                   : p->config.average,
                             p->config.rate};
    return mps__series_take(w->context, &p->series, &now,
                            &(mps__instant){w->state.t, w->state.step}, values);
}

mps_status mps__probes_take(mps__world *w, mps__probes *p)
{
    char label[MPS__PROBE_LABEL];
    for (int64_t k = 0; k < p->count; k++) {
        if (p->list[k].removed) continue;
        note_window(w, p, k);
        note_lag(w, p, k);
        const mps_status status = mps__probe_take(w, &p->list[k]);
        if (status < 0)
            return mps__fail(w->context, status, "no step was done, probe %s: %.400s",
                             mps__probe_label(p, k, label), w->context->error);
    }
    return MPS_OK;
}

mps_status mps__probe_read(mps__world *w, mps__probe *p, double *values)
{
    if (p->config.average == 0) return mps__probe_measure(w, p, values);
    MPS__TRY(mps__probe_take(w, p));
    if (p->series.rows == 0) return mps__probe_measure(w, p, values);
    mps__series_mean(&p->series, w->state.t - window(w, &p->config), w->state.t, values);
    return MPS_OK;
}
