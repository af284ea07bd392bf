/* SPDX-License-Identifier: BSD-3-Clause */
/* What touches no wall falls freely. Pressures are reckoned from those of a fluid that moves with the tank, b = g - a_tank, which is exact
 * where the tank holds the fluid. In a drop nothing does, and where the eigenvalues of M_i are bounded (moments.bounded) gradients give back
 * only part of b: drops of some ten particles fell at 0.6-0.95 g, and a tank took drops along that it did not touch. So in a body of fluid
 * without a wetted wall about it a_tank is g, b = 0. In large bodies few particles are bounded: those of more than LARGE are not followed. */
#include "builtin.h"

enum { NOT_SEEN, FREE, HELD, LARGE = 1000 };

/* Particles of a body in the order in which they were found. */
typedef struct body {
    double *particle, *state; /* [n] */
    int64_t count;
} body;

static inline void join(body *k, int64_t i)
{
    k->state[i] = FREE;
    k->particle[k->count++] = (double)i;
}

/* Look at the neighbours of particle i. @return whether one of them holds the body; those not seen before belong to it */
static bool is_held(const mps_stage *s, int64_t i, body *k)
{
    const mps_stencil *t = s->near;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->region[j] >= MPS_REGION_SPRAY) continue;
        if (s->kind[j] != MPS_FLUID || k->state[j] == HELD) return true;
        if (k->state[j] == NOT_SEEN) join(k, j);
    }
    return false;
}

/* The body about the surface particle `seed`, as far as needed to know whether it is free. */
static void explore(mps_stage *s, int64_t seed, body *k)
{
    bool held = false;
    k->count = 0;
    join(k, seed);
    for (int64_t next = 0; next < k->count && !held; next++) held = is_held(s, (int64_t)k->particle[next], k) || k->count > LARGE;
    for (int64_t m = 0; m < k->count; m++) {
        const int64_t i = (int64_t)k->particle[m];
        if (held) k->state[i] = HELD;
        for (int d = 0; d < s->dim && !held; d++) s->tank_accel[i * s->dim + d] = s->g[d];
    }
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self, (void)k;
    body b = {mps_stage_scratch(s, s->n), mps_stage_scratch(s, s->n), 0};
    if (!b.particle || !b.state) return 1;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->region[i] == MPS_REGION_SURFACE && b.state[i] == NOT_SEEN) explore(s, i, &b);
    return 0;
}

const mps_model_ops mps__body_free = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "body.free", .order = 240, .classify = classify};
