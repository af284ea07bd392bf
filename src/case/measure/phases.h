/* SPDX-License-Identifier: BSD-3-Clause */
/* What a phase does as a whole. */
#ifndef MPS_CASE_PHASES_H
#define MPS_CASE_PHASES_H

#include <mps/mps.h>
#include <stdbool.h>

/* Means over the particles of a phase, which all have the same volume: of places, of their squares, of velocities. */
typedef struct phase_means {
    int64_t count;
    double x[3], x2[3], u[3];
} phase_means;

/* @return false if the particles cannot be read or there are none of this phase */
bool mps__phase_means_get(mps_sim *sim, int32_t phase, phase_means *m);

/* Number of particles that strayed into another phase: fluid with fewer than two of its own phase within two spacings, though it
 * is not alone there. -1 when memory is out. */
int64_t mps__phase_strays(mps_sim *sim);

#endif
