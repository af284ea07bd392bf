/* SPDX-License-Identifier: BSD-3-Clause */
/* Threads of a device: index of a thread and barriers within a group. For NVPTX, and for SPIR with
 * the names of OpenCL. */
#ifndef MPS_DEVICE_THREADS_H
#define MPS_DEVICE_THREADS_H

#include "launch.h"
#include <stddef.h>
#include <stdint.h>

/* Memory shared by a group of threads. OpenCL needs the name of its kernel as prefix. */
#define MPS__SHARED(type, name, count, kernel)                     \
    static __attribute__((address_space(3), loader_uninitialized)) \
    type name[count] __asm__(#kernel "." #name)

#ifdef __NVPTX__
static inline int64_t mps__thread_group(void)
{
    return __nvvm_read_ptx_sreg_ctaid_x();
}

static inline int64_t mps__thread_lane(void)
{
    return __nvvm_read_ptx_sreg_tid_x();
}

static inline int64_t mps__thread_row(void)
{
    return mps__thread_group() * MPS__LAUNCH_GROUP + mps__thread_lane();
}

static inline void mps__thread_wait(void)
{
    __nvvm_bar_sync(0);
}
#else
size_t mps__cl_global(unsigned) __asm__("_Z13get_global_idj");
size_t mps__cl_group(unsigned) __asm__("_Z12get_group_idj");
size_t mps__cl_lane(unsigned) __asm__("_Z12get_local_idj");
__attribute__((convergent)) void mps__cl_barrier(unsigned) __asm__("_Z7barrierj");

static inline int64_t mps__thread_group(void)
{
    return (int64_t)mps__cl_group(0);
}

static inline int64_t mps__thread_lane(void)
{
    return (int64_t)mps__cl_lane(0);
}

static inline int64_t mps__thread_row(void)
{
    return (int64_t)mps__cl_global(0);
}

static inline __attribute__((always_inline)) void mps__thread_wait(void)
{
    mps__cl_barrier(3); /* of shared and global memory */
}
#endif

#endif
