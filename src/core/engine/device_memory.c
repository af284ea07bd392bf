/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays of a step, mirrored in host and device memory. */
#include "device_memory.h"
#include "deferred.h"
#include <string.h>

enum {
    /* constants: settings of each model, then those of the simulation */
    VISCOSITIES = MPS__MODELS_ACTIVE * MPS__SETTINGS,
    TENSIONS = VISCOSITIES + MPS__PHASES,
    CONSTANTS = TENSIONS + MPS__PHASES * MPS__PHASES
};

/* ---- arrays ---- */

static mps__array *array_of(mps__memory *t, int32_t channel)
{
    return mps__channels_of(t->channels, t->particles, channel);
}

static mps__array *field_of(mps__memory *t, int32_t field)
{
    return mps__field_array(&t->particles->field[field]);
}

/* ---- a device ---- */

void mps__memory_init(mps__memory *t, mps__channels *c, mps__particles *s, mps_parallel *parallel)
{
    *t = (mps__memory){.channels = c,
                       .particles = s,
                       .parallel = parallel,
                       .logged = -1,
                       .logged_solution = -1,
                       .listed = -1};
    mps__device_init(&t->device, c->context);
    t->last.struct_size = sizeof t->last;
}

void mps__memory_free(mps__memory *t)
{
    if (!t->channels) return; /* initialisation ran out of memory */
    for (int32_t k = 0; k < t->channels->count; k++)
        mps__array_release(&t->channels->list[k].array);
    for (int32_t k = 0; k < t->particles->fields; k++) mps__array_release(field_of(t, k));
    for (int32_t k = 0; k < MPS__BLOCKS; k++) mps__array_release(&t->block[k]);
    for (int32_t k = 0; k < MPS__SCRATCH; k++) mps__array_release(&t->scratch[k]);
    mps__array_release(&t->order);
    mps__array_release(&t->results);
    mps__array_release(&t->constants);
    if (t->constant) mps__free(t->device.context, t->constant);
    mps__device_end(&t->device);
    mps__memory_init(t, t->channels, t->particles, t->parallel);
}

mps_status mps__memory_attach(mps__memory *t, const mps_device_ops *ops)
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
    mps__memory_free(t);
    t->device = device;
    if (t->device.ops.name) t->device.parallel.user = t->device.memory.user = &t->device;
    t->constant = constant;
    return MPS_OK;
}

/* ---- start and end of a step ---- */

static size_t number_of(const mps__memory *t, int32_t channel)
{
    return t->channels->list[channel].spec.type == MPS_TYPE_INTEGER ? sizeof(int32_t)
                                                                    : sizeof(double);
}

/* Allocate the device array; its values are on the host. */
static mps_status open_array(mps__memory *t, mps__array *a, size_t element, size_t number)
{
    MPS__TRY(mps__array_fit(a, &t->device, (size_t)t->particles->n * element, number));
    mps__array_invalidate(a, MPS__ON_DEVICE);
    return MPS_OK;
}

static mps_status open_channel(mps__memory *t, int32_t channel)
{
    mps__array *a = array_of(t, channel);
    if (!a || a->bytes > 0 || channel >= MPS__CHANNELS) return MPS_OK;
    return open_array(t, a, mps__channels_bytes(t->channels, t->particles, channel),
                      number_of(t, channel));
}

/* Allocate the device arrays of all fields, including fields that no call declares. */
static mps_status open_fields(mps__memory *t)
{
    for (int32_t k = 0; k < t->particles->fields; k++) {
        const mps__field *f = &t->particles->field[k];
        mps__array *a = field_of(t, k);
        if (a->bytes != (size_t)t->particles->n * mps__field_element(f))
            MPS__TRY(open_array(t, a, mps__field_element(f), f->size));
    }
    return MPS_OK;
}

static mps_status open_constants(mps__memory *t)
{
    if (t->constants.bytes > 0) return MPS_OK;
    MPS__TRY(mps__array_fit(&t->constants, &t->device, CONSTANTS * sizeof(double), sizeof(double)));
    memset(t->constant, 0, CONSTANTS * sizeof(double));
    mps__device_clear(&t->device, t->constants.mirror.data, t->constants.bytes);
    return MPS_OK;
}

void mps__memory_begin(mps__memory *t)
{
    t->step = mps__device_present(&t->device);
    if (t->step) mps__device_begin(&t->device);
}

mps_status mps__memory_enter(mps__memory *t)
{
    MPS__TRY(open_constants(t));
    MPS__TRY(open_fields(t));
    t->open = true;
    mps__memory_set_space(t, MPS__ON_DEVICE);
    return MPS_OK;
}

