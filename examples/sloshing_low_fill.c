/* SPDX-License-Identifier: BSD-3-Clause */
/* Shallow tank of Wen, Zhao & Wan 2022 section 5.2: 0.6 x 0.6 m, 0.03 m of water, moved by x = -a (1 - cos wt). */
#include "common/tank.h"

static const tank_case tank = {
    .size = {0.6, 0.6},
    .depth = 0.03,
    .motion = {.dof = MPS_MOVE_X, .form = 1, .amplitude = 0.01, .omega = 2.825}};

static void add_columns(run *r, const tank_case *c)
{
    run_wall_pressure(r, "P1", 0, 0.02, 0);
    run_gauge(r, "eta_right", c->size[0] - 0.02, 0, run_level(r));
}

int main(int argc, char **argv)
{
    cli_options o;
    cli_defaults(
        &o, "sloshing_low_fill",
        "shallow tank of Wen, Zhao & Wan 2022, section 5.2: x = -0.01 m (1 - cos(2.825/s t))");
    o.dp = 0.00375;
    o.dp_min = 0.0005;
    o.dp_max = 0.015;
    o.t_end = 8.5;
    return tank_main(&o, &tank, add_columns, argc, argv);
}
