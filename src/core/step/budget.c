/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of energy and momentum. They are exact: the same bytes for any number of threads and any order of the particles. */
#include "budget.h"
#include "terms.h"
#include <string.h>

enum { TERMS = 5 }; /* sums of one loop, at most */

/* What terms are made of. */
typedef struct terms {
    const mps__world *w;
    const void *data;
    int32_t count; /* sums */
} terms;

/* Define `name`, which adds the terms of one kind of particles; each has its own loop, in which its function is inlined. */
#define ADD_TERMS(name, kind_of_particles, set)                                                 \
    static void name(void *argument, int64_t begin, int64_t end, mps_exact *sums, double *none) \
    {                                                                                           \
        const terms *k = argument;                                                              \
        mps__terms t;                                                                           \
        (void)none;                                                                             \
        mps__terms_begin(&t, sums, k->count);                                                   \
        for (int64_t i = begin; i < end; i++) {                                                 \
            double own[TERMS] = {0};                                                            \
            if (k->w->particles.kind[i] != (kind_of_particles)) continue;                       \
            if (mps__is_ghost(&k->w->ghosts, i)) continue;                                      \
            set(k->w, k->data, i, own);                                                         \
            mps__terms_add(&t, own);                                                            \
        }                                                                                       \
        mps__terms_end(&t);                                                                     \
    }

static void sum_terms(const mps__world *w, mps_exact_fn add, const void *data, int32_t count,
                      double *values)
{
    terms k = {w, data, count};
    mps_exact sums[TERMS] = {{{0}, 0, 0}};
    mps_exact_rows(&w->pool.parallel, w->particles.n, MPS_PARALLEL_LEAST, add, &k,
                   &(mps_exact_values){.sums = count, .sum = sums});
    mps__ranks_sum(w->ghosts.ranks, count, sums);
    for (int32_t v = 0; v < count; v++) values[v] = mps_exact_value(&sums[v]);
}

static double mass(const mps__world *w, int64_t i)
{
    return w->particles.rho[i] * (w->setup.dim == 2 ? w->setup.dp * w->setup.dp
                                                    : w->setup.dp * w->setup.dp * w->setup.dp);
}

/* Kinetic energy, momentum, and last the potential energy. */
static void energy_term(const mps__world *w, const void *data, int64_t i, double *term)
{
    (void)data;
    const double *u = w->particles.u + i * w->setup.dim;
    const double m = mass(w, i);
    term[0] = 0.5 * m * mps__dot(u, u, w->setup.dim);
    for (int d = 0; d < w->setup.dim; d++) term[1 + d] = m * u[d];
    term[1 + w->setup.dim] = -m *
                             mps__dot(w->setup.g, w->particles.x + i * w->setup.dim, w->setup.dim);
}

ADD_TERMS(add_energy, MPS_FLUID, energy_term)

void mps__budget_sum(const mps__world *w, mps__bulk *bulk)
{
    double s[TERMS] = {0};
    sum_terms(w, add_energy, NULL, 2 + w->setup.dim, s);
    *bulk = (mps__bulk){.kinetic = s[0], .potential = s[1 + w->setup.dim]};
    for (int d = 0; d < w->setup.dim; d++) bulk->momentum[d] = s[1 + d];
}

void mps__budget_sum_flow(const mps__world *w, mps__bulk *bulk)
{
    double s[TERMS] = {0};
    sum_terms(w, add_energy, NULL, 1 + w->setup.dim, s);
    *bulk = (mps__bulk){.kinetic = s[0], .momentum = {s[1], s[2], s[3]}};
}

typedef struct acceleration {
    const double *a;
    double dt;
} acceleration;

static void push_term(const mps__world *w, const void *data, int64_t i, double *term)
{
    const acceleration *k = data;
    const double *b = k->a + i * w->setup.dim, *u = w->particles.u + i * w->setup.dim,
                 m = mass(w, i);
    term[0] = m * k->dt *
              (mps__dot(b, u, w->setup.dim) + 0.5 * k->dt * mps__dot(b, b, w->setup.dim));
    term[1] = m;
    for (int d = 0; d < w->setup.dim; d++) term[2 + d] = m * k->dt * b[d];
}

