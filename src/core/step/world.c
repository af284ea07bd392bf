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

static bool outside(const mps__world *w, int64_t i, const double *lo, const double *hi)
{
    double X[3];
    if (w->particles.kind[i] != MPS_FLUID) return false;
    mps__motion_to_tank(&w->motion, &w->motion.now, w->particles.x + i * w->setup.dim, X);
    for (int d = 0; d < w->setup.dim; d++)
        if (!(X[d] >= lo[d] && X[d] <= hi[d])) return true;
    return false;
}

/* The last particles are no more, but they stay where they are in memory: what comes now may fail. `all`: on all ranks. */
static void set_aside(mps__world *w, int64_t count, int64_t all)
{
    w->particles.n -= count;
    w->ghosts.known -= count;
    w->particles.generation++;
    w->state.lost += all;
    w->lists.aside += count;
    w->lists.gone += all;
    w->lists.neighbours.valid = false;
}

void mps__world_take_back(mps__world *w)
{
    if (w->lists.gone > 0) set_aside(w, -w->lists.aside, -w->lists.gone);
}

/* Move the particles with `gone` behind the others. */
static mps_status part_lost(mps__world *w, const bool *gone, int64_t lost)
{
    mps__particles *s = &w->particles;
    int64_t stay = 0, go = s->n - lost;
    if (lost == 0) return MPS_OK;
    int32_t *order = mps__alloc(w->context, s->n, sizeof *order);
    if (!order) return MPS_E_NOMEM;
    for (int64_t i = 0; i < s->n; i++) order[gone[i] ? go++ : stay++] = (int32_t)i;
    mps_status status = mps__ghosts_ordered(&w->ghosts, order);
    if (status == MPS_OK) status = mps__particles_permute(s, s->n, order);
    mps__free(w->context, order);
    return status;
}

/* Apply the policy to the particles with `gone`, if any; the text says where they are, and names the one with the least id. */
static mps_status handle_lost(mps__world *w, const bool *gone, const char *where)
{
    const mps__particles *s = &w->particles;
    mps__found found = {.id = INT64_MAX};
    for (int64_t i = 0; i < s->n; i++) {
        if (!gone[i]) continue;
        found.count++;
        if (s->id[i] > found.id) continue;
        found.id = s->id[i];
        memcpy(found.x, s->x + i * s->dim, (size_t)s->dim * sizeof *s->x);
    }
    const int64_t lost = found.count;
    mps__world_find(w, &found);
    if (found.count == 0) return MPS_OK;
    if (w->setup.lost_policy == MPS_LOST_ERROR)
        return mps__fail(w->context, MPS_E_LOST,
                         "%lld particles %s at t = %.6g s; particle %lld is at (%g, %g, %g) m",
                         (long long)found.count, where, w->state.t, (long long)found.id, found.x[0],
                         found.x[1], found.x[2]);
    mps__log(w->context, MPS_LOG_WARNING,
             "t = %.6g s: %lld particles %s and were removed; particle %lld was at (%g, %g, %g) m",
             w->state.t, (long long)found.count, where, (long long)found.id, found.x[0], found.x[1],
             found.x[2]);
    MPS__TRY(part_lost(w, gone, lost));
    set_aside(w, lost, found.count);
    return MPS_OK;
}

typedef struct box {
    const mps__world *w;
    double lo[3], hi[3];
} box;

static void outside_rows(void *argument, int64_t begin, int64_t end)
{
    const box *b = argument;
    for (int64_t i = begin; i < end; i++)
        b->w->work.gone[i] = !mps__is_ghost(&b->w->ghosts, i) && outside(b->w, i, b->lo, b->hi);
}

static mps_status leave_domain(mps__world *w)
{
    box b = {.w = w};
    if (!mps__world_domain(w, b.lo, b.hi)) return MPS_OK;
    mps_parallel_rows(&w->pool.parallel, w->particles.n, outside_rows, &b);
    return handle_lost(w, w->work.gone, "left the domain");
}

static double distance2(const mps__world *w, int64_t i, int64_t j)
{
    double sum = 0;
    for (int d = 0; d < w->setup.dim; d++)
        sum += pow(w->particles.x[j * w->setup.dim + d] - w->particles.x[i * w->setup.dim + d], 2);
    return sum;
}

/* Is particle i, `r2` from a dummy, beyond the face this dummy stands behind, and is no wall nearer than the dummy? */
static bool behind(const mps__world *w, int64_t i, int64_t dummy, double r2)
{
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    const int64_t wall = s->wall_of[dummy];
    double X[3], height = 0;
    if (wall < 0) return false;
    mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->setup.dim, X);
    for (int d = 0; d < w->setup.dim; d++)
        height += (X[d] - s->ref[wall * w->setup.dim + d]) * s->area[wall * w->setup.dim + d];
    for (int64_t p = l->begin[i]; height < 0 && p < l->middle[i]; p++)
        if (s->kind[l->col[p]] == MPS_WALL && distance2(w, i, l->col[p]) <= r2) return false;
    return height < 0;
}

/* Whether particle i touches a wall from behind. */
static bool spilled(const mps__world *w, int64_t i)
{
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    for (int64_t p = l->begin[i]; p < l->middle[i]; p++) {
        const int64_t j = l->col[p];
        if (s->kind[j] != MPS_DUMMY || mps__is_shadow(s, j)) continue;
        const double r2 = distance2(w, i, j);
        if (r2 < w->setup.dp * w->setup.dp && behind(w, i, j, r2)) return true;
    }
    return false;
}

static void spilled_rows(void *argument, int64_t begin, int64_t end)
{
    const mps__world *w = argument;
    for (int64_t i = begin; i < end; i++)
        w->work.gone[i] = w->lists.neighbours.rim[i] && spilled(w, i);
}

/* Liquid that ran over the rim of an open tank touches its walls from behind. There they would press it as if it stood before them. */
static mps_status leave_tank(mps__world *w)
{
    mps_parallel_rows(&w->pool.parallel, w->particles.n, spilled_rows, w);
    return handle_lost(w, w->work.gone, "are behind a wall");
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
    mps_status status = leave_domain(w);
    any = w->particles.n > 0;
    if (w->lists.gone > 0) mps__world_any(w, 1, &any);
    if (!any)
        status = mps__fail(w->context, MPS_E_STATE, "t = %.6g s: all particles left the domain",
                           w->state.t);
    if (status == MPS_OK) status = renew(w);
    if (status == MPS_OK) status = reserve_work(w); /* there may be more than before */
    const int64_t gone = w->lists.gone;
    if (status == MPS_OK) status = leave_tank(w);
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
