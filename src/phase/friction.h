/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction at walls: the velocity of a dummy as used for fluid in front of the wall, such that the
 * velocity relative to the tank is 0 on the face of the wall (no slip). With the dummies' own
 * velocity a linear profile is 0 at 0.2 dp behind the face (far radius 3.1 dp). */
#ifndef MPS_PHASE_FRICTION_H
#define MPS_PHASE_FRICTION_H

#include "helpers.h"

/* Distance from the face [dp] below which the mirror velocity of a particle is reduced: there the
 * wall particles themselves give the no-slip condition. */
static const double mps__mirror_near = 0.5;

/* Velocity of dummy j less that of fluid particle i. The dummy has the opposite of i's velocity
 * relative to the tank, times the ratio of their distances from the face of j's wall. The tank's
 * velocity at i is extrapolated from wall and dummy, so that rigid rotation with the tank is no
 * shear. Its rotation about the normal is omitted: it cancels over the dummies around i.
 * velocity: [n*dim] the channel. */
MPS_ROW void mps__mirror_velocity(const int dim, const mps_view *view, const double *velocity,
                                  int64_t i, int64_t j, double du[3])
{
    const int64_t w = view->wall_of[j];
    const double *u = velocity + i * dim, *v = velocity + j * dim;
    for (int d = 0; d < dim; d++) du[d] = v[d] - u[d];
    if (w < 0) return;
    double size = 0, above = 0, below = 0, apart = 0, turn = 0, ahead = 0;
    /* relative to the wall: dummy, fluid; dummy's velocity less the wall's */
    double r[3], h[3], dv[3];
    for (int d = 0; d < dim; d++) {
        const double area = view->area[w * dim + d];
        r[d] = view->x[j * dim + d] - view->x[w * dim + d];
        h[d] = view->x[i * dim + d] - view->x[w * dim + d];
        dv[d] = v[d] - velocity[w * dim + d];
        size += area * area;
        above += area * h[d];
        below -= area * r[d];
        apart += r[d] * r[d];
        turn += dv[d] * h[d];
        ahead += r[d] * h[d];
    }
    if (!(size > 0 && apart > 0 && above > 0 && below > 0)) return;
    const double over = 1.0 / sqrt(size), near = mps__mirror_near * view->dp, y = above * over;
    const double ratio = below * over * y / (y > near ? y * y : near * near);
    /* Omega x h with Omega = r x dv / r^2 is (dv (r.h) - r (dv.h))/r^2 */
    for (int d = 0; d < dim; d++) {
        const double spin = (dv[d] * ahead - r[d] * turn) / apart;
        du[d] -= ratio * (u[d] - velocity[w * dim + d] - spin);
    }
}

#endif
