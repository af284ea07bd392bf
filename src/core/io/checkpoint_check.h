/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of the numbers in a checkpoint. A checksum detects damage, but not wrong numbers from
 * another program. All checks run before anything changes. */
#ifndef MPS_CORE_CHECKPOINT_CHECK_H
#define MPS_CORE_CHECKPOINT_CHECK_H

#include "checkpoint.h"

/* The state in a checkpoint. The arrays belong to the archive. */
typedef struct mps__arrived {
    const mps_sim *sim;
    mps__state state;
    mps__pose now;
    mps_motion_state hold;
    int64_t next_id, n;
    const void *field[MPS__FIELDS_MAX]; /* in the order of the particles' fields */
    int32_t linked, listed;
    const double *searched; /* [n*dim], NULL unless listed */
} mps__arrived;

/* Time, steps, poses, budget, flags. */
mps_status mps__check_scalars(mps__context *c, const mps__arrived *a);
/* Fields, tags, ids, links, and the solids, which must equal those of the simulation. */
mps_status mps__check_particles(mps__context *c, const mps__arrived *a);
/* State of a rigid body that carries the tank. */
mps_status mps__check_body(mps__context *c, const mps__body_state *b);
mps_status mps__check_load(mps__context *c, const mps__load *l);
/* Numbers of a model (its state). */
mps_status mps__check_numbers(mps__context *c, const mps_model_ops *ops, const mps__numbers *s);
/* Series of probe number `probe`. `waits` is the flag in the file. */
mps_status mps__check_series(mps__context *c, const mps__arrived *a, int64_t probe,
                             const mps__series *s, int64_t waits);

#endif
