/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics of the rigid tank: x = c + d + R (X - c), R = Ry Rz Rx; in 2-D R = Rz. */
#include "motion.h"
#include <math.h>
#include <string.h>

/* Tolerance for rounding of times beyond the table's end [s]. */
static const double end_slack = 1e-9;

const char *const mps__dof_name[MPS_DOF_COUNT] = {"MPS_MOVE_X",   "MPS_MOVE_Y",   "MPS_MOVE_Z",
                                                  "MPS_ROTATE_X", "MPS_ROTATE_Y", "MPS_ROTATE_Z"};

bool mps__dof_in_plane(int32_t dof)
{
    return dof == MPS_MOVE_X || dof == MPS_MOVE_Y || dof == MPS_ROTATE_Z;
}

mps_status mps__motion_state_in(const mps_motion_state *given, mps_motion_state *own)
{
    *own = (mps_motion_state){.struct_size = sizeof *own};
    MPS__TRY(mps__struct_in(NULL, "mps_motion_state", own, sizeof *own, given));
    const bool good = mps__finite(own->value, MPS_DOF_COUNT) &&
                      mps__finite(own->rate, MPS_DOF_COUNT) &&
                      mps__finite(own->accel, MPS_DOF_COUNT);
    return good ? MPS_OK : MPS_E_ARG;
}

/* R = Ry Rz Rx */
static const int32_t turn_order[3] = {1, 2, 0};

void mps__motion_pose_of(const mps_motion_state *state, double t, mps__pose *pose)
{
    mps__angles angles = {.order = turn_order};
    mps__triad axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int n = 0; n < 3; n++) {
        const int dof = MPS_ROTATE_X + turn_order[n];
        angles.angle[n] = state->value[dof];
        angles.rate[n] = state->rate[dof];
        angles.accel[n] = state->accel[dof];
    }
    pose->t = t;
    pose->state = *state;
    mps__rotation_apply(&angles, &axes, pose->omega, pose->alpha);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            pose->rotation[3 * row + column] = axes.e[column][row];
}

bool mps__motion_angles_of(const mps__triad *axes, const double omega[3], const double alpha[3],
                           mps_motion_state *state)
{
    static const mps__triad rest = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    mps__angles angles = {.order = turn_order};
    if (!mps__rotation_angles(&rest, axes, omega, alpha, &angles)) return false;
    for (int n = 0; n < 3; n++) {
        const int dof = MPS_ROTATE_X + turn_order[n];
        state->value[dof] = angles.angle[n];
        state->rate[dof] = angles.rate[n];
        state->accel[dof] = angles.accel[n];
    }
    return true;
}

/* Refuse directions that 2-D does not have, and values that are not finite. */
static mps_status check_state(const mps__motion *m, double t, const mps_motion_state *s)
{
    const double *const set[3] = {s->value, s->rate, s->accel};
    static const char *const what[3] = {"value", "rate", "acceleration"};
    for (int k = 0; k < MPS_DOF_COUNT; k++)
        for (int v = 0; v < 3; v++) {
            if (!isfinite(set[v][k]))
                return mps__fail(m->context, MPS_E_PLUGIN,
                                 "motion: the %s of '%s' is %g at t = %g s, must be finite",
                                 what[v], mps__dof_name[k], set[v][k], t);
            MPS__CHECK(m->context, m->dim == 3 || mps__dof_in_plane(k) || set[v][k] == 0,
                       "motion: the %s of '%s' is %g at t = %g s, must be 0 in 2-D", what[v],
                       mps__dof_name[k], set[v][k], t);
        }
    return MPS_OK;
}

/* Arm from the centre, with three components: in 2-D the third is 0, the centre's plane. */
static void arm(const mps__motion *m, const double *X, double out[3])
{
    for (int d = 0; d < 3; d++) out[d] = d < m->dim ? X[d] - m->centre[d] : 0.0;
}

static void rotate(const mps__pose *pose, const double V[3], double v[3])
{
    const double *R = pose->rotation;
    for (int d = 0; d < 3; d++) v[d] = R[3 * d] * V[0] + R[3 * d + 1] * V[1] + R[3 * d + 2] * V[2];
}

/* Displacements in the order x, y, z: dof 0, 1, 2. */
static void add_linear(const mps__motion *m, const double *linear, const double angular[3],
                       double *out)
{
    for (int d = 0; d < m->dim; d++) out[d] = linear[d] + angular[d];
}

void mps__motion_init(mps__motion *m, mps__context *context, int32_t dim)
{
    *m = (mps__motion){.context = context, .dim = dim, .t_end = INFINITY};
    m->hold.struct_size = sizeof m->hold;
    mps__motion_pose_of(&m->hold, 0, &m->now);
}

