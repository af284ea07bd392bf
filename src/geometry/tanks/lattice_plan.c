/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on a lattice: choose points that are free, then append them all at once. */
#include "lattice_plan.h"
#include <math.h>
#include <string.h>

void mps__lattice_plan_init(mps__lattice_plan *p, mps_sim *sim, const mps__lattice_box *box)
{
    *p = (mps__lattice_plan){.sim = sim, .box = *box, .dim = sim->world.setup.dim};
}

static int64_t plan_points(const mps__lattice_plan *p)
{
    int64_t n = 1;
    for (int d = 0; d < 3; d++) n *= p->box.last[d] - p->box.first[d] + 1;
    return n;
}

bool mps__lattice_plan_next(const mps__lattice_plan *p, int64_t k[3])
{
    for (int d = 0; d < 3; d++) {
        if (++k[d] <= p->box.last[d]) return true;
        k[d] = p->box.first[d];
    }
    return false;
}

void mps__lattice_point(const mps__lattice_plan *p, const int64_t k[3], double X[3])
{
    for (int d = 0; d < p->dim; d++) X[d] = p->box.lo[d] + (double)k[d] * p->box.h[d];
}

/* Index in `state` of the lattice point that a particle at X occupies, i.e. nearer than half a
 * cell; -1: none. */
static int64_t occupied(const mps__lattice_plan *p, const double *X)
{
    int64_t place = 0, stride = 1;
    double distance2 = 0;
    for (int d = 0; d < p->dim; d++) {
        double q = (X[d] - p->box.lo[d]) / p->box.h[d], nearest = round(q);
        if (nearest < (double)p->box.first[d] || nearest > (double)p->box.last[d]) return -1;
        distance2 += (q - nearest) * (q - nearest);
        place += ((int64_t)nearest - p->box.first[d]) * stride;
        stride *= p->box.last[d] - p->box.first[d] + 1;
    }
    return distance2 < 0.25 * (1 - 1e-9) ? place : -1;
}

static void mark_taken(mps__lattice_plan *p)
{
    const mps__particles *s = &p->sim->world.particles;
    const mps__motion *m = &p->sim->world.motion;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3];
        if (mps__is_shadow(s, i)) continue;
        mps__motion_to_tank(m, &m->now, &s->x[i * p->dim], X);
        int64_t place = occupied(p, X);
        if (place >= 0) p->state[place] = s->kind[i] == MPS_FLUID ? POINT_FLUID : POINT_SOLID;
    }
}

bool mps__plate_covers(const mps_sim *sim, const double *X)
{
    static const double least = 0.7; /* [dp] */
    const mps__occluders *s = &sim->world.lists.occluders;
    for (int32_t m = 0; m < s->count; m++)
        if (s->list[m].axis < 0 &&
            mps__occluder_distance(&s->list[m], X) < least * sim->world.setup.dp)
            return true;
    return false;
}

static void mark_plates(mps__lattice_plan *p)
{
    const mps__occluders *s = &p->sim->world.lists.occluders;
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    bool any = false;
    for (int32_t m = 0; m < s->count; m++) any = any || s->list[m].axis < 0;
    if (!any) return;
    do {
        double X[3] = {0, 0, 0};
        mps__lattice_point(p, k, X);
        if (mps__plate_covers(p->sim, X)) p->state[place] = POINT_SOLID;
        place++;
    } while (mps__lattice_plan_next(p, k));
}

/* Mark points in a solid or nearer than half a cell to its surface. */
static void mark_solids(mps__lattice_plan *p)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    if (p->sim->solids == 0 || p->of_tank) return;
    do {
        double X[3] = {0, 0, 0};
        mps__lattice_point(p, k, X);
        if (mps__solid_covers(p->sim, X)) p->state[place] = POINT_SOLID;
        place++;
    } while (mps__lattice_plan_next(p, k));
}

static void mark_chosen(mps__lattice_plan *p)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    p->taken = p->chosen = 0;
    do {
        if (p->state[place] >= POINT_FLUID) {
            /* only points of the plan count as conflicts, and a user's `inside` is evaluated for
             * free points only */
            if (!p->inside) p->taken += p->choose(p, k);
        } else if (p->choose(p, k)) {
            p->state[place] = POINT_CHOSEN;
            p->chosen++;
        }
        place++;
    } while (mps__lattice_plan_next(p, k));
}

int mps__lattice_plan_beside(const mps__lattice_plan *p, const int64_t k[3], int axis, int64_t step)
{
    int64_t place = 0, stride = 1;
    const int64_t at = k[axis] + step;
    if (at < p->box.first[axis] || at > p->box.last[axis])
        return at <= 0 || at >= p->sim->lattice_cells[axis] ? POINT_SOLID : POINT_FREE;
    for (int d = 0; d < p->dim; d++) {
        place += (k[d] + (d == axis ? step : 0) - p->box.first[d]) * stride;
        stride *= p->box.last[d] - p->box.first[d] + 1;
    }
    return p->state[place];
}

static void place_particle(const mps__lattice_plan *p, const int64_t k[3], int64_t i)
{
    mps__world *w = &p->sim->world;
    mps__particles *s = &w->particles;
    mps__lattice_site here = {0};
    double X[3] = {0, 0, 0};
    p->describe(p, k, &here);
    mps__lattice_point(p, k, X);
    mps__packing_place(&p->packing, k, X);
    /* solids are at rest before the first step, so that they jump to their velocity in it */
    mps__motion_point(&w->motion, &w->motion.now, X, &s->x[i * p->dim], NULL, NULL);
    if (here.kind != MPS_FLUID) {
        memcpy(&s->ref[i * p->dim], X, (size_t)p->dim * sizeof(double));
        memcpy(&s->area[i * p->dim], here.area, (size_t)p->dim * sizeof(double));
    }
    s->kind[i] = here.kind;
    s->phase[i] = here.phase;
    s->part[i] = here.part;
    s->rho[i] = w->setup.phase_density[here.phase];
}

/* Decide for every lattice point of the box; the particles are not changed. Call
 * mps__lattice_plan_free() afterwards in any case. */
mps_status mps__lattice_plan_choose(mps__lattice_plan *p)
{
    p->state = mps__alloc(&p->sim->context, plan_points(p), 1);
    if (!p->state) return MPS_E_NOMEM;
    mark_taken(p);
    mark_plates(p);
    mark_solids(p);
    mark_chosen(p);
    return MPS_OK;
}

mps_status mps__lattice_plan_build(mps__lattice_plan *p)
{
    mps__particles *s = &p->sim->world.particles;
    MPS__TRY(mps__particles_reserve(s, p->chosen));
    int64_t i = mps__particles_append(s, p->chosen, MPS_FLUID), place = 0;
    bool solids = false;
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]};
    do
        if (p->state[place++] == POINT_CHOSEN) {
            place_particle(p, k, i);
            if (s->kind[i++] != MPS_FLUID) solids = true;
        }
    while (mps__lattice_plan_next(p, k));
    s->solids += solids;
    p->sim->world.lists.neighbours.valid = false;
    return MPS_OK;
}

void mps__lattice_plan_free(mps__lattice_plan *p)
{
    mps__free(&p->sim->context, p->state);
    mps__packing_free(&p->packing);
}
