/* SPDX-License-Identifier: BSD-3-Clause */
/* Rectangular tanks with water in them, and all the rest of a driver that is such a tank. */
#ifndef MPS_EXAMPLES_TANK_H
#define MPS_EXAMPLES_TANK_H

#include "baffle.h"
#include "run.h"

/* Air as everywhere in these cases [kg/m3], [Pa s]. */
#define TANK_AIR_DENSITY   1.29
#define TANK_AIR_VISCOSITY 1.5e-5

/* A tank that moves along x. */
typedef struct tank_case {
    double size[3];      /* inner [m]; the third in 3-D */
    double depth;        /* of the water [m] */
    mps_harmonic motion; /* --amplitude and --ramp replace its amplitude and ramp */
    baffle plate;        /* a baffle across it; top 0: none. With one the case is for one liquid */
    bool whole_rows;     /* no more water than the whole rows below the depth hold */
} tank_case;

/* Name and add the columns of probes.csv that are the driver's own. */
typedef void (*tank_columns_fn)(run *r, const tank_case *c);

/* Walls only; the lattice of the fills is laid. @param size inner [m] */
void tank_walls(run *r, const double *size);
/* The same with the lattice laid so that y = middle is halfway between two rows: two fluids meet there. The tank reaches as far up as
 * down from it, y = 0 may be up to a spacing off its floor. @param lo,hi [3] out: its corners */
void tank_walls_about(run *r, const double *size, double middle, double *lo, double *hi);
/* Walls, baffle, water up to the depth, air above it where the model has a gas, and the motion. */
void tank_build(run *r, const tank_case *c);
/* Liquid from the corner 0 of the tank to `hi`, which need not be on the lattice. With `whole_rows`, with a model to the letter of the papers
 * and below gas it ends with the last whole row: in a row of both the one would have to pass through the other. @param built as of mps_fill_level_add() */
void tank_liquid(run *r, const double *hi, bool whole_rows, double *built);
/* The same in the whole tank up to a depth; sets the still level and writes it to summary.json. */
void tank_fill(run *r, const double *size, double depth, bool whole_rows);
/* A harmonic motion that grows over the periods of --ramp. */
void tank_move(run *r, mps_harmonic motion);
/* Whether the motion is the driver's own, that its references belong to. */
bool tank_moves_as_given(const run *r, const tank_case *c);
/* Command line of a driver of such a tank, and run and outputs; the case may be changed in between. */
void tank_parse(cli_options *o, const tank_case *c, int argc, char **argv);
int tank_run(const cli_options *o, const tank_case *c, tank_columns_fn columns);
/* Command line, run and outputs. The options hold the driver's defaults. @return exit code of the program */
int tank_main(cli_options *o, const tank_case *c, tank_columns_fn columns, int argc, char **argv);

#endif
