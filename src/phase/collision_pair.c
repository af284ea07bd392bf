/* SPDX-License-Identifier: BSD-3-Clause */
/* Collisions, W22 (24)(25): pairs of fluid particles nearer than a distance that approach exchange momentum along their
 * line; a fluid particle nearer than a distance to a wall loses the normal part of its approach. All pairs see the
 * velocities before the collisions, so that the order of particles does not matter; momentum of pairs is conserved. */
#include "walls.h"

enum { DISTANCE, RESTITUTION, WALL_DISTANCE };
static const mps_setting settings[] = {{"distance", 0.6, 0.0, 1.5}, {"restitution", 0.5, 0.0, 1.0}, {"wall_distance", 0.5, 0.0, 1.5}};

/* W/r^2 of pairs nearer than a distance is more than this: what spares most pairs a look at where they are. */
static double least_weight(const mps_stencil *t, double distance)
{
    if (t->kernel.id == MPS_KERNEL_CUSTOM || !(distance < t->re)) return -1;
    return (mps_kernel_weight(&t->kernel, distance, t->re) - 1e-9) / (distance * distance);
}

/* Change of velocity of i by its fluid neighbours. @return whether it has solid ones too */
MPS__ROW bool fluid_pairs(const int dim, const double *k, const mps_stage *stage, double least, int64_t i, double du[3])
{
    const mps_stage copy = *stage, *s = &copy;
    const mps_stencil near = *s->near, *t = &near;
    const double reach = k[DISTANCE] * s->dp, reach2 = reach * reach;
    bool solids = false;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID) {
            solids = true;
            continue;
        }
        if (t->w_r2[p] < least) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.r2 >= reach2) continue;
        double approach = 0; /* rate of separation times distance */
        for (int d = 0; d < dim; d++) approach += (s->u[j * dim + d] - s->u[i * dim + d]) * q.d[d];
        if (approach >= 0) continue;
        const double share = (1.0 + k[RESTITUTION]) * s->density[j] / (s->density[i] + s->density[j]);
        for (int d = 0; d < dim; d++) du[d] += share * approach / q.r2 * q.d[d];
    }
    return solids;
}

MPS__ROW void collide(const int dim, const double *k, const mps_stage *s, double least, int64_t i, double *change)
{
    const double *u = s->u + i * dim;
    double du[3] = {0}, v[3];
    const bool solids = fluid_pairs(dim, k, s, least, i, du);
    for (int d = 0; d < dim; d++) v[d] = u[d] + du[d];
    if (solids) mps__walls_keep_off(s, k[WALL_DISTANCE] * s->dp, 0, s->u, i, v);
    for (int d = 0; d < dim; d++) change[i * dim + d] = v[d] - u[d];
}

static int velocity(void *self, const double *k, mps_stage *s)
{
    (void)self;
    double *change = mps_stage_scratch(s, s->n * s->dim);
    const double least = least_weight(s->near, k[DISTANCE] * s->dp);
    if (!change) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) MPS__ROW_CALL(s, collide, k, s, least, i, change);
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
