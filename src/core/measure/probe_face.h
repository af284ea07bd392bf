/* SPDX-License-Identifier: BSD-3-Clause */
/* The wall face that contains a sensor. */
#ifndef MPS_CORE_PROBE_FACE_H
#define MPS_CORE_PROBE_FACE_H

#include "world.h"
#include <mps/probe.h>

/* A solid particle near the sensor. */
typedef struct mps__face_solid {
    int64_t id, place;
    double r[3], n[3]; /* from the sensor; normal into the liquid, 0 without an area */
    bool wall, member;
} mps__face_solid;

/* A wall particle of the face. */
typedef struct mps__face_point {
    int64_t id, place;
    int64_t number;       /* index in the list of the sensor, -1: not in it */
    double at[2], weight; /* coordinates along the tangents, from the sensor */
    /* belongs to this face alone; on an edge where the face turns away from the liquid */
    bool inside, edge;
} mps__face_point;

/* The plane of a face at the sensor. */
typedef struct mps__face {
    int32_t dim, sides;    /* directions along the face: 1 or 2 */
    const double *wanted;  /* NULL, or the requested normal of the face, unit length */
    mps__face_solid *base; /* a particle of the face */
    /* off: distance of the sensor in front of the plane, < 0: behind it */
    double dp, width, radius, off;
    double normal[3], tangent[2][3];
    /* from the sensor: ends of the face, and centroid of the covered area */
    double lo[2], hi[2], target[2];
    int64_t count, capacity, solids, solid_capacity;
    mps__face_point *list; /* by id */
    mps__face_solid *solid;
} mps__face;

/* Find the face of a sensor and its particles; there must be a wall. Call mps__face_free()
 * afterwards in any case. */
mps_status mps__face_find(mps__face *f, mps__world *w, const mps_probe *c);
void mps__face_free(mps__face *f, mps__context *c);
/* Particle of the nearest face with another normal, if that is as near within dp/2; NULL: none. */
const mps__face_solid *mps__face_rival(mps__face *f);
/* Whether the face is one-sided: it has a normal. */
bool mps__face_has_sides(const mps__face *f);
/* Distance from a point in the tank frame to the nearest wall particle; infinite without walls. */
double mps__sensor_distance(const mps__world *w, const double *at);

#endif
