/* SPDX-License-Identifier: BSD-3-Clause */
/* Gravity. `column`: liquid as wide as its tank falls flat on the floor; nothing before, impulse rho h U, no rebound, rho g h in the end.
 * `floor`: a column that stands free on a floor which leaves downwards at 2 g. Liquid that the void reaches falls freely, with pressure 0 and a
 * gap of g t^2/2; it reaches the rim first. The middle is shut off from it: no air can get in there, so the floor takes its liquid along and
 * pulls until the void has come in from the rims. So the rim has an exact answer, the middle and its gap have none. */
#include "impact.h"
#include "common/view.h"
#include <math.h>

static const double HEIGHT = 0.5, DROP = 0.1, BREADTH = 0.4, GRAVITY = 9.81;
/* Time simulated after contact; statics are measured from REST_FROM on [s]. */
static const double REST = 1, REST_FROM = 0.5;
static const double PULL = 0.2;            /* time simulated [s] */
static const double BEFORE = 3, AFTER = 4; /* window about contact [dp/U] */

static void set_column(impact *c, cli_options *o)
{
    const double drop = lround(DROP / o->dp) * o->dp;
    o->gravity = GRAVITY;
    c->speed = sqrt(2 * GRAVITY * drop);
    c->contact = c->speed / GRAVITY;
    o->t_end = c->contact + REST;
}

static void build_column(impact *c)
{
    run *r = &c->run;
    const double dp = r->options.dp, u = c->speed, tick = dp / u, rho = c->density;
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
    run_wall_sensor(r, "P", middle, 0, 0.5 * size[2], 2 * dp);
    const int pressure = impact_last(c);
    run_force(r, "F", "tank.y0", 1);
    const int force = impact_last(c);
    impact_figure(c, "before", TRACE_LARGEST, pressure, before, rho * GRAVITY * h);
    impact_figure(c, "impulse_walls", TRACE_INTEGRAL, force, hit, -wall * exact);
    impact_figure(c, "impulse_fluid", TRACE_CHANGE, TRACE_MOMENTUM + 1, hit,
                  fluid * (exact - GRAVITY * (to - from)));
    impact_figure(c, "rebound", TRACE_LARGEST, TRACE_MOMENTUM + 1, after, fluid * u);
    impact_figure(c, "still", TRACE_MEAN, pressure, still, rho * GRAVITY * h);
    impact_figure(c, "still_least", TRACE_LEAST, pressure, still, rho * GRAVITY * h);
    impact_figure(c, "still_largest", TRACE_LARGEST, pressure, still, rho * GRAVITY * h);
    impact_figure(c, "least", TRACE_LEAST, pressure, after, rho * GRAVITY * h);
    impact_figure(c, "peak_raw", TRACE_LARGEST, pressure, (impact_span){0, after.to, 0},
                  rho * u * u);
    impact_figure(c, "peak_mean", TRACE_LARGEST, pressure, smooth, rho * u * u);
}

/* ---- the floor leaves ------------------------------------------------------------------------------------------- */

static int leave(void *user, double t, mps_motion_state *s)
{
    (void)user;
    s->value[MPS_MOVE_Y] = -GRAVITY * t * t;
    s->rate[MPS_MOVE_Y] = -2 * GRAVITY * t;
    s->accel[MPS_MOVE_Y] = -2 * GRAVITY;
    return 0;
}

/* Lowest liquid above its place on the floor. */
static double gap(void *user, mps_sim *sim)
{
    const double floor[3] = {0};
    double at[3] = {0}, lowest = INFINITY;
    view v;
    if (mps_motion_to_lab(sim, floor, at, NULL) != MPS_OK || !view_open(sim, &v)) return NAN;
    for (int64_t i = 0; i < v.x.count; i++)
        if (v.kind.integers[i] == MPS_FLUID) lowest = fmin(lowest, v.x.data[i * v.x.stride + 1]);
    view_close(sim, &v);
    return lowest - at[1] - ((const impact *)user)->run.options.dp;
}

static void set_floor(impact *c, cli_options *o)
{
    (void)c;
    o->gravity = GRAVITY;
    o->t_end = PULL;
}

static void build_floor(impact *c)
{
    run *r = &c->run;
    const double dp = r->options.dp, rho = c->density;
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
    run_check(r, mps_motion_callback_set(r->sim, leave, NULL), "motion");
    for (int i = 0; i < 2; i++) {
        run_wall_sensor(r, name[i], i == 0 ? middle : (wide + 1) * dp, 0, depth, 2 * dp);
        impact_figure(c, least[i], TRACE_LEAST, impact_last(c), raw, rho * GRAVITY * h);
        impact_figure(c, least_mean[i], TRACE_LEAST, impact_last(c), smooth, rho * GRAVITY * h);
        impact_figure(c, means[i], TRACE_MEAN, impact_last(c), mean, rho * GRAVITY * h);
    }
    run_particle_value(r, "gap", "m",
                       "Gap above the floor: from the floor to the lowest liquid, less a spacing",
                       gap, c);
    impact_figure(c, "gap", TRACE_CHANGE, impact_last(c), raw, 0.5 * GRAVITY * PULL * PULL);
    impact_figure(c, "fall_fluid", TRACE_CHANGE, TRACE_MOMENTUM + 1, raw, -fluid);
}

const impact_case impact_column = {set_column, build_column, 0.025, true};
const impact_case impact_floor = {set_floor, build_floor, 0.025, true};
