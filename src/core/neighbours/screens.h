/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates as occluders; positions are in the tank's frame. Two particles are a pair only if the
 * line between them crosses no occluder. Behind each side of a plate are its shadows: dummies that
 * overlap with the particles of the other side. They are visible only through their own occluder,
 * that is, exactly where it hides those particles. So around an edge nothing is counted twice, and
 * nothing is missing. */
#ifndef MPS_CORE_SCREENS_H
#define MPS_CORE_SCREENS_H

#include "base.h"

/* A rectangle, in 2-D a segment. */
typedef struct mps__screen {
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
} mps__screen;

/* A particle near an occluder. */
typedef struct mps__seer {
    int32_t particle;
    int32_t shadow; /* index of its occluder + 1 if it is a shadow, else 0 */
    uint64_t above; /* bit k: it is above occluder k */
    /* start of its lines of sight: for walls a little above their face, so that the two faces of a
     * plate are on different sides */
    double at[3];
} mps__seer;

typedef struct mps__screens {
    mps__context *context;
    int32_t dim, count;
    int64_t capacity, seers, seer_capacity, slot_capacity;
    mps__screen *list;
    mps__seer *seer;
    int32_t *slot; /* [n] index in `seer` of each particle, -1: not near an occluder */
} mps__screens;

void mps__screens_init(mps__screens *s, mps__context *context, int32_t dim);
void mps__screens_free(mps__screens *s);
/* Allocate for one more occluder; then add it, which cannot fail. */
mps_status mps__screens_reserve(mps__screens *s);
void mps__screens_add(mps__screens *s, const mps__screen *screen);
/* Signed distance of a position from the plane. */
double mps__screen_height(const mps__screen *s, const double *X);
/* Distance of a position from the plate. */
double mps__screen_distance(const mps__screen *s, const double *X);
/* Whether the line from a to b crosses the hidden rectangle. */
bool mps__screen_crossed(const mps__screen *s, const double *a, const double *b);
/* Set `above` from `at`. */
void mps__screens_sides(const mps__screen *list, int32_t count, mps__seer *a);
/* Whether the two are hidden from each other. @param list [count] all occluders */
bool mps__screens_hidden(const mps__screen *list, int32_t count, const mps__seer *a,
                         const mps__seer *b);

#endif
