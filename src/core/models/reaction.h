/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of solids on the fluid that verbs report, besides pressures on walls: mps_stage_reaction(). */
#ifndef MPS_CORE_REACTION_H
#define MPS_CORE_REACTION_H

#include "particles.h"
#include <mps/exact.h>
#include <stdbool.h>

/* Which line of the energy budget takes what a verb dissipates: by its model or, of other models, by its hook. */
enum {
    MPS__LINE_VISCOUS,
    MPS__LINE_COLLISION,
    MPS__LINE_FRICTION,
    MPS__LINE_PLUGINS,
    MPS__LINES,
    MPS__LINE_OF_HOOK = -1
};

/* Places in mps__reactions.sum: lines, then the tank as a whole, then parts. */
enum { MPS__REACTION_WHOLE = MPS__LINES, MPS__REACTIONS = MPS__LINES + 1 + MPS__PARTS_MAX };

/* Of one step, as this rank knows it: force on the fluid and moment about the centre of the tank's motion, in the lab. */
typedef struct mps__reactions {
    bool any;         /* a verb reported, on all ranks */
    bool here, there; /* on the host; on a device, which has sums too: mps__results.reaction */
    mps_exact sum[MPS__REACTIONS][6];
    /* kinetic energy beside that of the particles, by lines: at the beginning of the step, and at its end [J] */
    double kinetic_before[MPS__LINES], kinetic[MPS__LINES];
} mps__reactions;

#endif
