/* SPDX-License-Identifier: BSD-3-Clause */
/* Dam break of Lobovsky et al. 2014: a column of water 0.6 m long and 0.3 m high in a tank
 * 1.61 x 0.6 m, in 3-D 0.15 m wide. */
#include "driver/tank.h"
#include <string.h>

static const double LENGTH = 1.61, HEIGHT = 0.6, BREADTH = 0.15, COLUMN_LENGTH = 0.6,
                    COLUMN_HEIGHT = 0.3;
static const double DENSITY = 997, KINEMATIC_VISCOSITY = 8.9e-7; /* 25 degrees */
static const double SENSOR = 0.0042; /* diameter of the pressure sensors */

static void build(driver *d, double *built)
{
    const double hi[] = {COLUMN_LENGTH, COLUMN_HEIGHT, BREADTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    tank.size[2] = BREADTH;
    driver_phase(d, 0, DENSITY, DENSITY * KINEMATIC_VISCOSITY);
    driver_check(d, mps_tank_add(d->sim, &tank, built), "tank");
    tank_liquid(d, hi, false, NULL);
}

static void add_columns(driver *d, const double *built)
{
    static const char *const name[] = {"P1", "P2", "P3", "P4"};
    static const double height[] = {0.003, 0.015, 0.030, 0.080};
    mps_measure front = driver_measure_of("front", NULL, NULL);
    for (int i = 0; i < 4; i++) driver_wall(d, name[i], built[0], height[i], built[2] / 2, SENSOR);
    memcpy(front.box + 3, built, 3 * sizeof *built);
    driver_measure(d, front);
}

int main(int argc, char **argv)
{
    driver d;
    double built[3];
    driver_defaults(
        &d, "dam_break",
        "dam break of Lobovsky et al. 2014, 0.3 m high; dp 0.01 in 2-D, 0.02 in 3-D unless given");
    d.has_dim = true;
    d.dp_min = 0.0005;
    d.dp_max = 0.05;
    d.t_end = 1.4;
    driver_parse(&d, argc, argv);
    if (d.dp == 0) d.dp = d.dim == 3 ? 0.02 : 0.01;
    driver_open(&d);
    build(&d, built);
    add_columns(&d, built);
    return driver_run(&d);
}
