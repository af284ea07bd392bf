/* SPDX-License-Identifier: BSD-3-Clause */
/* Contents of a checkpoint. The set-up is a text with one line for each choice of a user, so that a
 * difference can be reported; the state is numbers. */
#ifndef MPS_CORE_CHECKPOINT_H
#define MPS_CORE_CHECKPOINT_H

#include "archive.h"
#include "sim.h"

/* A growing text; with `data` NULL only `size` grows. */
typedef struct mps__text {
    char *data;
    int64_t size;
} mps__text;

/* Number of solid particles among n, and an order-independent checksum of their kinds, parts and
 * positions (NULL: without positions, if a model moves them). */
typedef struct mps__solids {
    int64_t count;
    uint64_t checksum;
} mps__solids;

mps__solids mps__solids_of(int64_t n, int32_t dim, const int32_t *kind, const int32_t *part,
                           const double *ref);
/* Set-up of a simulation: a state fits every simulation with the same set-up. */
void mps__setup_text(const mps_sim *sim, mps__text *text);
/* Refuse a different set-up, with the first difference in the error text. Both texts are terminated
 * by a 0. */
mps_status mps__setup_compare(mps__context *c, const char *saved, const char *here);

/* Write the state to an archive. */
void mps__state_put(mps_sim *sim, mps__archive *a);
/* Read the state from an archive, all or nothing. The set-ups must be equal. */
mps_status mps__state_get(mps_sim *sim, const mps__archive *a);

#endif
