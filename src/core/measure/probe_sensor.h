/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure over the area of a sensor. */
#ifndef MPS_CORE_PROBE_SENSOR_H
#define MPS_CORE_PROBE_SENSOR_H

#include "probe_edge.h"
#include <mps/probe.h>

/* A wall particle under the sensor and its share of the area; < 0 where pressure is extrapolated from others, 0 where only an edge needs it. */
typedef struct mps__sensor_weight {
    int64_t id;
    int64_t place; /* where it was last seen: sorting moves it; on many ranks -1: not owned here */
    double weight;
} mps__sensor_weight;

/* The face that a sensor reads. */
typedef struct mps__sensor_face {
    double normal[3]; /* 0: the face has no sides */
    int32_t part;     /* -1: none */
} mps__sensor_face;

typedef struct mps__sensor {
    int64_t count, capacity;
    mps__sensor_weight *list; /* by ascending id; the weights' sum is 1 */
    mps__edges edges;         /* of the list */
    mps__sensor_face face;
    int64_t generation, linked; /* of the particles it was made for */
    int64_t links, orders;      /* on many ranks likewise, and when they were looked for */
} mps__sensor;

void mps__sensor_free(mps__context *c, mps__sensor *sensor);
/* Where a sensor is. */
typedef struct mps__sensor_place {
    /* before the plane of its face, < 0: behind it, 0: the face has no sides; along it beyond the face's ends, <= 0: on it [m] */
    double off, beyond;
    mps__sensor_face face, rival; /* rival: a face that is about as near and looks elsewhere */
    bool has_rival;
} mps__sensor_place;

/* There must be a wall. @return MPS_E_STATE: no face looks along config->normal */
mps_status mps__sensor_place_find(mps__world *w, const mps_probe *config, mps__sensor_place *place);
/* Find the particles under the sensor and their weights; on failure the old ones stay. There must be a wall. */
mps_status mps__sensor_build(mps__world *w, const mps_probe *config, mps__sensor *sensor);
/* Mean pressure now; anew only if particles came or went. */
mps_status mps__sensor_read(mps__world *w, const mps_probe *config, mps__sensor *sensor,
                            double *value);

#endif
