/* SPDX-License-Identifier: BSD-3-Clause */
/* Two fluids at rest, Wen, Zhao & Wan 2022 section 4.1: 0.75 m of 1000 kg/m3 below 0.75 m of
 * 1 kg/m3 in a closed tank 1 m wide. */
#include "driver/tank.h"

static const double SIZE[] = {1, 1.5, 0}, LAYER = 0.75, HEAVY = 1000, LIGHT = 1, VISCOSITY = 1e-3;

static void build(driver *d)
{
    double lo[3], hi[3];
    driver_phase(d, 0, HEAVY, VISCOSITY);
    driver_phase(d, 1, LIGHT, VISCOSITY);
    tank_walls_about(d, SIZE, LAYER, lo, hi);
    driver_check(d, mps_fill_box_add(d->sim, 0, lo, (const double[]){hi[0], LAYER}, NULL, NULL),
                 "heavy fluid");
    driver_check(d, mps_fill_box_add(d->sim, 1, lo, hi, NULL, NULL), "light fluid");
}

static void add_columns(driver *d)
{
    static const char *const name[] = {"P1", "P2", "P3"};
    mps_measure trespass = driver_measure_of(
        "trespass", NULL, "how far a fluid reaches beyond the interface at the end [m]");
    for (int i = 0; i < 3; i++) driver_wall(d, name[i], 0, 0.25 * (i + 1), 0, 0);
    trespass.level = LAYER;
    trespass.at_end = 1;
    driver_measure(d, trespass);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(
        &d, "static_two_fluid",
        "two fluids at rest, Wen, Zhao & Wan 2022, section 4.1: 1000 kg/m3 below 1 kg/m3");
    d.model = "mmps";
    d.need = "reference.lid";
    d.dp = 0.02;
    d.dp_min = 0.001;
    d.dp_max = 0.1;
    d.t_end = 5;
    d.has_sigma = true;
    driver_parse(&d, argc, argv);
    driver_open(&d);
    build(&d);
    add_columns(&d);
    return driver_run(&d);
}
