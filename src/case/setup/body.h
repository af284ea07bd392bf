/* SPDX-License-Identifier: BSD-3-Clause */
/* A rigid body that carries the tank. */
#ifndef MPS_CASE_BODY_H
#define MPS_CASE_BODY_H

#include "ship_motion.h"

typedef struct build_body {
    mps_body body;
    const struct build_drive *drive; /* a load of a plug-in; NULL: none */
    build_motion axes, load;         /* load: harmonics or a table, by degree of freedom */
    /* By degree of freedom of the ship, of the body without liquid: mass or moment of inertia about
     * the centre, stiffness including that of its weight, damping, dry friction. */
    double mass[MOTION_DEGREES], stiffness[MOTION_DEGREES], damping[MOTION_DEGREES],
        friction[MOTION_DEGREES];
} build_body;

/* Mass, centre of mass and moment of inertia about that centre of the liquid frozen as a solid. */
typedef struct frozen {
    /* moments of inertia about the axes x, y, z through the centre */
    double mass, place[3], inertia[3];
} frozen;

bool mps__body_frozen(const build *b, frozen *f);
/* Natural period of a degree of freedom [s], without liquid (NULL) or with frozen liquid; nan: no
 * restoring stiffness. */
double mps__body_period(const build *b, int32_t degree, const frozen *liquid);

#endif
