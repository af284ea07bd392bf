/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of particles: add, remove, fields, leases. */
#define _POSIX_C_SOURCE 200809L
#include "collect.h"
#include "plates.h"
#include "sim.h"
#include "world_ranks.h"
#include <math.h>
#include <mps/particles.h>
#include <string.h>

/* Particles closer than this [dp] are duplicates by mistake. */
static const double overlap = 0.1;

static const mps_particle_block block_default = {.struct_size = sizeof(mps_particle_block),
                                                 .kind = MPS_FLUID};

mps_status mps_particle_block_init(mps_particle_block *block, size_t size)
{
    return mps__struct_init("mps_particle_block", block, size, &block_default,
                            sizeof block_default);
}

static mps_status not_leased(mps_sim *sim)
{
    const int32_t open = mps__particles_leases(&sim->world.particles);
    return open ? mps__fail(&sim->context, MPS_E_BUSY, "%d lease(s) are open", open) : MPS_OK;
}

static mps_status check_block(mps_sim *sim, const mps_particle_block *b)
{
    mps__context *c = &sim->context;
    const int dim = sim->world.setup.dim;
    MPS__CHECK(c, b->kind >= MPS_FLUID && b->kind <= MPS_DUMMY,
               "block.kind is %d: MPS_FLUID, MPS_WALL or MPS_DUMMY", b->kind);
    MPS__CHECK(c,
               b->phase >= 0 && b->phase < MPS__PHASES && sim->world.setup.phase_defined[b->phase],
               "block.phase is %d: not defined, call mps_phase_set() first", b->phase);
    MPS__CHECK(c, b->count >= 1 && b->count <= INT32_MAX, "block.count is %lld: 1..%d",
               (long long)b->count, INT32_MAX);
    MPS__CHECK(c, b->position, "block.position is NULL");
    MPS__CHECK(c, !b->part || strnlen(b->part, MPS__PART_NAME) < MPS__PART_NAME,
               "block.part is longer than %d characters", MPS__PART_NAME - 1);
    const double *arrays[] = {b->position, b->velocity, b->area};
    const char *names[] = {"position", "velocity", "area"};
    for (int a = 0; a < 3; a++)
        for (int64_t k = 0; arrays[a] && k < b->count * dim; k++)
            MPS__CHECK(c, isfinite(arrays[a][k]),
                       "block.%s of particle %lld, axis %lld is %g: must be finite", names[a],
                       (long long)(k / dim), (long long)(k % dim), arrays[a][k]);
    const mps__motion *m = &sim->world.motion;
    const mps__carry carry = mps__motion_carry(m, &m->now);
    for (int64_t k = 0; b->velocity && b->kind == MPS_FLUID && k < b->count; k++) {
        const double *u = b->velocity + k * dim,
                     speed = sqrt(mps__relative2(dim, &carry, b->position + k * dim, u));
        MPS__CHECK(
            c, speed <= sim->world.setup.speed_limit,
            "block.velocity of particle %lld is (%g, %g, %g) m/s: at most %g m/s relative to "
            "the tank, mps_config.speed_limit",
            (long long)k, u[0], u[1], dim == 3 ? u[2] : 0, sim->world.setup.speed_limit);
    }
    return MPS_OK;
}

/* Refuse particles on top of each other, in the block or with existing ones. Coincident walls are
 * the two faces of a plate. */
