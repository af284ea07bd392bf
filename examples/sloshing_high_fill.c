/* SPDX-License-Identifier: BSD-3-Clause */
/* Half-full tank of Wen, Zhao & Wan 2022 section 5.1: 0.6 x 0.6 m, 0.3 m of water, moved by
 * x = -a (1 - cos wt). */
#include "driver/tank.h"

static const tank_case tank = {
    .size = {0.6, 0.6},
    .depth = 0.3,
    .motion = {.dof = MPS_MOVE_X, .form = 1, .amplitude = 0.005, .omega = 6.85}};

/* Fully nonlinear potential flow: crests of the gauge above still level, and peaks of P1, two from
 * each hump after 3 s. */
static const double CREST_T[] = {1.16, 2.08, 2.99, 3.91, 4.85};
static const double CREST[] = {0.0244, 0.0456, 0.0700, 0.0982, 0.1303};
static const double PEAK_T[] = {0.58, 1.50, 2.40, 3.30, 3.60, 4.21, 4.55};
static const double PEAK[] = {2812, 2869, 2925, 2991, 2916, 3071, 3001};

static void add_columns(driver *d, const tank_case *c)
{
    driver_wall(d, "P1", 0, 0.02, 0, 0);
    driver_gauge(d, "eta_right", c->size[0] - 0.02, 0, c->level);
    if (!tank_moves_as_given(d, c)) return;
    driver_marks(d, "peaks of P1, FNPF", "Pa", 7, PEAK_T, PEAK);
    driver_marks(d, "crests, FNPF", "m", 5, CREST_T, CREST);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(
        &d, "sloshing_high_fill",
        "half-full tank of Wen, Zhao & Wan 2022, section 5.1: x = -0.005 m (1 - cos(6.85/s t))");
    d.dp = 0.01;
    d.dp_min = 0.0005;
    d.dp_max = 0.05;
    d.t_end = 5;
    tank_parse(&d, &tank, argc, argv);
    return tank_run(&d, tank, add_columns);
}
