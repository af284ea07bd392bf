/* SPDX-License-Identifier: BSD-3-Clause */
/* The checked build (CMake option MPS_CHECKED). Verbs write only what they declare, and
 * memory that holds nothing any more is NaN. */
#ifndef MPS_CORE_GUARD_H
#define MPS_CORE_GUARD_H

#include "host.h"

/* Copies of all arrays that a verb may not write, one behind the other. */
typedef struct mps__guard {
    char *copies;
    size_t element; /* bytes of a particle in all of them */
    int32_t count;
    struct mps__guarded {
        const char *name;
        const void *array;
        size_t before;  /* bytes of a particle in those before it */
        size_t element; /* bytes of a particle */
    } list[MPS__CHANNELS + MPS__FIELDS_MAX];
} mps__guard;

/* Before a verb. */
mps_status mps__guard_begin(mps__guard *g, const mps__host *h, const mps__call *call);
/* After it: `status`, if it failed, or MPS_E_PLUGIN with model, channel and particle if it wrote what it does not declare. */
mps_status mps__guard_end(mps__guard *g, const mps__host *h, const mps_stage *s,
                          const mps__call *call, mps_status status);
/* The step is over: arrays that live for a step become NaN. */
void mps__guard_poison(const mps__host *h);

#endif
