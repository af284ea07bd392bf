/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure over the area of a sensor: a disc in 3-D, a strip in 2-D, cut off where the face ends.
 *
 * Between the particles of a face pressure is linear (3-D: bilinear), so its integral over the sensor is a weighted sum
 * of theirs. Along a line the weights are integrals of tent functions in closed form; a disc is summed over chords at
 * equal steps of the angle, which is exact for linear pressures (Gauss-Chebyshev) and moves smoothly with the sensor. */
#include "probe_sensor.h"
#include "probes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHORDS = 256 };

/* The plane of a face at the sensor. */
typedef struct face {
    int32_t sides; /* directions along the face: 1 or 2 */
    int64_t base;  /* a particle of the face */
    double dp, radius;
    double centre[3], normal[3], tangent[2][3];
    double lo[2], hi[2]; /* of its particles beside the sensor, from the centre */
    int64_t count, capacity;
    struct under {
        int64_t id, place;
        double at[2]; /* along the tangents, from the centre */
    } * list;
} face;

static double distance2(const double *a, const double *b, int32_t dim)
{
    double sum = 0;
    for (int32_t d = 0; d < dim; d++) sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sum;
}

double mps__sensor_distance(const mps__world *w, const double *at)
{
    const mps__particles *s = &w->particles;
    double least = INFINITY;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_WALL) least = fmin(least, distance2(&s->ref[i * w->dim], at, w->dim));
    return sqrt(least);
}

/* ---- the face ---- */

/* Largest squared area of the wall particles within `reach` of the sensor. */
static double largest_area2(const mps__world *w, const double *at, double reach)
{
    const mps__particles *s = &w->particles;
    double most = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL || distance2(&s->ref[i * w->dim], at, w->dim) > reach * reach) continue;
        most = fmax(most, mps__dot(&s->area[i * w->dim], &s->area[i * w->dim], w->dim));
    }
    return most;
}

/* The nearest wall particle that is not on an edge, whose smaller area looks between two faces. Of two as near the one
 * that looks at the sensor, then the older. -1 without walls. */
static int64_t nearest_of_face(const mps__world *w, const double *at)
{
    const mps__particles *s = &w->particles;
    const double margin = 1e-9 * w->dp * w->dp, enough = 0.55 * largest_area2(w, at, mps__sensor_distance(w, at) + 1.5 * w->dp);
    double least = INFINITY, towards = 0;
    int64_t best = -1;
    for (int64_t i = 0; i < s->n; i++) {
        const double *area = &s->area[i * w->dim], *ref = &s->ref[i * w->dim];
        if (s->kind[i] != MPS_WALL || mps__dot(area, area, w->dim) < enough) continue;
        const double d2 = distance2(ref, at, w->dim);
        if (d2 > least + margin) continue;
        double looks = 0;
        for (int32_t d = 0; d < w->dim; d++) looks += (at[d] - ref[d]) * area[d];
        const bool as_near = best >= 0 && d2 >= least - margin;
        if (as_near && (looks < towards || (looks == towards && s->id[i] > s->id[best]))) continue;
        least = fmin(least, d2);
        towards = looks;
        best = i;
    }
    return best;
}

/* Of a wall without areas, as a plate one particle thick: the axis along which the part reaches least around `base`. */
static void flat_axis(const mps__world *w, int64_t base, double normal[3])
{
    const mps__particles *s = &w->particles;
    double spread[3] = {0, 0, 0};
    for (int64_t i = 0; i < s->n; i++) {
        const double *here = &s->ref[i * w->dim], *there = &s->ref[base * w->dim];
        if (s->kind[i] != MPS_WALL || s->part[i] != s->part[base] || distance2(here, there, w->dim) > 4.41 * w->dp * w->dp) continue;
        for (int32_t d = 0; d < w->dim; d++) spread[d] += fabs(here[d] - there[d]);
    }
    int32_t least = 0;
    for (int32_t d = 1; d < w->dim; d++)
        if (spread[d] < spread[least]) least = d;
    normal[least] = 1;
}