static mps_status check_overlap(mps_sim *sim, const mps_particle_block *b)
{
    mps__particles *s = &sim->world.particles;
    const int dim = sim->world.setup.dim;
    const int64_t n = s->n + b->count;
    const double reach = overlap * sim->world.setup.dp;
    double *x = mps__alloc(&sim->context, n * dim, sizeof *x);
    mps_neighbours *list = NULL;
    mps_status status = x ? mps_neighbours_create(dim, sim->world.setup.dp, &sim->context.allocator,
                                                  &list)
                          : MPS_E_NOMEM;
    if (status == MPS_OK) {
        memcpy(x, s->x, (size_t)(s->n * dim) * sizeof *x);
        memcpy(x + s->n * dim, b->position, (size_t)(b->count * dim) * sizeof *x);
        status = mps_neighbours_build(list, n, x, reach, reach);
    }
    if (status < 0)
        mps__fail(&sim->context, status, "%s",
                  list ? list->context->error : "no memory to look for overlapping particles");
    for (int64_t i = s->n; status == MPS_OK && i < n;
         i++) /* candidates, as coincident particles are no pairs */
        for (int64_t k = list->begin[i]; k < list->begin[i] + list->count[i] && status == MPS_OK;
             k++) {
            const int64_t j = list->col[k];
            const int32_t other = j < s->n ? s->kind[j] : b->kind;
            if ((b->kind != MPS_FLUID && other != MPS_FLUID) || (j < s->n && mps__is_shadow(s, j)))
                continue;
            status = mps__fail(
                &sim->context, MPS_E_ARG,
                "particle %lld of the block lies within %g dp of %s %lld at (%g, %g): at least %g "
                "dp apart",
                (long long)(i - s->n), overlap, j < s->n ? "particle" : "its particle",
                (long long)(j < s->n ? s->id[j] : j - s->n), x[j * dim], x[j * dim + 1], overlap);
        }
    mps_neighbours_destroy(list);
    mps__free(&sim->context, x);
    return status;
}

static void store_block(mps_sim *sim, const mps_particle_block *b, int32_t part, int64_t first)
{
    mps__world *w = &sim->world;
    mps__particles *s = &w->particles;
    const int dim = w->setup.dim;
    for (int64_t k = 0; k < b->count; k++) {
        const int64_t i = first + k;
        memcpy(s->x + i * dim, b->position + k * dim, (size_t)dim * sizeof(double));
        s->phase[i] = b->phase;
        s->part[i] = part;
        s->rho[i] = w->setup.phase_density[b->phase];
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * dim, s->ref + i * dim);
        if (b->kind != MPS_FLUID)
            mps__motion_point(&w->motion, &w->motion.now, s->ref + i * dim, NULL,
                              w->state.step > 0 ? s->u + i * dim : NULL, NULL);
        else if (b->velocity)
            memcpy(s->u + i * dim, b->velocity + k * dim, (size_t)dim * sizeof(double));
        if (b->area && b->kind == MPS_WALL) {
            double tip[3];
            for (int d = 0; d < dim; d++) tip[d] = s->x[i * dim + d] + b->area[k * dim + d];
            mps__motion_to_tank(&w->motion, &w->motion.now, tip, s->area + i * dim);
            for (int d = 0; d < dim; d++) s->area[i * dim + d] -= s->ref[i * dim + d];
        }
    }
}

/* An open tank may be filled from above, so fluid outside of the walls is accepted with a
 * warning. */
static void log_outside(mps_sim *sim, const mps_particle_block *b)
{
    mps__world *w = &sim->world;
    const int dim = w->setup.dim;
    double corner[6], X[3];
    int64_t count = 0, first = 0;
    if (b->kind != MPS_FLUID) return;
    mps__world_box_of_solids(w, corner);
    for (int64_t k = b->count - 1; k >= 0 && !isinf(corner[0]); k--) {
        bool outside = false;
        mps__motion_to_tank(&w->motion, &w->motion.now, b->position + k * dim, X);
        for (int d = 0; d < dim; d++)
            outside = outside || X[d] > corner[d] || X[d] < -corner[3 + d];
        count += outside;
        first = outside ? k : first;
    }
    if (count == 0) return;
    const double *x = b->position + first * dim;
    mps__log(w->context, MPS_LOG_WARNING,
             "%lld fluid particles of the block are outside of the box of the solids, first at "
             "(%g, %g, %g) m: they count as fluid until they leave the domain or touch a wall from "
             "behind, and are lost then",
             (long long)count, x[0], x[1], dim == 3 ? x[2] : 0);
}

