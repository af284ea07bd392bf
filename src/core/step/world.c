/* SPDX-License-Identifier: BSD-3-Clause */
/* What a step stands on: domain, lost particles, sorted particles, neighbour lists, dummies and their walls. */
#include "plates.h"
#include "world_ranks.h"
#include <string.h>

mps_status mps__world_init(mps__world *w, mps__context *context, int32_t dim, double dp)
{
    w->context = context;
    w->setup.dim = dim;
    w->setup.dp = dp;
    w->threads = 1;
    mps__pool_init(&w->pool, context);
    w->lists.linked = -1;
    for (int k = 0; k < MPS__PHASES * MPS__PHASES; k++) w->setup.tension[k] = -1.0;
    mps__neighbours_init(&w->lists.neighbours, context, dim, dp);
    mps__neighbours_init(&w->lists.complete, context, dim, dp);
    w->lists.complete.skin = 0; /* searched at each request */
    mps__screens_init(&w->lists.screens, context, dim);
    w->lists.neighbours.screens = w->lists.complete.screens = &w->lists.screens;
    mps__ppe_init(&w->ppe, context);
    mps__bounds_init(&w->bounds, context);
    w->state.jump.since = INT32_MAX;
    mps__motion_init(&w->motion, context, dim);
    MPS__TRY(mps__particles_init(&w->particles, context, dim));
    w->lists.neighbours.parallel = w->lists.complete.parallel = w->particles
                                                                    .parallel = &w->pool.parallel;
    w->lists.neighbours.shared = w->lists.complete
                                     .shared = w->ppe.scratch = w->particles.scratch = &w->scratch;
    mps__channels_init(&w->channels, context, dim);
    w->host = (mps__host){.context = context,
                          .models = &w->models,
                          .channels = &w->channels,
                          .particles = &w->particles,
                          .scratch = &w->scratch,
                          .parallel = &w->pool.parallel,
                          .ghosts = &w->ghosts,
                          .sets = {.context = context}};
    mps__plan_init(&w->host.plan);
    mps__ranks_init(&w->ranks, context);
    mps__ghosts_init(&w->ghosts, context, &w->ranks, &w->particles);
    MPS__TRY(mps__models_init(&w->models, context, &w->channels, &w->particles));
    return mps__solvers_init(&w->solvers, context);
}

void mps__world_free(mps__world *w)
{
    mps__particles_free(&w->particles);
    mps__neighbours_free(&w->lists.neighbours);
    mps__neighbours_free(&w->lists.complete);
    mps__screens_free(&w->lists.screens);
    mps__models_free(&w->models);
    mps__solvers_free(&w->solvers);
    mps__ppe_free(&w->ppe);
    mps__bounds_free(&w->bounds);
    mps__motion_free(&w->motion);
    mps__channels_free(&w->channels);
    mps__work *k = &w->work;
    void *all[] = {k->gone,
                   k->tank_acceleration,
                   k->volume_deviation,
                   k->asymmetry,
                   k->pressure_density,
                   k->turned,
                   k->motion,
                   k->value,
                   k->condition};
    for (size_t a = 0; a < sizeof all / sizeof all[0]; a++) mps__free(w->context, all[a]);
    mps__free(w->context, w->lists.listed_at);
    mps__scratch_free(w->context, &w->scratch);
    mps__pool_free(&w->pool);
    mps__sets_free(&w->host.sets);
    mps__ghosts_free(&w->ghosts);
    mps__ranks_free(&w->ranks);
}

static void speed_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const mps__world *w = argument;
    double most = values[0];
    for (int64_t i = begin; i < end; i++) {
        const double *u = w->particles.u + i * w->setup.dim, square = mps__dot(u, u, w->setup.dim);
        if (mps__is_ghost(&w->ghosts, i)) continue;
        most = square > most ? square : most; /* a NaN does not count */
    }
    values[0] = most;
}

