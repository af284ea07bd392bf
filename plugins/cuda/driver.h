/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions of the CUDA driver used here, opened by name. Types and numbers are those of its
 * documentation. */
#ifndef MPS_CUDA_DRIVER_H
#define MPS_CUDA_DRIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint64_t cuda_address;
typedef struct cuda_opaque *cuda_handle; /* of a context, a module, a kernel, a stream */

enum { CUDA_CAPABILITY_MAJOR = 75, CUDA_CAPABILITY_MINOR = 76 }; /* attributes of a GPU */
enum { CUDA_NON_BLOCKING = 1 };                                  /* attribute of a stream */
enum { CUDA_JIT_ERRORS = 5, CUDA_JIT_ERRORS_SIZE = 6 };

/* Member, name in the driver, arguments. All return 0 or the number of an error. */
#define CUDA_FUNCTIONS(F)                                                                          \
    F(init, cuInit, (unsigned flags))                                                              \
    F(version, cuDriverGetVersion, (int *version))                                                 \
    F(error_text, cuGetErrorString, (int error, const char **text))                                \
    F(count, cuDeviceGetCount, (int *count))                                                       \
    F(device, cuDeviceGet, (int *device, int number))                                              \
    F(name, cuDeviceGetName, (char *name, int size, int device))                                   \
    F(memory, cuDeviceTotalMem_v2, (size_t * bytes, int device))                                   \
    F(attribute, cuDeviceGetAttribute, (int *value, int attribute, int device))                    \
    F(retain, cuDevicePrimaryCtxRetain, (cuda_handle * context, int device))                       \
    F(release, cuDevicePrimaryCtxRelease_v2, (int device))                                         \
    F(push, cuCtxPushCurrent_v2, (cuda_handle context))                                            \
    F(pop, cuCtxPopCurrent_v2, (cuda_handle * context))                                            \
    F(load, cuModuleLoadDataEx,                                                                    \
      (cuda_handle * module, const void *text, unsigned options, int *option, void **value))       \
    F(unload, cuModuleUnload, (cuda_handle module))                                                \
    F(kernel, cuModuleGetFunction, (cuda_handle * kernel, cuda_handle module, const char *name))   \
    F(stream, cuStreamCreate, (cuda_handle * stream, unsigned flags))                              \
    F(end_stream, cuStreamDestroy_v2, (cuda_handle stream))                                        \
    F(wait, cuStreamSynchronize, (cuda_handle stream))                                             \
    F(take, cuMemAlloc_v2, (cuda_address * address, size_t bytes))                                 \
    F(memory_free, cuMemFree_v2, (cuda_address address))                                           \
    F(free_memory, cuMemGetInfo_v2, (size_t * free_bytes, size_t * bytes))                         \
    F(up, cuMemcpyHtoDAsync_v2,                                                                    \
      (cuda_address to, const void *from, size_t bytes, cuda_handle stream))                       \
    F(down, cuMemcpyDtoHAsync_v2, (void *to, cuda_address from, size_t bytes, cuda_handle stream)) \
    F(copy, cuMemcpyDtoDAsync_v2,                                                                  \
      (cuda_address to, cuda_address from, size_t bytes, cuda_handle stream))                      \
    F(fill, cuMemsetD8Async,                                                                       \
      (cuda_address to, unsigned char value, size_t bytes, cuda_handle stream))                    \
    F(launch, cuLaunchKernel,                                                                      \
      (cuda_handle kernel, unsigned groups, unsigned groups_y, unsigned groups_z,                  \
       unsigned threads, unsigned threads_y, unsigned threads_z, unsigned shared,                  \
       cuda_handle stream, void **arguments, void **extra))

#define CUDA_MEMBER(member, symbol, arguments) int(*member) arguments;
typedef struct cuda_driver {
    CUDA_FUNCTIONS(CUDA_MEMBER)
} cuda_driver;

/* A GPU in use by handles: its primary context, and the kernels in it. */
typedef struct cuda_gpu {
    const cuda_driver *driver;
    int number, device, users;
    cuda_handle context, module;
} cuda_gpu;

/* Text of a failure. */
typedef struct cuda_text {
    char line[400];
} cuda_text;

/* Keep the first text, formatted as by printf. @return 1 */
int cuda_fail(cuda_text *text, const char *format, ...);
/* Keep the first text for an error of a call of the driver; nothing if error is 0. @return 0, or
 * 1 */
int cuda_check(cuda_text *text, const cuda_driver *driver, int error, const char *what);

/* The driver, opened once per process. NULL: not available, the text has the reason. */
const cuda_driver *cuda_driver_open(cuda_text *text);
/* Find a GPU. @return 0, or 1 with the text */
int cuda_find(const cuda_driver *driver, int number, int *device, cuda_text *text);
/* Context and kernels of a GPU, shared by all handles of the process. NULL: the text has the
 * reason. */
cuda_gpu *cuda_gpu_open(int number, cuda_text *text);
void cuda_gpu_close(cuda_gpu *gpu);

#endif
