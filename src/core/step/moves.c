/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of a step: results are finite and not too fast, displacements are within what walls can
 * contain; displacements of the walls. */
#include "step.h"
#include "world_ranks.h"
#include <float.h>
#include <string.h>

/* Assumed layers of dummies behind walls that a user gave particle by particle. */
static const int32_t layers_unknown = 2;

static double limit_of(const mps__world *w)
{
    return (1 + (w->setup.layers > 0 ? w->setup.layers : layers_unknown)) * w->setup.dp;
}

/* Displacements in a step, in the frame of the tank, whose poses at both ends are in the view. */
typedef struct ways {
    const double *before, *x; /* [n*dim] positions at the begin and the end of the step */
    const double *ref, *u;
    double dt, limit;
    mps__carry carry;
} ways;

/* Displacement of a fluid particle relative to the tank. */
MPS_ROW double moved(const int dim, const mps_view *v, const ways *f, int64_t i)
{
    const mps_tank_pose *k = &v->tank;
    double from[3], to[3], square = 0;
    mps__tank_place(dim, k->centre, k->shift, k->rotation, f->before + i * dim, from);
    mps__tank_place(dim, k->centre, k->next_shift, k->next_rotation, f->x + i * dim, to);
    for (int d = 0; d < dim; d++) square += (to[d] - from[d]) * (to[d] - from[d]);
    return sqrt(square);
}

/* View of the present particles, with the present pose of the tank and another one. */
static void view_of(const mps__world *w, const mps__pose *next, mps_view *v)
{
    mps__world_view(w, v);
    mps__motion_view_next(next, &v->tank);
}

/* Index of the particle with this id; -1: it is on another rank, which has the error text. */
static int64_t place_of(mps__world *w, int64_t id)
{
    const mps__particles *s = &w->particles;
    int64_t i = mps__own_from(&w->ghosts, 0);
    w->context->error[0] = 0;
    while (i < s->n && s->id[i] != id) i = mps__own_from(&w->ghosts, i + 1);
    return i < s->n ? i : -1;
}

/* Positions before this step moved the particles, on the host. */
static const double *places_before(mps__world *w)
{
    mps__memory_sync(&w->runner.memory, MPS__POSITION_BEFORE, MPS__ON_HOST);
    return mps__channels_array(&w->channels, &w->particles, MPS__POSITION_BEFORE);
}

static mps_status jumped(mps__world *w, const mps_view *v, const ways *f, int64_t id)
{
    const int64_t i = place_of(w, id);
    if (i < 0) return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
    mps__memory_sync_fields(&w->runner.memory);
    const ways here = {.before = places_before(w), .x = w->particles.x};
    const double *x = here.before + i * v->dim, distance = moved(v->dim, v, &here, i);
    mps__fail(
        w->context, MPS_E_DIVERGED,
        "t = %.9g s: fluid particle %lld at (%g, %g, %g) m would move %g m in a step of %g s, at "
        "%g m/s; allowed: at most "
        "%g m, as deep as walls and their dummies are. Take a shorter step, or an adaptive one",
        w->state.t, (long long)w->particles.id[i], x[0], x[1], w->setup.dim == 3 ? x[2] : 0,
        distance, f->dt, distance / f->dt, f->limit);
    return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
}

/* Whether fluid may move too far: adaptive steps prevent it, unless a plug-in model accelerates
 * it. */
bool mps__world_may_jump(const mps__world *w)
{
    const mps_time_control *c = &w->setup.control;
    bool foreign = false;
    for (int32_t m = 0; m < w->models.active; m++)
        foreign = foreign || mps__models_foreign(&w->models, &w->models.on[m]);
    return c->dt > 0 || c->cfl <= 0 || c->cfl > 1 || foreign;
}

/* 1: there are solids; the largest displacement, and the negative of the least id beyond the
 * limit. */
MPS_ROW void raise_way(const int dim, const mps_view *v, const ways *f, int64_t i, double *most)
{
    const double distance = mps_is_fluid(v, i) ? moved(dim, v, f, i) : 0;
    if (!mps_is_fluid(v, i)) most[0] = 1;
    most[1] = distance > most[1] ? distance : most[1];
    if (distance > f->limit) most[2] = mps_larger(most[2], -(double)v->id[i]);
}
MPS_SUMS(raise_ways, raise_way, ways)

/* Fluid that moves farther in a step than the depth of the solids' layers could pass through them
 * undetected. */
mps_status mps__step_check_moves(mps__step *q, const double *before)
{
    mps__world *w = q->w;
    const ways f = {.before = before,
                    .x = mps__seen(w, MPS__FIELD_POSITION),
                    .dt = q->view.dt,
                    .limit = limit_of(w)};
    double most[3] = {0, 0, -INFINITY};
    mps_view v;
    if (!mps__world_may_jump(w)) return MPS_OK;
    view_of(w, &q->pose, &v);
    mps__runner_max(&w->runner, &v, 3, &raise_ways, &f, most);
    if (most[0] > 0 && !isinf(most[2])) return jumped(w, &v, &f, (int64_t)-most[2]);
    if (w->setup.control.dt > 0 && most[1] > w->setup.dp && !q->next.moves_told) {
        q->next.moves_told = true;
        mps__log(w->context, MPS_LOG_WARNING,
                 "t = %.9g s: in a fixed step of %g s fluid moves up to %g m, more than a spacing "
                 "of %g m: the step is too long for its speed",
                 w->state.t, f.dt, most[1], w->setup.dp);
    }
    return MPS_OK;
}

/* Square of the largest deviation from a uniform motion: of a wall from the present tank velocity,
 * of fluid relative to the walls. The present velocity itself brings no wall nearer to liquid that
 * moves with the tank. */
