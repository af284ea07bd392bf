/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays of a step at two places. */
#include "engine.h"
#include <string.h>

/* The twin of a channel; NULL: it has none. */
static mps__twin *twin_of(mps__twins *t, int32_t channel)
{
    if (channel < 0) return NULL;
    const mps__field *f = mps__channels_field(t->channels, t->particles, channel);
    if (f) return &t->list[MPS__CHANNELS + (f - t->particles->field)];
    return mps__channel_is_scalar(&t->channels->list[channel]) ? NULL : &t->list[channel];
}

static void *host_array(const mps__twins *t, int32_t channel)
{
    return mps__channels_array(t->channels, t->particles, channel);
}

/* These values are not read any more. */
static void outdate(const mps__twins *t, const mps__twin *twin, void *array)
{
    if (t->engine->outdated) t->engine->outdated(t->engine->self, array, twin->bytes, twin->number);
}

/* ---- a step begins and ends ---- */

void mps__twins_attach(mps__twins *t, const mps__engine *engine)
{
    for (int32_t k = 0; k < MPS__CHANNELS + MPS__FIELDS_MAX; k++)
        if (t->list[k].room > 0) t->engine->give(t->engine->self, t->list[k].data);
    memset(t->list, 0, sizeof t->list);
    t->engine = engine;
    t->open = false;
}

static size_t number_of(const mps__twins *t, int32_t channel)
{
    const mps__field *f = mps__channels_field(t->channels, t->particles, channel);
    if (f) return f->size;
    return t->channels->list[channel].spec.type == MPS_TYPE_INTEGER ? sizeof(int32_t)
                                                                    : sizeof(double);
}

/* Room for the values of a channel, which are on the host. */
static mps_status open_twin(mps__twins *t, int32_t channel)
{
    mps__twin *twin = twin_of(t, channel);
    if (!twin || twin->bytes > 0) return MPS_OK;
    const size_t bytes = (size_t)t->particles->n *
                         mps__channels_bytes(t->channels, t->particles, channel);
    if (bytes > twin->room) {
        if (twin->room > 0) t->engine->give(t->engine->self, twin->data);
        twin->room = 0;
        twin->data = t->engine->room(t->engine->self, bytes);
        if (!twin->data)
            return mps__fail(t->channels->context, MPS_E_NOMEM,
                             "the engine has no room for %zu bytes", bytes);
        twin->room = bytes;
    }
    twin->bytes = bytes;
    twin->number = number_of(t, channel);
    twin->old[MPS__ON_HOST] = false;
    twin->old[MPS__ON_ENGINE] = true;
    outdate(t, twin, twin->data);
    return MPS_OK;
}

mps_status mps__twins_open(mps__twins *t, const mps__plan *p)
{
    int32_t flux[MPS__FLUX_CHANNELS];
    if (!t->engine) return MPS_OK;
    for (int32_t k = 0; k < MPS__CHANNELS + MPS__FIELDS_MAX; k++) t->list[k].bytes = 0;
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++)
        for (int32_t u = 0; u < p->call[k].use_count; u++)
            MPS__TRY(open_twin(t, p->call[k].channel[u]));
    mps__flux_channels(t->channels, flux);
    for (int f = 0; f < MPS__FLUX_CHANNELS; f++) MPS__TRY(open_twin(t, flux[f]));
    t->open = true;
    return MPS_OK;
}

void mps__twins_close(mps__twins *t)
{
    mps__twins_fields_ready(t);
    t->open = false;
}

/* ---- values ---- */

static void copy(mps__twins *t, mps__twin *twin, void *host, int32_t place)
{
    if (twin->bytes == 0 || !twin->old[place]) return;
    if (place == MPS__ON_ENGINE)
        t->engine->upload(t->engine->self, twin->data, host, twin->bytes);
    else
        t->engine->download(t->engine->self, host, twin->data, twin->bytes);
    twin->old[place] = false;
}

void mps__twins_ready(mps__twins *t, int32_t channel, int32_t place)
{
    mps__twin *twin = t->open ? twin_of(t, channel) : NULL;
    if (twin) copy(t, twin, host_array(t, channel), place);
}

void mps__twins_fields_ready(mps__twins *t)
{
    for (int32_t k = 0; t->open && k < t->particles->fields; k++)
        copy(t, &t->list[MPS__CHANNELS + k], *t->particles->field[k].data, MPS__ON_HOST);
}

void mps__twins_written(mps__twins *t, int32_t channel, int32_t place)
{
    mps__twin *twin = t->open ? twin_of(t, channel) : NULL;
    if (!twin) return;
    const int32_t other = place == MPS__ON_HOST ? MPS__ON_ENGINE : MPS__ON_HOST;
    twin->old[place] = false;
    twin->old[other] = true;
    outdate(t, twin, mps__twins_array(t, channel, other));
}

void *mps__twins_array(mps__twins *t, int32_t channel, int32_t place)
{
    const mps__twin *twin = place == MPS__ON_ENGINE ? twin_of(t, channel) : NULL;
    return twin ? twin->data : host_array(t, channel);
}
