/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernels made by scripts/device_rows, as text of NVIDIA's virtual machine (PTX). */
#ifndef MPS_CUDA_ROWS_H
#define MPS_CUDA_ROWS_H

extern const char mps__cuda_rows[]; /* terminated by 0 */

#endif
