/* SPDX-License-Identifier: BSD-3-Clause */
/* Prerequisites of a step: domain, lost particles, sorted particles, neighbour lists, dummies and
 * their walls. */
#include "plates.h"
#include "world_ranks.h"
#include <string.h>

mps_status mps__world_init(mps__world *w, mps__context *context, int32_t dim, double dp,
                           const mps__pass *const *passes, int32_t pass_count)
{
    w->context = context;
    w->setup.dim = dim;
    w->setup.dp = w->setup.dp_given = dp;
    w->threads = 1;
    mps__pool_init(&w->pool, context);
    w->lists.linked = w->lists.listed = -1;
    for (int k = 0; k < MPS__PHASES * MPS__PHASES; k++) w->setup.tension[k] = -1.0;
    mps__neighbours_init(&w->lists.neighbours, context, dim, dp);
    mps__neighbours_init(&w->lists.complete, context, dim, dp);
    w->lists.complete.skin = 0; /* searched at each request */
    mps__occluders_init(&w->lists.occluders, context, dim);
    w->lists.neighbours.occluders = w->lists.complete.occluders = &w->lists.occluders;
    mps__ppe_init(&w->ppe, context);
    mps__bounds_init(&w->bounds, context);
    mps__voids_init(&w->voids, context);
    w->state.jump.since = INT32_MAX;
    w->next_flags.flow = w->booked = -1;
    mps__motion_init(&w->motion, context, dim);
    MPS__TRY(mps__particles_init(&w->particles, context, dim));
    w->lists.neighbours.parallel = w->lists.complete.parallel = w->particles
                                                                    .parallel = &w->pool.parallel;
    w->lists.neighbours.shared = w->lists.complete
                                     .shared = w->ppe.scratch = w->particles.scratch = &w->scratch;
    mps__channels_init(&w->channels, context, dim);
    w->runner = (mps__runner){.context = context,
                              .models = &w->models,
                              .channels = &w->channels,
                              .particles = &w->particles,
                              .scratch = &w->scratch,
                              .parallel = &w->pool.parallel,
                              .ghosts = &w->ghosts,
                              .phase_defined = w->setup.phase_defined,
                              .densities = {.versions = -1},
                              .sets = {.context = context}};
    mps__memory_init(&w->runner.memory, &w->channels, &w->particles, &w->pool.parallel);
    mps__plan_init(&w->runner.plan, passes, pass_count);
    mps__ranks_init(&w->ranks, context);
    mps__ghosts_init(&w->ghosts, context, &w->ranks, &w->particles);
    MPS__TRY(mps__models_init(&w->models, context, &w->channels, &w->particles));
    return mps__solvers_init(&w->solvers, context);
}

void mps__world_spacing(mps__world *w, double dp)
{
    mps_neighbours *lists[] = {&w->lists.neighbours, &w->lists.complete};
    const double ratio = dp / w->setup.dp;
    if (ratio == 1) return;
    w->setup.dp = dp;
    w->setup.re_near *= ratio;
    w->setup.re_far *= ratio;
    if (!w->setup.scale_given) w->setup.velocity_scale *= sqrt(ratio);
    for (int k = 0; k < 2; k++) {
        lists[k]->dp = dp;
        lists[k]->skin *= ratio;
    }
}

void mps__world_free(mps__world *w)
{
    mps__solvers_release_device(&w->solvers, &w->runner.memory.device);
    mps__ppe_release_device(&w->ppe, &w->runner.memory.device);
    mps__ghosts_release_device(&w->ghosts);
    mps__memory_free(&w->runner.memory);
    mps__particles_free(&w->particles);
    mps__neighbours_free(&w->lists.neighbours);
    mps__neighbours_free(&w->lists.complete);
    mps__occluders_free(&w->lists.occluders);
    mps__models_free(&w->models);
    mps__solvers_free(&w->solvers);
    mps__ppe_free(&w->ppe);
    mps__bounds_free(&w->bounds);
    mps__voids_free(&w->voids);
    mps__motion_free(&w->motion);
    mps__channels_free(&w->channels);
    mps__free(w->context, w->work.gone);
    mps__free(w->context, w->runner.entry);
    mps__free(w->context, w->runner.leaves);
    mps__free(w->context, w->work.turned);
    mps__free(w->context, w->work.placed);
    mps__free(w->context, w->lists.listed_at);
    mps__free(w->context, w->mass.next);
    mps__free(w->context, w->mass.moments);
    mps__free(w->context, w->mass.rhs);
    mps__free(w->context, w->mass.p);
    mps__free(w->context, w->mass.a);
    mps__scratch_free(w->context, &w->scratch);
    mps__pool_free(&w->pool);
    mps__sets_free(&w->runner.sets);
    mps__ghosts_free(&w->ghosts);
    mps__ranks_free(&w->ranks);
}

