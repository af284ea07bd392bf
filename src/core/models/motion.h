/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics of the rigid tank. The motions themselves are callbacks; src/bc holds the built-in ones. */
#ifndef MPS_CORE_MOTION_H
#define MPS_CORE_MOTION_H

#include "base.h"
#include <mps/motion.h>

/* Pose of the tank at one time, ready for mapping points. */
typedef struct mps__pose {
    double t;
    mps_motion_state state;
    double rotation[9];        /* R, row by row */
    double omega[3], alpha[3]; /* angular velocity and acceleration in the lab [rad/s], [rad/s2] */
} mps__pose;

typedef struct mps__motion {
    mps__context *context;
    int32_t dim, start;
    double centre[3];
    mps_motion_fn fn; /* NULL: the tank keeps the pose `hold` */
    void *user;
    void (*release)(mps__context *c, void *user); /* frees a built-in motion's data, or NULL */
    double t_end;                                 /* last time the motion is defined for */
    mps_motion_state hold;
    mps__pose now; /* at the present time */
} mps__motion;

void mps__motion_init(mps__motion *m, mps__context *context, int32_t dim);
void mps__motion_free(mps__motion *m);
/* The pose of given displacements, angles and rates. */
void mps__motion_pose_of(const mps_motion_state *state, int32_t dim, double t, mps__pose *pose);
/* Pose at time t. Fails for a callback's failure, NaN, a direction 2-D does not have, or t beyond a table. */
mps_status mps__motion_pose(mps__motion *m, double t, mps__pose *pose);
/* Lab position, velocity and acceleration of a point X of the tank; x, v, a are [dim], any may be NULL. */
void mps__motion_point(const mps__motion *m, const mps__pose *pose, const double *X, double *x,
                       double *v, double *a);
/* Back from the lab to the tank's frame. */
void mps__motion_to_tank(const mps__motion *m, const mps__pose *pose, const double *x, double *X);
/* Whether vectors of the tank's frame are others in the lab. */
bool mps__motion_turned(const mps__pose *pose);
/* Rotate a vector of the tank's frame into the lab. */
void mps__motion_rotate(const mps__motion *m, const mps__pose *pose, const double *V, double *v);

#endif
