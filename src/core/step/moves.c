/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of what a step has done: finite, not too fast, and not farther than the walls can hold; how far the walls go. */
#include "world_ranks.h"
#include <string.h>

/* Layers of dummies behind walls that a user gave particle by particle. */
static const int32_t layers_unknown = 2;

static double limit_of(const mps__world *w)
{
    return (1 + (w->setup.layers > 0 ? w->setup.layers : layers_unknown)) * w->setup.dp;
}

/* How far a fluid particle went with respect to the tank. */
static double moved(const mps__world *w, const mps__pose *next, int64_t i)
{
    double from[3], to[3], square = 0;
    mps__motion_to_tank(&w->motion, &w->motion.now, w->work.x0 + i * w->setup.dim, from);
    mps__motion_to_tank(&w->motion, next, w->particles.x + i * w->setup.dim, to);
    for (int d = 0; d < w->setup.dim; d++) square += (to[d] - from[d]) * (to[d] - from[d]);
    return sqrt(square);
}

/* Place of the particle with this id; -1: it is on another rank, which has the text of the failure. */
static int64_t place_of(mps__world *w, int64_t id)
{
    const mps__particles *s = &w->particles;
    int64_t i = 0;
    w->context->error[0] = 0;
    while (i < s->n && (s->id[i] != id || mps__is_ghost(&w->ghosts, i))) i++;
    return i < s->n ? i : -1;
}

static mps_status jumped(mps__world *w, const mps__pose *next, double dt, int64_t id)
{
    const int64_t i = place_of(w, id);
    if (i < 0) return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
    const double *x = w->work.x0 + i * w->setup.dim, distance = moved(w, next, i);
    mps__fail(
        w->context, MPS_E_DIVERGED,
        "t = %.9g s: fluid particle %lld at (%g, %g, %g) m would move %g m in a step of %g s, at "
        "%g m/s; allowed: at most "
        "%g m, as deep as walls and their dummies are. Take a shorter step, or an adaptive one",
        w->state.t, (long long)w->particles.id[i], x[0], x[1], w->setup.dim == 3 ? x[2] : 0,
        distance, dt, distance / dt, limit_of(w));
    return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
}

/* Steps that follow the speed never get there, unless a model of a plug-in pushes. */
static bool may_jump(const mps__world *w)
{
    const mps_time_control *c = &w->setup.control;
    bool foreign = false;
    for (int32_t m = 0; m < w->models.active; m++)
        foreign = foreign || mps__models_foreign(&w->models, &w->models.on[m]);
    return c->dt > 0 || c->cfl <= 0 || c->cfl > 1 || foreign;
}

/* Ways of the fluid in a step. */
typedef struct ways {
    const mps__world *w;
    const mps__pose *next;
    double dt, limit;
} ways;

/* 1: there are solids; the farthest way, and the negative of the least id beyond the limit. */
static void way_rows(void *argument, int64_t begin, int64_t end, double *v)
{
    const ways *k = argument;
    const mps__particles *s = &k->w->particles;
    for (int64_t i = begin; i < end; i++) {
        if (mps__is_ghost(&k->w->ghosts, i)) continue;
        const double distance = s->kind[i] == MPS_FLUID ? moved(k->w, k->next, i) : 0;
        if (s->kind[i] != MPS_FLUID) v[0] = 1;
        v[1] = distance > v[1] ? distance : v[1];
        if (distance > k->limit) v[2] = fmax(v[2], -(double)s->id[i]);
    }
}

/* Fluid that moves farther in a step than the layers of the solids are deep may come out behind them unseen. */
mps_status mps__world_check_moves(mps__world *w, const mps__pose *next, double dt)
{
    ways k = {w, next, dt, limit_of(w)};
    double v[3] = {0, 0, -INFINITY};
    if (!may_jump(w)) return MPS_OK;
    mps_parallel_max(&w->pool.parallel, w->particles.n, 3, way_rows, &k, v);
    mps__ranks_max(&w->ranks, 3, v);
    if (v[0] > 0 && !isinf(v[2])) return jumped(w, next, dt, (int64_t)-v[2]);
    if (w->setup.control.dt > 0 && v[1] > w->setup.dp && !w->state.moves_told) {
        w->state.moves_told = true;
        mps__log(w->context, MPS_LOG_WARNING,
                 "t = %.9g s: in a fixed step of %g s fluid moves up to %g m, more than a spacing "
                 "of %g m: the step is too long for its speed",
                 w->state.t, dt, v[1], w->setup.dp);
    }
    return MPS_OK;
}

