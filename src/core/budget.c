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
    const double *area = (const double *)data + i * w->dim;
    for (int d = 0; d < w->dim; d++) sum[d] += w->particles.p[i] * area[d];
}

static void add_wall(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_WALL, wall_term, data, r, part);
}

void mps__budget_wall_force(const mps__world *w, double force[3])
{
    const sums s = sum_parts(w, add_wall, w->work.area);
    memcpy(force, s.of, 3 * sizeof *force);
}

typedef struct tank_move {
    double c0[3], c1[3], dt;
    const double *omega, *u0;
} tank_move;

static void wall_work_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    const tank_move *k = data;
    const double *o = k->omega;
    double r[3] = {0}, v[3];
    for (int d = 0; d < w->dim; d++) r[d] = w->particles.x[i * w->dim + d] - k->c0[d];
    const double spin[3] = {o[1] * r[2] - o[2] * r[1], o[2] * r[0] - o[0] * r[2], o[0] * r[1] - o[1] * r[0]};
    for (int d = 0; d < w->dim; d++) {
        v[d] = (k->c1[d] - k->c0[d]) / k->dt + spin[d];
        sum[0] += mass(w, i) * v[d] * (w->particles.u[i * w->dim + d] - k->u0[i * w->dim + d] - k->dt * w->g[d]);
    }
}

static void add_wall_work(const mps__world *w, const void *data, range r, sums *part)
{
    add_terms(w, MPS_FLUID, wall_work_term, data, r, part);
}

double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *u0, double dt)
{
    tank_move k = {.dt = dt, .omega = end->omega, .u0 = u0};
    mps__motion_point(&w->motion, &w->motion.now, w->motion.centre, k.c0, NULL, NULL);
    mps__motion_point(&w->motion, end, w->motion.centre, k.c1, NULL, NULL);
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

static void deviation_term(const mps__world *w, const void *data, int64_t i, double *sum)
{
    (void)data;
    if (w->particles.region[i] > MPS_REGION_SECOND) return;
    sum[0] += w->work.volume[i];
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
