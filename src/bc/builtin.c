/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of boundaries. */
#include "builtin.h"

static const mps_model_ops *const all[] = {&mps__surface_asymmetry, &mps__surface_detached, &mps__surface_original, &mps__wall_half, &mps__wall_extrapolate, NULL};

const mps_model_ops *const *mps__builtin_bc(void)
{
    return all;
}
