/* SPDX-License-Identifier: BSD-3-Clause */
/* List of the built-in models of the fluid. */
#include "builtin.h"

static const mps_model_ops *const all[] = {&mps__viscosity_laplacian, &mps__source_mixed, &mps__gradient_conservative, &mps__collision_pair, NULL};

const mps_model_ops *const *mps__builtin_phase(void) { return all; }
