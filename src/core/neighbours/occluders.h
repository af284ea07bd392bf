/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates as occluders; positions are in the tank's frame. Two particles are a pair only if the
 * line between them crosses no occluder. Behind each side of a plate are its shadows: dummies that
 * overlap with the particles of the other side. They are visible only through their own occluder,
 * that is, exactly where it hides those particles. So around an edge nothing is counted twice, and
 * nothing is missing. */
#ifndef MPS_CORE_OCCLUDERS_H
#define MPS_CORE_OCCLUDERS_H

#include "base.h"

/* A rectangle, in 2-D a segment. */
typedef struct mps__occluder {
    double corner[3], normal[3];
    /* unit vectors along its edges from the corner; the second is zero in 2-D */
    double along[2][3];
    double length[2]; /* of the plate [m] */
    /* hidden range along the edges [m]: larger than the plate where it is attached to a wall */
    double from[2], to[2];
    int32_t axis;    /* of the normal if it is an axis of the tank, else -1 */
    int32_t part;    /* of the plate's particles */
    int32_t columns; /* layers of particles across the plate */
    bool active;     /* false once its walls have been removed */
} mps__occluder;

/* A particle near an occluder. */
typedef struct mps__near_plate {
    int32_t particle;
    int32_t shadow; /* index of its occluder + 1 if it is a shadow, else 0 */
    uint64_t above; /* bit k: it is above occluder k */
    /* start of its lines of sight: for walls a little above their face, so that the two faces of a
     * plate are on different sides */
    double at[3];
} mps__near_plate;

typedef struct mps__occluders {
    mps__context *context;
    int32_t dim, count;
    int64_t capacity, near_plates, near_plate_capacity, slot_capacity;
    mps__occluder *list;
    mps__near_plate *near_plate;
    int32_t *slot; /* [n] index in `near_plate` of each particle, -1: not near an occluder */
} mps__occluders;

void mps__occluders_init(mps__occluders *s, mps__context *context, int32_t dim);
void mps__occluders_free(mps__occluders *s);
/* Allocate for one more occluder; then add it, which cannot fail. */
mps_status mps__occluders_reserve(mps__occluders *s);
void mps__occluders_add(mps__occluders *s, const mps__occluder *occluder);
/* Signed distance of a position from the plane. */
double mps__occluder_height(const mps__occluder *s, const double *X);
/* Distance of a position from the plate. */
double mps__occluder_distance(const mps__occluder *s, const double *X);
/* Whether the line from a to b crosses the hidden rectangle. */
bool mps__occluder_crossed(const mps__occluder *s, const double *a, const double *b);
/* Set `above` from `at`. */
void mps__occluders_sides(const mps__occluder *list, int32_t count, mps__near_plate *a);
/* Whether the two are hidden from each other. @param list [count] all occluders */
bool mps__occluders_hidden(const mps__occluder *list, int32_t count, const mps__near_plate *a,
                           const mps__near_plate *b);

#endif
