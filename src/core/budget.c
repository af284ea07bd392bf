/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of energy and momentum. Particles are summed in a fixed number of parts, each by one thread: the same bytes for any number of threads. */
#include "budget.h"
#include <string.h>

enum { PARTS = 64, SUMS = 8 };

/* What a particle adds to up to eight sums. */
typedef struct sums {
    double of[SUMS];
} sums;
typedef void (*term_fn)(const mps__world *w, const void *data, int64_t i, double *sum);

/* Particles from..to-1. */
typedef struct range {
    int64_t from, to;
} range;
typedef void (*part_fn)(const mps__world *w, const void *data, range r, sums *part);

/* The terms of one kind of particles. Each kind of term has its own loop, in which its function is inlined. */
static inline __attribute__((always_inline)) void add_terms(const mps__world *w, int32_t kind, term_fn term, const void *data, range r,
                                                            sums *part)
{
    sums sum = *part; /* a local one stays in registers */
    for (int64_t i = r.from; i < r.to; i++)
        if (w->particles.kind[i] == kind) term(w, data, i, sum.of);
    *part = sum;
}

static sums sum_parts(const mps__world *w, part_fn add, const void *data)
{
    const int64_t n = w->particles.n;
    sums part[PARTS] = {{{0}}}, all = {{0}};
#pragma omp parallel for num_threads(w->threads) schedule(static)
    for (int p = 0; p < PARTS; p++) add(w, data, (range){n * p / PARTS, n * (p + 1) / PARTS}, &part[p]);
    for (int p = 0; p < PARTS; p++)
        for (int k = 0; k < SUMS; k++) all.of[k] += part[p].of[k];
    return all;
}

static double mass(const mps__world *w, int64_t i)
{
    return w->particles.rho[i] * (w->dim == 2 ? w->dp * w->dp : w->dp * w->dp * w->dp);
}

static void energy_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    (void)data;
    const double *u = w->particles.u + i * w->dim;
    sum[0] += 0.5 * mass(w, i) * mps__dot(u, u, w->dim);
    sum[1] -= mass(w, i) * mps__dot(w->g, w->particles.x + i * w->dim, w->dim);
    for (int d = 0; d < w->dim; d++) sum[2 + d] += mass(w, i) * u[d];
}

static void add_energy(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_FLUID, energy_term, data, r, part);
}

void mps__budget_sum(const mps__world *w, mps__bulk *bulk)
{
    const sums s = sum_parts(w, add_energy, NULL);
    *bulk = (mps__bulk){s.of[0], s.of[1], {s.of[2], s.of[3], s.of[4]}};
}

typedef struct acceleration {
    const double *a;
    double dt;
} acceleration;

static void push_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    const acceleration *k = data;
    const double *b = k->a + i * w->dim, *u = w->particles.u + i * w->dim, m = mass(w, i);
    sum[0] += m * k->dt * (mps__dot(b, u, w->dim) + 0.5 * k->dt * mps__dot(b, b, w->dim));
    sum[1] += m;
    for (int d = 0; d < w->dim; d++) {
        sum[2 + d] += m * u[d];
        sum[5 + d] += m * k->dt * b[d];
    }
}

static void add_push(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_FLUID, push_term, data, r, part);
}

void mps__budget_push(const mps__world *w, const double *a, double dt, mps__push *push)
{
    const sums s = sum_parts(w, add_push, &(acceleration){a, dt});
    *push = (mps__push){s.of[0], s.of[1], {s.of[2], s.of[3], s.of[4]}, {s.of[5], s.of[6], s.of[7]}};
}

static void wall_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    const double *area = w->work.area + i * w->dim;
    for (int d = 0; d < w->dim; d++) sum[d] += ((const double *)data)[i] * area[d];
}

static void add_wall(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_WALL, wall_term, data, r, part);
}

void mps__budget_wall_force(const mps__world *w, const double *pressure, double force[3])
{
    const sums s = sum_parts(w, add_wall, pressure);
    memcpy(force, s.of, 3 * sizeof *force);
}

/* A rigid velocity, about `centre`, and the impulses it works on. */
typedef struct tank_move {
    double centre[3], v[3], omega[3], dt;
    const double *a;
} tank_move;

/* Add half the velocity from one pose to another. Its turn is the part of (R1 R0^T - 1)/dt without strain, of what the walls really do. */
static void add_half_move(const mps__motion *m, const mps__pose *from, const mps__pose *to, double dt, tank_move *k)
{
    double c0[3] = {0}, c1[3] = {0}, turn[9] = {0};
    mps__motion_point(m, from, m->centre, c0, NULL, NULL);
    mps__motion_point(m, to, m->centre, c1, NULL, NULL);
    for (int r = 0; r < 9; r++) turn[r] = mps__dot(to->rotation + r / 3 * 3, from->rotation + r % 3 * 3, 3);
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
    if (w->dt_before > 0)
        add_half_move(m, &w->before, &m->now, w->dt_before, &k);
    else if (m->start == MPS_START_WITH_TANK)
        for (int d = 0; d < 3; d++) {
            k.v[d] += d < w->dim ? 0.5 * m->now.state.rate[d] : 0;
            k.omega[d] += 0.5 * m->now.omega[d];
        }
    return k;
}

static void wall_work_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    const tank_move *k = data;
    const double *o = k->omega, *a = k->a + i * w->dim;
    double r[3] = {0};
    for (int d = 0; d < w->dim; d++) r[d] = w->particles.x[i * w->dim + d] - k->centre[d];
    const double spin[3] = {o[1] * r[2] - o[2] * r[1], o[2] * r[0] - o[0] * r[2], o[0] * r[1] - o[1] * r[0]};
    for (int d = 0; d < w->dim; d++) sum[0] += mass(w, i) * k->dt * a[d] * (k->v[d] + spin[d]);
}

static void add_wall_work(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_FLUID, wall_work_term, data, r, part);
}

double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *a, double dt)
{
    tank_move k = mean_move(w, end, dt);
    k.a = a;
    return sum_parts(w, add_wall_work, &k).of[0];
}

static void lift_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    sum[0] += mass(w, i) * mps__dot(w->g, (const double *)data + i * w->dim, w->dim);
}

static void add_lift(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_FLUID, lift_term, data, r, part);
}

double mps__budget_lift(const mps__world *w, const double *dx)
{
    return sum_parts(w, add_lift, dx).of[0];
}

void mps__budget_book_added(const mps__world *w, mps__budget *b)
{
    mps__bulk now;
    mps__budget_sum(w, &now);
    b->added += now.kinetic + now.potential - (b->last.kinetic + b->last.potential);
    for (int d = 0; d < w->dim; d++) b->momentum.added[d] += now.momentum[d] - b->last.momentum[d];
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

static void deviation_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    (void)data;
    if (w->particles.region[i] > MPS_REGION_SECOND) return;
    sum[0] += w->work.volume_deviation[i];
    sum[1] += 1;
}

static void add_deviation(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_FLUID, deviation_term, data, r, part);
}

double mps__budget_mean_deviation(const mps__world *w)
{
    const sums s = sum_parts(w, add_deviation, NULL);
    return s.of[1] > 0 ? s.of[0] / s.of[1] : 0;
}
