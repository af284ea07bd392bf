/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs verbs of models, and the loops that they ask for. */
#ifndef MPS_CORE_HOST_H
#define MPS_CORE_HOST_H

#include "motion.h"
#include "parallel.h"
#include "plan.h"

typedef struct mps__host {
    mps__context *context;
    mps__models *models;
    mps__channels *channels;
    mps__particles *particles;
    mps__scratch *scratch; /* lent to the verb in progress: */
    int32_t scratch_used;  /* so many blocks */
    const mps_parallel *parallel;
    const mps__motion *motion; /* of the tank */
    const mps__pose *next;     /* pose at the end of the step; NULL: not known yet */
    bool no_memory;            /* a verb got no scratch */
    bool misused;              /* a verb asked for a loop that there is not */
    mps__plan plan;
} mps__host;

/* Run the verbs of a moment in their order. MPS_E_PLUGIN, MPS_E_NOMEM with model and time in the text. */
mps_status mps__host_run(mps__host *h, mps_stage *s, int32_t moment);
/* Name of the first model that writes a channel of the library, or NULL. */
const char *mps__host_writer(const mps__host *h, int32_t channel);

#endif
