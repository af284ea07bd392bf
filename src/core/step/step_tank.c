/* SPDX-License-Identifier: BSD-3-Clause */
/* The tank in a step: velocities of its solids, accelerations of the rigid tank, jumps of its
 * velocity. */
#include "step.h"
#include <string.h>

/* Whether both poses are equal in position and rotation. */
static bool same_place(const mps__pose *a, const mps__pose *b)
{
    bool same = true;
    for (int k = 0; k < MPS_DOF_COUNT; k++) same = same && a->state.value[k] == b->state.value[k];
    for (int k = 0; k < 9; k++) same = same && a->rotation[k] == b->rotation[k];
    return same;
}

/* Whether the tank neither moves in this step nor moved before it. */
static bool at_rest(const mps__step *q)
{
    const mps__world *w = q->w;
    const bool was = w->state.dt_before > 0 ? same_place(&w->state.before, &w->motion.now)
                                            : w->motion.start != MPS_START_WITH_TANK;
    return was && same_place(&w->motion.now, &q->pose);
}

/* ---- velocities and accelerations ---- */

/* Motion of the tank before this step: by its last pose, by its rates (a start with the tank),
 * none; if solids move in the tank, by the velocities of the solids. */
enum { BY_POSE, BY_RATES, AT_REST, AS_BEFORE };

typedef struct tank_fields {
    const double *ref, *place; /* of solids in the frame of the tank, at both ends of the step */
    double *velocity, *acceleration;
    double before_shift[3], before_rotation[9]; /* at the beginning of the last step */
    double dt_before;
    int32_t before;
} tank_fields;

/* Velocity of a point X of the tank over the last step; its present position is `here`. */
MPS_ROW void velocity_before(const int dim, const mps_view *v, const tank_fields *f,
                             const double *X, const double here[3], double u[3])
{
    double from[3], arm[3] = {0, 0, 0};
    for (int d = 0; d < 3; d++) u[d] = 0;
    if (f->before == BY_POSE || (f->before == AS_BEFORE && f->dt_before > 0)) {
        mps__tank_point(dim, v->tank.centre, f->before_shift, f->before_rotation, X, from);
        for (int d = 0; d < dim; d++) u[d] = (here[d] - from[d]) / f->dt_before;
    } else if (f->before == BY_RATES) {
        const double *R = v->tank.rotation, *o = v->tank.omega;
        double r[3] = {0, 0, 0};
        for (int d = 0; d < dim; d++) r[d] = X[d] - v->tank.centre[d];
        for (int d = 0; d < 3; d++)
            arm[d] = R[3 * d] * r[0] + R[3 * d + 1] * r[1] + R[3 * d + 2] * r[2];
        for (int d = 0; d < dim; d++) {
            const int e = (d + 1) % 3, g = (d + 2) % 3;
            u[d] = v->tank.rate[d] + (o[e] * arm[g] - o[g] * arm[e]);
        }
    }
}

MPS_ROW void move_tank_row(const int dim, const mps_view *v, const tank_fields *f, int64_t i)
{
    const mps_tank_pose *k = &v->tank;
    const bool fluid = mps_is_fluid(v, i);
    double X[3], here[3], next[3], old[3];
    if (fluid)
        mps__tank_place(dim, k->centre, k->shift, k->rotation, v->x + i * dim, X);
    else
        for (int d = 0; d < dim; d++) X[d] = f->ref[i * dim + d];
    mps__tank_point(dim, k->centre, k->shift, k->rotation, X, here);
    mps__tank_point(dim, k->centre, k->next_shift, k->next_rotation, fluid ? X : f->place + i * dim,
                    next);
    velocity_before(dim, v, f, X, here, old);
    for (int d = 0; d < dim && !fluid && f->before == AS_BEFORE; d++)
        old[d] = f->velocity[i * dim + d];
    for (int d = 0; d < dim; d++) {
        const double u = (next[d] - here[d]) / v->dt;
        f->acceleration[i * dim + d] = (u - old[d]) / v->dt;
        if (!fluid) f->velocity[i * dim + d] = u;
    }
}
MPS_ROWS(move_tank_rows, move_tank_row, tank_fields)

