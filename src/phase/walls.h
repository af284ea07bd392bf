/* SPDX-License-Identifier: BSD-3-Clause */
/* Impermeable walls: near the face of a wall the component of a vector into the wall is removed.
 * Used by the models that change velocities or positions near walls, and inlined into their rows:
 * otherwise a kernel of a device would copy its arguments to memory to pass their addresses. */
#ifndef MPS_PHASE_WALLS_H
#define MPS_PHASE_WALLS_H

#include "helpers.h"

/* In an acute corner the correction for one face points into the other face: iterate. */
enum { MPS__WALL_ITERATIONS = 4 };

/* Unit normal of wall j. Returns its area; 0: no normal. */
MPS_ROW double mps__wall_normal(const int dim, const mps_view *view, int64_t j, double n[3])
{
    const double *area = view->area + j * dim;
    double size = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    size = sqrt(size);
    for (int d = 0; d < dim; d++) n[d] = size > 0 ? area[d] / size : 0;
    return size;
}

/* Direction away from wall j; false if it has none. The edge of a thin plate has a normal, but no
 * face: it acts as a round post. */
MPS_ROW bool mps__wall_away(const int dim, const mps_view *view, const mps_pair *q, double n[3])
{
    const double size = mps__wall_normal(dim, view, q->j, n),
                 least = 1e-4 * (dim == 2 ? view->dp : view->dp * view->dp);
    for (int d = 0; d < dim && size < least; d++) n[d] = -q->d[d] / q->r;
    return size > 0;
}

/* Height of the particle over the face. */
MPS_ROW double mps__wall_height_over(const int dim, const mps_pair *q, const double n[3])
{
    double height = 0;
    for (int d = 0; d < dim; d++) height -= q->d[d] * n[d];
    return height;
}

/* True if the wall particle `other`, next to the fluid particle, is above the face of `wall` and on
 * the side of the fluid particle. */
MPS_ROW bool mps__wall_rises(const int dim, const mps_view *view, const mps_pair *wall,
                             const double n[3], double height, const mps_pair *other)
{
    double rise = 0, along = 0;
    for (int d = 0; d < dim; d++) {
        const double line = other->d[d] - wall->d[d];
        rise += line * n[d];
        along -= line * (wall->d[d] + height * n[d]);
    }
    return other->r2 < 2.5 * view->dp * view->dp && rise > 0.25 * view->dp && along > 0;
}

/* In a concave corner a face extends to the face that rises from it. The wall particles in the
 * corner do not show this: they have one normal for all faces, or the normal of the solid that was
 * added first, or they are hidden by a plate that begins between them. */
MPS_ROW bool mps__wall_continues(const int dim, const mps_view *view, int64_t i,
                                 const mps_pair *wall, const double n[3], double height)
{
    const mps_stencil *t = &view->near;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (!mps_is_wall(view, mps_stencil_column(t, p))) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (mps__wall_rises(dim, view, wall, n, height, &q)) return true;
    }
    return false;
}

/* True if the face of wall j, with normal n, blocks particle i. The distance to a face is measured
 * along its normal, not along the line to its particle, so that films slide. */
MPS_ROW bool mps__wall_in_way(const int dim, const mps_view *view, double reach, int64_t i,
                              const mps_pair *q, const double n[3])
{
    const double height = mps__wall_height_over(dim, q, n), aside2 = q->r2 - height * height;
    const double square = view->dp * view->dp;
    if (aside2 <= 0.6 * square) return true;
    return height > -reach && aside2 <= 2 * square &&
           mps__wall_continues(dim, view, i, q, n, height);
}

/* Arguments of mps__walls_keep_off(). */
typedef struct mps__wall_task {
    double reach, lift;
    const double *u;
} mps__wall_task;

/* Smallest component of v away from a face: it moves a particle out of the half next to the
 * wall. */
static inline double mps__wall_outward(const mps__wall_task *k, double height)
{
    if (!(height > -k->reach && height < 0.5 * k->reach)) return 0;
    return mps_smaller(k->lift, 0.5 * k->reach - height);
}

/* Corrects v once for each wall. Returns whether v was changed. */
MPS_ROW bool mps__wall_correct(const int dim, const mps_view *view, const mps__wall_task *k,
                               int64_t i, double v[3])
{
    const mps_stencil *t = &view->near;
    bool changed = false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (!mps_is_wall(view, mps_stencil_column(t, p))) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double n[3], vn = 0;
        if (!mps__wall_away(dim, view, &q, n) || mps__wall_height_over(dim, &q, n) >= k->reach)
            continue;
        const double least = mps__wall_outward(k, mps__wall_height_over(dim, &q, n));
        for (int d = 0; d < dim; d++) vn += (v[d] - (k->u ? k->u[q.j * dim + d] : 0)) * n[d];
        if (vn >= least || !mps__wall_in_way(dim, view, k->reach, i, &q, n)) continue;
        for (int d = 0; d < dim; d++) v[d] += (least - vn) * n[d];
        changed = true;
    }
    return changed;
}

/* Removes from v [dim] the part that moves fluid particle i into walls nearer than `reach` [m]. v
 * is a velocity and u [n*dim] contains the velocities of the walls; or v is a displacement and u is
 * NULL. A particle nearer than reach/2 to a face, or behind its plane (it passed over an edge), is
 * moved out by up to `lift` per call. */
MPS_ROW void mps__walls_keep_off(const int dim, const mps_view *view, double reach, double lift,
                                 const double *u, int64_t i, double v[3])
{
    const mps__wall_task asked = {reach, lift, u};
    for (int k = 0; k < MPS__WALL_ITERATIONS; k++)
        if (!mps__wall_correct(dim, view, &asked, i, v)) return;
}

#endif
