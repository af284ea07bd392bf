/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/motion.h. A new motion moves the tank and its contents to its pose at the
 * present time. */
#include "api_motion.h"
#include "step.h"
#include "builtin_motion.h"
#include <math.h>
#include <mps/couple.h>
#include <string.h>

static void release_block(mps__context *c, void *user)
{
    mps__free(c, user);
}

mps_status mps__sim_motion_free(mps_sim *sim)
{
    int32_t open = mps__particles_leases(&sim->world.particles);
    if (open > 0)
        return mps__fail(&sim->context, MPS_E_BUSY,
                         "%d leases are open: give them back before changing the motion",
                         (int)open);
    return MPS_OK;
}

static mps_status check_dof(mps_sim *sim, const char *what, int64_t index, int32_t dof)
{
    MPS__CHECK(&sim->context, dof >= 0 && dof < MPS_DOF_COUNT,
               "%s %lld: degree of freedom %d is not one of 0..%d", what, (long long)index,
               (int)dof, MPS_DOF_COUNT - 1);
    MPS__CHECK(&sim->context, mps__dof_in_plane(dof) || sim->world.setup.dim == 3,
               "%s %lld: degree of freedom '%s' (%d) needs 3-D; 2-D has MPS_MOVE_X (%d), "
               "MPS_MOVE_Y (%d) and MPS_ROTATE_Z (%d)",
               what, (long long)index, mps__dof_name[dof], (int)dof, MPS_MOVE_X, MPS_MOVE_Y,
               MPS_ROTATE_Z);
    return MPS_OK;
}

static bool same(const double *a, const double *b, int count)
{
    for (int k = 0; k < count; k++)
        if (a[k] != b[k]) return false;
    return true;
}

/* Keep the particle positions in the tank frame. Velocities stay: the next step sees the velocity
 * jump of the walls. */
static mps_status carry_particles(mps_sim *sim, const mps__motion *old)
{
    mps__world *w = &sim->world;
    const mps__motion *m = &w->motion;
    mps__particles *s = &w->particles;
    if (same(old->now.state.value, m->now.state.value, MPS_DOF_COUNT) &&
        same(old->centre, m->centre, 3))
        return MPS_OK;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_REF)); /* a model may move solids in the tank */
    MPS__TRY(mps__world_write_field(w, MPS__FIELD_POSITION));
    for (int64_t i = 0; i < s->n; i++) {
        double X[3], *x = &s->x[i * s->dim];
        if (s->kind[i] == MPS_FLUID)
            mps__motion_to_tank(old, &old->now, x, X);
        else
            memcpy(X, &s->ref[i * s->dim], (size_t)s->dim * sizeof(double));
        mps__motion_point(m, &m->now, X, x, NULL, NULL);
    }
    /* the change from the old pose to the new one is no motion: the tank starts anew */
    w->state.dt_before = 0;
    return MPS_OK;
}

mps_status mps__sim_motion_install(mps_sim *sim, mps__motion *next)
{
    mps__world *w = &sim->world;
    mps_status status = mps__motion_pose(next, w->state.t, &next->now);
    if (status == MPS_OK) status = mps__world_check_pose(w, next, &next->now, MPS_E_ARG);
    if (status < 0) {
        mps__motion_free(next);
        return status;
    }
    mps__motion old = w->motion;
    const bool goes_on = (old.posed && next->posed) ||
                         (next->fn == mps__body_motion && w->state.step > 0);
    w->motion = *next;
    status = carry_particles(sim, &old);
    if (status < 0) {
        w->motion = old;
        if (old.user != next->user) mps__motion_free(next);
        return status;
    }
    /* the limits predicted by the last step used velocities relative to the tank */
    if (!same(old.now.state.rate, next->now.state.rate, MPS_DOF_COUNT)) w->next_flags.flow = -1;
    if (old.user != next->user) mps__motion_free(&old);
    /* the next pose of a tank that is moved by poses is no start */
    if (!goes_on) w->state.start_pending = next->fn && next->start == MPS_START_WITH_TANK;
    return MPS_OK;
}

