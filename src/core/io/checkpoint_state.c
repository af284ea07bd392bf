/* SPDX-License-Identifier: BSD-3-Clause */
/* State of a simulation: the input of the next step, and the accumulated budgets. */
#include "checkpoint_check.h"
#include "plates.h"
#include "step.h"
#include "world_ranks.h"
#include <mps/couple.h>
#include <stdio.h>
#include <string.h>

enum { SLOTS = 32 };

/* An object stored as in memory. */
typedef struct slot {
    const char *name;
    void *at;
    size_t size;
} slot;

static int list_slots(mps__world *w, slot out[SLOTS])
{
#define SLOT(place)                        \
    {                                      \
#place, &w->place, sizeof w->place \
    }
#define STATE(member) SLOT(state.member),
    const slot all[] = {MPS__STATE(STATE) SLOT(motion.now), SLOT(motion.hold),
                        SLOT(particles.next_id)};
#undef STATE
#undef SLOT
    memcpy(out, all, sizeof all);
    return (int)(sizeof all / sizeof all[0]);
}

/* Whether dummies are linked to walls, and whether the candidates of the last search are valid. */
typedef struct lists {
    int32_t linked, listed;
} lists;

/* State of a series without its arrays. */
typedef struct series_state {
    int64_t step, waits, next;
    double start;
} series_state;

/* Load of the last step, without the flags of the user and of the next step. */
typedef struct load_state {
    double dt, at[3], force[6], accel[6], mass[36];
    int32_t has_mass, iterations;
} load_state;

static const char *title(char out[MPS__PART_TITLE], const char *kind, const char *name)
{
    snprintf(out, MPS__PART_TITLE, "%s %s", kind, name);
    return out;
}

static const char *probe_title(char out[MPS__PART_TITLE], int64_t probe, const char *name)
{
    snprintf(out, MPS__PART_TITLE, "probe %lld %s", (long long)probe, name);
    return out;
}

/* Part name of the numbers of active model number `model`, in the order of the set-up. */
static const char *model_title(char out[MPS__PART_TITLE], int32_t model)
{
    snprintf(out, MPS__PART_TITLE, "numbers of model %d", (int)model);
    return out;
}

static bool has_series(const mps__probe *p)
{
    return !p->removed && (p->config.average != 0 || p->config.rate > 0);
}

/* Fields of ranks are not stored but rebuilt: the file is the same for any number of ranks. */
static bool is_stored(const mps__world *w, int32_t field)
{
    const mps__particles *s = &w->particles;
    return s->field[field].data != (void **)&s->wall_id;
}

/* ---- writing ---- */

static void put_particles(const mps__world *w, mps__archive *a)
{
    const mps__particles *s = &w->particles;
    char name[MPS__PART_TITLE];
    for (int32_t k = 0; k < s->fields; k++)
        if (is_stored(w, k))
            mps__archive_put(a, title(name, "field", s->field[k].name), *s->field[k].data,
                             mps__field_element(&s->field[k]), s->n);
    const bool linked = w->lists.linked == s->solids, listed = w->lists.listed == s->generation;
    const lists have = {linked,
                        linked && listed && (w->lists.neighbours.valid || w->lists.listed_at)};
    mps__archive_put(a, "lists", &have, sizeof have, 1);
    /* the particle order and the time of the next search depend on the last search */
    if (have.listed && w->lists.listed_at)
        mps__archive_put(a, "searched", w->lists.listed_at, sizeof(double), s->n * s->dim);
    else if (have.listed)
        mps__archive_put(a, "searched", w->lists.neighbours.searched, sizeof(double),
                         s->n * s->dim);
}

static void put_series(const mps__probes *probes, mps__archive *a)
{
    char name[MPS__PART_TITLE];
    for (int64_t k = 0; k < probes->count; k++) {
        const mps__series *s = &probes->list[k].series;
        if (!has_series(&probes->list[k])) continue;
        const series_state state = {s->step, s->waits, s->next, s->start};
        mps__archive_put(a, probe_title(name, k, "series"), &state, sizeof state, 1);
        mps__archive_put(a, probe_title(name, k, "signal"),
                         s->row ? s->row + s->first * (1 + s->size) : NULL,
                         (size_t)(1 + s->size) * sizeof(double), s->rows - s->first);
        mps__archive_put(a, probe_title(name, k, "times"), s->t, sizeof(double), s->count);
        mps__archive_put(a, probe_title(name, k, "samples"), s->value,
                         (size_t)s->size * sizeof(double), s->count);
    }
}

