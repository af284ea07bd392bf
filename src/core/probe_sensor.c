/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure over the area of a sensor: a disc in 3-D, a strip in 2-D, cut off where the face ends.
 *
 * Between the particles of a face on the lattice pressure is linear (3-D: bilinear), so its integral over the sensor is a
 * weighted sum of theirs. Along a line the weights are integrals of tent functions in closed form; a disc is summed over
 * chords at equal steps of the angle, which is exact for linear pressures (Gauss-Chebyshev) and moves smoothly with the
 * sensor. Where the particles are not on a lattice, the weights are corrected so that a linear pressure stays exact. */
#include "probe_sensor.h"
#include "plates.h"
#include "probes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHORDS = 256 };

/* In spacings: half width of the tents that are tried; walls within `flat` of the plane of a face belong to it, neighbours within `beside`
 * tell a face from an edge; a particle stands for its face as far as `cover`; gap to the wall on which a face stands; normals are averaged
 * as far as `around`. */
static const double widths[] = {1, 1.3, 1.7, 2.2}, flat = 0.25, beside = 1.6, cover = 1.1, foot_gap = 1.3, around = 1.9;

/* Sum of the absolute weights up to which narrow tents are good: noise is amplified by no more. */
static const double tame = 1.3;

/* A solid particle near the sensor. */
typedef struct solid {
    int64_t id, place;
    double r[3], n[3]; /* from the sensor; normal into the liquid, 0 without an area */
    bool wall, member;
} solid;

/* The plane of a face at the sensor. */
typedef struct face {
    int32_t dim, sides;            /* directions along the face: 1 or 2 */
    solid *base;                   /* a particle of the face */
    double dp, width, radius, off; /* off: of the sensor's place before the plane, < 0: behind it */
    double normal[3], tangent[2][3];
    double lo[2], hi[2], target[2]; /* ends of the face beside the sensor and centroid of what the sensor covers, from the sensor */
    int64_t count, capacity, solids, solid_capacity;
    struct under {
        int64_t id, place;
        double at[2], weight; /* along the tangents, from the sensor */
    } * list;
    solid *solid;
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

static int compare_solid(const void *a, const void *b)
{
    const int64_t i = ((const solid *)a)->id, j = ((const solid *)b)->id;
    return (i > j) - (i < j);
}

/* Solids around the sensor, by id, so that nothing depends on how the particles are sorted. */
static mps_status collect_solids(face *f, mps__world *w, const double *at)
{
    const mps__particles *s = &w->particles;
    const double reach = mps__sensor_distance(w, at) + 1.5 * (f->radius + 4 * w->dp);
    for (int64_t i = 0; i < s->n; i++) {
        solid e = {.id = s->id[i], .place = i, .wall = s->kind[i] == MPS_WALL};
        if (s->kind[i] == MPS_FLUID || mps__is_shadow(s, i) || distance2(&s->ref[i * w->dim], at, w->dim) > reach * reach) continue;
        const double *area = &s->area[i * w->dim], size = e.wall ? sqrt(mps__dot(area, area, w->dim)) : 0;
        for (int32_t d = 0; d < w->dim; d++) {
            e.r[d] = s->ref[i * w->dim + d] - at[d];
            e.n[d] = size > 0 ? area[d] / size : 0;
        }
        MPS__TRY(mps__grow(w->context, (void **)&f->solid, &f->solid_capacity, f->solids, f->solids + 1, sizeof e));
        f->solid[f->solids++] = e;
    }
    qsort(f->solid, (size_t)f->solids, sizeof *f->solid, compare_solid);
    return MPS_OK;
}

static bool has_normal(const solid *e)
{
    return mps__dot(e->n, e->n, 3) > 0;
}

/* On an edge no neighbours lie in the plane that is across the particle's area, in 3-D only those along the edge. */
static bool on_face(const face *f, const solid *e)
{
    double moment[3] = {0, 0, 0}, tangent[2][3] = {{0}};
    if (!has_normal(e)) return false;
    mps__probe_across(f->dim, e->n, tangent);
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *o = &f->solid[k];
        double r[3], t[2];
        for (int d = 0; d < 3; d++) r[d] = (o->r[d] - e->r[d]) / f->dp;
        if (!o->wall || mps__dot(r, r, 3) > beside * beside || fabs(mps__dot(r, e->n, 3)) > flat || mps__dot(o->n, e->n, 3) <= 0) continue;
        for (int a = 0; a < 2; a++) t[a] = mps__dot(r, tangent[a], 3);
        moment[0] += t[0] * t[0];
        moment[1] += t[0] * t[1];
        moment[2] += t[1] * t[1];
    }
    if (f->dim == 2) return moment[0] > 0.1;
    const double mean = 0.5 * (moment[0] + moment[2]), root = hypot(0.5 * (moment[0] - moment[2]), moment[1]);
    return mean - root > 0.3;
}

