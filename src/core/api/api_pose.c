/* SPDX-License-Identifier: BSD-3-Clause */
/* Pose of the tank as a matrix: functions of mps/motion.h that need no simulation. */
#include "motion.h"
#include <math.h>
#include <string.h>

mps_status mps_motion_pose_init(mps_motion_pose *pose, size_t size)
{
    static const mps_motion_pose rest = {.struct_size = sizeof rest,
                                         .rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    return mps__struct_init("mps_motion_pose", pose, size, &rest, sizeof rest);
}

mps_status mps_motion_pose_from_state(const mps_motion_state *state, mps_motion_pose *pose)
{
    mps_motion_state own = {.struct_size = sizeof own};
    mps_motion_pose result = {.struct_size = sizeof result};
    mps__pose at;
    MPS__TRY(mps__motion_state_in(state, &own));
    mps__motion_pose_of(&own, 0, &at);
    memcpy(result.rotation, at.rotation, sizeof result.rotation);
    memcpy(result.omega, at.omega, sizeof result.omega);
    memcpy(result.alpha, at.alpha, sizeof result.alpha);
    for (int d = 0; d < 3; d++) {
        result.translation[d] = own.value[MPS_MOVE_X + d];
        result.velocity[d] = own.rate[MPS_MOVE_X + d];
        result.accel[d] = own.accel[MPS_MOVE_X + d];
    }
    return mps__struct_out(NULL, "mps_motion_pose", pose, &result, sizeof result);
}

/* Whether the columns of R are orthonormal and right-handed. */
static bool is_rotation(const mps__triad *axes)
{
    double third[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (!(fabs(mps__dot(axes->e[i], axes->e[j], 3) - (i == j)) <= 1e-6)) return false;
    mps__cross(axes->e[0], axes->e[1], third);
    return mps__dot(third, axes->e[2], 3) > 0;
}

mps_status mps_motion_pose_to_state(const mps_motion_pose *pose, mps_motion_state *state)
{
    mps_motion_pose own = {.struct_size = sizeof own};
    mps_motion_state result = {.struct_size = sizeof result};
    mps__triad axes;
    MPS__TRY(mps__struct_in(NULL, "mps_motion_pose", &own, sizeof own, pose));
    const double *const vectors[] = {own.translation, own.velocity, own.omega, own.accel,
                                     own.alpha};
    for (int k = 0; k < 5; k++)
        if (!mps__finite(vectors[k], 3)) return MPS_E_ARG;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            axes.e[column][row] = own.rotation[3 * row + column];
    if (!is_rotation(&axes)) return MPS_E_ARG;
    for (int d = 0; d < 3; d++) {
        result.value[MPS_MOVE_X + d] = own.translation[d];
        result.rate[MPS_MOVE_X + d] = own.velocity[d];
        result.accel[MPS_MOVE_X + d] = own.accel[d];
    }
    MPS__TRY(mps__struct_check(NULL, "mps_motion_state", state));
    if (!mps__motion_angles_of(&axes, own.omega, own.alpha, &result)) return MPS_E_STATE;
    return mps__struct_out(NULL, "mps_motion_state", state, &result, sizeof result);
}
