/* SPDX-License-Identifier: BSD-3-Clause */
/* What a checkpoint holds. The set-up is a text, one line for each thing that a user chose, so that a difference can be told;
 * the state is numbers. */
#ifndef MPS_CORE_CHECKPOINT_H
#define MPS_CORE_CHECKPOINT_H

#include "archive.h"
#include "sim.h"

/* A text that grows; `data` NULL: only `size` does. */
typedef struct mps__text {
    char *data;
    int64_t size;
} mps__text;

/* The set-up of a simulation: as long as it is the same, a state of one fits the other. */
void mps__setup_text(const mps_sim *sim, mps__text *text);
/* Refuse another one, naming the first difference. Both texts end with a 0. */
mps_status mps__setup_compare(mps__context *c, const char *saved, const char *here);

/* Put the state into an archive. */
void mps__state_put(mps_sim *sim, mps__archive *a);
/* Take it from there, all or nothing. The set-ups are the same. */
mps_status mps__state_get(mps_sim *sim, const mps__archive *a);

#endif
