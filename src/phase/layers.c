/* SPDX-License-Identifier: BSD-3-Clause */
#include "layers.h"
#include <mps/numbers.h>
#include <stddef.h>

static const double PI = 3.14159265358979323846;

/* Ratio of the rates; smallest rate 4 w^2, tan w = w; first weights, from the three conditions. */
static const double RATIO = 3.5, SLOWEST = 80.7629142257065;
/* Its logarithm and its power of 6, exact: otherwise kernels of devices would compute them for each
 * particle. */
static const double LOG_RATIO = 1.2527629684953681, POWER_6 = 1838.265625;
static const double FIRST[3] = {8.061972689696825, 12.990337578214488, 24.839696676022093};

/* (1 - exp(-z))/z */
static double phi1(double z)
{
    return z < 1e-5 ? 1 - z * (0.5 - z / 6) : -mps_expm1(-z) / z;
}

/* (1 - phi1(z))/z; first: phi1(z) */
static double phi2(double z, double first)
{
    return z < 1e-3 ? 0.5 - z * (1.0 / 6 - z * (1.0 / 24 - z / 120)) : (1 - first) / z;
}

/* The modes, dimensionless. */
typedef struct modes {
    double scale; /* [1/s] */
    double steady, slowest;
    double weight; /* over the square root of the rate */
    int first;     /* of the modes with own weights: */
    int count;
    const double *own;
} modes;

static void fill(const modes *m, double dt, mps__layers *layers)
{
    const double steady = m->steady * m->scale, single = phi1(steady * dt);
    double rate = m->slowest, drag = steady;
    /* With a steady part alone, u decays by exp(-steady dt): this fraction of du is implicit, 1/2
     * for short steps. */
    double added = steady * dt * phi2(steady * dt, single) / single;
    for (int k = 0; k < MPS__LAYERS; k++, rate *= RATIO) {
        const bool own = k >= m->first && k < m->first + m->count;
        const double weight = own ? m->own[k - m->first] : m->weight * sqrt(rate);
        const double z = rate * m->scale * dt, first = phi1(z), second = phi2(z, first);
        layers->keep[k] = mps_exp(-z);
        layers->rise[k] = z * second;
        layers->pull[k] = m->scale * weight * first;
        layers->energy[k] = weight / (2 * rate);
        drag += layers->pull[k];
        added += m->scale * dt * weight * second;
    }
    layers->drag = drag;
    layers->added = added;
}

void mps__layers_of(double nu, double width, double dt, mps__layers *layers)
{
    const modes m = {.scale = nu / (width * width),
                     .steady = 12,
                     .slowest = SLOWEST,
                     .weight = 2 / PI * LOG_RATIO,
                     .count = 3,
                     .own = FIRST};
    fill(&m, dt, layers);
}

enum { OWN = 6 };

/* Fits for walls: dimensions, far radius [dp], steady part, weights of modes 6 to 11. */
static const struct {
    int dim;
    double radius, steady, own[OWN];
} WALL[] = {{2, 2.1, 0.952725, {-0.003413, 0.287362, 0.358355, 1.460335, 2.398924, 5.301295}},
            {2, 3.1, 1.156275, {-0.153118, 0.227247, 0.391265, 1.553944, 2.363654, 5.340464}},
            {2, 4.1, 1.553915, {-0.645065, 0.407436, 0.292532, 1.714430, 2.243497, 5.418775}},
            {3, 2.1, 0.942245, {0.001978, 0.291207, 0.357993, 1.451335, 2.401879, 5.297908}},
            {3, 3.1, 1.131524, {-0.131173, 0.229954, 0.387612, 1.548070, 2.366284, 5.337699}},
            {3, 4.1, 1.501715, {-0.568730, 0.361840, 0.324501, 1.680938, 2.270946, 5.402469}}};

bool mps__layers_of_wall(int dim, double radius, double nu, double dp, double dt,
                         mps__layers *layers)
{
    for (size_t k = 0; k < sizeof WALL / sizeof WALL[0]; k++) {
        if (WALL[k].dim != dim || fabs(WALL[k].radius - radius) > 1e-6) continue;
        const modes m = {.scale = nu / (dp * dp),
                         .steady = WALL[k].steady,
                         .slowest = 0.3 / POWER_6,
                         .weight = LOG_RATIO / PI,
                         .first = OWN,
                         .count = OWN,
                         .own = WALL[k].own};
        fill(&m, dt, layers);
        return true;
    }
    return false;
}
