/* SPDX-License-Identifier: BSD-3-Clause */
#define CL_TARGET_OPENCL_VERSION 200
#include "standin.h"
#include "driver.h"
#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of errors, as the driver has them. */
enum { INVALID = 1, NO_MEMORY = 2, NO_IMAGE = 209, BAD_TEXT = 218, NO_KERNEL = 500, FAILED = 719 };
enum { BLOCKS = 1024, KERNELS = 4096, ARGUMENTS = 16384 };

typedef struct block {
    char *begin;
    size_t bytes;
} block;

typedef struct kernel {
    cl_kernel kernel;
    char name[100];
    size_t bytes; /* of its argument by value; 0: it takes an address */
} kernel;

static struct {
    const char *path, *failing;
    int64_t failing_at, visits;
    int count, capability, version, open, device;
    bool started;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    char *text; /* PTX */
    block block[BLOCKS];
    kernel kernel[KERNELS];
    int kernels;
    void *arguments;
} s = {.count = 1, .capability = 90, .version = 12040};

/* ---- interface for tests ---- */

void standin_kernels(const char *path)
{
    s.path = path;
}

void standin_fail(const char *function, int64_t visit)
{
    s.failing = function;
    s.failing_at = visit;
    s.visits = 0;
}

int64_t standin_visits(const char *function)
{
    return s.failing && strcmp(s.failing, function) == 0 ? s.visits : -1;
}

void standin_facts(int count, int capability, int version)
{
    s.count = count;
    s.capability = capability;
    s.version = version;
}

int standin_device(void)
{
    return s.device;
}

int standin_open(void)
{
    int open = s.open;
    for (int k = 0; k < BLOCKS; k++) open += s.block[k].begin != NULL;
    return open;
}

static bool fails(const char *function)
{
    return s.failing && strcmp(s.failing, function) == 0 && ++s.visits == s.failing_at;
}

#define MAY_FAIL(error) \
    if (fails(__func__)) return error

#define DECLARE(member, symbol, arguments) int symbol arguments;
CUDA_FUNCTIONS(DECLARE)

/* ---- the GPU ---- */

int cuInit(unsigned flags)
{
    MAY_FAIL(FAILED);
    cl_platform_id platform;
    cl_device_id device;
    cl_int error;
    if (s.started || flags) return flags ? INVALID : 0;
    if (clGetPlatformIDs(1, &platform, NULL) ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL))
        return FAILED;
    s.context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    if (!error) s.queue = clCreateCommandQueueWithProperties(s.context, device, NULL, &error);
    s.arguments = error ? NULL : clSVMAlloc(s.context, CL_MEM_READ_WRITE, ARGUMENTS, 0);
    s.started = s.arguments != NULL;
    return s.started ? 0 : FAILED;
}

int cuDriverGetVersion(int *version)
{
    MAY_FAIL(INVALID);
    *version = s.version;
    return 0;
}

int cuGetErrorString(int error, const char **text)
{
    *text = error == NO_MEMORY ? "out of memory" : "as the test wants it";
    return 0;
}

int cuDeviceGetCount(int *count)
{
    MAY_FAIL(FAILED);
    *count = s.count;
    return 0;
}

int cuDeviceGet(int *device, int number)
{
    MAY_FAIL(FAILED);
    *device = 100 + number;
    return number >= 0 && number < s.count ? 0 : INVALID;
}

int cuDeviceGetName(char *name, int size, int device)
{
    MAY_FAIL(FAILED);
    snprintf(name, (size_t)size, "stand-in %d", device - 100);
    return 0;
}

int cuDeviceTotalMem_v2(size_t *bytes, int device)
{
    MAY_FAIL(FAILED);
    (void)device;
    *bytes = (size_t)8 << 30;
    return 0;
}

int cuDeviceGetAttribute(int *value, int attribute, int device)
{
    MAY_FAIL(FAILED);
    (void)device;
    *value = attribute == CUDA_CAPABILITY_MAJOR ? s.capability / 10 : s.capability % 10;
    return 0;
}

int cuMemGetInfo_v2(size_t *free_bytes, size_t *bytes)
{
    MAY_FAIL(FAILED);
    *free_bytes = (size_t)6 << 30;
    *bytes = (size_t)8 << 30;
    return 0;
}

/* ---- contexts, streams ---- */

