/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a lattice meets a surface at any angle, its first points are 0.5 to 1.5 dp from it: too
 * near, or leaving a gap that tears. All free points near solids repel each other and are repelled
 * by solids, filled or not: otherwise points at a free surface would be pushed up. */
#include "packing.h"
#include "buckets.h"
#include <math.h>
#include <string.h>

enum { SWEEPS = 30 };
/* In spacings: distance within which points move, and within which they repel; range and length of
 * the repulsion; largest displacement. */
static const double moving = 2.6, taking_part = 4.3, range = 1.6, push = 0.12, longest = 0.45,
                    occupied = 0.5;

typedef struct work {
    mps_sim *sim;
    mps__packing *out;
    mps__buckets solids;
    double *home, lo[3], hi[3];
    int32_t *free; /* whether a point may move */
    int64_t home_capacity, free_capacity;
} work;

/* Distance to the nearest solid whose box contains a position. */
static double clearance(const mps_sim *sim, const double X[3])
{
    double least = INFINITY, r;
    for (int32_t k = 0; k < sim->solids; k++)
        if (mps__distances_at(&sim->solid[k], X, &r)) least = fmin(least, r);
    return least;
}

static mps_status collect_solids(work *w)
{
    const mps__particles *s = &w->sim->world.particles;
    MPS__TRY(mps__buckets_init(&w->solids, &w->sim->context, s->dim, w->lo, w->hi,
                               w->sim->world.setup.dp));
    for (int64_t i = 0; i < s->n; i++) {
        double X[3] = {0, 0, 0};
        if (s->kind[i] == MPS_FLUID || mps__is_shadow(s, i)) continue;
        memcpy(X, s->ref + i * s->dim, (size_t)s->dim * sizeof *X);
        MPS__TRY(mps__buckets_add(&w->solids, X));
    }
    return MPS_OK;
}

static mps_status add_point(work *w, int64_t place, const double X[3], bool may_move)
{
    mps__packing *p = w->out;
    mps__context *c = &w->sim->context;
    const int64_t i = p->count;
    MPS__TRY(mps__grow(c, (void **)&p->x, &p->capacity, 3 * i, 3 * (i + 1), sizeof *p->x));
    MPS__TRY(
        mps__grow(c, (void **)&w->home, &w->home_capacity, 3 * i, 3 * (i + 1), sizeof *w->home));
    MPS__TRY(mps__grow(c, (void **)&w->free, &w->free_capacity, i, i + 1, sizeof *w->free));
    memcpy(p->x + 3 * i, X, 3 * sizeof *X);
    memcpy(w->home + 3 * i, X, 3 * sizeof *X);
    w->free[i] = may_move;
    p->number[place] = (int32_t)(i + 1);
    p->count++;
    return MPS_OK;
}

static mps_status collect_points(work *w)
{
    const mps_sim *sim = w->sim;
    const double dp = sim->world.setup.dp;
    const int64_t *n = w->out->n;
    for (int64_t place = 0; place < n[0] * n[1] * n[2]; place++) {
        const int64_t k[3] = {place % n[0], place / n[0] % n[1], place / n[0] / n[1]};
        double X[3] = {0, 0, 0};
        for (int d = 0; d < sim->world.setup.dim; d++)
            X[d] = sim->lattice_lo[d] + (double)k[d] * sim->lattice_h[d];
        const double r = clearance(sim, X);
        if (r > taking_part * dp || mps__solid_covers(sim, X)) continue;
        if (mps__buckets_nearest(&w->solids, X, occupied * (1 - 1e-9) * dp, NULL) >= 0) continue;
        MPS__TRY(add_point(w, place, X, r < moving * dp));
    }
    return MPS_OK;
}

typedef struct pushes {
    double range, sum[3];
} pushes;

static void add_push(void *user, int64_t point, const double d[3], double r2)
{
    pushes *p = user;
    const double r = sqrt(r2), q = 1 - r / p->range;
    (void)point;
    for (int a = 0; a < 3 && r > 0; a++) p->sum[a] -= q * q * d[a] / r;
}

/* One sweep: all points use the positions before it. */
static mps_status sweep(work *w)
{
    mps__packing *p = w->out;
    const double dp = w->sim->world.setup.dp;
    mps__buckets now;
    mps_status status = mps__buckets_init(&now, p->context, w->sim->world.setup.dim, w->lo, w->hi,
                                          dp);
    if (status == MPS_OK) status = mps__buckets_reserve(&now, p->count);
    for (int64_t i = 0; i < p->count && status == MPS_OK; i++)
        status = mps__buckets_add(&now, p->x + 3 * i);
    for (int64_t i = 0; i < p->count && status == MPS_OK; i++) {
        pushes sum = {range * dp, {0, 0, 0}};
        double way[3], length2 = 0, *x = p->x + 3 * i;
        if (!w->free[i]) continue;
        mps__buckets_visit(&now, x, sum.range, add_push, &sum);
        mps__buckets_visit(&w->solids, x, sum.range, add_push, &sum);
        for (int d = 0; d < 3; d++) {
            way[d] = x[d] + push * dp * sum.sum[d] - w->home[3 * i + d];
            length2 += way[d] * way[d];
        }
        const double scale = fmin(1.0, longest * dp / fmax(sqrt(length2), 1e-30));
        for (int d = 0; d < 3; d++) x[d] = w->home[3 * i + d] + scale * way[d];
    }
    mps__buckets_free(&now);
    return status;
}

static mps_status make(work *w)
{
    mps_sim *sim = w->sim;
    mps__packing *p = w->out;
    for (int d = 0; d < sim->world.setup.dim; d++) {
        p->n[d] = sim->lattice_cells[d] + 1;
        w->lo[d] = sim->lattice_lo[d];
        w->hi[d] = w->lo[d] + (double)sim->lattice_cells[d] * sim->lattice_h[d];
    }
    p->number = mps__alloc(&sim->context, p->n[0] * p->n[1] * p->n[2], sizeof *p->number);
    if (!p->number) return MPS_E_NOMEM;
    MPS__TRY(collect_solids(w));
    MPS__TRY(collect_points(w));
    for (int k = 0; k < SWEEPS; k++) MPS__TRY(sweep(w));
    return MPS_OK;
}

mps_status mps__packing_make(mps__packing *p, mps_sim *sim)
{
    *p = (mps__packing){.context = &sim->context, .n = {1, 1, 1}};
    if (sim->solids == 0) return MPS_OK;
    work w = {.sim = sim, .out = p};
    const mps_status status = make(&w);
    mps__buckets_free(&w.solids);
    mps__free(&sim->context, w.home);
    mps__free(&sim->context, w.free);
    return status;
}

void mps__packing_free(mps__packing *p)
{
    if (!p->context) return;
    mps__free(p->context, p->number);
    mps__free(p->context, p->x);
    *p = (mps__packing){0};
}

void mps__packing_place(const mps__packing *p, const int64_t k[3], double *X)
{
    const int32_t i = p->number ? p->number[k[0] + p->n[0] * (k[1] + p->n[1] * k[2])] : 0;
    for (int d = 0; d < 3 && i > 0; d++) X[d] = p->x[3 * (int64_t)(i - 1) + d];
}