ADD_TERMS(add_push, MPS_FLUID, push_term)

void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push)
{
    double s[TERMS] = {0};
    sum_terms(w, add_push, &(acceleration){a, dt}, 2 + w->setup.dim, s);
    *push = (mps__push){s[0], s[1], {s[2], s[3], s[4]}};
}

static void wall_term(const mps__world *w, const void *data, int64_t i, double *term)
{
    const double *area = w->work.area + i * w->setup.dim;
    for (int d = 0; d < w->setup.dim; d++) term[d] = ((const double *)data)[i] * area[d];
}

ADD_TERMS(add_wall, MPS_WALL, wall_term)

void mps__budget_wall_force(const mps__world *w, const double *pressure, double force[3])
{
    sum_terms(w, add_wall, pressure, w->setup.dim, force);
}

/* A rigid velocity, about `centre`, and the impulses it works on. */
typedef struct tank_move {
    double centre[3], v[3], omega[3], dt;
    const double *a;
} tank_move;

/* Add half the velocity from one pose to another. Its turn is the part of (R1 R0^T - 1)/dt without strain, of what the walls really do. */
static void add_half_move(const mps__motion *m, const mps__pose *from, const mps__pose *to,
                          double dt, tank_move *k)
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

/* Mean of the velocities of the last step and of this one; before the first: what the start convention says. */
static tank_move mean_move(const mps__world *w, const mps__pose *end, double dt)
{
    const mps__motion *m = &w->motion;
    tank_move k = {.dt = dt};
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

static void wall_work_term(const mps__world *w, const void *data, int64_t i, double *term)
{
    const tank_move *k = data;
    const double *o = k->omega, *a = k->a + i * w->setup.dim;
    double r[3] = {0};
    for (int d = 0; d < w->setup.dim; d++)
        r[d] = w->particles.x[i * w->setup.dim + d] - k->centre[d];
    const double spin[3] = {o[1] * r[2] - o[2] * r[1], o[2] * r[0] - o[0] * r[2],
                            o[0] * r[1] - o[1] * r[0]};
    for (int d = 0; d < w->setup.dim; d++)
        term[0] += mass(w, i) * k->dt * a[d] * (k->v[d] + spin[d]);
}

ADD_TERMS(add_wall_work, MPS_FLUID, wall_work_term)

double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *a, double dt)
{
    tank_move k = mean_move(w, end, dt);
    k.a = a;
    double work;
    sum_terms(w, add_wall_work, &k, 1, &work);
    return work;
}

static void lift_term(const mps__world *w, const void *data, int64_t i, double *term)
{
    term[0] = mass(w, i) *
              mps__dot(w->setup.g, (const double *)data + i * w->setup.dim, w->setup.dim);
}

ADD_TERMS(add_lift, MPS_FLUID, lift_term)

double mps__budget_lift(const mps__world *w, const double *dx)
{
    double lift;
    sum_terms(w, add_lift, dx, 1, &lift);
    return lift;
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

void mps__budget_update(const mps__world *w, mps__budget *b)
{
    if (b->started) {
        mps__budget_book_added(w, b);
        return;
    }
    *b = (mps__budget){0}; /* a first step that failed leaves nothing */
    mps__budget_sum(w, &b->last);
    b->start = b->last.kinetic + b->last.potential;
}

static void deviation_term(const mps__world *w, const void *data, int64_t i, double *term)
{
    (void)data;
    if (w->particles.region[i] > MPS_REGION_SECOND) return;
    term[0] = w->work.volume_deviation[i];
    term[1] = 1;
}

ADD_TERMS(add_deviation, MPS_FLUID, deviation_term)

double mps__budget_mean_deviation(const mps__world *w)
{
    double s[2];
    sum_terms(w, add_deviation, NULL, 2, s);
    return s[1] > 0 ? s[0] / s[1] : 0;
}
