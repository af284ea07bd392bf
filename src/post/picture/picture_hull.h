/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the walls on the outside of the tank, and their outward directions. */
#ifndef MPS_POST_PICTURE_HULL_H
#define MPS_POST_PICTURE_HULL_H

#include "picture_scene.h"

/* Of each column of cells along x, y and z the least and the largest coordinate of a wall. */
typedef struct hull {
    const scene *s;
    int64_t cells[3];
    float *least[3], *most[3];
} hull;

/* @return false: memory is exhausted */
bool mps__hull_create(hull *h, const scene *s);
void mps__hull_free(hull *h);
/* The sum of the directions in which there is no wall beyond x; (0, 0, 0): an inner wall, such as a
 * baffle. */
void mps__hull_outwards(const hull *h, const float x[3], double out[3]);

#endif
