/* SPDX-License-Identifier: BSD-3-Clause */
/* A lying cylinder with elliptical ends, half full, in surge near its first natural frequency; or a tank from an STL file. */
#include "common/tank.h"
#include <math.h>
#include <string.h>

/* The ends are half as deep as the radius, as dished heads usually are. */
static const double RADIUS = 0.25, STRAIGHT = 0.6, END = 0.125, FILL = 0.5, OMEGA = 4.8;

/* The tank's box and the level of the water [m]. */
typedef struct cylinder_case {
    double lo[3], hi[3], level;
} cylinder_case;

/* One component of the force on the tank. */
typedef struct force_column {
    int32_t probe, component;
} force_column;

/* Distance to the shell, > 0 inside; the lowest point is at y = 0, the ends at x = 0 and x = STRAIGHT + 2 END. */
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

static int under_water(void *user, const double *x)
{
    const cylinder_case *c = user;
    return x[1] < c->level;
}

static void add_shell(run *r, cylinder_case *c)
{
    const double lo[] = {0, 0, -RADIUS}, hi[] = {STRAIGHT + 2 * END, 2 * RADIUS, RADIUS};
    mps_solid solid;
    mps_solid_init(&solid, sizeof solid);
    solid.name = "tank";
    solid.distance = shell;
    memcpy(solid.lo, lo, sizeof lo);
    memcpy(solid.hi, hi, sizeof hi);
    memcpy(c->lo, lo, sizeof lo);
    memcpy(c->hi, hi, sizeof hi);
    run_check(r, mps_solid_add(r->sim, &solid), "tank");
}

static void add_file(run *r, cylinder_case *c)
{
    double box[6];
    mps_stl stl;
    mps_stl_init(&stl, sizeof stl);
    stl.name = "tank";
    stl.container = 1;
    stl.scale = r->options.stl_scale;
    run_check(r, mps_stl_add(r->sim, r->options.stl, &stl, box), "tank");
    memcpy(c->lo, box, sizeof c->lo);
    memcpy(c->hi, box + 3, sizeof c->hi);
}

static void build(run *r, cylinder_case *c)
{
    const mps_harmonic motion = {
        .dof = MPS_MOVE_X, .amplitude = r->options.amplitude, .omega = OMEGA};
    if (r->options.stl)
        add_file(r, c);
    else
        add_shell(r, c);
    c->level = c->lo[1] + FILL * (c->hi[1] - c->lo[1]) + 0.01 * r->options.dp;
    run_check(r, mps_fill_add(r->sim, 0, under_water, c, NULL), "water");
    tank_move(r, motion);
}

static double force_value(void *user, mps_sim *sim)
{
    const force_column *f = user;
    double values[6] = {0};
    return mps_probe_read(sim, f->probe, values) == MPS_OK ? values[f->component] : NAN;
}

static void add_columns(run *r, const cylinder_case *c)
{
    static force_column force[2] = {{.component = 0}, {.component = 1}};
    const double x = 0.5 * (c->lo[0] + c->hi[0]), z = 0.5 * (c->lo[2] + c->hi[2]),
                 quarter = 0.25 * (c->hi[0] - c->lo[0]);
    const double foot[] = {x, c->lo[1] + r->options.dp, z}, left[] = {x - quarter, foot[1], z};
    const double level = run_level(r);
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_FORCE;
    probe.part = "tank";
    run_check(r, mps_probe_add(r->sim, &probe, &force[0].probe), "force");
    force[1].probe = force[0].probe;
    run_wall_sensor(r, "P_bottom", x, c->lo[1], z, 2 * r->options.dp);
    run_gauge_from(r, "eta_middle", foot, level);
    run_gauge_from(r, "eta_left", left, level);
    run_value(r, "F_x", "N",
              "Pressure force along x: of the water on the tank; mean over the time in which "
              "liquid crosses a spacing",
              force_value, &force[0]);
    run_value(r, "F_y", "N",
              "Pressure force along y: of the water on the tank; mean over the time in which "
              "liquid crosses a spacing",
              force_value, &force[1]);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cylinder_case c = {{0}, {0}, 0};
    cli_defaults(
        &o, "cylinder_tank",
        "lying cylinder 0.85 m long, radius 0.25 m, half full: x = a sin(4.8/s t), a = 0.02 m");
    o.dim = 3;
    o.dp = 0.025;
    o.dp_min = 0.002;
    o.dp_max = 0.05;
    o.t_end = 3;
    o.amplitude = 0.02;
    o.has_ramp = o.has_stl = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r, &c);
    add_columns(&r, &c);
    return run_finish(&r);
}
