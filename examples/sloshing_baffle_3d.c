/* SPDX-License-Identifier: BSD-3-Clause */
/* Baffled tank of Zhang, Wan & Hino 2014 section 2.3: 0.57 x 0.5 x 0.31 m, 0.2 m of water, a baffle
 * with a gap below it, moved by x = a sin wt at the first natural frequency of the tank without
 * it. */
#include "driver/tank.h"

static const tank_case tank = {
    .size = {0.57, 0.5, 0.31},
    .depth = 0.2,
    .motion = {.dof = MPS_MOVE_X, .amplitude = 0.03, .omega = 6.582},
    .plate = {.middle = 0.278, .thickness = 0.006, .bottom = 0.05, .top = 0.2}};

/* The paper prints a width of 0.6 m. Its numbers of particles at dp 0.005, 274195 of liquid and
 * 102500 of solids, correspond to a lattice 0.31 m wide, closed 0.25 m above the floor, with a
 * baffle of one column, 26 points high and 67 wide (with walls and dummies), 25 of the rows in the
 * water. The printed baffle has 31 rows in the water: with --layers 1 there are 273829 liquid
 * particles. --paper-baffle builds the baffle of these numbers, from 0.08 m to one row above the
 * water, and the lower lid: 274195 of liquid and 111360 of solids, because each side of a thin
 * plate has its own walls and dummies. */
static void use_paper_lattice(tank_case *c, driver *d)
{
    c->size[1] = 0.25;
    c->plate.bottom = 0.08;
    c->plate.top = c->depth + d->dp;
    if (d->layers == 0) d->layers = 1;
}

static void add_columns(driver *d, const tank_case *c)
{
    double level = c->level, x = c->size[0] / 2, z = c->size[2] / 2;
    driver_gauge(d, "eta_a", 0.01, z, level);
    driver_gauge(d, "eta_b", x, z, level);
    driver_gauge(d, "eta_c", 0.56, z, level);
}

int main(int argc, char **argv)
{
    driver d;
    tank_case c = tank;
    bool paper = false;
    driver_defaults(
        &d, "sloshing_baffle_3d",
        "baffled tank of Zhang, Wan & Hino 2014, section 2.3: x = 0.03 m sin(6.582/s t)");
    d.dim = 3;
    d.dp = 0.02;
    d.dp_min = 0.002;
    d.dp_max = 0.025;
    d.t_end = 2;
    driver_own(
        &d,
        (option){
            "--paper-baffle", NULL,
            "one column, as high as the paper's particle numbers say; lid 0.25 m above the floor",
            TYPE_FLAG, &paper, 0, 0, true, NULL});
    tank_parse(&d, &c, argc, argv);
    if (paper) use_paper_lattice(&c, &d);
    return tank_run(&d, c, add_columns);
}
