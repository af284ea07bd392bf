/* SPDX-License-Identifier: BSD-3-Clause */
/* Densities of the phases. */
#include "runner.h"
#include <math.h>
#include <string.h>

/* Another number if densities, kinds or phases have changed. */
static int64_t versions_of(const mps__particles *s)
{
    return s->field[MPS__FIELD_DENSITY].array.version + s->field[MPS__FIELD_KIND].array.version +
           s->field[MPS__FIELD_PHASE].array.version;
}

/* On the host also for steps on a device: no step changes densities, kinds or phases there. */
static void look(mps__densities *d, const mps__particles *s, const mps__ghosts *g)
{
    for (int m = 0; m < 2 * MPS__PHASES; m++) d->most[m] = -INFINITY;
    for (int64_t i = mps__own_from(g, 0); i < s->n; i = mps__own_from(g, i + 1)) {
        double *own = d->most + s->phase[i];
        if (s->kind[i] != MPS_FLUID) continue;
        own[0] = fmax(own[0], -s->rho[i]);
        own[MPS__PHASES] = fmax(own[MPS__PHASES], s->rho[i]);
    }
    d->versions = versions_of(s);
    d->generation = s->generation;
}

void mps__densities_find(mps__densities *d, const mps__particles *s, const mps__ghosts *g)
{
    double most[2 * MPS__PHASES];
    if (d->agreed) return;
    if (d->versions != versions_of(s) || d->generation != s->generation) look(d, s, g);
    memcpy(most, d->most, sizeof most);
    mps__ranks_max(g->ranks, 2 * MPS__PHASES, most);
    for (int p = 0; p < MPS__PHASES; p++) {
        const bool any = !isinf(most[p]);
        d->least[p] = any ? -most[p] : 0;
        d->greatest[p] = any ? most[MPS__PHASES + p] : 0;
    }
    d->agreed = true;
}

void mps_stage_densities(const mps_stage *s, double *least, double *greatest)
{
    mps__runner *h = s->host;
    mps__densities_find(&h->densities, h->particles, h->ghosts);
    if (least) memcpy(least, h->densities.least, sizeof h->densities.least);
    if (greatest) memcpy(greatest, h->densities.greatest, sizeof h->densities.greatest);
}
