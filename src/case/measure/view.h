/* SPDX-License-Identifier: BSD-3-Clause */
/* Leases that most figures need: positions, kinds and phases of all particles. */
#ifndef MPS_CASE_VIEW_H
#define MPS_CASE_VIEW_H

#include <mps/particles.h>
#include <stdbool.h>

typedef struct view {
    mps_lease x, kind, phase;
} view;

/* Lease all or none. */
bool mps__view_open(mps_sim *sim, view *v);
/* Release all leases. */
bool mps__view_close(mps_sim *sim, view *v);

#endif
