/* SPDX-License-Identifier: BSD-3-Clause */
/* A body that carries the tank. A step begins with the acceleration of the last one. Once pressures
 * and the accelerations of the liquid are known, its load is F = F0 - A a, and the body's equation
 * gives a. Pressures, velocities of walls and all accelerations are linear in a: they are corrected
 * in place, by the columns of the added mass. Effects of later parts of the step on the liquid act
 * on the body in the next one. */
#include "step.h"
#include <string.h>

int mps__body_motion(void *user, double t, mps_motion_state *state)
{
    const mps__world *w = user;
    const mps_motion_state *now = &w->motion.now.state;
    mps__rigid_advance(&w->body.given, now, now->accel, t - w->state.t, state);
    return 0;
}

/* ---- the body's equation ---- */

static mps_status ask_load(mps__step *q, double load[6])
{
    mps__world *w = q->w;
    const mps_body *b = &w->body.given;
    for (int k = 0; k < 6; k++) load[k] = 0;
    if (!b->load) return MPS_OK;
    mps_motion_state now = w->motion.now.state;
    now.struct_size = sizeof now;
    const mps__lock before = mps__lock_set(w->context, MPS__LOCKED, "the load of a body");
    const int failed = b->load(b->user, w->state.t, &now, load);
    w->context->lock = before;
    if (failed)
        return mps__fail(w->context, MPS_E_PLUGIN,
                         "mps_body.load failed with %d at t = %.9g s; must return 0", failed,
                         w->state.t);
    for (int k = 0; k < 6; k++)
        if (!isfinite(load[k]))
            return mps__fail(w->context, MPS_E_PLUGIN,
                             "mps_body.load gave load[%d] = %g at t = %.9g s; must be finite", k,
                             load[k], w->state.t);
    return MPS_OK;
}

static mps_status no_solution(const mps__step *q, const mps__rigid_step *r)
{
    mps__context *c = q->w->context;
    const double t = q->w->state.t;
    if (r->singular < 0)
        return mps__fail(c, MPS_E_STATE,
                         "t = %.9g s: '%s' of the body is %g, where '%s' and '%s' are one: free "
                         "one of them only, or choose other axes",
                         t, mps__dof_name[MPS_ROTATE_Z], q->w->motion.now.state.value[MPS_ROTATE_Z],
                         mps__dof_name[MPS_ROTATE_X], mps__dof_name[MPS_ROTATE_Y]);
    return mps__fail(c, MPS_E_STATE,
                     "t = %.9g s: coupling: '%s' of the body is free, but nothing resists an "
                     "acceleration along it: body, liquid and springs have %g %s, of which the "
                     "liquid %g; must be > %g. Give the body mass or inertia, or do not free it",
                     t, mps__dof_name[r->singular], r->have,
                     r->singular < MPS_ROTATE_X ? "kg" : "kg m2", r->share, r->least);
}

