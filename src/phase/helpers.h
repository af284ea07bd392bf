/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers of the models of the fluid. */
#ifndef MPS_PHASE_HELPERS_H
#define MPS_PHASE_HELPERS_H

#include <mps/model.h>
#include <stdbool.h>

/* Smallest and largest density of the fluid particles [kg/m3]; INFINITY, 0 without fluid. */
void mps__density_range(const mps_stage *s, double range[2]);

/* True for a fluid particle of the phase given by a setting. */
static inline bool mps__is_gas(const mps_view *v, int64_t i, double phase)
{
    return mps_is_fluid(v, i) && v->phase[i] == (int32_t)phase;
}

/* Fails if no fluid particle has this phase, or if one is not slower than the speed of sound.
 * Returns non-zero after a failure. */
int mps__gas_check(mps_stage *s, double phase, double sound, const double *velocity);

/* Subtracts the volumes by the equation of state from the channels "volume_deviation" and
 * "number_density", which then contain only the error of the volumes. Returns non-zero after a
 * failure.
 * denser: [n] (n - n0)/n0 by the equation of state, 0 for other particles; overwritten. */
int mps__gas_expect(mps_stage *s, double *denser, double *volume_deviation, double *number_density);

/* Gas fraction in the cell of particle i, 0..1. Cells of wall particles count if
 * v->flux.wall_factor > 0. region: the channel of that name. */
double mps__gas_fraction(const mps_view *v, const int32_t *region, int64_t i, double phase);

/* Arrays for mps__gas_conserve(). */
typedef struct mps__gas_rows {
    const int32_t *region;    /* channel "region" */
    const int32_t *condition; /* channel "pressure_condition" */
    double *source;           /* channel "pressure_source", changed */
    double phase;             /* phase of the gas */
} mps__gas_rows;

/* Sums over the rows: of the sources in the equation, of their number, of rows of the gas, of fixed
 * rows; over the gas of (volume by the equation of state - 1), in cells of the lattice. */
enum {
    MPS__GAS_SOURCES,
    MPS__GAS_ROWS,
    MPS__GAS_OWN,
    MPS__GAS_FIXED,
    MPS__GAS_SURPLUS,
    MPS__GAS_SUMS
};

/* Whether row i is in the pressure equation. */
static inline bool mps__gas_in_equation(const mps_view *v, const int32_t *region, int64_t i)
{
    return !mps_is_dummy(v, i) && mps_region_of(region, i) < MPS_REGION_SURFACE;
}

/* Adds all sums of row i except the last. */
MPS_ROW void mps__gas_add(const mps_view *v, const mps__gas_rows *f, int64_t i, double *sums)
{
    if (f->condition[i] == MPS_ROW_FIXED) sums[MPS__GAS_FIXED]++;
    if (!mps__gas_in_equation(v, f->region, i)) return;
    sums[MPS__GAS_SOURCES] += f->source[i];
    sums[MPS__GAS_ROWS]++;
    if (mps__is_gas(v, i, f->phase)) sums[MPS__GAS_OWN]++;
}

/* Conserves the volume of the gas if no row of the pressure equation is fixed: subtracts the sum of
 * all sources, and a fraction of the surplus. Call it before the gas adds its own terms.
 * sums: [MPS__GAS_SUMS] */
void mps__gas_conserve(const mps_stage *s, const mps__gas_rows *rows, const double *sums);

#endif
