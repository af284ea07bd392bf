/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots: save and restore the state of a simulation in memory. If the store still has the same
 * particles in the same order, which holds until the next search, the existing arrays are
 * overwritten and the neighbour lists stay. Otherwise the store is refilled, and the next step
 * searches at the positions of the saved search, as after a checkpoint. */
#include "snapshot.h"
#include "plates.h"
#include "world_ranks.h"
#include <string.h>

static const char listed_field[] = "listed_at";

/* Number of fields of the particles, without a last one that only waits for the next search. */
static int32_t fields_of(const mps__particles *s)
{
    return s->fields - (strcmp(s->field[s->fields - 1].name, listed_field) == 0);
}

/* Positions of the last search if its candidates are valid, else NULL. */
static const double *searched_at(mps__world *w)
{
    mps__particles *s = &w->particles;
    if (w->lists.linked != s->solids || w->lists.listed != s->generation) return NULL;
    if (w->lists.listed_at) return w->lists.listed_at;
    const mps__field *f = mps__particles_field(s, listed_field);
    if (f) return *f->data;
    return w->lists.neighbours.valid ? w->lists.neighbours.searched : NULL;
}

/* ---- save ---- */

static mps_status reserve_field(mps__context *c, mps__copy *to, const mps__field *from, int64_t n)
{
    if (to->bytes != mps__field_element(from)) { /* other models added the fields */
        mps__free(c, to->data);
        to->data = NULL;
        to->capacity = 0;
        to->bytes = mps__field_element(from);
    }
    return mps__grow(c, (void **)&to->data, &to->capacity, 0, n, to->bytes);
}

/* Allocate all arrays. On failure the snapshot loses its contents. */
static mps_status reserve(mps_snapshot *k)
{
    mps__world *w = &k->sim->world;
    const mps__particles *s = &w->particles;
    mps__context *c = w->context;
    MPS__TRY(mps__kept_reserve(k));
    for (int32_t f = 0; f < fields_of(s); f++)
        MPS__TRY(reserve_field(c, &k->field[f], &s->field[f], s->n + 1));
    if (w->ghosts.ghost)
        MPS__TRY(mps__grow(c, (void **)&k->ghost, &k->ghost_capacity, 0, s->n + 1, 1));
    if (!searched_at(w)) return MPS_OK;
    return mps__grow(c, (void **)&k->searched, &k->searched_capacity, 0, s->n * s->dim + 1,
                     sizeof *k->searched);
}

static void take_particles(mps_snapshot *k)
{
    mps__world *w = &k->sim->world;
    const mps__particles *s = &w->particles;
    const mps_parallel *parallel = &w->pool.parallel;
    const double *searched = searched_at(w);
    k->fields = fields_of(s);
    for (int32_t f = 0; f < k->fields; f++) {
        memcpy(k->field[f].name, s->field[f].name, MPS__NAME_SIZE);
        mps__parallel_copy(parallel, k->field[f].data, *s->field[f].data,
                           (size_t)s->n * k->field[f].bytes);
    }
    k->known = w->ghosts.known;
    if (w->ghosts.ghost) memcpy(k->ghost, w->ghosts.ghost, (size_t)w->ghosts.known);
    k->n = s->n;
    k->next_id = s->next_id;
    k->written = s->written;
    k->linked = w->lists.linked == s->solids;
    k->listed = searched != NULL;
    if (searched)
        mps__parallel_copy(parallel, k->searched, searched,
                           (size_t)(s->n * s->dim) * sizeof *searched);
    k->generation = s->generation;
    k->orders = w->lists.orders;
}

static mps_status not_taken(mps_snapshot *k, const char *call)
{
    return mps__fail(&k->sim->context, MPS_E_STATE,
                     "%s(): the snapshot holds nothing: call mps_snapshot_take() first", call);
}

mps_status mps_snapshot_create(mps_sim *sim, mps_snapshot **snapshot)
{
    MPS__SETS(sim);
    MPS__CHECK(&sim->context, snapshot, "mps_snapshot_create(): snapshot is NULL");
    *snapshot = mps__alloc(&sim->context, 1, sizeof **snapshot);
    if (!*snapshot) return MPS_E_NOMEM;
    (*snapshot)->sim = sim;
    return MPS_OK;
}