/* Solve the body's equation; `change`: of the accelerations in the lab. */
static mps_status solve_body(mps__step *q, const double force[6], double change[6],
                             mps_motion_state *next)
{
    mps__world *w = q->w;
    mps__body_state *state = &q->body;
    mps__rigid_loads l = {.dt = q->view.dt,
                          .dt_before = w->state.dt_before > 0 ? w->state.dt_before : q->view.dt,
                          .liquid_mass = q->momentum_before[6],
                          .dp = w->setup.dp};
    mps__rigid_step r;
    double was[6];
    *state = w->body.state;
    MPS__TRY(ask_load(q, l.external));
    mps__step_acceleration(q, was);
    const uint32_t known = mps__rigid_columns(&w->body.given, w->setup.dim);
    for (int k = 0; k < 36; k++) l.mass[k] = known >> k % 6 & 1 ? q->load.mass[k] : 0;
    memcpy(l.g, w->setup.g, sizeof l.g);
    for (int k = 0; k < 6; k++) {
        state->felt_late[k] = state->late[k] / l.dt;
        l.rest[k] = force[k] + mps__dot6(l.mass + 6 * k, was) + state->felt_late[k];
    }
    if (!mps__rigid_solve(&w->body.given, w->motion.centre, &w->motion.now.state, &l, &r))
        return no_solution(q, &r);
    mps__rigid_advance(&w->body.given, &w->motion.now.state, r.accel, l.dt, next);
    for (int k = 0; k < 6; k++) q->felt[k] = r.liquid[k] - state->felt_late[k];
    memcpy(state->liquid, r.liquid, sizeof state->liquid);
    memcpy(state->external, l.external, sizeof state->external);
    memcpy(state->restoring, r.restoring, sizeof state->restoring);
    memcpy(state->friction, r.friction, sizeof state->friction);
    memcpy(state->mass, l.mass, sizeof state->mass);
    state->damped += r.damped;
    state->rubbed += r.rubbed;
    state->external_work += r.external_work;
    state->liquid_work += r.liquid_work;
    state->iterations = q->load.iterations;
    /* as for the liquid, from pose to pose */
    mps__motion_pose_of(next, q->pose.t, &q->pose);
    mps__step_acceleration(q, change);
    for (int k = 0; k < 6; k++) change[k] -= was[k];
    return MPS_OK;
}

/* ---- corrections ---- */

typedef struct changes {
    const double *place;                 /* of solids at the end of the step, tank's frame */
    const double *columns_p, *columns_a; /* changes by each column [n*count], [n*count*dim] */
    double *pressure, *acceleration, *tank, *velocity;
    double shift[3], rotation[9]; /* of the tank at the end of the step, as predicted */
    double change[6];             /* of the columns' accelerations */
    int32_t count;
} changes;

/* Displacement of a particle's position in the tank from the predicted to the actual end of the
 * step. */
MPS_ROW void find_way(const int dim, const mps_view *v, const changes *f, int64_t i, double way[3])
{
    const mps_tank_pose *k = &v->tank;
    double X[3], old[3], next[3];
    if (mps_is_fluid(v, i))
        mps__tank_place(dim, k->centre, k->shift, k->rotation, v->x + i * dim, X);
    else
        for (int d = 0; d < dim; d++) X[d] = f->place[i * dim + d];
    mps__tank_point(dim, k->centre, f->shift, f->rotation, X, old);
    mps__tank_point(dim, k->centre, k->next_shift, k->next_rotation, X, next);
    for (int d = 0; d < dim; d++) way[d] = next[d] - old[d];
}

MPS_ROW void raise_way(const int dim, const mps_view *v, const changes *f, int64_t i, double *most)
{
    double way[3];
    if (mps_is_fluid(v, i)) return;
    find_way(dim, v, f, i, way);
    const double square = mps__dot(way, way, dim);
    *most = square <= *most ? *most : square;
}
MPS_SUMS(raise_ways, raise_way, changes)

/* Models let fluid that no wall contains fall with g, whatever the tank does (body.free). */
MPS_ROW bool falls(const int dim, const mps_view *v, const changes *f, int64_t i)
{
    bool same = mps_is_fluid(v, i);
    for (int d = 0; d < dim; d++) same = same && f->tank[i * dim + d] == v->g[d];
    return same;
}

MPS_ROW void correct_row(const int dim, const mps_view *v, const changes *f, int64_t i)
{
    const bool fluid = mps_is_fluid(v, i);
    double way[3];
    if (falls(dim, v, f, i)) return;
    find_way(dim, v, f, i, way);
    for (int d = 0; d < dim; d++) {
        const int64_t k = i * dim + d;
        f->tank[k] += way[d] / (v->dt * v->dt);
        if (!fluid) f->velocity[k] += way[d] / v->dt;
    }
    for (int32_t c = 0; c < f->count; c++) {
        const int64_t column = i * f->count + c;
        f->pressure[i] += f->change[c] * f->columns_p[column];
        for (int d = 0; d < dim && fluid; d++)
            f->acceleration[i * dim + d] += f->change[c] * f->columns_a[column * dim + d];
    }
}
MPS_ROWS(correct_rows, correct_row, changes)

