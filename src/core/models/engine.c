/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays of a step, mirrored in host and device memory. */
#include "engine_twin.h"
#include "later.h"
#include <string.h>

enum {
    FIELDS = MPS__TWIN_FIELDS,
    ALL = MPS__CHANNELS + MPS__FIELDS_MAX,
    /* constants: settings of each model, then those of the simulation */
    VISCOSITIES = MPS__MODELS_ACTIVE * MPS__SETTINGS,
    TENSIONS = VISCOSITIES + MPS__PHASES,
    CONSTANTS = TENSIONS + MPS__PHASES * MPS__PHASES
};

/* ---- mirrors ---- */

static bool is_field_of(const mps__particles *s, int64_t serial)
{
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].serial == serial) return true;
    return false;
}

mps__twin *mps__twin_of_field(mps__twins *t, int32_t field)
{
    const int64_t serial = t->particles->field[field].serial;
    mps__twin *list = t->list + FIELDS, *own = list + field;
    int32_t k = 0;
    if (own->field == serial) return own;
    while (k < MPS__FIELDS_MAX && list[k].field != serial) k++;
    const bool is_new = k == MPS__FIELDS_MAX;
    /* a mirror of no field: there are as many mirrors as fields at most */
    for (k = is_new ? 0 : k; is_new && is_field_of(t->particles, list[k].field);) k++;
    const mps__twin found = list[k];
    list[k] = *own;
    *own = found;
    own->field = serial;
    if (is_new) own->bytes = 0;
    return own;
}

/* Mirror of the field with this host array, or NULL. */
static mps__twin *twin_of_array(mps__twins *t, const void *array)
{
    for (int32_t k = 0; array && k < t->particles->fields; k++)
        if (*t->particles->field[k].data == array) return mps__twin_of_field(t, k);
    return NULL;
}

/* Mirror of a channel, or NULL. Positions and areas of solids are fields of the particles if no
 * model writes them. */
mps__twin *mps__twin_of(mps__twins *t, int32_t channel)
{
    if (channel < 0) return NULL;
    const mps__field *f = mps__channels_field(t->channels, t->particles, channel);
    if (f) return mps__twin_of_field(t, (int32_t)(f - t->particles->field));
    if (mps__channel_is_scalar(&t->channels->list[channel])) return NULL;
    mps__twin *twin = channel == MPS__SOLID_PLACE || channel == MPS__SOLID_AREA
                          ? twin_of_array(t, t->channels->list[channel].array)
                          : NULL;
    return twin ? twin : &t->list[channel];
}

/* Tell the device that these values are not read any more. */
static void outdate(mps__twins *t, const mps__twin *twin, void *array)
{
    mps__device_outdate(&t->device, array, twin->bytes, twin->number);
}

void mps__twin_give_back(mps__twins *t, mps__twin *twin)
{
    mps__device_leave(&t->device, &twin->spare);
    if (twin->room > 0) mps__device_give(&t->device, twin->data, twin->room);
    *twin = (mps__twin){.field = twin->field};
}

mps_status mps__twin_fit(mps__twins *t, mps__twin *twin, size_t bytes, size_t number)
{
    if (bytes > twin->room) {
        mps__twin_give_back(t, twin);
        twin->data = mps__device_room(&t->device, bytes);
        if (!twin->data) return MPS_E_NOMEM;
        twin->room = bytes;
    }
    twin->bytes = bytes;
    twin->number = number;
    twin->old[MPS__ON_HOST] = false;
    twin->old[MPS__ON_DEVICE] = true;
    return MPS_OK;
}

void mps__twin_copy(mps__twins *t, mps__twin *twin, void *host, int32_t place)
{
    if (twin->bytes == 0 || !twin->old[place]) return;
    if (place == MPS__ON_DEVICE)
        mps__device_upload(&t->device, twin->data, host, twin->bytes);
    else
        mps__device_download(&t->device, host, twin->data, twin->bytes);
    twin->old[place] = t->device.failed;
}

/* Host lists stay readable when their rows change on the device: they hold an older partition of
 * the same candidates, from which the rows can be rebuilt if the device fails. */
