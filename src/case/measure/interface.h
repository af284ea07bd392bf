/* SPDX-License-Identifier: BSD-3-Clause */
/* The interface between phase 0 and the others in 2-D: the line where the fluid is half of each. */
#ifndef MPS_CASE_INTERFACE_H
#define MPS_CASE_INTERFACE_H

#include "raster.h"

/* Lengths are exact for straight lines; a circle of radius R is measured too small by about (width
 * dp)^2/(6 R) [m]. */
typedef struct contour {
    double length;       /* [m] */
    double area;         /* of the phases other than 0 [m2] */
    double lo[2], hi[2]; /* bounding box of the line in the tank's frame; NAN without a line */
} contour;

/* Measure the line on a filled raster: it is straight in each cell of the grid. A single particle
 * of the other phase makes no line, a cluster of four does. */
contour mps__contour_measure(const raster *g);

#endif