mps_status mps_snapshot_take(mps_snapshot *snapshot)
{
    if (!snapshot) return MPS_E_ARG;
    mps_snapshot *k = snapshot;
    mps_sim *sim = k->sim;
    MPS__MEASURES(sim);
    mps__world *w = &sim->world;
    for (int32_t f = 0; f < w->particles.fields; f++)
        if (w->particles.field[f].writer)
            return mps__fail(w->context, MPS_E_BUSY, "field \"%s\" is leased for writing",
                             w->particles.field[f].name);
    MPS__TRY(mps__world_fetch(w));
    MPS__TRY(mps__world_fetch_searched(w));
    k->taken = false;
    MPS__TRY(mps__ranks_report(&w->ranks, reserve(k)));
    take_particles(k);
    mps__kept_take(k);
    k->state = w->state;
    k->now = w->motion.now;
    k->hold = w->motion.hold;
    k->has_posed = w->motion.posed != NULL;
    if (k->has_posed) k->posed = *w->motion.posed;
    k->info = w->info;
    k->load = w->load;
    k->body = w->body.state;
    k->geometry = sim->solids;
    k->occluders = w->lists.occluders.count;
    k->taken = true;
    return MPS_OK;
}

/* ---- restore ---- */

static mps_status changed(mps_snapshot *k, const char *what)
{
    return mps__fail(&k->sim->context, MPS_E_STATE,
                     "mps_snapshot_restore(): the %s changed since the snapshot was taken: take "
                     "another one",
                     what);
}

/* The layout of the snapshot must match the simulation. Settings, motions and probes may differ. */
static mps_status check_setup(mps_snapshot *k)
{
    const mps__world *w = &k->sim->world;
    const mps__particles *s = &w->particles;
    if (k->geometry != k->sim->solids || k->occluders != w->lists.occluders.count)
        return changed(k, "geometry");
    bool same = k->models == w->models.active;
    for (int32_t m = 0; same && m < k->models; m++) same = k->model[m] == w->models.on[m].ops;
    if (!same) return changed(k, "models");
    same = k->fields == fields_of(s);
    for (int32_t f = 0; same && f < k->fields; f++)
        same = strcmp(k->field[f].name, s->field[f].name) == 0 &&
               k->field[f].bytes == mps__field_element(&s->field[f]);
    return same ? MPS_OK : changed(k, "fields of the particles");
}

/* Temporary state of a restore: memory allocated in advance. */
typedef struct arrival {
    bool same, lists;  /* the store is unchanged; its neighbour lists too */
    double *listed_at; /* positions for repeating the search, or NULL */
    bool field;        /* on many ranks: the field that carries these positions was added */
} arrival;

/* What is unchanged since the snapshot, on all ranks. Candidates are valid for a search at the same
 * positions. */
static arrival compare(const mps_snapshot *k)
{
    mps__world *w = &k->sim->world;
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    const bool here = mps__world_fetch_searched(w) == MPS_OK;
    enum { STORE, LISTS, THINGS };
    bool other[THINGS];
    other[STORE] = k->n != s->n || k->generation != s->generation || k->orders != w->lists.orders ||
                   k->known != w->ghosts.known || w->lists.listed_at || fields_of(s) != s->fields;
    other[LISTS] = other[STORE] || !k->listed || !l->valid || !here ||
                   memcmp(k->searched, l->searched, (size_t)(k->n * s->dim) * sizeof(double)) != 0;
    mps__world_any(w, THINGS, other);
    return (arrival){.same = !other[STORE], .lists = !other[LISTS]};
}

static mps_status reserve_places(mps_snapshot *k, arrival *a)
{
    mps__world *w = &k->sim->world;
    mps__particles *s = &w->particles;
    if (!k->listed || a->lists) return MPS_OK;
    if (mps__ranks_many(&w->ranks)) {
        if (fields_of(s) != s->fields) return MPS_OK; /* it exists already */
        MPS__TRY(mps__particles_field_add(s, listed_field, s->dim, sizeof(double), false, NULL));
        s->field[s->fields - 1].trails = true;
        a->field = true;
        return MPS_OK;
    }
    a->listed_at = mps__alloc(w->context, k->n * s->dim + 1, sizeof *a->listed_at);
    return a->listed_at ? MPS_OK : MPS_E_NOMEM;
}

/* Everything that may fail. The values of the simulation do not change. */
static mps_status prepare(mps_snapshot *k, arrival *a)
{
    mps__world *w = &k->sim->world;
    mps__particles *s = &w->particles;
    MPS__TRY(mps__kept_return_reserve(k));
    if (k->n > s->n) MPS__TRY(mps__particles_reserve(s, k->n - s->n));
    MPS__TRY(reserve_places(k, a));
    if (a->same) return MPS_OK;
    if (!mps__scratch_take(w->context, s->scratch, 0, k->n, sizeof(int32_t))) return MPS_E_NOMEM;
    MPS__TRY(mps__particles_permute_reserve(s, k->n));
    return mps__ghosts_reset_reserve(&w->ghosts, k->n);
}

