/* SPDX-License-Identifier: BSD-3-Clause */
/* Liquid impacts on walls: cases of known impulse, force or pressure. summary.json has the figures,
 * trace.csv the values of every step. */
#include "impact/impact.h"

static const impact_case *const CASES[] = {&impact_flat, &impact_film,   &impact_wedge,
                                           &impact_jet,  &impact_column, &impact_floor,
                                           &impact_box,  &impact_toe};

static void choose(impact *c, const impact_case *chosen)
{
    driver *d = &c->d;
    if (d->dim == 3 && !chosen->in_space)
        driver_refuse(d, "--dim 3: this case is for 2 dimensions");
    if (d->dp == 0) d->dp = chosen->dp;
    const double t_end = d->t_end;
    chosen->set(c, d);
    if (d->probe_dt == 0)
        d->probe_dt = d->t_end /
                      500; /* independent of --t-end: a run can continue to a later one */
    if (t_end > 0) d->t_end = t_end;
}

int main(int argc, char **argv)
{
    static impact c = {.density = 1000, .speed = 1, .deadrise = 30, .block = 2, .layers = 2};
    driver *d = &c.d;
    int32_t number = 0;
    driver_defaults(d, "impact",
                    "liquid meets a wall: impulses, forces and pressures of exact solutions");
    driver_own(d, (option){"--case", "flat|film|wedge|jet|column|floor|box|toe", "kind of impact",
                           TYPE_CHOICE, &number, 0, 0, false, NULL});
    driver_own(d, (option){"--rows", "N", "film, toe: rows of particles", TYPE_INT, &c.layers, 1,
                           200, false, NULL});
    driver_own(d, (option){"--deadrise", "DEG",
                           "wedge, toe: angle between its side and the liquid's surface", TYPE_REAL,
                           &c.deadrise, 10, 60, false, NULL});
    driver_own(d, (option){"--block", "M", "wedge: half width and depth of the liquid [m]",
                           TYPE_REAL, &c.block, 0.5, 10, false, NULL});
    driver_own(d, (option){"--tip", "flat|wedge|round", "toe: its shape", TYPE_CHOICE, &c.tip, 0, 0,
                           false, NULL});
    driver_own(d, (option){"--shift", "X", "toe: middle of the tip beside that of the rows [dp]",
                           TYPE_REAL, &c.shift, -1, 1, false, NULL});
    d->has_dim = true;
    d->dp = 0;
    d->dp_min = 1e-4;
    d->dp_max = 0.1;
    d->t_end = 0;
    d->probe_dt = 0;
    d->sensor_average = 0; /* the figures have their own means */
    driver_parse(d, argc, argv);
    choose(&c, CASES[number]);
    driver_open(d);
    CASES[number]->build(&c);
    return driver_run(d);
}
