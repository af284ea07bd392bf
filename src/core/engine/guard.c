/* SPDX-License-Identifier: BSD-3-Clause */
/* Write protection by comparison; NaN in dead memory. */
#include "guard.h"
#include <math.h>
#include <string.h>

/* Whether the call may write to an array of `element` bytes per particle. */
static bool may_write(const mps__runner *h, const mps__call *call, const char *array,
                      size_t element)
{
    bool may = call->pass && call->pass->undeclared;
    for (int32_t u = 0; u < call->use_count; u++) {
        const char *other = mps__channels_array(h->channels, h->particles, call->channel[u]);
        if (!other || !(call->uses[u].access & MPS_USE_WRITE)) continue;
        const size_t n = (size_t)h->particles->n,
                     bytes = mps__channels_bytes(h->channels, h->particles, call->channel[u]);
        may = may || (array < other + n * bytes && other < array + n * element);
    }
    return may;
}

static void protect(mps__guard *g, const char *name, const void *array, size_t element)
{
    for (int32_t k = 0; k < g->count; k++)
        if (g->list[k].array == array) return; /* memory with two names */
    g->list[g->count++] = (struct mps__guarded){name, array, g->element, element};
    g->element += element;
}

/* Whether the host copy of a channel or field is stale: the call may update it. */
static bool is_stale(const mps__runner *h, int32_t channel)
{
    const mps__array *a = mps__channels_of(h->channels, h->particles, channel);
    return h->memory.open && a && !mps__array_valid(a, MPS__ON_HOST);
}

/* Whether the host copy of a channel, or of another one that overlaps it in memory, is stale. */
static bool is_stale_memory(const mps__runner *h, int32_t channel)
{
    const mps__channel *own = &h->channels->list[channel];
    const char *array = mps__channels_array(h->channels, h->particles, channel);
    const size_t n = (size_t)h->particles->n, bytes = n * mps__channel_element(own);
    bool stale = is_stale(h, channel);
    for (int32_t k = 0; k < h->channels->count && !stale; k++) {
        const mps__channel *c = &h->channels->list[k];
        const char *other = mps__channels_array(h->channels, h->particles, k);
        stale = is_stale(h, k) && other && c->where == MPS__IN_ARENA &&
                array < other + n * mps__channel_element(c) && other < array + bytes;
    }
    return stale;
}

/* Before the arena has memory for this step, in the hook populate, it may be too small. */
static bool has_memory(const mps__runner *h, const char *array, size_t element)
{
    return array + (size_t)h->particles->n * element <= h->channels->arena + h->channels->held;
}

/* List channels of models first, so that shared memory is reported under their names. */
static void list_arrays(mps__guard *g, const mps__runner *h, const mps__call *call)
{
    for (int32_t m = 0; m < h->channels->count; m++) {
        const int32_t k = (m + MPS__OWN_CHANNELS) % h->channels->count;
        const mps__channel *c = &h->channels->list[k];
        const void *array = mps__channels_array(h->channels, h->particles, k);
        if (array && c->where == MPS__IN_ARENA && !mps__channel_is_scalar(c) &&
            has_memory(h, array, mps__channel_element(c)) && !is_stale_memory(h, k) &&
            !may_write(h, call, array, mps__channel_element(c)))
            protect(g, c->spec.name, array, mps__channel_element(c));
    }
    for (int32_t k = 0; k < h->particles->fields; k++) {
        const mps__field *f = &h->particles->field[k];
        if (!is_stale(h, MPS__CHANNELS + k) && !may_write(h, call, *f->data, mps__field_element(f)))
            protect(g, f->name, *f->data, mps__field_element(f));
    }
}

static char *copy_of(const mps__guard *g, const mps__runner *h, int32_t k)
{
    return g->copies + (size_t)h->particles->n * g->list[k].before;
}

mps_status mps__guard_begin(mps__guard *g, const mps__runner *h, const mps__call *call)
{
    *g = (mps__guard){0};
    list_arrays(g, h, call);
    g->copies = mps__alloc(h->context, h->particles->n * (int64_t)g->element, 1);
    if (!g->copies) return MPS_E_NOMEM;
    for (int32_t k = 0; k < g->count; k++)
        memcpy(copy_of(g, h, k), g->list[k].array, (size_t)h->particles->n * g->list[k].element);
    return MPS_OK;
}

static mps_status compare(const mps__runner *h, const mps_stage *s, const mps__call *call,
                          const struct mps__guarded *k, const char *copy)
{
    const size_t bytes = (size_t)h->particles->n * k->element;
    if (memcmp(k->array, copy, bytes) == 0) return MPS_OK;
    size_t at = 0;
    while (((const char *)k->array)[at] == copy[at]) at++;
    return mps__fail(h->context, MPS_E_PLUGIN,
                     "model '%s' at t = %.9g s wrote '%s' of particle %lld in hook '%s': its "
                     "verb must declare this with MPS_USE_WRITE",
                     call->name, s->view->t, k->name, (long long)h->particles->id[at / k->element],
                     mps__hook_name(s->hook));
}

mps_status mps__guard_end(mps__guard *g, const mps__runner *h, const mps_stage *s,
                          const mps__call *call, mps_status status)
{
    for (int32_t k = 0; k < g->count && status == MPS_OK; k++)
        status = compare(h, s, call, &g->list[k], copy_of(g, h, k));
    mps__free(h->context, g->copies);
    return status;
}

void mps__guard_poison(const mps__runner *h)
{
    double *values = (double *)(void *)h->channels->arena;
    for (size_t v = 0; v < h->channels->held / sizeof *values; v++) values[v] = NAN;
}