static bool is_list(const mps__twins *t, const mps__twin *twin)
{
    return twin >= t->block && twin < t->block + MPS__LASTING;
}

void mps__twin_change(mps__twins *t, mps__twin *twin, void *host, int32_t place, bool all)
{
    const int32_t other = place == MPS__ON_HOST ? MPS__ON_DEVICE : MPS__ON_HOST;
    const bool was_old = twin->old[other];
    twin->old[place] = false;
    twin->old[other] = true;
    if (was_old || (other == MPS__ON_HOST && !all && is_list(t, twin))) return;
    outdate(t, twin, other == MPS__ON_HOST ? host : twin->data);
}

/* ---- a device ---- */

void mps__twins_init(mps__twins *t, mps__channels *c, mps__particles *s, mps_parallel *parallel)
{
    *t = (mps__twins){.channels = c,
                      .particles = s,
                      .parallel = parallel,
                      .told = -1,
                      .told_solution = -1,
                      .changes = -1,
                      .listed = -1};
    mps__device_init(&t->device, c->context);
    t->last.struct_size = sizeof t->last;
}

void mps__twins_free(mps__twins *t)
{
    if (!t->channels) return; /* initialisation ran out of memory */
    for (int32_t k = 0; k < ALL; k++) mps__twin_give_back(t, &t->list[k]);
    for (int32_t k = 0; k < MPS__BLOCKS; k++) mps__twin_give_back(t, &t->block[k]);
    for (int32_t k = 0; k < MPS__SCRATCH; k++) mps__twin_give_back(t, &t->scratch[k]);
    mps__twin_give_back(t, &t->order);
    mps__twin_give_back(t, &t->results);
    mps__twin_give_back(t, &t->constants);
    if (t->constant) mps__free(t->device.context, t->constant);
    mps__device_end(&t->device);
    mps__twins_init(t, t->channels, t->particles, t->parallel);
}

mps_status mps__twins_attach(mps__twins *t, const mps_device_ops *ops)
{
    mps__device device;
    double *constant = NULL;
    mps__device_init(&device, t->device.context);
    if (ops) {
        constant = mps__alloc(t->device.context, CONSTANTS, sizeof *constant);
        if (!constant) return MPS_E_NOMEM;
        const mps_status status = mps__device_set(&device, ops);
        if (status < 0) {
            mps__free(t->device.context, constant);
            return status;
        }
    }
    mps__twins_free(t);
    t->device = device;
    if (t->device.ops.name) t->device.parallel.user = &t->device;
    t->constant = constant;
    return MPS_OK;
}

/* ---- start and end of a step ---- */

static size_t number_of(const mps__twins *t, int32_t channel)
{
    return t->channels->list[channel].spec.type == MPS_TYPE_INTEGER ? sizeof(int32_t)
                                                                    : sizeof(double);
}

/* Allocate the device array of a channel; its values are on the host. */
static mps_status open_twin(mps__twins *t, int32_t channel)
{
    mps__twin *twin = mps__twin_of(t, channel);
    if (!twin || twin->bytes > 0) return MPS_OK;
    const size_t bytes = (size_t)t->particles->n *
                         mps__channels_bytes(t->channels, t->particles, channel);
    MPS__TRY(mps__twin_fit(t, twin, bytes, number_of(t, channel)));
    outdate(t, twin, twin->data);
    return MPS_OK;
}

/* Allocate the device arrays of all fields, including fields that no call declares. */
static mps_status open_fields(mps__twins *t)
{
    for (int32_t k = 0; k < t->particles->fields; k++) {
        const mps__field *f = &t->particles->field[k];
        mps__twin *twin = mps__twin_of_field(t, k);
        const size_t bytes = (size_t)t->particles->n * (size_t)f->components * f->size;
        if (t->changes != t->particles->changes || twin->bytes != bytes) {
            MPS__TRY(mps__twin_fit(t, twin, bytes, f->size));
            outdate(t, twin, twin->data);
        }
        twin->host = *f->data;
    }
    for (int32_t k = t->particles->fields; k < MPS__FIELDS_MAX; k++) t->list[FIELDS + k].bytes = 0;
    t->changes = t->particles->changes;
    return MPS_OK;
}

