/* SPDX-License-Identifier: BSD-3-Clause */
/* Rising bubble of Hysing et al. 2009: a bubble of radius 0.25 m, 0.5 m above the floor of a box of 1 x 2 m, g = 0.98 m/s2; no slip at
 * the floor and the ceiling, free slip at the vertical walls where the model of viscosity can do that. */
#include "common/contour.h"
#include "common/phases.h"
#include "common/tank.h"
#include <math.h>

/* Liquid and bubble of both cases. */
typedef struct fluids {
    double density[2], viscosity[2], sigma;
} fluids;

static const fluids CASES[] = {{{1000, 100}, {10, 1}, 24.5}, {{1000, 1}, {10, 0.1}, 1.96}};
static const double SIZE[] = {1, 2, 0}, CENTRE[] = {0.5, 0.5}, RADIUS = 0.25, GRAVITY = 0.98;
static const double SMOOTHING = 2; /* of the interface, in spacings */

static int in_bubble(void *user, const double *x)
{
    (void)user;
    /* with the points on the circle */
    return hypot(x[0] - CENTRE[0], x[1] - CENTRE[1]) < (1 + 1e-9) * RADIUS;
}

static void build(run *r, const fluids *f)
{
    const double lo[] = {0, 0};
    for (int p = 0; p < 2; p++) run_phase(r, p, f->density[p], f->viscosity[p]);
    tank_walls(r, SIZE);
    run_check(r, mps_fill_add(r->sim, 1, in_bubble, NULL, NULL), "bubble");
    run_check(r, mps_fill_box_add(r->sim, 0, lo, SIZE, NULL, NULL), "liquid");
}

static double height(void *user, mps_sim *sim)
{
    phase_means m;
    (void)user;
    return phase_means_get(sim, 1, &m) ? m.x[1] : NAN;
}

static double speed(void *user, mps_sim *sim)
{
    phase_means m;
    (void)user;
    return phase_means_get(sim, 1, &m) ? m.u[1] : NAN;
}

/* Circumference of the circle of the same area over that of the bubble. */
static double circularity(void *user, mps_sim *sim)
{
    if (!raster_fill(user, sim)) return NAN;
    contour c = contour_measure(user);
    return 2 * sqrt(acos(-1.0) * c.area) / c.length;
}

static void add_columns(run *r, raster *g)
{
    const double lo[] = {0, 0};
    if (!raster_create(g, r->sim, lo, SIZE, SMOOTHING)) run_check(r, MPS_E_NOMEM, "interface");
    run_particle_value(r, "yc", "m", "Height of the bubble: y of its centre of mass", height, NULL);
    run_particle_value(r, "v", "m/s", "Rise velocity of the bubble: mean of its velocity along y",
                       speed, NULL);
    run_particle_value(
        r, "circularity", "",
        "Circularity of the bubble: circumference of the circle of the same area over its own",
        circularity, g);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    raster g;
    int32_t number = 0;
    cli_defaults(&o, "rising_bubble", "rising bubble of Hysing et al. 2009, case 1 or 2");
    cli_own(&o, (cli_option){"--case", "1|2", "case of the benchmark", TYPE_CHOICE, &number, 0, 0,
                             false});
    o.model = "mmps";
    o.need = "tension.csf";
    o.dp = 0.02;
    o.dp_min = 0.002;
    o.dp_max = 0.05;
    o.t_end = 3;
    o.gravity = GRAVITY;
    o.no_gas = true;
    o.prefer = "viscosity.slip=1"; /* walls across x */
    cli_parse(&o, argc, argv);
    o.sigma = CASES[number].sigma;
    run_open(&r, &o);
    build(&r, &CASES[number]);
    add_columns(&r, &g);
    int code = run_finish(&r);
    raster_free(&g);
    return code;
}