static void put_numbers(const mps__models *m, mps__archive *a)
{
    char name[MPS__PART_TITLE];
    for (int32_t k = 0; k < m->active; k++)
        if (m->on[k].state.count > 0)
            mps__archive_put(a, model_title(name, k), m->on[k].state.value, sizeof(double),
                             m->on[k].state.count);
}

/* Output rows between the checkpoint and the first step after it interpolate from this load. */
static void put_load(const mps__load *l, mps__archive *a)
{
    load_state out = {.dt = l->dt, .has_mass = l->has_mass, .iterations = l->iterations};
    if (!l->known) return;
    memcpy(out.at, l->at, sizeof out.at);
    memcpy(out.force, l->force, sizeof out.force);
    memcpy(out.accel, l->accel, sizeof out.accel);
    memcpy(out.mass, l->mass, sizeof out.mass);
    mps__archive_put(a, "load", &out, sizeof out, 1);
}

void mps__state_put(mps_sim *sim, mps__archive *a)
{
    slot slots[SLOTS];
    const int count = list_slots(&sim->world, slots);
    for (int k = 0; k < count; k++)
        mps__archive_put(a, slots[k].name, slots[k].at, slots[k].size, 1);
    if (mps__body_carries(&sim->world))
        mps__archive_put(a, "body", &sim->world.body.state, sizeof sim->world.body.state, 1);
    put_load(&sim->world.load, a);
    put_particles(&sim->world, a);
    put_series(&sim->probes, a);
    put_numbers(&sim->world.models, a);
}

/* ---- reading ---- */

/* State during reading: arrays of the archive, and new arrays that will replace those of the
 * simulation. */
typedef struct arrival {
    mps_sim *sim;
    const mps__archive *a;
    int64_t n; /* particles */
    slot slots[SLOTS];
    int count; /* of the slots */
    const void *value[SLOTS];
    const void *body; /* NULL: no rigid body carries the tank */
    mps__load load;   /* of the last step */
    mps__arrived arrived;
    lists have;
    double *listed_at;
    mps__series *series;                      /* one for each probe */
    mps__numbers numbers[MPS__MODELS_ACTIVE]; /* of each active model */
} arrival;

/* Elements of a part, which must have `wanted` elements. */
static const void *part(const arrival *v, const char *name, size_t bytes, int64_t wanted)
{
    int64_t count;
    const void *elements = mps__archive_get(v->a, name, bytes, &count);
    if (!elements || count == wanted) return elements;
    mps__fail(v->a->context, MPS_E_VERSION,
              "\"%s\" of the checkpoint has %lld elements; must be %lld", name, (long long)count,
              (long long)wanted);
    return NULL;
}

static mps_status find_slots(arrival *v)
{
    v->count = list_slots(&v->sim->world, v->slots);
    for (int k = 0; k < v->count; k++)
        if (!(v->value[k] = part(v, v->slots[k].name, v->slots[k].size, 1))) return MPS_E_VERSION;
    return MPS_OK;
}

/* New value of a slot. */
static void slot_value(const arrival *v, const void *at, void *value)
{
    for (int k = 0; k < v->count; k++)
        if (v->slots[k].at == at) memcpy(value, v->value[k], v->slots[k].size);
}

/* Scalars of the file, instead of those of the simulation. */
static mps_status find_scalars(arrival *v)
{
    mps__world *w = &v->sim->world;
    mps__arrived *a = &v->arrived;
    MPS__TRY(find_slots(v));
    a->sim = v->sim;
#define ARRIVED(member) slot_value(v, &w->state.member, &a->state.member);
    MPS__STATE(ARRIVED)
#undef ARRIVED
    slot_value(v, &w->motion.now, &a->now);
    slot_value(v, &w->motion.hold, &a->hold);
    slot_value(v, &w->particles.next_id, &a->next_id);
    return mps__check_scalars(v->a->context, a);
}

/* A rigid body continues with its stored pose; other motions are compared. */
static mps_status find_body(arrival *v)
{
    mps__body_state body;
    if (!mps__body_carries(&v->sim->world)) return MPS_OK;
    v->body = part(v, "body", sizeof body, 1);
    if (!v->body) return MPS_E_VERSION;
    memcpy(&body, v->body, sizeof body);
    return mps__check_body(v->a->context, &body);
}

