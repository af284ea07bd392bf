/* SPDX-License-Identifier: BSD-3-Clause */
/* Liquid that meets walls: cases of known impulse, force or pressure. summary.json has the figures, trace.csv every step. */
#include "impact/impact.h"

static const impact_case *const CASES[] = {&impact_flat, &impact_film,   &impact_wedge,
                                           &impact_jet,  &impact_column, &impact_floor,
                                           &impact_box};

static void choose(impact *c, cli_options *o, const impact_case *chosen)
{
    if (o->dim == 3 && !chosen->in_space)
        cli_refuse(o, "--dim 3: this case is for 2 dimensions%s%s", "", "");
    if (o->dp == 0) o->dp = chosen->dp;
    const double t_end = o->t_end;
    chosen->set(c, o);
    if (o->probe_dt == 0)
        o->probe_dt = o->t_end /
                      500; /* the same with any --t-end: a run can go on to a later one */
    if (t_end > 0) o->t_end = t_end;
}

int main(int argc, char **argv)
{
    static impact c = {.density = 1000, .speed = 1, .deadrise = 30, .block = 2, .layers = 2};
    cli_options o;
    int32_t number = 0;
    cli_defaults(&o, "impact",
                 "liquid meets a wall: impulses, forces and pressures of exact solutions");
    cli_own(&o, (cli_option){"--case", "flat|film|wedge|jet|column|floor|box", "kind of impact",
                             TYPE_CHOICE, &number, 0, 0, false});
    cli_own(&o, (cli_option){"--rows", "N", "film: rows of particles", TYPE_INT, &c.layers, 1, 100,
                             false});
    cli_own(&o, (cli_option){"--deadrise", "DEG",
                             "wedge: angle between its side and the liquid's surface", TYPE_REAL,
                             &c.deadrise, 10, 60, false});
    cli_own(&o, (cli_option){"--block", "M", "wedge: half width and depth of the liquid [m]",
                             TYPE_REAL, &c.block, 0.5, 10, false});
    o.has_dim = true;
    o.dp = 0;
    o.dp_min = 1e-4;
    o.dp_max = 0.1;
    o.t_end = 0;
    o.probe_dt = 0;
    o.sensor_average = 0; /* the figures are means of their own */
    cli_parse(&o, argc, argv);
    choose(&c, &o, CASES[number]);
    run_open(&c.run, &o);
    trace_add(&c.run, &c.rows);
    CASES[number]->build(&c);
    return run_finish(&c.run);
}
