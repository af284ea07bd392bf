/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall particles as half cells: the wall row is the mirrored lattice cut in two, so that fluid pairs count once, wall-wall pairs
 * half, and dummies drop out (their mirror partner is the particle itself). Exact on a lattice, in corners too.
 * A wall particle takes part as far as fluid lies about it: wet = kernel sum of the fluid over that of a full half space. */
#include "builtin.h"

static const double NEARLY = 0.7;

/* Fluid stands before a face if it is so far above its plane, over dp. */
static const double ABOVE = 0.1;

/* Kernel sum over a half lattice without its boundary row. */
static double half_sum(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, depth = t->dim == 3 ? reach : 0;
    double sum = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = 1; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum += mps_kernel_weight(&t->kernel, r, t->re);
            }
    return sum;
}

/* Kernel sum over the fluid. Spray does not count: a wall particle left with other walls alone would make the system singular. Nor does fluid that
 * is all behind the plane of the face: beyond an edge a wall would take the pressure of liquid in front of the other face. */
MPS__ROW double fluid_sum(const int dim, const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    const double *area = s->area + i * dim;
    double sum = 0, size = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    bool before = size == 0;
    const double least = ABOVE * s->dp * sqrt(size);
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->region[j] == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double height = 0;
        for (int d = 0; d < dim; d++) height += q.d[d] * area[d];
        before = before || height > least;
        sum += q.w;
    }
    return before ? sum : 0;
}

/* Density of the fluid beside a wall particle: that of the nearest, and of others as far as they are hardly farther away (W/r^2 more than
 * `NEARLY` of the nearest one's, some 7 % in distance). With the nearest one's alone its row would turn from gas to water within a step where a
 * wave runs up the wall, and its pressure with it. Counting those farther away moves the pressures of a still tank by 0.1 % of rho g h. */
MPS__ROW double density_beside(const int dim, const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    double nearest = 0, rho = s->density[i], sum = 0, weight = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->region[j] == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.w_r2 <= nearest) continue;
        nearest = q.w_r2;
        rho = s->density[j];
    }
    for (int64_t p = t->begin[i]; p < t->end[i] && nearest > 0; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->region[j] == MPS_REGION_SPRAY) continue;
        const double nearly = fmax(0, mps_stencil_pair_dim(dim, t, i, p).w_r2 / nearest - NEARLY);
        sum += nearly * nearly * (s->density[j] - rho);
        weight += nearly * nearly;
    }
    return weight > 0 ? rho + sum / weight : rho;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self, (void)k;
    const double full = half_sum(s->near);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL) continue;
        const double sum = MPS__ROW_CALL(s, fluid_sum, s, i);
        s->wet[i] = sum < full ? sum / full : 1.0;
        if (sum == 0) s->region[i] = MPS_REGION_DRY;
        s->density_smooth[i] = MPS__ROW_CALL(s, density_beside, s, i);
    }
    return 0;
}

/* Wall-wall pairs of the pressure equation. */
static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self, (void)k, (void)s;
    terms->wall_factor = 0.5;
    return 0;
}

const mps_model_ops mps__wall_half = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "wall.half", .order = 200, .classify = classify, .source = source};
