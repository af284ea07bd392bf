/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 3: kernels and operators are public, see mps/operators.h; nothing private is needed above them. */
#ifndef MPS_CORE_OPERATORS_H
#define MPS_CORE_OPERATORS_H

#include "base.h"
#include <math.h>
#include <mps/operators.h>

#endif
