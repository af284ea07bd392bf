/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure of one face on an edge that it shares with another face. */
#ifndef MPS_CORE_PROBE_EDGE_H
#define MPS_CORE_PROBE_EDGE_H

#include "probe_face.h"

/* A particle that belongs to the face alone, and its weights in the mean beside the edge and in the
 * line extrapolated to the edge. */
typedef struct mps__edge_weight {
    int64_t of; /* index in the list of the face, later in that of the sensor */
    double mean, line;
} mps__edge_weight;

/* A particle on the edge. */
typedef struct mps__edge {
    /* index of the edge particle in the same list; range of its weights */
    int64_t of, first, count;
} mps__edge;

typedef struct mps__edges {
    int64_t count, capacity, weights, weight_capacity;
    mps__edge *list;
    mps__edge_weight *weight;
} mps__edges;

/* Find the weights for all edge particles that have a sensor weight. */
mps_status mps__edges_find(mps__edges *e, mps__context *c, const mps__face *f);
void mps__edges_free(mps__edges *e, mps__context *c);
/* Replace the pressures p of edge particles in a list by those of the face alone. */
void mps__edges_apply(const mps__edges *e, double *p);

#endif
