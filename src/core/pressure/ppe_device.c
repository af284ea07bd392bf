/* SPDX-License-Identifier: BSD-3-Clause */
/* Copy of a device's pressure equation on the host, for functions without device loops. */
#include "ppe.h"

/* Allocate the same arrays on the host, in the same layout; nothing is copied yet. */
static mps_status reserve_here(const mps__ppe *e, mps__ppe *here)
{
    *here = *e;
    here->device = NULL;
    here->spare = here->spare_x = NULL; /* of channels, whose values are on the device */
    MPS__TRY(mps__ppe_reserve_rows(here, e->problem.dim));
    MPS__TRY(mps__ppe_reserve_entries(here));
    return e->law ? mps__ppe_reserve_laws(here) : MPS_OK;
}

/* Copy the arrays of the rows up to the address `end`. */
static void fetch_rows(const mps__ppe *e, const mps__ppe *here, const void *end)
{
    mps__device_download(e->device, here->diagonal, e->diagonal,
                         (size_t)((const char *)end - (const char *)e->diagonal));
    if (e->n == 0) here->row[0] = 0;
}

static void fetch_entries(const mps__ppe *e, const mps__ppe *here)
{
    const size_t entries = (size_t)e->entries;
    mps__device_download(e->device, here->col, e->col, entries * sizeof *e->col);
    mps__device_download(e->device, here->val, e->val, entries * sizeof *e->val);
}

mps_status mps__ppe_come(mps__ppe *e)
{
    mps__ppe here;
    MPS__TRY(reserve_here(e, &here));
    fetch_rows(e, &here, e->unknown + e->particles);
    fetch_entries(e, &here);
    if (e->law)
        mps__device_download(e->device, here.gas, e->gas, (size_t)(2 * e->n) * sizeof *e->gas);
    if (e->moments)
        mps__device_download(e->device, here.moments, e->there[MPS__PPE_MOMENTS].data,
                             (size_t)(e->n * e->problem.dim) * sizeof *e->moments);
    here.left = e->device;
    here.unknown_there = e->unknown;
    here.p_there = e->p;
    *e = here;
    e->ranks.order = e->order;
    mps__ppe_ranks_order(e);
    mps__ppe_point(&e->problem, e);
    return mps__device_status(e->left);
}

mps_status mps__ppe_go(mps__ppe *e)
{
    e->device = e->left;
    mps__device_upload(e->device, e->p_there, e->p, (size_t)e->columns * sizeof *e->p);
    e->p = e->p_there;
    e->unknown = e->unknown_there;
    return mps__device_status(e->device);
}

void mps__ppe_leave(mps__ppe *e, mps__device *d)
{
    for (int k = 0; k < MPS__PPE_BLOCKS; k++) mps__device_leave(d, &e->there[k]);
    e->device = NULL;
}
