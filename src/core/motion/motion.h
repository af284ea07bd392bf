/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics of the rigid tank. The motions are callbacks; the built-in ones are in src/bc. */
#ifndef MPS_CORE_MOTION_H
#define MPS_CORE_MOTION_H

#include "base.h"
#include "rotation.h"
#include <mps/motion.h>
#include <mps/stage.h>

/* Pose of the tank at one time, ready for mapping points. */
typedef struct mps__pose {
    double t;
    mps_motion_state state;
    double rotation[9];        /* R, row by row */
    double omega[3], alpha[3]; /* angular velocity and acceleration in the lab [rad/s], [rad/s2] */
} mps__pose;

/* Interpolation between two poses: the motion that mps_motion_pose_set() sets. */
typedef struct mps__posed {
    double begin, end; /* [s] */
    mps_motion_state from, to;
} mps__posed;

typedef struct mps__motion {
    mps__context *context;
    int32_t dim, start;
    double centre[3];
    mps_motion_fn fn; /* NULL: the tank keeps the pose `hold` */
    void *user;
    void (*release)(mps__context *c, void *user); /* frees a built-in motion's data, or NULL */
    double t_end;                                 /* last time for which the motion is defined */
    /* Longest step from t, at most dt, that resolves the motion [s]. NULL: unknown */
    double (*longest)(const void *user, double t, double dt);
    bool logged;       /* the log has the warning that a fixed step is longer than that */
    mps__posed *posed; /* `user`, if the motion interpolates between two poses, else NULL */
    mps_motion_state hold;
    mps__pose now; /* at the present time */
} mps__motion;

/* Names of the degrees of freedom, for messages. */
extern const char *const mps__dof_name[MPS_DOF_COUNT];
/* Whether 2-D has this degree of freedom. */
bool mps__dof_in_plane(int32_t dof);

/* x = c + d + R (X - c): centre c, displacement d, rotation R. */
static inline void mps__tank_point(const int dim, const double centre[3], const double shift[3],
                                   const double R[9], const double *X, double *x)
{
    double r[3] = {0, 0, 0}, s[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) r[d] = X[d] - centre[d];
    for (int d = 0; d < dim; d++)
        s[d] = dim == 3 ? R[3 * d] * r[0] + R[3 * d + 1] * r[1] + R[3 * d + 2] * r[2]
                        : R[3 * d] * r[0] + R[3 * d + 1] * r[1];
    for (int d = 0; d < dim; d++) x[d] = centre[d] + shift[d] + s[d];
}

/* X = c + R^T (x - c - d), the inverse. */
static inline void mps__tank_place(const int dim, const double centre[3], const double shift[3],
                                   const double R[9], const double *x, double *X)
{
    double r[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) r[d] = x[d] - centre[d] - shift[d];
    for (int d = 0; d < dim; d++)
        X[d] = centre[d] + (dim == 3 ? R[d] * r[0] + R[3 + d] * r[1] + R[6 + d] * r[2]
                                     : R[d] * r[0] + R[3 + d] * r[1]);
}

/* Velocity of the rigid tank at one time: translation and rotation about `at`. Decisions use speeds
 * relative to it, so that neither a uniform motion nor a rotation of liquid with its tank changes a
 * result. */
typedef struct mps__carry {
    /* position [m] and velocity [m/s] of the centre, angular velocity [rad/s] */
    double at[3], rate[3], omega[3];
} mps__carry;

/* Velocity of the tank at x. */
MPS_ROW void mps__carried(const int dim, const mps__carry *k, const double *x, double out[3])
{
    const double *w = k->omega;
    double r[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) r[d] = x[d] - k->at[d];
    out[0] = k->rate[0] + (dim == 2 ? -w[2] * r[1] : w[1] * r[2] - w[2] * r[1]);
    out[1] = k->rate[1] + (dim == 2 ? w[2] * r[0] : w[2] * r[0] - w[0] * r[2]);
    out[2] = dim == 3 ? k->rate[2] + (w[0] * r[1] - w[1] * r[0]) : 0;
}

/* Velocity u of a particle at x, relative to the tank. For a tank at rest it is u, bit by bit. */
MPS_ROW void mps__relative(const int dim, const mps__carry *k, const double *x, const double *u,
                           double out[3])
{
    mps__carried(dim, k, x, out);
    for (int d = 0; d < 3; d++) out[d] = d < dim ? u[d] - out[d] : 0;
}

/* Square of the speed relative to the tank. */
MPS_ROW double mps__relative2(const int dim, const mps__carry *k, const double *x, const double *u)
{
    double v[3];
    mps__relative(dim, k, x, u, v);
    return mps__dot(v, v, dim);
}

void mps__motion_init(mps__motion *m, mps__context *context, int32_t dim);
void mps__motion_free(mps__motion *m);
/* The pose of given displacements, angles and rates. */
void mps__motion_pose_of(const mps_motion_state *state, double t, mps__pose *pose);
/* Copy a caller's state, if its size is that of a version and all values are finite. `own`: out. */
mps_status mps__motion_state_in(const mps_motion_state *given, mps_motion_state *own);
/* The three angles of a tank whose axes have these directions in the lab (the columns of R). false:
 * MPS_ROTATE_Z is within 1e-6 of +-pi/2. */
bool mps__motion_angles_of(const mps__triad *axes, const double omega[3], const double alpha[3],
                           mps_motion_state *state);
/* Pose at time t. Fails if the callback fails, for NaN, a direction that 2-D does not have, or t
 * beyond a table. */
mps_status mps__motion_pose(mps__motion *m, double t, mps__pose *pose);
/* Lab position, velocity and acceleration of a point X of the tank; x, v, a are [dim], any may be
 * NULL. */
void mps__motion_point(const mps__motion *m, const mps__pose *pose, const double *X, double *x,
                       double *v, double *a);
/* From the lab to the tank's frame. */
void mps__motion_to_tank(const mps__motion *m, const mps__pose *pose, const double *x, double *X);
/* What row functions read of the poses at the beginning and at the end of a step. */
void mps__motion_view(const mps__motion *m, const mps__pose *pose, mps_tank_pose *view);
void mps__motion_view_next(const mps__pose *pose, mps_tank_pose *view);
/* Velocity of the tank at the time of a pose. */
mps__carry mps__motion_carry(const mps__motion *m, const mps__pose *pose);
/* Whether the tank's axes differ from those of the lab. */
bool mps__motion_rotated(const mps__pose *pose);
/* Rotate a vector of the tank's frame into the lab. */
void mps__motion_rotate(const mps__motion *m, const mps__pose *pose, const double *V, double *v);
/* Rotate a vector of the lab into the tank's frame. */
void mps__motion_rotate_back(const mps__motion *m, const mps__pose *pose, const double *v,
                             double *V);

#endif
