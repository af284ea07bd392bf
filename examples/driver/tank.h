/* SPDX-License-Identifier: BSD-3-Clause */
/* Rectangular tanks with water: geometry and complete runs of drivers. */
#ifndef MPS_EXAMPLES_TANK_H
#define MPS_EXAMPLES_TANK_H

#include "driver.h"

/* Air in all these cases [kg/m3], [Pa s]. */
#define TANK_AIR_DENSITY   1.29
#define TANK_AIR_VISCOSITY 1.5e-5

/* Dimensions of a baffle across a tank [m]; in 3-D it extends from wall to wall. */
typedef struct baffle {
    double middle, thickness; /* along x */
    double bottom, top;       /* along y */
} baffle;

/* A tank that moves along x. */
typedef struct tank_case {
    double size[3];      /* inner [m]; the third in 3-D */
    double depth;        /* of the water [m] */
    mps_harmonic motion; /* --amplitude and --ramp replace its amplitude and ramp */
    baffle plate;        /* top 0: none; a case with a baffle has one liquid */
    bool whole_rows;     /* fill only complete rows below the depth */
    double level;        /* still level as built */
} tank_case;

/* Name and add the driver's own columns of probes.csv. */
typedef void (*tank_columns_fn)(driver *d, const tank_case *c);

/* Walls only; they define the lattice of the fills. @param size inner [m] */
void tank_walls(driver *d, const double *size);
/* Walls of a tank whose lattice has y = middle, the interface of two fluids, halfway between two
 * rows. The tank is symmetric about y = middle; y = 0 may be up to dp from its floor. @param lo,hi
 * [3] out: its corners */
void tank_walls_about(driver *d, const double *size, double middle, double *lo, double *hi);
/* Liquid from the corner 0 of the tank to `hi`, which need not be on the lattice. With
 * `whole_rows`, with the models of the papers and below gas it ends with the last complete row,
 * because liquid and gas in one row would have to move through each other. @param built as in
 * mps_fill_level_add() */
void tank_liquid(driver *d, const double *hi, bool whole_rows, double *built);
/* Liquid in the whole tank up to a depth. @return the still level */
double tank_fill(driver *d, const double *size, double depth, bool whole_rows);
/* Whether the motion is the driver's default, for which its references are valid. */
bool tank_moves_as_given(const driver *d, const tank_case *c);
/* Command line, and run with outputs, of a driver of such a tank; the case may be changed in
 * between. */
void tank_parse(driver *d, const tank_case *c, int argc, char **argv);
int tank_run(driver *d, tank_case c, tank_columns_fn columns);

#endif