double mps__world_speed(mps__world *w)
{
    double most = 0;
    mps_parallel_max(&w->pool.parallel, w->particles.n, 1, speed_rows, w, &most);
    mps__ranks_max(&w->ranks, 1, &most);
    return sqrt(most);
}

void mps__world_note_layers(mps__world *w, int32_t layers)
{
    if (w->setup.layers == 0 || layers < w->setup.layers) w->setup.layers = layers;
}

void mps__world_note_phases(mps__world *w)
{
    bool any[MPS__PHASES] = {false};
    for (int64_t i = 0; i < w->particles.n; i++)
        if (w->particles.kind[i] == MPS_FLUID) any[w->particles.phase[i]] = true;
    mps__world_any(w, MPS__PHASES, any);
    /* phase 0 always exists, also if the user does not define it */
    for (int p = 1; p < MPS__PHASES; p++)
        if (w->setup.phase_defined[p] && !any[p])
            mps__log(w->context, MPS_LOG_WARNING,
                     "phase %d is defined, but no fluid particle is of it", p);
}

/* Box of the solids: upper corner, negative of the lower one; infinite without any. */
static void box_of_solids(const mps__world *w, double corner[6])
{
    const mps__particles *s = &w->particles;
    for (int d = 0; d < 6; d++) corner[d] = -INFINITY;
    for (int64_t i = 0; i < s->n; i++)
        for (int d = 0; s->kind[i] != MPS_FLUID && d < s->dim; d++) {
            corner[d] = fmax(corner[d], s->ref[i * s->dim + d]);
            corner[3 + d] = fmax(corner[3 + d], -s->ref[i * s->dim + d]);
        }
}

bool mps__world_domain(mps__world *w, double lo[3], double hi[3])
{
    double corner[6], size = 0;
    if (w->setup.domain_given) {
        memcpy(lo, w->setup.domain_min, 3 * sizeof *lo);
        memcpy(hi, w->setup.domain_max, 3 * sizeof *hi);
        return true;
    }
    box_of_solids(w, corner);
    mps__ranks_max(&w->ranks, 6, corner);
    if (isinf(corner[0])) return false;
    for (int d = 0; d < w->setup.dim; d++) size = fmax(size, corner[d] + corner[3 + d]);
    for (int d = 0; d < w->setup.dim; d++) {
        lo[d] = -corner[3 + d] - size;
        hi[d] = corner[d] + size;
    }
    return true;
}

static mps_status reserve_work(mps__world *w)
{
    mps__work *k = &w->work;
    const int64_t n = w->particles.n, dim = w->setup.dim;
    MPS__TRY(mps__channels_reserve(&w->channels, n));
    if (n <= k->capacity) return MPS_OK;
    const int64_t wanted = mps__room(n, k->capacity);
    struct {
        void **place;
        int64_t count;
        size_t size;
    } a[] = {{(void **)&k->condition, wanted, sizeof(int32_t)},
             {(void **)&k->gone, wanted, sizeof(bool)},
             {(void **)&k->volume_deviation, wanted, sizeof(double)},
             {(void **)&k->asymmetry, wanted * dim, sizeof(double)},
             {(void **)&k->pressure_density, wanted, sizeof(double)},
             {(void **)&k->tank_acceleration, wanted * dim, sizeof(double)},
             {(void **)&k->motion, wanted * dim, sizeof(double)},
             {(void **)&k->value, wanted * 5, sizeof(double)}};
    k->capacity = 0; /* nothing in here outlives a step */
    for (size_t i = 0; i < sizeof a / sizeof a[0]; i++) {
        mps__free(w->context, *a[i].place);
        *a[i].place = mps__alloc(w->context, a[i].count, a[i].size);
        if (!*a[i].place) return MPS_E_NOMEM;
    }
    double **const terms[] = {&k->source, &k->shift, &k->gas, &k->law};
    for (int i = 0; i < 4; i++) *terms[i] = k->value + (i + 1) * wanted;
    k->load = k->source;
    k->x0 = k->shift;
    w->ppe.spare = k->shift;
    w->ppe.spare_x = k->motion;
    k->capacity = wanted;
    return MPS_OK;
}