MPS_ROW void rest_row(const int dim, const mps_view *v, const tank_fields *f, int64_t i)
{
    for (int64_t k = i * dim; k < (i + 1) * dim; k++) {
        f->acceleration[k] = 0;
        if (!mps_is_fluid(v, i)) f->velocity[k] = 0;
    }
}
MPS_ROWS(rest_rows, rest_row, tank_fields)

/* Set the velocity that moves solids to their next position, and for every particle the
 * acceleration of the rigid tank. */
static mps_status move_tank(mps_stage *s)
{
    const mps__step *q = mps__step_of(s);
    const mps__world *w = q->w;
    const bool with_tank = w->motion.start == MPS_START_WITH_TANK,
               bodies = w->work.bodies && w->state.dt_before > 0;
    tank_fields f = {.ref = mps__seen(w, MPS__FIELD_REF),
                     .place = s->data[2],
                     .velocity = s->data[0],
                     .acceleration = s->data[1],
                     .dt_before = w->state.dt_before,
                     .before = bodies                   ? AS_BEFORE
                               : w->state.dt_before > 0 ? BY_POSE
                               : with_tank              ? BY_RATES
                                                        : AT_REST};
    memcpy(f.before_shift, w->state.before.state.value, sizeof f.before_shift);
    memcpy(f.before_rotation, w->state.before.rotation, sizeof f.before_rotation);
    mps_stage_rows(s, at_rest(q) && !w->work.bodies ? &rest_rows : &move_tank_rows, &f);
    return MPS_OK;
}

static const mps_use tank_uses[] = {{"velocity", MPS_USE_CHANGE},
                                    {"tank_acceleration", MPS_USE_WRITE | MPS__USE_BEGIN},
                                    {"solid_place", MPS_USE_READ}};

const mps__pass mps__pass_tank = {.name = "tank",
                                  .hook = MPS_MOTION,
                                  .place = MPS__AFTER_MODELS,
                                  .stage = MPS_STAGE_OPERATORS,
                                  .with_ghosts = true,
                                  .device = true,
                                  .use_count = 3,
                                  .uses = tank_uses,
                                  .run = move_tank};

/* ---- jumps ---- */

typedef struct jump_fields {
    const double *acceleration;
} jump_fields;

/* Square of the largest acceleration of the solids. */
MPS_ROW void raise_acceleration(const int dim, const mps_view *v, const jump_fields *f, int64_t i,
                                double *most)
{
    const double *a = f->acceleration + i * dim, square = mps__dot(a, a, dim);
    if (!mps_is_fluid(v, i)) *most = square > *most ? square : *most;
}
MPS_SUMS(raise_accelerations, raise_acceleration, jump_fields)

/* The velocity jumps if it changes within a step by more than twice as much as in the last one, and
 * by more than 2 g. Velocities are means over a step, so the change takes half of both steps: over
 * dt alone, a steady acceleration would count as a jump in a shortened step. */
static void take_jump(void *step, const double *most)
{
    mps__step *q = step;
    const mps__world *w = q->w;
    const double dt = q->view.dt,
                 change = w->state.dt_before > 0 ? 2 * dt / (dt + w->state.dt_before) : 1;
    q->next.jump = (mps__jump){change * sqrt(fmax(most[0], 0)), w->state.jump.since < INT32_MAX
                                                                    ? w->state.jump.since + 1
                                                                    : INT32_MAX};
    if (q->next.jump.accel > 2 * w->setup.velocity_scale * w->setup.velocity_scale / w->setup.dp &&
        q->next.jump.accel > 2 * w->state.jump.accel)
        q->next.jump.since = 0;
    q->stage.since_jump = q->next.jump.since;
}

void mps__step_note_jump(mps_stage *s, const double *acceleration)
{
    mps__step *q = mps__step_of(s);
    mps__runner_max_deferred(&q->w->runner, s->view, 1, &raise_accelerations,
                             &(jump_fields){acceleration}, (mps__then){take_jump, q});
}

