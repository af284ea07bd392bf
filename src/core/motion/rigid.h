/* SPDX-License-Identifier: BSD-3-Clause */
/* Mechanics of a rigid body that carries the tank, in the degrees of freedom of mps/motion.h. */
#ifndef MPS_CORE_RIGID_H
#define MPS_CORE_RIGID_H

#include "motion.h"
#include <mps/body.h>

/* State of a body from step to step, besides the pose and the rates of the tank. Part of snapshots
 * and checkpoints. */
typedef struct mps__body_state {
    double late[6];   /* impulses of the liquid deferred to the next step [N s, N m s] */
    double liquid[6]; /* loads of the last step: see mps_body_report */
    double external[6], restoring[6], felt_late[6], mass[36];
    double friction[6];
    double damped, external_work, liquid_work, start, rubbed; /* [J] */
    double origin[3]; /* position of the centre of mass when the body was set */
    int64_t iterations;
} mps__body_state;

typedef struct mps__body {
    mps_body given;
    mps__body_state state;
} mps__body;

/* Loads that move the body in a step of dt, after one of dt_before; about the centre of motion,
 * axes of the lab. */
typedef struct mps__rigid_loads {
    double rest[6]; /* of the liquid at zero acceleration: its load is rest - mass a */
    double mass[36];
    double external[6];
    double g[3], dt, dt_before;
    double liquid_mass; /* scale of the singularity test: see NOTHING [kg] */
    double dp;
} mps__rigid_loads;

/* Result of a step: accelerations of the degrees of freedom, and as six components in the lab. */
typedef struct mps__rigid_step {
    double accel[6], lab[6];
    double liquid[6], restoring[6], friction[6];
    double damped, external_work, liquid_work, rubbed; /* in this step [J] */
    /* if there is no solution: the degree of freedom, its mass including the liquid's, the liquid's
     * contribution, the least mass allowed */
    int32_t singular;
    double have, share, least;
} mps__rigid_step;

/* Loads or accelerations: three along axes, three about them. */
static inline double mps__dot6(const double a[6], const double b[6])
{
    return mps__dot(a, b, 3) + mps__dot(a + 3, b + 3, 3);
}

static inline bool mps__rigid_is_free(const mps_body *b, int32_t dof)
{
    return (b->free >> dof & 1) != 0;
}

/* Columns of the added mass that free degrees need: bits of x, y, z and rotations about them. */
uint32_t mps__rigid_columns(const mps_body *b, int32_t dim);
/* Solve a step from the state `now`. false: singular, or two angles are degenerate (singular =
 * -1). */
bool mps__rigid_solve(const mps_body *b, const double centre[3], const mps_motion_state *now,
                      const mps__rigid_loads *l, mps__rigid_step *out);
/* State at the end of a step of dt with these accelerations. A degree that friction stops gets zero
 * rate. */
void mps__rigid_advance(const mps_body *b, const mps_motion_state *now, const double accel[6],
                        double dt, mps_motion_state *next);
/* Kinetic energy; energy of the springs at a pose [J]; position of the centre of mass. */
double mps__rigid_kinetic(const mps_body *b, const double centre[3], const mps_motion_state *now);
double mps__rigid_spring(const mps_body *b, const double value[6]);
void mps__rigid_place(const mps_body *b, const double centre[3], const mps_motion_state *now,
                      double place[3]);

#endif
