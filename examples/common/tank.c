/* SPDX-License-Identifier: BSD-3-Clause */
/* Building tanks of water. */
#include "tank.h"
#include <math.h>
#include <string.h>

void tank_walls(run *r, const double *size)
{
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, size, sizeof tank.size);
    run_check(r, mps_tank_add(r->sim, &tank, NULL), "tank");
}

void tank_walls_about(run *r, const double *size, double middle, double *lo, double *hi)
{
    double dp = r->options.dp, half = (floor(size[1] / 2 / dp + 1e-6) + 0.5) * dp;
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, size, sizeof tank.size);
    tank.lo[1] = middle - half;
    tank.size[1] = 2 * half;
    for (int d = 0; d < 3; d++) {
        lo[d] = tank.lo[d];
        hi[d] = tank.lo[d] + tank.size[d];
    }
    run_check(r, mps_tank_add(r->sim, &tank, NULL), "tank");
}

static double still_level(void *user, mps_sim *sim)
{
    (void)sim;
    return *(const double *)user;
}

void tank_liquid(run *r, const double *hi, bool whole_rows, double *built)
{
    const double lo[3] = {0};
    if (whole_rows || run_has_gas(r) || strstr(r->options.model, ".paper"))
        run_check(r, mps_fill_box_add(r->sim, 0, lo, hi, NULL, built), "liquid");
    else
        run_check(r, mps_fill_level_add(r->sim, 0, lo, hi, NULL, built), "liquid");
}

void tank_fill(run *r, const double *size, double depth, bool whole_rows)
{
    const double level[3] = {size[0], depth, size[2]};
    double built[6];
    tank_liquid(r, level, whole_rows, built);
    r->level = built[r->options.dim + 1];
    run_figure_add(r, "still_level", "y of the still level as filled [m]", still_level, &r->level);
}

void tank_move(run *r, mps_harmonic motion)
{
    motion.ramp = r->options.ramp * 2 * acos(-1.0) / motion.omega;
    run_check(r, mps_motion_harmonics_set(r->sim, 1, &motion), "motion");
}

bool tank_moves_as_given(const run *r, const tank_case *c)
{
    return r->options.amplitude == c->motion.amplitude && r->options.ramp == 0;
}

void tank_build(run *r, const tank_case *c)
{
    const double lo[3] = {0};
    mps_harmonic motion = c->motion;
    motion.amplitude = r->options.amplitude;
    tank_walls(r, c->size);
    if (c->plate.top > 0) baffle_add(r, &c->plate, c->size[2]);
    tank_fill(r, c->size, c->depth, c->whole_rows);
    if (run_has_gas(r)) {
        run_phase(r, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
        run_check(r, mps_fill_box_add(r->sim, 1, lo, c->size, NULL, NULL), "air");
    }
    tank_move(r, motion);
}

void tank_parse(cli_options *o, const tank_case *c, int argc, char **argv)
{
    o->amplitude = c->motion.amplitude;
    o->has_ramp = true;
    o->has_layers = c->plate.top > 0;
    o->has_sigma = !o->has_layers;
    if (!o->has_layers)
        o->need =
            "reference.lid"; /* in a closed tank full of liquid and gas something must set the level of the pressures */
    cli_parse(o, argc, argv);
}

int tank_run(const cli_options *o, const tank_case *c, tank_columns_fn columns)
{
    run r;
    run_open(&r, o);
    tank_build(&r, c);
    columns(&r, c);
    return run_finish(&r);
}

int tank_main(cli_options *o, const tank_case *c, tank_columns_fn columns, int argc, char **argv)
{
    tank_parse(o, c, argc, argv);
    return tank_run(o, c, columns);
}
