/* SPDX-License-Identifier: BSD-3-Clause */
/* Detects boxes that are thin plates. */
#include "geometry.h"
#include <math.h>

/* A point nearer to a wall than this [dp] coincides with it. */
static const double same = 0.3;

/* Fraction of the points of a box's face, or of those `beyond` it, that are walls. */
static double covered(mps_sim *sim, const mps__lattice_box *box, int axis, int64_t at)
{
    const mps__particles *s = &sim->world.particles;
    double points = 1, walls = 0;
    for (int d = 0; d < s->dim; d++)
        points *= d == axis ? 1 : (double)(box->last[d] - box->first[d] + 1);
    for (int64_t i = 0; i < s->n; i++) {
        bool there = s->kind[i] == MPS_WALL;
        for (int d = 0; there && d < s->dim; d++) {
            const double q = (s->ref[i * s->dim + d] - box->lo[d]) / box->h[d];
            there = d == axis ? fabs(q - (double)at) < same
                              : q > (double)box->first[d] - same && q < (double)box->last[d] + same;
        }
        walls += there;
    }
    return walls / points;
}

/* A box on a wall is a step of it, not a plate. */
static bool lies_on_wall(mps_sim *sim, const mps__lattice_box *box, int axis)
{
    for (int64_t beyond = 0; beyond < 2; beyond++)
        if (covered(sim, box, axis, box->first[axis] - beyond) > 0.5 ||
            covered(sim, box, axis, box->last[axis] + beyond) > 0.5)
            return true;
    return false;
}

static int thinnest(const mps__lattice_box *box, int dim)
{
    int axis = 0;
    for (int d = 1; d < dim; d++)
        if (box->last[d] - box->first[d] < box->last[axis] - box->first[axis]) axis = d;
    return axis;
}

bool mps__plate_of_box(mps_sim *sim, const mps__lattice_box *box, mps__plate_shape *shape)
{
    const int dim = sim->world.setup.dim, axis = thinnest(box, dim);
    int e = 0;
    *shape = (mps__plate_shape){.axis = axis,
                                .nodes = {1, 1},
                                .spacing = {sim->world.setup.dp, sim->world.setup.dp},
                                .across = box->h[axis]};
    if (box->last[axis] - box->first[axis] > 2 || lies_on_wall(sim, box, axis)) return false;
    shape->columns = (int32_t)(box->last[axis] - box->first[axis]) + 1;
    shape->normal[axis] = 1;
    for (int d = 0; d < dim; d++) {
        const double middle = d == axis ? 0.5 * (double)(box->first[d] + box->last[d])
                                        : (double)box->first[d];
        shape->corner[d] = box->lo[d] + middle * box->h[d];
        if (d == axis) continue;
        shape->along[e][d] = 1;
        shape->spacing[e] = box->h[d];
        shape->nodes[e++] = box->last[d] - box->first[d] + 1;
    }
    return true;
}
