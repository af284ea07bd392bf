/* SPDX-License-Identifier: BSD-3-Clause */
/* Ghosts on a device: the ghost flags, and the halo exchange of device arrays. Only the packets are
 * copied to and from the host. */
#include "ghosts.h"
#include "loop.h"
#include <string.h>

void mps__ghosts_release_device(mps__ghosts *g)
{
    mps__device_block *all[] = {&g->on_device.ghost, &g->on_device.send, &g->on_device.receive,
                                &g->on_device.packets};
    for (size_t k = 0; g->on_device.device && k < sizeof all / sizeof all[0]; k++)
        mps__device_release(g->on_device.device, all[k]);
    g->on_device = (mps__ghosts_device){.orders = -1};
}

static bool put(mps__device *d, mps__device_block *buffer, const void *from, int64_t count,
                size_t size)
{
    if (!mps__device_fit(d, buffer, (size_t)count * size)) return false;
    mps__device_upload(d, buffer->data, from, (size_t)count * size);
    return true;
}

/* Copy the ghost flags and the indices of packets, if particles were reordered since. */
static mps_status show(mps__ghosts *g, mps__device *d)
{
    mps__ghosts_device *t = &g->on_device;
    if (t->device == d && t->orders == g->orders) return MPS_OK;
    t->device = d;
    t->orders = -1;
    if (!put(d, &t->ghost, g->ghost, g->particles->n, sizeof *g->ghost) ||
        !put(d, &t->send, g->send, g->sends, sizeof *g->send) ||
        !put(d, &t->receive, g->receive, g->receives, sizeof *g->receive))
        return MPS_E_NOMEM;
    t->orders = g->orders;
    return MPS_OK;
}

const uint8_t *mps__ghosts_seen(mps__ghosts *g, mps__device *d)
{
    if (!g->ghost || !d) return g->ghost;
    if (show(g, d) < 0) mps__device_fail(d); /* loops would not skip the ghosts */
    return g->on_device.ghost.data;
}

typedef struct packets {
    const int32_t *particle; /* of each packet */
    const char *from;
    char *values;
    size_t bytes; /* per packet */
} packets;

MPS_ROW void unpack_row(const packets *f, int64_t k)
{
    memcpy(f->values + (size_t)f->particle[k] * f->bytes, f->from + (size_t)k * f->bytes, f->bytes);
}
MPS__LOOP_ANY(unpack_rows, unpack_row, packets)

/* Bytes of a packet of the device arrays before array `end`. */
static size_t bytes_device(const mps__halo_array *shared, int32_t end)
{
    size_t bytes = 0;
    for (int32_t a = 0; a < end; a++) bytes += shared[a].on_device ? shared[a].bytes : 0;
    return bytes;
}

static mps_status reserve(mps__ghosts *g, mps__device *d, size_t bytes)
{
    const int64_t most = g->sends > g->receives ? g->sends : g->receives;
    MPS__TRY(show(g, d));
    if (!mps__device_fit(d, &g->on_device.packets, (size_t)most * bytes)) return MPS_E_NOMEM;
    return mps__grow(g->context, (void **)&g->staged, &g->staged_capacity, 0, most * (int64_t)bytes,
                     1);
}

/* Packets of an array follow those of the arrays before it. */
mps_status mps__ghosts_fetch(mps__ghosts *g, mps__device *d, const mps__halo_array *shared,
                             int32_t count)
{
    const size_t bytes = bytes_device(shared, count);
    MPS__TRY(reserve(g, d, bytes));
    for (int32_t a = 0; a < count; a++)
        if (shared[a].on_device)
            mps__particles_permute_values(
                &d->parallel,
                (char *)g->on_device.packets.data + (size_t)g->sends * bytes_device(shared, a),
                shared[a].values, g->sends, g->on_device.send.data, shared[a].bytes);
    mps__device_download(d, g->staged, g->on_device.packets.data, (size_t)g->sends * bytes);
    return mps__device_status(d);
}

mps_status mps__ghosts_bring(mps__ghosts *g, mps__device *d, const mps__halo_array *shared,
                             int32_t count)
{
    const char *const from = g->on_device.packets.data;
    mps__device_upload(d, g->on_device.packets.data, g->staged,
                       (size_t)g->receives * bytes_device(shared, count));
    for (int32_t a = 0; a < count; a++)
        if (shared[a].on_device)
            mps__loop_run(&d->parallel, &unpack_rows, MPS__ANY_DIM, g->receives,
                          &(packets){g->on_device.receive.data,
                                     from + (size_t)g->receives * bytes_device(shared, a),
                                     shared[a].values, shared[a].bytes});
    return mps__device_status(d);
}

/* ---- sparse values ---- */

typedef struct indexed {
    const int32_t *particle, *index;
    const double *from;
    double *to;
} indexed;

MPS_ROW void take_row(const indexed *f, int64_t k)
{
    const int32_t at = f->index[f->particle[k]];
    f->to[k] = at >= 0 ? f->from[at] : 0;
}
MPS__LOOP_ANY(take_rows, take_row, indexed)

MPS_ROW void put_row(const indexed *f, int64_t k)
{
    const int32_t at = f->index[f->particle[k]];
    if (at >= 0) f->to[at] = f->from[k];
}
MPS__LOOP_ANY(put_rows, put_row, indexed)

mps_status mps__ghosts_fetch_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     const double *x, double *out)
{
    MPS__TRY(reserve(g, d, sizeof *x));
    mps__loop_run(&d->parallel, &take_rows, MPS__ANY_DIM, g->sends,
                  &(indexed){g->on_device.send.data, index, x, g->on_device.packets.data});
    mps__device_download(d, out, g->on_device.packets.data, (size_t)g->sends * sizeof *x);
    return mps__device_status(d);
}

mps_status mps__ghosts_bring_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     double *x, const double *in)
{
    mps__device_upload(d, g->on_device.packets.data, in, (size_t)g->receives * sizeof *x);
    mps__loop_run(&d->parallel, &put_rows, MPS__ANY_DIM, g->receives,
                  &(indexed){g->on_device.receive.data, index, g->on_device.packets.data, x});
    return mps__device_status(d);
}
