/* SPDX-License-Identifier: BSD-3-Clause */
/* The load on the tank, as the momentum deficit of the liquid. The liquid ends where the pressure
 * equation ends it: at walls, whose half cells contain no particles, and at the centres of surface
 * particles, which count as half a cell. F = M g - dP/dt of the particles + m (g - a) of the half
 * cells. */
#include "half_cell.h"
#include "step.h"
#include <mps/couple.h>
#include <string.h>

int32_t mps__step_freedom(int32_t dim, int32_t freedom[6])
{
    static const int32_t plane[3] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    for (int32_t k = 0; k < 6; k++) freedom[k] = dim == 3 ? k : plane[k % 3];
    return dim == 3 ? 6 : 3;
}

/* ---- momentum of the particles ---- */

typedef struct flow {
    const double *rho, *u;
    const double *a; /* accelerations to be applied to velocities, or NULL */
    const int32_t *region;
    int32_t masses; /* 1: also masses and their arms */
    double cell, dt, at[3];
} flow;

/* Number of axes of moments. */
#define TURNS(dim) ((dim) == 3 ? 3 : 1)

/* Momentum [dim], its moment [TURNS], mass, mass times arm [dim]. */
MPS_ROW void add_moment(const int dim, const mps_view *v, const flow *f, int64_t i, double *term)
{
    double r[3] = {0}, u[3] = {0}, turn[3];
    if (!mps_is_fluid(v, i)) return;
    const double m = mps__cell_mass(f->rho, f->region, f->cell, i);
    for (int d = 0; d < dim; d++) {
        r[d] = v->x[i * dim + d] - f->at[d];
        const int64_t k = i * dim + d;
        u[d] = m * (f->a ? f->u[k] + f->dt * f->a[k] : f->u[k]);
        *term++ = u[d];
    }
    mps__cross(r, u, turn);
    for (int k = 0; k < TURNS(dim); k++) *term++ = turn[dim == 2 ? 2 : k];
    if (!f->masses) return;
    *term++ = m;
    for (int d = 0; d < dim; d++) *term++ = m * r[d];
}
MPS_SUMS(add_moments, add_moment, flow)

static double cell_of(const mps__world *w)
{
    const double dp = w->setup.dp;
    return w->setup.dim == 2 ? dp * dp : dp * dp * dp;
}

/* Momentum of the velocities, or of velocities changed by accelerations `a`. Masses are constant in
 * a step: once they are known, they are not summed again, and returned as 0. */
static void sum_momentum(const mps__step *q, const double *a, bool masses,
                         double sums[MPS__MOMENTUM])
{
    const mps__world *w = q->w;
    const int32_t dim = w->setup.dim, turns = TURNS(dim), own = dim + turns;
    flow f = {.rho = mps__seen(w, MPS__FIELD_DENSITY),
              .u = mps__seen(w, MPS__FIELD_VELOCITY),
              .a = a,
              .masses = masses,
              .dt = q->view.dt,
              .region = mps__seen(w, MPS__FIELD_REGION),
              .cell = cell_of(w)};
    double found[MPS__MOMENTUM] = {0};
    mps_view v;
    memcpy(f.at, q->load.at, sizeof f.at);
    mps__world_view(w, &v);
    mps__runner_sum(&w->runner, &v, masses ? own + 1 + dim : own, &add_moments, &f, found);
    memset(sums, 0, MPS__MOMENTUM * sizeof *sums);
    memcpy(sums, found, (size_t)dim * sizeof *sums);
    memcpy(sums + 6 - turns, found + dim, (size_t)turns * sizeof *sums);
    memcpy(sums + 6, found + own, (size_t)(1 + dim) * sizeof *sums);
}

/* Regions are those of this step, velocities still those before it. */
static mps_status begin_load(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    q->load = (mps__load){.watch = w->load.watch,
                          .what = mps__body_carries(w) ? MPS_LOAD_MASS : w->load.watch};
    if (q->load.what == MPS_LOAD_NONE) return MPS_OK;
    mps__motion_point(&w->motion, &w->motion.now, w->motion.centre, q->load.at, NULL, NULL);
    sum_momentum(q, NULL, true, q->momentum_before);
    return MPS_OK;
}

static const mps_use begin_uses[] = {
    {"velocity", MPS_USE_READ}, {"density", MPS_USE_READ}, {"region", MPS_USE_READ}};

const mps__pass mps__pass_begin_load = {.name = "begin_load",
                                        .hook = MPS_FORCE,
                                        .place = MPS__AFTER_MODELS,
                                        .stage = MPS_STAGE_OPERATORS,
                                        .device = true,
                                        .use_count = 3,
                                        .uses = begin_uses,
                                        .run = begin_load};

/* ---- half cells ---- */

typedef struct half_fields {
    mps__halves halves;
    const double *tank, *acceleration;
    double at[3], turn[3];
} half_fields;

/* The acceleration by pressures is that of the liquid minus gravity. */
MPS_ROW void add_half(const int dim, const mps_view *v, const half_fields *f, int64_t i,
                      double *term)
{
    double n[3] = {0}, a[3], r[3] = {0}, push[3] = {0};
    mps__half_pull pull = {.a = f->acceleration, .stride = dim};
    const double mass = mps__half_cell(dim, v, &f->halves, i, n);
    if (mass == 0) return;
    for (int d = 0; d < dim; d++) pull.tank[d] = f->tank[i * dim + d] - v->g[d];
    for (int d = 0; d < 3; d++) pull.turn[d] = f->turn[d];
    mps__half_acceleration(dim, v, &f->halves, &pull, i, n, a);
    for (int d = 0; d < dim; d++) {
        push[d] = -mass * a[d];
        r[d] = v->x[i * dim + d] - f->at[d];
        term[d] = push[d];
    }
    mps__cross(r, push, term + 3);
}
MPS_SUMS(add_halves, add_half, half_fields)

