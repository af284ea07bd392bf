/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums over the fluid that make up the budgets of energy and momentum. Mass of a fluid particle: rho dp^D. */
#ifndef MPS_CORE_BUDGET_H
#define MPS_CORE_BUDGET_H

#include "world.h"

/* What accelerations do to it over dt. */
typedef struct mps__push {
    double energy;     /* kinetic energy gained [J] */
    double mass;       /* [kg] */
    double impulse[3]; /* [kg m/s] */
} mps__push;

void mps__budget_sum(const mps__world *w, mps__bulk *bulk);
/* What changes of velocities change: all but the potential energy, which is set to 0. */
void mps__budget_sum_flow(const mps__world *w, mps__bulk *bulk);
void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push);
/* Work of the rigid tank on the fluid over a step that gives it accelerations `a` by pressure, from the change of its momentum and moment
 * of momentum: F.v + T.omega holds for any distribution of the forces on the walls [J]. An impulse that takes the walls from v0 to v1
 * works with their mean. */
double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *a, double dt);
/* The same of a force on the fluid and its moment about the centre of motion at the beginning of the step [J]. */
double mps__budget_tank_work(const mps__world *w, const mps__pose *end, const double force[6],
                             double dt);
/* Work of solids that models move in the tank, by pressures on them and their ways in the tank in this step [J]. */
double mps__budget_body_work(const mps__world *w, const double *pressure, const double *place);
/* Force of the walls on the fluid by pressures on them, sum p A, in the step in progress [N]. Returns its work, with the same velocities of
 * the walls [J]. */
double mps__budget_wall_force(const mps__world *w, const mps__pose *end, const double *pressure,
                              double dt, double force[3]);
/* Potential energy lost by displacements dx [J]. */
double mps__budget_lift(const mps__world *w, const double *dx);
/* Between steps: what others have done to the fluid since the last one, particles come or gone and arrays written, goes to `added`.
 * Before the first step there is nothing to compare with, and the budget begins. */
void mps__budget_update(const mps__world *w, mps__budget *b);
/* All that has changed since `last` goes to `added`. */
void mps__budget_book_added(const mps__world *w, mps__budget *b);
/* Mean volume deviation of inner fluid particles in the step just made; 0 if there is none. */
double mps__budget_mean_deviation(const mps__world *w, const double *deviation);

#endif
