/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls of the papers: wall particles take part in the pressure equation, dummies get the kernel mean of the fluid and wall
 * pressures about them and no equation of their own. */
#include "builtin.h"

/* Solids have no density of their own: beside gas they must not be as heavy as water. */
static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self, (void)k;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] != MPS_FLUID) s->density_smooth[i] = mps__density_beside(s, i);
    return 0;
}

/* Before the gradient: pressures of dummies. */
static int gradient(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self, (void)k, (void)a;
    const mps_stencil *t = s->near;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_DUMMY) continue;
        double sum = 0, weight = 0;
        for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
            const mps_pair q = mps_stencil_pair(t, i, p);
            if (s->kind[q.j] == MPS_DUMMY) continue;
            sum += q.w * s->p[q.j];
            weight += q.w;
        }
        s->p[i] = weight > 0 ? sum / weight : 0;
    }
    return 0;
}

const mps_model_ops mps__wall_extrapolate = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "wall.extrapolate",
                                             .order = 200,
                                             .classify = classify,
                                             .gradient = gradient};