static void face_init(face *f, const mps__world *w, const mps_probe *c)
{
    const mps__particles *s = &w->particles;
    *f = (face){.sides = w->dim - 1, .base = nearest_of_face(w, c->at), .dp = w->dp};
    f->radius = fmax(0.5 * c->diameter, 1e-6 * w->dp);
    const double *area = &s->area[f->base * w->dim], *ref = &s->ref[f->base * w->dim];
    const double norm = sqrt(mps__dot(area, area, w->dim));
    if (norm > 0)
        for (int32_t d = 0; d < w->dim; d++) f->normal[d] = area[d] / norm;
    else
        flat_axis(w, f->base, f->normal);
    double off = 0;
    for (int32_t d = 0; d < w->dim; d++) off += (c->at[d] - ref[d]) * f->normal[d];
    for (int32_t d = 0; d < w->dim; d++) f->centre[d] = c->at[d] - off * f->normal[d];
    mps__probe_across(w->dim, f->normal, f->tangent);
}

/* True if wall particle i lies in the face's plane, looks to the same side and carries pressure to the sensor. */
static bool face_has(const face *f, const mps__particles *s, int64_t i, struct under *out)
{
    const double *area = &s->area[i * s->dim];
    double r[3] = {0, 0, 0};
    for (int32_t d = 0; d < s->dim; d++) r[d] = s->ref[i * s->dim + d] - f->centre[d];
    if (fabs(mps__dot(r, f->normal, s->dim)) > 0.25 * f->dp) return false;
    for (int32_t e = 0; e < f->sides; e++) {
        out->at[e] = mps__dot(r, f->tangent[e], s->dim);
        if (fabs(out->at[e]) > f->radius + 1.001 * f->dp) return false;
    }
    const double looks = mps__dot(area, f->normal, s->dim);
    return mps__dot(area, area, s->dim) > 0 ? looks > 0 : s->part[i] == s->part[f->base];
}

static int compare_under(const void *a, const void *b)
{
    const int64_t i = ((const struct under *)a)->id, j = ((const struct under *)b)->id;
    return (i > j) - (i < j);
}

/* By id, so that sums do not depend on how the particles are sorted. */
static mps_status face_collect(face *f, mps__world *w)
{
    const mps__particles *s = &w->particles;
    for (int e = 0; e < 2; e++) {
        f->lo[e] = INFINITY;
        f->hi[e] = -INFINITY;
    }
    for (int64_t i = 0; i < s->n; i++) {
        struct under u = {.id = s->id[i], .place = i};
        if (s->kind[i] != MPS_WALL || !face_has(f, s, i, &u)) continue;
        MPS__TRY(mps__grow(w->context, (void **)&f->list, &f->capacity, f->count, f->count + 1, sizeof u));
        f->list[f->count++] = u;
        for (int32_t e = 0; e < f->sides; e++) {
            f->lo[e] = fmin(f->lo[e], u.at[e]);
            f->hi[e] = fmax(f->hi[e], u.at[e]);
        }
    }
    if (f->count > 0) qsort(f->list, (size_t)f->count, sizeof *f->list, compare_under);
    return MPS_OK;
}

/* ---- weights ---- */

/* Tent function of the interpolation and its integral from the left, q in spacings. */
static double tent(double q)
{
    return fmax(0, 1 - fabs(q));
}

static double tent_integral(double q)
{
    q = fmin(fmax(q, -1), 1);
    return q < 0 ? 0.5 * (1 + q) * (1 + q) : 1 - 0.5 * (1 - q) * (1 - q);
}

/* Integral along side e from the centre - half to the centre + half, cut off at the face's ends. */
static double along(const face *f, const struct under *u, int e, double half)
{
    const double from = fmax(-half, f->lo[e]), to = fmin(half, f->hi[e]);
    return to > from ? tent_integral((to - u->at[e]) / f->dp) - tent_integral((from - u->at[e]) / f->dp) : 0;
}

