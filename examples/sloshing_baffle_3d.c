/* SPDX-License-Identifier: BSD-3-Clause */
/* Baffled tank of Zhang, Wan & Hino 2014 section 2.3: 0.57 x 0.5 x 0.31 m, 0.2 m of water, a baffle with a gap below it,
 * moved by x = a sin wt at the first natural frequency of the tank without it. */
#include "common/baffle.h"

/* The paper prints a width of 0.6 m. Its particle numbers at dp 0.005, 274195 of liquid and 102500 of solids, are those of a lattice
 * 0.31 m wide, closed 0.25 m above the floor, with a baffle of one column, 26 points high and 67 (walls and dummies too) wide, 25 of
 * the rows in the water. The printed baffle has 31 rows in it: with --layers 1 there are 273829 of liquid. */
static const double LENGTH = 0.57, HEIGHT = 0.5, WIDTH = 0.31, DEPTH = 0.2, AMPLITUDE = 0.03, OMEGA = 6.582;
static const baffle BAFFLE = {.middle = 0.278, .thickness = 0.006, .bottom = 0.05, .top = 0.2};

static void build(run *r)
{
    const mps_harmonic motion = {.dof = MPS_SURGE, .amplitude = r->options.amplitude, .omega = OMEGA};
    const double lo[] = {0, 0, 0}, hi[] = {LENGTH, DEPTH, WIDTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    tank.size[2] = WIDTH;
    run_check(r, mps_geometry_tank(r->sim, &tank, NULL), "tank");
    baffle_add(r, &BAFFLE, WIDTH);
    run_check(r, mps_geometry_fill_box(r->sim, 0, lo, hi, NULL), "water");
    run_check(r, mps_motion_set_harmonics(r->sim, 1, &motion), "motion");
}

static void add_columns(run *r)
{
    double level = run_level(r);
    run_gauge(r, "eta_a", LENGTH / 2 - 0.275, WIDTH / 2, level);
    run_gauge(r, "eta_b", LENGTH / 2, WIDTH / 2, level);
    run_gauge(r, "eta_c", LENGTH / 2 + 0.275, WIDTH / 2, level);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "sloshing_baffle_3d", "baffled tank of Zhang, Wan & Hino 2014, section 2.3: x = 0.03 m sin(6.582/s t)");
    o.dim = 3;
    o.dp = 0.02;
    o.dp_min = 0.002;
    o.dp_max = 0.025;
    o.t_end = 2;
    o.amplitude = AMPLITUDE;
    o.has_layers = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