enum { PRESSURE, ACCELERATION, TANK, VELOCITY, DENSITY, REGION, PLACE, USES };

/* Fail if the body moves farther than a spacing from the prediction. */
static mps_status check_way(mps_stage *s, const changes *f)
{
    const mps__step *q = mps__step_of(s);
    double most;
    mps_stage_max(s, 1, &raise_ways, f, &most);
    const double way = sqrt(fmax(most, 0)), allowed = s->view->dp;
    if (way <= allowed) return MPS_OK;
    return mps__fail(q->w->context, MPS_E_DIVERGED,
                     "t = %.9g s: coupling: the body moves walls %g m away from where its last "
                     "acceleration carries them in a step of %g s; must be at most %g m. Take "
                     "shorter steps",
                     s->view->t, way, s->view->dt, allowed);
}

static mps_status move_body(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    const mps__load_arrays arrays = {.acceleration = s->data[ACCELERATION],
                                     .tank = s->data[TANK],
                                     .density = s->data[DENSITY],
                                     .region = s->data[REGION]};
    changes f = {.place = s->data[PLACE],
                 .columns_p = w->mass.next,
                 .columns_a = w->mass.a,
                 .pressure = s->data[PRESSURE],
                 .acceleration = s->data[ACCELERATION],
                 .tank = s->data[TANK],
                 .velocity = s->data[VELOCITY]};
    double force[6], change[6];
    int32_t freedom[6];
    mps_motion_state next;
    if (w->work.bodies)
        return mps__fail(w->context, MPS_E_STATE,
                         "a body carries the tank, and a model moves solids in it (it writes "
                         "'solid_place'): remove that model, or call mps_body_set() with NULL");
    memcpy(f.shift, q->pose.state.value, sizeof f.shift);
    memcpy(f.rotation, q->pose.rotation, sizeof f.rotation);
    mps__step_freedom(w->setup.dim, freedom);
    f.count = q->columns.count;
    mps__step_load_now(s, &arrays, force);
    MPS__TRY(solve_body(q, force, change, &next));
    MPS__TRY(mps__world_check_pose(w, &w->motion, &q->pose, MPS_E_DIVERGED));
    mps__motion_view_next(&q->pose, &q->view.tank);
    for (int32_t c = 0; c < f.count; c++) f.change[c] = change[freedom[q->columns.degree[c]]];
    MPS__TRY(check_way(s, &f));
    mps_stage_rows(s, &correct_rows, &f);
    mps__step_note_jump(s, f.tank);
    mps__runner_flush(&w->runner);
    return MPS_OK;
}

static const mps_use body_uses[USES] = {
    [PRESSURE] = {"pressure", MPS_USE_CHANGE},
    [ACCELERATION] = {"acceleration", MPS_USE_CHANGE | MPS_USE_NEIGHBOURS},
    [TANK] = {"tank_acceleration", MPS_USE_CHANGE},
    [VELOCITY] = {"velocity", MPS_USE_CHANGE},
    [DENSITY] = {"pressure_density", MPS_USE_NEIGHBOURS},
    [REGION] = {"region", MPS_USE_NEIGHBOURS},
    [PLACE] = {"solid_place", MPS_USE_READ}};

static bool carries_none(const void *step)
{
    const mps__step *q = step;
    return !mps__body_carries(q->w);
}

const mps__pass mps__pass_body = {.name = "body",
                                  .hook = MPS_GRADIENT,
                                  .place = MPS__AFTER_MODELS,
                                  .stage = MPS_STAGE_CORRECT,
                                  .with_ghosts = true,
                                  .use_count = USES,
                                  .uses = body_uses,
                                  .run = move_body,
                                  .idle = carries_none};

/* Defer the effects of the step on the liquid that the body has not received. */
void mps__step_body_end(mps__step *q)
{
    if (!mps__body_carries(q->w)) return;
    for (int k = 0; k < 6; k++) q->body.late[k] = q->view.dt * (q->load.force[k] - q->felt[k]);
    q->w->body.state = q->body;
}