MPS_ROW void raise_wall_way(const int dim, const mps_view *v, const ways *f, int64_t i,
                            double *most)
{
    const mps_tank_pose *k = &v->tank;
    const bool fluid = mps_is_fluid(v, i);
    double X[3], here[3], next[3], u[3], square = 0; /* u: velocity of the tank at `here` */
    if (fluid)
        mps__tank_place(dim, k->centre, k->shift, k->rotation, v->x + i * dim, X);
    else
        for (int d = 0; d < dim; d++) X[d] = f->ref[i * dim + d];
    mps__tank_point(dim, k->centre, k->shift, k->rotation, X, here);
    mps__tank_point(dim, k->centre, k->next_shift, k->next_rotation, X, next);
    mps__carried(dim, &f->carry, here, u);
    for (int d = 0; d < dim; d++) {
        const double way = next[d] - here[d] - f->dt * (fluid ? f->u[i * dim + d] : u[d]);
        square += way * way;
    }
    *most = square > *most ? square : *most;
}
MPS_SUMS(raise_wall_ways, raise_wall_way, ways)

static void take_way(void *way, const double *most)
{
    *(double *)way = most[0] > 0 ? sqrt(most[0]) : 0;
}

void mps__world_way_of_walls(mps__world *w, const mps__pose *pose, double dt, double *way)
{
    mps__memory_set_space(&w->runner.memory, MPS__ON_DEVICE);
    const ways f = {.ref = mps__seen(w, MPS__FIELD_REF),
                    .u = mps__seen(w, MPS__FIELD_VELOCITY),
                    .dt = dt,
                    .carry = mps__motion_carry(&w->motion, &w->motion.now)};
    mps_view v;
    view_of(w, pose, &v);
    *way = 0; /* if a device fails */
    mps__runner_max_deferred(&w->runner, &v, 1, &raise_wall_ways, &f, (mps__then){take_way, way});
    mps__memory_set_space(&w->runner.memory, MPS__ON_HOST);
}

mps_status mps__world_check_pose(const mps__world *w, const mps__motion *m, const mps__pose *pose,
                                 mps_status refusal)
{
    const double most = MPS__FARTHEST * w->setup.dp, origin[3] = {0, 0, 0};
    double x[3] = {0};
    bool near = true;
    mps__motion_point(m, pose, origin, x, NULL, NULL);
    for (int d = 0; d < w->setup.dim; d++) near = near && fabs(x[d]) <= most;
    if (near) return MPS_OK;
    return mps__fail(w->context, refusal,
                     "the motion carries the tank to (%g, %g, %g) m at t = %.9g s: must be within "
                     "%g m, %g spacings, of the origin",
                     x[0], x[1], x[2], pose->t, most, MPS__FARTHEST);
}

/* Arguments of the check of a step's result. */
typedef struct result {
    const double *x, *u, *p;
    double fastest; /* speed limit */
    mps__carry carry;
} result;

/* The largest speed of the fluid, and the negative of the least id of a particle that is not finite
 * or too fast. */
MPS_ROW void raise_result(const int dim, const mps_view *v, const result *f, int64_t i,
                          double *most)
{
    const double speed = sqrt(mps__relative2(dim, &f->carry, f->x + i * dim, f->u + i * dim));
    bool sound = speed <= f->fastest && isfinite(f->p[i]);
    for (int d = 0; d < dim; d++) sound = sound && isfinite(f->x[i * dim + d]);
    if (!sound) {
        most[1] = mps_larger(most[1], -(double)v->id[i]);
    } else if (mps_is_fluid(v, i)) {
        most[0] = speed > most[0] ? speed : most[0];
    }
}
MPS_SUMS(raise_results, raise_result, result)

static void take_result(void *to, const double *most)
{
    *(mps__outcome *)to = (mps__outcome){most[0] > 0 ? most[0] : 0, most[1]};
}

void mps__step_ask_result(mps__step *q)
{
    mps__world *w = q->w;
    const result f = {.x = mps__seen(w, MPS__FIELD_POSITION),
                      .u = mps__seen(w, MPS__FIELD_VELOCITY),
                      .p = mps__seen(w, MPS__FIELD_PRESSURE),
                      .fastest = fmin(w->setup.speed_limit, DBL_MAX),
                      .carry = mps__motion_carry(&w->motion, &q->pose)};
    q->outcome = (mps__outcome){0, -INFINITY}; /* if a device fails */
    mps__runner_max_deferred(&w->runner, &q->view, 2, &raise_results, &f,
                             (mps__then){take_result, &q->outcome});
}

/* NaN and speeds beyond every physical range stop the run, with the particle and its position. */
mps_status mps__step_check_result(mps__step *q, bool has_moved)
{
    mps__world *w = q->w;
    const mps_view *s = &q->view;
    const mps__outcome *v = &q->outcome;
    const mps__particles *all = &w->particles;
    q->info.max_speed = v->fastest;
    q->info.cfl = v->fastest * s->dt / s->dp;
    if (isinf(v->failed)) return MPS_OK;
    const int64_t worst = place_of(w, (int64_t)-v->failed);
    if (worst < 0) return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
    mps__memory_sync_fields(&w->runner.memory);
    const double *u = all->u + worst * s->dim,
                 *x = (has_moved ? places_before(w) : all->x) + worst * s->dim;
    mps__fail(w->context, MPS_E_DIVERGED,
              "t = %.9g s: particle %lld at (%g, %g, %g) m got velocity (%g, %g, %g) m/s and "
              "pressure %g Pa; allowed: finite, at most %g m/s relative to the tank",
              s->t, (long long)all->id[worst], x[0], x[1], s->dim == 3 ? x[2] : 0, u[0], u[1],
              s->dim == 3 ? u[2] : 0, w->particles.p[worst], w->setup.speed_limit);
    return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
}
