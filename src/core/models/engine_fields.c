/* SPDX-License-Identifier: BSD-3-Clause */
/* Mirrored fields and lists of the particles, during a step and between steps: they stay on the
 * device until the host requests them. */
#include "engine.h"
#include <stdio.h>

bool mps__twins_there(const mps__twins *t)
{
    bool any = false;
    for (int32_t k = 0; t->step && k < t->particles->fields && !any; k++)
        any = mps__array_valid(&t->particles->field[k].array, MPS__ON_DEVICE);
    return any;
}

static mps__array *field_of(mps__twins *t, int32_t field)
{
    return mps__field_array(&t->particles->field[field]);
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
    for (int32_t k = first; k < end; k++) mps__array_copy(field_of(t, k), MPS__ON_HOST);
    return came(t, &before);
}

mps_status mps__twins_fetch(mps__twins *t)
{
    return fetch(t, 0, t->particles->fields);
}

mps_status mps__twins_fetch_field(mps__twins *t, int32_t field)
{
    return fetch(t, field, field + 1);
}

void mps__twins_forget(mps__twins *t)
{
    mps__particles_written(t->particles);
    t->gone[0] = 0;
}

static void blocks_ready(mps__twins *t, int32_t end)
{
    for (int32_t k = 0; k < end; k++) mps__array_copy(&t->block[k], MPS__ON_HOST);
    t->torn = t->device.failed;
}

/* Rows that changed on the device since their last copy are another partition of candidates that
 * the host already has. */
static bool lacks_candidates(const mps__twins *t)
{
    return t->torn || !mps__array_valid(&t->block[MPS__RIM_ROWS], MPS__ON_HOST);
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
    MPS__TRY(mps__twins_alive(t));
    mps__array_copy(&t->block[MPS__SEARCHED], MPS__ON_HOST);
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
    const mps__array searched = t->block[MPS__SEARCHED];
    const bool torn = lacks_candidates(t);
    mps__twins_rows_drop(t);
    t->torn = torn;
    t->block[MPS__SEARCHED] = searched; /* positions stay requested until they are copied */
}

/* ---- a failed step ---- */

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

static mps_status permute_field(mps__twins *t, mps__array *a, const mps__field *f,
                                const int32_t *order)
{
    if (!mps__device_fit(&t->device, &a->spare, a->bytes)) return MPS_E_NOMEM;
    mps__particles_gather(t->parallel, a->spare.data, a->mirror.data, t->particles->n, order,
                          mps__field_element(f));
    return MPS_OK;
}

mps_status mps__twins_permute(mps__twins *t, const int32_t *order, const int32_t *there,
                              bool *moved, bool *old)
{
    mps__particles *s = t->particles;
    mps_status status = MPS_OK;
    const bool any = mps__twins_there(t) && s->n > 0;
    for (int32_t k = 0; k < s->fields; k++) {
        old[k] = !mps__array_valid(field_of(t, k), MPS__ON_HOST);
        /* new indices of walls are found on the host */
        moved[k] = any && k != MPS__FIELD_WALL_OF &&
                   mps__array_valid(field_of(t, k), MPS__ON_DEVICE);
    }
    if (!any) return MPS_OK;
    MPS__TRY(mps__twins_enter(t));
    if (!there) {
        status = mps__array_fit(&t->order, &t->device, (size_t)s->n * sizeof *order, sizeof *order);
        if (status == MPS_OK)
            mps__device_upload(&t->device, t->order.mirror.data, order, t->order.bytes);
        there = t->order.mirror.data;
    }
    for (int32_t k = 0; k < s->fields && status == MPS_OK; k++)
        if (moved[k]) status = permute_field(t, field_of(t, k), &s->field[k], there);
    const mps_status left = mps__twins_leave(t);
    return status < 0 ? status : left;
}

void mps__twins_permuted(mps__twins *t, const bool *moved)
{
    for (int32_t k = 0; k < t->particles->fields; k++)
        if (moved[k]) mps__array_exchange(field_of(t, k));
}

/* ---- values ---- */

static mps__array *array_of(mps__twins *t, int32_t channel)
{
    return mps__channels_of(t->channels, t->particles, channel);
}

void mps__twins_ready(mps__twins *t, int32_t channel, int32_t place)
{
    mps__array *a = t->open ? array_of(t, channel) : NULL;
    if (a) mps__array_copy(a, place);
}

void mps__twins_fields_ready(mps__twins *t)
{
    for (int32_t k = 0; t->open && k < t->particles->fields; k++)
        mps__array_copy(field_of(t, k), MPS__ON_HOST);
}

void mps__twins_written(mps__twins *t, int32_t channel, int32_t place)
{
    mps__array *a = array_of(t, channel);
    if (a) mps__array_written(a, place);
}

/* On the device if both copies are valid. */
static mps__shared shared_of(mps__twins *t, mps__array *a, size_t element)
{
    const bool there = t->open && a->bytes > 0 && mps__array_valid(a, MPS__ON_DEVICE);
    mps__array_written(a, there ? MPS__ON_DEVICE : MPS__ON_HOST);
    mps__array_ghosts_set(a, true);
    return (mps__shared){there ? a->mirror.data : a->host, element, there};
}

mps__shared mps__twins_shared(mps__twins *t, int32_t channel)
{
    return shared_of(t, array_of(t, channel),
                     mps__channels_bytes(t->channels, t->particles, channel));
}

mps__shared mps__twins_shared_field(mps__twins *t, int32_t field)
{
    return shared_of(t, field_of(t, field), mps__field_element(&t->particles->field[field]));
}

void *mps__twins_array(mps__twins *t, int32_t channel, int32_t place)
{
    const mps__array *a = place == MPS__ON_DEVICE ? array_of(t, channel) : NULL;
    return a ? a->mirror.data : mps__channels_array(t->channels, t->particles, channel);
}