static mps_status open_constants(mps__twins *t)
{
    if (t->constants.room > 0) return MPS_OK;
    MPS__TRY(mps__twin_fit(t, &t->constants, CONSTANTS * sizeof(double), sizeof(double)));
    memset(t->constant, 0, CONSTANTS * sizeof(double));
    mps__device_clear(&t->device, t->constants.data, t->constants.bytes);
    return MPS_OK;
}

void mps__twins_begin(mps__twins *t)
{
    t->step = mps__device_there(&t->device);
    if (t->step) mps__device_begin(&t->device);
}

mps_status mps__twins_enter(mps__twins *t)
{
    MPS__TRY(open_constants(t));
    MPS__TRY(open_fields(t));
    t->open = true;
    mps__twins_go(t, MPS__ON_DEVICE);
    return MPS_OK;
}

mps_status mps__twins_leave(mps__twins *t)
{
    mps__twins_go(t, MPS__ON_HOST);
    t->open = false;
    return mps__device_status(&t->device);
}

mps_status mps__twins_open(mps__twins *t, const mps__plan *p)
{
    int32_t flux[MPS__FLUX_CHANNELS];
    if (!t->step) return MPS_OK;
    for (int32_t k = 0; k < FIELDS; k++) t->list[k].bytes = 0;
    MPS__TRY(open_constants(t));
    MPS__TRY(mps__twin_fit(t, &t->results, sizeof(mps__results), sizeof(double)));
    MPS__TRY(open_fields(t));
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++)
        for (int32_t u = 0; u < p->call[k].use_count; u++)
            MPS__TRY(open_twin(t, p->call[k].channel[u]));
    mps__flux_channels(t->channels, flux);
    for (int f = 0; f < MPS__FLUX_CHANNELS; f++) MPS__TRY(open_twin(t, flux[f]));
    t->open = true;
    return mps__device_status(&t->device);
}

mps_status mps__twins_block(mps__twins *t, int32_t block, void *host, int64_t count, size_t number,
                            bool values)
{
    mps__twin *twin = &t->block[block];
    if (!t->open || !host || count == 0) return MPS_OK;
    /* lists grow slightly from step to step */
    const size_t bytes = (size_t)count * number;
    if (bytes > twin->room) MPS__TRY(mps__twin_fit(t, twin, bytes + bytes / 8, number));
    MPS__TRY(mps__twin_fit(t, twin, bytes, number));
    twin->host = host;
    twin->old[MPS__ON_DEVICE] = values;
    outdate(t, twin, twin->data);
    return MPS_OK;
}

mps_status mps__twins_close(mps__twins *t)
{
    if (!t->step) return MPS_OK;
    mps__twins_go(t, MPS__ON_HOST);
    for (int32_t k = MPS__LASTING; k < MPS__BLOCKS; k++) t->block[k].bytes = 0;
    if (t->device.failed) mps__twins_rows_lose(t);
    t->last = t->device.info;
    t->open = t->step = false;
    const mps_status status = mps__device_status(&t->device);
    t->device.failed = false; /* the next step may succeed */
    return status;
}

/* ---- where loops run ---- */

int32_t mps__twins_go(mps__twins *t, int32_t place)
{
    const int32_t before = t->place;
    if (!t->open || place == before) return before;
    if (place == MPS__ON_DEVICE) {
        t->host_parallel = *t->parallel;
        *t->parallel = t->device.parallel;
    } else {
        *t->parallel = t->host_parallel;
    }
    t->place = place;
    return before;
}

/* Mirror of the field or block that contains a host array, or NULL. */
static mps__twin *find(mps__twins *t, const void *array)
{
    const char *a = array;
    for (int32_t k = FIELDS; k < ALL + MPS__BLOCKS; k++) {
        mps__twin *twin = k < ALL ? &t->list[k] : &t->block[k - ALL];
        const char *host = twin->host;
        if (twin->bytes > 0 && a >= host && a < host + twin->bytes) return twin;
    }
    return NULL;
}

static void *address(const mps__twin *twin, const void *array)
{
    return (char *)twin->data + ((const char *)array - (const char *)twin->host);
}

