/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of energy and momentum. They are exact: the same bytes for any number of threads and any
 * order of the particles. */
#include "budget.h"
#include <string.h>

enum { TERMS = 5 }; /* sums of one loop, at most */

/* Arguments of the row functions. */
typedef struct terms {
    const double *rho, *u;
    const double *data; /* by particle: an acceleration, a displacement, a pressure, a deviation */
    const int32_t *region;
    double cell, dt;
    double centre[3], v[3], omega[3]; /* velocity of the rigid tank, about `centre` */
} terms;

/* Set what all row functions use. */
static void complete(const mps__world *w, mps_view *v, terms *f)
{
    const double dp = w->setup.dp;
    mps__world_view(w, v);
    f->rho = mps__seen(w, MPS__FIELD_DENSITY);
    f->u = mps__seen(w, MPS__FIELD_VELOCITY);
    f->region = mps__seen(w, MPS__FIELD_REGION);
    f->cell = w->setup.dim == 2 ? dp * dp : dp * dp * dp;
}

static void sum_terms(const mps__world *w, const mps_sums *add, terms *f, int32_t count,
                      double *values)
{
    mps_view v;
    complete(w, &v, f);
    mps__runner_sum(&w->runner, &v, count, add, f, values);
}

static void sum_deferred(mps__world *w, const mps_sums *add, terms *f, int32_t count,
                         mps__then then)
{
    mps_view v;
    complete(w, &v, f);
    mps__runner_sum_deferred(&w->runner, &v, count, add, f, then);
}

/* Kinetic energy and momentum. */
MPS_ROW void add_flow(const int dim, const mps_view *v, const terms *f, int64_t i, double *term)
{
    if (!mps_is_fluid(v, i)) return;
    const double *u = f->u + i * dim, m = f->rho[i] * f->cell;
    term[0] = 0.5 * m * mps__dot(u, u, dim);
    for (int d = 0; d < dim; d++) term[1 + d] = m * u[d];
}
MPS_SUMS(add_flows, add_flow, terms)

/* Kinetic energy, momentum, and last the potential energy. */
MPS_ROW void add_energy(const int dim, const mps_view *v, const terms *f, int64_t i, double *term)
{
    if (!mps_is_fluid(v, i)) return;
    add_flow(dim, v, f, i, term);
    term[1 + dim] = -(f->rho[i] * f->cell) * mps__dot(v->g, v->x + i * dim, dim);
}
MPS_SUMS(add_energies, add_energy, terms)

void mps__budget_sum(const mps__world *w, mps__bulk *bulk)
{
    double s[TERMS] = {0};
    sum_terms(w, &add_energies, &(terms){0}, 2 + w->setup.dim, s);
    mps__budget_take(w, s, bulk);
}

void mps__budget_deferred(mps__world *w, mps__then then)
{
    sum_deferred(w, &add_energies, &(terms){0}, 2 + w->setup.dim, then);
}

void mps__budget_take(const mps__world *w, const double *sums, mps__bulk *bulk)
{
    *bulk = (mps__bulk){.kinetic = sums[0], .potential = sums[1 + w->setup.dim]};
    for (int d = 0; d < w->setup.dim; d++) bulk->momentum[d] = sums[1 + d];
}

void mps__budget_sum_flow(const mps__world *w, mps__bulk *bulk)
{
    double s[TERMS] = {0};
    sum_terms(w, &add_flows, &(terms){0}, 1 + w->setup.dim, s);
    mps__budget_take_flow(w, s, bulk);
}

void mps__budget_flow_deferred(mps__world *w, mps__then then)
{
    sum_deferred(w, &add_flows, &(terms){0}, 1 + w->setup.dim, then);
}

void mps__budget_take_flow(const mps__world *w, const double *sums, mps__bulk *bulk)
{
    *bulk = (mps__bulk){.kinetic = sums[0]};
    for (int d = 0; d < w->setup.dim; d++) bulk->momentum[d] = sums[1 + d];
}

