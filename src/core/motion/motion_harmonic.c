/* SPDX-License-Identifier: BSD-3-Clause */
/* Harmonic motion: a sum of A sin(w t + phase) and -A (1 - cos w t), each with an optional ramp. */
#include "angles.h"
#include "builtin_motion.h"
#include <math.h>
#include <string.h>

typedef struct harmonic_set {
    int32_t count;
    mps_harmonic item[];
} harmonic_set;

/* Ratio of the amplitude to its final value, and its first two derivatives. */
static void grow(double ramp, double t, double f[3])
{
    const double x = t < ramp ? fmax(t, 0) / ramp : 1, rest = 1 - x;
    f[0] = x * x * x * (10 - 15 * x + 6 * x * x);
    f[1] = t < ramp ? 30 * x * x * rest * rest / ramp : 0;
    f[2] = t < ramp ? 60 * x * rest * (rest - x) / ramp / ramp : 0;
}

/* -A (1 - cos w t) = A sin(w t + pi/2) - A, in the form that is exact at t = 0. */
static void swing(const mps_harmonic *h, double t, double q[3])
{
    double a = h->amplitude, w = h->omega, angle = h->form == 1 ? w * t : w * t + h->phase;
    double sine = mps__sin(angle), cosine = mps__cos(angle);
    if (h->form == 1) {
        double half = mps__sin(0.5 * angle);
        q[0] = -2 * a * half * half;
        q[1] = -a * w * sine;
        q[2] = -a * w * w * cosine;
    } else {
        q[0] = a * sine;
        q[1] = a * w * cosine;
        q[2] = -a * w * w * sine;
    }
}

static void add_harmonic(const mps_harmonic *h, double t, mps_motion_state *s)
{
    double f[3], q[3];
    grow(h->ramp, t, f);
    swing(h, t, q);
    s->value[h->dof] += f[0] * q[0];
    s->rate[h->dof] += f[1] * q[0] + f[0] * q[1];
    s->accel[h->dof] += f[2] * q[0] + 2 * f[1] * q[1] + f[0] * q[2];
}

void *mps__motion_harmonic_create(const mps_allocator *allocator, int32_t count,
                                  const mps_harmonic *harmonics)
{
    size_t bytes = (size_t)count * sizeof *harmonics;
    harmonic_set *set = allocator->alloc(allocator->user, sizeof *set + bytes);
    if (!set) return NULL;
    set->count = count;
    memcpy(set->item, harmonics, bytes);
    return set;
}

int mps__motion_harmonic(void *user, double t, mps_motion_state *state)
{
    const harmonic_set *set = user;
    for (int32_t k = 0; k < set->count; k++) add_harmonic(&set->item[k], t, state);
    return 0;
}

double mps__motion_harmonic_longest(const void *user, double t, double dt)
{
    const harmonic_set *set = user;
    const double circle = 6.283185307179586, steps = 20;
    double shortest = INFINITY;
    (void)dt;
    for (int32_t k = 0; k < set->count; k++) {
        const mps_harmonic *h = &set->item[k];
        if (h->amplitude == 0) continue;
        if (h->omega > 0) shortest = fmin(shortest, circle / h->omega);
        if (t < h->ramp) shortest = fmin(shortest, h->ramp);
    }
    return shortest / steps;
}
