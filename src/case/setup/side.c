/* SPDX-License-Identifier: BSD-3-Clause */
/* On which side of walls of any shape a position is, as built. */
#include "build.h"
#include <math.h>

static double square_of(const double *x, const double *y, int32_t dim)
{
    double sum = 0;
    for (int32_t d = 0; d < dim; d++) sum += (x[d] - y[d]) * (x[d] - y[d]);
    return sum;
}

bool mps__wall_behind(build *b, const double *x, int32_t *part)
{
    mps_lease at = {.struct_size = sizeof at}, kind = at, tag = at, plate = at;
    bool good = mps_lease_begin(b->sim, "position", MPS_READ, &at) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "kind", MPS_READ, &kind) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "part", MPS_READ, &tag) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "plate", MPS_READ, &plate) == MPS_OK;
    double least = INFINITY;
    bool behind = false; /* the nearest particle of a solid is no wall: it is behind one */
    for (int64_t i = 0; good && i < at.count; i++) {
        if (kind.integers[i] == MPS_FLUID || plate.integers[i] > 0) continue;
        const double square = square_of(x, at.data + i * at.stride, b->dim);
        if (square >= least) continue;
        least = square;
        behind = kind.integers[i] == MPS_DUMMY;
        *part = tag.integers[i];
    }
    mps_lease_end(b->sim, &plate);
    mps_lease_end(b->sim, &tag);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &at);
    return behind;
}