MPS_ROW void add_push(const int dim, const mps_view *v, const terms *f, int64_t i, double *term)
{
    if (!mps_is_fluid(v, i)) return;
    const double *b = f->data + i * dim, *u = f->u + i * dim, m = f->rho[i] * f->cell;
    term[0] = m * f->dt * (mps__dot(b, u, dim) + 0.5 * f->dt * mps__dot(b, b, dim));
    term[1] = m;
    for (int d = 0; d < dim; d++) term[2 + d] = m * f->dt * b[d];
}
MPS_SUMS(add_pushes, add_push, terms)

void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push)
{
    double s[TERMS] = {0};
    sum_terms(w, &add_pushes, &(terms){.data = a, .dt = dt}, 2 + w->setup.dim, s);
    mps__budget_take_push(w, s, push);
}

void mps__budget_push_deferred(mps__world *w, const double *a, double dt, mps__then then)
{
    sum_deferred(w, &add_pushes, &(terms){.data = a, .dt = dt}, 2 + w->setup.dim, then);
}

void mps__budget_take_push(const mps__world *w, const double *sums, mps__push *push)
{
    *push = (mps__push){.energy = sums[0], .mass = sums[1]};
    for (int d = 0; d < w->setup.dim; d++) push->impulse[d] = sums[2 + d];
}

/* Add half the velocity from one pose to another. The angular velocity is the skew-symmetric part
 * of (R1 R0^T - 1)/dt, as of the walls' displacements. */
static void add_half_move(const mps__motion *m, const mps__pose *from, const mps__pose *to,
                          double dt, terms *k)
{
    double c0[3] = {0}, c1[3] = {0}, turn[9] = {0};
    mps__motion_point(m, from, m->centre, c0, NULL, NULL);
    mps__motion_point(m, to, m->centre, c1, NULL, NULL);
    for (int r = 0; r < 9; r++)
        turn[r] = mps__dot(to->rotation + r / 3 * 3, from->rotation + r % 3 * 3, 3);
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        k->v[d] += 0.5 * (c1[d] - c0[d]) / dt;
        k->omega[d] += 0.25 * (turn[f * 3 + e] - turn[e * 3 + f]) / dt;
    }
}

/* Mean of the velocities of the last step and of this one; for the first step that of the start
 * convention. */
static terms mean_move(const mps__world *w, const mps__pose *end, double dt)
{
    const mps__motion *m = &w->motion;
    terms k = {.dt = dt};
    mps__motion_point(m, &m->now, m->centre, k.centre, NULL, NULL);
    add_half_move(m, &m->now, end, dt, &k);
    if (w->state.dt_before > 0)
        add_half_move(m, &w->state.before, &m->now, w->state.dt_before, &k);
    else if (m->start == MPS_START_WITH_TANK)
        for (int d = 0; d < 3; d++) {
            k.v[d] += d < w->setup.dim ? 0.5 * m->now.state.rate[d] : 0;
            k.omega[d] += 0.5 * m->now.omega[d];
        }
    return k;
}

/* Tank velocity at a particle. */
MPS_ROW void move_velocity(const int dim, const mps_view *v, const terms *f, int64_t i, double u[3])
{
    const double *o = f->omega;
    double r[3] = {0};
    for (int d = 0; d < dim; d++) r[d] = v->x[i * dim + d] - f->centre[d];
    const double spin[3] = {o[1] * r[2] - o[2] * r[1], o[2] * r[0] - o[0] * r[2],
                            o[0] * r[1] - o[1] * r[0]};
    for (int d = 0; d < 3; d++) u[d] = f->v[d] + spin[d];
}

MPS_ROW void add_work(const int dim, const mps_view *v, const terms *f, int64_t i, double *term)
{
    if (!mps_is_fluid(v, i)) return;
    const double *a = f->data + i * dim;
    double u[3];
    move_velocity(dim, v, f, i, u);
    for (int d = 0; d < dim; d++) term[0] += f->rho[i] * f->cell * f->dt * a[d] * u[d];
}
MPS_SUMS(add_works, add_work, terms)

void mps__budget_wall_work(mps__world *w, const mps__pose *end, const double *a, double dt,
                           mps__then then)
{
    terms k = mean_move(w, end, dt);
    k.data = a;
    sum_deferred(w, &add_works, &k, 1, then);
}

