/* SPDX-License-Identifier: BSD-3-Clause */
/* Shallow tank of Wen, Zhao & Wan 2022 section 5.2: 0.6 x 0.6 m, 0.03 m of water, moved by x = -a (1 - cos wt). */
#include "common/run.h"

static const double SIZE = 0.6, DEPTH = 0.03, AMPLITUDE = 0.01, OMEGA = 2.825;

static void build(run *r)
{
    const mps_harmonic motion = {.dof = MPS_SURGE, .form = 1, .amplitude = r->options.amplitude, .omega = OMEGA};
    const double lo[] = {0, 0}, hi[] = {SIZE, DEPTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = tank.size[1] = SIZE;
    run_check(r, mps_geometry_tank(r->sim, &tank, NULL), "tank");
    run_check(r, mps_geometry_fill_box(r->sim, 0, lo, hi, NULL), "water");
    run_check(r, mps_motion_set_harmonics(r->sim, 1, &motion), "motion");
}

static void add_columns(run *r)
{
    run_wall_pressure(r, "P1", 0, 0.02, 0);
    run_gauge(r, "eta_right", SIZE - 0.02, 0, run_level(r));
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "sloshing_low_fill", "shallow tank of Wen, Zhao & Wan 2022, section 5.2: x = -0.01 m (1 - cos(2.825/s t))");
    o.dp = 0.00375;
    o.dp_min = 0.0005;
    o.dp_max = 0.015;
    o.t_end = 8.5;
    o.amplitude = AMPLITUDE;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
