/* SPDX-License-Identifier: BSD-3-Clause */
/* A dam break flows over a low box on the floor; in 3-D half of it, with a wall on the plane of
 * symmetry and a free side of the box. The pressure is positive on the whole front face; on the top
 * behind the edge and on the rear face, adjacent to the void, there is no suction. */
#include "impact.h"
#include <math.h>

static const double LENGTH = 3.2, HEIGHT = 1, HALF_BREADTH = 0.48, COLUMN_LENGTH = 1.24,
                    COLUMN_HEIGHT = 0.55, GRAVITY = 9.81;
/* The box: position of its front; length and height; half width [m]. */
static const double FRONT = 2.4, BOX = 0.16, BOX_HALF_BREADTH = 0.2;
static const double PASSED = 0.6, MEANS_END = 0.9; /* means of the passing stream [s] */
/* Duration in 2-D and 3-D: in 2-D liquid falls behind the box from 1.3 s on [s]. */
static const double END[] = {1.6, 0.9};
enum { FRONTS = 4, TOPS = 4 };

static void set(impact *c, driver *d)
{
    d->gravity = GRAVITY;
    c->speed = sqrt(2 * GRAVITY * COLUMN_HEIGHT);
    d->t_end = END[d->dim - 2];
}

static void build_walls(impact *c)
{
    driver *d = &c->d;
    const double size[] = {LENGTH, HEIGHT, HALF_BREADTH};
    const double lo[] = {FRONT, 0, 0}, hi[] = {FRONT + BOX, BOX, BOX_HALF_BREADTH}, zero[3] = {0};
    const double column[] = {COLUMN_LENGTH, COLUMN_HEIGHT, HALF_BREADTH};
    impact_water(c);
    impact_walls(c, size, false);
    driver_check(d, mps_baffle_add(d->sim, "box", lo, hi, NULL), "box");
    driver_check(d, mps_fill_level_add(d->sim, 0, zero, column, NULL, NULL), "water");
}

static void build(impact *c)
{
    static const char *const name[] = {"F1", "F2", "F3", "F4", "T1", "T2", "T3", "T4", "R"};
    static const char *const mean[] = {"F1_mean", "F2_mean", "F3_mean", "F4_mean", "T1_mean",
                                       "T2_mean", "T3_mean", "T4_mean", "R_mean"};
    static const char *const least[] = {"F1_least", "F2_least", "F3_least", "F4_least", "T1_least",
                                        "T2_least", "T3_least", "T4_least", "R_least"};
    driver *d = &c->d;
    const double dp = d->dp, pressure = c->density * c->speed * c->speed;
    const impact_span passing = {PASSED, MEANS_END, 0},
                      smooth = {PASSED, END[d->dim - 2], 2 * dp / c->speed};
    build_walls(c);
    for (int i = 0; i <= FRONTS + TOPS; i++) {
        const double part = (2 * (i % FRONTS) + 1) / 8.0 * BOX;
        const double x = i < FRONTS          ? FRONT
                         : i < FRONTS + TOPS ? FRONT + part
                                             : FRONT + BOX,
                     y = i < FRONTS          ? part
                         : i < FRONTS + TOPS ? BOX
                                             : 0.5 * BOX;
        driver_wall(d, name[i], x, y, 0.5 * BOX_HALF_BREADTH, dp);
        impact_figure(c, mean[i], MPS_TRACE_MEAN, name[i], passing, 1);
        impact_figure(c, least[i], MPS_TRACE_LEAST, name[i], smooth, 1);
    }
    driver_force(d, "Fx", "box", 0);
    impact_figure(c, "force_x", MPS_TRACE_MEAN, "Fx", passing, 1);
    driver_force(d, "Fy", "box", 1);
    impact_figure(c, "force_y", MPS_TRACE_MEAN, "Fy", passing, 1);
    impact_given(c, "rho_u2", pressure);
}

const impact_case impact_box = {set, build, 0.02, true};
