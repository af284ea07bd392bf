/* SPDX-License-Identifier: BSD-3-Clause */
/* Cavities: what liquid and walls enclose, filled with gas or with nothing. */
#ifndef MPS_CASE_CAVITY_H
#define MPS_CASE_CAVITY_H

#include "raster.h"

typedef struct cavities {
    raster grid;
    /* [nodes] number of the connected body of space without liquid, from 1; 0: none; -1: liquid
     * not looked at yet */
    int32_t *body;
    int64_t *queue;
} cavities;

/* @param from,to  inner corners of the tank [m] @return false when memory is out; mps__cavities_free() is allowed then */
bool mps__cavities_create(cavities *c, mps_sim *sim, const double *from, const double *to);
void mps__cavities_free(cavities *c);

/* Volume of all cavities [m2; m3 in 3-D], NAN if it cannot be measured: cells of one spacing that are less than half full of liquid
 * make bodies, cells with a common face belong together; the largest body is the open space above the liquid, bodies of
 * fewer than four cells are gaps between particles, the others are cavities. What of their border cells is empty counts too, so that the
 * volume of a cavity is that of the particles missing to 0.02 dp of its border; the half cell beside a wall is not part of it. A gas is not looked at: with and without one it is the same measure. */
double mps__cavities_volume(cavities *c, mps_sim *sim);

#endif
