/* SPDX-License-Identifier: BSD-3-Clause */
/* Shallow tank of Wen, Zhao & Wan 2022 section 5.2: 0.6 x 0.6 m, 0.03 m of water, moved by
 * x = -a (1 - cos wt). */
#include "driver/tank.h"

static const tank_case tank = {
    .size = {0.6, 0.6},
    .depth = 0.03,
    .motion = {.dof = MPS_MOVE_X, .form = 1, .amplitude = 0.01, .omega = 2.825}};

static void add_columns(driver *d, const tank_case *c)
{
    driver_wall(d, "P1", 0, 0.02, 0, 0);
    driver_gauge(d, "eta_right", c->size[0] - 0.02, 0, c->level);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(
        &d, "sloshing_low_fill",
        "shallow tank of Wen, Zhao & Wan 2022, section 5.2: x = -0.01 m (1 - cos(2.825/s t))");
    d.dp = 0.00375;
    d.dp_min = 0.0005;
    d.dp_max = 0.015;
    d.t_end = 8.5;
    tank_parse(&d, &tank, argc, argv);
    return tank_run(&d, tank, add_columns);
}