/* How far the sensor is from what a wall particle stands for, squared: from its plane, and along it beyond its cell. */
static double remoteness(const face *f, const solid *e)
{
    const double off = mps__dot(e->r, e->n, 3), square = mps__dot(e->r, e->r, 3), along = sqrt(fmax(0, square - off * off));
    if (!has_normal(e)) return square;
    const double beyond = fmax(0, along - cover * f->dp);
    return off * off + beyond * beyond + 1e-4 * along * along;
}

/* The least remote wall particle of a face. Of two as remote the one that looks at the sensor, then the older. NULL: none. */
static solid *least_remote(const face *f, bool (*may_be)(const face *f, const solid *e))
{
    const double margin = 1e-10 * f->dp * f->dp;
    double least = INFINITY, towards = 0;
    solid *best = NULL;
    for (int64_t k = 0; k < f->solids; k++) {
        solid *e = &f->solid[k];
        if (!e->wall) continue;
        const double remote = remoteness(f, e), looks = -mps__dot(e->r, e->n, 3);
        if (remote > least + margin || (best && remote >= least - margin && looks <= towards) || !may_be(f, e)) continue;
        least = fmin(least, remote);
        towards = looks;
        best = e;
    }
    return best;
}

static bool any_with_normal(const face *f, const solid *e)
{
    (void)f;
    return has_normal(e);
}

static bool any_wall(const face *f, const solid *e)
{
    (void)f;
    return e->wall;
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

/* Mean normal of the face around the sensor: particles beside an edge have a part of the other face, those of a curved face turn. */
static void face_normal(face *f, const mps__world *w)
{
    const solid *base = f->base;
    double sum[3] = {0, 0, 0}, r[3], foot[3];
    if (!has_normal(base)) {
        flat_axis(w, base->place, f->normal);
        return;
    }
    const double off = mps__dot(base->r, base->n, 3);
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *e = &f->solid[k];
        for (int d = 0; d < 3; d++) {
            r[d] = (e->r[d] - base->r[d]) / f->dp;
            foot[d] = (e->r[d] - off * base->n[d]) / f->dp;
        }
        if (!e->wall || fabs(mps__dot(r, base->n, 3)) > flat || mps__dot(e->n, base->n, 3) < 0.9) continue;
        const double weight = 1 - mps__dot(foot, foot, 3) / (around * around);
        if (e != base && (weight <= 0 || !on_face(f, e))) continue;
        for (int d = 0; d < 3; d++) sum[d] += fmax(weight, 0.1) * e->n[d];
    }
    const double size = sqrt(mps__dot(sum, sum, 3));
    for (int d = 0; d < 3; d++) f->normal[d] = sum[d] / size;
}

/* Find the face of a sensor; there must be a wall. face_free() afterwards in any case. */
static mps_status face_init(face *f, mps__world *w, const mps_probe *c)
{
    *f = (face){.dim = w->dim, .sides = w->dim - 1, .dp = w->dp, .width = w->dp};
    f->radius = fmax(0.5 * c->diameter, 1e-6 * w->dp);
    MPS__TRY(collect_solids(f, w, c->at));
    f->base = least_remote(f, on_face);
    if (!f->base) f->base = least_remote(f, any_with_normal);
    if (!f->base) f->base = least_remote(f, any_wall);
    face_normal(f, w);
    f->off = -mps__dot(f->base->r, f->normal, 3);
    mps__probe_across(w->dim, f->normal, f->tangent);
    return MPS_OK;
}

static void face_free(face *f, mps__context *c)
{
    mps__free(c, f->list);
    mps__free(c, f->solid);
}

static double height(const face *f, const solid *e)
{
    return mps__dot(e->r, f->normal, 3) + f->off;
}

/* Whether a solid stands on a wall particle, so that it is not wetted. */
static bool is_covered(const face *f, const solid *e)
{
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *o = &f->solid[k];
        double r[3];
        for (int d = 0; d < 3; d++) r[d] = (o->r[d] - e->r[d]) / f->dp - e->n[d];
        const double square = mps__dot(r, r, 3);
        if (square < 0.01 ? !o->wall || mps__dot(o->n, e->n, 3) < -0.9 : square < 0.25 && !o->wall) return true;
    }
    return false;
}

