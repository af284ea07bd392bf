/* SPDX-License-Identifier: BSD-3-Clause */
/* Collecting particles: the arrays of the store are replaced by larger ones, which all ranks fill,
 * and restored afterwards. */
#include "collect.h"
#include <string.h>

/* ---- stores ---- */

/* Replace the store by an empty one with capacity for n particles. */
static mps_status swap_out(mps__world *w, int64_t n)
{
    mps__particles *s = &w->particles;
    mps__collected *g = &w->collected;
    void *fresh[MPS__FIELDS_MAX];
    for (int32_t k = 0; k < s->fields; k++) {
        fresh[k] = mps__alloc(w->context, n, mps__field_element(&s->field[k]));
        if (fresh[k]) continue;
        while (k-- > 0) mps__free(w->context, fresh[k]);
        return MPS_E_NOMEM;
    }
    for (int32_t k = 0; k < s->fields; k++) {
        g->array[k] = *s->field[k].data;
        *s->field[k].data = fresh[k];
    }
    g->n = s->n;
    g->capacity = s->capacity;
    g->swapped = true;
    s->n = 0;
    s->capacity = n;
    return MPS_OK;
}

void mps__collect_end(mps__world *w)
{
    mps__particles *s = &w->particles;
    mps__collected *g = &w->collected;
    for (int32_t k = 0; k < s->fields && g->swapped; k++) {
        mps__free(w->context, *s->field[k].data);
        *s->field[k].data = g->array[k];
    }
    if (g->swapped) {
        s->n = g->n;
        s->capacity = g->capacity;
        w->ghosts.ghost = g->ghost;
    }
    mps__free(w->context, g->listed);
    if (g->listed) w->lists.listed_at = NULL;
    *g = (mps__collected){0};
}

/* ---- messages ---- */

/* Packets of the owned particles, or of the solids among them; the position of the last search
 * follows the fields. */
static int64_t pack_own(const mps__world *w, bool solids, size_t bytes, char *out)
{
    const mps__particles *s = &w->particles;
    const size_t place = (size_t)s->dim * sizeof *s->x;
    const double *searched = w->lists.neighbours.valid ? w->lists.neighbours.searched : s->x;
    int64_t count = 0;
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        if (solids && s->kind[i] == MPS_FLUID) continue;
        if (out) {
            mps__ghosts_pack(s, i, out + (size_t)count * bytes);
            memcpy(out + (size_t)(count + 1) * bytes - place, searched + i * s->dim, place);
        }
        count++;
    }
    return count;
}

/* Make a store from packets; `listed` gets the positions of the last search. */
static mps_status unpack_all(mps__world *w, int64_t n, size_t bytes, const char *in, double *listed)
{
    mps__particles *s = &w->particles;
    const size_t place = (size_t)s->dim * sizeof *s->x;
    MPS__TRY(swap_out(w, n));
    w->collected.ghost = w->ghosts.ghost;
    w->ghosts.ghost = NULL;
    for (int64_t i = 0; i < n; i++) {
        mps__ghosts_unpack(s, i, in + (size_t)i * bytes);
        memcpy(listed + i * s->dim, in + (size_t)(i + 1) * bytes - place, place);
    }
    s->n = n;
    return MPS_OK;
}