static int depth; /* contexts that were pushed */

int cuDevicePrimaryCtxRetain(cuda_handle *context, int device)
{
    MAY_FAIL(NO_MEMORY);
    s.device = device - 100;
    *context = (cuda_handle)&s;
    s.open++;
    return 0;
}

int cuDevicePrimaryCtxRelease_v2(int device)
{
    (void)device;
    s.open--;
    return 0;
}

int cuCtxPushCurrent_v2(cuda_handle context)
{
    MAY_FAIL(FAILED);
    depth++;
    return context == (cuda_handle)&s ? 0 : INVALID;
}

int cuCtxPopCurrent_v2(cuda_handle *context)
{
    *context = (cuda_handle)&s;
    return --depth >= 0 ? 0 : INVALID;
}

int cuStreamCreate(cuda_handle *stream, unsigned flags)
{
    MAY_FAIL(NO_MEMORY);
    *stream = (cuda_handle)&depth;
    s.open++;
    return depth == 1 && flags == CUDA_NON_BLOCKING ? 0 : INVALID;
}

int cuStreamDestroy_v2(cuda_handle stream)
{
    (void)stream;
    s.open--;
    return 0;
}

int cuStreamSynchronize(cuda_handle stream)
{
    MAY_FAIL(FAILED);
    return depth == 1 && stream == (cuda_handle)&depth ? 0 : INVALID;
}

/* ---- memory ---- */

/* The allocation that contains these bytes. */
static block *block_of(cuda_address address, size_t bytes)
{
    const char *at = (const char *)(uintptr_t)address;
    for (int k = 0; k < BLOCKS; k++) {
        block *r = &s.block[k];
        if (r->begin && at >= r->begin && at + bytes <= r->begin + r->bytes) return r;
    }
    return NULL;
}

int cuMemAlloc_v2(cuda_address *address, size_t bytes)
{
    MAY_FAIL(NO_MEMORY);
    int k = 0;
    while (k < BLOCKS && s.block[k].begin) k++;
    if (k == BLOCKS || depth != 1) return NO_MEMORY;
    s.block[k].begin = clSVMAlloc(s.context, CL_MEM_READ_WRITE, bytes, 0);
    s.block[k].bytes = bytes;
    if (!s.block[k].begin) return NO_MEMORY;
    memset(s.block[k].begin, 0xff, bytes);
    *address = (uintptr_t)s.block[k].begin;
    return 0;
}

int cuMemFree_v2(cuda_address address)
{
    block *r = block_of(address, 0);
    if (!r || depth != 1) return INVALID;
    clSVMFree(s.context, r->begin);
    *r = (block){0};
    return 0;
}

int cuMemcpyHtoDAsync_v2(cuda_address to, const void *from, size_t bytes, cuda_handle stream)
{
    MAY_FAIL(FAILED);
    if (!block_of(to, bytes) || depth != 1 || stream != (cuda_handle)&depth) return INVALID;
    memcpy((void *)(uintptr_t)to, from, bytes);
    return 0;
}

int cuMemcpyDtoHAsync_v2(void *to, cuda_address from, size_t bytes, cuda_handle stream)
{
    MAY_FAIL(FAILED);
    if (!block_of(from, bytes) || depth != 1 || stream != (cuda_handle)&depth) return INVALID;
    memcpy(to, (const void *)(uintptr_t)from, bytes);
    return 0;
}

int cuMemcpyDtoDAsync_v2(cuda_address to, cuda_address from, size_t bytes, cuda_handle stream)
{
    MAY_FAIL(FAILED);
    if (!block_of(to, bytes) || !block_of(from, bytes) || stream != (cuda_handle)&depth)
        return INVALID;
    memcpy((void *)(uintptr_t)to, (const void *)(uintptr_t)from, bytes);
    return 0;
}

int cuMemsetD8Async(cuda_address to, unsigned char value, size_t bytes, cuda_handle stream)
{
    MAY_FAIL(FAILED);
    if (!block_of(to, bytes) || depth != 1 || stream != (cuda_handle)&depth) return INVALID;
    memset((void *)(uintptr_t)to, value, bytes);
    return 0;
}

/* ---- kernels ---- */

