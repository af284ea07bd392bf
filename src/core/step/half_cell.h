/* SPDX-License-Identifier: BSD-3-Clause */
/* Half cells of liquid before wetted walls, which have no particles. */
#ifndef MPS_CORE_HALF_CELL_H
#define MPS_CORE_HALF_CELL_H

#include <math.h>
#include <mps/operators.h>
#include <mps/stage.h>
#include <stdbool.h>

typedef struct mps__halves {
    const double *density, *wetted; /* of the row of the wall; share of the cell, NULL: all of it */
    const int32_t *region;
    const double *a; /* acceleration of the liquid: of particle j from a[j*stride] on */
    int64_t stride;
} mps__halves;

/* Mass of a particle of the liquid, which ends at the centres of those on the surface. */
static inline double mps__cell_mass(const double *density, const int32_t *region, double cell,
                                    int64_t i)
{
    return density[i] * cell * (mps_region_of(region, i) == MPS_REGION_SURFACE ? 0.5 : 1);
}

static inline bool mps__is_about(const mps_view *v, const mps__halves *h, int64_t j)
{
    return mps_is_fluid(v, j) && mps_region_of(h->region, j) != MPS_REGION_SPRAY;
}

/* Mass of the half cell before a particle, 0: there is none; n: unit normal of the wall. Where faces meet the cell is a quarter, and the area
 * vector is shorter. Beside the surface the wetted share counts. */
MPS_ROW double mps__half_cell(const int dim, const mps_view *v, const mps__halves *h, int64_t i,
                              double n[3])
{
    const mps_stencil *t = &v->near;
    const double *area = v->area + i * dim, face = dim == 2 ? v->dp : v->dp * v->dp;
    bool any = false, surface = false;
    if (!mps_is_wall(v, i) || mps_region_of(h->region, i) == MPS_REGION_DRY) return 0;
    double size = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    size = sqrt(size);
    if (size == 0) return 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps__is_about(v, h, j)) continue;
        any = true;
        surface = surface || mps_region_of(h->region, j) == MPS_REGION_SURFACE;
    }
    for (int d = 0; d < dim; d++) n[d] = area[d] / size;
    const double share = surface && h->wetted ? h->wetted[i] : 1;
    return any ? h->density[i] * share * 0.5 * v->dp * size * mps_smaller(1, size / face) : 0;
}

/* Acceleration of that cell: that of the wall, `tank`, along the normal, and along the face the mean of the liquid about it. */
MPS_ROW void mps__half_acceleration(const int dim, const mps_view *v, const mps__halves *h,
                                    int64_t i, const double *tank, const double n[3], double out[3])
{
    const mps_stencil *t = &v->near;
    double weight = 0, across = 0;
    for (int d = 0; d < 3; d++) out[d] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps__is_about(v, h, j)) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        weight += q.w;
        for (int d = 0; d < dim; d++) out[d] += q.w * h->a[j * h->stride + d];
    }
    for (int d = 0; d < dim && weight > 0; d++) out[d] /= weight;
    for (int d = 0; d < dim; d++) across += n[d] * (tank[d] - out[d]);
    for (int d = 0; d < dim; d++) out[d] += across * n[d];
}

#endif
