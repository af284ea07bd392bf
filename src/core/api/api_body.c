/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/body.h. */
#include "api_motion.h"
#include "step.h"
#include <mps/body.h>
#include <string.h>

static const mps_body body_default = {.struct_size = sizeof(mps_body), .gravity = 1};
static const mps_body_report report_default = {.struct_size = sizeof(mps_body_report)};

mps_status mps_body_init(mps_body *body, size_t size)
{
    return mps__struct_init("mps_body", body, size, &body_default, sizeof body_default);
}

mps_status mps_body_report_init(mps_body_report *report, size_t size)
{
    return mps__struct_init("mps_body_report", report, size, &report_default,
                            sizeof report_default);
}

/* ---- arguments ---- */

static mps_status check_free(const mps__world *w, const mps_body *b)
{
    MPS__CHECK(w->context, b->free > 0 && b->free < 1 << MPS_DOF_COUNT,
               "mps_body.free is %d: must be a sum of MPS_BODY_FREE(), 1..%d", (int)b->free,
               (1 << MPS_DOF_COUNT) - 1);
    for (int32_t k = 0; k < MPS_DOF_COUNT; k++)
        MPS__CHECK(w->context,
                   w->setup.dim == 3 || mps__dof_in_plane(k) || !mps__rigid_is_free(b, k),
                   "mps_body.free is %d and has '%s', which 2-D lacks: 2-D has MPS_MOVE_X, "
                   "MPS_MOVE_Y and MPS_ROTATE_Z",
                   (int)b->free, mps__dof_name[k]);
    return MPS_OK;
}

static mps_status check_array(const mps__world *w, const char *name, const double *value,
                              int32_t count)
{
    for (int32_t k = 0; k < count; k++)
        MPS__CHECK(w->context, isfinite(value[k]), "mps_body.%s[%d] is %g: must be finite", name,
                   (int)k, value[k]);
    return MPS_OK;
}

/* A physical body has non-negative moments about every axis: all principal minors are non-negative,
 * except for rounding. */
static mps_status check_inertia(const mps__world *w, const double *i)
{
    double size = 0;
    for (int k = 0; k < 9; k++) size = fmax(size, fabs(i[k]));
    const double small = 1e-9 * size;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const double a = i[4 * r], b = i[4 * c], one = i[3 * r + c], other = i[3 * c + r];
            MPS__CHECK(w->context, fabs(one - other) <= small,
                       "mps_body.inertia is not symmetric: [%d] is %g, [%d] is %g", 3 * r + c, one,
                       3 * c + r, other);
            MPS__CHECK(w->context, w->setup.dim == 3 || (r == 2 && c == 2) || one == 0,
                       "mps_body.inertia[%d] is %g: must be 0 in 2-D, only [8] is not", 3 * r + c,
                       one);
            MPS__CHECK(w->context, a >= 0 && (r == c || a * b - one * other >= -small * size),
                       "mps_body.inertia has a negative moment: [%d] is %g, [%d] is %g, [%d] is %g",
                       4 * r, a, 4 * c, b, 3 * r + c, one);
        }
    const double whole = i[0] * (i[4] * i[8] - i[5] * i[7]) - i[1] * (i[3] * i[8] - i[5] * i[6]) +
                         i[2] * (i[3] * i[7] - i[4] * i[6]);
    MPS__CHECK(w->context, whole >= -small * size * size,
               "mps_body.inertia has a negative moment about some axis: its determinant is %g",
               whole);
    return MPS_OK;
}

static mps_status check_body(const mps__world *w, const mps_body *b)
{
    MPS__TRY(check_free(w, b));
    MPS__CHECK(w->context, b->mass >= 0 && isfinite(b->mass),
               "mps_body.mass is %g kg: must be finite and >= 0", b->mass);
    MPS__TRY(check_array(w, "centre_of_mass", b->centre_of_mass, 3));
    MPS__TRY(check_array(w, "inertia", b->inertia, 9));
    MPS__TRY(check_array(w, "stiffness", b->stiffness, 36));
    MPS__TRY(check_array(w, "damping", b->damping, 36));
    MPS__TRY(check_array(w, "equilibrium", b->equilibrium, 6));
    for (int k = 0; k < 6; k++)
        MPS__CHECK(w->context, b->friction[k] >= 0 && isfinite(b->friction[k]),
                   "mps_body.friction[%d] is %g: must be finite and >= 0", k, b->friction[k]);
    MPS__CHECK(w->context, b->gravity == 0 || b->gravity == 1,
               "mps_body.gravity is %d: must be 0 or 1", (int)b->gravity);
    return check_inertia(w, b->inertia);
}