/* Without load recording in the simulation the load stays unknown after a checkpoint. */
static mps_status find_load(arrival *v)
{
    const mps__load *now = &v->sim->world.load;
    mps__load *l = &v->load;
    load_state in;
    *l = *now;
    l->known = false;
    if (!mps__archive_has(v->a, "load")) return MPS_OK;
    const void *from = part(v, "load", sizeof in, 1);
    if (!from) return MPS_E_VERSION;
    memcpy(&in, from, sizeof in);
    l->known = now->watch != MPS_LOAD_NONE || mps__body_carries(&v->sim->world);
    l->has_mass = in.has_mass != 0 && now->watch == MPS_LOAD_MASS;
    l->iterations = in.iterations;
    l->dt = in.dt;
    memcpy(l->at, in.at, sizeof l->at);
    memcpy(l->force, in.force, sizeof l->force);
    memcpy(l->accel, in.accel, sizeof l->accel);
    memcpy(l->mass, in.mass, sizeof l->mass);
    return mps__check_load(v->a->context, l);
}

static mps_status find_particles(arrival *v)
{
    const mps__particles *s = &v->sim->world.particles;
    char name[MPS__PART_TITLE];
    if (!mps__archive_get(v->a, "field id", sizeof *s->id, &v->n)) return MPS_E_VERSION;
    for (int32_t k = 0; k < s->fields; k++) {
        title(name, "field", s->field[k].name);
        if (!is_stored(&v->sim->world, k) || (s->field[k].passing && !mps__archive_has(v->a, name)))
            continue;
        v->arrived.field[k] = part(v, name, mps__field_element(&s->field[k]), v->n);
        if (!v->arrived.field[k]) return MPS_E_VERSION;
    }
    const void *have = part(v, "lists", sizeof v->have, 1);
    if (!have) return MPS_E_VERSION;
    memcpy(&v->have, have, sizeof v->have);
    mps__arrived *a = &v->arrived;
    a->n = v->n;
    a->linked = v->have.linked;
    a->listed = v->have.listed;
    if (a->listed && !(a->searched = part(v, "searched", sizeof(double), v->n * s->dim)))
        return MPS_E_VERSION;
    MPS__TRY(mps__check_particles(v->a->context, a));
    if (!a->listed) return MPS_OK;
    v->listed_at = mps__alloc(v->a->context, v->n * s->dim, sizeof *v->listed_at);
    if (!v->listed_at) return MPS_E_NOMEM;
    memcpy(v->listed_at, a->searched, (size_t)(v->n * s->dim) * sizeof *v->listed_at);
    return MPS_OK;
}

/* Copy a part into a new growing array. */
static mps_status copy_part(const arrival *v, const char *name, size_t bytes, double **copy,
                            int64_t *count)
{
    const void *from = mps__archive_get(v->a, name, bytes, count);
    if (!from) return MPS_E_VERSION;
    *copy = mps__alloc(v->a->context, *count, bytes);
    if (!*copy) return MPS_E_NOMEM;
    memcpy(*copy, from, (size_t)*count * bytes);
    return MPS_OK;
}

static mps_status find_series(const arrival *v, int64_t k, mps__series *s)
{
    char name[MPS__PART_TITLE];
    const size_t values = (size_t)s->size * sizeof(double);
    series_state state;
    int64_t samples;
    const void *from = part(v, probe_title(name, k, "series"), sizeof state, 1);
    if (!from) return MPS_E_VERSION;
    memcpy(&state, from, sizeof state);
    s->step = state.step;
    s->waits = state.waits != 0;
    s->next = state.next;
    s->start = state.start;
    MPS__TRY(
        copy_part(v, probe_title(name, k, "signal"), sizeof(double) + values, &s->row, &s->rows));
    MPS__TRY(copy_part(v, probe_title(name, k, "times"), sizeof(double), &s->t, &s->count));
    MPS__TRY(copy_part(v, probe_title(name, k, "samples"), values, &s->value, &samples));
    s->row_capacity = s->rows * (1 + s->size);
    s->t_capacity = s->count;
    s->value_capacity = s->count * s->size;
    if (samples != s->count)
        return mps__fail(v->a->context, MPS_E_VERSION, "probe %lld has %lld samples at %lld times",
                         (long long)k, (long long)samples, (long long)s->count);
    return mps__check_series(v->a->context, &v->arrived, k, s, state.waits);
}

