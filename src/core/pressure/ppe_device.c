/* SPDX-License-Identifier: BSD-3-Clause */
/* Copy of a device's pressure equation on the host, for functions without device loops. */
#include "ppe.h"

/* Allocate the same arrays on the host, in the same layout; nothing is copied yet. */
static mps_status reserve_on_host(const mps__ppe *e, mps__ppe *on_host)
{
    *on_host = *e;
    on_host->device = NULL;
    on_host->spare = on_host->spare_x = NULL; /* of channels, whose values are on the device */
    MPS__TRY(mps__ppe_reserve_rows(on_host, e->problem.dim));
    MPS__TRY(mps__ppe_reserve_entries(on_host));
    return e->law ? mps__ppe_reserve_laws(on_host) : MPS_OK;
}

/* Copy the arrays of the rows up to the address `end`. */
static void fetch_rows(const mps__ppe *e, const mps__ppe *on_host, const void *end)
{
    mps__device_download(e->device, on_host->diagonal, e->diagonal,
                         (size_t)((const char *)end - (const char *)e->diagonal));
    if (e->n == 0) on_host->row[0] = 0;
}

static void fetch_entries(const mps__ppe *e, const mps__ppe *on_host)
{
    const size_t entries = (size_t)e->entries;
    mps__device_download(e->device, on_host->col, e->col, entries * sizeof *e->col);
    mps__device_download(e->device, on_host->val, e->val, entries * sizeof *e->val);
}

mps_status mps__ppe_to_host(mps__ppe *e)
{
    mps__ppe on_host;
    MPS__TRY(reserve_on_host(e, &on_host));
    fetch_rows(e, &on_host, e->unknown + e->particles);
    fetch_entries(e, &on_host);
    if (e->law)
        mps__device_download(e->device, on_host.gas, e->gas, (size_t)(2 * e->n) * sizeof *e->gas);
    if (e->moments)
        mps__device_download(e->device, on_host.moments, e->on_device[MPS__PPE_MOMENTS].data,
                             (size_t)(e->n * e->problem.dim) * sizeof *e->moments);
    on_host.left = e->device;
    on_host.unknown_device = e->unknown;
    on_host.p_device = e->p;
    *e = on_host;
    e->ranks.order = e->order;
    mps__ppe_ranks_order(e);
    mps__ppe_point(&e->problem, e);
    return mps__device_status(e->left);
}

mps_status mps__ppe_to_device(mps__ppe *e)
{
    e->device = e->left;
    mps__device_upload(e->device, e->p_device, e->p, (size_t)e->columns * sizeof *e->p);
    e->p = e->p_device;
    e->unknown = e->unknown_device;
    return mps__device_status(e->device);
}

void mps__ppe_release_device(mps__ppe *e, mps__device *d)
{
    for (int k = 0; k < MPS__PPE_BLOCKS; k++) mps__device_release(d, &e->on_device[k]);
    e->device = NULL;
}
