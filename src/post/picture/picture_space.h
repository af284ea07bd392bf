/* SPDX-License-Identifier: BSD-3-Clause */
/* A view of all particles in 3-D: spheres with shading and depth, behind the walls that face the
 * viewer. */
#ifndef MPS_POST_PICTURE_SPACE_H
#define MPS_POST_PICTURE_SPACE_H

#include "picture_canvas.h"
#include "picture_scene.h"

/* Width of the view over its height. */
double mps__space_aspect(const scene *s);
/* Draw the view into a box. */
mps_status mps__space_draw(canvas *c, const pixel_box *box, const scene *s, page_errors *e);

#endif
