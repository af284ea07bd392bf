/* SPDX-License-Identifier: BSD-3-Clause */
/* Find the wall face that contains a sensor: the face with the nearest plane, of tanks, baffles,
 * plates and packed solids. It extends to the wall on which it is mounted, without walls that a
 * solid covers or a plate hides. */
#include "probe_face.h"
#include "angles.h"
#include "plates.h"
#include "probes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In spacings. flat: distance of walls from the plane of their face; beside: neighbours that
 * distinguish a face from an edge; cover: reach of a particle for its face; foot_gap: gap to the
 * wall on which a face is mounted; around: averaging radius of normals; as_near: difference of
 * distances up to which a second face is reported; near: distance of a requested face; aside:
 * search distance beside the sensor. */
static const double flat = 0.25, beside = 1.6, cover = 1.2, foot_gap = 1.3, around = 1.9,
                    as_near = 0.5, near = 2, aside = 3.5;

/* Cosines: of the largest angle between a normal and the requested one, and of the smallest angle
 * between two faces. */
static const double cosine_requested = 0.8660254037844386, cosine_other = 0.9;

/* Cosine of the smallest angle between faces at an edge, 39 degrees. A curved face of radius 5 dp
 * turns by less within the reach of a sensor. */
static const double turned = 0.78;

typedef mps__face_solid solid;

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
        if (s->kind[i] == MPS_WALL)
            least = fmin(least, distance2(&s->ref[i * w->setup.dim], at, w->setup.dim));
    return sqrt(least);
}
static int compare_solid(const void *a, const void *b)
{
    const int64_t i = ((const solid *)a)->id, j = ((const solid *)b)->id;
    return (i > j) - (i < j);
}

/* Solids around the sensor, by id, so that nothing depends on the particle order. */
static mps_status collect_solids(mps__face *f, mps__world *w, const double *at)
{
    const mps__particles *s = &w->particles;
    const double reach = mps__sensor_distance(w, at) + 1.5 * (f->radius + 4 * w->setup.dp);
    for (int64_t i = 0; i < s->n; i++) {
        solid e = {.id = s->id[i], .place = i, .wall = s->kind[i] == MPS_WALL};
        if (s->kind[i] == MPS_FLUID || mps__is_shadow(s, i) ||
            distance2(&s->ref[i * w->setup.dim], at, w->setup.dim) > reach * reach)
            continue;
        const double *area = &s->area[i * w->setup.dim],
                     size = e.wall ? sqrt(mps__dot(area, area, w->setup.dim)) : 0;
        for (int32_t d = 0; d < w->setup.dim; d++) {
            e.r[d] = s->ref[i * w->setup.dim + d] - at[d];
            e.n[d] = size > 0 ? area[d] / size : 0;
        }
        MPS__TRY(mps__grow(w->context, (void **)&f->solid, &f->solid_capacity, f->solids,
                           f->solids + 1, sizeof e));
        f->solid[f->solids++] = e;
    }
    qsort(f->solid, (size_t)f->solids, sizeof *f->solid, compare_solid);
    return MPS_OK;
}

static bool has_normal(const solid *e)
{
    return mps__dot(e->n, e->n, 3) > 0;
}

/* On an edge the particle has no neighbours in the plane normal to its area, in 3-D only those
 * along the edge. */
static bool on_face(const mps__face *f, const solid *e)
{
    double moment[3] = {0, 0, 0}, tangent[2][3] = {{0}};
    if (!has_normal(e)) return false;
    mps__probe_across(f->dim, e->n, tangent);
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *o = &f->solid[k];
        double r[3], t[2];
        for (int d = 0; d < 3; d++) r[d] = (o->r[d] - e->r[d]) / f->dp;
        if (!o->wall || mps__dot(r, r, 3) > beside * beside || fabs(mps__dot(r, e->n, 3)) > flat ||
            mps__dot(o->n, e->n, 3) <= 0)
            continue;
        for (int a = 0; a < 2; a++) t[a] = mps__dot(r, tangent[a], 3);
        moment[0] += t[0] * t[0];
        moment[1] += t[0] * t[1];
        moment[2] += t[1] * t[1];
    }
    if (f->dim == 2) return moment[0] > 0.1;
    const double mean = 0.5 * (moment[0] + moment[2]),
                 root = mps__hypot(0.5 * (moment[0] - moment[2]), moment[1]);
    return mean - root > 0.3;
}

