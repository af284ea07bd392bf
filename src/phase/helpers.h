/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers that several models of the fluid share. */
#ifndef MPS_PHASE_HELPERS_H
#define MPS_PHASE_HELPERS_H

#include <mps/model.h>
#include <stdbool.h>

/* Length of mps_view.viscosity, and of a side of mps_view.tension. */
enum { MPS__PHASE_LIMIT = 16 };

/* Smallest density of the fluid particles of each phase [kg/m3]; 0 for a phase without particles.
 * density: [n] the channel "density". */
void mps__phase_densities(const mps_stage *s, const double *density, double rho[MPS__PHASE_LIMIT]);

/* Smallest and largest density of the fluid particles [kg/m3]; INFINITY, -INFINITY without any. */
void mps__density_range(const mps_stage *s, const double *density, double range[2]);

/* True for a fluid particle of the phase that a setting names. */
static inline bool mps__is_gas(const mps_view *v, int64_t i, double phase)
{
    return mps_is_fluid(v, i) && v->phase[i] == (int32_t)phase;
}

/* Fails if no fluid particle has this phase, or if one is not slower than the speed of sound.
 * Returns non-zero after a failure. */
int mps__gas_check(mps_stage *s, double phase, double sound, const double *velocity);

/* Takes the volumes by the equation of state from the channels "volume_deviation" and
 * "number_density": both then hold the error of the volumes alone.
 * denser: [n] (n - n0)/n0 by the equation of state, 0 for other particles; overwritten.
 * Returns non-zero after a failure. */
int mps__gas_expect(mps_stage *s, double *denser, double *volume_deviation, double *number_density);

/* Share of the cell of particle i that holds gas, 0..1. Cells of wall particles count if
 * mps_equation.wall_factor > 0. region: the channel of that name. */
double mps__gas_share(const mps_view *v, const int32_t *region, int64_t i, double phase);

/* Arrays that mps__gas_conserve() works on. */
typedef struct mps__gas_rows {
    const int32_t *region;    /* channel "region" */
    const int32_t *condition; /* channel "pressure_condition" */
    double *source;           /* channel "pressure_source", changed */
    double phase;             /* phase of the gas */
} mps__gas_rows;

/* Keeps the volume of the gas if no row of the pressure equation is fixed: subtracts the sum of all
 * sources, and a part of `surplus`, the sum over the gas of (volume by the equation of state - 1)
 * in cells of the lattice. Call it before the gas adds its own terms. */
void mps__gas_conserve(const mps_stage *s, const mps__gas_rows *rows, double surplus);

#endif
