/* SPDX-License-Identifier: BSD-3-Clause */
/* The time that the resolution contains: dp/u, u the speed of the fastest piece of liquid.
 *
 *   u = max_i u_i,   u_i = N-th largest speed of the liquid within re of particle i, itself included, at most its own,
 *
 * N the number of particles that a film of two rows has within re of one of its own. So a film of two rows counts as soon as it reaches re to both
 * sides, and spray does not: drops of fewer than N particles, and fast particles beside slow ones. No region decides, as regions change from step
 * to step. Slower than 5 U_g the time does not depend on u, so that pieces are looked for among faster particles alone. */
#include "step.h"
#include "world_ranks.h"
#include <string.h>

/* Of the speed before. */
static const double NEARLY = 0.9;

typedef struct liquid {
    const double *u, *rho;
    double dense;  /* liquid is at least so dense [kg/m3] */
    double least;  /* of squares of speeds that matter */
    int32_t piece; /* N */
    mps__carry carry;
} liquid;

/* Particles of a film of two rows within the radius of one of them, with itself. */
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

/* Square of the speed of a particle of the liquid relative to the tank; -1: of another. */
MPS_ROW double speed2(const int dim, const mps_view *v, const liquid *f, int64_t i)
{
    return mps_is_fluid(v, i) && f->rho[i] >= f->dense
               ? mps__relative2(dim, &f->carry, v->x + i * dim, f->u + i * dim)
               : -1;
}

/* Particle i, then its neighbours: entry `p` from one before their begin on. One call of what is
 * asked of each keeps the kernels of devices small. */
MPS_ROW int64_t near_or_self(const mps_stencil *t, int64_t i, int64_t p)
{
    return p < mps_stencil_begin(t, i) ? i : mps_stencil_column(t, p);
}

/* How many of particle i and its neighbours have at least this square of a speed. */
MPS_ROW int32_t as_fast(const int dim, const mps_view *v, const liquid *f, int64_t i, double square)
{
    const mps_stencil *t = &v->near;
    int32_t count = 0;
    for (int64_t p = mps_stencil_begin(t, i) - 1; p < mps_stencil_end(t, i); p++)
        count += speed2(dim, v, f, near_or_self(t, i, p)) >= square;
    return count;
}

/* The next larger number, of a number >= 0. */
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

/* From the speeds of the fastest particle and of the fastest piece, 0 if that is no faster than 5 U_g. In calm liquid there are no impacts to be
 * averaged, and a mean lags. The time changes slowly: a mean over a time that shrinks does not count all of an impulse. */
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

/* Speeds of the fastest particle and of the fastest piece above `least`. */
static void ask_speeds(mps_stage *s, double least)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    liquid f = {.u = mps__seen(w, w->particles.u),
                .rho = mps__seen(w, w->particles.rho),
                .least = least * least,
                .piece = film_of_two_rows(&s->view->near),
                .carry = mps__motion_carry(&w->motion, &q->pose)};
    for (int p = 0; p < MPS__PHASES; p++)
        if (w->setup.phase_defined[p]) f.dense = fmax(f.dense, 0.5 * w->setup.phase_density[p]);
    mps__host_max_later(&w->host, s->view, SPEEDS, &raise_speeds, &f, (mps__then){take_speeds, q});
}

/* Where there is no piece nearly as fast as the one before, it is looked for among all above 5 U_g. */
void mps__step_crossing_end(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    if (q->nearly && q->speeds[PIECE] < 0) {
        ask_speeds(s, 5 * q->w->setup.velocity_scale);
        mps__host_settle(&q->w->host);
    }
    q->info.crossing_time = crossing_time(q->w, sqrt(fmax(0, q->speeds[ANY])),
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

/* Ghosts have the new velocities already. */
const mps__pass mps__pass_crossing = {.name = "crossing",
                                      .hook = MPS_SHIFT,
                                      .place = MPS__AFTER_MODELS,
                                      .stage = MPS_STAGE_CORRECT,
                                      .flat = true,
                                      .use_count = 2,
                                      .uses = uses,
                                      .run = find_crossing_time};
