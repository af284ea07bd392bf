/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 6: sums over the fluid that make up the budgets of energy and momentum. Mass of a fluid particle: rho dp^D. */
#ifndef MPS_CORE_BUDGET_H
#define MPS_CORE_BUDGET_H

#include "world.h"

/* The state of the fluid. */
typedef struct mps__bulk {
    double kinetic, potential; /* potential: -m g.x [J] */
    double momentum[3];        /* [kg m/s] */
} mps__bulk;

/* What accelerations do to it over dt. */
typedef struct mps__push {
    double energy;                  /* kinetic energy gained [J] */
    double mass;                    /* [kg] */
    double momentum[3], impulse[3]; /* before, and gained [kg m/s] */
} mps__push;

void mps__budget_sum(const mps__world *w, mps__bulk *bulk);
void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push);
/* Force of the walls on the fluid, sum p A, in the step in progress [N]. */
void mps__budget_wall_force(const mps__world *w, double force[3]);
/* Work of the rigid tank on the fluid over a step, from the change of the fluid's momentum and moment of momentum:
 * F.v + T.omega holds for any distribution of the forces on the walls [J]. */
double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *u0, double dt);
/* Potential energy lost by displacements dx [J]. */
double mps__budget_lift(const mps__world *w, const double *dx);
/* Mean volume deviation of inner fluid particles in the step just made; 0 if there is none. */
double mps__budget_mean_deviation(const mps__world *w);

#endif
