/* SPDX-License-Identifier: BSD-3-Clause */
/* First standing wave of a basin of length 1 m and depth 0.5 m, released from the surface a cos(pi
 * x/L), a = 0.02 m. */
#include "driver/driver.h"
#include <math.h>
#include <stdlib.h>

static const double LENGTH = 1, HEIGHT = 0.7, DEPTH = 0.5, AMPLITUDE = 0.02;

/* Displace the lattice point (x, y) by linear theory, which conserves areas: a linear stretch of
 * the columns would compress the water under the trough. The second-order error at the top of a
 * column is distributed over its height. */
static void displace(double x, double y, double k, double top, double *out)
{
    double a = AMPLITUDE / sinh(k * top);
    double surface_x = x - a * cosh(k * top) * sin(k * x), surface_y = top + AMPLITUDE * cos(k * x);
    out[0] = x - a * cosh(k * y) * sin(k * x);
    out[1] = y + a * sinh(k * y) * cos(k * x);
    out[1] *= (top + AMPLITUDE * cos(k * surface_x)) / surface_y;
}

static double add_water(driver *d, double length)
{
    double h[2], k = acos(-1.0) / length;
    driver_check(d, mps_lattice_get(d->sim, NULL, h), "water");
    int columns = (int)lround(length / h[0]) - 1, rows = (int)lround(DEPTH / h[1]);
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.count = (int64_t)columns * rows;
    double *x = malloc((size_t)block.count * 2 * sizeof *x);
    if (!x) driver_check(d, MPS_E_NOMEM, "water");
    for (int i = 0; x && i < columns; i++)
        for (int j = 0; j < rows; j++)
            displace((i + 1) * h[0], (j + 1) * h[1], k, rows * h[1],
                     x + 2 * ((int64_t)i * rows + j));
    block.position = x;
    mps_status status = mps_particles_add(d->sim, &block, NULL);
    free(x);
    driver_check(d, status, "water");
    return rows * h[1];
}

/* The still level. */
static double build(driver *d)
{
    mps_tank tank;
    double built[3];
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    driver_check(d, mps_tank_add(d->sim, &tank, built), "tank");
    return add_water(d, built[0]);
}

int main(int argc, char **argv)
{
    driver d;
    driver_defaults(&d, "standing_wave", "first standing wave of a basin 1 m long and 0.5 m deep");
    d.dp = 0.01;
    d.dp_min = 0.0005;
    d.dp_max = 0.05;
    d.t_end = 5.92; /* five periods */
    driver_parse(&d, argc, argv);
    driver_open(&d);
    const double level = build(&d);
    driver_gauge(&d, "eta_left", d.dp, 0, level);
    /* it measures odd modes only, which excludes the free second harmonic of the prescribed
     * cosine */
    driver_measure(&d, driver_measure_of("centre_of_mass", "x_centre",
                                         "Centre of mass along x: of all liquid"));
    return driver_run(&d);
}
