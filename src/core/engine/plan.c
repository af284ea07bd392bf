/* SPDX-License-Identifier: BSD-3-Clause */
/* Order of verbs: by hook, then by their access to common channels, by `after` and `before`, then
 * by the list of models. */
#include "plan.h"
#include <string.h>

/* Access of a verb to a channel, in the order in which verbs run. */
enum { PRODUCES, CHANGES, READS, NOTHING };

const char *mps__hook_name(int32_t hook)
{
    static const char *const name[MPS_HOOK_COUNT] = {"populate", "limit", "motion",   "classify",
                                                     "prepare",  "force", "source",   "level",
                                                     "gradient", "load",  "velocity", "shift"};
    return hook >= 0 && hook < MPS_HOOK_COUNT ? name[hook] : NULL;
}

const char *mps__part_name(int part)
{
    static const char *const name[MPS__OUTSIDE] = {"search", "undo", "open", "limits", "commit"};
    return name[part];
}

void mps__plan_init(mps__plan *p, const mps__pass *const *passes, int32_t count)
{
    *p = (mps__plan){.passes = passes, .pass_count = count, .noted = -1, .changes = -1};
}

/* ---- channels ---- */

static mps_status check_access(const mps__models *m, const mps__call *call, int32_t u)
{
    const mps__channel *k = &m->channels->list[call->channel[u]];
    const mps_use *use = &call->uses[u];
    const uint32_t hook = 1u << call->hook;
    const char *what = NULL;
    if ((use->access & (MPS_USE_READ | MPS__USE_AROUND)) && !(k->reads & hook)) what = "read";
    if ((use->access & MPS_USE_WRITE) && !(k->writes & hook)) what = "written";
    if (!what) return MPS_OK;
    return mps__fail(m->context, MPS_E_STATE, "model '%s': channel '%s' cannot be %s in hook '%s'",
                     call->name, use->channel, what, mps__hook_name(call->hook));
}

/* Fields of the user are channels too. @return index after the channels of the list, or -1 */
static int32_t find_field(const mps__models *m, const char *name)
{
    const mps__field *f = mps__particles_field(m->particles, name);
    return f && f->is_public && f->data == &f->own
               ? MPS__CHANNELS + (int32_t)(f - m->particles->field)
               : -1;
}

/* A user field may be used in all hooks; writes before the state is saved could not be undone. */
static mps_status check_field(const mps__models *m, const mps__call *call, const mps_use *use)
{
    if (call->hook != MPS_POPULATE || !(use->access & MPS_USE_WRITE)) return MPS_OK;
    return mps__fail(m->context, MPS_E_STATE,
                     "model '%s': field '%s' cannot be written in hook '%s'", call->name,
                     use->channel, mps__hook_name(call->hook));
}

static mps_status find_channel(const mps__models *m, mps__call *call, int32_t u)
{
    const mps_use *use = &call->uses[u];
    call->channel[u] = mps__channels_find(m->channels, use->channel);
    if (call->channel[u] >= 0) return check_access(m, call, u);
    call->channel[u] = find_field(m, use->channel);
    if (call->channel[u] >= 0) return check_field(m, call, use);
    if (use->access & MPS_USE_OPTIONAL) return MPS_OK;
    return mps__fail(
        m->context, MPS_E_STATE,
        "model '%s' uses channel '%s', which no active model brings: switch on a model "
        "that brings it, or remove '%s'",
        call->name, use->channel, call->name);
}

static mps_status find_channels(const mps__models *m, mps__call *call)
{
    for (int32_t u = 0; u < call->use_count; u++)
        if (call->pass)
            call->channel[u] = mps__channels_find_own(call->uses[u].channel);
        else
            MPS__TRY(find_channel(m, call, u));
    return MPS_OK;
}

/* ---- order ---- */

static int what_it_does(const mps__call *call, int32_t channel)
{
    int does = NOTHING;
    for (int32_t u = 0; u < call->use_count; u++) {
        if (call->channel[u] != channel) continue;
        const int32_t access = call->uses[u].access;
        const bool reads = access & (MPS_USE_READ | MPS__USE_AROUND);
        does = access & MPS_USE_WRITE ? (reads ? CHANGES : PRODUCES) : READS;
    }
    return does;
}

/* Strength of a reference in `after` or `before` to another verb's model. */
enum { NOT_NAMED, BY_STAR, BY_NAME };

static int names(const char *slot, const mps__call *other)
{
    if (!slot) return NOT_NAMED;
    if (strcmp(slot, "*") == 0) return BY_STAR;
    return mps__same_slot(other->model->ops->name, slot) ? BY_NAME : NOT_NAMED;
}

static int stronger(int a, int b)
{
    return a > b ? a : b;
}

/* Order by `after` and `before`: -1: a before b, 1: a after b, 0: undefined. A name is stronger
 * than "*". */
