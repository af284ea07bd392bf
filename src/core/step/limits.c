/* SPDX-License-Identifier: BSD-3-Clause */
/* How long a step may be. */
#include "world.h"

/* So many steps at most share what is left of a run. */
static const double SHARED_STEPS = 20;

static double least(double a, double b)
{
    return b > 0 && b < a ? b : a;
}

/* dt of the limits of the state, and of the growth since the last step that they chose; never 0. */
static mps_status choose_dt(mps__world *w, mps_stage *s, double *chosen)
{
    const mps_time_control *c = &w->setup.control;
    double dt = INFINITY, nu = 0;
    const double speed = mps__world_speed(w);
    for (int k = 0; k < MPS__PHASES; k++)
        if (w->setup.phase_defined[k])
            nu = fmax(nu, w->setup.phase_viscosity[k] / w->setup.phase_density[k]);
    if (speed > 0) dt = least(dt, c->cfl * w->setup.dp / speed);
    dt = least(dt, c->gravity * w->setup.dp / w->setup.velocity_scale);
    if (nu > 0) dt = least(dt, c->viscous * w->setup.dp * w->setup.dp / nu);
    s->dt_limit = INFINITY;
    MPS__TRY(mps__host_run(&w->host, s, MPS_LIMIT));
    s->dt_limit = -s->dt_limit;
    mps__ranks_max(&w->ranks, 1, &s->dt_limit);
    s->dt_limit = -s->dt_limit;
    dt = least(dt, s->dt_limit);
    if (w->state.dt_previous > 0) dt = least(dt, c->growth * w->state.dt_previous);
    *chosen = dt;
    return MPS_OK;
}

/* Shorten a step of at most `longest` until walls move no farther in it, or in half of it, than the cfl number allows. Where they speed up
 * the way is that of a power of the time: square roots do not fall below what is needed. */
static mps_status follow_walls(mps__world *w, double longest, double *dt)
{
    const int trials = 40;
    const double allowed = w->setup.control.cfl * w->setup.dp;
    double trial = fmin(*dt, longest);
    if (allowed <= 0 || !w->motion.fn) return MPS_OK;
    for (int k = 0; k < trials; k++) {
        double way = 0;
        for (int part = 1; part <= 2; part++) {
            mps__pose pose;
            MPS__TRY(mps__motion_pose(&w->motion, w->state.t + trial / part, &pose));
            way = fmax(way, part * mps__world_way_of_walls(w, &pose, trial / part));
        }
        if (way <= allowed * (1 + 1e-9)) return MPS_OK;
        trial *= k < trials / 2 && way > 1.02 * allowed ? sqrt(allowed / way) : allowed / way;
        *dt = trial;
    }
    return MPS_OK;
}

mps_status mps__world_limit_step(mps__world *w, mps_stage *s, double dt_max, double *planned)
{
    const mps_time_control *c = &w->setup.control;
    const double longest = c->dt > 0 ? dt_max : least(dt_max, c->dt_max);
    s->dt = w->state.dt_previous;
    double dt = c->dt;
    if (c->dt <= 0) {
        MPS__TRY(choose_dt(w, s, &dt));
        MPS__TRY(follow_walls(w, longest, &dt));
        if (!(dt >= c->dt_min))
            return mps__fail(w->context, MPS_E_DIVERGED,
                             "the time step fell to %g s at t = %.9g s, below dt_min = %g s; the "
                             "largest speed is %g m/s%s",
                             dt, w->state.t, c->dt_min, mps__world_speed(w),
                             w->motion.fn ? ", or that of the walls in this step is too large"
                                          : "");
    }
    const double step = fmin(dt, longest);
    *planned = dt <= longest ? dt : 0;
    const double steps = ceil(dt_max / step * (1 - 1e-6));
    s->dt = w->ending && steps <= SHARED_STEPS ? dt_max / steps : step;
    if (!(w->state.t + s->dt > w->state.t))
        return mps__fail(w->context, MPS_E_DIVERGED,
                         "the time step is %g s, too short to change the time, %g s", s->dt,
                         w->state.t);
    return MPS_OK;
}
