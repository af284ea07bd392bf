/* SPDX-License-Identifier: BSD-3-Clause */
/* Water at rest: 0.8 x 0.25 m in a tank 0.8 x 0.5 m, or 0.3 x 0.2 x 0.2 m in 3-D. Pressures must be
 * hydrostatic and velocities zero. */
#include "driver/tank.h"

/* Inner size of the tank and depth of the water [m]; y is up. */
static const double SIZE[2][3] = {{0.8, 0.5, 0}, {0.3, 0.4, 0.2}};
static const double DEPTH[2] = {0.25, 0.2};

static void build(driver *d)
{
    int k = d->dim - 2;
    tank_walls(d, SIZE[k]);
    tank_fill(d, SIZE[k], DEPTH[k], true);
}

static void add_columns(driver *d)
{
    static const char *const name[] = {"P1", "P2", "P3"};
    double level = driver_top(d), middle = SIZE[d->dim - 2][2] / 2;
    for (int i = 0; i < 3; i++) driver_wall(d, name[i], 0, (i + 1) / 20.0, middle, 0);
    driver_gauge(d, "eta_left", d->dp, middle, level);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(&d, "static_tank", "water at rest in a tank, 2-D or 3-D");
    d.has_dim = true;
    d.dp = 0.01;
    d.dp_min = 0.0005;
    d.dp_max = 0.05;
    d.t_end = 5;
    driver_parse(&d, argc, argv);
    driver_open(&d);
    build(&d);
    add_columns(&d);
    return driver_run(&d);
}
