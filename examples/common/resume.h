/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints of a run in its folder of outputs, and going on from one. */
#ifndef MPS_EXAMPLES_RESUME_H
#define MPS_EXAMPLES_RESUME_H

#include "run.h"

/* Write the checkpoint, after the rows up to its time, unless it is there. All ranks make this call. */
void resume_save(run *r);
/* True once for each interval of checkpoints. */
bool resume_due(run *r, double t);
/* Begin anew: what an earlier run left does not belong to the files that begin now. Exits with a message if it cannot be removed. */
void resume_forget(run *r);
/* Put the simulation where the checkpoint is, on all ranks; exits with a message if that cannot be. */
void resume_load(run *r);
/* Add a row of steps.csv to the totals. */
void resume_add_step(void *user, const double *row);
/* All tables are open: drop what is later than the checkpoint; exits with a message unless all steps are there. */
void resume_tables(run *r);
/* What to do where a file of rows cannot be gone on with. */
void resume_say_anew(const run *r);

#endif