static unsigned char *read_all(const char *path, size_t *bytes)
{
    FILE *f = path ? fopen(path, "rb") : NULL;
    unsigned char *text = NULL;
    long size = -1;
    if (f && fseek(f, 0, SEEK_END) == 0) size = ftell(f);
    if (size > 0 && fseek(f, 0, SEEK_SET) == 0) text = malloc((size_t)size);
    *bytes = text ? fread(text, 1, (size_t)size, f) : 0;
    if (f) fclose(f);
    return text;
}

int cuModuleLoadDataEx(cuda_handle *module, const void *text, unsigned options, int *option,
                       void **value)
{
    if (fails(__func__)) {
        for (unsigned k = 0; k < options; k++)
            if (option[k] == CUDA_JIT_ERRORS) strcpy(value[k], "line 1: as the test wants it");
        return BAD_TEXT;
    }
    cl_int error = CL_INVALID_VALUE, loaded;
    cl_device_id device;
    size_t bytes;
    if (!s.path) s.path = getenv("STANDIN_KERNELS"); /* of a program that is no test */
    if (!s.path) return NO_IMAGE;
    unsigned char *bitcode = read_all(s.path, &bytes);
    const unsigned char *one = bitcode;
    clGetContextInfo(s.context, CL_CONTEXT_DEVICES, sizeof device, &device, NULL);
    if (bitcode && !s.program) {
        s.program = clCreateProgramWithBinary(s.context, 1, &device, &bytes, &one, &loaded, &error);
        if (!error)
            error = clBuildProgram(s.program, 1, &device, "-x spir -spir-std=1.2", NULL, NULL);
        if (error) return NO_IMAGE;
    }
    free(bitcode);
    if (!s.program || !strstr(text, ".version") || depth != 1) return NO_IMAGE;
    s.text = realloc(s.text, strlen(text) + 1);
    strcpy(s.text, text);
    *module = (cuda_handle)s.text;
    s.open++;
    return 0;
}

int cuModuleUnload(cuda_handle module)
{
    (void)module;
    s.open--;
    return 0;
}

/* Type of the argument of a kernel, from its text: bytes by value, or 0: an address. -1: no such
 * kernel. */
static long argument_of(const char *name)
{
    char head[160];
    snprintf(head, sizeof head, ".entry %s(", name);
    const char *entry = strstr(s.text, head), *end = entry ? strchr(entry, ')') : NULL;
    if (!end) return -1;
    const char *bytes = strchr(entry, '[');
    return bytes && bytes < end ? strtol(bytes + 1, NULL, 10) : 0;
}

int cuModuleGetFunction(cuda_handle *found, cuda_handle module, const char *name)
{
    MAY_FAIL(FAILED);
    cl_int error;
    const long bytes = argument_of(name);
    if (bytes < 0) return NO_KERNEL;
    if (module != (cuda_handle)s.text || s.kernels == KERNELS) return INVALID;
    kernel *k = &s.kernel[s.kernels];
    k->kernel = clCreateKernel(s.program, name, &error);
    if (error) return NO_KERNEL;
    k->bytes = (size_t)bytes;
    s.kernels++;
    *found = (cuda_handle)k;
    return 0;
}

int cuLaunchKernel(cuda_handle started, unsigned groups, unsigned groups_y, unsigned groups_z,
                   unsigned threads, unsigned threads_y, unsigned threads_z, unsigned shared,
                   cuda_handle stream, void **arguments, void **extra)
{
    MAY_FAIL(FAILED);
    const kernel *k = (const kernel *)started;
    const size_t local = threads, global = (size_t)groups * threads;
    cuda_address address = 0;
    if (groups_y != 1 || groups_z != 1 || threads_y != 1 || threads_z != 1 || shared || extra)
        return INVALID;
    if (groups == 0 || depth != 1 || stream != (cuda_handle)&depth) return INVALID;
    if (k->bytes == 0) {
        memcpy(&address, arguments[0], sizeof address);
        if (!block_of(address, 1)) return INVALID;
    } else
        memcpy(s.arguments, arguments[0], k->bytes);
    void *given = k->bytes ? s.arguments : (void *)(uintptr_t)address;
    if (clSetKernelArgSVMPointer(k->kernel, 0, given) ||
        clEnqueueNDRangeKernel(s.queue, k->kernel, 1, NULL, &global, &local, 0, NULL, NULL) ||
        clFinish(s.queue))
        return FAILED;
    return 0;
}