void mps__world_view(const mps__world *w, mps_view *v)
{
    const mps__particles *s = &w->particles;
    *v = (mps_view){.struct_size = sizeof *v,
                    .dim = w->setup.dim,
                    .n = s->n,
                    .t = w->state.t,
                    .dp = w->setup.dp,
                    .velocity_scale = w->setup.velocity_scale,
                    .g = {w->setup.g[0], w->setup.g[1], w->setup.g[2]},
                    .kind = s->kind,
                    .phase = s->phase,
                    .id = s->id,
                    .x = s->x,
                    .area = w->work.area,
                    .wall_of = s->wall_of,
                    .viscosity = w->setup.phase_viscosity,
                    .tension = w->setup.tension,
                    .fastest = INFINITY};
    for (int p = 0; p < MPS__PHASES; p++) v->phases += w->setup.phase_defined[p];
    mps__motion_view(&w->motion, &w->motion.now, &v->tank);
}

typedef struct speeds {
    const double *u;
    mps__carry carry;
} speeds;

/* Square of the largest speed relative to the tank; NaN is ignored. */
MPS_ROW void raise_speed(const int dim, const mps_view *v, const speeds *f, int64_t i, double *most)
{
    const double square = mps__relative2(dim, &f->carry, v->x + i * dim, f->u + i * dim);
    *most = square > *most ? square : *most;
}
MPS_SUMS(raise_speeds, raise_speed, speeds)

double mps__world_speed(mps__world *w)
{
    mps_view v;
    double most = 0;
    if (w->next_flags.holds) return sqrt(w->next_flags.most[MPS__NEXT_SPEED]);
    mps__world_view(w, &v);
    mps__memory_set_space(&w->runner.memory, MPS__ON_DEVICE);
    const speeds f = {mps__seen(w, MPS__FIELD_VELOCITY),
                      mps__motion_carry(&w->motion, &w->motion.now)};
    mps__runner_max(&w->runner, &v, 1, &raise_speeds, &f, &most);
    mps__memory_set_space(&w->runner.memory, MPS__ON_HOST);
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
    /* phase 0 always exists, even if the user does not define it */
    for (int p = 1; p < MPS__PHASES; p++)
        if (w->setup.phase_defined[p] && !any[p])
            mps__log(w->context, MPS_LOG_WARNING,
                     "phase %d is defined, but no fluid particle is of it", p);
}

void mps__world_box_of_solids(mps__world *w, double corner[6])
{
    const mps__particles *s = &w->particles;
    for (int d = 0; d < 6; d++) corner[d] = -INFINITY;
    for (int64_t i = 0; i < s->n; i++)
        for (int d = 0; s->kind[i] != MPS_FLUID && d < s->dim; d++) {
            corner[d] = fmax(corner[d], s->ref[i * s->dim + d]);
            corner[3 + d] = fmax(corner[3 + d], -s->ref[i * s->dim + d]);
        }
    mps__ranks_max(&w->ranks, 6, corner);
}

bool mps__world_domain(mps__world *w, double lo[3], double hi[3])
{
    double corner[6], size = 0;
    if (w->setup.domain_given) {
        memcpy(lo, w->setup.domain_min, 3 * sizeof *lo);
        memcpy(hi, w->setup.domain_max, 3 * sizeof *hi);
        return true;
    }
    mps__world_box_of_solids(w, corner);
    if (isinf(corner[0])) return false;
    for (int d = 0; d < w->setup.dim; d++) size = fmax(size, corner[d] + corner[3 + d]);
    for (int d = 0; d < w->setup.dim; d++) {
        lo[d] = -corner[3 + d] - size;
        hi[d] = corner[d] + size;
    }
    return true;
}

mps_status mps__world_reserve(mps__world *w)
{
    mps__work *k = &w->work;
    return w->particles.n <= k->capacity
               ? MPS_OK
               : mps__grow(w->context, (void **)&k->gone, &k->capacity, 0,
                           mps__capacity_for(w->particles.n, k->capacity), sizeof *k->gone);
}