void mps__motion_free(mps__motion *m)
{
    if (m->release) m->release(m->context, m->user);
    m->fn = NULL;
    m->user = NULL;
    m->release = NULL;
    m->longest = NULL;
    m->posed = NULL;
    m->t_end = INFINITY;
}

mps_status mps__motion_pose(mps__motion *m, double t, mps__pose *pose)
{
    if (!m->fn) {
        mps__motion_pose_of(&m->hold, t, pose);
        return MPS_OK;
    }
    if (t > m->t_end + end_slack)
        return mps__fail(m->context, MPS_E_STATE,
                         "the motion is not defined at t = %.10g s: the %s is at %.10g s", t,
                         m->posed ? "pose of mps_motion_pose_set()" : "last row of its table",
                         m->t_end);
    mps_motion_state state = {.struct_size = sizeof state};
    const mps__lock before = mps__lock_set(m->context, MPS__LOCKED, "a motion");
    int failed = m->fn(m->user, t, &state);
    m->context->lock = before;
    if (failed)
        return mps__fail(m->context, MPS_E_PLUGIN, "the motion callback failed with %d at t = %g s",
                         failed, t);
    state.struct_size = sizeof state;
    MPS__TRY(check_state(m, t, &state));
    mps__motion_pose_of(&state, t, pose);
    return MPS_OK;
}

void mps__motion_point(const mps__motion *m, const mps__pose *pose, const double *X, double *x,
                       double *v, double *a)
{
    double r[3], s[3], turn[3], spin[3], swing[3];
    arm(m, X, r);
    rotate(pose, r, s);
    if (x)
        for (int d = 0; d < m->dim; d++) x[d] = m->centre[d] + pose->state.value[d] + s[d];
    if (!v && !a) return;
    mps__cross(pose->omega, s, turn);
    if (v) add_linear(m, pose->state.rate, turn, v);
    if (!a) return;
    /* alpha x r + omega x (omega x r) */
    mps__cross(pose->alpha, s, swing);
    mps__cross(pose->omega, turn, spin);
    for (int d = 0; d < 3; d++) swing[d] += spin[d];
    add_linear(m, pose->state.accel, swing, a);
}

void mps__motion_to_tank(const mps__motion *m, const mps__pose *pose, const double *x, double *X)
{
    mps__tank_place(m->dim, m->centre, pose->state.value, pose->rotation, x, X);
}

void mps__motion_view(const mps__motion *m, const mps__pose *pose, mps_tank_pose *view)
{
    *view = (mps_tank_pose){.has_next = 0};
    memcpy(view->centre, m->centre, sizeof view->centre);
    memcpy(view->shift, pose->state.value, sizeof view->shift);
    memcpy(view->rotation, pose->rotation, sizeof view->rotation);
    memcpy(view->rate, pose->state.rate, sizeof view->rate);
    memcpy(view->omega, pose->omega, sizeof view->omega);
}

void mps__motion_view_next(const mps__pose *pose, mps_tank_pose *view)
{
    memcpy(view->next_shift, pose->state.value, sizeof view->next_shift);
    memcpy(view->next_rotation, pose->rotation, sizeof view->next_rotation);
    view->has_next = 1;
}

mps__carry mps__motion_carry(const mps__motion *m, const mps__pose *pose)
{
    mps__carry k;
    for (int d = 0; d < 3; d++) {
        k.at[d] = m->centre[d] + pose->state.value[d];
        k.rate[d] = pose->state.rate[d];
        k.omega[d] = pose->omega[d];
    }
    return k;
}

bool mps__motion_rotated(const mps__pose *pose)
{
    bool turned = false;
    for (int k = 0; k < 9; k++) turned |= pose->rotation[k] != (k % 4 == 0);
    return turned;
}

void mps__motion_rotate(const mps__motion *m, const mps__pose *pose, const double *V, double *v)
{
    double in[3] = {V[0], V[1], m->dim == 3 ? V[2] : 0.0}, out[3];
    rotate(pose, in, out);
    memcpy(v, out, (size_t)m->dim * sizeof(double));
}

void mps__motion_rotate_back(const mps__motion *m, const mps__pose *pose, const double *v,
                             double *V)
{
    const double *R = pose->rotation, in[3] = {v[0], v[1], m->dim == 3 ? v[2] : 0.0};
    for (int d = 0; d < m->dim; d++) V[d] = R[d] * in[0] + R[3 + d] * in[1] + R[6 + d] * in[2];
}
