/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates that hide the particles on one side from those on the other. All places are in the tank's frame.
 *
 * Two particles are a pair only if the line between them crosses no screen. Behind each side of a plate stand its shadows, dummies
 * that overlap with what is on the other side: these are seen only through their own screen, that is, exactly where it hides
 * what is really there. So nothing is counted twice around an edge, and nothing is missing. */
#ifndef MPS_CORE_SCREENS_H
#define MPS_CORE_SCREENS_H

#include "base.h"

/* A rectangle, in 2-D a segment. */
typedef struct mps__screen {
    double corner[3], normal[3];
    double along[2][3]; /* unit vectors of its edges from the corner; the second is zero in 2-D */
    double length[2];   /* of the plate [m] */
    /* what is hidden along the edges [m]: more than the plate where it stands on a wall */
    double from[2], to[2];
    int32_t axis;    /* of the normal if it is an axis of the tank, else -1 */
    int32_t part;    /* of the plate's particles */
    int32_t columns; /* of them side by side */
    bool active;     /* false once its walls have been removed */
} mps__screen;

/* A particle near a screen. */
typedef struct mps__seer {
    int32_t particle;
    int32_t shadow; /* number of its screen + 1 if it is a shadow, else 0 */
    uint64_t above; /* bit k: it is above screen k */
    /* the place that lines of sight start at: for walls a little above their face, so that the two
     * faces of a plate are on different sides of it */
    double at[3];
} mps__seer;

typedef struct mps__screens {
    mps__context *context;
    int32_t dim, count;
    int64_t capacity, seers, seer_capacity, slot_capacity;
    mps__screen *list;
    mps__seer *seer;
    int32_t *slot; /* [n] place in `seer` of each particle, -1: near no screen */
} mps__screens;

void mps__screens_init(mps__screens *s, mps__context *context, int32_t dim);
void mps__screens_free(mps__screens *s);
/* Room for one more, and then the screen itself, which cannot fail. */
mps_status mps__screens_reserve(mps__screens *s);
void mps__screens_add(mps__screens *s, const mps__screen *screen);
/* Signed distance of a place from the plane. */
double mps__screen_height(const mps__screen *s, const double *X);
/* Distance of a place from the plate itself. */
double mps__screen_distance(const mps__screen *s, const double *X);
/* True if the line from a to b crosses what the screen hides. */
bool mps__screen_crossed(const mps__screen *s, const double *a, const double *b);
/* Set `above` from `at`. */
void mps__screens_sides(const mps__screen *list, int32_t count, mps__seer *a);
/* True if the two are no pair. @param list [count] all screens */
bool mps__screens_hidden(const mps__screen *list, int32_t count, const mps__seer *a,
                         const mps__seer *b);

#endif
