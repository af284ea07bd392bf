/* SPDX-License-Identifier: BSD-3-Clause */
/* Collisions, W22 (24)(25): pairs of fluid particles nearer than a distance that approach exchange momentum along their
 * line; a fluid particle nearer than a distance to a wall loses the normal part of its approach. All pairs see the
 * velocities before the collisions, so that the order of particles does not matter; momentum of pairs is conserved. */
#include "builtin.h"
#include <stdbool.h>

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

/* Unit normal of wall j. @return its area; 0: it has no normal */
MPS__ROW double normal(const int dim, const mps_stage *s, int64_t j, double n[3])
{
    const double *area = s->area + j * dim;
    double size = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    size = sqrt(size);
    for (int d = 0; d < dim; d++) n[d] = size > 0 ? area[d] / size : 0;
    return size;
}

/* Direction away from wall j, if it has one. The edge of a thin plate has a normal, but no face: it is a round post. */
MPS__ROW bool away(const int dim, const mps_stage *s, const mps_pair *q, double n[3])
{
    const double size = normal(dim, s, q->j, n), least = 1e-4 * (dim == 2 ? s->dp : s->dp * s->dp);
    for (int d = 0; d < dim && size < least; d++) n[d] = -q->d[d] / q->r;
    return size > 0;
}

MPS__ROW double height_over(const int dim, const mps_pair *q, const double n[3])
{
    double height = 0;
    for (int d = 0; d < dim; d++) height -= q->d[d] * n[d];
    return height;
}

/* Is wall j in the way, if its face looks along n? A face is met along its normal, not along the line to its particle, so that films slide. */
MPS__ROW bool in_way(const int dim, const double *k, const mps_stage *s, const mps_pair *q, const double n[3])
{
    const double height = height_over(dim, q, n);
    return height < k[WALL_DISTANCE] * s->dp && q->r2 - height * height <= 0.6 * s->dp * s->dp;
}

/* Does a wall whose face looks along n stand on another, `foot`, straight before it? */
MPS__ROW bool stands_on(const int dim, const mps_stage *s, const mps_pair *wall, const double n[3], const mps_pair *foot)
{
    double up[3], length2 = 0, rise = 0, aside = 0;
    if (normal(dim, s, foot->j, up) == 0) return false;
    for (int d = 0; d < dim; d++) {
        const double line = wall->d[d] - foot->d[d];
        length2 += line * line;
        rise += line * up[d];
        aside += line * n[d];
    }
    return length2 < 2.5 * s->dp * s->dp && rise > 0.99 * sqrt(length2) && fabs(aside) < 0.1 * s->dp;
}

/* Solids that touch share particles, and these have the normal of the solid that was there first. So the face of a wall of the other one
 * goes on to the particle the wall stands on: is that in the way? */
MPS__ROW bool foot_in_way(const int dim, const double *k, const mps_stage *s, int64_t i, const mps_pair *wall, const double n[3])
{
    const mps_stencil *t = s->near;
    if (fabs(height_over(dim, wall, n)) >= k[WALL_DISTANCE] * s->dp) return false;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_WALL) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (in_way(dim, k, s, &q, n) && stands_on(dim, s, wall, n, &q)) return true;
    }
    return false;
}

/* Take away what carries i into walls. */
MPS__ROW void walls(const int dim, const double *k, const mps_stage *s, int64_t i, double du[3])
{
    const mps_stencil *t = s->near;
    const double reach = k[WALL_DISTANCE] * s->dp;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_WALL) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double n[3], un = 0;
        if (!away(dim, s, &q, n) || height_over(dim, &q, n) >= reach) continue;
        for (int d = 0; d < dim; d++) un += (s->u[i * dim + d] + du[d] - s->u[q.j * dim + d]) * n[d];
        if (un >= 0 || !(in_way(dim, k, s, &q, n) || foot_in_way(dim, k, s, i, &q, n))) continue;
        for (int d = 0; d < dim; d++) du[d] -= un * n[d];
    }
}

MPS__ROW void collide(const int dim, const double *k, const mps_stage *s, int64_t i, double *change)
{
    double du[3] = {0};
    fluid_pairs(dim, k, s, i, du);
    walls(dim, k, s, i, du);
    for (int d = 0; d < dim; d++) change[i * dim + d] = du[d];
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
