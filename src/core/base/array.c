/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays in two memory spaces. */
#include "array.h"
#include <string.h>

/* ---- values ---- */

void mps__array_copy(mps__array *a, int32_t space)
{
    if (!a->device || mps__array_valid(a, space)) return;
    if (space == MPS__ON_DEVICE)
        mps__device_upload(a->device, a->mirror.data, a->host, a->bytes);
    else
        mps__device_download(a->device, a->host, a->mirror.data, a->bytes);
    if (!a->device->failed) a->version_in[space] = a->version;
}

static int32_t other_than(int32_t space)
{
    return space == MPS__ON_HOST ? MPS__ON_DEVICE : MPS__ON_HOST;
}

void mps__array_advanced(mps__array *a, int32_t space)
{
    const bool ghosts = mps__array_ghosts_valid(a);
    a->version_in[space] = ++a->version;
    if (ghosts) a->ghosts = a->version;
}

void mps__array_invalidate(mps__array *a, int32_t space)
{
    a->version_in[space] = -1;
    if (a->bytes > 0)
        mps__device_invalidate(a->device, space == MPS__ON_HOST ? a->host : a->mirror.data,
                               a->bytes, a->number);
}

void mps__array_written(mps__array *a, int32_t space)
{
    const int32_t other = other_than(space);
    const bool was_valid = mps__array_valid(a, other);
    mps__array_advanced(a, space);
    if (was_valid) mps__array_invalidate(a, other);
}

/* ---- memory ---- */

void mps__array_release(mps__array *a)
{
    if (a->device) {
        mps__device_release(a->device, &a->spare);
        mps__device_release(a->device, &a->mirror);
    }
    a->bytes = 0;
    a->device = NULL;
    a->version_in[MPS__ON_HOST] = a->version;
    a->version_in[MPS__ON_DEVICE] = -1;
}

mps_status mps__array_fit(mps__array *a, mps__device *d, size_t bytes, size_t number)
{
    if (bytes > a->mirror.bytes) {
        mps__array_release(a);
        a->mirror.data = mps__device_alloc(d, bytes);
        if (!a->mirror.data) return MPS_E_NOMEM;
        a->mirror.bytes = bytes;
    }
    a->device = d;
    a->bytes = bytes;
    a->number = number;
    a->version_in[MPS__ON_HOST] = a->version;
    a->version_in[MPS__ON_DEVICE] = -1;
    return MPS_OK;
}

void mps__array_exchange(mps__array *a)
{
    const mps__device_block before = a->mirror;
    a->mirror = a->spare;
    a->spare = before;
    a->version_in[MPS__ON_DEVICE] = a->version;
}

/* ---- copies ---- */

mps_status mps__array_keep(mps__array *a, mps__context *c, const mps_parallel *p, size_t bytes)
{
    const int64_t size = (int64_t)bytes;
    a->kept_in = mps__array_valid(a, MPS__ON_HOST) ? MPS__ON_HOST : MPS__ON_DEVICE;
    if (a->kept_in == MPS__ON_DEVICE) {
        if (!mps__device_fit(a->device, &a->spare, bytes)) return MPS_E_NOMEM;
        mps__device_copy(a->device, a->spare.data, a->mirror.data, bytes);
        return mps__device_status(a->device);
    }
    if (size > a->kept_capacity)
        MPS__TRY(mps__grow(c, &a->kept, &a->kept_capacity, 0,
                           mps__capacity_for(size, a->kept_capacity), 1));
    mps__parallel_copy(p, a->kept, a->host, bytes);
    return MPS_OK;
}

void mps__array_restore(mps__array *a, size_t bytes)
{
    if (a->kept_in == MPS__NOWHERE) return;
    if (a->kept_in == MPS__ON_HOST)
        memcpy(a->host, a->kept, bytes);
    else
        mps__device_copy(a->device, a->mirror.data, a->spare.data, bytes);
    mps__array_written(a, a->kept_in);
}