mps_status mps__memory_exit(mps__memory *t)
{
    mps__memory_set_space(t, MPS__ON_HOST);
    t->open = false;
    return mps__device_status(&t->device);
}

mps_status mps__memory_open(mps__memory *t, const mps__plan *p)
{
    int32_t flux[MPS__FLUX_CHANNELS];
    if (!t->step) return MPS_OK;
    for (int32_t k = 0; k < t->channels->count; k++) t->channels->list[k].array.bytes = 0;
    MPS__TRY(open_constants(t));
    MPS__TRY(mps__array_fit(&t->results, &t->device, sizeof(mps__results), sizeof(double)));
    MPS__TRY(open_fields(t));
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT]; k++)
        for (int32_t u = 0; u < p->call[k].use_count; u++)
            MPS__TRY(open_channel(t, p->call[k].channel[u]));
    mps__flux_channels(t->channels, flux);
    for (int f = 0; f < MPS__FLUX_CHANNELS; f++) MPS__TRY(open_channel(t, flux[f]));
    t->open = true;
    return mps__device_status(&t->device);
}

mps_status mps__memory_block(mps__memory *t, int32_t block, void *host, int64_t count,
                             size_t number, bool values)
{
    mps__array *a = &t->block[block];
    if (!t->open || !host || count == 0) return MPS_OK;
    /* lists grow slightly from step to step */
    const size_t bytes = (size_t)count * number;
    if (bytes > a->mirror.bytes) MPS__TRY(mps__array_fit(a, &t->device, bytes + bytes / 8, number));
    MPS__TRY(mps__array_fit(a, &t->device, bytes, number));
    a->host = host;
    mps__array_invalidate(a, MPS__ON_DEVICE);
    if (!values) a->version_in[MPS__ON_DEVICE] = a->version;
    return MPS_OK;
}

mps_status mps__memory_close(mps__memory *t)
{
    if (!t->step) return MPS_OK;
    mps__memory_set_space(t, MPS__ON_HOST);
    for (int32_t k = MPS__LASTING; k < MPS__BLOCKS; k++) t->block[k].bytes = 0;
    if (t->device.failed) mps__memory_rows_lose(t);
    t->last = t->device.info;
    t->open = t->step = false;
    const mps_status status = mps__device_status(&t->device);
    t->device.failed = false; /* the next step may succeed */
    return status;
}

/* ---- where loops run ---- */

int32_t mps__memory_set_space(mps__memory *t, int32_t space)
{
    const int32_t before = t->space;
    if (!t->open || space == before) return before;
    if (space == MPS__ON_DEVICE) {
        t->host_parallel = *t->parallel;
        *t->parallel = t->device.parallel;
    } else {
        *t->parallel = t->host_parallel;
    }
    t->space = space;
    return before;
}

static void *address(const mps__memory *t, const mps__array *a)
{
    return t->space == MPS__ON_DEVICE ? a->mirror.data : a->host;
}

void *mps__memory_read(mps__memory *t, int32_t field)
{
    mps__array *a = field_of(t, field);
    if (t->open) mps__array_copy(a, t->space);
    return address(t, a);
}

void *mps__memory_write(mps__memory *t, int32_t field)
{
    mps__array *a = field_of(t, field);
    mps__array_written(a, t->space);
    return address(t, a);
}

static mps__array *block_of(mps__memory *t, int32_t block, const void *host)
{
    mps__array *a = &t->block[block];
    return t->open && a->bytes > 0 && a->host == host ? a : NULL;
}

void *mps__memory_list_seen(mps__memory *t, int32_t block, const void *host)
{
    mps__array *a = block_of(t, block, host);
    if (!a) return (void *)host;
    if (t->space == MPS__ON_DEVICE) mps__array_copy(a, t->space);
    return address(t, a);
}

/* Lists of a search stay readable on the host when their rows change on the device: there they hold
 * an older partition of the same candidates, from which the rows can be rebuilt if the device
 * fails. */
void *mps__memory_list_given(mps__memory *t, int32_t block, void *host, bool all)
{
    mps__array *a = block_of(t, block, host);
    if (!a) return host;
    if (!all) mps__array_copy(a, t->space);
    if (!all && block < MPS__LASTING && t->space == MPS__ON_DEVICE)
        mps__array_advanced(a, t->space);
    else
        mps__array_written(a, t->space);
    return address(t, a);
}

