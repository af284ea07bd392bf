/* SPDX-License-Identifier: BSD-3-Clause */
/* Cavities: regions enclosed by liquid and walls, filled with gas or empty. */
#ifndef MPS_CASE_CAVITY_H
#define MPS_CASE_CAVITY_H

#include "raster.h"

typedef struct cavities {
    raster grid;
    /* [nodes] number of the connected region without liquid, from 1; 0: none; -1: liquid not
     * visited yet */
    int32_t *body;
    int64_t *queue;
} cavities;

/* @param from,to  inner corners of the tank [m]
 * @return false: memory is exhausted; mps__cavities_free() is still valid */
bool mps__cavities_create(cavities *c, mps_sim *sim, const double *from, const double *to);
void mps__cavities_free(cavities *c);

/* Volume of all cavities [m2; m3 in 3-D], NAN if it cannot be measured. Cells of one spacing that
 * are less than half full of liquid are connected across common faces; the largest connected region
 * is the open space above the liquid, regions of fewer than four cells are gaps between particles,
 * the others are cavities. The empty part of their border cells is included, so that the volume of
 * a cavity is that of the missing particles within 0.02 dp of its border; the half cell beside a
 * wall is excluded. The measure does not depend on the gas. */
double mps__cavities_volume(cavities *c, mps_sim *sim);

#endif
