/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure over the area of a sensor: a disc in 3-D, a strip in 2-D, clipped at the ends of
 * the face.
 *
 * Pressure is linear between the lattice particles of a face (3-D: bilinear), so its integral over
 * the sensor is a weighted sum. Along a line the weights are closed-form integrals of tent
 * functions; a disc is integrated over chords at equal steps of the angle, which is exact for
 * linear pressures (Gauss-Chebyshev) and varies smoothly with the sensor position. For particles
 * off a lattice the weights are corrected so that a linear pressure stays exact. On an edge the
 * face has its own pressure: probe_edge.c. */
#include "probe_sensor.h"
#include "angles.h"
#include "collect.h"
#include "probe_face.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
enum { CHORDS = 256 };

/* Half widths of the tent functions tried, in spacings. */
static const double widths[] = {1, 1.3, 1.7, 2.2};

/* Largest accepted sum of absolute weights of narrow tents: the bound of noise amplification. */
static const double tame = 1.3;

static mps__sensor_face face_of(const mps__world *w, const mps__face_solid *e, const double *n)
{
    mps__sensor_face face = {.part = w->particles.part[e->place]};
    for (int d = 0; d < 3; d++) face.normal[d] = n[d] + 0.0; /* avoids -0 */
    return face;
}

static mps__sensor_place place_on(const mps__world *w, mps__face *f)
{
    mps__sensor_place p = {.face = face_of(w, f->base, f->normal)};
    if (mps__face_has_sides(f)) p.off = f->off;
    for (int32_t a = 0; a < f->sides; a++) p.beyond = fmax(p.beyond, fmax(f->lo[a], -f->hi[a]));
    const mps__face_solid *rival = mps__face_rival(f);
    p.has_rival = rival != NULL;
    if (rival) p.rival = face_of(w, rival, rival->n);
    return p;
}

