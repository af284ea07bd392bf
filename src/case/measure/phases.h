/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages over a phase. */
#ifndef MPS_CASE_PHASES_H
#define MPS_CASE_PHASES_H

#include <mps/mps.h>
#include <stdbool.h>

/* Means over the particles of a phase, which all have the same volume: of positions, of their
 * squares, of velocities. */
typedef struct phase_means {
    int64_t count;
    double x[3], x2[3], u[3];
} phase_means;

/* @return false if the particles cannot be read or the phase has none */
bool mps__phase_means_get(mps_sim *sim, int32_t phase, phase_means *m);

/* Number of particles that strayed into another phase: fluid with fewer than two neighbours of its
 * own phase within two spacings, though it has others. -1: memory is exhausted. */
int64_t mps__phase_strays(mps_sim *sim);

#endif
