/* SPDX-License-Identifier: BSD-3-Clause */
/* What the cases share: walls, liquid with a velocity, figures. */
#include "impact.h"
#include "common/ranks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void impact_weightless(impact *c, cli_options *o)
{
    o->gravity = 0;
    /* that of a flow of Froude number 10 over one spacing; limits dt at cfl 0.6 */
    o->velocity_scale = 0.1 * c->speed;
}

void impact_water(impact *c)
{
    run_phase(&c->run, 0, c->density, 0);
}

void impact_walls(impact *c, const double *size, bool open)
{
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < 3; d++) tank.size[d] = size[d];
    tank.open_top = open;
    run_check(&c->run, mps_tank_add(c->run.sim, &tank, NULL), "walls");
}

void impact_fill(impact *c, const int *columns, const int *rows)
{
    const double dp = c->run.options.dp, lo[] = {(columns[0] - 0.1) * dp, (rows[0] - 0.1) * dp, 0};
    const double hi[] = {(columns[1] + 0.1) * dp, (rows[1] + 0.1) * dp, 1e3};
    run_check(&c->run, mps_fill_box_add(c->run.sim, 0, lo, hi, NULL, NULL), "water");
}

void impact_start(impact *c, double u, double v)
{
    run *r = &c->run;
    mps_lease kind = {.struct_size = sizeof kind}, lease = {.struct_size = sizeof lease};
    run_check(r, mps_lease_begin(r->sim, "kind", MPS_READ, &kind), "velocities");
    run_check(r, mps_lease_begin(r->sim, "velocity", MPS_WRITE, &lease), "velocities");
    for (int64_t i = 0; i < lease.count; i++) {
        if (kind.integers[i] != MPS_FLUID) continue;
        lease.data[i * lease.stride] = u;
        lease.data[i * lease.stride + 1] = v;
    }
    run_check(r, mps_lease_end(r->sim, &lease), "velocities");
    run_check(r, mps_lease_end(r->sim, &kind), "velocities");
}

double impact_width(const impact *c)
{
    return c->run.options.dim == 3 ? IMPACT_SLICE * c->run.options.dp : 1;
}

double impact_fluid_width(const impact *c)
{
    return c->run.options.dim == 3 ? (IMPACT_SLICE - 1) * c->run.options.dp : 1;
}

/* What a measure is, from its own numbers. */
static void tell_measure(const impact *c, const trace_measure *m, char *out, size_t size)
{
    static const char *const kind[] = {
        [TRACE_GIVEN] = "",          [TRACE_INTEGRAL] = "integral over time of",
        [TRACE_MEAN] = "mean of",    [TRACE_CHANGE] = "change of",
        [TRACE_LARGEST] = "largest", [TRACE_LEAST] = "least",
        [TRACE_SLOPE] = "slope of"};
    static const char *const flow[] = {"momentum of the fluid along x",
                                       "momentum of the fluid along y"};
    const int own = m->column - TRACE_OWN;
    if (m->kind == TRACE_GIVEN) {
        snprintf(out, size, "known beforehand, to compare with");
        return;
    }
    int used = snprintf(out, size, "%s %s", kind[m->kind],
                        own >= 0 ? c->run.column[own].name : flow[m->column - TRACE_MOMENTUM]);
    if (m->window > 0)
        used += snprintf(out + used, size - (size_t)used, ", means over %.4g s", m->window);
    used += snprintf(out + used, size - (size_t)used, ", t = %.4g to %.4g s", m->from, m->to);
    if (m->scale != 1) snprintf(out + used, size - (size_t)used, ", divided by %.5g", m->scale);
}

void impact_figure(impact *c, const char *name, trace_kind kind, int column, impact_span span,
                   double scale)
{
    run *r = &c->run;
    if (r->figures == RUN_FIGURES) {
        fprintf(ranks_messages(), "%s: more than %d figures\n", r->options.program, RUN_FIGURES);
        ranks_exit(CLI_FAILED);
    }
    trace_measure *m = &c->measure[r->figures];
    *m = (trace_measure){.rows = &c->rows,
                         .kind = kind,
                         .column = column,
                         .from = span.from,
                         .to = span.to,
                         .window = span.window,
                         .scale = scale};
    char about[160];
    tell_measure(c, m, about, sizeof about);
    run_figure_add(r, name, about, trace_figure, m);
}

void impact_given(impact *c, const char *name, double value)
{
    impact_figure(c, name, TRACE_GIVEN, 0, (impact_span){0}, value);
}

int impact_last(const impact *c)
{
    return TRACE_OWN + c->run.columns - 1;
}
