/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles near thin plates: start points of their lines of sight; no particle passes a plate. */
#include "plates.h"
#include "loop.h"
#include "world_ranks.h"
#include <string.h>

/* In spacings: distance of the start points of walls from their face; least distance of fluid from
 * the plane of a plate. */
static const double above_face = 1e-5, off_plane = 1e-2;

static void wall_sight(const mps__world *w, int64_t i, double at[3])
{
    const double *area = w->particles.area + i * w->setup.dim,
                 size = sqrt(mps__dot(area, area, w->setup.dim));
    for (int d = 0; d < w->setup.dim; d++)
        at[d] = w->particles.ref[i * w->setup.dim + d] +
                (size > 0 ? above_face * w->setup.dp * area[d] / size : 0);
}

/* Near-plate particles, the plates, and the pose of the tank. */
typedef struct look_fields {
    const int32_t *kind;
    const double *x;
    const mps__occluder *occluder;
    mps__near_plate *near_plate;
    int32_t occluders;
    double least; /* distance of fluid from the plane of a plate */
    const double *centre, *shift, *rotation;
} look_fields;

static look_fields fields_of(const mps__world *w)
{
    const mps__occluders *p = &w->lists.occluders;
    const mps__motion *m = &w->motion;
    return (look_fields){.kind = w->particles.kind,
                         .x = w->particles.x,
                         .occluder = p->list,
                         .near_plate = p->near_plate,
                         .occluders = p->count,
                         .least = off_plane * w->setup.dp,
                         .centre = m->centre,
                         .shift = m->now.state.value,
                         .rotation = m->now.rotation};
}

/* Fluid exactly in the plane of a plate, beyond its edge, would see both faces: move it to one
 * side. */
MPS_ROW void fluid_sight(const int dim, const look_fields *f, int64_t i, double at[3])
{
    mps__tank_place(dim, f->centre, f->shift, f->rotation, f->x + i * dim, at);
    for (int32_t k = 0; k < f->occluders; k++) {
        const mps__occluder *s = &f->occluder[k];
        const double height = mps__occluder_height(s, at),
                     least = height < 0 ? -f->least : f->least;
        if (fabs(height) >= f->least) continue;
        for (int d = 0; d < dim; d++) at[d] += (least - height) * s->normal[d];
    }
}

static void sight(const mps__world *w, const look_fields *f, int64_t i, double at[3])
{
    const mps__particles *s = &w->particles;
    at[2] = 0;
    if (s->kind[i] == MPS_FLUID)
        fluid_sight(w->setup.dim, f, i, at);
    else if (s->kind[i] == MPS_WALL)
        wall_sight(w, i, at);
    else
        memcpy(at, s->ref + i * w->setup.dim, (size_t)w->setup.dim * sizeof *at);
}

/* Whether, until the next search, X can be the partner of a particle or of a shadow beyond an
 * occluder. */
static bool near_occluder(const mps__world *w, const double *X)
{
    const double depth = fmax(3 * w->setup.dp, w->setup.re_far),
                 reach = w->setup.re_far + depth + w->lists.neighbours.skin;
    for (int32_t k = 0; k < w->lists.occluders.count; k++)
        if (mps__occluder_distance(&w->lists.occluders.list[k], X) < reach) return true;
    return false;
}

void mps__plates_set_active(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__occluders *p = &w->lists.occluders;
    for (int32_t k = 0; k < p->count; k++) p->list[k].active = false;
    for (int64_t i = 0; i < s->n; i++)
        if (s->plate[i] > 0 && s->kind[i] == MPS_WALL &&
            s->part[i] == p->list[s->plate[i] - 1].part)
            p->list[s->plate[i] - 1].active = true;
    for (int32_t k = 0; k < p->count && mps__ranks_many(&w->ranks); k++)
        mps__world_any(w, 1, &p->list[k].active);
}

mps_status mps__plates_find(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__occluders *p = &w->lists.occluders;
    if (p->count == 0) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    mps__plates_set_active(w);
    MPS__TRY(mps__grow(w->context, (void **)&p->slot, &p->slot_capacity, 0, s->n, sizeof *p->slot));
    p->near_plates = 0;
    const look_fields f = fields_of(w);
    for (int64_t i = 0; i < s->n; i++) {
        mps__near_plate near_plate = {.particle = (int32_t)i,
                                      .shadow = mps__is_shadow(s, i) ? s->plate[i] : 0};
        sight(w, &f, i, near_plate.at);
        mps__occluders_sides(p->list, p->count, &near_plate);
        p->slot[i] = -1;
        if (!near_occluder(w, near_plate.at)) continue;
        MPS__TRY(mps__grow(w->context, (void **)&p->near_plate, &p->near_plate_capacity,
                           p->near_plates, p->near_plates + 1, sizeof near_plate));
        p->slot[i] = (int32_t)p->near_plates;
        p->near_plate[p->near_plates++] = near_plate;
    }
    return MPS_OK;
}

