/* SPDX-License-Identifier: BSD-3-Clause */
/* One step in progress, and its parts beside the flow in step.c. */
#ifndef MPS_CORE_STEP_H
#define MPS_CORE_STEP_H

#include "budget.h"

/* What one step carries along; committed to the world only when all went well. */
typedef struct mps__step {
    mps__world *w;
    mps_stage stage;
    mps_stencil near, far;
    mps_flux flux;
    mps__ppe_terms terms;
    mps__pose pose; /* of the tank at the end of the step */
    mps_step_info info;
    mps__budget budget;
    double momentum[3]; /* of the prediction */
    mps__bulk bulk;     /* of the velocities that were booked last */
    mps__jump jump;
    double spread; /* time that a gain below 1 spreads pressures over [s] */
    double clock;  /* beginning of the present stage */
    bool not_converged;
    bool moved; /* positions are new, the old ones kept */
} mps__step;

/* ---- the flow: step.c ---- */

/* Book the time since the last call as that of MPS_STAGE_... */
void mps__step_end_stage(mps__step *q, int stage);

/* ---- the stage: step_stage.c ---- */

/* What verbs see, and where the channels of the library are. */
void mps__step_open(mps__step *q);
/* First values of the channels that live for a step; number density and asymmetry at the present positions. */
mps_status mps__step_begin(mps__step *q);
/* First values of the channels of the pressure equation. */
void mps__step_begin_equation(mps__step *q);
/* Run the verbs of a moment. */
mps_status mps__step_run(mps__step *q, int32_t moment);

/* ---- the tank: step_tank.c ---- */

/* Area vectors of the walls at the beginning of the step. */
mps_status mps__step_turn_areas(mps__world *w);
/* Velocities of the solids over this step, accelerations of the tank, and whether its velocity jumped. */
void mps__step_move_tank(mps__step *q);

/* ---- the pressures: step_pressure.c ---- */

/* <lap p> = source: sources, equation and solution. W22 (10). */
mps_status mps__step_project(mps__step *q);

/* ---- the books: step_books.c ---- */

/* What force models and gravity are about to do. */
void mps__step_book_forces(mps__step *q);
/* What the new pressures have done. */
void mps__step_book_pressure(mps__step *q);
/* What collisions have done to the velocities. */
void mps__step_book_collisions(mps__step *q);
/* What displacements and the change of velocities with them do. */
void mps__step_book_shift(mps__step *q);
/* Stop drops at plates, and book it as a collision. */
void mps__step_stop_at_plates(mps__step *q);

#endif
