/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics of the rigid tank: x = c + d + R (X - c), R = Rz(yaw) Ry(pitch) Rx(roll); in 2-D R = Rz(roll + yaw). */
#include "motion.h"
#include <math.h>
#include <string.h>

/* Beyond the table's end by rounding only [s]. */
static const double end_slack = 1e-9;

static const char *const dof_name[MPS_DOF_COUNT] = {"surge", "heave", "sway",
                                                    "roll",  "yaw",   "pitch"};

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void rotation_matrix(const double q[MPS_DOF_COUNT], double R[9])
{
    double cr = cos(q[MPS_ROLL]), sr = sin(q[MPS_ROLL]), cp = cos(q[MPS_PITCH]),
           sp = sin(q[MPS_PITCH]), cy = cos(q[MPS_YAW]), sy = sin(q[MPS_YAW]);
    const double rows[9] = {cy * cp,
                            cy * sp * sr - sy * cr,
                            cy * sp * cr + sy * sr,
                            sy * cp,
                            sy * sp * sr + cy * cr,
                            sy * sp * cr - cy * sr,
                            -sp,
                            cp * sr,
                            cp * cr};
    memcpy(R, rows, sizeof rows);
}

/* omega = yaw' ez + pitch' e2 + roll' e3, where e2 = Rz ey and e3 = Rz Ry ex turn with the angles before them; alpha is
 * its derivative, e2' = yaw' ez x e2 and e3' = (yaw' ez + pitch' e2) x e3. */
static void angular_rates(const mps_motion_state *s, double omega[3], double alpha[3])
{
    double cy = cos(s->value[MPS_YAW]), sy = sin(s->value[MPS_YAW]), cp = cos(s->value[MPS_PITCH]),
           sp = sin(s->value[MPS_PITCH]);
    const double e2[3] = {-sy, cy, 0}, e3[3] = {cy * cp, sy * cp, -sp};
    double roll = s->rate[MPS_ROLL], pitch = s->rate[MPS_PITCH], yaw = s->rate[MPS_YAW];
    double turn[3] = {pitch * e2[0], pitch * e2[1], yaw}, e2_rate[3], e3_rate[3];
    const double ez[3] = {0, 0, yaw};
    cross(ez, e2, e2_rate);
    cross(turn, e3, e3_rate);
    for (int d = 0; d < 3; d++) {
        omega[d] = turn[d] + roll * e3[d];
        alpha[d] = s->accel[MPS_PITCH] * e2[d] + pitch * e2_rate[d] + s->accel[MPS_ROLL] * e3[d] +
                   roll * e3_rate[d];
    }
    alpha[2] += s->accel[MPS_YAW];
}

/* In 2-D roll is another name of the one rotation there is. */
static void flatten(double q[MPS_DOF_COUNT])
{
    q[MPS_YAW] += q[MPS_ROLL];
    q[MPS_ROLL] = 0;
}

void mps__motion_pose_of(const mps_motion_state *state, int32_t dim, double t, mps__pose *pose)
{
    mps_motion_state turn = *state;
    pose->t = t;
    pose->state = *state;
    if (dim == 2) {
        flatten(turn.value);
        flatten(turn.rate);
        flatten(turn.accel);
    }
    rotation_matrix(turn.value, pose->rotation);
    angular_rates(&turn, pose->omega, pose->alpha);
}

/* What 2-D does not have, and what is not a number. */
static mps_status check_state(const mps__motion *m, double t, const mps_motion_state *s)
{
    const double *const set[3] = {s->value, s->rate, s->accel};
    static const char *const what[3] = {"value", "rate", "acceleration"};
    for (int k = 0; k < MPS_DOF_COUNT; k++)
        for (int v = 0; v < 3; v++) {
            if (!isfinite(set[v][k]))
                return mps__fail(m->context, MPS_E_PLUGIN, "motion: %s %s is %g at t = %g s",
                                 dof_name[k], what[v], set[v][k], t);
            MPS__CHECK(
                m->context, m->dim == 3 || (k != MPS_SWAY && k != MPS_PITCH) || set[v][k] == 0,
                "motion: %s %s is %g at t = %g s, but 2-D has surge, heave, and roll or yaw only",
                dof_name[k], what[v], set[v][k], t);
        }
    return MPS_OK;
}

/* The arm from the centre, in three dimensions: in 2-D the tank's third coordinate is the centre's. */
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
    mps__motion_pose_of(&m->hold, dim, 0, &m->now);
}

void mps__motion_free(mps__motion *m)
{
    if (m->release) m->release(m->context, m->user);
    m->fn = NULL;
    m->user = NULL;
    m->release = NULL;
    m->t_end = INFINITY;
}

mps_status mps__motion_pose(mps__motion *m, double t, mps__pose *pose)
{
    if (!m->fn) {
        mps__motion_pose_of(&m->hold, m->dim, t, pose);
        return MPS_OK;
    }
    if (t > m->t_end + end_slack)
        return mps__fail(
            m->context, MPS_E_STATE,
            "the motion is not defined at t = %.10g s: the last row of its table is at %.10g s", t,
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
    mps__motion_pose_of(&state, m->dim, t, pose);
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
    cross(pose->omega, s, turn);
    if (v) add_linear(m, pose->state.rate, turn, v);
    if (!a) return;
    /* alpha x r + omega x (omega x r) */
    cross(pose->alpha, s, swing);
    cross(pose->omega, turn, spin);
    for (int d = 0; d < 3; d++) swing[d] += spin[d];
    add_linear(m, pose->state.accel, swing, a);
}

void mps__motion_to_tank(const mps__motion *m, const mps__pose *pose, const double *x, double *X)
{
    const double *R = pose->rotation;
    double r[3] = {0, 0, 0};
    for (int d = 0; d < m->dim; d++) r[d] = x[d] - m->centre[d] - pose->state.value[d];
    for (int d = 0; d < m->dim; d++)
        X[d] = m->centre[d] + (R[d] * r[0] + R[3 + d] * r[1] + R[6 + d] * r[2]);
}

bool mps__motion_turned(const mps__pose *pose)
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