/* Each rank checks its own particles; all ranks return the same status. */
static mps_status check_overlap_everywhere(mps_sim *sim, const mps_particle_block *b)
{
    return mps__ranks_agree(&sim->world.ranks, check_overlap(sim, b));
}

static mps_status add_block(mps_sim *sim, const mps_particle_block *block, int64_t *ids)
{
    mps__particles *s = &sim->world.particles;
    mps_particle_block b = block_default;
    MPS__TRY(not_leased(sim));
    MPS__TRY(mps__struct_in(&sim->context, "mps_particle_block", &b, sizeof b, block));
    MPS__TRY(check_block(sim, &b));
    MPS__TRY(check_overlap_everywhere(sim, &b));
    MPS__TRY(mps__particles_reserve(s, b.count));
    int32_t part = -1;
    if (b.kind != MPS_FLUID) {
        part = mps__part_number(s, b.part ? b.part : "solid", true);
        MPS__CHECK(&sim->context, part >= 0,
                   "block.part \"%s\": empty, or one part too many (at most %d)",
                   b.part ? b.part : "solid", MPS__PARTS_MAX);
    }
    const int64_t first = mps__particles_append(s, b.count, b.kind);
    store_block(sim, &b, part, first);
    log_outside(sim, &b);
    sim->world.lists.neighbours.valid = false;
    for (int64_t k = 0; ids && k < b.count; k++) ids[k] = s->id[first + k];
    return mps__world_divided(&sim->world) ? mps__world_adopt(&sim->world) : MPS_OK;
}

/* If one rank is out of memory, the others have the new particles and it has not. */
static mps_status same_everywhere(mps_sim *sim, mps_status status)
{
    mps__ranks *r = &sim->world.ranks;
    return status == MPS_OK        ? mps__ranks_status(r)
           : status == MPS_E_NOMEM ? mps__ranks_report(r, status)
                                   : status;
}

mps_status mps_particles_add(mps_sim *sim, const mps_particle_block *block, int64_t *ids)
{
    MPS__CHANGES(sim);
    return same_everywhere(sim, add_block(sim, block, ids));
}

/* Indices of all ids, [next_id], -1: no such particle; NULL: out of memory. */
static int32_t *places(mps_sim *sim)
{
    mps__particles *s = &sim->world.particles;
    int32_t *place = mps__alloc(&sim->context, s->next_id, sizeof *place);
    if (!place) return NULL;
    for (int64_t k = 0; k < s->next_id; k++) place[k] = -1;
    for (int64_t i = 0; i < s->n; i++) place[s->id[i]] = (int32_t)i;
    return place;
}

/* Whether all ids are known, each given once; on many ranks each must be owned by exactly one rank.
 * `place` of a removed particle becomes -1. */
static mps_status check_ids(mps_sim *sim, int64_t count, const int64_t *ids, int32_t *place)
{
    const mps__particles *s = &sim->world.particles;
    int64_t *found = mps__alloc(&sim->context, count, sizeof *found), bad = count;
    if (!found) return MPS_E_NOMEM;
    for (int64_t k = 0; k < count; k++) {
        if (ids[k] < 0 || ids[k] >= s->next_id || place[ids[k]] < 0) continue;
        found[k] = mps__own_place(&sim->world.ghosts, place[ids[k]]) >= 0;
        place[ids[k]] = -1;
    }
    for (int64_t k = 0; k < count; k += INT32_MAX)
        mps__ranks_add(&sim->world.ranks, (int32_t)(count - k < INT32_MAX ? count - k : INT32_MAX),
                       found + k);
    for (int64_t k = count - 1; k >= 0; k--) bad = found[k] == 1 ? bad : k;
    mps__free(&sim->context, found);
    MPS__TRY(mps__ranks_status(&sim->world.ranks));
    MPS__CHECK(&sim->context, bad == count, "remove: id %lld is unknown, or given twice",
               (long long)ids[bad < count ? bad : 0]);
    return MPS_OK;
}

