/* SPDX-License-Identifier: BSD-3-Clause */
/* Build tanks of water. */
#include "tank.h"
#include <math.h>
#include <string.h>

void tank_walls(driver *d, const double *size)
{
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, size, sizeof tank.size);
    driver_check(d, mps_tank_add(d->sim, &tank, NULL), "tank");
}

void tank_walls_about(driver *d, const double *size, double middle, double *lo, double *hi)
{
    double dp = d->dp, half = (floor(size[1] / 2 / dp + 1e-6) + 0.5) * dp;
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, size, sizeof tank.size);
    tank.lo[1] = middle - half;
    tank.size[1] = 2 * half;
    for (int k = 0; k < 3; k++) {
        lo[k] = tank.lo[k];
        hi[k] = tank.lo[k] + tank.size[k];
    }
    driver_check(d, mps_tank_add(d->sim, &tank, NULL), "tank");
}

/* A vertical baffle on the nearest lattice points. Its faces are columns of wall particles, so n
 * columns are n - 1 cells thick; n is d->layers or follows from the thickness. */
static void add_baffle(driver *d, const baffle *b, double width)
{
    double h[3], columns = d->layers;
    driver_check(d, mps_lattice_get(d->sim, NULL, h), "baffle");
    if (columns < 1) columns = round(b->thickness / h[0]) + 1;
    double first = round(b->middle / h[0] - 0.5 * (columns - 1)) * h[0];
    const double lo[] = {first, round(b->bottom / h[1]) * h[1], 0},
                 hi[] = {first + (columns - 1) * h[0], round(b->top / h[1]) * h[1], width};
    driver_check(d, mps_baffle_add(d->sim, "baffle", lo, hi, NULL), "baffle");
}

void tank_liquid(driver *d, const double *hi, bool whole_rows, double *built)
{
    const double lo[3] = {0};
    if (whole_rows || driver_has_gas(d) || strstr(d->model, ".paper"))
        driver_check(d, mps_fill_box_add(d->sim, 0, lo, hi, NULL, built), "liquid");
    else
        driver_check(d, mps_fill_level_add(d->sim, 0, lo, hi, NULL, built), "liquid");
}

double tank_fill(driver *d, const double *size, double depth, bool whole_rows)
{
    const double level[3] = {size[0], depth, size[2]};
    double built[6];
    tank_liquid(d, level, whole_rows, built);
    driver_check_job(d, mps_job_level_set(d->job, built[d->dim + 1]));
    return built[d->dim + 1];
}

/* Gas in all that is left of a box from the origin. */
static void add_air(driver *d, const double *size)
{
    const double lo[3] = {0};
    driver_phase(d, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
    driver_check(d, mps_fill_box_add(d->sim, 1, lo, size, NULL, NULL), "air");
}

static double surge(void *user, mps_sim *sim)
{
    mps_motion_state tank = {.struct_size = sizeof tank};
    (void)user;
    return mps_motion_state_get(sim, &tank) < 0 ? NAN : tank.value[MPS_MOVE_X];
}

/* A harmonic motion that grows over the periods of --ramp. */
static void move(driver *d, mps_harmonic motion)
{
    motion.ramp = d->ramp * 2 * acos(-1.0) / motion.omega;
    driver_check(d, mps_motion_harmonics_set(d->sim, 1, &motion), "motion");
    driver_value(d, "surge", "m", "Displacement of the tank, surge: of the centre, as prescribed",
                 MPS_JOB_MOTION, surge, NULL);
}

bool tank_moves_as_given(const driver *d, const tank_case *c)
{
    return d->amplitude == c->motion.amplitude && d->ramp == 0;
}

void tank_parse(driver *d, const tank_case *c, int argc, char **argv)
{
    d->amplitude = c->motion.amplitude;
    d->has_ramp = true;
    d->has_layers = c->plate.top > 0;
    d->has_sigma = !d->has_layers;
    if (!d->has_layers)
        d->need = "reference.lid"; /* a closed tank full of liquid and gas needs a pressure datum */
    driver_parse(d, argc, argv);
}

int tank_run(driver *d, tank_case c, tank_columns_fn columns)
{
    mps_harmonic motion = c.motion;
    motion.amplitude = d->amplitude;
    driver_open(d);
    tank_walls(d, c.size);
    if (c.plate.top > 0) add_baffle(d, &c.plate, c.size[2]);
    c.level = tank_fill(d, c.size, c.depth, c.whole_rows);
    if (driver_has_gas(d)) add_air(d, c.size);
    move(d, motion);
    columns(d, &c);
    return driver_run(d);
}