static void sum_halves(mps_stage *s, const mps__load_arrays *a, double force[6])
{
    half_fields f = {
        .tank = a->tank,
        .acceleration = a->acceleration,
        .halves = {.density = a->density, .wetted = s->view->flux.wetted, .region = a->region}};
    double accel[6];
    mps__step_acceleration(mps__step_of(s), accel);
    memcpy(f.at, mps__step_of(s)->load.at, sizeof f.at);
    memcpy(f.turn, accel + 3, sizeof f.turn);
    mps_stage_sum(s, 6, &add_halves, &f, force);
}

/* Add the momentum deficit of the particles. */
static void add_lack(const mps__step *q, const double after[MPS__MOMENTUM], double force[6])
{
    const double *g = q->w->setup.g, *b = q->momentum_before;
    double weight[6];
    for (int d = 0; d < 3; d++) weight[d] = b[6] * g[d];
    mps__cross(b + 7, g, weight + 3);
    for (int k = 0; k < 6; k++) force[k] += weight[k] - (after[k] - b[k]) / q->view.dt;
}

void mps__step_load_now(mps_stage *s, const mps__load_arrays *a, double force[6])
{
    double after[MPS__MOMENTUM];
    sum_halves(s, a, force);
    sum_momentum(mps__step_of(s), a->acceleration, false, after);
    add_lack(mps__step_of(s), after, force);
}

enum { ACCELERATION, TANK, DENSITY, REGION, CORRECTION, USES };

static mps_status sum_half_cells(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    if (q->load.what == MPS_LOAD_NONE) return MPS_OK;
    sum_halves(s,
               &(mps__load_arrays){.acceleration = s->data[ACCELERATION],
                                   .tank = s->data[TANK],
                                   .density = s->data[DENSITY],
                                   .region = s->data[REGION]},
               q->load.force);
    return MPS_OK;
}

static const mps_use half_uses[USES] = {
    [ACCELERATION] = {"acceleration", MPS_USE_NEIGHBOURS},
    [TANK] = {"tank_acceleration", MPS_USE_READ},
    [DENSITY] = {"pressure_density", MPS_USE_READ},
    [REGION] = {"region", MPS_USE_NEIGHBOURS},
    /* keeps the channel allocated until the added mass has been computed */
    [CORRECTION] = {"correction", MPS_USE_READ | MPS_USE_OPTIONAL}};

const mps__pass mps__pass_half_cells = {.name = "half_cells",
                                        .hook = MPS_LOAD,
                                        .place = MPS__AFTER_MODELS,
                                        .stage = MPS_STAGE_CORRECT,
                                        .device = true,
                                        .use_count = USES,
                                        .uses = half_uses,
                                        .run = sum_half_cells};

/* ---- the end of the step ---- */

/* Velocity of the centre of motion from one pose to another, and the angular velocity: the
 * skew-symmetric part of (R1 R0^T - 1)/dt. */
static void velocity_between(const mps__motion *m, const mps__pose *from, const mps__pose *to,
                             double dt, double out[6])
{
    double c0[3] = {0}, c1[3] = {0}, turn[9];
    mps__motion_point(m, from, m->centre, c0, NULL, NULL);
    mps__motion_point(m, to, m->centre, c1, NULL, NULL);
    for (int r = 0; r < 9; r++)
        turn[r] = mps__dot(to->rotation + r / 3 * 3, from->rotation + r % 3 * 3, 3);
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        out[d] = (c1[d] - c0[d]) / dt;
        out[3 + d] = 0.5 * (turn[f * 3 + e] - turn[e * 3 + f]) / dt;
    }
}

void mps__step_acceleration(const mps__step *q, double accel[6])
{
    const mps__world *w = q->w;
    const mps__motion *m = &w->motion;
    double before[6] = {0};
    velocity_between(m, &m->now, &q->pose, q->view.dt, accel);
    if (w->state.dt_before > 0)
        velocity_between(m, &w->state.before, &m->now, w->state.dt_before, before);
    else if (m->start == MPS_START_WITH_TANK)
        for (int d = 0; d < 3; d++) {
            before[d] = m->now.state.rate[d];
            before[3 + d] = m->now.omega[d];
        }
    for (int k = 0; k < 6; k++) accel[k] = (accel[k] - before[k]) / q->view.dt;
}

void mps__step_load_close(mps__step *q)
{
    double after[MPS__MOMENTUM];
    if (q->load.what == MPS_LOAD_NONE) return;
    sum_momentum(q, NULL, false, after);
    add_lack(q, after, q->load.force);
}

void mps__step_load_end(mps__step *q)
{
    mps__world *w = q->w;
    mps__load *l = &q->load;
    if (l->what != MPS_LOAD_NONE) {
        mps__step_acceleration(q, l->accel);
        l->dt = q->view.dt;
        l->known = true;
        if (l->has_mass) mps__step_mass_end(q);
        l->has_mass = l->has_mass && l->watch == MPS_LOAD_MASS;
    }
    w->load = *l;
}
