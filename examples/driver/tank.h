/* SPDX-License-Identifier: BSD-3-Clause */
/* Rectangular tanks with water in them, and all the rest of a driver that is such a tank. */
#ifndef MPS_EXAMPLES_TANK_H
#define MPS_EXAMPLES_TANK_H

#include "driver.h"

/* Air as everywhere in these cases [kg/m3], [Pa s]. */
#define TANK_AIR_DENSITY   1.29
#define TANK_AIR_VISCOSITY 1.5e-5

/* A baffle across a tank as it is described [m]; in 3-D it reaches from wall to wall. */
typedef struct baffle {
    double middle, thickness; /* along x */
    double bottom, top;       /* along y */
} baffle;

/* A tank that moves along x. */
typedef struct tank_case {
    double size[3];      /* inner [m]; the third in 3-D */
    double depth;        /* of the water [m] */
    mps_harmonic motion; /* --amplitude and --ramp replace its amplitude and ramp */
    baffle plate;        /* top 0: none. With one the case is for one liquid */
    bool whole_rows;     /* no more water than the whole rows below the depth hold */
    double level;        /* still level as built */
} tank_case;

/* Name and add the columns of probes.csv that are the driver's own. */
typedef void (*tank_columns_fn)(driver *d, const tank_case *c);

/* Walls only; the lattice of the fills is laid. @param size inner [m] */
void tank_walls(driver *d, const double *size);
/* The same with the lattice laid so that y = middle is halfway between two rows: two fluids meet there. The tank reaches as far up as
 * down from it, y = 0 may be up to a spacing off its floor. @param lo,hi [3] out: its corners */
void tank_walls_about(driver *d, const double *size, double middle, double *lo, double *hi);
/* Liquid from the corner 0 of the tank to `hi`, which need not be on the lattice. With `whole_rows`, with a model to the letter of the papers
 * and below gas it ends with the last whole row: in a row of both the one would have to pass through the other. @param built as of mps_fill_level_add() */
void tank_liquid(driver *d, const double *hi, bool whole_rows, double *built);
/* The same in the whole tank up to a depth. @return the still level */
double tank_fill(driver *d, const double *size, double depth, bool whole_rows);
/* Whether the motion is the driver's own, that its references belong to. */
bool tank_moves_as_given(const driver *d, const tank_case *c);
/* Command line of a driver of such a tank, and run and outputs; the case may be changed in between. */
void tank_parse(driver *d, const tank_case *c, int argc, char **argv);
int tank_run(driver *d, tank_case c, tank_columns_fn columns);

#endif