/* Whether the liquid before the face reaches a wall particle: no plate hides it, no solid covers it. */
static bool is_open(const face *f, const mps__world *w, const double *at, const solid *e)
{
    const solid *b = f->base;
    double from[3] = {0, 0, 0};
    if (e == b) return true;
    const double off = mps__dot(b->r, b->n, 3) + 0.01 * f->dp;
    for (int32_t d = 0; d < f->dim; d++) from[d] = at[d] + off * b->n[d] + 0.01 * b->r[d];
    return !mps__plates_hide(w, from, e->place) && !(has_normal(e) && is_covered(f, e));
}

static mps_status add_member(face *f, mps__context *c, solid *e)
{
    struct under u = {.id = e->id, .place = e->place};
    MPS__TRY(mps__grow(c, (void **)&f->list, &f->capacity, f->count, f->count + 1, sizeof u));
    for (int32_t a = 0; a < f->sides; a++) {
        u.at[a] = mps__dot(e->r, f->tangent[a], 3);
        f->lo[a] = fmin(f->lo[a], u.at[a]);
        f->hi[a] = fmax(f->hi[a], u.at[a]);
    }
    f->list[f->count++] = u;
    e->member = true;
    return MPS_OK;
}

/* True if a wall particle lies in the face's plane, looks to the same side and carries pressure to the sensor. */
static bool face_has(const face *f, const mps__particles *s, const solid *e)
{
    if (!e->wall || fabs(height(f, e)) > flat * f->dp) return false;
    for (int32_t a = 0; a < f->sides; a++)
        if (fabs(mps__dot(e->r, f->tangent[a], 3)) > f->radius + 2.5 * f->dp) return false;
    return has_normal(e) ? mps__dot(e->n, f->normal, 3) > 1e-9 : s->part[e->place] == s->part[f->base->place];
}

/* Where the plane of another wall meets that of the face, along the tangents; false if it does so nowhere near. */
static bool meets_face(const face *f, const solid *e, double at[2])
{
    double across = 0, t[2] = {0, 0};
    const double h = height(f, e), up = mps__dot(e->n, f->normal, 3);
    if (!e->wall || e->member || h < -flat * f->dp || h > 1.1 * f->dp || up < -0.5 || up > 0.9) return false;
    for (int32_t a = 0; a < f->sides; a++) {
        t[a] = mps__dot(e->n, f->tangent[a], 3);
        across += t[a] * t[a];
    }
    for (int32_t a = 0; a < f->sides; a++) at[a] = mps__dot(e->r, f->tangent[a], 3) + (across > 0 ? up * h * t[a] / across : 0);
    return across > 0.1;
}

/* A face goes on to the wall it stands on, as far as that is next to its last particles. */
static mps_status reach_foot(face *f, mps__world *w, const double *at)
{
    const int64_t members = f->count;
    for (int64_t k = 0; k < f->solids; k++) {
        solid *e = &f->solid[k];
        double end[2] = {0, 0}, least = INFINITY;
        if (!meets_face(f, e, end) || !is_open(f, w, at, e)) continue;
        for (int64_t m = 0; m < members; m++) least = fmin(least, distance2(end, f->list[m].at, f->sides));
        if (least > foot_gap * foot_gap * f->dp * f->dp) continue;
        if (fabs(height(f, e)) < 1e-3 * f->dp) MPS__TRY(add_member(f, w->context, e));
        for (int32_t a = 0; a < f->sides; a++) {
            if (fabs(mps__dot(e->n, f->tangent[a], 3)) < 0.5) continue;
            f->lo[a] = fmin(f->lo[a], end[a]);
            f->hi[a] = fmax(f->hi[a], end[a]);
        }
    }
    return MPS_OK;
}

static int compare_under(const void *a, const void *b)
{
    const int64_t i = ((const struct under *)a)->id, j = ((const struct under *)b)->id;
    return (i > j) - (i < j);
}

static mps_status face_collect(face *f, mps__world *w, const double *at)
{
    for (int a = 0; a < 2; a++) {
        f->lo[a] = INFINITY;
        f->hi[a] = -INFINITY;
    }
    for (int64_t k = 0; k < f->solids; k++)
        if (face_has(f, &w->particles, &f->solid[k]) && is_open(f, w, at, &f->solid[k])) MPS__TRY(add_member(f, w->context, &f->solid[k]));
    MPS__TRY(reach_foot(f, w, at));
    if (f->count > 0) qsort(f->list, (size_t)f->count, sizeof *f->list, compare_under);
    return MPS_OK;
}

