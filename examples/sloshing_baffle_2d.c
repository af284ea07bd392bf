/* SPDX-License-Identifier: BSD-3-Clause */
/* Baffled tank of Zhang, Wan & Hino 2014 section 2.2: 0.57 x 0.5 m, 0.18 m of water, a baffle on
 * the floor at mid-length, moved by x = a sin wt. */
#include "driver/tank.h"

static const tank_case tank = {
    .size = {0.57, 0.5},
    .depth = 0.18,
    .motion = {.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 3.53},
    .plate = {.middle = 0.285, .thickness = 0.006, .bottom = 0, .top = 0.15}};

static void add_columns(driver *d, const tank_case *c)
{
    const double level = c->level, on_baffle[] = {c->size[0] / 2, c->plate.top, 0};
    driver_gauge(d, "eta_a", 0.01, 0, level);
    driver_gauge_from(d, "eta_b", on_baffle, level);
    driver_gauge(d, "eta_c", 0.56, 0, level);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(&d, "sloshing_baffle_2d",
                    "baffled tank of Zhang, Wan & Hino 2014, section 2.2: x = 0.1 m sin(3.53/s t)");
    d.dp = 0.006;
    d.dp_min = 0.0005;
    d.dp_max = 0.02;
    d.t_end = 6;
    tank_parse(&d, &tank, argc, argv);
    return tank_run(&d, tank, add_columns);
}
