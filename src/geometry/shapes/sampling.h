/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall particles on the surface of a solid and dummies behind it. */
#ifndef MPS_CORE_SAMPLING_H
#define MPS_CORE_SAMPLING_H

#include "buckets.h"
#include "contour.h"

typedef struct mps__samples {
    mps__context *context;
    const mps__shape *shape;
    const mps__contour *contour;
    const mps__buckets *others;    /* existing solid particles; they are not changed */
    double keep_lo[3], keep_hi[3]; /* no particle is placed outside */
    /* results */
    mps__buckets wall, dummy;
    int32_t *feature; /* [wall.count] MPS__CORNER, ... */
    double *area;     /* [3*wall.count] into the liquid */
    double surface;   /* area of the contour within keep_lo..keep_hi */
    double wanted;    /* target number of wall particles: surface over dp^(dim-1) */
    int64_t thin;     /* wall particles with less than 3 dp of solid behind them */
    double thin_at[3];
    int64_t feature_capacity;
} mps__samples;

/* Wall particles with their areas, spaced about dp. lo..hi [dim]: a box around all particles. */
mps_status mps__samples_walls(mps__samples *s, const double *lo, const double *hi);
/* Dummies to a depth of `layers` spacings: behind each wall particle, then lattice points in
 * remaining gaps. */
mps_status mps__samples_dummies(mps__samples *s, int32_t layers, const mps__distances *lattice);
void mps__samples_free(mps__samples *s);

#endif