/* Install a motion of the library: it owns its data, and its step length limit is known. */
static mps_status install_built_in(mps_sim *sim, mps_motion_fn fn, void *data,
                                   double (*longest)(const void *, double, double), double t_end)
{
    mps__motion next = sim->world.motion;
    next.fn = fn;
    next.user = data;
    next.release = release_block;
    next.t_end = t_end;
    next.longest = longest;
    next.logged = false;
    next.posed = NULL;
    return mps__sim_motion_install(sim, &next);
}

static mps_status install_function(mps_sim *sim, mps_motion_fn fn, void *user)
{
    mps__motion next = sim->world.motion;
    next.fn = fn;
    next.user = user;
    next.release = NULL;
    next.t_end = INFINITY;
    next.longest = NULL;
    next.posed = NULL;
    return mps__sim_motion_install(sim, &next);
}

static mps_status no_memory(mps_sim *sim, int64_t rows)
{
    return mps__fail(&sim->context, MPS_E_NOMEM, "no memory for a motion of %lld rows",
                     (long long)rows);
}

static mps_status check_harmonic(mps_sim *sim, int32_t k, const mps_harmonic *h)
{
    mps__context *c = &sim->context;
    MPS__TRY(check_dof(sim, "harmonic", k, h->dof));
    MPS__CHECK(c, h->form == 0 || h->form == 1, "harmonic %d: form is %d, must be 0 or 1", (int)k,
               (int)h->form);
    MPS__CHECK(c, isfinite(h->amplitude), "harmonic %d: amplitude is %g, must be finite", (int)k,
               h->amplitude);
    MPS__CHECK(c, isfinite(h->omega) && h->omega >= 0,
               "harmonic %d: omega is %g rad/s, must be finite and >= 0", (int)k, h->omega);
    MPS__CHECK(c, isfinite(h->phase), "harmonic %d: phase is %g, must be finite", (int)k, h->phase);
    MPS__CHECK(c, isfinite(h->ramp) && h->ramp >= 0,
               "harmonic %d: ramp is %g s, must be finite and >= 0", (int)k, h->ramp);
    return MPS_OK;
}

static mps_status check_table_times(mps_sim *sim, int64_t rows, const double *t)
{
    mps__context *c = &sim->context;
    for (int64_t k = 0; k < rows; k++) {
        MPS__CHECK(c, isfinite(t[k]), "motion table: t is %g in row %lld, must be finite", t[k],
                   (long long)k);
        MPS__CHECK(
            c, k == 0 || t[k] > t[k - 1],
            "motion table: t = %.10g in row %lld does not increase, the row before has %.10g", t[k],
            (long long)k, t[k > 0 ? k - 1 : 0]);
    }
    MPS__CHECK(c, t[0] <= sim->world.state.t,
               "motion table: t = %.10g in row 0 is after the present time %.10g", t[0],
               sim->world.state.t);
    return MPS_OK;
}

static mps_status check_table_columns(mps_sim *sim, int32_t dofs, const int32_t *dof)
{
    for (int32_t c = 0; c < dofs; c++) {
        MPS__TRY(check_dof(sim, "motion table: column", c, dof[c]));
        for (int32_t b = 0; b < c; b++)
            MPS__CHECK(&sim->context, dof[b] != dof[c],
                       "motion table: columns %d and %d are both degree of freedom %d", (int)b,
                       (int)c, (int)dof[c]);
    }
    return MPS_OK;
}

mps_status mps_motion_state_init(mps_motion_state *state, size_t size)
{
    static const mps_motion_state rest = {.struct_size = sizeof rest};
    return mps__struct_init("mps_motion_state", state, size, &rest, sizeof rest);
}

