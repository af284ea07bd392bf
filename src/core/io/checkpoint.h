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

/* The solid particles among n: how many, and a checksum of their kinds, parts and places (NULL: without, where a model moves them) in any order. */
typedef struct mps__solids {
    int64_t count;
    uint64_t checksum;
} mps__solids;

mps__solids mps__solids_of(int64_t n, int32_t dim, const int32_t *kind, const int32_t *part,
                           const double *ref);
/* The set-up of a simulation: as long as it is the same, a state of one fits the other. */
void mps__setup_text(const mps_sim *sim, mps__text *text);
/* Refuse another one, naming the first difference. Both texts end with a 0. */
mps_status mps__setup_compare(mps__context *c, const char *saved, const char *here);

/* Put the state into an archive. */
void mps__state_put(mps_sim *sim, mps__archive *a);
/* Take it from there, all or nothing. The set-ups are the same. */
mps_status mps__state_get(mps_sim *sim, const mps__archive *a);

#endif
