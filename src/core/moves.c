/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 6: checks of what a step has done: finite, not too fast, and not farther than the walls can hold; how far the walls go. */
#include "world.h"
#include <string.h>

/* Layers of dummies behind walls that a user gave particle by particle. */
static const int32_t layers_unknown = 2;

static double limit_of(const mps__world *w)
{
    return (1 + (w->layers > 0 ? w->layers : layers_unknown)) * w->dp;
}

/* How far a fluid particle went with respect to the tank. */
static double moved(const mps__world *w, const mps__pose *next, int64_t i)
{
    double from[3], to[3], square = 0;
    mps__motion_to_tank(&w->motion, &w->motion.now, w->work.x0 + i * w->dim, from);
    mps__motion_to_tank(&w->motion, next, w->particles.x + i * w->dim, to);
    for (int d = 0; d < w->dim; d++) square += (to[d] - from[d]) * (to[d] - from[d]);
    return sqrt(square);
}

static mps_status jumped(const mps__world *w, const mps__pose *next, double dt, int64_t i)
{
    const double *x = w->work.x0 + i * w->dim, distance = moved(w, next, i);
    return mps__fail(w->context, MPS_E_DIVERGED,
                     "t = %.9g s: fluid particle %lld at (%g, %g, %g) m would move %g m in a step of %g s, at %g m/s; allowed: at most "
                     "%g m, as deep as walls and their dummies are. Take a shorter step, or an adaptive one",
                     w->info.t, (long long)w->particles.id[i], x[0], x[1], w->dim == 3 ? x[2] : 0, distance, dt, distance / dt,
                     limit_of(w));
}

/* Steps that follow the speed never get there, unless a stranger's model pushes. */
static bool may_jump(const mps__world *w)
{
    const mps_time_control *c = &w->control;
    bool foreign = false;
    for (int32_t m = 0; m < w->models.active; m++) foreign = foreign || mps__models_foreign(&w->models, &w->models.on[m]);
    return c->dt > 0 || c->cfl <= 0 || c->cfl > 1 || foreign;
}

/* What moves farther in a step than the layers of the solids are deep may come out behind them, and nobody would see that it went through. */
mps_status mps__world_check_moves(mps__world *w, const mps__pose *next, double dt)
{
    const mps__particles *s = &w->particles;
    const double limit = limit_of(w);
    double most = 0;
    int64_t first = s->n, solids = 0;
    if (!may_jump(w)) return MPS_OK;
#pragma omp parallel for num_threads(w->threads) reduction(max : most) reduction(min : first) reduction(+ : solids) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        const double distance = s->kind[i] == MPS_FLUID ? moved(w, next, i) : 0;
        solids += s->kind[i] != MPS_FLUID;
        most = distance > most ? distance : most;
        if (distance > limit) first = i < first ? i : first;
    }
    if (solids > 0 && first < s->n) return jumped(w, next, dt, first);
    if (w->control.dt > 0 && most > w->dp && !w->moves_told) {
        w->moves_told = true;
        mps__log(
            w->context, MPS_LOG_WARNING,
            "t = %.9g s: in a fixed step of %g s fluid moves up to %g m, more than a spacing of %g m: the step is too long for its speed",
            w->info.t, dt, most, w->dp);
    }
    return MPS_OK;
}

double mps__world_way_of_walls(const mps__world *w, const mps__pose *pose, double dt)
{
    const mps__particles *s = &w->particles;
    double most = 0;
#pragma omp parallel for num_threads(w->threads) reduction(max : most) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        double X[3], here[3], next[3], square = 0;
        const bool fluid = s->kind[i] == MPS_FLUID;
        if (fluid)
            mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->dim, X);
        else
            memcpy(X, s->ref + i * w->dim, (size_t)w->dim * sizeof *X);
        mps__motion_point(&w->motion, &w->motion.now, X, here, NULL, NULL);
        mps__motion_point(&w->motion, pose, X, next, NULL, NULL);
        for (int d = 0; d < w->dim; d++) {
            const double way = next[d] - here[d] - (fluid ? dt * s->u[i * w->dim + d] : 0);
            square += way * way;
        }
        most = square > most ? square : most;
    }
    return sqrt(most);
}

/* NaN and speeds beyond every physical range stop the run, with the particle and its place. */
mps_status mps__world_check_result(const mps__world *w, const mps_stage *s, bool arrived, mps_step_info *info)
{
    const double *v = w->particles.u, *p = w->particles.p;
    double most = 0, liquid = 0, dense = 0;
    int64_t worst = s->n;
    for (int k = 0; k < MPS__PHASES; k++)
        if (w->phase_defined[k]) dense = fmax(dense, 0.5 * w->phase_density[k]);
#pragma omp parallel for num_threads(w->threads) reduction(max : most, liquid) reduction(min : worst) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        const double *u = v + i * s->dim, *x = s->x + i * s->dim;
        const double speed = sqrt(mps__dot(u, u, s->dim));
        if (!(isfinite(speed) && speed <= w->speed_limit && mps__finite(x, s->dim) && isfinite(p[i])))
            worst = i < worst ? i : worst;
        else if (s->kind[i] == MPS_FLUID) {
            most = speed > most ? speed : most;
            if (w->particles.rho[i] >= dense) liquid = speed > liquid ? speed : liquid;
        }
    }
    info->crossing_time = mps__crossing_time(w, liquid, s->dt);
    info->max_speed = most;
    info->cfl = most * s->dt / s->dp;
    if (worst == s->n) return MPS_OK;
    const double *u = v + worst * s->dim, *x = (arrived ? w->work.x0 : s->x) + worst * s->dim;
    return mps__fail(
        w->context, MPS_E_DIVERGED,
        "t = %.9g s: particle %lld at (%g, %g, %g) m got velocity (%g, %g, %g) m/s and pressure %g Pa; allowed: finite, at most %g m/s",
        s->t, (long long)s->id[worst], x[0], x[1], s->dim == 3 ? x[2] : 0, u[0], u[1], s->dim == 3 ? u[2] : 0, p[worst], w->speed_limit);
}