static int declared(const mps__call *a, const mps__call *b)
{
    const int before = stronger(names(a->verb->before, b), names(b->verb->after, a));
    const int after = stronger(names(a->verb->after, b), names(b->verb->before, a));
    return before == after ? 0 : before > after ? -1 : 1;
}

/* Whether a must run before b. */
static bool precedes(const mps__call *a, const mps__call *b)
{
    if (a->model == b->model) return a->verb < b->verb;
    const int by_word = declared(a, b);
    bool by_data = false;
    for (int32_t u = 0; u < a->use_count && by_word == 0; u++) {
        const int32_t channel = a->channel[u];
        if (channel < 0) continue;
        const int mine = what_it_does(a, channel), theirs = what_it_does(b, channel);
        by_data = by_data || (mine < theirs && theirs != NOTHING);
    }
    return by_word < 0 || by_data;
}

/* First of the calls from..to-1 that must run before call a, or -1. */
static int32_t first_awaited(const mps__plan *p, int32_t a, int32_t from, int32_t to)
{
    for (int32_t b = from; b < to; b++)
        if (b != a && precedes(&p->call[b], &p->call[a])) return b;
    return -1;
}

/* First of the calls from..to-1 that no other of them must precede, or -1. */
static int32_t first_free(const mps__plan *p, int32_t from, int32_t to)
{
    for (int32_t a = from; a < to; a++)
        if (first_awaited(p, a, from, to) < 0) return a;
    return -1;
}

/* The calls from..to-1 all wait for each other: follow the dependencies to a cycle. */
static mps_status ring(const mps__plan *p, const mps__models *m, int32_t from, int32_t to)
{
    int32_t a = from;
    for (int32_t k = from; k < to; k++) a = first_awaited(p, a, from, to);
    const int32_t b = first_awaited(p, a, from, to);
    return mps__fail(m->context, MPS_E_STATE,
                     "models '%s' and '%s' wait for each other in hook '%s': name the order in "
                     "'after' or 'before' of one",
                     p->call[a].name, p->call[b].name, mps__hook_name(p->call[a].hook));
}

static mps_status sort_hook(mps__plan *p, const mps__models *m, int32_t from, int32_t to)
{
    for (; from < to; from++) {
        const int32_t next = first_free(p, from, to);
        if (next < 0) return ring(p, m, from, to);
        const mps__call moved = p->call[next];
        memmove(&p->call[from + 1], &p->call[from], (size_t)(next - from) * sizeof moved);
        p->call[from] = moved;
    }
    return MPS_OK;
}

static mps_status add_call(mps__plan *p, const mps__models *m, int32_t *count,
                           const mps__call *call)
{
    if (*count == MPS__CALLS)
        return mps__fail(m->context, MPS_E_STATE, "the active models have more than %d verbs",
                         MPS__CALLS - p->pass_count);
    p->call[*count] = *call;
    return find_channels(m, &p->call[(*count)++]);
}

/* Add the verbs of one hook in the order of the models. */
static mps_status add_verbs(mps__plan *p, const mps__models *m, int32_t hook, int32_t *count)
{
    for (int32_t k = 0; k < m->active; k++) {
        const mps_model_ops *ops = m->on[k].ops;
        for (int32_t v = 0; v < ops->verb_count; v++) {
            const mps_verb *verb = &ops->verbs[v];
            if (verb->hook == hook)
                MPS__TRY(add_call(p, m, count,
                                  &(mps__call){.name = ops->name,
                                               .model = &m->on[k],
                                               .verb = verb,
                                               .hook = hook,
                                               .use_count = verb->use_count,
                                               .uses = verb->uses}));
        }
    }
    return MPS_OK;
}

static mps_status add_passes(mps__plan *p, const mps__models *m, int32_t hook, int32_t place,
                             int32_t *count)
{
    for (int32_t k = 0; k < p->pass_count; k++) {
        const mps__pass *pass = p->passes[k];
        if (pass->hook == hook && pass->place == place)
            MPS__TRY(add_call(p, m, count,
                              &(mps__call){.name = pass->name,
                                           .pass = pass,
                                           .hook = hook,
                                           .use_count = pass->use_count,
                                           .uses = pass->uses}));
    }
    return MPS_OK;
}

/* Exactly one verb writes a scalar; others may change it. */
static mps_status check_owners(const mps__plan *p, const mps__models *m)
{
    for (int32_t c = 0; c < m->channels->count; c++) {
        const mps__call *owner = NULL;
        if (!mps__channel_is_scalar(&m->channels->list[c])) continue;
        for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++) {
            const mps__call *call = &p->call[k];
            if (!call->model || what_it_does(call, c) != PRODUCES) continue;
            if (owner && owner->model != call->model)
                return mps__fail(m->context, MPS_E_STATE,
                                 "models '%s' and '%s' both write channel '%s', one number for all "
                                 "particles: remove one of them, or let one change it "
                                 "(MPS_USE_CHANGE)",
                                 owner->name, call->name, m->channels->list[c].spec.name);
            owner = call;
        }
    }
    return MPS_OK;
}

