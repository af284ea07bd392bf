/* SPDX-License-Identifier: BSD-3-Clause */
/* Energy sums. Particles are summed in a fixed number of parts, each by one thread: the same bytes for any number of threads. */
#include "budget.h"
#include <string.h>

enum { PARTS = 64 };

/* What a particle adds to a sum or two. */
typedef struct pair_of_sums {
    double first, second;
} pair_of_sums;
typedef void (*term_fn)(const mps__world *w, const void *data, int64_t i, pair_of_sums *sum);

/* Sums over the fluid. */
static pair_of_sums sum_fluid(const mps__world *w, term_fn term, const void *data)
{
    const int64_t n = w->particles.n;
    pair_of_sums part[PARTS] = {{0}}, sum = {0};
#pragma omp parallel for num_threads(w->threads) schedule(static)
    for (int p = 0; p < PARTS; p++)
        for (int64_t i = n * p / PARTS; i < n * (p + 1) / PARTS; i++)
            if (w->particles.kind[i] == MPS_FLUID) term(w, data, i, &part[p]);
    for (int p = 0; p < PARTS; p++) {
        sum.first += part[p].first;
        sum.second += part[p].second;
    }
    return sum;
}

static double mass(const mps__world *w, int64_t i)
{
    return w->particles.rho[i] * (w->dim == 2 ? w->dp * w->dp : w->dp * w->dp * w->dp);
}

static void energy_term(const mps__world *w, const void *data, int64_t i, pair_of_sums *sum)
{
    (void)data;
    const double *u = w->particles.u + i * w->dim;
    sum->first += 0.5 * mass(w, i) * mps__dot(u, u, w->dim);
    sum->second -= mass(w, i) * mps__dot(w->g, w->particles.x + i * w->dim, w->dim);
}

void mps__budget_sum(const mps__world *w, double *kinetic, double *potential)
{
    const pair_of_sums sum = sum_fluid(w, energy_term, NULL);
    *kinetic = sum.first;
    *potential = sum.second;
}

typedef struct acceleration {
    const double *a;
    double dt;
} acceleration;

static void power_term(const mps__world *w, const void *data, int64_t i, pair_of_sums *sum)
{
    const acceleration *k = data;
    const double *b = k->a + i * w->dim;
    sum->first += mass(w, i) * k->dt * (mps__dot(b, w->particles.u + i * w->dim, w->dim) + 0.5 * k->dt * mps__dot(b, b, w->dim));
}

double mps__budget_power(const mps__world *w, const double *a, double dt)
{
    return sum_fluid(w, power_term, &(acceleration){a, dt}).first;
}

typedef struct tank_move {
    double c0[3], c1[3], dt;
    const double *omega, *u0;
} tank_move;

static void wall_work_term(const mps__world *w, const void *data, int64_t i, pair_of_sums *sum)
{
    const tank_move *k = data;
    const double *o = k->omega;
    double r[3] = {0}, v[3];
    for (int d = 0; d < w->dim; d++) r[d] = w->particles.x[i * w->dim + d] - k->c0[d];
    const double spin[3] = {o[1] * r[2] - o[2] * r[1], o[2] * r[0] - o[0] * r[2], o[0] * r[1] - o[1] * r[0]};
    for (int d = 0; d < w->dim; d++) {
        v[d] = (k->c1[d] - k->c0[d]) / k->dt + spin[d];
        sum->first += mass(w, i) * v[d] * (w->particles.u[i * w->dim + d] - k->u0[i * w->dim + d] - k->dt * w->g[d]);
    }
}

double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *u0, double dt)
{
    tank_move k = {.dt = dt, .omega = end->omega, .u0 = u0};
    mps__motion_point(&w->motion, &w->motion.now, w->motion.centre, k.c0, NULL, NULL);
    mps__motion_point(&w->motion, end, w->motion.centre, k.c1, NULL, NULL);
    return sum_fluid(w, wall_work_term, &k).first;
}

static void lift_term(const mps__world *w, const void *data, int64_t i, pair_of_sums *sum)
{
    sum->first += mass(w, i) * mps__dot(w->g, (const double *)data + i * w->dim, w->dim);
}

double mps__budget_lift(const mps__world *w, const double *dx)
{
    return sum_fluid(w, lift_term, dx).first;
}

static void deviation_term(const mps__world *w, const void *data, int64_t i, pair_of_sums *sum)
{
    (void)data;
    if (w->particles.region[i] > MPS_REGION_SECOND) return;
    sum->first += w->work.volume[i];
    sum->second += 1;
}

double mps__budget_mean_deviation(const mps__world *w)
{
    const pair_of_sums sum = sum_fluid(w, deviation_term, NULL);
    return sum.second > 0 ? sum.first / sum.second : 0;
}
