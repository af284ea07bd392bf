/* SPDX-License-Identifier: BSD-3-Clause */
/* Marks of sensors with their names, which do not cover each other. */
#ifndef MPS_POST_PICTURE_SENSORS_H
#define MPS_POST_PICTURE_SENSORS_H

#include "picture_canvas.h"

enum { MARKS_MOST = 256 };

/* Names that are there, and the box in which all must be. */
typedef struct marks {
    pixel_box inside;
    int count;
    pixel_box taken[MARKS_MOST];
} marks;

/* A ring at (x, y), with its name on the side to which (nx, ny) points; (0, 0): to the right. */
void mps__marks_point(marks *m, canvas *c, double x, double y, double nx, double ny,
                      const char *name);
/* A broken line from (x, y) up to `top`, with its name there. */
void mps__marks_line(marks *m, canvas *c, double x, double y, double top, const char *name);

#endif