/* Square of the longest way of a wall, or of the fluid as the walls see it. */
static void wall_way_rows(void *argument, int64_t begin, int64_t end, double *most)
{
    const ways *k = argument;
    const mps__world *w = k->w;
    const mps__particles *s = &w->particles;
    for (int64_t i = begin; i < end; i++) {
        double X[3], here[3], next[3], square = 0;
        const bool fluid = s->kind[i] == MPS_FLUID;
        if (mps__is_ghost(&w->ghosts, i)) continue;
        if (fluid)
            mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->setup.dim, X);
        else
            memcpy(X, s->ref + i * w->setup.dim, (size_t)w->setup.dim * sizeof *X);
        mps__motion_point(&w->motion, &w->motion.now, X, here, NULL, NULL);
        mps__motion_point(&w->motion, k->next, X, next, NULL, NULL);
        for (int d = 0; d < w->setup.dim; d++) {
            const double way = next[d] - here[d] - (fluid ? k->dt * s->u[i * w->setup.dim + d] : 0);
            square += way * way;
        }
        *most = square > *most ? square : *most;
    }
}

double mps__world_way_of_walls(mps__world *w, const mps__pose *pose, double dt)
{
    ways k = {w, pose, dt, 0};
    double most = 0;
    mps_parallel_max(&w->pool.parallel, w->particles.n, 1, wall_way_rows, &k, &most);
    mps__ranks_max(&w->ranks, 1, &most);
    return sqrt(most);
}

/* What a step has done. */
typedef struct result {
    const mps__world *w;
    double dense; /* liquid is denser [kg/m3] */
} result;

/* The largest speed of the fluid, that of the liquid, and the negative of the least id of what is not finite or too fast. */
static void result_rows(void *argument, int64_t begin, int64_t end, double *v)
{
    const result *k = argument;
    const mps__world *w = k->w;
    const mps__particles *s = &w->particles;
    for (int64_t i = begin; i < end; i++) {
        if (mps__is_ghost(&w->ghosts, i)) continue;
        const double *u = s->u + i * w->setup.dim;
        const double speed = sqrt(mps__dot(u, u, w->setup.dim));
        if (!(isfinite(speed) && speed <= w->setup.speed_limit &&
              mps__finite(s->x + i * w->setup.dim, w->setup.dim) && isfinite(s->p[i]))) {
            v[2] = fmax(v[2], -(double)s->id[i]);
        } else if (s->kind[i] == MPS_FLUID) {
            v[0] = speed > v[0] ? speed : v[0];
            if (s->rho[i] >= k->dense) v[1] = speed > v[1] ? speed : v[1];
        }
    }
}

/* NaN and speeds beyond every physical range stop the run, with the particle and its place. */
mps_status mps__world_check_result(mps__world *w, const mps_stage *s, bool arrived,
                                   mps_step_info *info)
{
    result k = {w, 0};
    double v[3] = {0, 0, -INFINITY};
    for (int p = 0; p < MPS__PHASES; p++)
        if (w->setup.phase_defined[p]) k.dense = fmax(k.dense, 0.5 * w->setup.phase_density[p]);
    mps_parallel_max(&w->pool.parallel, s->n, 3, result_rows, &k, v);
    mps__ranks_max(&w->ranks, 3, v);
    info->crossing_time = mps__crossing_time(w, v[1], s->dt);
    info->max_speed = v[0];
    info->cfl = v[0] * s->dt / s->dp;
    if (isinf(v[2])) return MPS_OK;
    const int64_t worst = place_of(w, (int64_t)-v[2]);
    if (worst < 0) return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
    const double *u = w->particles.u + worst * s->dim,
                 *x = (arrived ? w->work.x0 : w->particles.x) + worst * s->dim;
    mps__fail(w->context, MPS_E_DIVERGED,
              "t = %.9g s: particle %lld at (%g, %g, %g) m got velocity (%g, %g, %g) m/s and "
              "pressure %g Pa; allowed: finite, at most %g m/s",
              s->t, (long long)s->id[worst], x[0], x[1], s->dim == 3 ? x[2] : 0, u[0], u[1],
              s->dim == 3 ? u[2] : 0, w->particles.p[worst], w->setup.speed_limit);
    return mps__ranks_text(&w->ranks, MPS_E_DIVERGED);
}
