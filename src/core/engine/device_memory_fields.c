/* SPDX-License-Identifier: BSD-3-Clause */
/* Mirrored fields and lists of the particles, during a step and between steps: they stay on the
 * device until the host requests them. */
#include "device_memory.h"
#include <stdio.h>

bool mps__memory_on_device(const mps__memory *t)
{
    bool any = false;
    for (int32_t k = 0; t->step && k < t->particles->fields && !any; k++)
        any = mps__array_valid(&t->particles->field[k].array, MPS__ON_DEVICE);
    return any;
}

static mps__array *field_of(mps__memory *t, int32_t field)
{
    return mps__field_array(&t->particles->field[field]);
}

/* ---- to the host ---- */

/* Add copies outside of a step to the counters of the previous step. Failed copies may be
 * repeated. */
static mps_status count_copies(mps__memory *t, const mps_device_info *before)
{
    const mps_device_info *now = &t->device.info;
    const mps_status status = mps__device_status(&t->device);
    if (t->step) return status;
    t->last.waits += now->waits - before->waits;
    t->last.downloads += now->downloads - before->downloads;
    t->last.bytes_down += now->bytes_down - before->bytes_down;
    t->device.failed = false;
    return status;
}

mps_status mps__memory_alive(const mps__memory *t)
{
    return t->lost[0] ? mps__fail(t->device.context, MPS_E_PLUGIN, "%s", t->lost) : MPS_OK;
}

/* Fields k with first <= k < end. */
static mps_status fetch(mps__memory *t, int32_t first, int32_t end)
{
    const mps_device_info before = t->device.info;
    MPS__TRY(mps__memory_alive(t));
    for (int32_t k = first; k < end; k++) mps__array_copy(field_of(t, k), MPS__ON_HOST);
    return count_copies(t, &before);
}

mps_status mps__memory_fetch(mps__memory *t)
{
    return fetch(t, 0, t->particles->fields);
}

mps_status mps__memory_fetch_field(mps__memory *t, int32_t field)
{
    return fetch(t, field, field + 1);
}

void mps__memory_forget(mps__memory *t)
{
    mps__particles_written(t->particles);
    t->lost[0] = 0;
}

static void blocks_ready(mps__memory *t, int32_t end)
{
    for (int32_t k = 0; k < end; k++) mps__array_copy(&t->block[k], MPS__ON_HOST);
    t->torn = t->device.failed;
}

/* Rows that changed on the device since their last copy are another partition of candidates that
 * the host already has. */
static bool lacks_candidates(const mps__memory *t)
{
    return t->torn || !mps__array_valid(&t->block[MPS__NEAR_DUMMIES], MPS__ON_HOST);
}

mps_status mps__memory_fetch_lists(mps__memory *t)
{
    const mps_device_info before = t->device.info;
    MPS__TRY(mps__memory_alive(t));
    if (lacks_candidates(t)) blocks_ready(t, MPS__LASTING);
    return count_copies(t, &before);
}

mps_status mps__memory_fetch_searched(mps__memory *t)
{
    const mps_device_info before = t->device.info;
    MPS__TRY(mps__memory_alive(t));
    mps__array_copy(&t->block[MPS__SEARCHED], MPS__ON_HOST);
    return count_copies(t, &before);
}

void mps__memory_sync_rows(mps__memory *t)
{
    if (t->step) blocks_ready(t, MPS__LASTING);
}

void mps__memory_sync_lists(mps__memory *t)
{
    if (t->step) blocks_ready(t, MPS__BLOCKS);
}

void mps__memory_rows_drop(mps__memory *t)
{
    for (int k = 0; k < MPS__LASTING; k++) t->block[k].bytes = 0;
    t->listed = -1;
    t->torn = false;
}

void mps__memory_rows_lose(mps__memory *t)
{
    const mps__array searched = t->block[MPS__SEARCHED];
    const bool torn = lacks_candidates(t);
    mps__memory_rows_drop(t);
    t->torn = torn;
    t->block[MPS__SEARCHED] = searched; /* positions stay requested until they are copied */
}

/* ---- a failed step ---- */

