/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers that several models of boundaries share. */
#ifndef MPS_BC_HELPERS_H
#define MPS_BC_HELPERS_H

#include <mps/model.h>
#include <stdbool.h>

/* Unit vector against gravity; false, and `up` as it was, without gravity. */
bool mps__upward(const mps_view *v, double up[3]);

/* Height of particle i along it [m]. */
double mps__height(const mps_view *v, const double up[3], int64_t i);

#endif