mps_status mps_motion_centre_set(mps_sim *sim, const double *centre, int32_t start)
{
    MPS__SETS(sim);
    mps__world *w = &sim->world;
    MPS__TRY(mps__sim_motion_free(sim));
    if (w->state.step > 0)
        return mps__fail(&sim->context, MPS_E_STATE,
                         "the centre is set before the first step; %lld steps were taken",
                         (long long)w->state.step);
    MPS__CHECK(&sim->context, centre, "centre is NULL");
    MPS__CHECK(&sim->context, start == MPS_START_AT_REST || start == MPS_START_WITH_TANK,
               "start is %d: must be MPS_START_AT_REST (0) or MPS_START_WITH_TANK (1)", (int)start);
    mps__motion next = w->motion;
    for (int32_t d = 0; d < w->setup.dim; d++) {
        MPS__CHECK(&sim->context, fabs(centre[d]) <= MPS__FARTHEST * w->setup.dp,
                   "centre[%d] is %g m: must be within %g m, %g spacings, of the origin", (int)d,
                   centre[d], MPS__FARTHEST * w->setup.dp, MPS__FARTHEST);
        next.centre[d] = centre[d];
    }
    /* the current pose does not depend on the centre */
    mps__motion old = w->motion;
    next.start = start;
    w->motion = next;
    const mps_status status = carry_particles(sim, &old);
    if (status < 0) {
        w->motion = old;
        return status;
    }
    w->state.start_pending = next.fn && start == MPS_START_WITH_TANK;
    return MPS_OK;
}

mps_status mps_motion_harmonics_set(mps_sim *sim, int32_t count, const mps_harmonic *harmonics)
{
    MPS__SETS(sim);
    MPS__TRY(mps__sim_motion_free(sim));
    MPS__CHECK(&sim->context, count >= 1, "harmonics: count is %d, must be at least 1", (int)count);
    MPS__CHECK(&sim->context, harmonics, "harmonics is NULL");
    for (int32_t k = 0; k < count; k++) MPS__TRY(check_harmonic(sim, k, &harmonics[k]));
    void *data = mps__motion_harmonic_create(&sim->context.allocator, count, harmonics);
    if (!data) return no_memory(sim, count);
    return install_built_in(sim, mps__motion_harmonic, data, mps__motion_harmonic_longest,
                            INFINITY);
}

mps_status mps_motion_table_set(mps_sim *sim, int64_t rows, const double *t, int32_t dofs,
                                const int32_t *dof, const double *values)
{
    MPS__SETS(sim);
    mps__context *c = &sim->context;
    MPS__TRY(mps__sim_motion_free(sim));
    MPS__CHECK(c, rows >= 2 && rows <= INT32_MAX, "motion table: %lld rows, must be 2..%d",
               (long long)rows, INT32_MAX);
    MPS__CHECK(c, dofs >= 1 && dofs <= MPS_DOF_COUNT, "motion table: %d columns, must be 1..%d",
               (int)dofs, MPS_DOF_COUNT);
    MPS__CHECK(c, t && dof && values, "motion table: %s is NULL",
               !t     ? "t"
               : !dof ? "dof"
                      : "values");
    MPS__TRY(check_table_columns(sim, dofs, dof));
    MPS__TRY(check_table_times(sim, rows, t));
    for (int64_t k = 0; k < rows * dofs; k++)
        MPS__CHECK(c, isfinite(values[k]),
                   "motion table: value %g in row %lld, column %d is not finite", values[k],
                   (long long)(k / dofs), (int)(k % dofs));
    void *data = mps__motion_table_create(&c->allocator, rows, t, dofs, dof, values);
    if (!data) return no_memory(sim, rows);
    return install_built_in(sim, mps__motion_table, data, mps__motion_table_longest, t[rows - 1]);
}

mps_status mps_motion_callback_set(mps_sim *sim, mps_motion_fn fn, void *user)
{
    MPS__SETS(sim);
    MPS__TRY(mps__sim_motion_free(sim));
    MPS__CHECK(&sim->context, fn,
               "the motion callback is NULL: use mps_motion_clear() for no motion");
    return install_function(sim, fn, user);
}

