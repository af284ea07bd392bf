/* SPDX-License-Identifier: BSD-3-Clause */
/* Rayleigh-Taylor instability, Wen, Zhao & Wan 2022 section 4.2: 1.8 kg/m3 above 1 kg/m3 in a closed box of 1 x 2 m, mu = 2.5e-3 Pa s,
 * g = 1 m/s2, no surface tension, interface y = 1 - 0.15 sin(2 pi x). */
#include "common/contour.h"
#include "common/phases.h"
#include "common/tank.h"
#include <math.h>

static const double SIZE[] = {1, 2, 0}, HEAVY = 1.8, LIGHT = 1, VISCOSITY = 2.5e-3, GRAVITY = 1;
static const double SMOOTHING = 1.5; /* of the interface, in spacings */

/* Volume of fluid, 256 x 512 cells: lightest and heaviest tip. */
static const double TIP_T[] = {1, 2, 3, 4, 5, 1, 2, 3, 4, 5};
static const double TIP[] = {1.229, 1.392, 1.558, 1.702, 1.828, 0.767, 0.566, 0.337, 0.159, 0.093};

static int below(void *user, const double *x)
{
    (void)user;
    return x[1] < 1 - 0.15 * sin(2 * acos(-1.0) * x[0]);
}

static void build(run *r)
{
    double lo[3], hi[3];
    run_phase(r, 0, HEAVY, VISCOSITY);
    run_phase(r, 1, LIGHT, VISCOSITY);
    tank_walls_about(r, SIZE, 1, lo, hi);
    run_check(r, mps_fill_add(r->sim, 1, below, NULL, NULL), "light fluid");
    run_check(r, mps_fill_box_add(r->sim, 0, lo, hi, NULL, NULL), "heavy fluid");
}

/* Highest and lowest point of the interface. */
static double top(void *user, mps_sim *sim)
{
    return raster_fill(user, sim) ? contour_measure(user).hi[1] : NAN;
}

static double bottom(void *user, mps_sim *sim)
{
    return raster_fill(user, sim) ? contour_measure(user).lo[1] : NAN;
}

static double strays(void *user, mps_sim *sim)
{
    (void)user;
    return (double)phase_strays(sim);
}

static void add_columns(run *r, raster *g)
{
    const double lo[] = {0, 0};
    if (!raster_create(g, r->sim, lo, SIZE, SMOOTHING)) run_check(r, MPS_E_NOMEM, "interface");
    run_particle_value(r, "ytop", "m", "Highest point of the interface: y", top, g);
    run_particle_value(r, "ybot", "m", "Lowest point of the interface: y", bottom, g);
    run_mark_add(r, "tips, volume of fluid", "m", 10, TIP_T, TIP);
    run_particle_figure(r, "strays", "particles that strayed into the other fluid at the end",
                        strays, NULL);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    raster g;
    cli_defaults(
        &o, "rayleigh_taylor",
        "Rayleigh-Taylor instability, Wen, Zhao & Wan 2022, section 4.2: 1.8 kg/m3 above 1 kg/m3");
    o.model = "mmps";
    o.dp = 0.0125;
    o.dp_min = 0.001;
    o.dp_max = 0.05;
    o.t_end = 5;
    o.gravity = GRAVITY;
    o.sigma = 0;
    o.no_gas = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r, &g);
    int code = run_finish(&r);
    raster_free(&g);
    return code;
}
