/* SPDX-License-Identifier: BSD-3-Clause */
/* Axes of a picture: a map from metres to pixels, ticks at round numbers, and the colour bar. */
#ifndef MPS_POST_PICTURE_AXES_H
#define MPS_POST_PICTURE_AXES_H

#include "picture_canvas.h"
#include "picture_scene.h"

/* Between the bars of two phases, in pixels of a picture 1280 wide. */
enum { AXES_BARS_APART = 58 };

/* A view of x and y. */
typedef struct plane {
    pixel_box box;              /* pixels of lo .. hi */
    double lo[2], hi[2], scale; /* [m], pixels per metre */
} plane;

double mps__plane_x(const plane *v, double x);
double mps__plane_y(const plane *v, double y);

enum { AXES_TICKS = 64 };

/* Round numbers from lo to hi with a step of 1, 2 or 5 times a power of ten: about `most` of
 * them. */
typedef struct ticks {
    int count;
    double step, value[AXES_TICKS];
} ticks;

void mps__axes_ticks(ticks *t, double lo, double hi, double most);
/* Draw ticks, numbers and units left of and below a view. */
void mps__axes_draw(canvas *c, const plane *v);
/* The colour of a pressure of a phase. */
colour mps__axes_colour(const scene *s, int32_t phase, double p);
/* Draw colour bars, one per phase, with numbers and unit, from x to the right. */
void mps__axes_bar(canvas *c, const scene *s, double x, double top, double height);

#endif
