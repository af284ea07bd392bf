/* SPDX-License-Identifier: BSD-3-Clause */
/* A lying cylinder with elliptical ends, half full, in surge near its first natural frequency; or a
 * tank from an STL file. */
#include "driver/tank.h"
#include <math.h>
#include <string.h>

/* The depth of the ends is half the radius, as usual for dished heads. */
static const double RADIUS = 0.25, STRAIGHT = 0.6, END = 0.125, FILL = 0.5, OMEGA = 4.8;

/* Bounding box of the tank and level of the water [m]. */
typedef struct cylinder_case {
    double lo[3], hi[3], level;
} cylinder_case;

/* Distance to the shell, > 0 inside; the lowest point is at y = 0, the ends at x = 0 and
 * x = STRAIGHT + 2 END. */
static double shell(void *user, const double *x)
{
    const double y = x[1] - RADIUS, r = sqrt(y * y + x[2] * x[2]);
    const double out = fmax(END - x[0], x[0] - END - STRAIGHT);
    (void)user;
    if (out <= 0) return RADIUS - r;
    /* value over slope of the ellipsoid */
    const double value = hypot(out / END, r / RADIUS),
                 slope = hypot(out / (END * END), r / (RADIUS * RADIUS));
    return value * (1 - value) / slope;
}

static void add_shell(driver *d, cylinder_case *c)
{
    mps_solid solid;
    *c = (cylinder_case){{0, 0, -RADIUS}, {STRAIGHT + 2 * END, 2 * RADIUS, RADIUS}, 0};
    mps_solid_init(&solid, sizeof solid);
    solid.name = "tank";
    solid.distance = shell;
    memcpy(solid.lo, c->lo, sizeof solid.lo);
    memcpy(solid.hi, c->hi, sizeof solid.hi);
    driver_check(d, mps_solid_add(d->sim, &solid), "tank");
}

static void add_file(driver *d, cylinder_case *c)
{
    double box[6];
    mps_stl stl;
    mps_stl_init(&stl, sizeof stl);
    stl.name = "tank";
    stl.container = 1;
    stl.scale = d->stl_scale;
    driver_check(d, mps_stl_add(d->sim, d->stl, &stl, box), "tank");
    memcpy(c->lo, box, sizeof c->lo);
    memcpy(c->hi, box + 3, sizeof c->hi);
}

static void build(driver *d, cylinder_case *c)
{
    const mps_harmonic motion = {.dof = MPS_MOVE_X, .amplitude = d->amplitude, .omega = OMEGA};
    if (d->stl)
        add_file(d, c);
    else
        add_shell(d, c);
    const double top[] = {c->hi[0], c->lo[1] + FILL * (c->hi[1] - c->lo[1]), c->hi[2]};
    double built[6];
    driver_check(d, mps_fill_level_add(d->sim, 0, c->lo, top, NULL, built), "water");
    c->level = built[4];
    driver_check_job(d, mps_job_level_set(d->job, c->level));
    tank_move(d, motion);
}

static void add_columns(driver *d, const cylinder_case *c)
{
    const double x = 0.5 * (c->lo[0] + c->hi[0]), z = 0.5 * (c->lo[2] + c->hi[2]),
                 quarter = 0.25 * (c->hi[0] - c->lo[0]);
    const double foot[] = {x, c->lo[1] + d->dp, z}, left[] = {x - quarter, foot[1], z};
    driver_wall(d, "P_bottom", x, c->lo[1], z, 2 * d->dp);
    driver_gauge_from(d, "eta_middle", foot, c->level);
    driver_gauge_from(d, "eta_left", left, c->level);
    driver_force(d, "F_x", "tank", 0);
    driver_force(d, "F_y", "tank", 1);
}

int main(int argc, char **argv)
{
    driver d;
    cylinder_case c = {{0}, {0}, 0};
    driver_defaults(
        &d, "cylinder_tank",
        "lying cylinder 0.85 m long, radius 0.25 m, half full: x = a sin(4.8/s t), a = 0.02 m");
    d.dim = 3;
    d.dp = 0.025;
    d.dp_min = 0.002;
    d.dp_max = 0.05;
    d.t_end = 3;
    d.amplitude = 0.02;
    d.has_ramp = d.has_stl = true;
    driver_parse(&d, argc, argv);
    driver_open(&d);
    build(&d, &c);
    add_columns(&d, &c);
    return driver_run(&d);
}