mps_status mps_motion_clear(mps_sim *sim)
{
    MPS__SETS(sim);
    MPS__TRY(mps__sim_motion_free(sim));
    mps__motion next = sim->world.motion;
    next.hold = (mps_motion_state){.struct_size = sizeof next.hold};
    memcpy(next.hold.value, next.now.state.value, sizeof next.hold.value);
    next.fn = NULL;
    next.user = NULL;
    next.release = NULL;
    next.longest = NULL;
    next.posed = NULL;
    next.t_end = INFINITY;
    return mps__sim_motion_install(sim, &next);
}

mps_status mps_motion_pose_set(mps_sim *sim, double t_end, const mps_motion_state *state)
{
    MPS__SETS(sim);
    mps__world *w = &sim->world;
    mps__posed way = {.begin = w->state.t, .end = t_end, .from = w->motion.now.state};
    mps__pose last;
    MPS__TRY(mps__sim_motion_free(sim));
    way.to.struct_size = way.from.struct_size = sizeof way.to;
    MPS__TRY(mps__struct_in(&sim->context, "mps_motion_state", &way.to, sizeof way.to, state));
    MPS__CHECK(&sim->context, isfinite(t_end) && t_end > w->state.t,
               "mps_motion_pose_set(): t_end is %.10g s: must be finite and after the present time "
               "%.10g s",
               t_end, w->state.t);
    mps__motion next = w->motion;
    next.fn = mps__motion_posed;
    next.user = &way;
    next.release = NULL; /* the present motion stays if this one is refused */
    next.t_end = t_end;
    next.longest = NULL;
    next.logged = false;
    /* an error in a callback of the library must not mention a plug-in */
    if (mps__motion_pose(&next, t_end, &last) < 0) return MPS_E_ARG;
    MPS__TRY(mps__world_check_pose(w, &next, &last, MPS_E_ARG));
    next.posed = next.user = mps__alloc(&sim->context, 1, sizeof way);
    if (!next.user) return MPS_E_NOMEM;
    *next.posed = way;
    next.release = release_block;
    return mps__sim_motion_install(sim, &next);
}

mps_status mps_motion_state_get(const mps_sim *sim, mps_motion_state *state)
{
    if (!sim) return MPS_E_ARG;
    const mps_motion_state *now = &sim->world.motion.now.state;
    return mps__struct_out(mps__sim_context(sim), "mps_motion_state", state, now, sizeof *now);
}

mps_status mps_motion_state_at(mps_sim *sim, double t, mps_motion_state *state)
{
    MPS__READS(sim);
    mps__world *w = &sim->world;
    mps__pose pose;
    MPS__TRY(mps__struct_check(w->context, "mps_motion_state", state));
    MPS__CHECK(w->context, isfinite(t), "mps_motion_state_at(): t is %g s: must be finite", t);
    if (mps__body_carries(w))
        return mps__fail(w->context, MPS_E_STATE,
                         "mps_motion_state_at(): a body carries the tank: its motion is not known "
                         "in advance");
    MPS__TRY(mps__motion_pose(&w->motion, t, &pose));
    return mps__struct_out(w->context, "mps_motion_state", state, &pose.state, sizeof pose.state);
}

mps_status mps_motion_to_lab(const mps_sim *sim, const double *tank, double *lab, double *velocity)
{
    if (!sim) return MPS_E_ARG;
    const mps__motion *m = &sim->world.motion;
    MPS__CHECK(mps__sim_context(sim), tank && lab, "%s is NULL", tank ? "lab" : "tank");
    MPS__CHECK(mps__sim_context(sim), mps__finite(tank, m->dim),
               "the point (%g, %g%s) is not finite", tank[0], tank[1], m->dim == 3 ? ", ..." : "");
    mps__motion_point(m, &m->now, tank, lab, velocity, NULL);
    return MPS_OK;
}