/* Copy the fields, including the positions of the search if they move with the particles. */
static void copy_fields(const mps_snapshot *k)
{
    mps__world *w = &k->sim->world;
    const mps__field *places = mps__particles_field(&w->particles, listed_field);
    if (places && k->listed)
        memcpy(*places->data, k->searched, (size_t)(k->n * w->setup.dim) * sizeof(double));
    for (int32_t f = 0; f < k->fields; f++)
        mps__parallel_copy(&w->pool.parallel, *w->particles.field[f].data, k->field[f].data,
                           (size_t)k->n * k->field[f].bytes);
}

static bool is_own(const mps_snapshot *k, int64_t i)
{
    return i >= k->known || mps__owns(k->ghost, i);
}

/* Refill the store with the owned particles of the snapshot, in their order. The next search adds
 * ghosts. The capacity is sufficient. */
static void fill_store(mps_snapshot *k)
{
    mps__world *w = &k->sim->world;
    mps__particles *s = &w->particles;
    s->n = k->n;
    s->generation++;
    s->solids++;
    copy_fields(k);
    if (mps__ranks_many(&w->ranks)) {
        int32_t *order = mps__scratch_take(w->context, s->scratch, 0, k->n, sizeof *order);
        int64_t own = 0, known = 0;
        for (int64_t i = 0; i < k->n; i++) {
            if (is_own(k, i)) order[own++] = (int32_t)i;
            if (i + 1 == k->known) known = own;
        }
        mps__particles_permute(s, own, order);
        mps__ghosts_reset(&w->ghosts, known);
    }
    w->lists.orders++; /* invalidates stored indices */
    mps__plates_set_active(w);
}

static void restore_particles(mps_snapshot *k, const arrival *a)
{
    mps__world *w = &k->sim->world;
    mps__particles *s = &w->particles;
    if (a->same)
        copy_fields(k);
    else
        fill_store(k);
    mps__memory_forget(&w->runner.memory);
    s->next_id = k->next_id;
    s->written = k->written;
    w->lists.linked = k->linked ? s->solids : -1;
    w->lists.listed = k->listed ? s->generation : -1;
    w->lists.neighbours.valid = a->lists;
    w->lists.aside = w->lists.gone = w->lists.lost = 0;
    mps__free(w->context, w->lists.listed_at);
    w->lists.listed_at = a->listed_at;
    if (a->listed_at)
        memcpy(a->listed_at, k->searched, (size_t)(k->n * s->dim) * sizeof *a->listed_at);
}

mps_status mps_snapshot_restore(mps_snapshot *snapshot)
{
    if (!snapshot) return MPS_E_ARG;
    mps_snapshot *k = snapshot;
    mps_sim *sim = k->sim;
    MPS__STEPS(sim); /* all fields are replaced, also those valid only on a device */
    mps__world *w = &sim->world;
    if (!k->taken) return not_taken(k, __func__);
    const int32_t open = mps__particles_leases(&w->particles);
    if (open)
        return mps__fail(w->context, MPS_E_BUSY,
                         "%d lease(s) are open; end them before restoring a snapshot", open);
    MPS__TRY(check_setup(k));
    arrival a = compare(k);
    const mps_status status = mps__ranks_agree(&w->ranks, prepare(k, &a));
    if (status < 0) {
        if (a.field) mps__particles_field_drop(&w->particles);
        mps__free(w->context, a.listed_at);
        return status;
    }
    restore_particles(k, &a);
    mps__kept_return(k);
    w->state = k->state;
    w->motion.now = k->now;
    w->motion.hold = k->hold;
    if (k->has_posed && w->motion.posed) *w->motion.posed = k->posed;
    w->info = k->info;
    const int32_t watch = w->load.watch;
    w->load = k->load;
    w->body.state = k->body;
    w->load.watch = watch;
    return MPS_OK;
}

void mps_snapshot_destroy(mps_snapshot *snapshot)
{
    if (!snapshot) return;
    mps__context *c = &snapshot->sim->context;
    mps__kept_free(snapshot);
    for (int32_t f = 0; f < MPS__FIELDS_MAX; f++) mps__free(c, snapshot->field[f].data);
    mps__free(c, snapshot->ghost);
    mps__free(c, snapshot->searched);
    mps__free(c, snapshot);
}
