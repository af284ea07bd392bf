/* SPDX-License-Identifier: BSD-3-Clause */
/* Common code of the cases: walls, liquid with a velocity, figures. */
#include "impact.h"

void impact_weightless(impact *c, driver *d)
{
    d->gravity = 0;
    /* velocity scale of a flow with Froude number 10 at the length dp; limits dt at cfl 0.6 */
    d->velocity_scale = 0.1 * c->speed;
}

void impact_water(impact *c)
{
    driver_phase(&c->d, 0, c->density, 0);
}

void impact_walls(impact *c, const double *size, bool open)
{
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < 3; d++) tank.size[d] = size[d];
    tank.open_top = open;
    driver_check(&c->d, mps_tank_add(c->d.sim, &tank, NULL), "walls");
}

void impact_fill(impact *c, const int *columns, const int *rows)
{
    const double dp = c->d.dp, lo[] = {(columns[0] - 0.1) * dp, (rows[0] - 0.1) * dp, 0};
    const double hi[] = {(columns[1] + 0.1) * dp, (rows[1] + 0.1) * dp, 1e3};
    driver_check(&c->d, mps_fill_box_add(c->d.sim, 0, lo, hi, NULL, NULL), "water");
}

void impact_start(impact *c, double u, double v)
{
    driver *d = &c->d;
    mps_lease kind = {.struct_size = sizeof kind}, lease = {.struct_size = sizeof lease};
    driver_check(d, mps_lease_begin(d->sim, "kind", MPS_READ, &kind), "velocities");
    driver_check(d, mps_lease_begin(d->sim, "velocity", MPS_WRITE, &lease), "velocities");
    for (int64_t i = 0; i < lease.count; i++) {
        if (kind.integers[i] != MPS_FLUID) continue;
        lease.data[i * lease.stride] = u;
        lease.data[i * lease.stride + 1] = v;
    }
    driver_check(d, mps_lease_end(d->sim, &lease), "velocities");
    driver_check(d, mps_lease_end(d->sim, &kind), "velocities");
}

double impact_width(const impact *c)
{
    return c->d.dim == 3 ? IMPACT_SLICE * c->d.dp : 1;
}

double impact_fluid_width(const impact *c)
{
    return c->d.dim == 3 ? (IMPACT_SLICE - 1) * c->d.dp : 1;
}

void impact_figure(impact *c, const char *name, int32_t kind, const char *column, impact_span span,
                   double scale)
{
    mps_trace t;
    mps_trace_init(&t, sizeof t);
    t.kind = kind;
    t.name = name;
    t.column = column;
    t.from = span.from;
    t.to = span.to;
    t.window = span.window;
    t.scale = scale;
    driver_check_job(&c->d, mps_job_trace_add(c->d.job, &t));
}

void impact_told(impact *c, const char *name, const char *about, double value)
{
    mps_trace t;
    mps_trace_init(&t, sizeof t);
    t.kind = MPS_TRACE_GIVEN;
    t.name = name;
    t.about = about;
    t.scale = value;
    driver_check_job(&c->d, mps_job_trace_add(c->d.job, &t));
}

void impact_given(impact *c, const char *name, double value)
{
    impact_told(c, name, NULL, value);
}
