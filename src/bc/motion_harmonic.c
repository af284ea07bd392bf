/* SPDX-License-Identifier: BSD-3-Clause */
/* Harmonic motion: a sum of A sin(w t + phase) and -A (1 - cos w t). */
#include "builtin_motion.h"
#include <math.h>
#include <string.h>

typedef struct harmonic_set {
    int32_t count;
    mps_harmonic item[];
} harmonic_set;

/* -A (1 - cos w t) = A sin(w t + pi/2) - A, in the form that is exact at t = 0. */
static void add_harmonic(const mps_harmonic *h, double t, mps_motion_state *s)
{
    double a = h->amplitude, w = h->omega, angle = h->form == 1 ? w * t : w * t + h->phase;
    double sine = sin(angle), cosine = cos(angle);
    if (h->form == 1) {
        double half = sin(0.5 * angle);
        s->value[h->dof] -= 2 * a * half * half;
        s->rate[h->dof] -= a * w * sine;
        s->accel[h->dof] -= a * w * w * cosine;
    } else {
        s->value[h->dof] += a * sine;
        s->rate[h->dof] += a * w * cosine;
        s->accel[h->dof] -= a * w * w * sine;
    }
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
