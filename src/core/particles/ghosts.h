/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on many ranks: ownership, and ghosts, that is, copies of other ranks' particles within
 * reach of the owned ones. Owned particles and ghosts share one store in one order, so that sums
 * over neighbours have the same order on any rank. */
#ifndef MPS_CORE_GHOSTS_H
#define MPS_CORE_GHOSTS_H

#include "device.h"
#include "particles.h"
#include "ranks.h"

/* Positions for the partition, in the tank's frame: X [dim] of particle i. */
typedef struct mps__placing {
    void (*place)(const void *argument, int64_t i, double *X);
    float (*weight)(const void *argument, int64_t i); /* computational work of particle i */
    const void *argument;
    /* fluid and dummies within this distance of owned particles become ghosts [m] */
    double reach;
    /* the same distance for wall particles: those that dummies within `reach` belong to */
    double reach_walls;
} mps__placing;

/* Per-particle values of a halo exchange. */
typedef struct mps__halo_array {
    void *values;
    size_t bytes;   /* per particle */
    bool on_device; /* the array is in device memory */
} mps__halo_array;

/* Ghost data in device memory. */
typedef struct mps__ghosts_device {
    mps__device *device; /* NULL: none yet */
    int64_t orders;      /* value of mps__ghosts.orders for which the data are valid; -1: none */
    mps__device_block ghost, send, receive, packets;
} mps__ghosts_device;

typedef struct mps__ghosts {
    mps__context *context;
    mps__ranks *ranks;
    mps__particles *particles;
    uint8_t *ghost; /* [capacity] 1: a ghost; NULL: single rank */
    int64_t *run;   /* [2 runs] ranges of owned particles: begin, end */
    int64_t capacity, run_capacity, runs;
    /* particles already partitioned; those behind them are replicated on all ranks */
    int64_t known;
    bool divided;   /* a partition exists, even if this rank owns nothing */
    double reach;   /* of the present ghosts [m] */
    bool cut;       /* space is partitioned */
    bool recut;     /* repartition in the next mps__ghosts_renew() */
    bool connected; /* the route is valid: */
    /* from owned particles to their copies on other ranks, and from other ranks to the ghosts */
    mps_route route;
    int64_t sends, receives, send_capacity, receive_capacity;
    int32_t *send, *receive;    /* indices of these particles, in the order of the route */
    struct mps__parcel *parcel; /* list of particles and ranks, while it is built */
    int64_t parcels, parcel_capacity, out_capacity, in_capacity;
    char *out, *in;
    /* number of reorderings; each changes the indices of ghosts, sends and receives */
    int64_t orders;
    mps__ghosts_device on_device;
    char *staged; /* staging buffer of packets of device arrays, both ways */
    int64_t staged_capacity;
} mps__ghosts;

void mps__ghosts_init(mps__ghosts *g, mps__context *context, mps__ranks *ranks,
                      mps__particles *particles);
void mps__ghosts_free(mps__ghosts *g);

/* Public part of the module; scripts/layers refuses access to `ghost` elsewhere. */

/* Whether this rank owns particle i: for row functions, which have `ghost` as a flat array. */
static inline bool mps__owns(const uint8_t *ghost, int64_t i)
{
    return !ghost || !ghost[i];
}

/* First owned particle from index i on; the number of particles: none. Loops over owned particles:
 *   for (int64_t i = mps__own_from(g, 0); i < s->n; i = mps__own_from(g, i + 1)) */
static inline int64_t mps__own_from(const mps__ghosts *g, int64_t i)
{
    while (g->ghost && i < g->particles->n && g->ghost[i]) i++;
    return i;
}

/* Index i if this rank owns the particle; -1 for a ghost, or if i < 0. */
static inline int64_t mps__own_place(const mps__ghosts *g, int64_t i)
{
    return i >= 0 && mps__owns(g->ghost, i) ? i : -1;
}

/* Whether this rank counts or writes particle i: its owner; rank 0 while all ranks have all
 * particles. */
static inline bool mps__own_output(const mps__ghosts *g, int64_t i)
{
    return g->divided ? mps__owns(g->ghost, i) : g->ranks->rank == 0;
}

/* Keep the owned ones of the particles that all ranks have added in the same way since the last
 * call. The first call partitions space. All calls below are collective; on a single rank they do
 * nothing. */
mps_status mps__ghosts_adopt(mps__ghosts *g, const mps__placing *p);
/* Migrate particles to their owners, after repartitioning if `recut` is set, and receive new
 * ghosts. The last `aside` particles in memory, behind those of the store, stay. Owned particles
 * and ghosts are not in order yet: mps__ghosts_ordered() must follow. */
mps_status mps__ghosts_renew(mps__ghosts *g, const mps__placing *p, int64_t aside);
/* The store has owned particles only, the first `known` of them partitioned; the next
 * mps__ghosts_renew() makes ghosts. Cannot fail after mps__ghosts_reset_reserve() for at least as
 * many particles. */
mps_status mps__ghosts_reset_reserve(mps__ghosts *g, int64_t n);
void mps__ghosts_reset(mps__ghosts *g, int64_t known);
/* To be called before the store is permuted: particle order[k] moves to index k. */
mps_status mps__ghosts_ordered(mps__ghosts *g, const int32_t *order);
/* Halo exchange: copy the owners' values to the ghosts. `d`: the device that has the arrays marked
 * `on_device`; which arrays are on a device may differ between ranks. */
mps_status mps__ghosts_exchange_at(mps__ghosts *g, mps__device *d, const mps__halo_array *shared,
                                   int32_t count);
/* Halo exchange of arrays on the host. */
static inline mps_status mps__ghosts_exchange(mps__ghosts *g, const mps__halo_array *shared,
                                              int32_t count)
{
    return mps__ghosts_exchange_at(g, NULL, shared, count);
}
/* Halo exchange of sparse values: particle i has x[index[i]], none if index[i] < 0. `d`: the device
 * that has both arrays; NULL: the host. */
mps_status mps__ghosts_exchange_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                        double *x);

/* `ghost` for row functions on a device; d NULL: on the host; returns NULL if this rank has no
 * ghosts. If it cannot be allocated, the device is marked as failed. ghosts_device.c */
const uint8_t *mps__ghosts_seen(mps__ghosts *g, mps__device *d);
/* Release the device memory; before the device is detached. */
void mps__ghosts_release_device(mps__ghosts *g);
/* Copy packets of device arrays to g->staged, array by array, and from there to the ghosts. */
mps_status mps__ghosts_fetch(mps__ghosts *g, mps__device *d, const mps__halo_array *shared,
                             int32_t count);
mps_status mps__ghosts_bring(mps__ghosts *g, mps__device *d, const mps__halo_array *shared,
                             int32_t count);
/* Copy packets of sparse values to `out` [sends], and from `in` [receives]. */
mps_status mps__ghosts_fetch_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     const double *x, double *out);
mps_status mps__ghosts_bring_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     double *x, const double *in);

/* Bytes of all fields of a particle; copy these fields into a packet, and back. */
size_t mps__ghosts_packet(const mps__particles *s);
void mps__ghosts_pack(const mps__particles *s, int64_t i, char *to);
void mps__ghosts_unpack(const mps__particles *s, int64_t i, const char *from);

/* Call rows(argument, begin, end) for the owned particles in begin..end-1. */
void mps__ghosts_rows(const mps__ghosts *g, mps_range_fn rows, void *argument, int64_t begin,
                      int64_t end);

#endif