mps_status mps__plan_make(mps__plan *p, const mps__models *m)
{
    int32_t count = 0;
    if (p->changes == m->changes) return MPS_OK;
    p->changes = -1;
    for (int32_t hook = 0; hook < MPS_HOOK_COUNT; hook++) {
        p->begin[hook] = count;
        MPS__TRY(add_passes(p, m, hook, MPS__BEFORE_MODELS, &count));
        const int32_t first = count;
        MPS__TRY(add_verbs(p, m, hook, &count));
        MPS__TRY(sort_hook(p, m, first, count));
        MPS__TRY(add_passes(p, m, hook, MPS__AFTER_MODELS, &count));
        MPS__TRY(add_passes(p, m, hook, MPS__LAST_OF_STEP, &count));
    }
    p->begin[MPS_HOOK_COUNT] = count;
    MPS__TRY(check_owners(p, m));
    mps__channels_find_fields(m->channels, m->particles);
    mps__liveness_make(p, m->channels);
    mps__plan_clear_costs(p);
    p->changes = m->changes;
    return MPS_OK;
}

void mps__plan_clear_costs(mps__plan *p)
{
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++) p->call[k].cost = (mps__cost){0};
    for (int part = 0; part < MPS__OUTSIDE; part++) p->outside[part] = (mps__cost){0};
}

/* A part comes before the calls of a hook, or after all calls. */
bool mps__plan_entry(const mps__plan *p, int32_t index, const mps__call **call, int *part)
{
    static const int32_t before[MPS__OUTSIDE] = {MPS_LIMIT, MPS_LIMIT, MPS_LIMIT, MPS_LIMIT + 1,
                                                 MPS_HOOK_COUNT};
    *call = NULL;
    *part = 0;
    while (*part < MPS__OUTSIDE && p->begin[before[*part]] + *part < index) ++*part;
    if (*part < MPS__OUTSIDE && p->begin[before[*part]] + *part == index) return true;
    index -= *part;
    if (index < 0 || index >= p->begin[MPS_HOOK_COUNT]) return false;
    *call = &p->call[index];
    return true;
}

void mps__flux_channels(const mps__channels *c, int32_t channel[MPS__FLUX_CHANNELS])
{
    channel[0] = MPS__PRESSURE_DENSITY;
    channel[1] = MPS__TANK_ACCELERATION;
    channel[2] = mps__channels_find(c, "interface_distance");
    channel[3] = mps__channels_find(c, "pressure_jump");
    channel[4] = mps__channels_find(c, "wetted_share");
}

bool mps__plan_has_writer(const mps__plan *p, int32_t channel)
{
    bool any = false;
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++)
        any = any || (p->call[k].model && what_it_does(&p->call[k], channel) < READS);
    return any;
}

bool mps__plan_writes(const mps__plan *p, mps__channels *c, mps__particles *s,
                      const mps__field *field)
{
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++) {
        const mps__call *call = &p->call[k];
        if (call->pass && call->pass->place == MPS__LAST_OF_STEP) continue;
        for (int32_t u = 0; u < call->use_count; u++)
            if (call->uses[u].access & MPS_USE_WRITE && call->channel[u] >= 0 &&
                mps__channels_field(c, s, call->channel[u]) == field)
                return true;
    }
    return false;
}

/* Whether a verb of this hook writes the channel. */
static bool is_written(const mps__plan *p, const mps__models *m, int32_t hook, const char *channel)
{
    const int32_t which = mps__channels_find(m->channels, channel);
    for (int32_t k = p->begin[hook]; k < p->begin[hook + 1]; k++)
        if (p->call[k].model && what_it_does(&p->call[k], which) < READS) return true;
    return false;
}

void mps__plan_note(mps__plan *p, const mps__models *m)
{
    if (p->noted == p->changes) return;
    p->noted = p->changes;
    if (!is_written(p, m, MPS_SOURCE, "pressure_source"))
        mps__log(m->context, MPS_LOG_WARNING,
                 "no active model adds to 'pressure_source' in hook 'source': nothing keeps the "
                 "fluid's volume, its particles fall through one another; switch on a model of "
                 "slot \"source\"");
    if (!is_written(p, m, MPS_GRADIENT, "acceleration"))
        mps__log(m->context, MPS_LOG_WARNING,
                 "no active model adds to 'acceleration' in hook 'gradient': pressures do not "
                 "move the fluid, its particles fall through one another; switch on a model of "
                 "slot \"gradient\"");
}