/* Near-plate particle k. Solids are at rest in the tank. */
MPS_ROW void look_row(const int dim, const look_fields *f, int64_t k)
{
    mps__near_plate *near_plate = &f->near_plate[k];
    if (f->kind[near_plate->particle] != MPS_FLUID) return;
    near_plate->at[2] = 0;
    fluid_sight(dim, f, near_plate->particle, near_plate->at);
    mps__occluders_sides(f->occluder, f->occluders, near_plate);
}
MPS__LOOP(look_rows, look_row, look_fields)

void mps__plates_look(mps__world *w)
{
    const look_fields f = fields_of(w);
    mps__loop_run(&w->pool.parallel, &look_rows, w->setup.dim, w->lists.occluders.near_plates, &f);
}

/* Restore the distance from the plate, and keep only the velocity along the plate, unless it
 * recedes. */
static void stop(mps__world *w, const mps__pose *end, int64_t i, const mps__occluder *s,
                 double height, double X[3])
{
    double *x = w->particles.x + i * w->setup.dim, *u = w->particles.u + i * w->setup.dim, n[3],
           v[3], approach = 0;
    const double back = height - mps__occluder_height(s, X);
    for (int d = 0; d < w->setup.dim; d++) X[d] += back * s->normal[d];
    mps__motion_point(&w->motion, end, X, x, v, NULL);
    mps__motion_rotate(&w->motion, end, s->normal, n);
    for (int d = 0; d < w->setup.dim; d++) approach += (u[d] - v[d]) * n[d];
    for (int d = 0; d < w->setup.dim; d++) u[d] -= approach * height < 0 ? approach * n[d] : 0;
}

void mps__plates_stop(mps__world *w, const mps__pose *end)
{
    const mps__occluders *p = &w->lists.occluders;
    if (p->count == 0) return;
    for (int64_t k = 0; k < p->near_plates; k++) {
        const mps__near_plate *near_plate = &p->near_plate[k];
        const int64_t i = near_plate->particle;
        double X[3] = {0};
        if (w->particles.kind[i] != MPS_FLUID) continue;
        mps__motion_to_tank(&w->motion, end, w->particles.x + i * w->setup.dim, X);
        for (int32_t m = 0; m < p->count; m++)
            if (p->list[m].active && mps__occluder_crossed(&p->list[m], near_plate->at, X))
                stop(w, end, i, &p->list[m], mps__occluder_height(&p->list[m], near_plate->at), X);
    }
}

bool mps__plates_hide(const mps__world *w, const double *X, int64_t i)
{
    if (w->lists.occluders.count == 0) return false;
    mps__near_plate from = {0}, to = {0};
    if (mps__is_shadow(&w->particles, i)) return true;
    memcpy(from.at, X, (size_t)w->setup.dim * sizeof *X);
    const look_fields f = fields_of(w);
    sight(w, &f, i, to.at);
    mps__occluders_sides(f.occluder, f.occluders, &from);
    mps__occluders_sides(f.occluder, f.occluders, &to);
    return mps__occluders_hidden(w->lists.occluders.list, w->lists.occluders.count, &from, &to);
}

int32_t mps__plates_part(const mps__world *w, int64_t i, int d)
{
    const int32_t plate = w->particles.plate[i];
    if (plate == 0 || w->lists.occluders.list[plate - 1].axis != d ||
        w->particles.area[i * w->setup.dim + d] == 0)
        return -1;
    return w->lists.occluders.list[plate - 1].part;
}

double mps__plates_fraction(const mps__world *w, int64_t i)
{
    const mps__particles *s = &w->particles;
    if (s->plate[i] == 0 || s->kind[i] != MPS_WALL ||
        w->lists.occluders.list[s->plate[i] - 1].columns > 1)
        return 1;
    return mps__dot(s->area + i * w->setup.dim, w->lists.occluders.list[s->plate[i] - 1].normal,
                    w->setup.dim) != 0
               ? 0.5
               : 1;
}
