/* SPDX-License-Identifier: BSD-3-Clause */
/* Collisions, W22 (24)(25): pairs of fluid particles nearer than a distance that approach exchange momentum along their
 * line; a fluid particle nearer than a distance to a wall loses the normal part of its approach. All pairs see the
 * velocities before the collisions, so that the order of particles does not matter; momentum of pairs is conserved. */
#include "walls.h"

enum { DISTANCE, RESTITUTION, WALL_DISTANCE };
static const mps_setting settings[] = {{"distance", 0.6, 0.0, 1.5}, {"restitution", 0.5, 0.0, 1.0}, {"wall_distance", 0.5, 0.0, 1.5}};

/* Change of velocity of i by its fluid neighbours. */
MPS__ROW void fluid_pairs(const int dim, const double *k, const mps_stage *s, int64_t i, double du[3])
{
    const mps_stencil *t = s->near;
    const double reach = k[DISTANCE] * s->dp, reach2 = reach * reach;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.r2 >= reach2) continue;
        double approach = 0; /* rate of separation times distance */
        for (int d = 0; d < dim; d++) approach += (s->u[j * dim + d] - s->u[i * dim + d]) * q.d[d];
        if (approach >= 0) continue;
        const double share = (1.0 + k[RESTITUTION]) * s->density[j] / (s->density[i] + s->density[j]);
        for (int d = 0; d < dim; d++) du[d] += share * approach / q.r2 * q.d[d];
    }
}

MPS__ROW void collide(const int dim, const double *k, const mps_stage *s, int64_t i, double *change)
{
    const double *u = s->u + i * dim;
    double du[3] = {0}, v[3];
    fluid_pairs(dim, k, s, i, du);
    for (int d = 0; d < dim; d++) v[d] = u[d] + du[d];
    mps__walls_keep_off(s, k[WALL_DISTANCE] * s->dp, 0, s->u, i, v);
    for (int d = 0; d < dim; d++) change[i * dim + d] = v[d] - u[d];
}

static int velocity(void *self, const double *k, mps_stage *s)
{
    (void)self;
    double *change = mps_stage_scratch(s, s->n * s->dim);
    if (!change) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, collide, k, s, i, change);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n * s->dim; i++) s->u[i] += change[i];
    return 0;
}

const mps_model_ops mps__collision_pair = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "collision.pair",
                                           .order = 700,
                                           .setting_count = 3,
                                           .settings = settings,
                                           .velocity = velocity};
