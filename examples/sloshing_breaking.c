/* SPDX-License-Identifier: BSD-3-Clause */
/* Breaking wave of Wen, Zhao & Wan 2022 section 5.3 (experiment of Rafiee et al. 2011): a tank 1.3 x 0.9 m, 0.18 m of water,
 * moved by x = a sin(2 pi f t). */
#include "common/run.h"
#include <math.h>

static const double WIDTH = 1.3, HEIGHT = 0.9, DEPTH = 0.18, AMPLITUDE = 0.1, FREQUENCY = 0.496;

static void build(run *r)
{
    const mps_harmonic motion = {.dof = MPS_SURGE, .amplitude = r->options.amplitude, .omega = 2 * acos(-1.0) * FREQUENCY};
    const double lo[] = {0, 0}, hi[] = {WIDTH, DEPTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = WIDTH;
    tank.size[1] = HEIGHT;
    run_check(r, mps_geometry_tank(r->sim, &tank, NULL), "tank");
    run_check(r, mps_geometry_fill_box(r->sim, 0, lo, hi, NULL), "water");
    run_check(r, mps_motion_set_harmonics(r->sim, 1, &motion), "motion");
}

/* The models have no air: what the liquid leaves of the tank, so a change is an error of the liquid's volume. */
static double air_volume(void *user, mps_sim *sim)
{
    mps_energy e;
    (void)user;
    mps_energy_init(&e, sizeof e);
    return mps_energy_get(sim, &e) == MPS_OK ? WIDTH * HEIGHT - e.volume : NAN;
}

static void add_columns(run *r)
{
    double level = run_level(r), dp = r->options.dp;
    run_wall_pressure(r, "P1", WIDTH, 0.165, 0);
    run_wall_pressure(r, "P2", WIDTH, 0.180, 0);
    run_wall_pressure(r, "P3", WIDTH, 0.195, 0);
    run_gauge(r, "eta_left", dp, 0, level);
    run_gauge(r, "eta_right", WIDTH - dp, 0, level);
    run_value(r, "air_volume", "m2", air_volume, NULL);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "sloshing_breaking", "breaking wave of Wen, Zhao & Wan 2022, section 5.3: x = 0.1 m sin(2 pi 0.496/s t)");
    o.dp = 0.01;
    o.dp_min = 0.0005;
    o.dp_max = 0.03;
    o.t_end = 4.5;
    o.amplitude = AMPLITUDE;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