/* After solids were added or removed: link dummies to walls, estimate wall areas, and set the
 * number density that solids keep as long as no fluid is in reach. Needs all candidates. */
static mps_status link_solids(mps__world *w)
{
    mps_stencil near;
    mps__particles_written(&w->particles);
    MPS__TRY(mps__world_link_walls(w));
    MPS__TRY(mps__plates_find(w));
    mps__neighbours_hide(&w->lists.neighbours);
    MPS__TRY(mps__world_stencil(w, MPS_NEAR, &near));
    MPS__TRY(mps_op_number_density(&near, w->particles.nd));
    MPS__TRY(mps__ghosts_exchange(
        &w->ghosts, &(mps__halo_array){.values = w->particles.nd, .bytes = sizeof *w->particles.nd},
        1));
    w->lists.linked = w->particles.solids;
    w->lists.links++;
    return MPS_OK;
}

/* Select the particles that get rows in the next search. */
static void choose_rows(mps__world *w, bool all)
{
    w->lists.neighbours.kind = all ? NULL : w->particles.kind;
    w->lists.neighbours.dummy_rows = mps__models_dummy_rows(&w->models);
    w->lists.neighbours.ghost_rows = mps__models_neighbour_rows(&w->models);
}

/* Lists of the particles in their present order, which is that of the cells if `sorted`; positions
 * are on the host. */
static mps_status search_lists(mps__world *w, bool sorted, bool all)
{
    mps__particles *s = &w->particles;
    if (sorted && !w->lists.neighbours.key)
        MPS__TRY(mps__neighbours_order(&w->lists.neighbours, s->n, s->x, s->id, w->setup.re_far));
    if (sorted) mps__neighbours_sorted(&w->lists.neighbours, s->n);
    choose_rows(w, all);
    /* rows of the last lists, which may be newer on the device */
    mps__memory_rows_drop(&w->runner.memory);
    return mps__neighbours_search(&w->lists.neighbours, s->n, s->x, w->setup.re_near,
                                  w->setup.re_far);
}

/* Search without idle solids, on the host or on the device of the step, and apply occlusion. */
static mps_status search_active(mps__world *w, bool sorted)
{
    bool on_device = false;
    choose_rows(w, false);
    if (sorted) MPS__TRY(mps__world_search_device(w, &on_device));
    if (!on_device) MPS__TRY(mps__world_fetch(w));
    if (!on_device) MPS__TRY(search_lists(w, sorted, false));
    MPS__TRY(mps__plates_find(w));
    if (on_device) return mps__world_hide_device(w);
    mps__neighbours_hide(&w->lists.neighbours);
    return MPS_OK;
}

/* New lists, with exact rows. */
static mps_status search(mps__world *w, bool sorted)
{
    mps_status status = MPS_OK;
    if (w->lists.linked != w->particles.solids) {
        MPS__TRY(mps__world_fetch(w));
        MPS__TRY(search_lists(w, sorted, true));
        status = link_solids(w);
    }
    if (status == MPS_OK) status = search_active(w, sorted);
    if (status < 0) w->lists.neighbours.valid = false;
    if (status == MPS_OK) w->lists.listed = w->particles.generation;
    return status;
}

/* Whether the candidates of the last search are valid, but lists have to be rebuilt: models or the
 * solver require or no longer require rows of dummies, or more ghosts; or the device that had them
 * has failed. */
static bool wants_other_lists(const mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    return l->valid && w->lists.linked == w->particles.solids &&
           w->lists.listed == w->particles.generation &&
           (l->torn || l->dummy_rows != mps__models_dummy_rows(&w->models) ||
            mps__world_wants_ghosts(w));
}

static mps_status note_models(mps__world *w)
{
    const mps__particles *s = &w->particles;
    if (!wants_other_lists(w)) return MPS_OK;
    MPS__TRY(mps__world_fetch_searched(w));
    w->lists.listed_at = mps__alloc(w->context, s->n * s->dim, sizeof(double));
    if (!w->lists.listed_at) return MPS_E_NOMEM;
    mps__parallel_copy(&w->pool.parallel, w->lists.listed_at, w->lists.neighbours.searched,
                       (size_t)(s->n * s->dim) * sizeof(double));
    return MPS_OK;
}

/* Lists at the positions that are temporarily in the store. */
static mps_status search_listed(mps__world *w)
{
    MPS__TRY(search_lists(w, true, false));
    return mps__plates_find(w);
}