/* Remove the particles whose index is -1. */
static mps_status take_out(mps_sim *sim, const int32_t *place)
{
    mps__particles *s = &sim->world.particles;
    int64_t left = 0, gone = 0;
    int32_t *order = mps__alloc(&sim->context, s->n, sizeof *order);
    if (!order) return MPS_E_NOMEM;
    for (int64_t i = 0; i < s->n; i++) left += place[s->id[i]] >= 0;
    for (int64_t i = 0, kept = 0; i < s->n; i++)
        order[place[s->id[i]] >= 0 ? kept++ : left + gone++] = (int32_t)i;
    mps_status status = mps__ghosts_ordered(&sim->world.ghosts, order);
    if (status == MPS_OK) status = mps__particles_permute(s, left, order);
    if (status == MPS_OK && mps__ranks_many(&sim->world.ranks)) sim->world.ghosts.known = left;
    mps__free(&sim->context, order);
    return status;
}

static mps_status remove_block(mps_sim *sim, int64_t count, const int64_t *ids)
{
    MPS__TRY(not_leased(sim));
    MPS__CHECK(&sim->context, count >= 1 && ids, "remove: count is %lld with %s ids",
               (long long)count, ids ? "given" : "no");
    MPS__TRY(mps__world_adopt(&sim->world));
    int32_t *place = places(sim);
    if (!place) return MPS_E_NOMEM;
    mps_status status = check_ids(sim, count, ids, place);
    if (status == MPS_OK) status = take_out(sim, place);
    if (status == MPS_OK) sim->world.lists.neighbours.valid = false;
    if (status == MPS_OK) mps__plates_set_active(&sim->world);
    mps__free(&sim->context, place);
    return status;
}

mps_status mps_particles_remove(mps_sim *sim, int64_t count, const int64_t *ids)
{
    MPS__CHANGES(sim);
    return same_everywhere(sim, remove_block(sim, count, ids));
}

int64_t mps_particles_count(const mps_sim *sim, int32_t kind)
{
    if (!sim || kind < -1 || kind > MPS_DUMMY) return -1;
    const mps__particles *s = &sim->world.particles;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++) count += kind < 0 || s->kind[i] == kind;
    return count;
}

int64_t mps_particle_index(const mps_sim *sim, int64_t id)
{
    for (int64_t i = 0; sim && i < sim->world.particles.n; i++)
        if (sim->world.particles.id[i] == id) return i;
    return -1;
}

mps_status mps_field_add(mps_sim *sim, const char *name, int32_t components)
{
    MPS__SETS(sim);
    MPS__TRY(not_leased(sim));
    MPS__CHECK(&sim->context, name && name[0] && strnlen(name, 32) < 32,
               "a field's name has 1..31 characters");
    MPS__CHECK(&sim->context, components >= 1 && components <= 9,
               "field \"%s\": components is %d: 1..9", name, components);
    MPS__CHECK(&sim->context, !mps__particles_field(&sim->world.particles, name),
               "field \"%s\" exists already", name);
    MPS__CHECK(&sim->context, mps__channels_find(&sim->world.channels, name) < 0,
               "field '%s': a channel of the models has this name", name);
    return mps__particles_field_add(&sim->world.particles, name, components, sizeof(double), true,
                                    NULL);
}

static const mps_lease closed = {.struct_size = sizeof closed};

mps_status mps_lease_init(mps_lease *lease, size_t size)
{
    return mps__struct_init("mps_lease", lease, size, &closed, sizeof closed);
}

/* Find a field that can be leased; the error text lists those that can. */
static mps_status find_leasable(mps_sim *sim, const char *name, mps__field **found)
{
    mps__particles *s = &sim->world.particles;
    const char *names[MPS__FIELDS_MAX];
    char hint[MPS__HINT_SIZE];
    int count = 0;
    *found = mps__particles_field(s, name);
    if (*found && ((*found)->is_public || (*found)->is_tag)) return MPS_OK;
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].is_public || s->field[k].is_tag) names[count++] = s->field[k].name;
    return mps__fail(&sim->context, MPS_E_NAME, "no field '%.60s'; %s", name,
                     mps__hint(hint, '\'', name, names, count));
}

