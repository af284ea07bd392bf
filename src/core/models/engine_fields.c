/* SPDX-License-Identifier: BSD-3-Clause */
/* Mirrored fields and lists of the particles, during a step and between steps: they stay on the
 * device until the host requests them. */
#include "engine_twin.h"
#include <stdio.h>

bool mps__twins_there(const mps__twins *t)
{
    return t->step && t->changes == t->particles->changes;
}

/* ---- to the host ---- */

/* Add copies outside of a step to the counters of the previous step. Failed copies may be
 * repeated. */
static mps_status came(mps__twins *t, const mps_device_info *before)
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

mps_status mps__twins_alive(const mps__twins *t)
{
    return t->gone[0] ? mps__fail(t->device.context, MPS_E_PLUGIN, "%s", t->gone) : MPS_OK;
}

/* Fields k with first <= k < end. */
static mps_status fetch(mps__twins *t, int32_t first, int32_t end)
{
    const mps_device_info before = t->device.info;
    MPS__TRY(mps__twins_alive(t));
    for (int32_t k = first; k < end; k++)
        mps__twin_copy(t, mps__twin_of_field(t, k), *t->particles->field[k].data, MPS__ON_HOST);
    return came(t, &before);
}

mps_status mps__twins_fetch(mps__twins *t)
{
    return fetch(t, 0, t->particles->fields);
}

mps_status mps__twins_fetch_field(mps__twins *t, const void *array)
{
    int32_t k = 0;
    while (k < t->particles->fields && *t->particles->field[k].data != array) k++;
    return k < t->particles->fields ? fetch(t, k, k + 1) : MPS_OK;
}

void mps__twins_changed(mps__twins *t, const void *array)
{
    for (int32_t k = 0; k < t->particles->fields; k++) {
        mps__twin *twin = mps__twin_of_field(t, k);
        void *host = *t->particles->field[k].data;
        if (host == array && twin->bytes > 0) mps__twin_change(t, twin, host, MPS__ON_HOST, true);
    }
}

void mps__twins_changed_alone(mps__twins *t, const void *array, int64_t changes)
{
    if (t->changes != changes) return;
    mps__twins_changed(t, array);
    t->changes = t->particles->changes;
}

void mps__twins_forget(mps__twins *t)
{
    for (int32_t k = 0; k < t->particles->fields; k++)
        mps__twin_of_field(t, k)->old[MPS__ON_HOST] = false;
    t->changes = -1;
    t->gone[0] = 0;
}

static void blocks_ready(mps__twins *t, int32_t end)
{
    for (int32_t k = 0; k < end; k++)
        mps__twin_copy(t, &t->block[k], t->block[k].host, MPS__ON_HOST);
    t->torn = t->device.failed;
}

/* Rows that changed on the device since their last copy are another partition of candidates that
 * the host already has. */
static bool lacks_candidates(const mps__twins *t)
{
    const mps__twin *rim = &t->block[MPS__RIM_ROWS];
    return t->torn || (rim->bytes > 0 && rim->old[MPS__ON_HOST]);
}

mps_status mps__twins_fetch_lists(mps__twins *t)
{
    const mps_device_info before = t->device.info;
    MPS__TRY(mps__twins_alive(t));
    if (lacks_candidates(t)) blocks_ready(t, MPS__LASTING);
    return came(t, &before);
}

mps_status mps__twins_fetch_searched(mps__twins *t)
{
    const mps_device_info before = t->device.info;
    mps__twin *twin = &t->block[MPS__SEARCHED];
    MPS__TRY(mps__twins_alive(t));
    mps__twin_copy(t, twin, twin->host, MPS__ON_HOST);
    return came(t, &before);
}

void mps__twins_rows_ready(mps__twins *t)
{
    if (t->step) blocks_ready(t, MPS__LASTING);
}

void mps__twins_lists_ready(mps__twins *t)
{
    if (t->step) blocks_ready(t, MPS__BLOCKS);
}

void mps__twins_rows_drop(mps__twins *t)
{
    for (int k = 0; k < MPS__LASTING; k++) t->block[k].bytes = 0;
    t->listed = -1;
    t->torn = false;
}

void mps__twins_rows_lose(mps__twins *t)
{
    const mps__twin searched = t->block[MPS__SEARCHED];
    const bool torn = lacks_candidates(t);
    mps__twins_rows_drop(t);
    t->torn = torn;
    t->block[MPS__SEARCHED] = searched; /* positions stay requested until they are copied */
}

/* ---- a failed step ---- */

mps_status mps__twins_keep(mps__twins *t, int32_t field, bool *kept)
{
    mps__twin *twin = mps__twin_of_field(t, field);
    *kept = mps__twins_there(t) && twin->bytes > 0 && twin->old[MPS__ON_HOST];
    if (!*kept) return MPS_OK;
    if (!mps__device_fit(&t->device, &twin->spare, twin->bytes)) return MPS_E_NOMEM;
    mps__device_copy(&t->device, twin->spare.data, twin->data, twin->bytes);
    return mps__device_status(&t->device);
}

void mps__twins_restore(mps__twins *t, int32_t field, bool kept)
{
    mps__twin *twin = mps__twin_of_field(t, field);
    void *host = *t->particles->field[field].data;
    if (twin->bytes == 0) return;
    if (kept) mps__device_copy(&t->device, twin->data, twin->spare.data, twin->bytes);
    mps__twin_change(t, twin, host, kept ? MPS__ON_DEVICE : MPS__ON_HOST, true);
}

