/* SPDX-License-Identifier: BSD-3-Clause */
/* Lateral impact of a shallow liquid, SPHERIC validation test 10 (Souto-Iglesias et al. 2011): a tank 0.9 x 0.508 m, 0.093 m of water or
 * sunflower oil, rolls about the middle of its floor by 4 degrees, with 0.85 of the first natural period. It is 62 mm wide; in 2-D the friction of its
 * side walls, which matters for oil, is --use friction.sides --set friction.width=0.062 --set friction.omega=3.86. */
#include "common/tank.h"
#include <math.h>

enum { WATER, OIL };
static const struct {
    double density, viscosity;
} LIQUID[] = {{998, 8.94e-4}, {900, 0.045}};

static const double SIZE[] = {0.9, 0.508, 0.062}, DEPTH = 0.093, CYCLES = 0.85, DEGREES = 4,
                    PI = 3.14159265358979;

/* Period of the longest wave of a tank of this length, by linear theory. */
static double natural_period(double gravity)
{
    const double k = PI / SIZE[0];
    return 2 * PI / sqrt(gravity * k * tanh(k * DEPTH));
}

static double angle(void *user, mps_sim *sim)
{
    mps_motion_state s = {.struct_size = sizeof s};
    (void)user;
    return mps_motion_state_get(sim, &s) == MPS_OK ? s.value[MPS_ROTATE_Z] * 180 / PI : NAN;
}

static void build(run *r, int32_t liquid, mps_harmonic motion)
{
    const double lo[3] = {0}, middle[3] = {0.5 * SIZE[0], 0, 0.5 * SIZE[2]};
    tank_walls(r, SIZE);
    run_phase(r, 0, LIQUID[liquid].density, LIQUID[liquid].viscosity);
    tank_fill(r, SIZE, DEPTH, false);
    if (run_has_gas(r)) {
        run_phase(r, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
        run_check(r, mps_fill_box_add(r->sim, 1, lo, SIZE, NULL, NULL), "air");
    }
    run_check(r, mps_motion_centre_set(r->sim, middle, MPS_START_AT_REST), "centre");
    tank_move(r, motion);
}

/* Pressures at the still level on both sides, heights at both walls and at a quarter of the length. */
static void add_columns(run *r)
{
    const double level = run_level(r), dp = r->options.dp, z = 0.5 * SIZE[2];
    run_wall_pressure(r, "P_left", 0, DEPTH, z);
    run_wall_pressure(r, "P_right", SIZE[0], DEPTH, z);
    run_gauge(r, "eta_left", dp, z, level);
    run_gauge(r, "eta_quarter", 0.25 * SIZE[0], z, level);
    run_gauge(r, "eta_right", SIZE[0] - dp, z, level);
    run_value(r, "angle", "deg",
              "Roll angle of the tank: about the middle of its floor, counterclockwise", angle,
              NULL);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    int32_t liquid = OIL;
    double degrees = DEGREES, cycles = CYCLES;
    mps_harmonic motion = {.dof = MPS_ROTATE_Z};
    cli_defaults(&o, "sloshing_roll",
                 "lateral impact of a shallow liquid in a tank that rolls about the middle of its "
                 "floor, by 4 degrees");
    o.dp = 0.00775;
    o.dp_min = 0.001;
    o.dp_max = 0.031;
    o.t_end = 5;
    o.ramp = 0.5;
    o.has_dim = o.has_ramp = o.has_sigma = true;
    o.need =
        "reference.lid"; /* in a closed tank full of liquid and gas something must set the level of the pressures */
    cli_own(&o, (cli_option){"--liquid", "water|oil",
                             "998 kg/m3 and 0.894 mPa s, or 900 kg/m3 and 45 mPa s", TYPE_CHOICE,
                             &liquid, 0, 0, false});
    cli_own(&o, (cli_option){"--angle", "DEG", "amplitude of the roll [deg]", TYPE_REAL, &degrees,
                             0.01, 20, false});
    cli_own(&o, (cli_option){"--cycles", "R", "period over the first natural period", TYPE_REAL,
                             &cycles, 0.2, 5, false});
    cli_parse(&o, argc, argv);
    motion.amplitude = degrees * PI / 180;
    motion.omega = 2 * PI / (cycles * natural_period(o.gravity));
    run_open(&r, &o);
    build(&r, liquid, motion);
    add_columns(&r);
    return run_finish(&r);
}
