/* SPDX-License-Identifier: BSD-3-Clause */
/* A slug of water on a cushion of compressible air: w^2 = rho_a c^2/(rho_w L H); at rest the
 * cushion is compressed by rho_w g L/(rho_a c^2) of its height H. Models of several phases have no
 * free surface. Therefore the slug is in the middle of a closed tube between two columns of 2 H,
 * which together are as stiff as one of H below it. It is released where the air has no pressure.
 *
 * Water above air falls through it. To prevent this, the slug has a high viscosity and slides along
 * the walls without friction: its rigid motion is that of water, only the deformation of its ends
 * is several times slower. */
#include "driver/tank.h"
#include <math.h>

static const double SLUG = 0.2, CUSHION = 0.2, WATER = 1000, TOUGH = 50;
static const double SPACINGS = 20; /* width of the tube */

/* The slug is half a spacing below the middle: the rows at its ends are half a spacing inside it,
 * the rows at the ends of the tube one spacing. */
static void build(driver *d)
{
    const double dp = d->dp, column = dp * (double)lround(2 * CUSHION / dp),
                 length = dp * (double)lround(SLUG / dp);
    const double bottom = column - 0.5 * dp, lo[] = {0, 0},
                 hi[] = {SPACINGS * dp, 2 * column + length};
    const double slug_lo[] = {0, bottom}, slug_hi[] = {SPACINGS * dp, bottom + length};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = hi[0];
    tank.size[1] = hi[1];
    driver_phase(d, 0, WATER, TOUGH);
    driver_phase(d, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
    driver_check(d, mps_tank_add(d->sim, &tank, NULL), "tube");
    driver_check(d, mps_fill_box_add(d->sim, 0, slug_lo, slug_hi, NULL, NULL), "slug");
    driver_check(d, mps_fill_box_add(d->sim, 1, lo, hi, NULL, NULL), "air");
}

static void add_columns(driver *d)
{
    mps_measure rise = driver_measure_of(
        "centre", "x_slug",
        "Rise of the slug: height of its centre of mass above that at the start");
    rise.axis = 1;
    rise.change = 1;
    driver_measure(d, rise);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(&d, "air_cushion",
                    "slug of water, 0.2 m long, on a cushion of air: 9.718 Hz, 2.63 mm");
    d.model = "mmps";
    d.need = "gas.compressible";
    d.prefer = "viscosity.slip=1";
    d.dp = 0.01;
    d.dp_min = 0.001;
    d.dp_max = 0.04;
    d.t_end = 0.5;
    d.has_sigma = true;
    driver_parse(&d, argc, argv);
    driver_open(&d);
    build(&d);
    add_columns(&d);
    return driver_run(&d);
}
