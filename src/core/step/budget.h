/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums over the fluid that make up the budgets of energy and momentum. Mass of a fluid particle:
 * rho dp^D. */
#ifndef MPS_CORE_BUDGET_H
#define MPS_CORE_BUDGET_H

#include "world.h"

/* Effect of accelerations on the fluid over dt. */
typedef struct mps__push {
    double energy;     /* kinetic energy gained [J] */
    double mass;       /* [kg] */
    double impulse[3]; /* [kg m/s] */
} mps__push;

void mps__budget_sum(const mps__world *w, mps__bulk *bulk);
/* Deferred mps__budget_sum(): `then` gets the sums for mps__budget_take(). */
void mps__budget_deferred(mps__world *w, mps__then then);
void mps__budget_take(const mps__world *w, const double *sums, mps__bulk *bulk);
/* Sums that depend on velocities: all but the potential energy, which is set to 0. */
void mps__budget_sum_flow(const mps__world *w, mps__bulk *bulk);
void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push);
/* Deferred versions; `then` gets the sums for mps__budget_take_flow() and
 * mps__budget_take_push(). */
void mps__budget_flow_deferred(mps__world *w, mps__then then);
void mps__budget_take_flow(const mps__world *w, const double *sums, mps__bulk *bulk);
void mps__budget_push_deferred(mps__world *w, const double *a, double dt, mps__then then);
void mps__budget_take_push(const mps__world *w, const double *sums, mps__push *push);
/* Work of the rigid tank on the fluid over a step in which pressure gives it accelerations `a`,
 * from the change of its momentum and moment of momentum: F.v + T.omega holds for any distribution
 * of the forces on the walls [J]. An impulse that changes the walls' velocity from v0 to v1 works
 * with their mean. For `then`: 1 sum. */
void mps__budget_wall_work(mps__world *w, const mps__pose *end, const double *a, double dt,
                           mps__then then);
/* Work of a force on the fluid, and of its moment about the centre of motion at the beginning of
 * the step [J]. */
double mps__budget_tank_work(const mps__world *w, const mps__pose *end, const double force[6],
                             double dt);
/* Work of solids that models move in the tank: pressures times displacements in the tank in this
 * step [J]. */
double mps__budget_body_work(const mps__world *w, const double *pressure, const double *place);
/* For `then`: force of the walls on the fluid by pressures on them, sum p A, in this step [N],
 * `dim` sums; last its work, with the velocities of mps__budget_wall_work() [J]. */
void mps__budget_wall_force(mps__world *w, const mps__pose *end, const double *pressure, double dt,
                            mps__then then);
/* For `then`: potential energy lost by displacements dx [J]. */
void mps__budget_lift(mps__world *w, const double *dx, mps__then then);
/* Between steps: add changes by others since the last step (particles added or removed, arrays
 * written) to `added`. Before the first step the budget begins. */
mps_status mps__budget_update(const mps__world *w, mps__budget *b);
/* Add all changes since `last` to `added`. */
void mps__budget_book_added(const mps__world *w, mps__budget *b);
/* For `then`: sum of the volume deviations of inner fluid particles in this step, and their
 * number. */
void mps__budget_deviation(mps__world *w, const double *deviation, mps__then then);

#endif
