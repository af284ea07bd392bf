/* SPDX-License-Identifier: BSD-3-Clause */
/* The order in which the verbs of the active models run, and their channels. */
#ifndef MPS_CORE_PLAN_H
#define MPS_CORE_PLAN_H

#include "models.h"

enum { MPS__CALLS = 128 };

/* A verb in its place. */
typedef struct mps__call {
    const mps__model *model;
    const mps_verb *verb;
    /* of each use; from MPS__CHANNELS on fields of the user; -1: missing, as it may be */
    int32_t channel[MPS__USES];
} mps__call;

typedef struct mps__plan {
    int64_t noted;   /* of which it was told what is missing; -1: none */
    int64_t changes; /* those of the models that it was made for; -1: none */
    int32_t begin[MPS_MOMENT_COUNT + 1];
    mps__call call[MPS__CALLS]; /* those of moment m: begin[m] .. begin[m+1]-1 */
} mps__plan;

void mps__plan_init(mps__plan *p);
/* Make the plan of the active models, unless it is made. MPS_E_STATE: a channel that no model
 * brings, or verbs that wait for each other. */
mps_status mps__plan_make(mps__plan *p, const mps__models *m);
/* Log a warning for each part of the scheme that no active model does: once after models changed. */
void mps__plan_note(mps__plan *p, const mps__models *m);
/* Name of a moment, e.g. "force". */
const char *mps__moment_name(int32_t moment);

#endif
