/* SPDX-License-Identifier: BSD-3-Clause */
/* Marks of sensors with their names, placed without overlap. */
#ifndef MPS_POST_PICTURE_SENSORS_H
#define MPS_POST_PICTURE_SENSORS_H

#include "picture_canvas.h"

enum { MARKS_MOST = 256 };

/* Names drawn so far, and the box that contains all. */
typedef struct marks {
    pixel_box inside;
    int count;
    pixel_box taken[MARKS_MOST];
} marks;

/* Draw a ring at (x, y), with its name on the side of (nx, ny); (0, 0): to the right. */
void mps__marks_point(marks *m, canvas *c, double x, double y, double nx, double ny,
                      const char *name);
/* Draw a broken line from (x, y) up to `top`, with its name there. */
void mps__marks_line(marks *m, canvas *c, double x, double y, double top, const char *name);

#endif
