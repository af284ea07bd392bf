/* SPDX-License-Identifier: BSD-3-Clause */
/* Water at rest: 0.8 x 0.25 m in a tank 0.8 x 0.5 m, or 0.3 x 0.2 x 0.2 m in 3-D. Pressures must be hydrostatic and nothing move. */
#include "common/tank.h"

/* Inner size of the tank and depth of the water [m]; y is up. */
static const double SIZE[2][3] = {{0.8, 0.5, 0}, {0.3, 0.4, 0.2}};
static const double DEPTH[2] = {0.25, 0.2};

static void build(run *r)
{
    int k = r->options.dim - 2;
    tank_walls(r, SIZE[k]);
    tank_fill(r, SIZE[k], DEPTH[k], true);
}

static void add_columns(run *r)
{
    static const char *const name[] = {"P1", "P2", "P3"};
    double level = run_level(r), middle = SIZE[r->options.dim - 2][2] / 2;
    for (int i = 0; i < 3; i++) run_wall_pressure(r, name[i], 0, 0.05 * (i + 1), middle);
    run_gauge(r, "eta_left", r->options.dp, middle, level);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    cli_defaults(&o, "static_tank", "water at rest in a tank, 2-D or 3-D");
    o.has_dim = true;
    o.dp = 0.01;
    o.dp_min = 0.0005;
    o.dp_max = 0.05;
    o.t_end = 5;
    cli_parse(&o, argc, argv);
    run_open(&r, &o);
    build(&r);
    add_columns(&r);
    return run_finish(&r);
}