/* Squared distance of the sensor from the cell of a wall particle: normal to its plane, and along
 * it beyond the cell. */
static double remoteness(const mps__face *f, const solid *e)
{
    const double off = mps__dot(e->r, e->n, 3), square = mps__dot(e->r, e->r, 3),
                 along = sqrt(fmax(0, square - off * off));
    if (!has_normal(e)) return square;
    const double beyond = fmax(0, along - cover * f->dp);
    return off * off + beyond * beyond + 1e-4 * along * along;
}

/* Whether a wall particle has the requested normal and is close enough. */
static bool is_wanted(const mps__face *f, const solid *e)
{
    const double most = (near + 1e-6) * f->dp;
    return !f->wanted ||
           (mps__dot(e->n, f->wanted, 3) >= cosine_requested && remoteness(f, e) <= most * most);
}

/* Closest wall particle of a face. At equal distance the one facing the sensor, then the lower id.
 * NULL: none. */
static solid *least_remote(const mps__face *f, bool (*may_be)(const mps__face *f, const solid *e))
{
    const double margin = 1e-10 * f->dp * f->dp;
    double least = INFINITY, towards = 0;
    solid *best = NULL;
    for (int64_t k = 0; k < f->solids; k++) {
        solid *e = &f->solid[k];
        if (!e->wall || !is_wanted(f, e)) continue;
        const double remote = remoteness(f, e), looks = -mps__dot(e->r, e->n, 3);
        if (remote > least + margin || (best && remote >= least - margin && looks <= towards) ||
            !may_be(f, e))
            continue;
        least = fmin(least, remote);
        towards = looks;
        best = e;
    }
    return best;
}

static bool any_with_normal(const mps__face *f, const solid *e)
{
    (void)f;
    return has_normal(e);
}

static bool any_wall(const mps__face *f, const solid *e)
{
    (void)f;
    return e->wall;
}

/* Normal of a wall without areas, e.g. a plate one particle thick: the axis of least extent of the
 * part around `base`. */
static void flat_axis(const mps__world *w, int64_t base, double normal[3])
{
    const mps__particles *s = &w->particles;
    double spread[3] = {0, 0, 0};
    for (int64_t i = 0; i < s->n; i++) {
        const double *here = &s->ref[i * w->setup.dim], *there = &s->ref[base * w->setup.dim];
        if (s->kind[i] != MPS_WALL || s->part[i] != s->part[base] ||
            distance2(here, there, w->setup.dim) > 4.41 * w->setup.dp * w->setup.dp)
            continue;
        for (int32_t d = 0; d < w->setup.dim; d++) spread[d] += fabs(here[d] - there[d]);
    }
    int32_t least = 0;
    for (int32_t d = 1; d < w->setup.dim; d++)
        if (spread[d] < spread[least]) least = d;
    normal[least] = 1;
}

/* Mean normal of the face around the sensor: normals of particles near an edge include the other
 * face, those of a curved face vary. */
static void face_normal(mps__face *f, const mps__world *w)
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
        if (!e->wall || fabs(mps__dot(r, base->n, 3)) > flat || mps__dot(e->n, base->n, 3) < 0.9)
            continue;
        const double weight = 1 - mps__dot(foot, foot, 3) / (around * around);
        if (e != base && (weight <= 0 || !on_face(f, e))) continue;
        for (int d = 0; d < 3; d++) sum[d] += fmax(weight, 0.1) * e->n[d];
    }
    const double size = sqrt(mps__dot(sum, sum, 3));
    for (int d = 0; d < 3; d++) f->normal[d] = sum[d] / size;
}

/* Error: there is no wall, or none with the requested normal. */
static mps_status no_base(const mps__face *f, const mps__world *w)
{
    if (!f->wanted)
        return mps__fail(w->context, MPS_E_STATE, "wall pressure: there is no wall particle");
    return mps__fail(w->context, MPS_E_STATE,
                     "wall pressure: no face within 2 dp = %g m of probe.at looks along "
                     "probe.normal (%g, %g, %g), or within 30 degrees of it",
                     near * f->dp, f->wanted[0], f->wanted[1], f->wanted[2]);
}

