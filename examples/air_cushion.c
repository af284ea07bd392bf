/* SPDX-License-Identifier: BSD-3-Clause */
/* A slug of water on a cushion of compressible air: w^2 = rho_a c^2/(rho_w L H), and at rest the cushion is shorter by
 * rho_w g L/(rho_a c^2) of its height H. The models of several phases know no free surface, so that the slug stands in the middle of a closed
 * tube between two columns of 2 H, which together are as stiff as one of H below it. It is let go where the air has no pressure.
 *
 * Water above air falls through it. To keep it up the slug is as tough as syrup and slides along the walls without friction: its motion as a
 * whole is that of water, only what bends its ends takes several times as long. */
#include "common/phases.h"
#include "common/tank.h"
#include <math.h>

static const double SLUG = 0.2, CUSHION = 0.2, WATER = 1000, TOUGH = 50;
static const double SPACINGS = 20; /* width of the tube */

/* The slug is half a spacing below the middle: the rows at its ends lie half a spacing inside it, those at the ends of the tube a whole one. */
static void build(run *r)
{
    const double dp = r->options.dp, column = dp * (double)lround(2 * CUSHION / dp),
                 length = dp * (double)lround(SLUG / dp);
    const double bottom = column - 0.5 * dp, lo[] = {0, 0},
                 hi[] = {SPACINGS * dp, 2 * column + length};
    const double slug_lo[] = {0, bottom}, slug_hi[] = {SPACINGS * dp, bottom + length};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = hi[0];
    tank.size[1] = hi[1];
    run_phase(r, 0, WATER, TOUGH);
    run_phase(r, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
    run_check(r, mps_tank_add(r->sim, &tank, NULL), "tube");
    run_check(r, mps_fill_box_add(r->sim, 0, slug_lo, slug_hi, NULL, NULL), "slug");
    run_check(r, mps_fill_box_add(r->sim, 1, lo, hi, NULL, NULL), "air");
}

/* How far the slug is above where it was let go. */
static double displacement(void *user, mps_sim *sim)
{
    phase_means m;
    const double *start = user;
    return phase_means_get(sim, 0, &m) ? m.x[1] - *start : NAN;
}

static void add_columns(run *r, double *start)
{
    phase_means m;
    if (!phase_means_get(r->sim, 0, &m)) run_check(r, MPS_E_STATE, "slug");
    *start = m.x[1];
    run_particle_value(r, "x_slug", "m",
                       "Rise of the slug: height of its centre of mass above that at the start",
                       displacement, start);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    double start;
    cli_defaults(&o, "air_cushion",
                 "slug of water, 0.2 m long, on a cushion of air: 9.718 Hz, 2.63 mm");
    o.model = "mmps";
    o.need = "gas.compressible";
    o.prefer = "viscosity.slip=1";
    o.dp = 0.01;
    o.dp_min = 0.001;
    o.dp_max = 0.04;
    o.t_end = 0.5;
    o.has_sigma = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r, &start);
    return run_finish(&r);
}
