/* SPDX-License-Identifier: BSD-3-Clause */
/* Surge tank of Zhang, Wan & Hino 2014 section 2.1: a tank 0.8 x 0.5 m, 0.25 m of water, moved by x = a sin wt. */
#include "common/run.h"

static const double WIDTH = 0.8, HEIGHT = 0.5, DEPTH = 0.25, AMPLITUDE = 0.02, OMEGA = 6.469;

/* Crests at the left wall in fully nonlinear potential flow started by the same velocity jump. */
static const double CREST_T[] = {1.11, 2.12, 3.19, 4.26, 5.19};
static const double CREST[] = {0.065, 0.120, 0.1585, 0.109, 0.019};

static void build(run *r)
{
    const mps_harmonic motion = {.dof = MPS_SURGE, .amplitude = r->options.amplitude, .omega = OMEGA};
    const double lo[] = {0, 0}, hi[] = {WIDTH, DEPTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = WIDTH;
    tank.size[1] = HEIGHT;
    run_check(r, mps_geometry_tank(r->sim, &tank, NULL), "tank");
    run_check(r, mps_geometry_fill_box(r->sim, 0, lo, hi, NULL), "water");
    run_check(r, mps_motion_set_harmonics(r->sim, 1, &motion), "motion");
}

static void add_columns(run *r)
{
    static const char *const name[] = {"P1", "P2", "P3", "P4", "P5"};
    double level = run_level(r), dp = r->options.dp;
    for (int i = 0; i < 5; i++) run_wall_pressure(r, name[i], 0, 0.05 * (i + 1), 0);
    run_gauge(r, "eta_left", dp, 0, level);
    run_gauge(r, "eta_right", WIDTH - dp, 0, level);
    if (r->options.amplitude == AMPLITUDE) run_mark_add(r, "crests, FNPF", "m", 5, CREST_T, CREST);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "sloshing_surge", "surge tank of Zhang, Wan & Hino 2014, section 2.1: x = 0.02 m sin(6.469/s t)");
    o.dp = 0.008;
    o.dp_min = 0.0005;
    o.dp_max = 0.05;
    o.t_end = 5.4;
    o.amplitude = AMPLITUDE;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
