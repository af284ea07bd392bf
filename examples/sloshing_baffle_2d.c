/* SPDX-License-Identifier: BSD-3-Clause */
/* Baffled tank of Zhang, Wan & Hino 2014 section 2.2: 0.57 x 0.5 m, 0.18 m of water, a baffle on the floor at mid-length,
 * moved by x = a sin wt. */
#include "common/baffle.h"
#include <math.h>

static const double WIDTH = 0.57, HEIGHT = 0.5, DEPTH = 0.18, AMPLITUDE = 0.1, OMEGA = 3.53;
static const baffle BAFFLE = {.middle = 0.285, .thickness = 0.006, .bottom = 0, .top = 0.15};

static void build(run *r)
{
    const mps_harmonic motion = {.dof = MPS_SURGE, .amplitude = r->options.amplitude, .omega = OMEGA};
    const double lo[] = {0, 0}, hi[] = {WIDTH, DEPTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = WIDTH;
    tank.size[1] = HEIGHT;
    run_check(r, mps_geometry_tank(r->sim, &tank, NULL), "tank");
    baffle_add(r, &BAFFLE, 0);
    run_check(r, mps_geometry_fill_box(r->sim, 0, lo, hi, NULL), "water");
    run_check(r, mps_motion_set_harmonics(r->sim, 1, &motion), "motion");
}

static void add_columns(run *r)
{
    double level = run_level(r), dp = r->options.dp, top = floor(BAFFLE.top / dp + 1e-6) * dp;
    const double on_baffle[] = {WIDTH / 2, top, 0};
    run_gauge(r, "eta_a", WIDTH / 2 - 0.275, 0, level);
    run_gauge_from(r, "eta_b", on_baffle, level);
    run_gauge(r, "eta_c", WIDTH / 2 + 0.275, 0, level);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "sloshing_baffle_2d", "baffled tank of Zhang, Wan & Hino 2014, section 2.2: x = 0.1 m sin(3.53/s t)");
    o.dp = 0.006;
    o.dp_min = 0.0005;
    o.dp_max = 0.02;
    o.t_end = 6;
    o.amplitude = AMPLITUDE;
    o.has_layers = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
