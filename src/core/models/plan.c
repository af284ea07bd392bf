/* SPDX-License-Identifier: BSD-3-Clause */
/* Order of verbs: by moment, then by what they do to the same channel, by `after` and `before`,
 * then by the list of models. */
#include "plan.h"
#include <string.h>

/* What a verb does to a channel, in the order in which verbs run. */
enum { PRODUCES, CHANGES, READS, NOTHING };

const char *mps__moment_name(int32_t moment)
{
    static const char *const name[MPS_MOMENT_COUNT] = {"limit",    "classify", "prepare",  "force",
                                                       "source",   "level",    "gradient", "load",
                                                       "velocity", "shift"};
    return moment >= 0 && moment < MPS_MOMENT_COUNT ? name[moment] : NULL;
}

void mps__plan_init(mps__plan *p)
{
    *p = (mps__plan){.noted = -1, .changes = -1};
}

/* ---- channels ---- */

static mps_status check_access(const mps__models *m, const mps__call *call, int32_t u)
{
    const mps__channel *k = &m->channels->list[call->channel[u]];
    const mps_use *use = &call->verb->uses[u];
    const uint32_t moment = 1u << call->verb->moment;
    const char *what = NULL;
    if ((use->access & (MPS_USE_READ | MPS__USE_AROUND)) && !(k->reads & moment)) what = "read";
    if ((use->access & MPS_USE_WRITE) && !(k->writes & moment)) what = "written";
    if (!what) return MPS_OK;
    return mps__fail(m->context, MPS_E_STATE,
                     "model '%s': channel '%s' cannot be %s in moment '%s'", call->model->ops->name,
                     use->channel, what, mps__moment_name(call->verb->moment));
}

/* Fields of the user are channels too. @return the place behind those of the list, or -1 */
static int32_t find_field(const mps__models *m, const char *name)
{
    const mps__field *f = mps__particles_field(m->particles, name);
    return f && f->is_public && f->data == &f->own
               ? MPS__CHANNELS + (int32_t)(f - m->particles->field)
               : -1;
}

static mps_status find_channels(const mps__models *m, mps__call *call)
{
    for (int32_t u = 0; u < call->verb->use_count; u++) {
        const mps_use *use = &call->verb->uses[u];
        call->channel[u] = mps__channels_find(m->channels, use->channel);
        if (call->channel[u] >= 0)
            MPS__TRY(check_access(m, call, u));
        else
            call->channel[u] = find_field(m, use->channel);
        if (call->channel[u] < 0 && !(use->access & MPS_USE_OPTIONAL))
            return mps__fail(m->context, MPS_E_STATE,
                             "model '%s' uses channel '%s', which no active model brings: switch "
                             "on a model that brings it, or "
                             "remove '%s'",
                             call->model->ops->name, use->channel, call->model->ops->name);
    }
    return MPS_OK;
}

/* ---- order ---- */

static int what_it_does(const mps__call *call, int32_t channel)
{
    int does = NOTHING;
    for (int32_t u = 0; u < call->verb->use_count; u++) {
        if (call->channel[u] != channel) continue;
        const int32_t access = call->verb->uses[u].access;
        const bool reads = access & (MPS_USE_READ | MPS__USE_AROUND);
        does = access & MPS_USE_WRITE ? (reads ? CHANGES : PRODUCES) : READS;
    }
    return does;
}

/* How strongly an entry of `after` or `before` names the model of another verb. */
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

/* -1: a runs before b by what they say, 1: after it, 0: they say nothing. A name says more than "*". */
static int said(const mps__call *a, const mps__call *b)
{
    const int before = stronger(names(a->verb->before, b), names(b->verb->after, a));
    const int after = stronger(names(a->verb->after, b), names(b->verb->before, a));
    return before == after ? 0 : before > after ? -1 : 1;
}

/* Whether a must run before b. */
static bool precedes(const mps__call *a, const mps__call *b)
{
    if (a->model == b->model) return a->verb < b->verb;
    const int by_word = said(a, b);
    bool by_data = false;
    for (int32_t u = 0; u < a->verb->use_count && by_word == 0; u++) {
        const int32_t channel = a->channel[u];
        if (channel < 0) continue;
        const int mine = what_it_does(a, channel), theirs = what_it_does(b, channel);
        by_data = by_data || (mine < theirs && theirs != NOTHING);
    }
    return by_word < 0 || by_data;
}

