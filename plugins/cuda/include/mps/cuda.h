/* SPDX-License-Identifier: BSD-3-Clause */
/** @file cuda.h  Plug-in library libmps_cuda: runs the time steps of a handle on a GPU of NVIDIA.
 *
 *      mps_sim_create(&config, &sim);
 *      mps_cuda_use(sim, 0);
 *      ... build and step as without a GPU ...
 *      mps_sim_destroy(sim);
 *
 *  The library opens the driver, libcuda.so.1, when a GPU is requested; building the library or its
 *  users does not need CUDA. It needs a driver of CUDA 9 or newer and a GPU of compute capability
 *  6.0 or newer. Double precision is fast on the classes P100, V100, A100 and H100; other GPUs run
 *  at 1/32 or 1/64 of their speed.
 *
 *  Results have the same bytes as on the host. When the first handle uses a GPU, the driver
 *  translates the loops for it within seconds and stores the result for the next process. A verb
 *  without loops for a device runs on the host: the log of the handle names it once,
 *  mps_sim_device_info() counts it.
 *
 *  A handle uses its own stream in the primary context of the GPU and restores the context of the
 *  calling thread. Handles in different threads may use the same GPU. */
#ifndef MPS_CUDA_H
#define MPS_CUDA_H

#include <mps/device.h>

MPS_BEGIN_DECLS

/** For mps_cuda_use(): rank r uses GPU r modulo the number of GPUs; without ranks GPU 0 is used.
 *  Use it if each machine has as many ranks as GPUs, with consecutive numbers. */
#define MPS_CUDA_OF_RANK (-1)

/** Run the steps of a handle on a GPU from now on, as mps_sim_device_set() does;
 *  mps_sim_device_set(sim, NULL) returns to the host. Collective: all ranks call it.
 *  @param number  of the GPU, from 0 on, as the driver counts them; or MPS_CUDA_OF_RANK
 *  @return MPS_E_PLUGIN (no driver, no such GPU, too old, no memory; text in mps_sim_error()), and
 *          as mps_sim_device_set() */
MPS_API mps_status mps_cuda_use(mps_sim *sim, int32_t number);

/** A GPU. */
typedef struct mps_cuda_info {
    /** Set by mps_cuda_info_init(). */
    uint32_t struct_size;
    /** out: GPUs of this machine. */
    int32_t count;
    /** out: its name. */
    char name[128];
    /** out: total memory [bytes]. */
    uint64_t memory;
    /** out: free memory [bytes]. */
    uint64_t free_memory;
    /** out: compute capability, e.g. 90 for 9.0. */
    int32_t capability;
    /** out: latest version of CUDA that the driver supports, e.g. 12040 for 12.4. */
    int32_t driver;
} mps_cuda_info;

/** Set struct_size and zero. @param size  sizeof(mps_cuda_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_cuda_info_init(mps_cuda_info *info, size_t size);

/** Properties of a GPU.
 *  @param number  of the GPU, from 0 on
 *  @param info    initialised by mps_cuda_info_init(); out
 *  @param error   NULL, or [error_size] buffer for the text of a failure
 *  @return MPS_E_ARG (info), MPS_E_PLUGIN (no driver, no such GPU) */
MPS_API mps_status mps_cuda_info_get(int32_t number, mps_cuda_info *info, char *error,
                                     size_t error_size);

MPS_END_DECLS

#endif
