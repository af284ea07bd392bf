/* SPDX-License-Identifier: BSD-3-Clause */
/* The checked build (CMake option MPS_CHECKED). Verbs may write only what they declare, and dead
 * memory is NaN. */
#ifndef MPS_CORE_GUARD_H
#define MPS_CORE_GUARD_H

#include "runner.h"

/* Copies of all arrays that a verb may not write, stored contiguously. */
typedef struct mps__guard {
    char *copies;
    size_t element; /* bytes per particle of all copies */
    int32_t count;
    struct mps__guarded {
        const char *name;
        const void *array;
        size_t before;  /* bytes per particle of the copies before it */
        size_t element; /* bytes per particle */
    } list[MPS__CHANNELS + MPS__FIELDS_MAX];
} mps__guard;

/* Call before a verb. */
mps_status mps__guard_begin(mps__guard *g, const mps__runner *h, const mps__call *call);
/* Call after a verb. Return `status` if it failed, or MPS_E_PLUGIN with model, channel and particle
 * if the verb wrote what it does not declare. */
mps_status mps__guard_end(mps__guard *g, const mps__runner *h, const mps_stage *s,
                          const mps__call *call, mps_status status);
/* End a step: arrays of MPS_LIFE_STEP become NaN. */
void mps__guard_poison(const mps__runner *h);

#endif
