/* SPDX-License-Identifier: BSD-3-Clause */
/* A block or a film of liquid slides along a floor and meets a vertical wall, without gravity.
 *
 * Block of length L and height H, pressure 0 on its top and back (Cooker and Peregrine 1995):
 *   pressure impulse at depth d: rho U H sum 2 sin(l d/H) tanh(l L/H)/l^2,
 *   on the whole wall: rho U H^2 sum 2 tanh(l L/H)/l^3,   l = (n - 1/2) pi, n = 1, 2, ...
 * Long film of height h: the impact of a long block, then rho U^2 h. */
#include "impact.h"
#include <math.h>
#include <string.h>

/* Height of the block; spacing of rows, irrelevant for a film [m]. */
static const double HEIGHT = 1, ROW = 0.01;
static const double BEFORE = 3, SHORT = 1, LONG = 4, LATE = 12; /* windows around contact [dp/U] */
enum { FILM_LENGTH = 40, SERIES = 400 };

/* Impulses of the block; depth < 0: mean of the whole wall. */
static double impulse(double depth, double length)
{
    double sum = 0;
    for (int n = 1; n <= SERIES; n++) {
        const double l = (n - 0.5) * acos(-1.0);
        sum += 2 * tanh(l * length) / (l * l) * (depth < 0 ? 1 / l : sin(l * depth));
    }
    return sum;
}

/* Initial liquid of `rows` times `columns` particles, its foremost column IMPACT_GAP spacings from
 * the wall. @return position of the wall */
static double build_front(impact *c, int rows, int columns)
{
    const double dp = c->d.dp;
    const int wall = columns + 2 * IMPACT_GAP;
    const int across[] = {wall - IMPACT_GAP - columns + 1, wall - IMPACT_GAP}, up[] = {1, rows};
    const double size[] = {wall * dp, (2 * rows + 20) * dp, IMPACT_SLICE * dp};
    impact_water(c);
    impact_walls(c, size, false);
    impact_fill(c, across, up);
    impact_start(c, c->speed, 0);
    return wall * dp;
}

static void set_front(impact *c, driver *d)
{
    impact_weightless(c, d);
    c->contact = (IMPACT_GAP - 1) * d->dp / c->speed;
}

static void set_flat(impact *c, driver *d)
{
    set_front(c, d);
    d->t_end = c->contact + (LONG + 1) * d->dp / c->speed;
}

static void set_film(impact *c, driver *d)
{
    set_front(c, d);
    d->t_end = c->contact + (LATE + 1) * d->dp / c->speed;
}

static void add_sensor(impact *c, const char *name, double wall, double y)
{
    const double dp = c->d.dp;
    driver_wall(&c->d, name, wall, y, 0.5 * IMPACT_SLICE * dp, 2 * dp);
}

/* Impulse of a column from before the contact to `end` dp/U after it. */
static void add_impulse(impact *c, const char *name, const char *column, double end, double scale)
{
    const double tick = c->d.dp / c->speed;
    const impact_span span = {c->contact - BEFORE * tick, c->contact + end * tick, 0};
    const bool state = strcmp(column, "momentum_x") == 0;
    impact_figure(c, name, state ? MPS_TRACE_CHANGE : MPS_TRACE_INTEGRAL, column, span, scale);
}

static void build_flat(impact *c)
{
    static const struct {
        double depth;
        const char *column, *figure, *exact;
    } at[] = {{0.1, "P_10", "impulse_10", "exact_10"},
              {0.25, "P_25", "impulse_25", "exact_25"},
              {0.5, "P_50", "impulse_50", "exact_50"},
              {0.75, "P_75", "impulse_75", "exact_75"},
              {1, "P_bottom", "impulse_bottom", "exact_bottom"}};
    const double dp = c->d.dp, tick = dp / c->speed;
    const int rows = (int)lround(HEIGHT / dp);
    const double height = rows * dp, wall = build_front(c, rows, 2 * rows),
                 unit = c->density * c->speed * height;
    for (int i = 0; i < 5; i++) {
        add_sensor(c, at[i].column, wall, at[i].depth < 1 ? (1 - at[i].depth) * height : 2 * dp);
        add_impulse(c, at[i].figure, at[i].column, SHORT, unit);
        impact_given(c, at[i].exact, impulse(at[i].depth, 2));
    }
    const impact_span whole = {0, c->contact + LONG * tick, 0}, smooth = {0, whole.to, tick},
                      early = {0, c->contact - BEFORE * tick, 0};
    add_impulse(c, "impulse_bottom_late", "P_bottom", LONG, unit);
    driver_wall(&c->d, "P_mean", wall, 0.5 * height, 0.5 * IMPACT_SLICE * dp, height);
    add_impulse(c, "impulse_mean", "P_mean", SHORT, unit);
    add_impulse(c, "impulse_mean_late", "P_mean", LONG, unit);
    driver_force(&c->d, "F", "tank.x1", 0);
    add_impulse(c, "impulse_force", "F", SHORT, unit * height * impact_width(c));
    add_impulse(c, "impulse_fluid", "momentum_x", SHORT, -unit * height * impact_fluid_width(c));
    impact_given(c, "exact_mean", impulse(-1, 2));
    add_impulse(c, "impulse_force_late", "F", LONG, unit * height * impact_width(c));
    add_impulse(c, "impulse_fluid_late", "momentum_x", LONG,
                -unit * height * impact_fluid_width(c));
    impact_figure(c, "peak_raw", MPS_TRACE_LARGEST, "P_bottom", whole,
                  c->density * c->speed * c->speed);
    impact_figure(c, "peak_mean", MPS_TRACE_LARGEST, "P_bottom", smooth,
                  c->density * c->speed * c->speed);
    impact_figure(c, "force_before", MPS_TRACE_LARGEST, "F", early,
                  c->density * c->speed * c->speed * height * impact_width(c));
}

static void build_film(impact *c)
{
    const double dp = c->d.dp, tick = dp / c->speed, height = c->layers * dp;
    const double wall = build_front(c, c->layers, FILM_LENGTH),
                 unit = c->density * c->speed * dp * height;
    const double exact = impulse(-1, (double)FILM_LENGTH / c->layers) * c->layers + LONG;
    const impact_span late = {c->contact + LONG * tick, c->contact + LATE * tick, 0},
                      whole = {0, late.to, 0}, smooth = {0, late.to, tick};
    add_sensor(c, "P_bottom", wall, 2 * dp);
    driver_force(&c->d, "F", "tank.x1", 0);
    add_impulse(c, "impulse_walls", "F", LONG, unit * impact_width(c));
    add_impulse(c, "impulse_fluid", "momentum_x", LONG, -unit * impact_fluid_width(c));
    impact_given(c, "exact_fluid", exact);
    impact_given(c, "exact_half_cell", exact * (c->layers + 0.5) / c->layers);
    impact_figure(c, "late_walls", MPS_TRACE_INTEGRAL, "F", late, unit * impact_width(c));
    impact_figure(c, "late_fluid", MPS_TRACE_CHANGE, "momentum_x", late,
                  -unit * impact_fluid_width(c));
    impact_given(c, "late_exact", LATE - LONG);
    impact_figure(c, "peak_raw", MPS_TRACE_LARGEST, "P_bottom", whole,
                  c->density * c->speed * c->speed);
    impact_figure(c, "peak_mean", MPS_TRACE_LARGEST, "P_bottom", smooth,
                  c->density * c->speed * c->speed);
}

const impact_case impact_flat = {set_flat, build_flat, 0.05, true};
const impact_case impact_film = {set_film, build_film, ROW, true};