/* The first of the calls from..to-1 that must run before call a, or -1. */
static int32_t first_awaited(const mps__plan *p, int32_t a, int32_t from, int32_t to)
{
    for (int32_t b = from; b < to; b++)
        if (b != a && precedes(&p->call[b], &p->call[a])) return b;
    return -1;
}

/* The first of the calls from..to-1 that no other of them must precede, or -1. */
static int32_t first_free(const mps__plan *p, int32_t from, int32_t to)
{
    for (int32_t a = from; a < to; a++)
        if (first_awaited(p, a, from, to) < 0) return a;
    return -1;
}

/* Each of the calls from..to-1 waits for another one. Going from one to the one that it waits for ends in a ring. */
static mps_status ring(const mps__plan *p, const mps__models *m, int32_t from, int32_t to)
{
    int32_t a = from;
    for (int32_t k = from; k < to; k++) a = first_awaited(p, a, from, to);
    const int32_t b = first_awaited(p, a, from, to);
    return mps__fail(m->context, MPS_E_STATE,
                     "models '%s' and '%s' wait for each other in moment '%s': name the order in "
                     "'after' or 'before' of one",
                     p->call[a].model->ops->name, p->call[b].model->ops->name,
                     mps__moment_name(p->call[a].verb->moment));
}

static mps_status sort_moment(mps__plan *p, const mps__models *m, int32_t from, int32_t to)
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

/* The verbs of one moment in the order of the models. */
static mps_status collect(mps__plan *p, const mps__models *m, int32_t moment, int32_t *count)
{
    for (int32_t k = 0; k < m->active; k++) {
        const mps_model_ops *ops = m->on[k].ops;
        for (int32_t v = 0; v < ops->verb_count; v++) {
            if (ops->verbs[v].moment != moment) continue;
            if (*count == MPS__CALLS)
                return mps__fail(m->context, MPS_E_STATE,
                                 "the active models have more than %d verbs", MPS__CALLS);
            mps__call *call = &p->call[(*count)++];
            *call = (mps__call){.model = &m->on[k], .verb = &ops->verbs[v]};
            MPS__TRY(find_channels(m, call));
        }
    }
    return MPS_OK;
}

mps_status mps__plan_make(mps__plan *p, const mps__models *m)
{
    int32_t count = 0;
    if (p->changes == m->changes) return MPS_OK;
    p->changes = -1;
    for (int32_t moment = 0; moment < MPS_MOMENT_COUNT; moment++) {
        p->begin[moment] = count;
        MPS__TRY(collect(p, m, moment, &count));
        MPS__TRY(sort_moment(p, m, p->begin[moment], count));
    }
    p->begin[MPS_MOMENT_COUNT] = count;
    p->changes = m->changes;
    return MPS_OK;
}

/* Whether a verb of this moment writes the channel. */
static bool is_written(const mps__plan *p, const mps__models *m, int32_t moment,
                       const char *channel)
{
    const int32_t which = mps__channels_find(m->channels, channel);
    for (int32_t k = p->begin[moment]; k < p->begin[moment + 1]; k++)
        if (what_it_does(&p->call[k], which) < READS) return true;
    return false;
}

void mps__plan_note(mps__plan *p, const mps__models *m)
{
    if (p->noted == p->changes) return;
    p->noted = p->changes;
    if (!is_written(p, m, MPS_SOURCE, "pressure_source"))
        mps__log(m->context, MPS_LOG_WARNING,
                 "no active model adds to 'pressure_source' in moment 'source': nothing keeps the "
                 "fluid's volume, its particles fall through one another; switch on a model of "
                 "slot \"source\"");
    if (!is_written(p, m, MPS_GRADIENT, "acceleration"))
        mps__log(m->context, MPS_LOG_WARNING,
                 "no active model adds to 'acceleration' in moment 'gradient': pressures do not "
                 "move the fluid, its particles fall through one another; switch on a model of "
                 "slot \"gradient\"");
}
