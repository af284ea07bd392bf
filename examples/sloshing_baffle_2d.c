/* SPDX-License-Identifier: BSD-3-Clause */
/* Baffled tank of Zhang, Wan & Hino 2014 section 2.2: 0.57 x 0.5 m, 0.18 m of water, a baffle on the floor at mid-length,
 * moved by x = a sin wt. */
#include "common/tank.h"
#include <math.h>

static const tank_case tank = {
    .size = {0.57, 0.5},
    .depth = 0.18,
    .motion = {.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 3.53},
    .plate = {.middle = 0.285, .thickness = 0.006, .bottom = 0, .top = 0.15}};

static void add_columns(run *r, const tank_case *c)
{
    double h[2], level = run_level(r), middle = c->size[0] / 2;
    run_check(r, mps_lattice_get(r->sim, NULL, h), "baffle");
    const double top = floor(c->plate.top / h[1] + 1e-6) * h[1];
    const double on_baffle[] = {middle, top, 0};
    run_gauge(r, "eta_a", middle - 0.275, 0, level);
    run_gauge_from(r, "eta_b", on_baffle, level);
    run_gauge(r, "eta_c", middle + 0.275, 0, level);
}

int main(int argc, char **argv)
{
    cli_options o;
    cli_defaults(&o, "sloshing_baffle_2d",
                 "baffled tank of Zhang, Wan & Hino 2014, section 2.2: x = 0.1 m sin(3.53/s t)");
    o.dp = 0.006;
    o.dp_min = 0.0005;
    o.dp_max = 0.02;
    o.t_end = 6;
    return tank_main(&o, &tank, add_columns, argc, argv);
}
