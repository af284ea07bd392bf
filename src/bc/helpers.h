/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers of the models of boundaries. */
#ifndef MPS_BC_HELPERS_H
#define MPS_BC_HELPERS_H

#include <mps/model.h>
#include <stdbool.h>

/* Unit vector against gravity. Without gravity: false, and `up` is not changed. */
bool mps__upward(const mps_view *v, double up[3]);

/* Height of particle i along `up` [m]. */
double mps__height(const mps_view *v, const double up[3], int64_t i);

#endif
