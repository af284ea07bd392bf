/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs verbs of models, and the loops that they ask for. */
#ifndef MPS_CORE_HOST_H
#define MPS_CORE_HOST_H

#include "motion.h"
#include "parallel.h"
#include "plan.h"
#include "sets.h"

typedef struct mps__host {
    mps__context *context;
    mps__models *models;
    mps__channels *channels;
    mps__particles *particles;
    mps__scratch *scratch; /* lent to the verb in progress: */
    int32_t scratch_used;  /* so many blocks */
    const mps_parallel *parallel;
    mps__ghosts *ghosts;
    const mps__motion *motion; /* of the tank */
    const mps__pose *next;     /* pose at the end of the step; NULL: not known yet */
    bool no_memory;            /* a verb got no scratch */
    bool misused;              /* a verb asked for a loop that there is not */
    mps__sets sets;            /* bodies */
    mps__plan plan;
} mps__host;

/* Channels that mps_flux shows; -1: no model brings it. */
enum { MPS__FLUX_CHANNELS = 5 };
void mps__host_flux(const mps__host *h, int32_t channel[MPS__FLUX_CHANNELS]);
/* Ghosts get the values of those of the channels whose owners have newer ones. `channel` may have -1, for none; at most 24 besides those of fluxes. */
mps_status mps__host_share(mps__host *h, const int32_t *channel, int32_t count);
/* Owners have written new values of a channel; or ghosts have got the same ones. */
void mps__host_written(mps__host *h, int32_t channel);
void mps__host_alike(mps__host *h, int32_t channel);
/* Ghosts are new: they have all fields of their owners. */
void mps__host_all_alike(mps__host *h);
/* Run the verbs of a moment in their order. MPS_E_PLUGIN, MPS_E_NOMEM with model and time in the text. */
mps_status mps__host_run(mps__host *h, mps_stage *s, int32_t moment);
/* Name of the first model that writes a channel of the library, or NULL. */
const char *mps__host_writer(const mps__host *h, int32_t channel);

#endif