mps_status mps__sensor_place_find(mps__world *w, const mps_probe *config, mps__sensor_place *place)
{
    mps__face f;
    const mps_status status = mps__face_find(&f, w, config);
    *place = status == MPS_OK ? place_on(w, &f) : (mps__sensor_place){0};
    mps__face_free(&f, w->context);
    return status;
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

/* Ends along side e of a chord of half length `half`, clipped at the face's ends; false if nothing
 * remains. */
static bool chord(const mps__face *f, int e, double half, double *from, double *to)
{
    *from = fmax(-half, f->lo[e]);
    *to = fmin(half, f->hi[e]);
    return *to > *from;
}

static double along(const mps__face *f, const mps__face_point *u, int e, double half)
{
    double from, to;
    if (!chord(f, e, half, &from, &to)) return 0;
    return tent_integral((to - u->at[e]) / f->width) - tent_integral((from - u->at[e]) / f->width);
}

/* Call for each chord of a disc: position across, half length, area fraction. */
static void chord_of_disc(const mps__face *f, int k, double *across, double *half, double *share)
{
    const double from = mps__asin(fmin(fmax(f->lo[0] / f->radius, -1), 1)),
                 to = mps__asin(fmin(fmax(f->hi[0] / f->radius, -1), 1));
    const double angle = from + (to - from) * (k + 0.5) / CHORDS;
    *across = f->radius * mps__sin(angle);
    *half = f->radius * mps__cos(angle);
    *share = (to - from) * *half;
}

static double under_disc(const mps__face *f, const mps__face_point *u)
{
    double sum = 0, across, half, share;
    for (int k = 0; k < CHORDS; k++) {
        chord_of_disc(f, k, &across, &half, &share);
        const double part = tent((across - u->at[0]) / f->width);
        if (part > 0) sum += part * share * along(f, u, 1, half);
    }
    return sum;
}

/* Centroid of the covered area; false if it is empty. */
static bool find_target(mps__face *f)
{
    double area = 0, from, to, across, half, share;
    f->target[0] = f->target[1] = 0;
    if (f->sides == 1) {
        if (!chord(f, 0, f->radius, &from, &to)) return false;
        f->target[0] = 0.5 * (from + to);
        return true;
    }
    for (int k = 0; k < CHORDS; k++) {
        chord_of_disc(f, k, &across, &half, &share);
        if (!chord(f, 1, half, &from, &to)) continue;
        area += share * (to - from);
        f->target[0] += share * (to - from) * across;
        f->target[1] += share * (to - from) * 0.5 * (from + to);
    }
    for (int a = 0; a < 2; a++) f->target[a] /= area > 0 ? area : 1;
    return area > 0;
}

/* Correction factor of a weight at q from the target: k[0] + k[1] q[0] + k[2] q[1], so that the
 * weights sum to 1 and their centroid is the target. False if the particles do not allow it. On a
 * lattice the factor is 1/sum. */
static bool correction(const mps__face *f, double k[3])
{
    double s0 = 0, s1[2] = {0, 0}, s2[3] = {0, 0, 0}, g[2] = {0, 0};
    for (int64_t i = 0; i < f->count; i++) {
        const mps__face_point *u = &f->list[i];
        const double q[2] = {u->at[0] - f->target[0], u->at[1] - f->target[1]}, w = u->weight;
        s0 += w;
        for (int a = 0; a < f->sides; a++) s1[a] += w * q[a];
        s2[0] += w * q[0] * q[0];
        s2[1] += w * q[0] * q[1];
        s2[2] += w * q[1] * q[1];
    }
    k[0] = 1 / s0;
    k[1] = k[2] = 0;
    if (!(s0 > 0)) return false;
    if (mps__hypot(s1[0], s1[1]) <= 1e-9 * f->dp * s0) return true;
    if (f->sides == 1) {
        s2[1] = s1[1] = 0;
        s2[2] = s2[0];
    }
    const double det = s2[0] * s2[2] - s2[1] * s2[1];
    if (!(det > 1e-6 * s2[0] * s2[2])) return false;
    g[0] = (s2[2] * s1[0] - s2[1] * s1[1]) / det;
    g[1] = (s2[0] * s1[1] - s2[1] * s1[0]) / det;
    const double rest = s0 - g[0] * s1[0] - g[1] * s1[1];
    if (!(rest > 1e-3 * s0)) return false;
    k[0] = 1 / rest;
    k[1] = -g[0] / rest;
    k[2] = -g[1] / rest;
    return true;
}

/* Weights of tents of the face's width. Returns the sum of their absolute values, the noise
 * amplification; INFINITY: no weights. */
static double weigh(mps__face *f)
{
    double k[3], sum = 0;
    for (int64_t i = 0; i < f->count; i++)
        f->list[i].weight = f->sides == 1 ? along(f, &f->list[i], 0, f->radius)
                                          : under_disc(f, &f->list[i]);
    if (!correction(f, k)) return INFINITY;
    for (int64_t i = 0; i < f->count; i++) {
        mps__face_point *u = &f->list[i];
        u->weight *= k[0] + k[1] * (u->at[0] - f->target[0]) + k[2] * (u->at[1] - f->target[1]);
        sum += fabs(u->weight);
    }
    return sum;
}

/* Use the narrowest tents with accepted weights, or else the best ones. False without weights. */
static bool weigh_best(mps__face *f)
{
    enum { WIDTHS = sizeof widths / sizeof widths[0] };
    double least = INFINITY, best = 0;
    if (f->count == 0 || !find_target(f)) return false;
    for (int k = 0; k < WIDTHS && least > tame; k++) {
        f->width = widths[k] * f->dp;
        const double sum = weigh(f);
        if (sum > least * (1 - 1e-3) || !isfinite(sum)) continue;
        least = sum;
        best = f->width;
    }
    f->width = best;
    return best > 0 && isfinite(weigh(f));
}

/* Keep the particles with a weight and those needed for edge pressures, renumbered. */
static mps_status keep_weights(mps__context *c, mps__face *f, mps__sensor *sensor,
                               mps__edges *edges)
{
    MPS__TRY(mps__edges_find(edges, c, f));
    MPS__TRY(mps__grow(c, (void **)&sensor->list, &sensor->capacity, 0, f->count > 0 ? f->count : 1,
                       sizeof *sensor->list));
    for (int64_t k = 0; k < f->count; k++) f->list[k].number = f->list[k].weight != 0 ? 0 : -1;
    for (int64_t m = 0; m < edges->weights; m++) f->list[edges->weight[m].of].number = 0;
    sensor->count = 0;
    for (int64_t k = 0; k < f->count; k++) {
        if (f->list[k].number < 0) continue;
        f->list[k].number = sensor->count;
        sensor->list[sensor->count++] = (mps__sensor_weight){f->list[k].id, f->list[k].place,
                                                             f->list[k].weight};
    }
    for (int64_t k = 0; k < edges->count; k++)
        edges->list[k].of = f->list[edges->list[k].of].number;
    for (int64_t m = 0; m < edges->weights; m++)
        edges->weight[m].of = f->list[edges->weight[m].of].number;
    return MPS_OK;
}

mps_status mps__sensor_build(mps__world *w, const mps_probe *config, mps__sensor *sensor)
{
    mps__face f;
    mps__edges edges = {0};
    mps_status status = mps__face_find(&f, w, config);
    if (status == MPS_OK && !weigh_best(&f)) f.count = 0;
    if (status == MPS_OK) status = keep_weights(w->context, &f, sensor, &edges);
    /* the whole sensor is beside the face, or there is a single particle */
    if (status == MPS_OK && sensor->count == 0)
        sensor->list[sensor->count++] = (mps__sensor_weight){f.base->id, f.base->place, 1};
    if (status == MPS_OK) sensor->face = face_of(w, f.base, f.normal);
    mps__face_free(&f, w->context);
    if (status < 0) {
        mps__edges_free(&edges, w->context);
        return status;
    }
    mps__edges_free(&sensor->edges, w->context);
    sensor->edges = edges;
    sensor->generation = w->particles.generation;
    sensor->linked = w->lists.linked;
    sensor->links = w->lists.links;
    sensor->orders = -1;
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

/* Update the indices of this rank's particles after sorting. */
static void locate(const mps__world *w, mps__sensor *sensor)
{
    const mps__particles *s = &w->particles;
    const int64_t first = sensor->list[0].id, last = sensor->list[sensor->count - 1].id;
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        if (s->id[i] < first || s->id[i] > last) continue;
        mps__sensor_weight *e = bsearch(&s->id[i], sensor->list, (size_t)sensor->count, sizeof *e,
                                        compare_id);
        if (e) e->place = i;
    }
}

/* Whether particles were added or removed since the weights were computed. */
static bool is_old(const mps__world *w, const mps__sensor *sensor)
{
    if (mps__ranks_many(w->ghosts.ranks)) return sensor->links != w->lists.links;
    return sensor->generation != w->particles.generation || sensor->linked != w->lists.linked;
}

static mps_status build_again(mps__world *w, const mps_probe *config, mps__sensor *sensor)
{
    MPS__TRY(mps__collect_solids(w));
    mps_status status = isfinite(mps__sensor_distance(w, config->at))
                            ? mps__sensor_build(w, config, sensor)
                            : mps__fail(w->context, MPS_E_STATE,
                                        "wall pressure: there is no wall particle any more");
    mps__collect_end(w);
    return status;
}

/* Indices of the particles on this rank, -1: on another rank. */
static void locate_owned(const mps__world *w, mps__sensor *sensor)
{
    if (sensor->orders == w->lists.orders && w->lists.orders > 0) return;
    for (int64_t k = 0; k < sensor->count; k++) sensor->list[k].place = -1;
    locate(w, sensor);
    sensor->orders = w->lists.orders;
}

static void either(void *into, const void *from)
{
    double a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    if (a == 0) memcpy(into, &b, sizeof b);
}

/* Collect the pressures of the particles from the ranks that own them. */
static mps_status collect_pressures(mps__world *w, mps__sensor *sensor, double *p)
{
    locate_owned(w, sensor);
    for (int64_t k = 0; k < sensor->count; k++)
        p[k] = sensor->list[k].place >= 0 ? w->particles.load[sensor->list[k].place] : 0;
    mps__ranks_reduce(&w->ranks, (int32_t)sensor->count, sizeof *p, p, either);
    return mps__ranks_status(&w->ranks);
}

mps_status mps__sensor_read(mps__world *w, const mps_probe *config, mps__sensor *sensor,
                            double *value)
{
    const mps__particles *s = &w->particles;
    double sum = 0;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_WALL_PRESSURE));
    if (is_old(w, sensor)) MPS__TRY(mps__world_fetch(w));
    if (is_old(w, sensor)) MPS__TRY(build_again(w, config, sensor));
    double *p = mps__scratch_take(w->context, &w->scratch, 0, sensor->count, sizeof *p);
    if (!p) return MPS_E_NOMEM;
    if (mps__ranks_many(&w->ranks)) {
        MPS__TRY(collect_pressures(w, sensor, p));
    } else {
        if (!in_place(s, sensor)) locate(w, sensor);
        for (int64_t k = 0; k < sensor->count; k++) p[k] = s->load[sensor->list[k].place];
    }
    mps__edges_apply(&sensor->edges, p);
    for (int64_t k = 0; k < sensor->count; k++) sum += sensor->list[k].weight * p[k];
    *value = sum;
    return MPS_OK;
}

void mps__sensor_free(mps__context *c, mps__sensor *sensor)
{
    mps__free(c, sensor->list);
    mps__edges_free(&sensor->edges, c);
    *sensor = (mps__sensor){0};
}