static mps_status find_all_series(arrival *v)
{
    const mps__probes *p = &v->sim->probes;
    v->series = mps__alloc(v->a->context, p->count, sizeof *v->series);
    if (!v->series) return MPS_E_NOMEM;
    for (int64_t k = 0; k < p->count; k++) {
        v->series[k].size = p->list[k].series.size;
        v->series[k].step = -1;
        if (has_series(&p->list[k])) MPS__TRY(find_series(v, k, &v->series[k]));
    }
    return MPS_OK;
}

/* Models without such a part have no numbers. */
static mps_status find_numbers(arrival *v)
{
    char name[MPS__PART_TITLE];
    const mps__models *m = &v->sim->world.models;
    for (int32_t k = 0; k < m->active; k++) {
        mps__numbers *s = &v->numbers[k];
        if (!mps__archive_has(v->a, model_title(name, k))) continue;
        MPS__TRY(copy_part(v, name, sizeof(double), &s->value, &s->count));
        s->capacity = s->count;
        MPS__TRY(mps__check_numbers(v->a->context, m->on[k].ops, s));
    }
    return MPS_OK;
}

/* The tank must be at its stored position, if a motion moves it. */
static mps_status check_motion(const arrival *v)
{
    mps__world *w = &v->sim->world;
    const mps__pose saved = v->arrived.now;
    mps__pose here;
    if (!w->motion.fn || mps__body_carries(w)) return MPS_OK;
    MPS__TRY(mps__motion_pose(&w->motion, saved.t, &here));
    for (int d = 0; d < MPS_DOF_COUNT; d++)
        MPS__CHECK(
            w->context, saved.state.value[d] == here.state.value[d],
            "the motion is another one: at t = %.9g s '%s' is %.17g, in the checkpoint %.17g",
            saved.t, mps__dof_name[d], here.state.value[d], saved.state.value[d]);
    return MPS_OK;
}

/* Commit the state. Only the first call can fail; it changes nothing then. */
static mps_status move_in(arrival *v)
{
    mps__world *w = &v->sim->world;
    mps__probes *p = &v->sim->probes;
    MPS__TRY(mps__world_replace(w, v->n, v->arrived.field, v->listed_at != NULL));
    for (int k = 0; k < v->count; k++) memcpy(v->slots[k].at, v->value[k], v->slots[k].size);
    if (v->body) memcpy(&w->body.state, v->body, sizeof w->body.state);
    w->load = v->load;
    w->lists.linked = v->have.linked ? w->particles.solids : -1;
    w->lists.listed = v->have.listed ? w->particles.generation : -1;
    mps__plates_set_active(w);
    w->lists.neighbours.valid = false;
    w->lists.aside = w->lists.gone = 0;
    mps__free(w->context, w->lists.listed_at);
    w->lists.listed_at = v->listed_at;
    v->listed_at = NULL;
    mps__world_keep_listed(w);
    for (int64_t k = 0; k < p->count; k++) {
        if (p->list[k].removed) continue;
        mps__series old = p->list[k].series;
        p->list[k].series = v->series[k];
        p->list[k].series.cuts = old.cuts + 1;
        v->series[k] = old;
    }
    for (int32_t k = 0; k < w->models.active; k++) {
        const mps__numbers old = w->models.on[k].state;
        w->models.on[k].state = v->numbers[k];
        v->numbers[k] = old;
    }
    return MPS_OK;
}

mps_status mps__state_get(mps_sim *sim, const mps__archive *a)
{
    arrival v = {.sim = sim, .a = a};
    mps_status status = find_scalars(&v);
    if (status == MPS_OK) status = check_motion(&v);
    if (status == MPS_OK) status = find_body(&v);
    if (status == MPS_OK) status = find_load(&v);
    if (status == MPS_OK) status = find_particles(&v);
    if (status == MPS_OK) status = find_all_series(&v);
    if (status == MPS_OK) status = find_numbers(&v);
    if (status == MPS_OK) status = move_in(&v);
    for (int32_t k = 0; k < sim->world.models.active; k++)
        mps__numbers_free(a->context, &v.numbers[k]);
    mps__free(a->context, v.listed_at);
    for (int64_t k = 0; v.series && k < sim->probes.count; k++)
        mps__series_free(a->context, &v.series[k]);
    mps__free(a->context, v.series);
    return status;
}
