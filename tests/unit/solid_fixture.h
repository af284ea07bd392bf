/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes, shared by the tests of solids. */
#ifndef SOLID_FIXTURE_H
#define SOLID_FIXTURE_H

#include "sim.h"
#include "tank_fixture.h"
#include <stdio.h>

static const double pi = 3.14159265358979323846;

/* ---- shapes, all about the origin: > 0 within a unit circle, sphere, cylinder; a box ---- */

static inline double ball(void *user, const double *x)
{
    const int dim = *(const int *)user;
    return 1 - sqrt(x[0] * x[0] + x[1] * x[1] + (dim == 3 ? x[2] * x[2] : 0));
}

static int three = 3, two = 2;

static inline mps_solid solid_of(mps_distance_fn distance, mps_inside_fn inside, void *user,
                                 double size)
{
    mps_solid s;
    assert_int_equal(mps_solid_init(&s, sizeof s), MPS_OK);
    s.distance = distance;
    s.inside = inside;
    s.user = user;
    for (int d = 0; d < 3; d++) {
        s.lo[d] = -size;
        s.hi[d] = size;
    }
    return s;
}

#endif