/* Repeat a search that was done before a checkpoint or for other models, unless particles were
 * added or removed since: the store is already in order. */
static mps_status list_again(mps__world *w)
{
    mps__particles *s = &w->particles;
    double *const now = s->x;
    if (!w->lists.listed_at) MPS__TRY(note_models(w));
    if (mps__ranks_many(&w->ranks)) return mps__world_list_again(w, search_listed);
    if (!w->lists.listed_at) return MPS_OK;
    MPS__TRY(mps__world_fetch(w)); /* before positions are exchanged */
    if (w->lists.linked == s->solids && w->lists.listed == s->generation) {
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

/* Sort the particles by cell and search again, if needed. */
static mps_status renew(mps__world *w)
{
    mps__particles *s = &w->particles;
    enum { LINK, SEARCH, WRITTEN, THINGS };
    MPS__TRY(list_again(w));
    bool fresh = w->lists.listed == s->generation,
         wanted[THINGS] = {[LINK] = w->lists.linked != s->solids};
    if (fresh && !wanted[LINK]) MPS__TRY(mps__world_fresh(w, &fresh));
    wanted[SEARCH] = wanted[LINK] || !fresh;
    wanted[WRITTEN] = s->written;
    mps__world_any(w, THINGS, wanted);
    s->written = false;
    if (wanted[LINK]) w->lists.linked = -1;
    if (wanted[SEARCH]) {
        MPS__TRY(mps__world_divide(w));
        return search(w, true);
    }
    if (wanted[WRITTEN]) MPS__TRY(mps__world_exchange_written(w));
    return mps__world_rows(w);
}

mps_status mps__world_neighbours(mps__world *w)
{
    w->lists.aside = w->lists.gone = w->lists.lost = 0;
    return mps__world_neighbours_populated(w);
}

mps_status mps__world_neighbours_populated(mps__world *w)
{
    enum { PARTICLES, LOOKS, THINGS };
    MPS__TRY(mps__world_adopt(w));
    bool things[THINGS] = {[PARTICLES] = w->particles.n > 0, [LOOKS] = !w->next_flags.holds},
         any = true;
    mps__world_any(w, THINGS, things);
    w->next_flags.holds = !things[LOOKS]; /* if one rank has to compute them, all do */
    MPS__CHECK(w->context, things[PARTICLES], "there are no particles");
    if (!mps__world_on_device(w)) MPS__TRY(mps__world_fetch(w));
    MPS__TRY(mps__world_reserve(w));
    mps_status status = mps__world_leave_domain(w);
    any = w->particles.n > 0 || w->lists.gone == 0;
    if (w->lists.gone > 0) mps__world_any(w, 1, &any);
    if (!any)
        status = mps__fail(w->context, MPS_E_STATE, "t = %.6g s: all particles left the domain",
                           w->state.t);
    if (status == MPS_OK) status = renew(w);
    if (status == MPS_OK) status = mps__world_reserve(w); /* the number may have grown */
    const int64_t gone = w->lists.gone;
    if (status == MPS_OK) status = mps__world_leave_tank(w);
    if (status == MPS_OK && w->lists.gone > gone) status = renew(w);
    if (status == MPS_OK) status = mps__world_reserve(w);
    if (status == MPS_OK) status = mps__ranks_status(&w->ranks);
    if (status < 0) mps__world_take_back(w);
    return status;
}

/* Each search on many ranks reorders particles, so that leased arrays would change. */
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
    MPS__TRY(mps__world_reserve(w));
    MPS__TRY(mps__world_fetch(w));
    MPS__TRY(list_again(w));
    bool fresh = w->lists.linked == s->solids && w->lists.listed == s->generation;
    if (fresh) MPS__TRY(mps__world_fresh(w, &fresh));
    if (fresh) return mps__world_rows(w);
    const mps_status status = search(w, false);
    w->lists.neighbours.valid = false; /* the next step sorts, as it would have without this call */
    return status;
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

mps_status mps__world_add_guess(mps__world *w)
{
    mps__particles *s = &w->particles;
    if (w->mass.guess) return MPS_OK;
    MPS__TRY(mps__particles_field_add(s, "mass_pressure", w->setup.dim == 3 ? 6 : 3, sizeof(double),
                                      false, (void **)&w->mass.guess));
    mps__particles_field(s, "mass_pressure")->passing = true;
    return MPS_OK;
}