static mps_status find_base(mps__face *f, mps__world *w, const mps_probe *c)
{
    *f = (mps__face){
        .dim = w->setup.dim, .sides = w->setup.dim - 1, .dp = w->setup.dp, .width = w->setup.dp};
    f->wanted = mps__dot(c->normal, c->normal, 3) > 0 ? c->normal : NULL;
    f->radius = fmax(0.5 * c->diameter, 1e-6 * w->setup.dp);
    MPS__TRY(collect_solids(f, w, c->at));
    f->base = least_remote(f, on_face);
    if (!f->base) f->base = least_remote(f, any_with_normal);
    if (!f->base) f->base = least_remote(f, any_wall);
    if (!f->base) return no_base(f, w);
    face_normal(f, w);
    f->off = -mps__dot(f->base->r, f->normal, 3);
    mps__probe_across(w->setup.dim, f->normal, f->tangent);
    return MPS_OK;
}

/* Whether the particle belongs to a face with another normal. */
static bool on_other_face(const mps__face *f, const solid *e)
{
    return mps__dot(e->n, f->normal, 3) < cosine_other && on_face(f, e);
}

const mps__face_solid *mps__face_rival(mps__face *f)
{
    const double own = sqrt(remoteness(f, f->base));
    f->wanted = NULL;
    const solid *e = has_normal(f->base) ? least_remote(f, on_other_face) : NULL;
    return e && sqrt(remoteness(f, e)) <= own + as_near * f->dp ? e : NULL;
}

void mps__face_free(mps__face *f, mps__context *c)
{
    mps__free(c, f->list);
    mps__free(c, f->solid);
}

static double height(const mps__face *f, const solid *e)
{
    return mps__dot(e->r, f->normal, 3) + f->off;
}

/* Whether a solid is in contact with the wall particle, so that it is not wetted. */
static bool is_covered(const mps__face *f, const solid *e)
{
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *o = &f->solid[k];
        double r[3];
        for (int d = 0; d < 3; d++) r[d] = (o->r[d] - e->r[d]) / f->dp - e->n[d];
        const double square = mps__dot(r, r, 3);
        if (square < 0.01 ? !o->wall || mps__dot(o->n, e->n, 3) < -0.9 : square < 0.25 && !o->wall)
            return true;
    }
    return false;
}

/* Whether the liquid in front of the face reaches a wall particle: neither hidden by a plate nor
 * covered by a solid. */
static bool is_open(const mps__face *f, const mps__world *w, const double *at, const solid *e)
{
    const solid *b = f->base;
    double from[3] = {0, 0, 0};
    if (e == b) return true;
    const double off = mps__dot(b->r, b->n, 3) + 0.01 * f->dp;
    for (int32_t d = 0; d < f->dim; d++) from[d] = at[d] + off * b->n[d] + 0.01 * b->r[d];
    return !mps__plates_hide(w, from, e->place) && !(has_normal(e) && is_covered(f, e));
}