void *mps__twins_seen(mps__twins *t, const void *array)
{
    mps__twin *twin = t->open && array ? find(t, array) : NULL;
    if (!twin) return (void *)array;
    const bool is_field = twin >= t->list && twin < t->list + ALL;
    if (is_field || t->place == MPS__ON_DEVICE) mps__twin_copy(t, twin, twin->host, t->place);
    return t->place == MPS__ON_DEVICE ? address(twin, array) : (void *)array;
}

void *mps__twins_given(mps__twins *t, void *array, bool all)
{
    mps__twin *twin = t->open && array ? find(t, array) : NULL;
    if (!twin) return array;
    if (!all) mps__twin_copy(t, twin, twin->host, t->place);
    mps__twin_change(t, twin, twin->host, t->place, all);
    return t->place == MPS__ON_DEVICE ? address(twin, array) : array;
}

static void see_pairs(mps__twins *t, mps_stencil *s)
{
    s->x = mps__twins_seen(t, s->x);
    s->begin = mps__twins_seen(t, s->begin);
    s->end = mps__twins_seen(t, s->end);
    s->col = mps__twins_seen(t, s->col);
    s->w_r2 = mps__twins_seen(t, s->w_r2);
}

static void see_flux(mps__twins *t, mps_flux *f)
{
    int32_t channel[MPS__FLUX_CHANNELS];
    if (!f->density) return;
    mps__flux_channels(t->channels, channel);
    f->kind = mps__twins_seen(t, f->kind);
    f->phase = mps__twins_seen(t, f->phase);
    f->density = mps__twins_array(t, channel[0], MPS__ON_DEVICE);
    f->tank_acceleration = mps__twins_array(t, channel[1], MPS__ON_DEVICE);
    f->distance = mps__twins_array(t, channel[2], MPS__ON_DEVICE);
    f->jump = mps__twins_array(t, channel[3], MPS__ON_DEVICE);
    f->wetted = mps__twins_array(t, channel[4], MPS__ON_DEVICE);
}

void mps__twins_view(mps__twins *t, mps_view *v)
{
    if (t->place == MPS__ON_HOST) return;
    v->kind = mps__twins_seen(t, v->kind);
    v->phase = mps__twins_seen(t, v->phase);
    v->id = mps__twins_seen(t, v->id);
    v->x = mps__twins_seen(t, v->x);
    v->area = mps__twins_seen(t, v->area);
    v->wall_of = mps__twins_seen(t, v->wall_of);
    see_pairs(t, &v->near);
    see_pairs(t, &v->far);
    see_flux(t, &v->flux);
}

/* Constants from number `first` on; copied if they have changed. */
static const double *constants(mps__twins *t, int32_t first, int32_t count, const double *values)
{
    double *there = (double *)t->constants.data + first;
    if (!values) return NULL;
    if (memcmp(t->constant + first, values, (size_t)count * sizeof *values) != 0) {
        memcpy(t->constant + first, values, (size_t)count * sizeof *values);
        mps__device_upload(&t->device, there, values, (size_t)count * sizeof *values);
    }
    return there;
}

void mps__twins_loop_view(mps__twins *t, int32_t model, mps_view *v)
{
    mps__twins_view(t, v);
    v->viscosity = constants(t, VISCOSITIES, MPS__PHASES, v->viscosity);
    v->tension = constants(t, TENSIONS, MPS__PHASES * MPS__PHASES, v->tension);
    v->setting = constants(t, model * MPS__SETTINGS, MPS__SETTINGS, v->setting);
}

void *mps__twins_room(mps__twins *t, int32_t block, size_t bytes)
{
    mps__twin *twin = &t->scratch[block];
    if (mps__twin_fit(t, twin, bytes > 0 ? bytes : sizeof(double), sizeof(double)) < 0) return NULL;
    return twin->data;
}

void *mps__twins_scratch(mps__twins *t, int32_t block, size_t bytes)
{
    void *room = mps__twins_room(t, block, bytes);
    if (room) mps__device_clear(&t->device, room, t->scratch[block].bytes);
    return room;
}
