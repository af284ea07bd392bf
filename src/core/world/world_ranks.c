/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on many ranks. Space is partitioned in the frame of the tank, so that the partition
 * moves with it. */
#include "world_ranks.h"
#include <string.h>

/* Ghosts must not be lost to rounding of positions in the tank's frame. */
static const double margin = 1e-9;

/* Owners of positions of the pressure equation, which are relative to the displacement of the
 * tank. */
static mps_status find_owners(void *world, int64_t m, const double *x, int32_t *rank)
{
    mps__world *w = world;
    for (int64_t k = 0; k < m && !w->ranks.failed; k++) {
        double at[3] = {0}, X[3];
        for (int32_t d = 0; d < w->setup.dim; d++)
            at[d] = x[k * w->setup.dim + d] + w->ppe.moved[d];
        mps__motion_to_tank(&w->motion, &w->motion.now, at, X);
        w->ranks.failed = w->ranks.ops.owner(w->ranks.self, 1, X, rank + k) != 0;
    }
    return mps__ranks_status(&w->ranks);
}

mps_status mps__world_ranks_set(mps__world *w, const mps_ranks_ops *ops)
{
    mps__particles *s = &w->particles;
    MPS__TRY(mps__ranks_set(&w->ranks, ops));
    if (!mps__ranks_many(&w->ranks)) return MPS_OK;
    w->ppe.ghosts = &w->ghosts;
    w->ppe.owner = find_owners;
    w->ppe.world = w;
    w->balance.cost = 1;
    return mps__particles_field_add(s, "wall_id", 1, sizeof *s->wall_id, false,
                                    (void **)&s->wall_id);
}

static void place_of(const void *world, int64_t i, double *X)
{
    const mps__world *w = world;
    const mps__particles *s = &w->particles;
    if (s->kind[i] == MPS_FLUID)
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * s->dim, X);
    else
        memcpy(X, s->ref + i * s->dim, (size_t)s->dim * sizeof *X);
}

/* Reach of the ghosts. Walls of dummies that are ghosts are ghosts too: their distance is at most
 * that of the rows. */
static mps__placing placing(const mps__world *w)
{
    const double skin = w->lists.neighbours.skin, far = w->setup.re_far + skin,
                 rows = mps__models_neighbour_rows(&w->models) ? far + w->setup.re_near : far,
                 solver = w->solvers.pc ? w->solvers.pc->reach * w->setup.dp + skin : 0,
                 reach = fmax(rows,
                              fmax(solver, mps__models_reach(&w->models, w->setup.dp) + skin));
    return (mps__placing){place_of, mps__world_weight, w, reach * (1 + margin),
                          (reach + far) * (1 + margin)};
}

bool mps__world_wants_ghosts(const mps__world *w)
{
    return mps__ranks_many(w->ghosts.ranks) &&
           (placing(w).reach > w->ghosts.reach ||
            mps__models_neighbour_rows(&w->models) != w->lists.neighbours.ghost_rows);
}

mps_status mps__world_adopt(mps__world *w)
{
    const mps__placing p = placing(w);
    return mps__ghosts_adopt(&w->ghosts, &p);
}

void mps__world_any(mps__world *w, int32_t count, bool *things)
{
    double value[MPS__PHASES];
    if (!mps__ranks_many(&w->ranks)) return;
    for (int32_t k = 0; k < count; k++) value[k] = things[k];
    mps__ranks_max(&w->ranks, count, value);
    for (int32_t k = 0; k < count; k++) things[k] = value[k] > 0;
}

static void found_by_both(void *into, const void *from)
{
    mps__found *a = into;
    const mps__found *b = from;
    const int64_t count = a->count + b->count;
    if (b->id < a->id) *a = *b;
    a->count = count;
}

void mps__world_find(mps__world *w, mps__found *found)
{
    mps__ranks_reduce(&w->ranks, 1, sizeof *found, found, found_by_both);
}

