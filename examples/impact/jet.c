/* SPDX-License-Identifier: BSD-3-Clause */
/* A jet falls on a wide wall, without gravity: in the steady phase rho U^2/2 at the stagnation
 * point and rho U^2 b on the whole wall. */
#include "impact.h"
#include <math.h>

static const double WIDTH = 1; /* b [m] */
/* Lengths of the jet and the wall [b]; times of the steady phase after contact [b/U]. */
enum { LENGTH = 6, HALF_WALL = 12, BEGIN = 2, END = 5 };

static void set(impact *c, driver *d)
{
    const double b = lround(WIDTH / d->dp) * d->dp;
    impact_weightless(c, d);
    c->contact = (IMPACT_GAP - 1) * d->dp / c->speed;
    d->t_end = c->contact + END * b / c->speed + d->dp / c->speed;
}

static void build(impact *c)
{
    driver *d = &c->d;
    const double dp = d->dp, rho = c->density, u = c->speed;
    const int wide = (int)lround(WIDTH / dp), left = HALF_WALL * wide;
    const int across[] = {left, left + wide - 1},
              up[] = {IMPACT_GAP, IMPACT_GAP + LENGTH * wide - 1};
    const double size[] = {(2 * left + wide - 1) * dp, (up[1] + IMPACT_GAP) * dp,
                           IMPACT_SLICE * dp};
    const double b = wide * dp, middle = 0.5 * size[0];
    const impact_span steady = {c->contact + BEGIN * b / u, c->contact + END * b / u, 0};
    const impact_span start = {0, c->contact + 4 * dp / u, 0}, smooth = {0, start.to, dp / u},
                      settled = {steady.from, steady.to, dp / u};
    impact_water(c);
    impact_walls(c, size, false);
    impact_fill(c, across, up);
    impact_start(c, 0, -u);
    driver_wall(d, "P", middle, 0, 0.5 * size[2], 2 * dp);
    driver_wall(d, "P_quarter", middle + 0.25 * b, 0, 0.5 * size[2], 2 * dp);
    driver_force(d, "F", "tank.y0", 1);
    impact_figure(c, "stagnation", MPS_TRACE_MEAN, "P", steady, 0.5 * rho * u * u);
    impact_figure(c, "stagnation_least", MPS_TRACE_LEAST, "P", settled, 0.5 * rho * u * u);
    impact_figure(c, "stagnation_largest", MPS_TRACE_LARGEST, "P", settled, 0.5 * rho * u * u);
    impact_figure(c, "force_walls", MPS_TRACE_MEAN, "F", steady,
                  -rho * u * u * b * impact_width(c));
    impact_figure(c, "force_fluid", MPS_TRACE_CHANGE, "momentum_y", steady,
                  rho * u * b * impact_fluid_width(c) * u * (steady.to - steady.from));
    impact_figure(c, "peak_raw", MPS_TRACE_LARGEST, "P", start, rho * u * u);
    impact_figure(c, "peak_mean", MPS_TRACE_LARGEST, "P", smooth, rho * u * u);
}

const impact_case impact_jet = {set, build, 0.05, true};