/* Rows of pairs: those of the last search, or the compact near rows. */
static void see_pairs(mps__memory *t, mps_stencil *s)
{
    if (!s->begin) return;
    if (s->x) s->x = mps__memory_read(t, MPS__FIELD_POSITION);
    if (block_of(t, MPS__NEAR_BEGIN, s->begin)) {
        s->begin = mps__memory_list_seen(t, MPS__NEAR_BEGIN, s->begin);
        s->end = s->begin + 1;
        s->col = mps__memory_list_seen(t, MPS__NEAR_COLUMNS, s->col);
        s->w_r2 = mps__memory_list_seen(t, MPS__NEAR_WEIGHTS, s->w_r2);
        return;
    }
    const bool middle = block_of(t, MPS__ROWS_MIDDLE, s->end);
    s->begin = mps__memory_list_seen(t, MPS__ROWS_BEGIN, s->begin);
    s->end = mps__memory_list_seen(t, middle ? MPS__ROWS_MIDDLE : MPS__ROWS_END, s->end);
    s->col = mps__memory_list_seen(t, MPS__ROWS_COLUMNS, s->col);
}

static void see_flux(mps__memory *t, mps_flux *f)
{
    int32_t channel[MPS__FLUX_CHANNELS];
    if (!f->density) return;
    mps__flux_channels(t->channels, channel);
    f->kind = mps__memory_read(t, MPS__FIELD_KIND);
    f->phase = mps__memory_read(t, MPS__FIELD_PHASE);
    f->density = mps__memory_array(t, channel[0], MPS__ON_DEVICE);
    f->tank_acceleration = mps__memory_array(t, channel[1], MPS__ON_DEVICE);
    f->distance = mps__memory_array(t, channel[2], MPS__ON_DEVICE);
    f->jump = mps__memory_array(t, channel[3], MPS__ON_DEVICE);
    f->wetted = mps__memory_array(t, channel[4], MPS__ON_DEVICE);
}

void mps__memory_view(mps__memory *t, mps_view *v)
{
    if (t->space == MPS__ON_HOST) return;
    const bool on_device = v->kind == field_of(t, MPS__FIELD_KIND)->mirror.data,
               turned = block_of(t, MPS__ROTATED_AREAS, v->area);
    v->kind = mps__memory_read(t, MPS__FIELD_KIND);
    v->phase = mps__memory_read(t, MPS__FIELD_PHASE);
    v->id = mps__memory_read(t, MPS__FIELD_ID);
    v->x = mps__memory_read(t, MPS__FIELD_POSITION);
    v->wall_of = mps__memory_read(t, MPS__FIELD_WALL_OF);
    if (on_device) return; /* the other arrays, too, are those of the device */
    if (v->area)
        v->area = turned ? mps__memory_list_seen(t, MPS__ROTATED_AREAS, v->area)
                         : mps__memory_read(t, MPS__FIELD_AREA);
    see_pairs(t, &v->near);
    see_pairs(t, &v->far);
    see_flux(t, &v->flux);
}

/* Constants from number `first` on; copied if they have changed. */
static const double *constants(mps__memory *t, int32_t first, int32_t count, const double *values)
{
    double *on_device = (double *)t->constants.mirror.data + first;
    if (!values) return NULL;
    if (memcmp(t->constant + first, values, (size_t)count * sizeof *values) != 0) {
        memcpy(t->constant + first, values, (size_t)count * sizeof *values);
        mps__device_upload(&t->device, on_device, values, (size_t)count * sizeof *values);
    }
    return on_device;
}

void mps__memory_loop_view(mps__memory *t, int32_t model, mps_view *v)
{
    mps__memory_view(t, v);
    v->viscosity = constants(t, VISCOSITIES, MPS__PHASES, v->viscosity);
    v->tension = constants(t, TENSIONS, MPS__PHASES * MPS__PHASES, v->tension);
    v->setting = constants(t, model * MPS__SETTINGS, MPS__SETTINGS, v->setting);
}

void *mps__memory_workspace(mps__memory *t, int32_t block, size_t bytes)
{
    mps__array *a = &t->scratch[block];
    if (mps__array_fit(a, &t->device, bytes > 0 ? bytes : sizeof(double), sizeof(double)) < 0)
        return NULL;
    return a->mirror.data;
}

void *mps__memory_scratch(mps__memory *t, int32_t block, size_t bytes)
{
    void *array = mps__memory_workspace(t, block, bytes);
    if (array) mps__device_clear(&t->device, array, t->scratch[block].bytes);
    return array;
}
