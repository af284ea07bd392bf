/* SPDX-License-Identifier: BSD-3-Clause */
/* Nothing is carried through walls: a particle near the face of one loses the part of a vector that points into it. */
#include "walls.h"

/* In an acute corner what one face leaves over goes into the other: so often they take turns. */
enum { TURNS = 4 };

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

/* Does the wall `other`, next to the particle, rise over the face of `wall`, on the side of the particle? */
MPS__ROW bool rises(const int dim, const mps_stage *s, const mps_pair *wall, const double n[3], double height, const mps_pair *other)
{
    double rise = 0, along = 0;
    for (int d = 0; d < dim; d++) {
        const double line = other->d[d] - wall->d[d];
        rise += line * n[d];
        along -= line * (wall->d[d] + height * n[d]);
    }
    return other->r2 < 2.5 * s->dp * s->dp && rise > 0.25 * s->dp && along > 0;
}

/* In a concave corner a face goes on to where another rises from it. The particles there have one normal for all faces, or that of the solid
 * which was there first, or a plate that starts between them hides them. */
MPS__ROW bool goes_on(const int dim, const mps_stage *s, int64_t i, const mps_pair *wall, const double n[3], double height)
{
    const mps_stencil *t = s->near;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_WALL) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (rises(dim, s, wall, n, height, &q)) return true;
    }
    return false;
}

/* Is wall j, whose face looks along n, in the way? A face is met along its normal, not along the line to its particle, so that films slide. */
MPS__ROW bool in_way(const int dim, const mps_stage *s, double reach, int64_t i, const mps_pair *q, const double n[3])
{
    const double height = height_over(dim, q, n), aside2 = q->r2 - height * height, square = s->dp * s->dp;
    return aside2 <= 0.6 * square || (height > -reach && aside2 <= 2 * square && goes_on(dim, s, i, q, n, height));
}

/* What mps__walls_keep_off() was asked for. */
typedef struct task {
    double reach, lift;
    const double *u;
} task;

/* How fast a particle has to move away from a face at least: it is let out of the half next to the wall. */
static inline double outward(const task *k, double height)
{
    return height > -k->reach && height < 0.5 * k->reach ? fmin(k->lift, 0.5 * k->reach - height) : 0;
}

/* One turn of all walls. @return whether v has changed */
MPS__ROW bool turn(const int dim, const mps_stage *s, const task *k, int64_t i, double v[3])
{
    const mps_stencil *t = s->near;
    bool changed = false;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->kind[t->col[p]] != MPS_WALL) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double n[3], vn = 0;
        if (!away(dim, s, &q, n) || height_over(dim, &q, n) >= k->reach) continue;
        const double least = outward(k, height_over(dim, &q, n));
        for (int d = 0; d < dim; d++) vn += (v[d] - (k->u ? k->u[q.j * dim + d] : 0)) * n[d];
        if (vn >= least || !in_way(dim, s, k->reach, i, &q, n)) continue;
        for (int d = 0; d < dim; d++) v[d] += (least - vn) * n[d];
        changed = true;
    }
    return changed;
}

void mps__walls_keep_off(const mps_stage *s, double reach, double lift, const double *u, int64_t i, double v[3])
{
    const task asked = {reach, lift, u};
    for (int k = 0; k < TURNS; k++)
        if (!MPS__ROW_CALL(s, turn, s, &asked, i, v)) return;
}
