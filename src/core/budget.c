/* SPDX-License-Identifier: BSD-3-Clause */
/* Energy sums in the order of the particles, so that they are the same for any number of threads. */
#include "budget.h"
#include <string.h>

static double mass(const mps__world *w, int64_t i)
{
    return w->particles.rho[i] * (w->dim == 2 ? w->dp * w->dp : w->dp * w->dp * w->dp);
}

void mps__budget_sum(const mps__world *w, double *kinetic, double *potential)
{
    const mps__particles *s = &w->particles;
    *kinetic = *potential = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        const double *u = s->u + i * w->dim;
        *kinetic += 0.5 * mass(w, i) * mps__dot(u, u, w->dim);
        *potential -= mass(w, i) * mps__dot(w->g, s->x + i * w->dim, w->dim);
    }
}

double mps__budget_power(const mps__world *w, const double *a, double dt)
{
    const mps__particles *s = &w->particles;
    double sum = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        const double *b = a + i * w->dim;
        sum += mass(w, i) * dt * (mps__dot(b, s->u + i * w->dim, w->dim) + 0.5 * dt * mps__dot(b, b, w->dim));
    }
    return sum;
}

double mps__budget_wall_work(const mps__world *w, const mps__pose *end, const double *u0, double dt)
{
    const mps__particles *s = &w->particles;
    double c0[3] = {0}, c1[3] = {0}, work = 0;
    mps__motion_point(&w->motion, &w->motion.now, w->motion.centre, c0, NULL, NULL);
    mps__motion_point(&w->motion, end, w->motion.centre, c1, NULL, NULL);
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        double r[3] = {0}, v[3];
        for (int d = 0; d < w->dim; d++) r[d] = s->x[i * w->dim + d] - c0[d];
        const double *o = end->omega;
        const double spin[3] = {o[1] * r[2] - o[2] * r[1], o[2] * r[0] - o[0] * r[2], o[0] * r[1] - o[1] * r[0]};
        for (int d = 0; d < w->dim; d++) {
            v[d] = (c1[d] - c0[d]) / dt + spin[d];
            work += mass(w, i) * v[d] * (s->u[i * w->dim + d] - u0[i * w->dim + d] - dt * w->g[d]);
        }
    }
    return work;
}

double mps__budget_lift(const mps__world *w, const double *dx)
{
    const mps__particles *s = &w->particles;
    double sum = 0;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) sum += mass(w, i) * mps__dot(w->g, dx + i * w->dim, w->dim);
    return sum;
}

double mps__budget_mean_deviation(const mps__world *w)
{
    const mps__particles *s = &w->particles;
    double sum = 0;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->region[i] <= MPS_REGION_SECOND) {
            sum += w->work.volume[i];
            count++;
        }
    return count ? sum / (double)count : 0;
}