/* ---- walls of dummies: indices change with each order, ids do not ---- */

static uint64_t slot_of(int64_t id, uint64_t size)
{
    return ((uint64_t)id * UINT64_C(0x9e3779b97f4a7c15) >> 20) & (size - 1);
}

/* Indices of dummies' walls from their ids, by a hash table of the walls. */
mps_status mps__world_find_walls(mps__world *w)
{
    mps__particles *s = &w->particles;
    uint64_t size = 16, at;
    int64_t walls = 0;
    for (int64_t i = 0; i < s->n; i++) walls += s->kind[i] == MPS_WALL;
    while (size < 2 * (uint64_t)walls) size *= 2;
    int32_t *table = mps__scratch_take(w->context, &w->scratch, 3, (int64_t)size, sizeof *table);
    if (!table) return MPS_E_NOMEM;
    for (uint64_t k = 0; k < size; k++) table[k] = -1;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL) continue;
        for (at = slot_of(s->id[i], size); table[at] >= 0;) at = (at + 1) & (size - 1);
        table[at] = (int32_t)i;
    }
    for (int64_t i = 0; i < s->n; i++) {
        s->wall_of[i] = -1;
        if (s->kind[i] != MPS_DUMMY || s->wall_id[i] < 0) continue;
        for (at = slot_of(s->wall_id[i], size); table[at] >= 0; at = (at + 1) & (size - 1))
            if (s->id[table[at]] == s->wall_id[i]) {
                s->wall_of[i] = table[at];
                break;
            }
    }
    return MPS_OK;
}

mps_status mps__world_link_ghosts(mps__world *w)
{
    mps__particles *s = &w->particles;
    if (!mps__ranks_many(&w->ranks)) return MPS_OK;
    for (int64_t i = 0; i < s->n; i++)
        s->wall_id[i] = s->kind[i] == MPS_DUMMY && s->wall_of[i] >= 0 ? s->id[s->wall_of[i]] : -1;
    MPS__TRY(mps__ghosts_exchange(
        &w->ghosts, &(mps__halo_array){.values = s->wall_id, .bytes = sizeof *s->wall_id}, 1));
    return mps__world_find_walls(w);
}

/* ---- halo exchange and migration ---- */

mps_status mps__world_exchange_areas(mps__world *w)
{
    mps__particles *s = &w->particles;
    return mps__ghosts_exchange(
        &w->ghosts,
        &(mps__halo_array){.values = s->area, .bytes = (size_t)s->dim * sizeof *s->area}, 1);
}

mps_status mps__world_exchange_step(mps__world *w)
{
    mps__particles *s = &w->particles;
    mps__memory *t = &w->runner.memory;
    const mps__array *load = mps__channels_of(&w->channels, s, MPS__WALL_PRESSURE);
    mps__halo_array shared[1 + MPS__FIELDS_MAX];
    int32_t count = 0;
    if (!mps__ranks_many(&w->ranks)) return MPS_OK;
    if (!mps__array_ghosts_valid(load)) shared[count++] = mps__memory_halo(t, MPS__WALL_PRESSURE);
    for (int32_t k = 0; k < s->fields; k++)
        if (!mps__array_ghosts_valid(&s->field[k].array))
            shared[count++] = mps__memory_halo_field(t, k);
    return mps__ghosts_exchange_at(&w->ghosts, &t->device, shared, count);
}

mps_status mps__world_exchange_written(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__halo_array shared[MPS__FIELDS_MAX];
    int32_t count = 0;
    if (!mps__ranks_many(&w->ranks)) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].is_public) shared[count++] = mps__memory_halo_field(&w->runner.memory, k);
    return mps__ghosts_exchange(&w->ghosts, shared, count);
}