static mps_status add_member(mps__face *f, mps__context *c, solid *e)
{
    mps__face_point u = {.id = e->id, .place = e->place};
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

/* Whether a wall particle is in the face's plane, faces the same side and contributes pressure to
 * the sensor. */
static bool face_has(const mps__face *f, const mps__particles *s, const solid *e)
{
    if (!e->wall || fabs(height(f, e)) > flat * f->dp) return false;
    for (int32_t a = 0; a < f->sides; a++)
        if (fabs(mps__dot(e->r, f->tangent[a], 3)) > f->radius + aside * f->dp) return false;
    return has_normal(e) ? mps__dot(e->n, f->normal, 3) > 1e-9
                         : s->part[e->place] == s->part[f->base->place];
}

/* Intersection of another wall's plane with the face, along the tangents; false if it is far
 * away. */
static bool meets_face(const mps__face *f, const solid *e, double at[2])
{
    double across = 0, t[2] = {0, 0};
    const double h = height(f, e), up = mps__dot(e->n, f->normal, 3);
    if (!e->wall || e->member || h < -flat * f->dp || h > 1.1 * f->dp || up < -0.5 || up > 0.9)
        return false;
    for (int32_t a = 0; a < f->sides; a++) {
        t[a] = mps__dot(e->n, f->tangent[a], 3);
        across += t[a] * t[a];
    }
    for (int32_t a = 0; a < f->sides; a++)
        at[a] = mps__dot(e->r, f->tangent[a], 3) + (across > 0 ? up * h * t[a] / across : 0);
    return across > 0.1;
}

/* Extend the face to the wall on which it is mounted, if that is next to its last particles. */
static mps_status reach_foot(mps__face *f, mps__world *w, const double *at)
{
    const int64_t members = f->count;
    for (int64_t k = 0; k < f->solids; k++) {
        solid *e = &f->solid[k];
        double end[2] = {0, 0}, least = INFINITY;
        if (!meets_face(f, e, end) || !is_open(f, w, at, e)) continue;
        for (int64_t m = 0; m < members; m++)
            least = fmin(least, distance2(end, f->list[m].at, f->sides));
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

/* Height of a above the plane of particle o. */
static double from_plane(const solid *a, const solid *o)
{
    const double r[3] = {a->r[0] - o->r[0], a->r[1] - o->r[1], a->r[2] - o->r[2]};
    return mps__dot(r, o->n, 3);
}

static bool beside_each_other(const mps__face *f, const solid *a, const solid *b)
{
    return a != b && distance2(a->r, b->r, 3) <= beside * beside * f->dp * f->dp;
}

/* Whether wall particle e is on an edge where the face turns away from the liquid: a neighbouring
 * face extends behind this face, e is in both planes, and this face extends behind the other. */
static bool on_edge(const mps__face *f, const solid *e)
{
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *o = &f->solid[k];
        if (!o->wall || !has_normal(o) || !beside_each_other(f, e, o) ||
            height(f, o) >= -flat * f->dp || mps__dot(o->n, f->normal, 3) >= turned ||
            fabs(from_plane(e, o)) > flat * f->dp)
            continue;
        for (int64_t m = 0; m < f->solids; m++) {
            const solid *a = &f->solid[m];
            if (a->member && beside_each_other(f, e, a) &&
                from_plane(a, o) < from_plane(e, o) - flat * f->dp)
                return true;
        }
    }
    return false;
}

/* Mark the members of this face alone, and those on an edge that it shares. */
static void mark_edges(mps__face *f)
{
    for (int64_t k = 0; k < f->solids; k++) {
        const solid *e = &f->solid[k];
        if (!e->member || mps__dot(e->n, f->normal, 3) <= 1e-9) continue;
        const bool edge = on_edge(f, e);
        for (int64_t m = 0; m < f->count; m++) {
            if (f->list[m].id != e->id) continue;
            f->list[m].edge = edge;
            f->list[m].inside = !edge && mps__dot(e->n, f->normal, 3) >= cosine_other;
        }
    }
}

static int compare_under(const void *a, const void *b)
{
    const int64_t i = ((const mps__face_point *)a)->id, j = ((const mps__face_point *)b)->id;
    return (i > j) - (i < j);
}

static mps_status collect_members(mps__face *f, mps__world *w, const double *at)
{
    for (int a = 0; a < 2; a++) {
        f->lo[a] = INFINITY;
        f->hi[a] = -INFINITY;
    }
    for (int64_t k = 0; k < f->solids; k++)
        if (face_has(f, &w->particles, &f->solid[k]) && is_open(f, w, at, &f->solid[k]))
            MPS__TRY(add_member(f, w->context, &f->solid[k]));
    MPS__TRY(reach_foot(f, w, at));
    mark_edges(f);
    if (f->count > 0) qsort(f->list, (size_t)f->count, sizeof *f->list, compare_under);
    return MPS_OK;
}
mps_status mps__face_find(mps__face *f, mps__world *w, const mps_probe *c)
{
    MPS__TRY(find_base(f, w, c));
    return collect_members(f, w, c->at);
}

bool mps__face_has_sides(const mps__face *f)
{
    return has_normal(f->base);
}