static mps_status note_jump(mps_stage *s)
{
    mps__step_note_jump(s, s->data[0]);
    return MPS_OK;
}

static const mps_use jump_uses[] = {{"tank_acceleration", MPS_USE_READ}};

const mps__pass mps__pass_jump = {.name = "jump",
                                  .hook = MPS_MOTION,
                                  .place = MPS__AFTER_MODELS,
                                  .stage = MPS_STAGE_OPERATORS,
                                  .device = true,
                                  .use_count = 1,
                                  .uses = jump_uses,
                                  .run = note_jump};

/* ---- solids that move in the tank ---- */

/* Positions and areas of solids at the end of the step have arrays of their own only if a model
 * writes them. */
mps_status mps__step_place_solids(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__work *k = &w->work;
    const int64_t count = s->n * s->dim;
    mps__channel *list = w->channels.list;
    k->bodies = mps__plan_has_writer(&w->runner.plan, MPS__SOLID_PLACE) ||
                mps__plan_has_writer(&w->runner.plan, MPS__SOLID_AREA);
    list[MPS__SOLID_PLACE].array.host = list[MPS__SOLID_AREA].array.host = NULL; /* the fields */
    if (!k->bodies) return MPS_OK;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_REF));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_AREA));
    MPS__TRY(mps__grow(w->context, (void **)&k->placed, &k->placed_capacity, 0, 2 * count,
                       sizeof *k->placed));
    list[MPS__SOLID_PLACE].array.host = k->placed;
    list[MPS__SOLID_AREA].array.host = k->placed + count;
    memcpy(k->placed, s->ref, (size_t)count * sizeof *s->ref);
    memcpy(k->placed + count, s->area, (size_t)count * sizeof *s->area);
    return MPS_OK;
}

/* After the step: copy positions and areas of moved solids to the particles. */
void mps__step_keep_places(mps__world *w, const double *place, const double *area)
{
    const mps__particles *s = &w->particles;
    const size_t bytes = (size_t)(s->n * s->dim) * sizeof *place;
    if (!w->work.bodies) return;
    mps__parallel_copy(&w->pool.parallel, mps__given(w, MPS__FIELD_REF), place, bytes);
    mps__parallel_copy(&w->pool.parallel, mps__given(w, MPS__FIELD_AREA), area, bytes);
}

/* ---- areas ---- */

typedef struct turn_fields {
    const double *area;
    double *turned;
} turn_fields;

MPS_ROW void turn_row(const int dim, const mps_view *v, const turn_fields *f, int64_t i)
{
    const double *R = v->tank.rotation, *a = f->area + i * dim, z = dim == 3 ? a[2] : 0;
    for (int d = 0; d < dim; d++)
        f->turned[i * dim + d] = R[3 * d] * a[0] + R[3 * d + 1] * a[1] + R[3 * d + 2] * z;
}
MPS_ROWS(turn_rows, turn_row, turn_fields)

/* Area vectors in the lab have an array of their own if the tank is rotated. */
mps_status mps__step_rotate_areas(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__work *k = &w->work;
    k->area = s->area;
    if (!mps__motion_rotated(&w->motion.now)) return MPS_OK;
    MPS__TRY(mps__grow(w->context, (void **)&k->turned, &k->turned_capacity, 0, s->n * w->setup.dim,
                       sizeof *k->turned));
    k->area = k->turned;
    return MPS_OK;
}

void mps__step_find_areas(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps_view v;
    if (w->work.area == s->area) return;
    mps__world_view(w, &v);
    v.area = s->area; /* the rotated ones are computed here */
    w->runner.with_ghosts = true;
    mps__memory_set_space(&w->runner.memory, MPS__ON_DEVICE);
    const turn_fields f = {mps__seen(w, MPS__FIELD_AREA),
                           mps__given_list(w, MPS__ROTATED_AREAS, w->work.turned)};
    mps__runner_rows(&w->runner, &v, &turn_rows, &f);
    mps__memory_set_space(&w->runner.memory, MPS__ON_HOST);
    w->runner.with_ghosts = false;
}