mps_status mps__twins_restored(mps__twins *t, double time)
{
    mps__device_wait(&t->device); /* some devices report a failed copy only here */
    if (!t->device.failed) return MPS_OK;
    t->device.failed = false;
    snprintf(t->gone, sizeof t->gone,
             "t = %.9g s: device '%s' failed: %.200s; the fields of the particles were there "
             "alone: read a checkpoint or restore a snapshot",
             time, t->device.ops.name, t->device.why);
    return mps__twins_alive(t);
}

/* ---- permutation ---- */

static bool moves(const mps__twin *twin)
{
    return twin->bytes > 0 && !twin->old[MPS__ON_DEVICE];
}

static mps_status permute_field(mps__twins *t, mps__twin *twin, const mps__field *f,
                                const int32_t *order)
{
    if (!moves(twin)) return MPS_OK;
    if (!mps__device_fit(&t->device, &twin->spare, twin->bytes)) return MPS_E_NOMEM;
    mps__particles_gather(t->parallel, twin->spare.data, twin->data, t->particles->n, order,
                          (size_t)f->components * f->size);
    return MPS_OK;
}

mps_status mps__twins_permute(mps__twins *t, const int32_t *order, const int32_t *there)
{
    mps__particles *s = t->particles;
    mps_status status = MPS_OK;
    if (!mps__twins_there(t) || s->n == 0) return MPS_OK;
    MPS__TRY(mps__twins_enter(t));
    if (!there) {
        status = mps__twin_fit(t, &t->order, (size_t)s->n * sizeof *order, sizeof *order);
        if (status == MPS_OK) mps__device_upload(&t->device, t->order.data, order, t->order.bytes);
        there = t->order.data;
    }
    for (int32_t k = 0; k < s->fields && status == MPS_OK; k++)
        status = permute_field(t, mps__twin_of_field(t, k), &s->field[k], there);
    const mps_status left = mps__twins_leave(t);
    return status < 0 ? status : left;
}

void mps__twins_old(mps__twins *t, bool *old)
{
    for (int32_t k = 0; k < t->particles->fields; k++) {
        const mps__twin *twin = mps__twin_of_field(t, k);
        old[k] = twin->bytes > 0 && twin->old[MPS__ON_HOST];
    }
}

void mps__twins_permuted(mps__twins *t, int64_t changes)
{
    const mps__particles *s = t->particles;
    if (!t->step || t->changes != changes) return;
    for (int32_t k = 0; k < s->fields; k++) {
        mps__twin *twin = mps__twin_of_field(t, k);
        const mps__twin before = *twin;
        if (!moves(twin)) continue;
        twin->data = before.spare.data;
        twin->room = before.spare.bytes;
        twin->spare = (mps__device_block){before.data, before.room};
        /* indices of walls have changed */
        if (s->changes != changes && s->field[k].data == (void **)&s->wall_of)
            mps__twins_changed(t, s->wall_of);
    }
    t->changes = s->changes;
}

/* ---- values ---- */

void mps__twins_ready(mps__twins *t, int32_t channel, int32_t place)
{
    mps__twin *twin = t->open ? mps__twin_of(t, channel) : NULL;
    if (twin)
        mps__twin_copy(t, twin, mps__channels_array(t->channels, t->particles, channel), place);
}

void mps__twins_fields_ready(mps__twins *t)
{
    for (int32_t k = 0; t->open && k < t->particles->fields; k++)
        mps__twin_copy(t, mps__twin_of_field(t, k), *t->particles->field[k].data, MPS__ON_HOST);
}

void mps__twins_written(mps__twins *t, int32_t channel, int32_t place)
{
    mps__twin *twin = t->open ? mps__twin_of(t, channel) : NULL;
    void *host = mps__channels_array(t->channels, t->particles, channel);
    if (twin) mps__twin_change(t, twin, host, place, true);
}

/* Use the device if both copies are valid. */
static mps__shared shared_of(mps__twins *t, mps__twin *twin, void *host, size_t bytes)
{
    const bool there = t->open && twin && twin->bytes > 0 && !twin->old[MPS__ON_DEVICE];
    if (t->open && twin)
        mps__twin_change(t, twin, host, there ? MPS__ON_DEVICE : MPS__ON_HOST, false);
    return (mps__shared){there ? twin->data : host, bytes, there};
}

mps__shared mps__twins_shared(mps__twins *t, int32_t channel)
{
    return shared_of(t, t->open ? mps__twin_of(t, channel) : NULL,
                     mps__channels_array(t->channels, t->particles, channel),
                     mps__channels_bytes(t->channels, t->particles, channel));
}

mps__shared mps__twins_shared_field(mps__twins *t, int32_t field)
{
    const mps__field *f = &t->particles->field[field];
    return shared_of(t, mps__twin_of_field(t, field), *f->data, (size_t)f->components * f->size);
}

void *mps__twins_array(mps__twins *t, int32_t channel, int32_t place)
{
    const mps__twin *twin = place == MPS__ON_DEVICE ? mps__twin_of(t, channel) : NULL;
    return twin ? twin->data : mps__channels_array(t->channels, t->particles, channel);
}
