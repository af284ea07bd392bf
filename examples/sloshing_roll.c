/* SPDX-License-Identifier: BSD-3-Clause */
/* Lateral impact of a shallow liquid, SPHERIC validation test 10 (Souto-Iglesias et al. 2011): a
 * tank 0.9 x 0.508 m, 0.093 m of water or sunflower oil, rolls about the middle of its floor by 4
 * degrees, at 0.85 of the first natural period. It is 62 mm wide; in 2-D the friction of its side
 * walls, which matters for oil, is --use friction.history --set friction.width=0.062. */
#include "driver/tank.h"
#include <math.h>

enum { WATER, OIL };
static const struct {
    double density, viscosity;
} LIQUID[] = {{998, 8.94e-4}, {900, 0.045}};

static const double SIZE[] = {0.9, 0.508, 0.062}, DEPTH = 0.093, CYCLES = 0.85, DEGREES = 4,
                    PI = 3.14159265358979323846;

/* Period of the longest wave of a tank of this length, by linear theory. */
static double natural_period(double gravity)
{
    const double k = PI / SIZE[0];
    return 2 * PI / sqrt(gravity * k * tanh(k * DEPTH));
}

/* @return the still level */
static double build(driver *d, int32_t liquid, mps_harmonic motion)
{
    const double middle[3] = {0.5 * SIZE[0], 0, 0.5 * SIZE[2]};
    tank_walls(d, SIZE);
    driver_phase(d, 0, LIQUID[liquid].density, LIQUID[liquid].viscosity);
    const double level = tank_fill(d, SIZE, DEPTH, false);
    if (driver_has_gas(d)) tank_air(d, SIZE);
    driver_check(d, mps_motion_centre_set(d->sim, middle, MPS_START_AT_REST), "centre");
    tank_move(d, motion);
    return level;
}

/* Pressures at the still level on both sides, surface elevations at both walls and at a quarter of
 * the length. */
static void add_columns(driver *d, double level)
{
    const double dp = d->dp, z = 0.5 * SIZE[2];
    driver_wall(d, "P_left", 0, DEPTH, z, 0);
    driver_wall(d, "P_right", SIZE[0], DEPTH, z, 0);
    driver_gauge(d, "eta_left", dp, z, level);
    driver_gauge(d, "eta_quarter", 0.25 * SIZE[0], z, level);
    driver_gauge(d, "eta_right", SIZE[0] - dp, z, level);
    driver_measure(d, driver_measure_of("angle", NULL,
                                        "Roll angle of the tank: about the middle of its floor, "
                                        "counterclockwise"));
}

int main(int argc, char **argv)
{
    driver d;
    int32_t liquid = OIL;
    double degrees = DEGREES, cycles = CYCLES;
    mps_harmonic motion = {.dof = MPS_ROTATE_Z};
    driver_defaults(
        &d, "sloshing_roll",
        "lateral impact of a shallow liquid in a tank that rolls about the middle of its "
        "floor, by 4 degrees");
    d.dp = 0.00775;
    d.dp_min = 0.001;
    d.dp_max = 0.031;
    d.t_end = 5;
    d.ramp = 0.5;
    d.has_dim = d.has_ramp = d.has_sigma = true;
    d.need = "reference.lid"; /* a closed tank full of liquid and gas needs a pressure datum */
    driver_own(&d, (option){"--liquid", "water|oil",
                            "998 kg/m3 and 0.894 mPa s, or 900 kg/m3 and 45 mPa s", TYPE_CHOICE,
                            &liquid, 0, 0, false, NULL});
    driver_own(&d, (option){"--angle", "DEG", "amplitude of the roll [deg]", TYPE_REAL, &degrees,
                            0.01, 20, false, NULL});
    driver_own(&d, (option){"--cycles", "R", "period over the first natural period", TYPE_REAL,
                            &cycles, 0.2, 5, false, NULL});
    driver_parse(&d, argc, argv);
    motion.amplitude = degrees * PI / 180;
    motion.omega = 2 * PI / (cycles * natural_period(d.gravity));
    driver_open(&d);
    add_columns(&d, build(&d, liquid, motion));
    return driver_run(&d);
}
