/* SPDX-License-Identifier: BSD-3-Clause */
/* Breaking wave of Wen, Zhao & Wan 2022 section 5.3 (experiment of Rafiee et al. 2011): a tank
 * 1.3 x 0.9 m, in 3-D 0.1 m wide, 0.18 m of water, moved by x = a sin(2 pi f t), f = 0.496 Hz. */
#include "driver/tank.h"
#include <math.h>
#include <string.h>

static const double FREQUENCY = 0.496;
static tank_case tank = {
    .size = {1.3, 0.9, 0.1}, .depth = 0.18, .motion = {.dof = MPS_MOVE_X, .amplitude = 0.1}};

static void add_columns(driver *d, const tank_case *c)
{
    static const char *const name[] = {"P1", "P2", "P3"};
    double level = c->level, dp = d->dp, middle = c->size[2] / 2;
    for (int i = 0; i < 3; i++) driver_wall(d, name[i], c->size[0], 0.165 + 0.015 * i, middle, 0);
    driver_gauge(d, "eta_left", dp, middle, level);
    driver_gauge(d, "eta_right", c->size[0] - dp, middle, level);
    /* the cavity under the plunging crest: it persists in a model with air and collapses without */
    mps_measure gas = driver_measure_of("trapped_gas", "air_volume", NULL);
    memcpy(gas.box + 3, c->size, sizeof c->size);
    driver_measure(d, gas);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(
        &d, "sloshing_breaking",
        "breaking wave of Wen, Zhao & Wan 2022, section 5.3: x = 0.1 m sin(2 pi 0.496/s t)");
    d.dp = 0.01;
    d.dp_min = 0.0005;
    d.dp_max = 0.03;
    d.t_end = 4.5;
    d.has_dim = true;
    driver_own(&d, (option){"--width", "M", "width of the tank in 3-D [m]", TYPE_REAL,
                            &tank.size[2], 0.01, 2, false, NULL});
    tank.motion.omega = 2 * acos(-1.0) * FREQUENCY;
    tank_parse(&d, &tank, argc, argv);
    return tank_run(&d, tank, add_columns);
}
