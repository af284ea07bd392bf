/* SPDX-License-Identifier: BSD-3-Clause */
/* Dam break of Lobovsky et al. 2014: a column of water 0.6 m long and 0.3 m high in a tank 1.61 x 0.6 m, in 3-D 0.15 m wide. */
#include "common/ranks.h"
#include "common/tank.h"
#include "common/view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LENGTH = 1.61, HEIGHT = 0.6, BREADTH = 0.15, COLUMN_LENGTH = 0.6,
                    COLUMN_HEIGHT = 0.3;
static const double DENSITY = 997, KINEMATIC_VISCOSITY = 8.9e-7; /* 25 degrees */
static const double SENSOR = 0.0042; /* diameter of the pressure sensors */

/* Bins along the tank, two spacings long, that tell the main body of liquid from drops ahead of it. */
typedef struct bins {
    int64_t count;
    double size;
    double *furthest; /* [count] largest x in the bin, 0: empty */
} bins;

static void build(run *r, double *built)
{
    const double hi[] = {COLUMN_LENGTH, COLUMN_HEIGHT, BREADTH};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    tank.size[2] = BREADTH;
    run_phase(r, 0, DENSITY, DENSITY * KINEMATIC_VISCOSITY);
    run_check(r, mps_tank_add(r->sim, &tank, built), "tank");
    tank_liquid(r, hi, false, NULL);
}

static bool bins_collect(const bins *b, mps_sim *sim)
{
    view v;
    const bool open = view_open(sim, &v);
    memset(b->furthest, 0, (size_t)b->count * sizeof *b->furthest);
    for (int64_t i = 0; open && i < v.x.count; i++) {
        double at = v.x.data[i * v.x.stride];
        int64_t k = (int64_t)(at / b->size);
        if (v.kind.integers[i] == MPS_FLUID && at > 0 && k < b->count)
            b->furthest[k] = fmax(b->furthest[k], at);
    }
    const bool all = ranks_most(!open) == 0;
    ranks_largest((int)b->count, b->furthest); /* ghosts change no maximum */
    return open && view_close(sim, &v) && all;
}

/* The front: how far liquid reaches from the left wall without a gap. */
static double front(void *user, mps_sim *sim)
{
    const bins *b = user;
    if (!bins_collect(b, sim)) return NAN;
    int64_t k = 0;
    while (k + 1 < b->count && b->furthest[k + 1] > 0) k++;
    return b->furthest[k];
}

static void add_columns(run *r, const double *built, bins *b)
{
    static const char *const name[] = {"P1", "P2", "P3", "P4"};
    static const double height[] = {0.003, 0.015, 0.030, 0.080};
    double middle = built[2] / 2;
    for (int i = 0; i < 4; i++) run_wall_sensor(r, name[i], built[0], height[i], middle, SENSOR);
    b->size = 2 * r->options.dp;
    b->count = (int64_t)(built[0] / b->size) + 1;
    b->furthest = calloc((size_t)b->count, sizeof *b->furthest);
    if (!b->furthest) run_check(r, MPS_E_NOMEM, "front");
    run_value(r, "front", "m",
              "Place of the front: how far liquid reaches from the left wall without a gap", front,
              b);
}

int main(int argc, char **argv)
{
    cli_options o;
    run r;
    bins b = {0};
    double built[3];
    cli_defaults(
        &o, "dam_break",
        "dam break of Lobovsky et al. 2014, 0.3 m high; dp 0.01 in 2-D, 0.02 in 3-D unless given");
    o.has_dim = true;
    o.dp_min = 0.0005;
    o.dp_max = 0.05;
    o.t_end = 1.4;
    cli_parse(&o, argc, argv);
    if (o.dp == 0) o.dp = o.dim == 3 ? 0.02 : 0.01;
    run_open(&r, &o);
    build(&r, built);
    add_columns(&r, built, &b);
    int code = run_finish(&r);
    free(b.furthest);
    return code;
}
