/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure of one face on an edge that it shares with another. */
#ifndef MPS_CORE_PROBE_EDGE_H
#define MPS_CORE_PROBE_EDGE_H

#include "probe_face.h"

/* A particle of the face alone, and its parts in the mean beside the edge and in the line that is extrapolated to it. */
typedef struct mps__edge_share {
    int64_t of; /* number in the list of the face, later in that of the sensor */
    double mean, line;
} mps__edge_share;

/* A particle on the edge. */
typedef struct mps__edge {
    int64_t of, first, count; /* its number in the same list; its shares */
} mps__edge;

typedef struct mps__edges {
    int64_t count, capacity, shares, share_capacity;
    mps__edge *list;
    mps__edge_share *share;
} mps__edges;

/* Find the shares of all particles on edges that have a weight. */
mps_status mps__edges_find(mps__edges *e, mps__context *c, const mps__face *f);
void mps__edges_free(mps__edges *e, mps__context *c);
/* The pressures p of a list: those on edges become those of the face alone. */
void mps__edges_apply(const mps__edges *e, double *p);

#endif
