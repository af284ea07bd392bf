/* SPDX-License-Identifier: BSD-3-Clause */
/* With gravity. `column`: liquid as wide as its tank falls flat on the floor: pressure 0 before
 * contact, impulse rho h U, no rebound, finally rho g h. `floor`: the floor under a free column
 * accelerates downwards at 2 g. Liquid in contact with the void falls freely, with pressure 0 and a
 * gap of g t^2/2, first at the edges of the floor. The void cannot enter the middle: the floor
 * pulls the liquid there down with it until the void arrives from the edges. So the edges have an
 * exact solution, the middle and its gap do not. */
#include "impact.h"
#include <math.h>

static const double HEIGHT = 0.5, DROP = 0.1, BREADTH = 0.4, GRAVITY = 9.81;
/* Simulated time after contact; hydrostatics are measured from REST_FROM on [s]. */
static const double REST = 1, REST_FROM = 0.5;
static const double PULL = 0.2;            /* time simulated [s] */
static const double BEFORE = 3, AFTER = 4; /* window about contact [dp/U] */

static void set_column(impact *c, driver *d)
{
    const double drop = lround(DROP / d->dp) * d->dp;
    d->gravity = GRAVITY;
    c->speed = sqrt(2 * GRAVITY * drop);
    c->contact = c->speed / GRAVITY;
    d->t_end = c->contact + REST;
}

static void build_column(impact *c)
{
    driver *d = &c->d;
    const double dp = d->dp, u = c->speed, tick = dp / u, rho = c->density;
    const int drop = (int)lround(DROP / dp), wide = (int)lround(BREADTH / dp),
              high = (int)lround(HEIGHT / dp);
    const int across[] = {1, wide - 1}, up[] = {1 + drop, drop + high};
    const double size[] = {wide * dp, (up[1] + 10) * dp, IMPACT_SLICE * dp}, h = high * dp,
                 middle = 0.5 * size[0];
    const double wall = rho * h * size[0] * impact_width(c),
                 fluid = rho * h * (wide - 1) * dp * impact_fluid_width(c);
    const double from = c->contact - BEFORE * tick, to = c->contact + AFTER * tick,
                 exact = GRAVITY * to;
    const impact_span before = {0, c->contact - BEFORE * tick, 0}, hit = {from, to, 0},
                      after = {c->contact, c->contact + REST, 0};
    const impact_span still = {c->contact + REST_FROM, c->contact + REST, 0},
                      smooth = {0, after.to, tick};
    impact_water(c);
    impact_walls(c, size, false);
    impact_fill(c, across, up);
    driver_wall(d, "P", middle, 0, 0.5 * size[2], 2 * dp);
    driver_force(d, "F", "tank.y0", 1);
    impact_figure(c, "before", MPS_TRACE_LARGEST, "P", before, rho * GRAVITY * h);
    impact_figure(c, "impulse_walls", MPS_TRACE_INTEGRAL, "F", hit, -wall * exact);
    impact_figure(c, "impulse_fluid", MPS_TRACE_CHANGE, "momentum_y", hit,
                  fluid * (exact - GRAVITY * (to - from)));
    impact_figure(c, "rebound", MPS_TRACE_LARGEST, "momentum_y", after, fluid * u);
    impact_figure(c, "still", MPS_TRACE_MEAN, "P", still, rho * GRAVITY * h);
    impact_figure(c, "still_least", MPS_TRACE_LEAST, "P", still, rho * GRAVITY * h);
    impact_figure(c, "still_largest", MPS_TRACE_LARGEST, "P", still, rho * GRAVITY * h);
    impact_figure(c, "least", MPS_TRACE_LEAST, "P", after, rho * GRAVITY * h);
    impact_figure(c, "peak_raw", MPS_TRACE_LARGEST, "P", (impact_span){0, after.to, 0},
                  rho * u * u);
    impact_figure(c, "peak_mean", MPS_TRACE_LARGEST, "P", smooth, rho * u * u);
}

/* ---- moving floor
 * ------------------------------------------------------------------------------------------- */

static int leave(void *user, double t, mps_motion_state *s)
{
    (void)user;
    s->value[MPS_MOVE_Y] = -GRAVITY * t * t;
    s->rate[MPS_MOVE_Y] = -2 * GRAVITY * t;
    s->accel[MPS_MOVE_Y] = -2 * GRAVITY;
    return 0;
}

static void set_floor(impact *c, driver *d)
{
    (void)c;
    d->gravity = GRAVITY;
    d->t_end = PULL;
}

static void build_floor(impact *c)
{
    driver *d = &c->d;
    const double dp = d->dp, rho = c->density;
    const int wide = (int)lround(0.5 * BREADTH / dp), high = (int)lround(HEIGHT / dp);
    const int across[] = {wide, 2 * wide - 1}, up[] = {1, high};
    const double size[] = {(3 * wide - 1) * dp, 2 * high * dp, IMPACT_SLICE * dp}, h = high * dp,
                 middle = 0.5 * size[0], depth = 0.5 * size[2];
    const double fluid = rho * h * wide * dp * impact_fluid_width(c) * GRAVITY * PULL;
    const impact_span raw = {0, PULL, 0}, smooth = {0, PULL, 0.01}, mean = {0, PULL, 0};
    static const char *const name[] = {"P_middle", "P_rim"},
                             *const least[] = {"middle_least", "rim_least"},
                             *const least_mean[] = {"middle_least_mean", "rim_least_mean"},
                             *const means[] = {"middle_mean", "rim_mean"};
    impact_water(c);
    impact_walls(c, size, false);
    impact_fill(c, across, up);
    driver_check(d, mps_motion_callback_set(d->sim, leave, NULL), "motion");
    for (int i = 0; i < 2; i++) {
        driver_wall(d, name[i], i == 0 ? middle : (wide + 1) * dp, 0, depth, 2 * dp);
        impact_figure(c, least[i], MPS_TRACE_LEAST, name[i], raw, rho * GRAVITY * h);
        impact_figure(c, least_mean[i], MPS_TRACE_LEAST, name[i], smooth, rho * GRAVITY * h);
        impact_figure(c, means[i], MPS_TRACE_MEAN, name[i], mean, rho * GRAVITY * h);
    }
    driver_measure(d, driver_measure_of("gap", NULL, NULL));
    impact_figure(c, "gap", MPS_TRACE_CHANGE, "gap", raw, 0.5 * GRAVITY * PULL * PULL);
    impact_figure(c, "fall_fluid", MPS_TRACE_CHANGE, "momentum_y", raw, -fluid);
}

const impact_case impact_column = {set_column, build_column, 0.025, true};
const impact_case impact_floor = {set_floor, build_floor, 0.025, true};
