/* SPDX-License-Identifier: BSD-3-Clause */
/* Time-step limits, and which one decides. */
#include "step.h"

/* Equalise the last steps of a run if at most this many remain. */
static const double SHARED_STEPS = 20;

/* The limit that decides so far. */
typedef struct limit {
    double dt;
    const char *name;         /* mps_step_info.limit */
    const char *what, *units; /* the underlying value, for messages */
    double value;
} limit;

static void lower(limit *l, limit other)
{
    if (other.dt > 0 && other.dt < l->dt) *l = other;
}

/* Models lower s->dt_limit; the minimum over all ranks applies, with the name of the model that
 * requested it. */
static mps_status limit_by_models(mps__world *w, mps_stage *s, mps_view *v, limit *l)
{
    s->dt_limit = INFINITY;
    MPS__TRY(mps__runner_run(&w->runner, s, v, MPS_LIMIT));
    double own = s->dt_limit, least = -own, call = -1;
    mps__ranks_max(&w->ranks, 1, &least);
    s->dt_limit = -least;
    if (!(s->dt_limit < l->dt)) return MPS_OK;
    if (own == s->dt_limit) call = w->runner.limiter;
    mps__ranks_max(&w->ranks, 1, &call);
    const char *name = call < 0 ? "model" : w->runner.plan.call[(int)call].name;
    lower(l, (limit){s->dt_limit, name, "the model allows", "s", s->dt_limit});
    return MPS_OK;
}

/* Limits of the state, and of the growth since the last step chosen by limits. */
static mps_status limit_by_state(mps__world *w, mps_stage *s, mps_view *v, limit *l)
{
    const mps_time_control *c = &w->setup.control;
    const double dp = w->setup.dp, speed = mps__world_speed(w), scale = w->setup.velocity_scale;
    double nu = 0;
    v->fastest = speed;
    for (int k = 0; k < MPS__PHASES; k++)
        if (w->setup.phase_defined[k])
            nu = fmax(nu, w->setup.phase_viscosity[k] / w->setup.phase_density[k]);
    if (speed > 0)
        lower(l, (limit){c->cfl * dp / speed, "cfl", "the largest speed is", "m/s", speed});
    lower(l, (limit){c->gravity * dp / scale, "gravity", "the velocity scale is", "m/s", scale});
    if (nu > 0)
        lower(l, (limit){c->viscous * dp * dp / nu, "viscous", "the largest kinematic viscosity is",
                         "m2/s", nu});
    MPS__TRY(limit_by_models(w, s, v, l));
    const double last = w->state.dt_previous;
    if (last > 0) lower(l, (limit){c->growth * last, "growth", "the last step was", "s", last});
    return MPS_OK;
}

/* Shorten a step of at most `longest` until the walls' displacement in it, and in half of it,
 * satisfies the cfl number. For accelerating walls the displacement is a power of the time: the
 * square root does not overshoot. */
static mps_status follow_walls(mps__world *w, double longest, limit *l)
{
    const int trials = 40;
    const double allowed = w->setup.control.cfl * w->setup.dp;
    double trial = fmin(l->dt, longest);
    if (allowed <= 0 || !w->motion.fn) return MPS_OK;
    for (int k = 0; k < trials; k++) {
        double of_whole, of_half;
        mps__pose whole, half;
        MPS__TRY(mps__motion_pose(&w->motion, w->state.t + trial, &whole));
        MPS__TRY(mps__motion_pose(&w->motion, w->state.t + trial / 2, &half));
        mps__world_way_of_walls(w, &whole, trial, &of_whole);
        mps__world_way_of_walls(w, &half, trial / 2, &of_half);
        mps__runner_flush(&w->runner);
        const double way = fmax(of_whole, 2 * of_half);
        if (way <= allowed * (1 + 1e-9)) return MPS_OK;
        const double speed = way / trial;
        trial *= k < trials / 2 && way > 1.02 * allowed ? sqrt(allowed / way) : allowed / way;
        *l = (limit){trial, "walls", "the largest speed of the walls and relative to them is",
                     "m/s", speed};
    }
    return MPS_OK;
}

/* The longest step that resolves the motion; infinite if unknown. */
static double resolving(const mps__world *w, double dt)
{
    const mps__motion *m = &w->motion;
    return m->longest ? m->longest(m->user, w->state.t, dt) : INFINITY;
}

/* A step of at most `longest` chosen by the limits. */
static mps_status choose(mps__world *w, mps_stage *s, mps_view *v, double longest, limit *l)
{
    const double least = w->setup.control.dt_min;
    MPS__TRY(limit_by_state(w, s, v, l));
    const double known = resolving(w, fmin(l->dt, longest));
    lower(l, (limit){known, "motion", "the motion of the tank changes within", "s", known});
    MPS__TRY(follow_walls(w, longest, l));
    if (l->dt >= least) return MPS_OK;
    return mps__fail(w->context, MPS_E_DIVERGED,
                     "the time step fell to %g s at t = %.9g s, below dt_min = %g s, by the limit "
                     "'%s': %s %g %s",
                     l->dt, w->state.t, least, l->name, l->what, l->value, l->units);
}

/* The user chose the step: only warn. */
static void check_fixed(mps__world *w, double dt)
{
    const double known = resolving(w, dt);
    if (w->motion.logged || !(known < dt)) return;
    w->motion.logged = true;
    mps__log(w->context, MPS_LOG_WARNING,
             "t = %.9g s: a fixed step of %g s misses parts of the tank's motion; it changes "
             "within %g s: take steps of at most that",
             w->state.t, dt, known);
}

mps_status mps__step_limit(mps__step *q, double dt_max)
{
    mps__world *w = q->w;
    mps_view *v = &q->view;
    const mps_time_control *c = &w->setup.control;
    const bool own = c->dt <= 0 && c->dt_max > 0 && c->dt_max < dt_max;
    const double longest = own ? c->dt_max : dt_max;
    limit l = {c->dt > 0 ? c->dt : INFINITY, "fixed", "", "", 0};
    v->dt = w->state.dt_previous;
    if (c->dt <= 0) MPS__TRY(choose(w, &q->stage, v, longest, &l));
    const double step = fmin(l.dt, longest);
    /* a step shortened by the caller does not limit the growth of the next */
    if (l.dt <= longest) q->next.dt_previous = l.dt;
    const double steps = ceil(dt_max / step * (1 - 1e-6));
    v->dt = w->ending && steps <= SHARED_STEPS ? dt_max / steps : step;
    if (c->dt > 0) check_fixed(w, v->dt);
    q->info.limit = v->dt == l.dt ? l.name : own && v->dt == longest ? "dt_max" : "caller";
    if (!(w->state.t + v->dt > w->state.t))
        return mps__fail(w->context, MPS_E_DIVERGED,
                         "the time step is %g s, too short to change the time, %g s", v->dt,
                         w->state.t);
    return MPS_OK;
}
