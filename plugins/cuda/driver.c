/* SPDX-License-Identifier: BSD-3-Clause */
/* Process-wide state of the driver: its functions and the GPUs in use by handles. */
#include "driver.h"
#include "rows.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { GPUS = 64, LOG = 2000, LEAST_CAPABILITY = 60, LEAST_DRIVER = 9000 };

/* `lock` guards all of them. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static cuda_driver functions;
static bool opened;
static cuda_gpu gpus[GPUS];

int cuda_fail(cuda_text *text, const char *format, ...)
{
    va_list list;
    if (text->line[0]) return 1;
    va_start(list, format);
    vsnprintf(text->line, sizeof text->line, format, list);
    va_end(list);
    return 1;
}

int cuda_check(cuda_text *text, const cuda_driver *driver, int error, const char *what)
{
    const char *why = NULL;
    if (error == 0) return 0;
    driver->error_text(error, &why);
    return cuda_fail(text, "%s: %s (CUDA error %d)", what, why ? why : "no text", error);
}

/* ---- the driver ---- */

static int find_functions(void *library, cuda_driver *d, cuda_text *text)
{
    struct entry {
        const char *name;
        void *member;
    };
#define ENTRY(member, symbol, arguments) {#symbol, &d->member},
    const struct entry list[] = {CUDA_FUNCTIONS(ENTRY)};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        void *symbol = dlsym(library, list[k].name);
        if (!symbol)
            return cuda_fail(
                text, "the driver of NVIDIA is too old: it has no %s(); CUDA 9 or newer is needed",
                list[k].name);
        /* ISO C has no cast to a function pointer */
        memcpy(list[k].member, &symbol, sizeof symbol);
    }
    return 0;
}

static int open_driver(cuda_text *text)
{
    cuda_driver d;
    int version = 0;
    void *library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) return cuda_fail(text, "no driver of NVIDIA is installed: %s", dlerror());
    int failed = find_functions(library, &d, text) ||
                 cuda_check(text, &d, d.init(0), "the driver of NVIDIA does not start") ||
                 cuda_check(text, &d, d.version(&version), "version of the driver");
    if (!failed && version < LEAST_DRIVER)
        failed = cuda_fail(text, "the driver of NVIDIA knows CUDA %d.%d; must be 9.0 or newer",
                           version / 1000, version % 1000 / 10);
    if (failed) {
        dlclose(library);
        return 1;
    }
    functions = d; /* never closed: threads of the driver may run */
    opened = true;
    return 0;
}

const cuda_driver *cuda_driver_open(cuda_text *text)
{
    pthread_mutex_lock(&lock);
    const bool there = opened || open_driver(text) == 0;
    pthread_mutex_unlock(&lock);
    return there ? &functions : NULL;
}

/* ---- GPUs ---- */

int cuda_find(const cuda_driver *d, int number, int *device, cuda_text *text)
{
    int count = 0, major = 0, minor = 0;
    if (cuda_check(text, d, d->count(&count), "number of GPUs")) return 1;
    if (count == 0) return cuda_fail(text, "this machine has no GPU of NVIDIA");
    if (number < 0 || number >= count)
        return cuda_fail(text, "there is no GPU %d: must be 0..%d", number, count - 1);
    if (cuda_check(text, d, d->device(device, number), "a GPU does not open") ||
        cuda_check(text, d, d->attribute(&major, CUDA_CAPABILITY_MAJOR, *device),
                   "compute capability") ||
        cuda_check(text, d, d->attribute(&minor, CUDA_CAPABILITY_MINOR, *device),
                   "compute capability"))
        return 1;
    if (10 * major + minor < LEAST_CAPABILITY)
        return cuda_fail(text, "GPU %d has compute capability %d.%d; must be 6.0 or newer", number,
                         major, minor);
    return 0;
}

/* Load the kernels; the driver translates them for this GPU. */
static int load(cuda_gpu *g, cuda_text *text)
{
    char log[LOG] = "";
    int option[] = {CUDA_JIT_ERRORS, CUDA_JIT_ERRORS_SIZE};
    void *value[] = {log, (void *)(uintptr_t)sizeof log};
    const cuda_driver *d = g->driver;
    cuda_handle before;
    if (cuda_check(text, d, d->push(g->context), "context of the GPU")) return 1;
    const int error = d->load(&g->module, mps__cuda_rows, 2, option, value);
    d->pop(&before);
    if (error && log[0])
        return cuda_fail(text, "the driver does not take the kernels: %.300s", log);
    return cuda_check(text, d, error, "the driver does not take the kernels");
}

static int open_gpu(cuda_gpu *g, int number, cuda_text *text)
{
    const cuda_driver *d = &functions;
    *g = (cuda_gpu){.driver = d, .number = number};
    if (cuda_find(d, number, &g->device, text)) return 1;
    if (cuda_check(text, d, d->retain(&g->context, g->device), "context of the GPU")) return 1;
    if (load(g, text) == 0) return 0;
    d->release(g->device);
    return 1;
}

/* Entry of the GPU if it is in use, else a free one. */
static cuda_gpu *place_of(int number)
{
    cuda_gpu *place = NULL;
    for (int k = 0; k < GPUS; k++) {
        if (gpus[k].users > 0 && gpus[k].number == number) return &gpus[k];
        if (gpus[k].users == 0 && !place) place = &gpus[k];
    }
    return place;
}

cuda_gpu *cuda_gpu_open(int number, cuda_text *text)
{
    if (!cuda_driver_open(text)) return NULL;
    pthread_mutex_lock(&lock);
    cuda_gpu *g = place_of(number);
    if (!g)
        cuda_fail(text, "%d GPUs are in use; no more are possible in one process", GPUS);
    else if (g->users > 0 || open_gpu(g, number, text) == 0)
        g->users++;
    else
        g = NULL;
    pthread_mutex_unlock(&lock);
    return g;
}

void cuda_gpu_close(cuda_gpu *g)
{
    cuda_handle before;
    pthread_mutex_lock(&lock);
    if (--g->users == 0) {
        if (g->driver->push(g->context) == 0) {
            g->driver->unload(g->module);
            g->driver->pop(&before);
        }
        g->driver->release(g->device);
    }
    pthread_mutex_unlock(&lock);
}
