/* SPDX-License-Identifier: BSD-3-Clause */
/* Droplet of water in air without gravity, 5 mm in radius: pressure jump sigma/R at rest, or its
 * second mode with w^2 = 6 sigma/((rho_i + rho_o) R^3), excited by initial velocities of this
 * mode. */
#include "driver/tank.h"
#include <math.h>

static const double RADIUS = 5e-3, BOX = 20e-3, WATER = 1000, WATER_VISCOSITY = 1e-3;
static const double STRETCH = 0.05; /* amplitude of the oscillation [R] */
enum { REST, OSCILLATION };

static int in_drop(void *user, const double *x)
{
    (void)user;
    /* with the points on the circle the error of its area is below 3 % */
    return hypot(x[0] - BOX / 2, x[1] - BOX / 2) < (1 + 1e-9) * RADIUS;
}

static void build(driver *d)
{
    const double size[] = {BOX, BOX, 0}, lo[] = {0, 0};
    driver_phase(d, 0, WATER, WATER_VISCOSITY);
    driver_phase(d, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
    tank_walls(d, size);
    driver_check(d, mps_fill_add(d->sim, 0, in_drop, NULL, NULL), "water");
    driver_check(d, mps_fill_box_add(d->sim, 1, lo, size, NULL, NULL), "air");
}

/* Potential flow of r = R (1 + STRETCH sin(w t) cos(2 phi)) at t = 0: rate (x, -y) inside,
 * continuous at the surface and decaying outside. */
static void set_moving(driver *d)
{
    double rate = STRETCH * sqrt(6 * d->sigma / ((WATER + TANK_AIR_DENSITY) * pow(RADIUS, 3)));
    mps_lease kind = {.struct_size = sizeof kind}, x = {.struct_size = sizeof x},
              u = {.struct_size = sizeof u};
    driver_check(d, mps_lease_begin(d->sim, "kind", MPS_READ, &kind), "velocities");
    driver_check(d, mps_lease_begin(d->sim, "position", MPS_READ, &x), "velocities");
    driver_check(d, mps_lease_begin(d->sim, "velocity", MPS_WRITE, &u), "velocities");
    for (int64_t i = 0; i < x.count; i++) {
        if (kind.integers[i] != MPS_FLUID) continue;
        const double a = x.data[2 * i] - BOX / 2, b = x.data[2 * i + 1] - BOX / 2,
                     r2 = a * a + b * b, inside = RADIUS * RADIUS;
        const double outer = rate * pow(inside / r2, 2) / r2;
        u.data[2 * i] = r2 <= inside ? rate * a : outer * a * (a * a - 3 * b * b);
        u.data[2 * i + 1] = r2 <= inside ? -rate * b : outer * b * (3 * a * a - b * b);
    }
    driver_check(d, mps_lease_end(d->sim, &u), "velocities");
    driver_check(d, mps_lease_end(d->sim, &x), "velocities");
    driver_check(d, mps_lease_end(d->sim, &kind), "velocities");
}

static void add_columns(driver *d)
{
    const double jump = d->sigma / RADIUS;
    mps_measure dp = driver_measure_of(
                    "pressure_jump", "dp",
                    "Pressure jump: mean of the drop within half its radius less that of the air "
                    "beyond 1.5 radii"),
                rx = driver_measure_of(
                    "half_axis", "rx",
                    "Half axis of the drop along x: of the ellipse with the drop's second moment");
    dp.centre[0] = dp.centre[1] = BOX / 2;
    dp.radius = RADIUS;
    driver_measure(d, dp);
    driver_measure(d, rx);
    driver_marks(d, "sigma/R", "Pa", 1, &d->t_end, &jump);
}

int main(int argc, char **argv)
{
    driver d;
    int32_t mode = REST;
    driver_defaults(&d, "droplet",
                    "drop of water in air without gravity: pressure jump sigma/R, or oscillation");
    driver_own(&d, (option){"--mode", "rest|oscillation", "state of the drop at the start",
                            TYPE_CHOICE, &mode, 0, 0, false, NULL});
    d.model = "mmps";
    d.need = "tension.csf";
    d.dp = 4e-4;
    d.dp_min = 1e-5;
    d.dp_max = 1e-3;
    d.t_end = 0.25;
    d.gravity = 0;
    d.has_sigma = true;
    driver_parse(&d, argc, argv);
    driver_open(&d);
    build(&d);
    if (mode == OSCILLATION) set_moving(&d);
    add_columns(&d);
    return driver_run(&d);
}
