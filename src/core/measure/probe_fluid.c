/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure at a point in the fluid: kernel-weighted, exact for linear fields. */
#include "probe_fluid.h"
#include "plates.h"
#include <math.h>
#include <stdlib.h>

/* Moments of the kernel-weighted pressures around a point. */
typedef struct moments {
    double weight, p, x[3], px[3], xx[9];
    double low, high, nearest2;
} moments;

static void add_moment(moments *m, const double *r, double weight, double p)
{
    m->weight += weight;
    m->p += weight * p;
    for (int a = 0; a < 3; a++) {
        m->x[a] += weight * r[a];
        m->px[a] += weight * r[a] * p;
        for (int b = 0; b < 3; b++) m->xx[3 * a + b] += weight * r[a] * r[b];
    }
    m->low = fmin(m->low, p);
    m->high = fmax(m->high, p);
}

/* Solve the dim x dim system in place, symmetric positive definite; false if it is nearly
 * singular. */
static bool solve_small(int32_t dim, double a[9], double b[3], double scale)
{
    for (int32_t k = 0; k < dim; k++) {
        if (a[3 * k + k] < 1e-3 * scale) return false;
        for (int32_t i = k + 1; i < dim; i++) {
            double f = a[3 * i + k] / a[3 * k + k];
            for (int32_t j = k; j < dim; j++) a[3 * i + j] -= f * a[3 * k + j];
            b[i] -= f * b[k];
        }
    }
    for (int32_t k = dim - 1; k >= 0; k--) {
        for (int32_t j = k + 1; j < dim; j++) b[k] -= a[3 * k + j] * b[j];
        b[k] /= a[3 * k + k];
    }
    return true;
}

/* Weighted mean, extrapolated from the particles' centroid to the point with the weighted
 * least-squares gradient. */
static double moments_value(const mps__world *w, moments *m)
{
    double mean = m->p / m->weight, a[9], g[3], value = mean;
    for (int i = 0; i < 3; i++) {
        g[i] = m->px[i] / m->weight - mean * m->x[i] / m->weight;
        for (int j = 0; j < 3; j++)
            a[3 * i + j] = m->xx[3 * i + j] / m->weight -
                           m->x[i] * m->x[j] / (m->weight * m->weight);
    }
    if (!solve_small(w->setup.dim, a, g, w->setup.dp * w->setup.dp)) return mean;
    for (int32_t d = 0; d < w->setup.dim; d++) value -= g[d] * m->x[d] / m->weight;
    return fmin(fmax(value, m->low), m->high);
}

/* A particle near a point. */
typedef struct about {
    int64_t id;
    double r[3], d2, p;
} about;

static int compare_id(const void *a, const void *b)
{
    const int64_t i = ((const about *)a)->id, j = ((const about *)b)->id;
    return (i > j) - (i < j);
}

/* Fluid particles and the walls they wet near a point; a dry wall has p = 0 exactly. */
static mps_status find_about(const mps__world *w, const mps_probe *c, about **list, int64_t *count)
{
    const mps__particles *s = &w->particles;
    const int dim = w->setup.dim;
    int64_t capacity = 0;
    double at[3];
    mps__motion_point(&w->motion, &w->motion.now, c->at, at, NULL, NULL);
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        if (s->kind[i] == MPS_DUMMY || (s->kind[i] == MPS_WALL && s->load[i] == 0)) continue;
        about e = {.id = s->id[i], .d2 = mps__square_between(&s->x[i * dim], at, dim)};
        if (e.d2 >= w->setup.re_near * w->setup.re_near || mps__plates_hide(w, c->at, i)) continue;
        for (int32_t d = 0; d < dim; d++) e.r[d] = s->x[i * dim + d] - at[d];
        e.p = s->kind[i] == MPS_WALL ? s->load[i] : s->p[i];
        MPS__TRY(
            mps__grow(w->context, (void **)list, &capacity, *count, *count + 1, sizeof **list));
        (*list)[(*count)++] = e;
    }
    return mps__ranks_collect(w->ghosts.ranks, (void **)list, count, sizeof **list);
}

mps_status mps__fluid_measure(const mps__world *w, const mps_probe *c, double *value)
{
    moments m = {.low = INFINITY, .high = -INFINITY, .nearest2 = INFINITY};
    about *list = NULL;
    int64_t count = 0;
    MPS__TRY(mps__world_fetch(w));
    const mps_status status = find_about(w, c, &list, &count);
    if (count > 0) qsort(list, (size_t)count, sizeof *list, compare_id);
    for (int64_t k = 0; k < count; k++) {
        const double r = fmax(sqrt(list[k].d2), 1e-3 * w->setup.dp);
        add_moment(&m, list[k].r, mps_kernel_value(&w->setup.kernel, r, w->setup.re_near),
                   list[k].p);
        m.nearest2 = fmin(m.nearest2, list[k].d2);
    }
    mps__free(w->context, list);
    *value = m.nearest2 < 0.25 * w->setup.re_near * w->setup.re_near ? moments_value(w, &m) : 0;
    return status;
}