mps_status mps__memory_restored(mps__memory *t, double time)
{
    mps__device_wait(&t->device); /* some devices report a failed copy only here */
    if (!t->device.failed) return MPS_OK;
    t->device.failed = false;
    snprintf(t->lost, sizeof t->lost,
             "t = %.9g s: device '%s' failed: %.200s; the newest fields were on the device "
             "only: read a checkpoint or restore a snapshot",
             time, t->device.ops.name, t->device.why);
    return mps__memory_alive(t);
}

/* ---- permutation ---- */

static mps_status permute_field(mps__memory *t, mps__array *a, const mps__field *f,
                                const int32_t *order)
{
    if (!mps__device_fit(&t->device, &a->spare, a->bytes)) return MPS_E_NOMEM;
    mps__particles_permute_values(t->parallel, a->spare.data, a->mirror.data, t->particles->n,
                                  order, mps__field_element(f));
    return MPS_OK;
}

mps_status mps__memory_permute(mps__memory *t, const int32_t *order, const int32_t *on_device,
                               bool *moved, bool *stale)
{
    mps__particles *s = t->particles;
    mps_status status = MPS_OK;
    const bool any = mps__memory_on_device(t) && s->n > 0;
    for (int32_t k = 0; k < s->fields; k++) {
        stale[k] = !mps__array_valid(field_of(t, k), MPS__ON_HOST);
        /* new indices of walls are found on the host */
        moved[k] = any && k != MPS__FIELD_WALL_OF &&
                   mps__array_valid(field_of(t, k), MPS__ON_DEVICE);
    }
    if (!any) return MPS_OK;
    MPS__TRY(mps__memory_enter(t));
    if (!on_device) {
        status = mps__array_fit(&t->order, &t->device, (size_t)s->n * sizeof *order, sizeof *order);
        if (status == MPS_OK)
            mps__device_upload(&t->device, t->order.mirror.data, order, t->order.bytes);
        on_device = t->order.mirror.data;
    }
    for (int32_t k = 0; k < s->fields && status == MPS_OK; k++)
        if (moved[k]) status = permute_field(t, field_of(t, k), &s->field[k], on_device);
    const mps_status left = mps__memory_exit(t);
    return status < 0 ? status : left;
}

void mps__memory_permuted(mps__memory *t, const bool *moved)
{
    for (int32_t k = 0; k < t->particles->fields; k++)
        if (moved[k]) mps__array_exchange(field_of(t, k));
}

/* ---- values ---- */

static mps__array *array_of(mps__memory *t, int32_t channel)
{
    return mps__channels_of(t->channels, t->particles, channel);
}

void mps__memory_sync(mps__memory *t, int32_t channel, int32_t space)
{
    mps__array *a = t->open ? array_of(t, channel) : NULL;
    if (a) mps__array_copy(a, space);
}

void mps__memory_sync_fields(mps__memory *t)
{
    for (int32_t k = 0; t->open && k < t->particles->fields; k++)
        mps__array_copy(field_of(t, k), MPS__ON_HOST);
}

void mps__memory_written(mps__memory *t, int32_t channel, int32_t space)
{
    mps__array *a = array_of(t, channel);
    if (a) mps__array_written(a, space);
}

/* On the device if both copies are valid. */
static mps__halo_array shared_of(mps__memory *t, mps__array *a, size_t element)
{
    const bool on_device = t->open && a->bytes > 0 && mps__array_valid(a, MPS__ON_DEVICE);
    mps__array_written(a, on_device ? MPS__ON_DEVICE : MPS__ON_HOST);
    mps__array_ghosts_set(a, true);
    return (mps__halo_array){on_device ? a->mirror.data : a->host, element, on_device};
}

mps__halo_array mps__memory_halo(mps__memory *t, int32_t channel)
{
    return shared_of(t, array_of(t, channel),
                     mps__channels_bytes(t->channels, t->particles, channel));
}

mps__halo_array mps__memory_halo_field(mps__memory *t, int32_t field)
{
    return shared_of(t, field_of(t, field), mps__field_element(&t->particles->field[field]));
}

void *mps__memory_array(mps__memory *t, int32_t channel, int32_t space)
{
    const mps__array *a = space == MPS__ON_DEVICE ? array_of(t, channel) : NULL;
    return a ? a->mirror.data : mps__channels_array(t->channels, t->particles, channel);
}
