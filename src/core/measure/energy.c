/* SPDX-License-Identifier: BSD-3-Clause */
/* Energies, mass, volume and momentum of the fluid, and the budgets of energy and momentum. */
#include "budget.h"
#include "probes.h"
#include <string.h>

static void bulk_sums(const mps__world *w, mps_energy *e)
{
    const mps__particles *s = &w->particles;
    const double volume = w->setup.dim == 2 ? w->setup.dp * w->setup.dp : w->setup.dp * w->setup.dp * w->setup.dp;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        double mass = s->rho[i] * volume;
        e->mass += mass;
        for (int32_t d = 0; d < w->setup.dim; d++) e->centre[d] += mass * s->x[i * w->setup.dim + d];
        count++;
    }
    e->volume = volume * (double)count;
    for (int32_t d = 0; d < w->setup.dim; d++)
        if (e->mass > 0) e->centre[d] /= e->mass;
}

mps_status mps__energy_measure(mps__world *w, mps_energy *e)
{
    mps__budget b = w->state.budget;
    mps__budget_update(w, &b);
    *e = (mps_energy){.struct_size = sizeof *e,
                      .kinetic = b.last.kinetic,
                      .potential = b.last.potential,
                      .wall_work = b.wall_work,
                      .viscous = b.viscous,
                      .collision = b.collision,
                      .shift = b.shift,
                      .added = b.added};
    memcpy(e->momentum, b.last.momentum, sizeof e->momentum);
    bulk_sums(w, e);
    e->numerical = e->wall_work + e->added - e->viscous - e->collision - e->shift - (e->kinetic + e->potential - b.start);
    e->volume /= 1.0 + b.deviation;
    e->volume_error = b.deviation_start - b.deviation;
    return MPS_OK;
}

void mps__momentum_measure(const mps__world *w, mps_momentum *m)
{
    mps__budget b = w->state.budget;
    mps__budget_update(w, &b);
    *m = b.momentum;
    m->struct_size = sizeof *m;
    memcpy(m->total, b.last.momentum, sizeof m->total);
    for (int d = 0; d < w->setup.dim; d++) m->numerical[d] = m->pressure[d] - m->walls[d];
}