/* Order by the cells of the last search and ids, as on a single rank; or by ids alone. */
static mps_status order_all(mps__world *w, bool by_id, double *listed)
{
    mps__particles *s = &w->particles;
    mps_neighbours *l = &w->lists.complete;
    const int64_t generation = s->generation, solids = s->solids;
    if (by_id) {
        l->key = mps__scratch_take(w->context, &w->scratch, 0, 2 * s->n, sizeof *l->key);
        l->order = mps__scratch_take(w->context, &w->scratch, 1, 2 * s->n, sizeof *l->order);
        if (!l->key || !l->order) return MPS_E_NOMEM;
        for (int64_t i = 0; i < s->n; i++) {
            l->key[i] = (uint64_t)s->id[i];
            l->order[i] = (int32_t)i;
        }
        mps__sort_keys(l->key, l->order, s->n);
    } else {
        l->skin = w->lists.neighbours.skin;
        const mps_status status = mps__neighbours_order(l, s->n, listed, s->id, w->setup.re_far);
        l->skin = 0;
        MPS__TRY(status);
    }
    double *sorted = mps__scratch_take(w->context, &w->scratch, 3, s->n * s->dim, sizeof *sorted);
    if (!sorted) return MPS_E_NOMEM;
    const size_t place = (size_t)s->dim * sizeof *sorted;
    for (int64_t i = 0; i < s->n; i++)
        memcpy(sorted + i * s->dim, listed + (int64_t)l->order[i] * s->dim, place);
    memcpy(listed, sorted, (size_t)s->n * place);
    MPS__TRY(mps__particles_permute(s, s->n, l->order));
    s->generation = generation;
    s->solids = solids;
    return mps__world_find_walls(w);
}

/* Collect the blocks of all ranks: on rank 0, or on all. `in`: out, newly allocated. */
static mps_status collect(mps__world *w, bool everywhere, int64_t own, size_t bytes,
                          const char *out, char **in, int64_t *all)
{
    mps__ranks *r = &w->ranks;
    int64_t *count = mps__alloc(w->context, r->count, sizeof *count);
    if (!count) return MPS_E_NOMEM;
    mps__ranks_gather_number(r, own, count);
    *all = 0;
    for (int32_t k = 0; k < r->count; k++) *all += count[k];
    const bool here = everywhere || r->rank == 0;
    *in = here ? mps__alloc(w->context, *all, bytes) : NULL;
    mps_status status = here && !*in ? MPS_E_NOMEM : mps__ranks_status(r);
    for (int32_t k = 0; k < r->count; k++) count[k] *= (int64_t)bytes;
    if (status == MPS_OK && everywhere)
        mps__ranks_gather(r, out, count, *in);
    else if (status == MPS_OK)
        mps__ranks_send_to_first(r, out, count, *in);
    mps__free(w->context, count);
    return status == MPS_OK ? mps__ranks_status(r) : status;
}

static mps_status gather(mps__world *w, bool solids)
{
    const mps__particles *s = &w->particles;
    const size_t bytes = mps__ghosts_packet(s) + (size_t)s->dim * sizeof *s->x;
    MPS__TRY(mps__world_fetch(w));
    MPS__TRY(mps__world_fetch_searched(w));
    const int64_t own = pack_own(w, solids, bytes, NULL);
    char *out = mps__alloc(w->context, own, bytes), *in = NULL;
    int64_t all = 0;
    if (!out) return MPS_E_NOMEM;
    pack_own(w, solids, bytes, out);
    mps_status status = collect(w, solids, own, bytes, out, &in, &all);
    mps__free(w->context, out);
    if (status == MPS_OK && in) {
        w->collected.listed = mps__alloc(w->context, all * s->dim, sizeof(double));
        status = w->collected.listed ? unpack_all(w, all, bytes, in, w->collected.listed)
                                     : MPS_E_NOMEM;
        if (status == MPS_OK) status = order_all(w, solids, w->collected.listed);
        if (status == MPS_OK) w->lists.listed_at = w->collected.listed;
    } else if (status == MPS_OK) /* rank 0 has all */
        status = unpack_all(w, 0, bytes, NULL, NULL);
    mps__free(w->context, in);
    if (status < 0) mps__collect_end(w);
    return status;
}

mps_status mps__collect_all(mps__world *w)
{
    return mps__world_divided(w) ? gather(w, false) : MPS_OK;
}

mps_status mps__collect_solids(mps__world *w)
{
    return mps__world_divided(w) ? gather(w, true) : MPS_OK;
}