mps_status mps__sensor_place(mps__world *w, const mps_probe *config, double *off, double *beyond)
{
    face f;
    mps_status status = face_init(&f, w, config);
    if (status == MPS_OK) status = face_collect(&f, w, config->at);
    *off = status == MPS_OK && has_normal(f.base) ? f.off : 0;
    *beyond = 0;
    for (int32_t a = 0; a < f.sides && status == MPS_OK; a++) *beyond = fmax(*beyond, fmax(f.lo[a], -f.hi[a]));
    face_free(&f, w->context);
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

/* Ends along side e of a chord that reaches `half` to both sides, cut off at the face's ends; false if nothing is left. */
static bool chord(const face *f, int e, double half, double *from, double *to)
{
    *from = fmax(-half, f->lo[e]);
    *to = fmin(half, f->hi[e]);
    return *to > *from;
}

static double along(const face *f, const struct under *u, int e, double half)
{
    double from, to;
    if (!chord(f, e, half, &from, &to)) return 0;
    return tent_integral((to - u->at[e]) / f->width) - tent_integral((from - u->at[e]) / f->width);
}

/* Call for each chord of a disc: the place across, half its length, its share of the area. */
static void chord_of_disc(const face *f, int k, double *across, double *half, double *share)
{
    const double from = asin(fmin(fmax(f->lo[0] / f->radius, -1), 1)), to = asin(fmin(fmax(f->hi[0] / f->radius, -1), 1));
    const double angle = from + (to - from) * (k + 0.5) / CHORDS;
    *across = f->radius * sin(angle);
    *half = f->radius * cos(angle);
    *share = (to - from) * *half;
}

static double under_disc(const face *f, const struct under *u)
{
    double sum = 0, across, half, share;
    for (int k = 0; k < CHORDS; k++) {
        chord_of_disc(f, k, &across, &half, &share);
        const double part = tent((across - u->at[0]) / f->width);
        if (part > 0) sum += part * share * along(f, u, 1, half);
    }
    return sum;
}

/* Centroid of what the sensor covers; false if that is nothing. */
static bool find_target(face *f)
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

/* Factor of a weight at q from the target: k[0] + k[1] q[0] + k[2] q[1], so that the sum of the weights is 1 and their centroid the target.
 * False if the particles do not allow it. The weights of a lattice get no more than their sum's inverse. */
static bool correction(const face *f, double k[3])
{
    double s0 = 0, s1[2] = {0, 0}, s2[3] = {0, 0, 0}, g[2] = {0, 0};
    for (int64_t i = 0; i < f->count; i++) {
        const struct under *u = &f->list[i];
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
    if (hypot(s1[0], s1[1]) <= 1e-9 * f->dp * s0) return true;
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

/* Weights by tents of the face's width. Returns the sum of their absolute values, by which they amplify noise; INFINITY: there are none. */
static double weigh(face *f)
{
    double k[3], sum = 0;
    for (int64_t i = 0; i < f->count; i++)
        f->list[i].weight = f->sides == 1 ? along(f, &f->list[i], 0, f->radius) : under_disc(f, &f->list[i]);
    if (!correction(f, k)) return INFINITY;
    for (int64_t i = 0; i < f->count; i++) {
        struct under *u = &f->list[i];
        u->weight *= k[0] + k[1] * (u->at[0] - f->target[0]) + k[2] * (u->at[1] - f->target[1]);
        sum += fabs(u->weight);
    }
    return sum;
}

/* The narrowest tents whose weights are good, or else the best ones. False without weights. */
static bool weigh_best(face *f)
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

static mps_status keep_weights(mps__context *c, const face *f, mps__sensor *sensor)
{
    MPS__TRY(mps__grow(c, (void **)&sensor->list, &sensor->capacity, 0, f->count > 0 ? f->count : 1, sizeof *sensor->list));
    sensor->count = 0;
    for (int64_t k = 0; k < f->count; k++)
        if (f->list[k].weight != 0)
            sensor->list[sensor->count++] = (mps__sensor_weight){f->list[k].id, f->list[k].place, f->list[k].weight};
    return MPS_OK;
}

mps_status mps__sensor_build(mps__world *w, const mps_probe *config, mps__sensor *sensor)
{
    face f;
    mps_status status = face_init(&f, w, config);
    if (status == MPS_OK) status = face_collect(&f, w, config->at);
    if (status == MPS_OK && !weigh_best(&f)) f.count = 0;
    if (status == MPS_OK) status = keep_weights(w->context, &f, sensor);
    if (status == MPS_OK && sensor->count == 0) /* all of it is beside the face, or a single particle */
        sensor->list[sensor->count++] = (mps__sensor_weight){f.base->id, f.base->place, 1};
    face_free(&f, w->context);
    if (status < 0) return status;
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
