/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes of tanks, bodies and fills as signed distances. */
#ifndef MPS_CASE_FORM_H
#define MPS_CASE_FORM_H

#include <stdbool.h>
#include <stdint.h>

enum { FORM_POINTS = 64 };

typedef enum form_kind { FORM_BOX, FORM_POLYGON, FORM_ROD, FORM_TUBE, FORM_BALL } form_kind;

/* A closed surface in 2-D or 3-D. FORM_ROD: a cylinder with flat ends between two points.
 * FORM_TUBE: a cylinder along an axis with elliptical heads. In 2-D both are circles. */
typedef struct form {
    form_kind kind;
    int32_t dim;
    double lo[3], hi[3]; /* its box; FORM_POLYGON extends from lo to hi normal to its plane */
    int32_t points;
    double point[FORM_POINTS][2]; /* FORM_POLYGON, in order */
    bool sideways;                /* FORM_POLYGON: in the plane z, y; it extends along x */
    double end[2][3];             /* FORM_ROD; centre of a FORM_BALL: end[0] */
    double radius;
    int32_t axis;         /* FORM_TUBE */
    double length, heads; /* of the straight part; depth of a head [m], 0: flat ends */
} form;

/* Signed distance from the surface, > 0 inside. Exact except for elliptical heads, where it is
 * accurate near the surface. */
double mps__form_inside(const form *s, const double *x);
/* For mps_solid.distance; user: a form. Liquid inside, or outside. */
double mps__form_container(void *user, const double *x);
double mps__form_body(void *user, const double *x);
/* Set lo and hi from the other members; for a polygon in its plane only. */
void mps__form_box(form *s);
/* Area of a polygon, > 0 where its points are counterclockwise [m2]. */
double mps__form_polygon_area(const form *s);
/* Remove points of a polygon that equal the previous one, also at the end. */
void mps__form_polygon_clean(form *s);
/* Whether two sides of a polygon cross, touch or overlap. Side i is from point i to point i + 1.
 * @param side  [2] out: the first pair
 * @param at  [2] out: where they meet */
bool mps__form_polygon_crosses(const form *s, int32_t *side, double *at);
/* Volume of the shape of a tank [m3], in 2-D area [m2]; no tank is a rod. */
double mps__form_volume(const form *s);
/* Volume below a level y; for boxes and polygons, NAN for others. */
double mps__form_volume_below(const form *s, double y);

#endif
