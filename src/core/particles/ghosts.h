/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on many ranks: who owns them, and the ghosts, copies of particles of other ranks within reach of the owned ones. Owned particles and
 * ghosts stand in one store in one order, so that sums over neighbours have the same order on any rank. */
#ifndef MPS_CORE_GHOSTS_H
#define MPS_CORE_GHOSTS_H

#include "device.h"
#include "particles.h"
#include "ranks.h"

/* Places in the frame of the cuts, which is that of the tank: X [dim] of particle i. */
typedef struct mps__placing {
    void (*place)(const void *argument, int64_t i, double *X);
    float (*weight)(const void *argument, int64_t i); /* work that particle i makes */
    const void *argument;
    double reach;       /* of the owned particles: fluid and dummies within it become ghosts [m] */
    double reach_walls; /* likewise wall particles: those that dummies within `reach` belong to */
} mps__placing;

/* Values that neighbours read, of each particle. */
typedef struct mps__shared {
    void *values;
    size_t bytes; /* of a particle */
    bool there;   /* the array is one of the device */
} mps__shared;

/* What a device has of the ghosts. */
typedef struct mps__ghosts_there {
    mps__device *device; /* NULL: nothing yet */
    int64_t orders;      /* those of the ghosts that it has; -1: none */
    mps__device_block ghost, send, receive, packets;
} mps__ghosts_there;

typedef struct mps__ghosts {
    mps__context *context;
    mps__ranks *ranks;
    mps__particles *particles;
    uint8_t *ghost; /* [capacity] 1: a ghost; NULL: alone */
    int64_t *run;   /* [2 runs] ranges of owned particles: begin, end */
    int64_t capacity, run_capacity, runs;
    int64_t known;   /* particles that ranks have divided; those behind them all ranks have */
    bool divided;    /* they have divided some, be it none of this rank */
    double reach;    /* of the present ghosts [m] */
    bool cut;        /* space is divided */
    bool recut;      /* it is to be divided anew with the next mps__ghosts_renew() */
    bool connected;  /* there is a route: */
    mps_route route; /* owned particles to other ranks, and theirs to the ghosts here */
    int64_t sends, receives, send_capacity, receive_capacity;
    int32_t *send, *receive;    /* places of these particles, in the order of the route */
    struct mps__parcel *parcel; /* what goes to which rank, while that is found */
    int64_t parcels, parcel_capacity, out_capacity, in_capacity;
    char *out, *in;
    int64_t orders; /* places of ghosts, sends and receives change with each */
    mps__ghosts_there there;
    char *staged; /* packets of arrays of a device: to other ranks, or from them */
    int64_t staged_capacity;
} mps__ghosts;

void mps__ghosts_init(mps__ghosts *g, mps__context *context, mps__ranks *ranks,
                      mps__particles *particles);
void mps__ghosts_free(mps__ghosts *g);

/* What others ask of ghosts is below; scripts/layers refuses a look at `ghost` elsewhere. */

/* Whether this rank owns row i: for row functions, which have `ghost` as a flat array. */
static inline bool mps__owns(const uint8_t *ghost, int64_t i)
{
    return !ghost || !ghost[i];
}

/* First particle from place i on that this rank owns; the number of particles: none. Loops over owned particles:
 *   for (int64_t i = mps__own_from(g, 0); i < s->n; i = mps__own_from(g, i + 1)) */
static inline int64_t mps__own_from(const mps__ghosts *g, int64_t i)
{
    while (g->ghost && i < g->particles->n && g->ghost[i]) i++;
    return i;
}

/* Place i where this rank owns the particle, -1 where it is a ghost, or there is none (i < 0). */
static inline int64_t mps__own_place(const mps__ghosts *g, int64_t i)
{
    return i >= 0 && mps__owns(g->ghost, i) ? i : -1;
}

/* Whether this rank is the one that counts or writes particle i: its owner; rank 0 while all ranks have all particles. */
static inline bool mps__own_output(const mps__ghosts *g, int64_t i)
{
    return g->divided ? mps__owns(g->ghost, i) : g->ranks->rank == 0;
}

/* Of the particles that all ranks added alike since the last call, keep the own ones. The first call divides space. All calls below are those
 * of all ranks together; alone they do nothing. */
mps_status mps__ghosts_adopt(mps__ghosts *g, const mps__placing *p);
/* Particles go to the ranks that own their places, after new cuts if these are wanted, and new ghosts come. The last `aside` particles in memory, behind those of the store, stay
 * there. Owned particles and ghosts are not in order yet: mps__ghosts_ordered() must follow. */
mps_status mps__ghosts_renew(mps__ghosts *g, const mps__placing *p, int64_t aside);
/* The store has only particles that this rank owns, the first `known` of them divided; ghosts come with the next mps__ghosts_renew(). Cannot
 * fail after mps__ghosts_reset_reserve() for at least as many particles. */
mps_status mps__ghosts_reset_reserve(mps__ghosts *g, int64_t n);
void mps__ghosts_reset(mps__ghosts *g, int64_t known);
/* The store is about to be permuted: particle order[k] comes to place k. */
mps_status mps__ghosts_ordered(mps__ghosts *g, const int32_t *order);
/* Ghosts get the values that their owners have. `d`: the device of arrays that are there; the device of other ranks may have others of them. */
mps_status mps__ghosts_share_at(mps__ghosts *g, mps__device *d, const mps__shared *shared,
                                int32_t count);
/* The same of arrays of the host. */
static inline mps_status mps__ghosts_share(mps__ghosts *g, const mps__shared *shared, int32_t count)
{
    return mps__ghosts_share_at(g, NULL, shared, count);
}
/* The same of numbers that some particles have: particle i has x[index[i]], none where index[i] < 0. `d`: the device that has both arrays; NULL: the
 * host has them. */
mps_status mps__ghosts_share_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     double *x);

/* `ghost` for row functions at a device, NULL: the host; NULL too where this rank has none. Where there is no room for it the device has failed. ghosts_there.c */
const uint8_t *mps__ghosts_seen(mps__ghosts *g, mps__device *d);
/* The device is about to be detached. */
void mps__ghosts_leave(mps__ghosts *g);
/* Packets of the arrays that are there come to g->staged, array by array, and go back from it to their ghosts. */
mps_status mps__ghosts_fetch(mps__ghosts *g, mps__device *d, const mps__shared *shared,
                             int32_t count);
mps_status mps__ghosts_bring(mps__ghosts *g, mps__device *d, const mps__shared *shared,
                             int32_t count);
/* The same of numbers that some particles have, into `out` [sends] and from `in` [receives]. */
mps_status mps__ghosts_fetch_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     const double *x, double *out);
mps_status mps__ghosts_bring_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                     double *x, const double *in);

/* Bytes of all fields of a particle; these fields one behind the other, and back. */
size_t mps__ghosts_packet(const mps__particles *s);
void mps__ghosts_pack(const mps__particles *s, int64_t i, char *to);
void mps__ghosts_unpack(const mps__particles *s, int64_t i, const char *from);

/* Call rows(argument, begin, end) for the owned particles in begin..end-1. */
void mps__ghosts_rows(const mps__ghosts *g, mps_range_fn rows, void *argument, int64_t begin,
                      int64_t end);

#endif
