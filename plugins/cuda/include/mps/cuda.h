/* SPDX-License-Identifier: BSD-3-Clause */
/** @file cuda.h  Plug-in library libmps_cuda: runs the time steps of a handle on a GPU of NVIDIA.
 *
 *      mps_sim_create(&config, &sim);
 *      mps_cuda_use(sim, 0);
 *      ... build and step as without a GPU ...
 *      mps_sim_destroy(sim);
 *
 *  The library opens the driver, libcuda.so.1, when it is asked for a GPU; neither it nor its users
 *  need CUDA to be built. It needs a driver of CUDA 9 or newer and a GPU of compute capability 6.0
 *  or newer, whose doubles are fast: those of the classes P100, V100, A100 and H100. Others run,
 *  but at 1/32 or 1/64 of their speed.
 *
 *  Results have the same bytes as on the host. The driver translates the loops for the GPU when the
 *  first handle uses it, in seconds, and keeps the result for the next process. What has no loop on
 *  a device runs on the host: the log of the handle names it once, mps_sim_device_info() counts it.
 *
 *  A handle uses a stream of its own in the primary context of the GPU, and leaves the context of
 *  the calling thread as it was. Handles in different threads may use the same GPU. */
#ifndef MPS_CUDA_H
#define MPS_CUDA_H

#include <mps/device.h>

MPS_BEGIN_DECLS

/** For mps_cuda_use(): GPU r modulo their number on rank r, so GPU 0 without ranks. It fits where
 *  each machine has as many ranks as GPUs, one after the other. */
#define MPS_CUDA_OF_RANK (-1)

/** Run the steps of a handle on a GPU from now on, as mps_sim_device_set() does;
 *  mps_sim_device_set(sim, NULL) brings them back to the host. On many ranks a call of all ranks.
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
    /** out: its memory [bytes]. */
    uint64_t memory;
    /** out: what is free of it [bytes]. */
    uint64_t free_memory;
    /** out: compute capability, e.g. 90 for 9.0. */
    int32_t capability;
    /** out: version of CUDA that the driver knows, e.g. 12040 for 12.4. */
    int32_t driver;
} mps_cuda_info;

/** Set struct_size and zero. @param size  sizeof(mps_cuda_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_cuda_info_init(mps_cuda_info *info, size_t size);

/** Facts of a GPU.
 *  @param number  of the GPU, from 0 on
 *  @param info    initialised by mps_cuda_info_init(); out
 *  @param error   NULL, or [error_size] where a failed call writes why
 *  @return MPS_E_ARG (info), MPS_E_PLUGIN (no driver, no such GPU) */
MPS_API mps_status mps_cuda_info_get(int32_t number, mps_cuda_info *info, char *error,
                                     size_t error_size);

MPS_END_DECLS

#endif
