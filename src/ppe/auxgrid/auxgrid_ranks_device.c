/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid on many ranks with a device each: cells of all ranks on the device, upload of host lists,
 * and packets between host and device. */
#include "auxgrid.h"
#include "rows.h"
#include "loop.h"
#include <string.h>

enum { MOST_ARRAYS = 3 }; /* of a packet */

/* ---- packets ---- */

typedef struct packing {
    const int64_t *place;
    double *array, *packet;
    int64_t arrays, number; /* number of arrays in the packet; index of this one */
} packing;

MPS_ROW void pick_row(const packing *f, int64_t k)
{
    f->packet[k * f->arrays + f->number] = f->array[f->place[k]];
}
MPS__LOOP_ANY(pick_rows, pick_row, packing)

MPS_ROW void put_row(const packing *f, int64_t k)
{
    f->array[f->place[k]] = f->packet[k * f->arrays + f->number];
}
MPS__LOOP_ANY(put_rows, put_row, packing)

static void run(const mps__grid *g, const mps__loop *loop, const int64_t *place, int64_t count,
                int arrays, double *const *array)
{
    for (int a = 0; a < arrays; a++)
        mps__loop_run_cheap(g->parallel, loop, MPS__ANY_DIM, count,
                            &(packing){place, array[a], g->ranks.on_device.packet, arrays, a});
}

void mps__grid_to_host(mps__grid *g, const int64_t *place, int64_t count, int arrays,
                       double *const *array, double *values)
{
    const size_t bytes = (size_t)(count * arrays) * sizeof *values;
    run(g, &pick_rows, place, count, arrays, array);
    if (g->device->failed) memset(values, 0, bytes);
    mps__device_download(g->device, values, g->ranks.on_device.packet, bytes);
}

void mps__grid_to_device(mps__grid *g, const int64_t *place, int64_t count, int arrays,
                         double *const *array, const double *values)
{
    mps__device_upload(g->device, g->ranks.on_device.packet, values,
                       (size_t)(count * arrays) * sizeof *values);
    run(g, &put_rows, place, count, arrays, array);
}

/* ---- cells ---- */

/* Download keys and neighbours of the cells: the host finds owners and contributions from them. */
static int fetch_cells(mps__grid *g, const mps__grid_level *l)
{
    const int64_t around = l->cells * mps__grid_all(g->dim);
    int64_t *key = mps__grid_ranks_buffer(g, MPS__GRID_CELL_KEYS, l->cells, sizeof *key);
    int32_t *about = mps__grid_ranks_buffer(g, MPS__GRID_AROUND, around, sizeof *about);
    if (!key || !about) return MPS_PPE_NOMEM;
    mps__device_download(g->device, key, l->key, (size_t)l->cells * sizeof *key);
    mps__device_download(g->device, about, l->about, (size_t)around * sizeof *about);
    g->ranks.key = key;
    g->ranks.about = about;
    return g->device->failed ? MPS_PPE_NOMEM : 0;
}

int mps__grid_cells_device(mps__grid *g, const mps_ppe_problem *problem, const int64_t *key,
                           int64_t keys)
{
    mps__grid_level *l = &g->level[0];
    mps__device_upload(g->device, g->point_key, key, (size_t)keys * sizeof *key);
    if (!mps__grid_cells(g, l, keys)) return MPS_PPE_NOMEM;
    l->points = g->ranks.columns; /* so far the number of keys */
    if (!mps__grid_reserve_points(g, l)) return MPS_PPE_NOMEM;
    mps__grid_place(g, problem, l->points);
    mps__grid_home(g, l);
    return fetch_cells(g, l);
}

/* Upload a list to the device. NULL: out of memory */
static void *send(mps__grid *g, int which, const void *list, int64_t count, size_t size)
{
    void *on_device = mps__grid_ranks_buffer(g, which, count, size);
    if (on_device) mps__device_upload(g->device, on_device, list, (size_t)count * size);
    return on_device;
}

int mps__grid_owners_to_device(mps__grid *g)
{
    mps__grid_ranks *r = &g->ranks;
    mps__grid_device_lists *t = &r->on_device;
    const int64_t cells = g->level[0].cells, first = r->owned.first[r->table.rank];
    const int64_t sent = mps__grid_sent(r), received = mps__grid_received(r);
    int64_t *wide = mps__grid_ranks_buffer(g, MPS__GRID_WIDE, cells, sizeof *wide);
    for (int64_t c = 0; c < cells && wide; c++) wide[c] = r->owned.cell[c];
    g->visits = r->owned.first[r->table.rank + 1] - first;
    t->send = send(g, MPS__GRID_SEND_DEVICE, r->send, sent, sizeof *t->send);
    t->receive = send(g, MPS__GRID_RECEIVE_DEVICE, r->receive, received, sizeof *t->receive);
    t->owned = wide ? send(g, MPS__GRID_OWNED_DEVICE, wide, cells, sizeof *wide) : NULL;
    t->owner = send(g, MPS__GRID_OWNERS_DEVICE, r->owner, cells, sizeof *t->owner);
    g->visit = send(g, MPS__GRID_VISITS_DEVICE, r->owned.cell + first, g->visits, sizeof *g->visit);
    int64_t packet = MOST_ARRAYS * cells;
    if (packet < sent) packet = sent;
    if (packet < received) packet = received;
    t->packet = mps__grid_ranks_buffer(g, MPS__GRID_PACKET, packet, sizeof *t->packet);
    if (!t->send || !t->receive || !t->owned || !t->owner || !g->visit || !t->packet)
        return MPS_PPE_NOMEM;
    return g->device->failed ? MPS_PPE_NOMEM : 0;
}
