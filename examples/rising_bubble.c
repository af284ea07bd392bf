/* SPDX-License-Identifier: BSD-3-Clause */
/* Rising bubble of Hysing et al. 2009: a bubble of radius 0.25 m, 0.5 m above the floor of a box of
 * 1 x 2 m, g = 0.98 m/s2; no slip at the floor and the ceiling, free slip at the vertical walls if
 * the viscosity model supports it. */
#include "driver/tank.h"
#include <math.h>
#include <string.h>

/* Liquid and bubble of both cases. */
typedef struct fluids {
    double density[2], viscosity[2], sigma;
} fluids;

static const fluids CASES[] = {{{1000, 100}, {10, 1}, 24.5}, {{1000, 1}, {10, 0.1}, 1.96}};
static const double SIZE[] = {1, 2, 0}, CENTRE[] = {0.5, 0.5}, RADIUS = 0.25, GRAVITY = 0.98;
static const double SMOOTHING = 2; /* of the interface [dp] */

static int in_bubble(void *user, const double *x)
{
    (void)user;
    /* with the points on the circle */
    return hypot(x[0] - CENTRE[0], x[1] - CENTRE[1]) < (1 + 1e-9) * RADIUS;
}

static void build(driver *d, const fluids *f)
{
    const double lo[] = {0, 0};
    for (int p = 0; p < 2; p++) driver_phase(d, p, f->density[p], f->viscosity[p]);
    tank_walls(d, SIZE);
    driver_check(d, mps_fill_add(d->sim, 1, in_bubble, NULL, NULL), "bubble");
    driver_check(d, mps_fill_box_add(d->sim, 0, lo, SIZE, NULL, NULL), "liquid");
}

static void add_columns(driver *d)
{
    mps_measure height = driver_measure_of("centre", "yc",
                                           "Height of the bubble: y of its centre of mass"),
                speed = driver_measure_of("speed", "v",
                                          "Rise velocity of the bubble: mean of its velocity "
                                          "along y"),
                shape = driver_measure_of("circularity", NULL,
                                          "Circularity of the bubble: circumference of the circle "
                                          "of the same area over its own");
    height.phase = speed.phase = 1;
    height.axis = speed.axis = 1;
    memcpy(shape.box + 3, SIZE, sizeof SIZE);
    shape.smoothing = SMOOTHING;
    driver_measure(d, height);
    driver_measure(d, speed);
    driver_measure(d, shape);
}

int main(int argc, char **argv)
{
    driver d;
    int32_t number = 0;
    driver_defaults(&d, "rising_bubble", "rising bubble of Hysing et al. 2009, case 1 or 2");
    driver_own(&d, (option){"--case", "1|2", "case of the benchmark", TYPE_CHOICE, &number, 0, 0,
                            false, NULL});
    d.model = "mmps";
    d.need = "tension.csf";
    d.dp = 0.02;
    d.dp_min = 0.002;
    d.dp_max = 0.05;
    d.t_end = 3;
    d.gravity = GRAVITY;
    d.no_gas = true;
    d.prefer = "viscosity.slip=1"; /* walls across x */
    driver_parse(&d, argc, argv);
    d.sigma = CASES[number].sigma;
    driver_open(&d);
    build(&d, &CASES[number]);
    add_columns(&d);
    return driver_run(&d);
}
