/* SPDX-License-Identifier: BSD-3-Clause */
/* Half cells of liquid at wetted walls, which contain no particles. */
#ifndef MPS_CORE_HALF_CELL_H
#define MPS_CORE_HALF_CELL_H

#include "rotation.h"
#include <math.h>
#include <mps/operators.h>
#include <mps/stage.h>
#include <stdbool.h>

typedef struct mps__halves {
    /* by wall particle: density; wetted fraction of the cell, NULL: 1 */
    const double *density, *wetted;
    const int32_t *region;
} mps__halves;

/* Mass of a liquid particle; the liquid ends at the centres of surface particles. */
static inline double mps__cell_mass(const double *density, const int32_t *region, double cell,
                                    int64_t i)
{
    return density[i] * cell * (mps_region_of(region, i) == MPS_REGION_SURFACE ? 0.5 : 1);
}

static inline bool mps__is_about(const mps_view *v, const mps__halves *h, int64_t j)
{
    return mps_is_fluid(v, j) && mps_region_of(h->region, j) != MPS_REGION_SPRAY;
}

/* Fractions of the area of a cell's face: an area vector within a face exceeds the first, those at
 * edges, where two or three faces meet, exceed the second (a corner: sqrt(3)/4). Those of a free
 * edge of a thin plate are smaller. */
static const double MPS__IN_FACE = 0.9, MPS__IN_EDGE = 0.4;

/* Area of the largest of the faces that meet in wall particle i. At an edge its area vector has
 * contributions of each face; its neighbours within the faces have their normals. */
MPS_ROW double mps__face_area(const int dim, const mps_view *v, int64_t i, double size)
{
    const mps_stencil *t = &v->near;
    const double *area = v->area + i * dim, face = dim == 2 ? v->dp : v->dp * v->dp;
    double most = 0;
    if (size >= MPS__IN_FACE * face) return size;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        const double *other = v->area + j * dim;
        double own = 0, along = 0;
        if (!mps_is_wall(v, j)) continue;
        for (int d = 0; d < dim; d++) {
            own += other[d] * other[d];
            along += other[d] * area[d];
        }
        own = sqrt(own);
        if (own >= MPS__IN_FACE * face) most = mps_larger(most, along / own);
    }
    return most > 0 ? most : size * size / face;
}

/* Whether the edge is convex, as that of a block in liquid: neighbouring walls are then behind the
 * particle. */
MPS_ROW bool mps__is_outer(const int dim, const mps_view *v, int64_t i, double size, double face)
{
    const mps_stencil *t = &v->near;
    double sum = 0;
    if (face > 0.8 * size || size < MPS__IN_EDGE * (dim == 2 ? v->dp : v->dp * v->dp)) return false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (!mps_is_wall(v, mps_stencil_column(t, p))) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++) sum += q.w * q.d[d] * v->area[i * dim + d];
    }
    return sum < 0;
}

/* Mass of the half cell at a particle, 0: none; n: unit normal of the wall. The height is dp/2 over
 * one of its faces: where two or three faces meet it is a quarter or an eighth of a cell; at a
 * convex edge the complement. At the free surface the wetted fraction applies, in which surface
 * particles have half a cell. */
MPS_ROW double mps__half_cell(const int dim, const mps_view *v, const mps__halves *h, int64_t i,
                              double n[3])
{
    const mps_stencil *t = &v->near;
    const double *area = v->area + i * dim, cell = dim == 2 ? v->dp * v->dp : v->dp * v->dp * v->dp;
    if (!mps_is_wall(v, i) || mps_region_of(h->region, i) == MPS_REGION_DRY) return 0;
    double size = 0, all = 0, surface = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    size = sqrt(size);
    if (size == 0) return 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps__is_about(v, h, j)) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        all += w;
        if (mps_region_of(h->region, j) == MPS_REGION_SURFACE) surface += w;
    }
    if (!(all > 0)) return 0;
    for (int d = 0; d < dim; d++) n[d] = area[d] / size;
    const double share = surface > 0 && h->wetted ? h->wetted[i] * (1 - 0.5 * surface / all) : 1,
                 face = mps__face_area(dim, v, i, size), volume = 0.5 * v->dp * face;
    const bool outer = mps__is_outer(dim, v, i, size, face);
    return h->density[i] * share * (outer ? cell - volume : volume);
}

/* Accelerations around a half cell: of liquid particle j from a[j*stride] on; of the tank, linear
 * at the wall, and angular. */
typedef struct mps__half_pull {
    const double *a;
    int64_t stride;
    double tank[3], turn[3];
} mps__half_pull;

/* Acceleration of the half cell: along the normal that of the wall, `tank`; along the face the mean
 * of the surrounding liquid, extrapolated to the middle of the cell, dp/4 from the wall.
 * Accelerations by pressure have no curl: normal to a wall, the tangential part changes as the
 * normal part does along the wall, by n x the angular acceleration of the tank. */
MPS_ROW void mps__half_acceleration(const int dim, const mps_view *v, const mps__halves *h,
                                    const mps__half_pull *pull, int64_t i, const double n[3],
                                    double out[3])
{
    const mps_stencil *t = &v->near;
    double weight = 0, away = 0, across = 0, change[3];
    for (int d = 0; d < 3; d++) out[d] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps__is_about(v, h, j)) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        weight += q.w;
        for (int d = 0; d < dim; d++) {
            away += q.w * q.d[d] * n[d];
            out[d] += q.w * pull->a[j * pull->stride + d];
        }
    }
    mps__cross(n, pull->turn, change);
    for (int d = 0; d < dim && weight > 0; d++)
        out[d] = out[d] / weight - (away / weight - 0.25 * v->dp) * change[d];
    for (int d = 0; d < dim; d++) across += n[d] * (pull->tank[d] - out[d]);
    for (int d = 0; d < dim; d++) out[d] += across * n[d];
}

#endif
