/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles spread onto a regular grid that moves with the tank: which share of the space is liquid, gas, solid. */
#ifndef MPS_CASE_RASTER_H
#define MPS_CASE_RASTER_H

#include <mps/mps.h>
#include <stdbool.h>

/* What is told apart: phase 0, all other phases, walls and dummies. */
enum { RASTER_LIQUID, RASTER_OTHER, RASTER_SOLID, RASTER_LAYERS };

typedef struct raster {
    int32_t dim;
    double lo[3], dp; /* first node in the tank's frame; nodes are one spacing apart [m] */
    /* of the cubic B-splines the particles are spread with, in spacings: they reach twice as far */
    double width;
    int64_t size[3];     /* nodes along each axis; 1 for z in 2-D */
    int64_t count, step; /* nodes; step at which it was filled last, -1: never */
    double *share[RASTER_LAYERS];
} raster;

/* Nodes from lo to hi at the most. @param width at least 1 @return false when memory is out; mps__raster_free() is allowed then */
bool mps__raster_create(raster *g, mps_sim *sim, const double *lo, const double *hi, double width);
/* Fill it with the present state, if it is not yet; tanks may move, not turn. @return false if the particles cannot be read */
bool mps__raster_fill(raster *g, mps_sim *sim);
void mps__raster_free(raster *g);

#endif
