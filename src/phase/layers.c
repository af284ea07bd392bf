/* SPDX-License-Identifier: BSD-3-Clause */
#include "layers.h"
#include <math.h>

static const double PI = 3.14159265358979323846;

/* Ratio of the rates; slowest rate 4 w^2, tan w = w; first weights, from the three conditions. */
static const double RATIO = 3.5, SLOWEST = 80.7629142257065;
static const double FIRST[3] = {8.061972689696825, 12.990337578214488, 24.839696676022093};

/* (1 - exp(-z))/z */
static double phi1(double z)
{
    return z < 1e-5 ? 1 - z * (0.5 - z / 6) : -expm1(-z) / z;
}

/* (1 - phi1(z))/z */
static double phi2(double z)
{
    return z < 1e-3 ? 0.5 - z * (1.0 / 6 - z * (1.0 / 24 - z / 120)) : (1 - phi1(z)) / z;
}

void mps__layers_of(double nu, double width, double dt, mps__layers *layers)
{
    const double scale = nu / (width * width), steady = 12 * scale;
    double rate = SLOWEST, drag = steady;
    /* Of a lone steady part u decays by exp(-steady dt): this share of du is implicit, 1/2 for
     * short steps. */
    double added = steady * dt * phi2(steady * dt) / phi1(steady * dt);
    for (int k = 0; k < MPS__LAYERS; k++, rate *= RATIO) {
        const double weight = k < 3 ? FIRST[k] : 2 / PI * log(RATIO) * sqrt(rate);
        const double z = rate * scale * dt;
        layers->keep[k] = exp(-z);
        layers->rise[k] = z * phi2(z);
        layers->pull[k] = scale * weight * phi1(z);
        layers->energy[k] = weight / (2 * rate);
        drag += layers->pull[k];
        added += scale * dt * weight * phi2(z);
    }
    layers->drag = drag;
    layers->added = added;
}
