/* SPDX-License-Identifier: BSD-3-Clause */
/* Write protection by comparison, and NaN where there is no value. */
#include "guard.h"
#include <math.h>
#include <string.h>

/* Whether the call may write some bytes of an array of `element` bytes a particle. What the last of a step keeps are fields that are no channels. */
static bool may_write(const mps__host *h, const mps__call *call, const char *array, size_t element)
{
    bool may = call->pass && call->pass->place == MPS__LAST_OF_STEP;
    for (int32_t u = 0; u < call->use_count; u++) {
        const char *other = mps__channels_array(h->channels, h->particles, call->channel[u]);
        if (!other || !(call->uses[u].access & MPS_USE_WRITE)) continue;
        const size_t n = (size_t)h->particles->n,
                     bytes = mps__channels_bytes(h->channels, h->particles, call->channel[u]);
        may = may || (array < other + n * bytes && other < array + n * element);
    }
    return may;
}

static mps_status protect(mps__guard *g, const mps__host *h, const char *name, const void *array,
                          size_t element)
{
    for (int32_t k = 0; k < g->count; k++)
        if (g->list[k].array == array) return MPS_OK; /* memory with two names */
    void *copy = mps__alloc(h->context, h->particles->n, element);
    if (!copy) return MPS_E_NOMEM;
    memcpy(copy, array, (size_t)h->particles->n * element);
    g->list[g->count++] = (struct mps__guarded){name, array, copy, element};
    return MPS_OK;
}

/* Channels of models come first: memory that they share has their names. */
mps_status mps__guard_begin(mps__guard *g, const mps__host *h, const mps__call *call)
{
    mps_status status = MPS_OK;
    g->count = 0;
    for (int32_t m = 0; m < h->channels->count && status == MPS_OK; m++) {
        const int32_t k = (m + MPS__OWN_CHANNELS) % h->channels->count;
        const mps__channel *c = &h->channels->list[k];
        const void *array = mps__channels_array(h->channels, h->particles, k);
        if (array && c->where == MPS__IN_ARENA && !mps__channel_is_scalar(c) &&
            !may_write(h, call, array, mps__channel_element(c)))
            status = protect(g, h, c->spec.name, array, mps__channel_element(c));
    }
    for (int32_t k = 0; k < h->particles->fields && status == MPS_OK; k++) {
        const mps__field *f = &h->particles->field[k];
        if (!may_write(h, call, *f->data, (size_t)f->components * f->size))
            status = protect(g, h, f->name, *f->data, (size_t)f->components * f->size);
    }
    return status;
}

static mps_status compare(const mps__host *h, const mps_stage *s, const mps__call *call,
                          const struct mps__guarded *k)
{
    const size_t bytes = (size_t)h->particles->n * k->element;
    if (memcmp(k->array, k->copy, bytes) == 0) return MPS_OK;
    size_t at = 0;
    while (((const char *)k->array)[at] == ((const char *)k->copy)[at]) at++;
    return mps__fail(h->context, MPS_E_PLUGIN,
                     "model '%s' at t = %.9g s wrote '%s' of particle %lld in hook '%s': its "
                     "verb must declare this with MPS_USE_WRITE",
                     call->name, s->view->t, k->name, (long long)h->particles->id[at / k->element],
                     mps__hook_name(s->hook));
}

mps_status mps__guard_end(mps__guard *g, const mps__host *h, const mps_stage *s,
                          const mps__call *call, mps_status status)
{
    for (int32_t k = 0; k < g->count; k++) {
        if (status == MPS_OK) status = compare(h, s, call, &g->list[k]);
        mps__free(h->context, g->list[k].copy);
    }
    return status;
}

void mps__guard_poison(const mps__host *h)
{
    double *values = (double *)(void *)h->channels->arena;
    for (size_t v = 0; v < h->channels->held / sizeof *values; v++) values[v] = NAN;
}
