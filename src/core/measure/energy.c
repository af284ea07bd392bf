/* SPDX-License-Identifier: BSD-3-Clause */
/* Energies, mass, volume and momentum of the fluid, and budgets of energy and momentum. */
#include "budget.h"
#include "probes.h"
#include "world_ranks.h"
#include "terms.h"
#include <math.h>
#include <mps/model.h>
#include <string.h>

static void bulk_sums(const mps__world *w, mps_energy *e)
{
    const mps__particles *s = &w->particles;
    const double volume = w->setup.dim == 2 ? w->setup.dp * w->setup.dp
                                            : w->setup.dp * w->setup.dp * w->setup.dp;
    mps_exact sums[4] = {{{0}, 0, 0}}; /* mass, and mass times position */
    mps__terms t;
    int64_t count = 0;
    mps__terms_begin(&t, sums, 1 + w->setup.dim);
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        double own[4] = {s->rho[i] * volume};
        if (s->kind[i] != MPS_FLUID) continue;
        for (int32_t d = 0; d < w->setup.dim; d++) own[1 + d] = own[0] * s->x[i * w->setup.dim + d];
        mps__terms_add(&t, own);
        count++;
    }
    mps__terms_end(&t);
    mps__ranks_sum(w->ghosts.ranks, 1 + w->setup.dim, sums);
    mps__ranks_add(w->ghosts.ranks, 1, &count);
    e->mass = mps_exact_value(&sums[0]);
    for (int32_t d = 0; d < w->setup.dim; d++) e->centre[d] = mps_exact_value(&sums[1 + d]);
    e->volume = volume * (double)count;
    for (int32_t d = 0; d < w->setup.dim; d++)
        if (e->mass > 0) e->centre[d] /= e->mass;
}

/* Whether there is fluid in front of a wall: within 0.75 dp of the wall's normal, 2 dp deep. The
 * layer of walls above the surface has the uppermost fluid 1 dp beside its normal, and is dry; in
 * moving liquid a lattice point has fluid within 0.71 dp. */
static bool is_wet(const mps__world *w, const mps_neighbours *l, int64_t i)
{
    const mps__particles *s = &w->particles;
    const int dim = w->setup.dim;
    const double dp = w->setup.dp, *own = s->area + i * dim, *x = s->x + i * dim;
    double area[3] = {0}, n[3];
    memcpy(area, own, (size_t)dim * sizeof *own);
    mps__motion_rotate(&w->motion, &w->motion.now, area, n);
    const double size = sqrt(mps__dot(n, n, dim));
    for (int64_t k = l->begin[i]; size > 0 && k < l->begin[i] + l->count[i]; k++) {
        const double *other = s->x + (int64_t)l->col[k] * dim;
        double d[3] = {0};
        if (s->kind[l->col[k]] != MPS_FLUID) continue;
        for (int a = 0; a < dim; a++) d[a] = other[a] - x[a];
        const double along = mps__dot(d, n, dim) / size;
        const double aside2 = mps__dot(d, d, dim) - along * along;
        if (along > 0 && along < 2 * dp && aside2 < 0.75 * 0.75 * dp * dp) return true;
    }
    return false;
}

/* Volume of the half cells of wetted walls, minus that of the half cells above the free surface.
 * The areas of a closed surface sum to zero, so the free surface has the remaining area. */
static double half_cells(const mps__world *w, const mps_neighbours *l)
{
    const mps__particles *s = &w->particles;
    const int dim = w->setup.dim;
    mps_exact sums[4] = {{{0}, 0, 0}}; /* of |A|, and of A */
    mps__terms t;
    double open[3] = {0};
    mps__terms_begin(&t, sums, 1 + dim);
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        if (s->kind[i] != MPS_WALL || !is_wet(w, l, i)) continue;
        const double *a = s->area + i * dim;
        double own[4] = {sqrt(mps__dot(a, a, dim))};
        memcpy(own + 1, a, (size_t)dim * sizeof *a);
        mps__terms_add(&t, own);
    }
    mps__terms_end(&t);
    mps__ranks_sum(w->ghosts.ranks, 1 + dim, sums);
    for (int d = 0; d < dim; d++) open[d] = mps_exact_value(&sums[1 + d]);
    return 0.5 * w->setup.dp * (mps_exact_value(&sums[0]) - sqrt(mps__dot(open, open, dim)));
}

/* Uses the lists of the last step, or new ones if they are invalid: after a checkpoint was read, or
 * particles were added or removed. */
static mps_status add_half_cells(const mps__world *w, double *volume)
{
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    const bool kept = l->valid && !l->torn && l->n == s->n && w->lists.listed == s->generation;
    if (kept) MPS__TRY(mps__world_fetch_lists(w));
    if (w->state.step == 0 || (kept && !w->collected.swapped)) {
        *volume += half_cells(w, l);
        return MPS_OK;
    }
    mps_neighbours own;
    mps_status status = mps__neighbours_init(&own, w->context, w->setup.dim, w->setup.dp);
    if (status == MPS_OK)
        status = mps__neighbours_search(&own, s->n, s->x, w->setup.re_near, w->setup.re_far);
    if (status == MPS_OK) *volume += half_cells(w, &own);
    mps__neighbours_free(&own);
    return status;
}

mps_status mps__energy_measure(mps__world *w, mps_energy *e)
{
    MPS__TRY(mps__world_adopt(w));
    bool any = w->particles.n > 0;
    mps__world_any(w, 1, &any);
    /* in the order of a step, so that an earlier measurement changes no later byte */
    if (w->state.step == 0 && any)
        MPS__TRY(mps__particles_leases(&w->particles) ? mps__world_neighbours_kept(w)
                                                      : mps__world_neighbours(w));
    mps__budget b = w->state.budget;
    MPS__TRY(mps__world_fetch(w));
    MPS__TRY(mps__budget_update(w, &b));
    *e = (mps_energy){.struct_size = sizeof *e,
                      .kinetic = b.last.kinetic,
                      .potential = b.last.potential,
                      .wall_work_momentum = b.wall_work_momentum,
                      .wall_work_probes = b.wall_work_probes,
                      .viscous = b.viscous,
                      .plugins = b.plugins,
                      .collision = b.collision,
                      .shift = b.shift,
                      .added = b.added,
                      .friction = b.friction,
                      .layers = b.layers,
                      .gas = b.gas};
    memcpy(e->momentum, b.last.momentum, sizeof e->momentum);
    bulk_sums(w, e);
    e->numerical = e->wall_work_momentum + e->gas + e->added - e->viscous - e->plugins -
                   e->collision - e->shift - e->friction -
                   (e->kinetic + e->potential + e->layers - b.start);
    e->volume /= 1.0 + b.deviation;
    e->volume_filled = e->volume;
    if (any) MPS__TRY(add_half_cells(w, &e->volume_filled));
    e->mass_filled = e->volume > 0 ? e->mass * e->volume_filled / e->volume : 0;
    e->volume_error = b.deviation_start - b.deviation;
    return mps__ranks_status(&w->ranks);
}

mps_status mps__momentum_measure(const mps__world *w, mps_momentum *m)
{
    mps__budget b = w->state.budget;
    MPS__TRY(mps__budget_update(w, &b));
    *m = b.momentum;
    m->struct_size = sizeof *m;
    memcpy(m->total, b.last.momentum, sizeof m->total);
    for (int d = 0; d < w->setup.dim; d++) m->numerical[d] = m->pressure[d] - m->walls[d];
    return MPS_OK;
}