static mps_lease lease_of(const mps__particles *s, const mps__field *f, int32_t mode)
{
    mps_lease l = {
        .count = s->n, .stride = f->components, .slot = ((int32_t)(f - s->field) + 1) * 2 + mode};
    l.type = !f->is_tag                   ? MPS_DATA_DOUBLE
             : f->size == sizeof(int32_t) ? MPS_DATA_INT32
                                          : MPS_DATA_INT64;
    if (l.type == MPS_DATA_DOUBLE) l.data = *f->data;
    if (l.type == MPS_DATA_INT32) l.integers = *f->data;
    if (l.type == MPS_DATA_INT64) l.ids = *f->data;
    return l;
}

mps_status mps_lease_begin(mps_sim *sim, const char *field, int32_t mode, mps_lease *lease)
{
    MPS__READS(sim);
    mps__context *c = &sim->context;
    mps__field *f;
    MPS__CHECK(c, field, "the name of the field is NULL");
    MPS__TRY(mps__struct_check(c, "mps_lease", lease));
    MPS__CHECK(c, mode == MPS_READ || mode == MPS_WRITE, "mode is %d: MPS_READ or MPS_WRITE", mode);
    if (mode == MPS_WRITE) MPS__SETS(sim);
    MPS__TRY(find_leasable(sim, field, &f));
    MPS__CHECK(c, mode == MPS_READ || !f->is_tag,
               "field '%s' cannot be written: lease it with MPS_READ", field);
    if (f->writer || (mode == MPS_WRITE && f->readers > 0))
        return mps__fail(c, MPS_E_BUSY, "field '%s' is leased already, for %s", field,
                         f->writer ? "writing" : "reading");
    const int32_t k = (int32_t)(f - sim->world.particles.field);
    MPS__TRY(mode == MPS_WRITE ? mps__world_write_field(&sim->world, k)
                               : mps__world_fetch_field(&sim->world, k));
    const mps_lease open = lease_of(&sim->world.particles, f, mode);
    MPS__TRY(mps__struct_out(c, "mps_lease", lease, &open, sizeof open));
    if (mode == MPS_WRITE)
        f->writer = true;
    else
        f->readers++;
    return MPS_OK;
}

mps_status mps_lease_end(mps_sim *sim, mps_lease *lease)
{
    MPS__READS(sim);
    mps__context *c = &sim->context;
    mps__particles *s = &sim->world.particles;
    MPS__TRY(mps__struct_check(c, "mps_lease", lease));
    MPS__CHECK(c, lease->slot >= 2 && lease->slot / 2 <= s->fields, "this lease is not open");
    mps__field *f = &s->field[lease->slot / 2 - 1];
    const bool write = lease->slot % 2;
    MPS__CHECK(c, write ? f->writer : f->readers > 0, "this lease of '%s' is not open", f->name);
    const double *data = *f->data;
    for (int64_t k = 0; write && k < s->n * f->components; k++)
        MPS__CHECK(
            c, isfinite(data[k]) && (data != s->rho || data[k] > 0),
            "field '%s' of particle %lld was written as %g: must be finite%s; the lease stays open",
            f->name, (long long)s->id[k / f->components], data[k],
            data == s->rho ? " and > 0" : "");
    if (write) {
        f->writer = false;
        s->written = true;
    } else {
        f->readers--;
    }
    return mps__struct_out(c, "mps_lease", lease, &closed, sizeof closed);
}

int32_t mps_part_find(const mps_sim *sim, const char *name)
{
    return sim ? mps__part_number((mps__particles *)&sim->world.particles, name, false) : -1;
}
