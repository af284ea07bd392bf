/* SPDX-License-Identifier: BSD-3-Clause */
/* Fluid that models add and remove before a step, and its rollback if the step fails. */
#include "populate.h"
#include "collect.h"

#include "step.h"
#include "world_ranks.h"
#include <string.h>

/* The stage for verbs: particles without neighbours. */
static void open_stage(mps__world *w, mps_stage *s, mps_view *v)
{
    mps__world_view(w, v);
    v->dt = w->state.dt_before;
    *s = (mps_stage){.struct_size = sizeof *s, .step = w->state.step + 1};
}

/* Append the particles that verbs have added. */
static mps_status let_in(mps__world *w)
{
    const mps__runner *h = &w->runner;
    mps__particles *s = &w->particles;
    const size_t bytes = (size_t)s->dim * sizeof *s->x;
    if (h->entries == 0) return MPS_OK;
    MPS__TRY(mps__particles_reserve(s, h->entries));
    const int64_t first = mps__particles_append(s, h->entries, MPS_FLUID);
    for (int64_t k = 0; k < h->entries; k++) {
        const mps__entry *e = &h->entry[k];
        const int64_t i = first + k;
        memcpy(s->x + i * s->dim, e->x, bytes);
        memcpy(s->u + i * s->dim, e->u, bytes);
        s->phase[i] = e->phase;
        s->part[i] = -1;
        s->rho[i] = w->setup.phase_density[e->phase];
        mps__motion_to_tank(&w->motion, &w->motion.now, e->x, s->ref + i * s->dim);
    }
    return MPS_OK;
}

/* Remove marked particles, of those that existed before others were added. */
static mps_status let_out(mps__world *w, int64_t rows)
{
    const mps__runner *h = &w->runner;
    const mps__particles *s = &w->particles;
    int64_t count = 0;
    MPS__TRY(mps__world_reserve(w));
    memset(w->work.gone, 0, (size_t)s->n * sizeof *w->work.gone);
    for (int64_t i = mps__own_from(&w->ghosts, 0); h->leaving && i < rows;
         i = mps__own_from(&w->ghosts, i + 1)) {
        w->work.gone[i] = h->leaves[i] && s->kind[i] == MPS_FLUID;
        count += w->work.gone[i];
    }
    return mps__world_part(w, w->work.gone, count);
}

static mps_status apply(mps__world *w)
{
    const int64_t rows = w->particles.n;
    bool any[] = {w->runner.entries > 0, w->runner.leaving};
    mps__world_any(w, 2, any);
    if (any[0]) {
        w->lists.neighbours.valid = false;
        MPS__TRY(let_in(w));
        if (mps__world_divided(w)) MPS__TRY(mps__world_adopt(w));
    }
    return any[1] ? let_out(w, rows) : MPS_OK;
}

mps_status mps__world_populate(mps__world *w)
{
    mps_stage s;
    mps_view v;
    const int32_t *begin = w->runner.plan.begin;
    w->lists.aside = w->lists.gone = w->lists.lost = 0;
    w->lists.first_new = w->particles.next_id;
    if (begin[MPS_POPULATE] == begin[MPS_POPULATE + 1]) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    open_stage(w, &s, &v);
    mps__particles_written(&w->particles); /* verbs may write fields */
    w->next_flags.holds = false;
    w->runner.entries = 0;
    w->runner.leaving = false;
    MPS__TRY(mps__runner_run(&w->runner, &s, &v, MPS_POPULATE));
    return apply(w);
}

/* New particles are owned or ghosts: all of them are removed. */
void mps__world_depopulate(mps__world *w)
{
    mps__particles *s = &w->particles;
    int64_t kept = 0, fresh = 0;
    mps__world_take_back(w);
    if (w->lists.first_new == s->next_id) return;
    for (int64_t i = 0; i < s->n; i++) fresh += s->id[i] >= w->lists.first_new;
    int32_t *order = mps__scratch_take(w->context, &w->scratch, 0, s->n, sizeof *order);
    if (!order) return; /* out of memory: they stay for the next step */
    int64_t last = s->n - fresh;
    for (int64_t i = 0; i < s->n; i++)
        order[s->id[i] >= w->lists.first_new ? last++ : kept++] = (int32_t)i;
    if (mps__ghosts_ordered(&w->ghosts, order) < 0 || mps__particles_permute(s, s->n, order) < 0)
        return;
    s->n = kept;
    s->generation++;
    s->next_id = w->lists.first_new;
    w->ghosts.known = w->ghosts.known > kept ? kept : w->ghosts.known;
    w->lists.neighbours.valid = false;
}

/* ---- functions for verbs ---- */

static int refuse_hook(mps_stage *s, const char *call)
{
    return mps_stage_fail(s, "%s() was called in hook '%s': call it in 'populate'", call,
                          mps__hook_name(s->hook));
}

int mps_stage_add(mps_stage *s, int32_t phase, int64_t count, const double *x, const double *u)
{
    mps__runner *h = s->host;
    const int32_t dim = s->view->dim;
    if (s->hook != MPS_POPULATE) return refuse_hook(s, "mps_stage_add");
    if (phase < 0 || phase >= MPS__PHASES || !h->phase_defined[phase])
        return mps_stage_fail(s, "mps_stage_add(): phase %d is not defined", (int)phase);
    if (count < 0 || (count > 0 && !(x && u)))
        return mps_stage_fail(s, "mps_stage_add(): count is %lld, or x or u is NULL",
                              (long long)count);
    if (!mps__finite(x, count * dim) || !mps__finite(u, count * dim))
        return mps_stage_fail(s, "mps_stage_add(): a position or velocity is not finite");
    if (mps__grow(h->context, (void **)&h->entry, &h->entry_capacity, h->entries,
                  h->entries + count, sizeof *h->entry) < 0) {
        h->no_memory = true;
        return 1;
    }
    for (int64_t k = 0; k < count; k++) {
        mps__entry *e = &h->entry[h->entries++];
        *e = (mps__entry){.phase = phase};
        memcpy(e->x, x + k * dim, (size_t)dim * sizeof *x);
        memcpy(e->u, u + k * dim, (size_t)dim * sizeof *u);
    }
    return 0;
}

int mps_stage_remove(mps_stage *s, const int32_t *leaves)
{
    mps__runner *h = s->host;
    const int64_t n = s->view->n;
    if (s->hook != MPS_POPULATE) return refuse_hook(s, "mps_stage_remove");
    if (!leaves) return mps_stage_fail(s, "mps_stage_remove(): leaves is NULL");
    /* an earlier call in this step may have set marks, which are kept: the capacity suffices
     * then */
    if (n > h->leaves_capacity && mps__grow(h->context, (void **)&h->leaves, &h->leaves_capacity, 0,
                                            mps__capacity_for(n, h->leaves_capacity), 1) < 0) {
        h->no_memory = true;
        return 1;
    }
    for (int64_t i = 0; i < n; i++) {
        h->leaves[i] = (h->leaving && h->leaves[i]) || leaves[i] != 0;
    }
    h->leaving = true;
    return 0;
}
