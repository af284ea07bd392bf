/* SPDX-License-Identifier: BSD-3-Clause */
/* Interpolates particles to a regular grid that moves with the tank: fractions of liquid, gas and
 * solid. */
#ifndef MPS_CASE_RASTER_H
#define MPS_CASE_RASTER_H

#include <mps/mps.h>
#include <stdbool.h>

/* Classes: phase 0, all other phases, walls and dummies. */
enum { RASTER_LIQUID, RASTER_OTHER, RASTER_SOLID, RASTER_LAYERS };

typedef struct raster {
    int32_t dim;
    double lo[3], dp; /* first node in the tank's frame; nodes are one spacing apart [m] */
    /* width of the cubic B-splines of the particles, in spacings; their support is twice as
     * large */
    double width;
    int64_t size[3];     /* nodes along each axis; 1 for z in 2-D */
    int64_t count, step; /* nodes; step of the last fill, -1: never */
    double *share[RASTER_LAYERS];
} raster;

/* Nodes cover at most lo to hi.
 * @param width  at least 1
 * @return false: memory is exhausted; mps__raster_free() is still valid */
bool mps__raster_create(raster *g, mps_sim *sim, const double *lo, const double *hi, double width);
/* Fill it with the present state, unless it is current; tanks may translate, not rotate.
 * @return false if the particles cannot be read */
bool mps__raster_fill(raster *g, mps_sim *sim);
void mps__raster_free(raster *g);

#endif
