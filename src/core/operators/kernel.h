/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of kernels, with an error text if they are undefined. */
#ifndef MPS_CORE_KERNEL_H
#define MPS_CORE_KERNEL_H

#include "base.h"
#include <mps/operators.h>

/* As mps_lattice_constants(). */
mps_status mps__kernel_lattice(mps__context *c, const mps_kernel *kernel, int32_t dim, double dp,
                               double re, double *n0, double *lambda);

#endif