mps_status mps__world_divide(mps__world *w)
{
    mps__particles *s = &w->particles;
    mps_neighbours *l = &w->lists.neighbours;
    const mps__placing p = placing(w);
    const int32_t *on_device;
    if (mps__ranks_many(&w->ranks)) {
        MPS__TRY(mps__world_fetch(w)); /* particles migrate between hosts */
        mps__memory_forget(&w->runner.memory);
    }
    MPS__TRY(mps__ghosts_renew(&w->ghosts, &p, w->lists.aside));
    mps__runner_all_alike(&w->runner);
    MPS__TRY(mps__world_order(w, &on_device));
    MPS__TRY(mps__ghosts_ordered(&w->ghosts, l->order));
    MPS__TRY(mps__particles_permute_reserve(s, s->n));
    bool moved[MPS__FIELDS_MAX], stale[MPS__FIELDS_MAX];
    MPS__TRY(mps__memory_permute(&w->runner.memory, l->order, on_device, moved, stale));
    MPS__TRY(mps__particles_reorder(s, s->n, l->order, stale));
    mps__memory_permuted(&w->runner.memory, moved);
    l->ghost = w->ghosts.ghost;
    w->lists.orders++;
    return mps__ranks_many(&w->ranks) ? mps__world_find_walls(w) : MPS_OK;
}

/* ---- after a checkpoint ---- */

static const char listed_field[] = "listed_at";

mps_status mps__world_replace(mps__world *w, int64_t n, const void *const from[], bool listed)
{
    mps__particles *s = &w->particles;
    const void *all[MPS__FIELDS_MAX] = {NULL};
    memcpy(all, from, (size_t)s->fields * sizeof *all);
    const bool travels = mps__ranks_many(&w->ranks) && listed;
    if (travels) {
        MPS__TRY(mps__particles_field_add(s, listed_field, s->dim, sizeof(double), false, NULL));
        s->field[s->fields - 1].trails = true;
    }
    const mps_status status = mps__particles_replace(s, n, all);
    if (status == MPS_OK) mps__memory_forget(&w->runner.memory);
    if (status < 0 && travels) mps__particles_field_drop(s);
    if (status < 0 || !mps__ranks_many(&w->ranks)) return status;
    for (int64_t i = 0; i < n; i++) s->wall_id[i] = s->wall_of[i] >= 0 ? s->id[s->wall_of[i]] : -1;
    return status;
}

void mps__world_keep_listed(mps__world *w)
{
    mps__particles *s = &w->particles;
    const mps__field *f = mps__particles_field(s, listed_field);
    if (!f || !w->lists.listed_at) return;
    memcpy(*f->data, w->lists.listed_at, (size_t)(s->n * s->dim) * sizeof *s->x);
    mps__free(w->context, w->lists.listed_at);
    w->lists.listed_at = NULL;
}

static void exchange_places(mps__particles *s, double *other)
{
    for (int64_t k = 0; k < s->n * s->dim; k++) {
        const double x = s->x[k];
        s->x[k] = other[k];
        other[k] = x;
    }
}

mps_status mps__world_list_again(mps__world *w, mps_status (*search)(mps__world *w))
{
    mps__particles *s = &w->particles;
    if (w->lists.listed_at && !mps__particles_field(s, listed_field)) {
        MPS__TRY(mps__particles_field_add(s, listed_field, s->dim, sizeof(double), false, NULL));
        s->field[s->fields - 1].trails = true;
    }
    mps__world_keep_listed(w);
    const mps__field *f = mps__particles_field(s, listed_field);
    if (!f) return MPS_OK;
    mps_status status = mps__world_fetch(w); /* before positions are exchanged */
    if (status == MPS_OK && w->lists.linked == s->solids && w->lists.listed == s->generation) {
        const bool recut = w->ghosts.recut;
        w->ghosts.recut = false; /* the partition is for the present positions */
        exchange_places(s, *f->data);
        status = mps__world_divide(w);
        if (status == MPS_OK) status = search(w);
        exchange_places(s, *f->data);
        w->ghosts.recut = recut;
        w->lists.neighbours.valid = status == MPS_OK;
    }
    mps__particles_field_drop(s);
    return status;
}
