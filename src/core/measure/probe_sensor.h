/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure averaged over the area of a sensor. */
#ifndef MPS_CORE_PROBE_SENSOR_H
#define MPS_CORE_PROBE_SENSOR_H

#include "probe_edge.h"
#include <mps/probe.h>

/* A wall particle under the sensor and its weight in the area mean; < 0 where pressure is
 * extrapolated from other particles, 0 if only an edge needs it. */
typedef struct mps__sensor_weight {
    int64_t id;
    int64_t place; /* last known index: sorting changes it; -1: not owned by this rank */
    double weight;
} mps__sensor_weight;

/* The face read by a sensor. */
typedef struct mps__sensor_face {
    double normal[3]; /* 0: two-sided face */
    int32_t part;     /* -1: none */
} mps__sensor_face;

typedef struct mps__sensor {
    int64_t count, capacity;
    mps__sensor_weight *list; /* by ascending id; the weights sum to 1 */
    mps__edges edges;         /* of the list */
    mps__sensor_face face;
    int64_t generation, linked; /* of the particles at its construction */
    /* on many ranks: at its construction, and at the last update of the indices */
    int64_t links, orders;
} mps__sensor;

void mps__sensor_free(mps__context *c, mps__sensor *sensor);
/* Location of a sensor. */
typedef struct mps__sensor_place {
    /* distance in front of the plane of its face, < 0: behind it, 0: two-sided face; distance along
     * the plane beyond the face's ends, <= 0: within [m] */
    double off, beyond;
    mps__sensor_face face, rival; /* rival: a face about as near with another normal */
    bool has_rival;
} mps__sensor_place;

/* There must be a wall. @return MPS_E_STATE: no face has the normal config->normal */
mps_status mps__sensor_place_find(mps__world *w, const mps_probe *config, mps__sensor_place *place);
/* Find the particles under the sensor and their weights; on failure the old ones stay. There must
 * be a wall. */
mps_status mps__sensor_build(mps__world *w, const mps_probe *config, mps__sensor *sensor);
/* Mean pressure now; rebuilds the weights only if particles were added or removed. */
mps_status mps__sensor_read(mps__world *w, const mps_probe *config, mps__sensor *sensor,
                            double *value);

#endif