static double under_strip(const face *f, const struct under *u)
{
    return along(f, u, 0, f->radius);
}

static double under_disc(const face *f, const struct under *u)
{
    const double from = asin(fmin(fmax(f->lo[0] / f->radius, -1), 1)), to = asin(fmin(fmax(f->hi[0] / f->radius, -1), 1));
    double sum = 0;
    for (int k = 0; k < CHORDS; k++) {
        const double angle = from + (to - from) * (k + 0.5) / CHORDS, half = f->radius * cos(angle);
        const double share = tent((f->radius * sin(angle) - u->at[0]) / f->dp);
        if (share > 0) sum += share * half * along(f, u, 1, half);
    }
    return sum * (to - from);
}

static mps_status keep_weights(mps__context *c, const face *f, mps__sensor *sensor)
{
    double sum = 0;
    MPS__TRY(mps__grow(c, (void **)&sensor->list, &sensor->capacity, 0, f->count > 0 ? f->count : 1, sizeof *sensor->list));
    sensor->count = 0;
    for (int64_t k = 0; k < f->count; k++) {
        const struct under *u = &f->list[k];
        const double weight = f->sides == 1 ? under_strip(f, u) : under_disc(f, u);
        if (weight <= 0) continue;
        sensor->list[sensor->count++] = (mps__sensor_weight){u->id, u->place, weight};
        sum += weight;
    }
    for (int64_t k = 0; k < sensor->count; k++) sensor->list[k].weight /= sum;
    return MPS_OK;
}

mps_status mps__sensor_build(mps__world *w, const mps_probe *config, mps__sensor *sensor)
{
    face f;
    face_init(&f, w, config);
    mps_status status = face_collect(&f, w);
    if (status == MPS_OK) status = keep_weights(w->context, &f, sensor);
    mps__free(w->context, f.list);
    if (status < 0) return status;
    if (sensor->count == 0) /* all of it is beside the face */
        sensor->list[sensor->count++] = (mps__sensor_weight){w->particles.id[f.base], f.base, 1};
    sensor->generation = w->particles.generation;
    sensor->linked = w->linked;
    return MPS_OK;
}

/* ---- reading ---- */

static bool in_place(const mps__particles *s, const mps__sensor *sensor)
{
    for (int64_t k = 0; k < sensor->count; k++) {
        const mps__sensor_weight *e = &sensor->list[k];
        if (e->place >= s->n || s->id[e->place] != e->id) return false;
    }
    return true;
}

static int compare_id(const void *key, const void *entry)
{
    const int64_t i = *(const int64_t *)key, j = ((const mps__sensor_weight *)entry)->id;
    return (i > j) - (i < j);
}

/* The particles were sorted: look up where they are now. */
static void locate(const mps__particles *s, mps__sensor *sensor)
{
    const int64_t first = sensor->list[0].id, last = sensor->list[sensor->count - 1].id;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->id[i] < first || s->id[i] > last) continue;
        mps__sensor_weight *e = bsearch(&s->id[i], sensor->list, (size_t)sensor->count, sizeof *e, compare_id);
        if (e) e->place = i;
    }
}

mps_status mps__sensor_read(mps__world *w, const mps_probe *config, mps__sensor *sensor, double *value)
{
    const mps__particles *s = &w->particles;
    if (sensor->generation != s->generation || sensor->linked != w->linked) {
        if (!isfinite(mps__sensor_distance(w, config->at)))
            return mps__fail(w->context, MPS_E_STATE, "wall pressure: there is no wall particle any more");
        MPS__TRY(mps__sensor_build(w, config, sensor));
    }
    if (!in_place(s, sensor)) locate(s, sensor);
    double sum = 0;
    for (int64_t k = 0; k < sensor->count; k++) sum += sensor->list[k].weight * s->load[sensor->list[k].place];
    *value = sum;
    return MPS_OK;
}

void mps__sensor_free(mps__context *c, mps__sensor *sensor)
{
    mps__free(c, sensor->list);
    *sensor = (mps__sensor){0};
}
