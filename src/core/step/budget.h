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
/* The same later, from its sums. */
void mps__budget_later(mps__world *w, mps__then then);
void mps__budget_take(const mps__world *w, const double *sums, mps__bulk *bulk);
/* What changes of velocities change: all but the potential energy, which is set to 0. */
void mps__budget_sum_flow(const mps__world *w, mps__bulk *bulk);
void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push);
/* The same without waiting; what `then` gets is for these to take. */
void mps__budget_flow_later(mps__world *w, mps__then then);
void mps__budget_take_flow(const mps__world *w, const double *sums, mps__bulk *bulk);
void mps__budget_push_later(mps__world *w, const double *a, double dt, mps__then then);
void mps__budget_take_push(const mps__world *w, const double *sums, mps__push *push);
/* Work of the rigid tank on the fluid over a step that gives it accelerations `a` by pressure, from the change of its momentum and moment
 * of momentum: F.v + T.omega holds for any distribution of the forces on the walls [J]. An impulse that takes the walls from v0 to v1
 * works with their mean. For `then`: 1 sum. */
void mps__budget_wall_work(mps__world *w, const mps__pose *end, const double *a, double dt,
                           mps__then then);
/* The same of a force on the fluid and its moment about the centre of motion at the beginning of the step [J]. */
double mps__budget_tank_work(const mps__world *w, const mps__pose *end, const double force[6],
                             double dt);
/* Work of solids that models move in the tank, by pressures on them and their ways in the tank in this step [J]. */
double mps__budget_body_work(const mps__world *w, const double *pressure, const double *place);
/* For `then`: force of the walls on the fluid by pressures on them, sum p A, in the step in progress [N], `dim` sums; last its work, with the same
 * velocities of the walls [J]. */
void mps__budget_wall_force(mps__world *w, const mps__pose *end, const double *pressure, double dt,
                            mps__then then);
/* For `then`: potential energy lost by displacements dx [J]. */
void mps__budget_lift(mps__world *w, const double *dx, mps__then then);
/* Between steps: what others have done to the fluid since the last one, particles come or gone and arrays written, goes to `added`.
 * Before the first step there is nothing to compare with, and the budget begins. */
mps_status mps__budget_update(const mps__world *w, mps__budget *b);
/* All that has changed since `last` goes to `added`. */
void mps__budget_book_added(const mps__world *w, mps__budget *b);
/* For `then`: volume deviations of inner fluid particles in the step just made, and how many there are. */
void mps__budget_deviation(mps__world *w, const double *deviation, mps__then then);

#endif
