/* SPDX-License-Identifier: BSD-3-Clause */
/* Engine with a second copy of the fields on the host. Stale values are NaN in both copies. */
#ifndef SHADOW_H
#define SHADOW_H

#include "sim.h"

typedef struct shadow {
    mps__engine engine;
    int64_t rooms;                        /* that were not given back */
    int64_t uploads, downloads, outdated; /* so many */
} shadow;

/* Steps of a simulation run on the shadow from now on; it must live longer. */
void shadow_attach(shadow *s, mps_sim *sim);

#endif