/* What is done once when particles came or went: dummies find their walls, walls their areas, and solids the number density that they
 * keep as long as no fluid is about. All candidates are there. */
static mps_status link_solids(mps__world *w)
{
    mps_stencil near;
    MPS__TRY(mps__world_link_walls(w));
    MPS__TRY(mps__plates_find(w));
    mps__neighbours_hide(&w->lists.neighbours);
    MPS__TRY(mps__world_stencil(w, MPS_NEAR, &near));
    MPS__TRY(mps_op_number_density(&near, w->particles.nd));
    mps__host_written(&w->host, MPS__NUMBER_DENSITY);
    w->lists.linked = w->particles.generation;
    w->lists.links++;
    return MPS_OK;
}

/* Lists of the particles in the order they have, which is that of the cells if they are `sorted`. */
static mps_status search_lists(mps__world *w, bool sorted, bool all)
{
    mps__particles *s = &w->particles;
    if (sorted) mps__neighbours_sorted(&w->lists.neighbours, s->n);
    w->lists.neighbours.kind = all ? NULL : s->kind;
    w->lists.neighbours.dummy_rows = mps__models_dummy_rows(&w->models);
    w->lists.neighbours.ghost_rows = mps__models_neighbour_rows(&w->models);
    return mps__neighbours_search(&w->lists.neighbours, s->n, s->x, w->setup.re_near,
                                  w->setup.re_far);
}

/* New lists, with exact rows. */
static mps_status search(mps__world *w, bool sorted)
{
    mps_status status = MPS_OK;
    if (w->lists.linked != w->particles.generation) {
        MPS__TRY(search_lists(w, sorted, true));
        status = link_solids(w);
    }
    if (status == MPS_OK) status = search_lists(w, sorted, false);
    if (status == MPS_OK) status = mps__plates_find(w);
    if (status == MPS_OK) mps__neighbours_hide(&w->lists.neighbours);
    if (status < 0) w->lists.neighbours.valid = false;
    return status;
}

/* Whether the candidates of the last search still hold, but models or the solver want others: rows of dummies or none, more ghosts. */
static bool wants_other_lists(const mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    return l->valid && w->lists.linked == w->particles.generation &&
           (l->dummy_rows != mps__models_dummy_rows(&w->models) || mps__world_wants_ghosts(w));
}

static mps_status note_models(mps__world *w)
{
    const mps__particles *s = &w->particles;
    if (!wants_other_lists(w)) return MPS_OK;
    w->lists.listed_at = mps__alloc(w->context, s->n * s->dim, sizeof(double));
    if (!w->lists.listed_at) return MPS_E_NOMEM;
    mps__parallel_copy(&w->pool.parallel, w->lists.listed_at, w->lists.neighbours.searched,
                       s->n * s->dim);
    return MPS_OK;
}

/* Lists at the places that the store has for now. */
static mps_status search_listed(mps__world *w)
{
    MPS__TRY(search_lists(w, true, false));
    return mps__plates_find(w);
}

/* The candidates of a search that was done before a checkpoint or for other models, unless particles came or went since: the store has
 * its order already. */
static mps_status list_again(mps__world *w)
{
    mps__particles *s = &w->particles;
    double *const now = s->x;
    if (!w->lists.listed_at) MPS__TRY(note_models(w));
    if (mps__ranks_many(&w->ranks)) return mps__world_list_again(w, search_listed);
    if (!w->lists.listed_at) return MPS_OK;
    if (w->lists.linked == s->generation) {
        s->x = w->lists.listed_at;
        mps_status status = search_lists(w, false, false);
        if (status == MPS_OK) status = mps__plates_find(w);
        s->x = now;
        w->lists.neighbours.valid = status == MPS_OK;
        MPS__TRY(status);
    }
    mps__free(w->context, w->lists.listed_at);
    w->lists.listed_at = NULL;
    return MPS_OK;
}

