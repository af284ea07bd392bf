/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of solids on the fluid reported by verbs, besides wall pressures: mps_stage_reaction(). */
#ifndef MPS_CORE_REACTION_H
#define MPS_CORE_REACTION_H

#include "particles.h"
#include <mps/exact.h>
#include <stdbool.h>

/* Energy budget line of the dissipation of a verb: by its model, else by its hook. */
enum {
    MPS__LINE_VISCOUS,
    MPS__LINE_COLLISION,
    MPS__LINE_FRICTION,
    MPS__LINE_PLUGINS,
    MPS__LINES,
    MPS__LINE_OF_HOOK = -1
};

/* Indices in mps__reactions.sum: lines, then the whole tank, then parts. */
enum { MPS__REACTION_WHOLE = MPS__LINES, MPS__REACTIONS = MPS__LINES + 1 + MPS__PARTS_MAX };

/* Of one step and this rank: force on the fluid, and moment about the motion centre of the tank, in
 * the lab frame. */
typedef struct mps__reactions {
    bool any;                /* a verb reported; the same on all ranks */
    bool on_host, on_device; /* sums on the host; on a device too: mps__results.reaction */
    mps_exact sum[MPS__REACTIONS][6];
    /* kinetic energy besides that of the particles, by lines: at the start and at the end of the
     * step [J] */
    double kinetic_before[MPS__LINES], kinetic[MPS__LINES];
} mps__reactions;

#endif
