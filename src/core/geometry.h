/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 8: particles on the lattice of a tank. Arguments are checked by the public functions, see api_geometry.c. */
#ifndef MPS_CORE_GEOMETRY_H
#define MPS_CORE_GEOMETRY_H

#include "sim.h"
#include <mps/geometry.h>

/* Lattice points first..last (both included) of the lattice lo + k dp, in the tank's frame. */
typedef struct mps__lattice_box {
    double lo[3];
    int64_t first[3], last[3];
} mps__lattice_box;

/* Lattice points of the closed box lo..hi that lie in the last tank; false if there is none. */
bool mps__lattice_clip(const mps_sim *sim, const double *lo, const double *hi, mps__lattice_box *box);
mps_status mps__geometry_tank(mps_sim *sim, const mps_tank *tank, const int64_t cells[3]);
mps_status mps__geometry_baffle(mps_sim *sim, const char *name, const mps__lattice_box *box);
/* `inside` may be NULL: all points. */
mps_status mps__geometry_fill(mps_sim *sim, int32_t phase, const mps__lattice_box *box, mps_inside_fn inside, void *user, int64_t *added);

#endif
