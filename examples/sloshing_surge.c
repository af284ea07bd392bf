/* SPDX-License-Identifier: BSD-3-Clause */
/* Surge tank of Zhang, Wan & Hino 2014 section 2.1: a tank 0.8 x 0.5 m, 0.25 m of water, moved
 * by x = a sin wt. */
#include "driver/tank.h"

static const tank_case tank = {.size = {0.8, 0.5},
                               .depth = 0.25,
                               .motion = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 6.469}};

/* Crests 8 mm from the left wall in fully nonlinear potential flow with the same initial velocity
 * jump (scripts/validation/potential.py). */
static const double CREST_T[] = {1.107, 2.121, 3.202, 4.289, 5.364};
static const double CREST[] = {0.0656, 0.1234, 0.1793, 0.1394, 0.0216};

static void add_columns(driver *d, const tank_case *c)
{
    static const char *const name[] = {"P1", "P2", "P3", "P4", "P5"};
    double level = c->level, dp = d->dp;
    for (int i = 0; i < 5; i++) driver_wall(d, name[i], 0, (i + 1) / 20.0, 0, 0);
    driver_gauge(d, "eta_left", dp, 0, level);
    driver_gauge(d, "eta_right", c->size[0] - dp, 0, level);
    if (tank_moves_as_given(d, c)) driver_marks(d, "crests, FNPF", "m", 5, CREST_T, CREST);
}

int main(int argc, char **argv)
{
    driver d;
    tank_case c = tank;
    driver_defaults(&d, "sloshing_surge",
                    "surge tank of Zhang, Wan & Hino 2014, section 2.1: x = 0.02 m sin(6.469/s t)");
    d.dp = 0.008;
    d.dp_min = 0.0005;
    d.dp_max = 0.05;
    d.t_end = 5.4;
    driver_own(
        &d,
        (option){
            "--whole-rows", NULL,
            "water up to the last whole row below its depth, as the paper's particle numbers say",
            TYPE_FLAG, &c.whole_rows, 0, 0, true, NULL});
    tank_parse(&d, &c, argc, argv);
    return tank_run(&d, c, add_columns);
}
