/* SPDX-License-Identifier: BSD-3-Clause */
/* Rayleigh-Taylor instability, Wen, Zhao & Wan 2022 section 4.2: 1.8 kg/m3 above 1 kg/m3 in a
 * closed box of 1 x 2 m, mu = 2.5e-3 Pa s, g = 1 m/s2, no surface tension,
 * interface y = 1 - 0.15 sin(2 pi x). */
#include "driver/tank.h"
#include <math.h>
#include <string.h>

static const double SIZE[] = {1, 2, 0}, HEAVY = 1.8, LIGHT = 1, VISCOSITY = 2.5e-3, GRAVITY = 1;
static const double SMOOTHING = 1.5; /* of the interface [dp] */

/* Volume-of-fluid solution, 256 x 512 cells: tips of the light and the heavy fluid. */
static const double TIP_T[] = {1, 2, 3, 4, 5};
static const double TOP[] = {1.229, 1.392, 1.558, 1.702, 1.828},
                    BOTTOM[] = {0.767, 0.566, 0.337, 0.159, 0.093};

static int below(void *user, const double *x)
{
    (void)user;
    return x[1] < 1 - 0.15 * sin(2 * acos(-1.0) * x[0]);
}

static void build(driver *d)
{
    double lo[3], hi[3];
    driver_phase(d, 0, HEAVY, VISCOSITY);
    driver_phase(d, 1, LIGHT, VISCOSITY);
    tank_walls_about(d, SIZE, 1, lo, hi);
    driver_check(d, mps_fill_add(d->sim, 1, below, NULL, NULL), "light fluid");
    driver_check(d, mps_fill_box_add(d->sim, 0, lo, hi, NULL, NULL), "heavy fluid");
}

static void add_columns(driver *d)
{
    mps_measure top = driver_measure_of("interface_top", "ytop", NULL),
                bottom = driver_measure_of("interface_bottom", "ybot", NULL),
                strays = driver_measure_of("strays", NULL,
                                           "particles that strayed into the other fluid at the "
                                           "end");
    memcpy(top.box + 3, SIZE, sizeof SIZE);
    memcpy(bottom.box + 3, SIZE, sizeof SIZE);
    top.smoothing = bottom.smoothing = SMOOTHING;
    strays.at_end = 1;
    driver_measure(d, top);
    driver_measure(d, bottom);
    driver_measure(d, strays);
    driver_marks(d, "light tip, volume of fluid", "m", 5, TIP_T, TOP);
    driver_marks(d, "heavy tip, volume of fluid", "m", 5, TIP_T, BOTTOM);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(
        &d, "rayleigh_taylor",
        "Rayleigh-Taylor instability, Wen, Zhao & Wan 2022, section 4.2: 1.8 kg/m3 above 1 kg/m3");
    d.model = "mmps";
    d.dp = 0.0125;
    d.dp_min = 0.001;
    d.dp_max = 0.05;
    d.t_end = 5;
    d.gravity = GRAVITY;
    d.sigma = 0;
    d.no_gas = true;
    driver_parse(&d, argc, argv);
    driver_open(&d);
    build(&d);
    add_columns(&d);
    return driver_run(&d);
}
