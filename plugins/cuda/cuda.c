/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of libmps_cuda. */
#include "handle.h"
#include <mps/ranks.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *failure(void *self)
{
    const cuda *c = self;
    return c->text.line[0] ? c->text.line : NULL;
}

/* Number of the GPU, from the rank if requested, in the order of ranks of a machine. Errors are
 * reported when the GPU is opened. */
static int number_of(const mps_sim *sim, int32_t number)
{
    cuda_text text = {""};
    int32_t rank = 0;
    int count = 0;
    if (number != MPS_CUDA_OF_RANK) return number;
    mps_sim_ranks(sim, &rank, NULL);
    const cuda_driver *d = cuda_driver_open(&text);
    return d && d->count(&count) == 0 && count > 0 ? rank % count : 0;
}

mps_status mps_cuda_use(mps_sim *sim, int32_t number)
{
    cuda *c = calloc(1, sizeof *c);
    int32_t ranks = 1;
    mps_sim_ranks(sim, NULL, &ranks);
    if (!c && ranks > 1) mps_sim_device_set(sim, NULL); /* the other ranks wait for this call */
    if (!c) return MPS_E_NOMEM;
    c->number = number_of(sim, number);
    c->ops = (mps_device_ops){.struct_size = sizeof c->ops,
                              .api = MPS_DEVICE_API,
                              .name = "cuda",
                              .self = c,
                              .alloc = cuda_take,
                              .free = cuda_free,
                              .upload = cuda_upload,
                              .download = cuda_download,
                              .clear = cuda_clear,
                              .copy = cuda_copy,
                              .launch = cuda_rows,
                              .reduce = cuda_values,
                              .reduce_async = cuda_reduce_async,
                              .wait = cuda_wait,
                              .failure = failure,
                              .begin = cuda_begin,
                              .end = cuda_end};
    bool ended = false; /* true if the GPU of another rank does not open */
    c->ended = &ended;
    const mps_status status = mps_sim_device_set(sim, &c->ops);
    if (status >= 0)
        c->ended = NULL;
    else if (!ended)
        free(c);
    return status;
}

mps_status mps_cuda_info_init(mps_cuda_info *info, size_t size)
{
    if (!info || size != sizeof *info) return MPS_E_ARG;
    *info = (mps_cuda_info){.struct_size = sizeof *info};
    return MPS_OK;
}

static int ask(const cuda_driver *d, int32_t number, mps_cuda_info *info, cuda_text *text)
{
    int device, major = 0, minor = 0;
    size_t memory = 0, free_memory = 0;
    cuda_handle context, before;
    if (cuda_check(text, d, d->count(&info->count), "number of GPUs") ||
        cuda_find(d, number, &device, text) ||
        cuda_check(text, d, d->name(info->name, sizeof info->name, device), "name of the GPU") ||
        cuda_check(text, d, d->attribute(&major, CUDA_CAPABILITY_MAJOR, device),
                   "compute capability") ||
        cuda_check(text, d, d->attribute(&minor, CUDA_CAPABILITY_MINOR, device),
                   "compute capability") ||
        cuda_check(text, d, d->version(&info->driver), "version of the driver") ||
        cuda_check(text, d, d->retain(&context, device), "context of the GPU"))
        return 1;
    int error = d->push(context);
    if (!error) {
        error = d->free_memory(&free_memory, &memory);
        d->pop(&before);
    }
    d->release(device);
    info->capability = 10 * major + minor;
    info->memory = memory;
    info->free_memory = free_memory;
    return cuda_check(text, d, error, "memory of the GPU");
}

mps_status mps_cuda_info_get(int32_t number, mps_cuda_info *info, char *error, size_t error_size)
{
    mps_cuda_info got = {.struct_size = sizeof got};
    cuda_text text = {""};
    if (error && error_size > 0) error[0] = '\0';
    if (!info || info->struct_size != sizeof *info) {
        if (error && error_size > 0)
            snprintf(error, error_size,
                     "mps_cuda_info was not initialised by mps_cuda_info_init()");
        return MPS_E_ARG;
    }
    const cuda_driver *d = cuda_driver_open(&text);
    if (d && ask(d, number, &got, &text) == 0) {
        *info = got;
        return MPS_OK;
    }
    if (error && error_size > 0) snprintf(error, error_size, "%s", text.line);
    return MPS_E_PLUGIN;
}