/* Sort the store along the cells and search anew, where needed. */
static mps_status renew(mps__world *w)
{
    const mps__particles *s = &w->particles;
    enum { LINK, SEARCH, THINGS };
    MPS__TRY(list_again(w));
    bool wanted[THINGS] = {[LINK] = w->lists.linked != s->generation};
    wanted[SEARCH] = wanted[LINK] ||
                     !mps__neighbours_fresh(&w->lists.neighbours, s->n, s->x, w->setup.re_far);
    mps__world_any(w, THINGS, wanted);
    if (wanted[LINK]) w->lists.linked = -1;
    if (wanted[SEARCH]) {
        MPS__TRY(mps__world_divide(w));
        return search(w, true);
    }
    MPS__TRY(mps__world_share_places(w));
    mps__world_rows(w);
    return MPS_OK;
}

mps_status mps__world_neighbours(mps__world *w)
{
    bool any = w->particles.n > 0;
    MPS__TRY(mps__world_adopt(w));
    mps__world_any(w, 1, &any);
    MPS__CHECK(w->context, any, "there are no particles");
    w->lists.aside = w->lists.gone = 0;
    MPS__TRY(reserve_work(w));
    mps_status status = mps__world_leave_domain(w);
    any = w->particles.n > 0;
    if (w->lists.gone > 0) mps__world_any(w, 1, &any);
    if (!any)
        status = mps__fail(w->context, MPS_E_STATE, "t = %.6g s: all particles left the domain",
                           w->state.t);
    if (status == MPS_OK) status = renew(w);
    if (status == MPS_OK) status = reserve_work(w); /* there may be more than before */
    const int64_t gone = w->lists.gone;
    if (status == MPS_OK) status = mps__world_leave_tank(w);
    if (status == MPS_OK && w->lists.gone > gone) status = renew(w);
    if (status == MPS_OK) status = reserve_work(w);
    if (status == MPS_OK) status = mps__ranks_status(&w->ranks);
    if (status < 0) mps__world_take_back(w);
    return status;
}

/* Ranks order particles with each search, so that arrays that the caller holds would change. */
static mps_status neighbours_of_ranks(mps__world *w)
{
    const int32_t open = mps__particles_leases(&w->particles);
    if (open)
        return mps__fail(w->context, MPS_E_BUSY,
                         "%d lease(s) are open, and on many ranks particles change their places "
                         "with new neighbours: end them first",
                         open);
    return mps__world_neighbours(w);
}

mps_status mps__world_neighbours_kept(mps__world *w)
{
    mps__particles *s = &w->particles;
    if (mps__ranks_many(&w->ranks)) return neighbours_of_ranks(w);
    MPS__CHECK(w->context, s->n > 0, "there are no particles");
    MPS__TRY(reserve_work(w));
    MPS__TRY(list_again(w));
    const bool fresh = w->lists.linked == s->generation &&
                       mps__neighbours_fresh(&w->lists.neighbours, s->n, s->x, w->setup.re_far);
    if (fresh) {
        mps__world_rows(w);
        return MPS_OK;
    }
    const mps_status status = search(w, false);
    w->lists.neighbours.valid = false; /* the next step sorts, as it would have done */
    return status;
}

void mps__world_rows(mps__world *w)
{
    mps__plates_look(w);
    mps__neighbours_rows(&w->lists.neighbours, w->particles.x);
}

mps_status mps__world_stencil_all(mps__world *w, int32_t which, mps_stencil *stencil)
{
    mps__particles *s = &w->particles;
    mps_neighbours *l = &w->lists.complete;
    if (!w->lists.neighbours.partial) return mps__world_stencil(w, which, stencil);
    MPS__TRY(mps__neighbours_search(l, s->n, s->x, w->setup.re_near, w->setup.re_far));
    mps__neighbours_hide(l);
    return mps__neighbours_view(l, which, &w->setup.kernel, stencil);
}

mps_status mps__world_stencil(const mps__world *w, int32_t which, mps_stencil *stencil)
{
    return mps__neighbours_view(&w->lists.neighbours, which, &w->setup.kernel, stencil);
}
