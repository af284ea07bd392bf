/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of the fluid. */
#include "builtin.h"

static const mps_model_ops *const all[] = {
    &mps__moments_bounded,       &mps__viscosity_laplacian, &mps__dissipation_radial, &mps__source_mixed,     &mps__source_volume,
    &mps__gradient_conservative, &mps__gradient_corrected,  &mps__collision_pair,     &mps__shift_tangential, NULL};

const mps_model_ops *const *mps__builtin_phase(void)
{
    return all;
}
