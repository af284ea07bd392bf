/* SPDX-License-Identifier: BSD-3-Clause */
/* Crossing time dp/u, the shortest time that the resolution can represent; u is the speed of the
 * fastest piece of liquid:
 *   u = max_i u_i,   u_i = N-th largest speed of the liquid within re of particle i,
 * itself included, and at most its own speed; N is the number of particles that a film of two
 * layers has within re of one of its own. So a film of two layers counts once it extends by re to
 * both sides; spray does not: droplets of fewer than N particles, and fast particles among slow
 * ones. Regions are not used, as they change from step to step. Below 5 U_g the time does not
 * depend on u, so only faster particles are searched. */
#include "step.h"
#include "world_ranks.h"
#include <string.h>

/* Fraction of the previous speed. */
static const double NEARLY = 0.9;

typedef struct liquid {
    const double *u, *rho;
    double dense;  /* least density of liquid [kg/m3] */
    double least;  /* least square of a speed that matters */
    int32_t piece; /* N */
    mps__carry carry;
} liquid;

/* Particles of a film of two layers within the radius of one of them, with itself. */
static int32_t film_of_two_rows(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, across = t->dim == 3 ? reach : 0;
    int32_t count = 0;
    for (int row = 0; row < 2; row++)
        for (int k = -across; k <= across; k++)
            for (int i = -reach; i <= reach; i++)
                count += t->dp * sqrt((double)(i * i + row * row + k * k)) < t->re;
    return count;
}

/* Square of the speed of a liquid particle relative to the tank; -1: not liquid. */
MPS_ROW double speed2(const int dim, const mps_view *v, const liquid *f, int64_t i)
{
    return mps_is_fluid(v, i) && f->rho[i] >= f->dense
               ? mps__relative2(dim, &f->carry, v->x + i * dim, f->u + i * dim)
               : -1;
}

/* Particle i, then its neighbours, for `p` from one before their begin on. A single call site of
 * the inlined functions keeps device kernels small. */
MPS_ROW int64_t near_or_self(const mps_stencil *t, int64_t i, int64_t p)
{
    return p < mps_stencil_begin(t, i) ? i : mps_stencil_column(t, p);
}

/* Number of particles among i and its neighbours with at least this square of a speed. */
MPS_ROW int32_t as_fast(const int dim, const mps_view *v, const liquid *f, int64_t i, double square)
{
    const mps_stencil *t = &v->near;
    int32_t count = 0;
    for (int64_t p = mps_stencil_begin(t, i) - 1; p < mps_stencil_end(t, i); p++)
        count += speed2(dim, v, f, near_or_self(t, i, p)) >= square;
    return count;
}

/* The next larger double, for a value >= 0. */
MPS_ROW double above(double least)
{
    uint64_t bits;
    if (!(least < INFINITY)) return least;
    memcpy(&bits, &least, sizeof bits);
    bits++;
    memcpy(&least, &bits, sizeof bits);
    return least;
}

/* Squares of the largest speeds: of a piece, if it is above `least`; of a particle. */
enum { PIECE, ANY, SPEEDS };

MPS_ROW void raise_speed(const int dim, const mps_view *v, const liquid *f, int64_t i, double *most)
{
    const mps_stencil *t = &v->near;
    const int64_t first = mps_stencil_begin(t, i) - 2; /* `more` itself, then the particles */
    const double own = speed2(dim, v, f, i), more = above(mps_larger(most[PIECE], f->least));
    if (own > most[ANY]) most[ANY] = own;
    for (int64_t p = first; own >= more && p < mps_stencil_end(t, i); p++) {
        const double square = p == first ? more : speed2(dim, v, f, near_or_self(t, i, p));
        if (square < more || square > own || square <= most[PIECE]) continue;
        const bool piece = as_fast(dim, v, f, i, square) >= f->piece;
        if (p == first && !piece) return;
        if (p > first && piece) most[PIECE] = square;
    }
}
MPS_SUMS(raise_speeds, raise_speed, liquid)

/* From the speeds of the fastest particle and of the fastest piece; 0: that is no faster than 5
 * U_g. Calm liquid has no impacts to average, and a mean lags. The time changes slowly: a mean over
 * a shrinking time would miss part of an impulse. */
static double crossing_time(const mps__world *w, double fastest, double piece, double dt)
{
    const double scale = w->setup.velocity_scale, last = w->state.crossing_time;
    const double wanted = fmin(1, fastest / scale) *
                          fmin(w->setup.dp / fmax(piece, scale), mps__crossing_limit(w));
    return w->state.step > 0 ? fmin(fmax(wanted, last - 0.1 * dt), last + 0.1 * dt) : wanted;
}

static void take_speeds(void *step, const double *most)
{
    mps__step *q = step;
    memcpy(q->speeds, most, sizeof q->speeds);
}

/* Request the speeds of the fastest particle and of the fastest piece above `least`. */
static void ask_speeds(mps_stage *s, double least)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    liquid f = {.u = mps__seen(w, MPS__FIELD_VELOCITY),
                .rho = mps__seen(w, MPS__FIELD_DENSITY),
                .least = least * least,
                .piece = film_of_two_rows(&s->view->near),
                .carry = mps__motion_carry(&w->motion, &q->pose)};
    for (int p = 0; p < MPS__PHASES; p++)
        if (w->setup.phase_defined[p]) f.dense = fmax(f.dense, 0.5 * w->setup.phase_density[p]);
    mps__runner_max_deferred(&w->runner, s->view, SPEEDS, &raise_speeds, &f,
                             (mps__then){take_speeds, q});
}

/* If there is no piece nearly as fast as the previous one, search all particles above 5 U_g. */
void mps__step_crossing_end(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    if (q->nearly && q->speeds[PIECE] < 0) {
        ask_speeds(s, 5 * q->w->setup.velocity_scale);
        mps__runner_flush(&q->w->runner);
    }
    q->next.crossing_time = crossing_time(q->w, sqrt(fmax(0, q->speeds[ANY])),
                                          sqrt(fmax(0, q->speeds[PIECE])), s->view->dt);
}

static mps_status find_crossing_time(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    const mps__world *w = q->w;
    const double calm = 5 * w->setup.velocity_scale, last = w->state.crossing_time,
                 before = last > 0 ? NEARLY * w->setup.dp / last : 0;
    q->nearly = before > calm;
    ask_speeds(s, q->nearly ? before : calm);
    if (!mps__device_of(&w->pool.parallel)) mps__step_crossing_end(s);
    return mps__ranks_status(&q->w->ranks);
}

static const mps_use uses[] = {{"velocity", MPS_USE_NEIGHBOURS}, {"density", MPS_USE_NEIGHBOURS}};

/* The ghosts already have the new velocities. */
const mps__pass mps__pass_crossing = {.name = "crossing",
                                      .hook = MPS_SHIFT,
                                      .place = MPS__AFTER_MODELS,
                                      .stage = MPS_STAGE_CORRECT,
                                      .device = true,
                                      .use_count = 2,
                                      .uses = uses,
                                      .run = find_crossing_time};