/* ---- the body ---- */

/* Initialise with the velocities of the tank and an unknown acceleration. */
static void begin(mps__world *w)
{
    mps__body *b = &w->body;
    mps_motion_state now = w->motion.now.state;
    memset(now.accel, 0, sizeof now.accel);
    mps__motion_pose_of(&now, w->state.t, &w->motion.now);
    b->state = (mps__body_state){.late = {0}};
    b->state.start = mps__rigid_kinetic(&b->given, w->motion.centre, &now) +
                     mps__rigid_spring(&b->given, now.value);
    mps__rigid_place(&b->given, w->motion.centre, &now, b->state.origin);
}

mps_status mps_body_set(mps_sim *sim, const mps_body *body)
{
    MPS__SETS(sim);
    mps__world *w = &sim->world;
    mps_body own = body_default;
    MPS__TRY(mps__sim_motion_free(sim));
    if (!body) return mps__body_carries(w) ? mps_motion_clear(sim) : MPS_OK;
    MPS__TRY(mps__struct_in(w->context, "mps_body", &own, sizeof own, body));
    MPS__TRY(check_body(w, &own));
    own.struct_size = sizeof own;
    if (w->setup.dim == 2) own.centre_of_mass[2] = w->motion.centre[2];
    MPS__TRY(mps__ranks_report(&w->ranks, mps__world_add_guess(w)));
    const mps__body before = w->body;
    mps__motion next = w->motion;
    w->body.given = own;
    next.fn = mps__body_motion;
    next.user = w;
    next.release = NULL;
    next.longest = NULL;
    next.posed = NULL;
    next.t_end = INFINITY;
    const mps_status status = mps__sim_motion_install(sim, &next);
    if (status < 0) {
        w->body = before;
        return status;
    }
    begin(w);
    return MPS_OK;
}

/* Energies at the middle of the last step. */
static void put_energies(const mps__world *w, mps_body_report *out)
{
    const mps__body *b = &w->body;
    const mps_motion_state *now = &w->motion.now.state;
    double middle[6], place[3];
    mps_motion_state half = *now;
    for (int k = 0; k < 6; k++) {
        middle[k] = now->value[k];
        if (mps__rigid_is_free(&b->given, k)) middle[k] -= 0.5 * w->state.dt_before * now->rate[k];
        half.value[k] = middle[k];
    }
    out->kinetic = mps__rigid_kinetic(&b->given, w->motion.centre, now);
    out->spring = mps__rigid_spring(&b->given, middle);
    mps__rigid_place(&b->given, w->motion.centre, &half, place);
    for (int d = 0; d < 3 && b->given.gravity; d++)
        out->weight -= b->given.mass * w->setup.g[d] * (place[d] - b->state.origin[d]);
}

mps_status mps_body_get(mps_sim *sim, mps_body_report *report)
{
    MPS__READS(sim);
    mps__world *w = &sim->world;
    const mps__body_state *k = &w->body.state;
    const mps_motion_state *now = &w->motion.now.state;
    mps_body_report out = report_default;
    MPS__TRY(mps__struct_check(w->context, "mps_body_report", report));
    if (!mps__body_carries(w))
        return mps__fail(w->context, MPS_E_STATE,
                         "mps_body_get(): no body carries the tank: call mps_body_set() first");
    out.free = w->body.given.free;
    out.iterations = (int32_t)k->iterations;
    memcpy(out.pose, now->value, sizeof out.pose);
    memcpy(out.velocity, now->rate, sizeof out.velocity);
    memcpy(out.acceleration, now->accel, sizeof out.acceleration);
    memcpy(out.liquid, k->liquid, sizeof out.liquid);
    memcpy(out.external, k->external, sizeof out.external);
    memcpy(out.restoring, k->restoring, sizeof out.restoring);
    memcpy(out.mass, k->mass, sizeof out.mass);
    for (int d = 0; d < 6 && w->state.dt_before > 0; d++)
        out.late[d] = k->late[d] / w->state.dt_before;
    memcpy(out.friction, k->friction, sizeof out.friction);
    out.rubbed = k->rubbed;
    out.damped = k->damped;
    out.external_work = k->external_work;
    out.liquid_work = k->liquid_work;
    out.start = k->start;
    put_energies(w, &out);
    return mps__struct_out(w->context, "mps_body_report", report, &out, sizeof out);
}
