/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernels that scripts/device_rows makes, as text of NVIDIA's virtual machine (PTX). */
#ifndef MPS_CUDA_ROWS_H
#define MPS_CUDA_ROWS_H

extern const char mps__cuda_rows[]; /* ends with a 0 */

#endif
