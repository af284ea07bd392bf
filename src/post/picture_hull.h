/* SPDX-License-Identifier: BSD-3-Clause */
/* Which walls are the outside of the tank, and where they look. */
#ifndef MPS_POST_PICTURE_HULL_H
#define MPS_POST_PICTURE_HULL_H

#include "picture_scene.h"

/* Of each column of cells along x, y and z the least and the largest coordinate of a wall. */
typedef struct hull {
    const scene *s;
    int64_t cells[3];
    float *least[3], *most[3];
} hull;

/* @return false without memory */
bool mps__hull_create(hull *h, const scene *s);
void mps__hull_free(hull *h);
/* The sum of the directions in which no wall lies beyond that at x; (0, 0, 0): it stands between others, as a baffle does. */
void mps__hull_outwards(const hull *h, const float x[3], double out[3]);

#endif
