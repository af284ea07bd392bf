/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 6: sums over the fluid that make up the energy budget. Mass of a fluid particle: rho dp^D. */
#ifndef MPS_CORE_BUDGET_H
#define MPS_CORE_BUDGET_H

#include "world.h"

/* Kinetic and potential (-m g.x) energy [J]. */
void mps__budget_sum(const mps__world *w, double *kinetic, double *potential);
/* Kinetic energy gained by accelerations a over dt [J]. */
double mps__budget_power(const mps__world *w, const double *a, double dt);
/* Work of the rigid tank on the fluid over a step, from the change of the fluid's momentum and moment of momentum:
 * F.v + T.omega holds for any distribution of the forces on the walls [J]. */
double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *u0, double dt);
/* Potential energy lost by displacements dx [J]. */
double mps__budget_lift(const mps__world *w, const double *dx);
/* Mean volume deviation of inner fluid particles in the step just made; 0 if there is none. */
double mps__budget_mean_deviation(const mps__world *w);

#endif