double mps__budget_tank_work(const mps__world *w, const mps__pose *end, const double force[6],
                             double dt)
{
    const terms k = mean_move(w, end, dt);
    return dt * (mps__dot(force, k.v, 3) + mps__dot(force + 3, k.omega, 3));
}

/* Force, and last its work. */
MPS_ROW void add_wall(const int dim, const mps_view *v, const terms *f, int64_t i, double *term)
{
    if (!mps_is_wall(v, i) || f->data[i] == 0) return;
    const double *area = v->area + i * dim;
    double u[3];
    move_velocity(dim, v, f, i, u);
    for (int d = 0; d < dim; d++) {
        term[d] = f->data[i] * area[d];
        term[dim] += f->dt * term[d] * u[d];
    }
}
MPS_SUMS(add_walls, add_wall, terms)

void mps__budget_wall_force(mps__world *w, const mps__pose *end, const double *pressure, double dt,
                            mps__then then)
{
    terms k = mean_move(w, end, dt);
    k.data = pressure;
    sum_deferred(w, &add_walls, &k, 1 + w->setup.dim, then);
}

typedef struct body_fields {
    /* area and positions in the tank's frame, in which solids move */
    const double *pressure, *area, *from, *to;
} body_fields;

MPS_ROW void add_body_work(const int dim, const mps_view *v, const body_fields *f, int64_t i,
                           double *term)
{
    if (!mps_is_wall(v, i)) return;
    for (int64_t k = i * dim; k < (i + 1) * dim; k++)
        term[0] += f->pressure[i] * f->area[k] * (f->to[k] - f->from[k]);
}
MPS_SUMS(add_body_works, add_body_work, body_fields)

double mps__budget_body_work(const mps__world *w, const double *pressure, const double *place)
{
    const body_fields f = {pressure, mps__seen(w, MPS__FIELD_AREA), mps__seen(w, MPS__FIELD_REF),
                           place};
    double work = 0;
    mps_view v;
    if (!w->work.bodies) return 0;
    mps__world_view(w, &v);
    mps__runner_sum(&w->runner, &v, 1, &add_body_works, &f, &work);
    return work;
}

MPS_ROW void add_lift(const int dim, const mps_view *v, const terms *f, int64_t i, double *term)
{
    if (mps_is_fluid(v, i)) term[0] = f->rho[i] * f->cell * mps__dot(v->g, f->data + i * dim, dim);
}
MPS_SUMS(add_lifts, add_lift, terms)

void mps__budget_lift(mps__world *w, const double *dx, mps__then then)
{
    sum_deferred(w, &add_lifts, &(terms){.data = dx}, 1, then);
}

void mps__budget_book_added(const mps__world *w, mps__budget *b)
{
    mps__bulk now;
    mps__budget_sum(w, &now);
    b->added += now.kinetic + now.potential - (b->last.kinetic + b->last.potential);
    for (int d = 0; d < w->setup.dim; d++)
        b->momentum.added[d] += now.momentum[d] - b->last.momentum[d];
    b->last = now;
}

/* Whether the sums of the last step are still valid. Many ranks always sum again, which needs no
 * agreement. */
static bool is_booked(const mps__world *w)
{
    return w->booked == mps__particles_flow(&w->particles) && !mps__ranks_many(&w->ranks);
}

mps_status mps__budget_update(const mps__world *w, mps__budget *b)
{
    if (b->started && is_booked(w)) return MPS_OK;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_POSITION));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_VELOCITY));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_DENSITY));
    if (b->started) {
        mps__budget_book_added(w, b);
        return MPS_OK;
    }
    *b = (mps__budget){0}; /* a failed first step leaves nothing */
    mps__budget_sum(w, &b->last);
    b->start = b->last.kinetic + b->last.potential;
    return MPS_OK;
}

MPS_ROW void add_deviation(const int dim, const mps_view *v, const terms *f, int64_t i,
                           double *term)
{
    (void)dim;
    if (!mps_is_fluid(v, i) || f->region[i] > MPS_REGION_SECOND) return;
    term[0] = f->data[i];
    term[1] = 1;
}
MPS_SUMS(add_deviations, add_deviation, terms)

void mps__budget_deviation(mps__world *w, const double *deviation, mps__then then)
{
    sum_deferred(w, &add_deviations, &(terms){.data = deviation}, 2, then);
}
