/* SPDX-License-Identifier: BSD-3-Clause */
/* Drop of water in air without gravity, 5 mm in radius: pressure jump sigma/R at rest, or its second mode with
 * w^2 = 6 sigma/((rho_i + rho_o) R^3), started by the velocities of that mode. */
#include "common/phases.h"
#include "common/tank.h"
#include "common/view.h"
#include <math.h>

static const double RADIUS = 5e-3, BOX = 20e-3, WATER = 1000, WATER_VISCOSITY = 1e-3;
static const double STRETCH = 0.05; /* amplitude of the oscillation [R] */
enum { REST, OSCILLATION };

static int in_drop(void *user, const double *x)
{
    (void)user;
    /* with the points on the circle its area is right within 3 % */
    return hypot(x[0] - BOX / 2, x[1] - BOX / 2) < (1 + 1e-9) * RADIUS;
}

static void build(run *r)
{
    const double size[] = {BOX, BOX, 0}, lo[] = {0, 0};
    run_phase(r, 0, WATER, WATER_VISCOSITY);
    run_phase(r, 1, TANK_AIR_DENSITY, TANK_AIR_VISCOSITY);
    tank_walls(r, size);
    run_check(r, mps_fill_add(r->sim, 0, in_drop, NULL, NULL), "water");
    run_check(r, mps_fill_box_add(r->sim, 1, lo, size, NULL, NULL), "air");
}

/* Potential flow of r = R (1 + STRETCH sin(w t) cos(2 phi)) at t = 0: rate (x, -y) inside, the same at the surface and falling off outside. */
static void set_moving(run *r)
{
    double rate = STRETCH *
                  sqrt(6 * r->options.sigma / ((WATER + TANK_AIR_DENSITY) * pow(RADIUS, 3)));
    mps_lease kind = {.struct_size = sizeof kind}, x = {.struct_size = sizeof x},
              u = {.struct_size = sizeof u};
    run_check(r, mps_lease_begin(r->sim, "kind", MPS_READ, &kind), "velocities");
    run_check(r, mps_lease_begin(r->sim, "position", MPS_READ, &x), "velocities");
    run_check(r, mps_lease_begin(r->sim, "velocity", MPS_WRITE, &u), "velocities");
    for (int64_t i = 0; i < x.count; i++) {
        if (kind.integers[i] != MPS_FLUID) continue;
        const double a = x.data[2 * i] - BOX / 2, b = x.data[2 * i + 1] - BOX / 2,
                     r2 = a * a + b * b, inside = RADIUS * RADIUS;
        const double outer = rate * pow(inside / r2, 2) / r2;
        u.data[2 * i] = r2 <= inside ? rate * a : outer * a * (a * a - 3 * b * b);
        u.data[2 * i + 1] = r2 <= inside ? -rate * b : outer * b * (3 * a * a - b * b);
    }
    run_check(r, mps_lease_end(r->sim, &u), "velocities");
    run_check(r, mps_lease_end(r->sim, &x), "velocities");
    run_check(r, mps_lease_end(r->sim, &kind), "velocities");
}

/* Mean pressure of the inner half of the drop less that of the air beyond 1.5 R. */
static double jump(void *user, mps_sim *sim)
{
    view v;
    mps_lease p = {.struct_size = sizeof p};
    double sum[2] = {0};
    int64_t count[2] = {0};
    (void)user;
    if (!view_open(sim, &v)) return NAN;
    if (mps_lease_begin(sim, "pressure", MPS_READ, &p) == MPS_OK) {
        for (int64_t i = 0; i < v.x.count; i++) {
            const double r = hypot(v.x.data[2 * i] - BOX / 2, v.x.data[2 * i + 1] - BOX / 2) /
                             RADIUS;
            if (v.kind.integers[i] != MPS_FLUID || (r > 0.5 && r < 1.5)) continue;
            sum[r > 1] += p.data[i];
            count[r > 1]++;
        }
        mps_lease_end(sim, &p);
    }
    view_close(sim, &v);
    return count[0] && count[1] ? sum[0] / (double)count[0] - sum[1] / (double)count[1] : NAN;
}

/* Half axis along x of the ellipse with the drop's second moment: that of an ellipse is a quarter of its square. */
static double radius(void *user, mps_sim *sim)
{
    phase_means m;
    (void)user;
    return phase_means_get(sim, 0, &m) ? 2 * sqrt(m.x2[0] - m.x[0] * m.x[0]) : NAN;
}

static void add_columns(run *r)
{
    run_particle_value(
        r, "dp", "Pa",
        "Pressure jump: mean of the drop within half its radius less that of the air beyond "
        "1.5 radii",
        jump, NULL);
    r->column[r->columns - 1].pressure = true;
    run_particle_value(
        r, "rx", "m", "Half axis of the drop along x: of the ellipse with the drop's second moment",
        radius, NULL);
    run_mark_add(r, "sigma/R", "Pa", 1, &r->options.t_end, &(double){r->options.sigma / RADIUS});
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    int32_t mode = REST;
    cli_defaults(&o, "droplet",
                 "drop of water in air without gravity: pressure jump sigma/R, or oscillation");
    cli_own(&o, (cli_option){"--mode", "rest|oscillation", "state of the drop at the start",
                             TYPE_CHOICE, &mode, 0, 0, false});
    o.model = "mmps";
    o.need = "tension.csf";
    o.dp = 4e-4;
    o.dp_min = 1e-5;
    o.dp_max = 1e-3;
    o.t_end = 0.25;
    o.gravity = 0;
    o.has_sigma = true;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    if (mode == OSCILLATION) set_moving(&r);
    add_columns(&r);
    return run_finish(&r);
}
