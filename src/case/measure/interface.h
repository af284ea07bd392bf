/* SPDX-License-Identifier: BSD-3-Clause */
/* The interface between phase 0 and the others in 2-D: the line on which half of the fluid about is of either. */
#ifndef MPS_CASE_INTERFACE_H
#define MPS_CASE_INTERFACE_H

#include "raster.h"

/* Lengths are exact for straight lines; a circle of radius R comes out smaller by about (width dp)^2/(6 R) [m]. */
typedef struct contour {
    double length;       /* [m] */
    double area;         /* of the phases that are not 0 [m2] */
    double lo[2], hi[2]; /* box around the line in the tank's frame; NAN without a line */
} contour;

/* Measure it on a filled raster: the line runs straight through the cells of the grid. Single particles of the other phase
 * do not make a line, four in a heap do. */
contour mps__contour_measure(const raster *g);

#endif
