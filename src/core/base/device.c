/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of a device: checks, counters, failures. */
#include "device.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

void mps__device_init(mps__device *d, mps__context *context)
{
    *d = (mps__device){.context = context, .info = {.struct_size = sizeof d->info}};
}

static mps_status check_table(mps__context *c, const mps_device_ops *ops)
{
    MPS__CHECK(c, ops->api == MPS_DEVICE_API, "mps_device_ops.api is %u: this version knows %u",
               ops->api, MPS_DEVICE_API);
    MPS__CHECK(c, ops->name && ops->name[0], "mps_device_ops.name is NULL or empty");
    const bool complete = ops->alloc && ops->free && ops->upload && ops->download && ops->clear &&
                          ops->copy && ops->launch && ops->reduce && ops->reduce_async &&
                          ops->wait && ops->failure;
    MPS__CHECK(c, complete,
               "device '%s' lacks a function: all but 'invalidated', 'begin' and 'end' are needed",
               ops->name);
    return MPS_OK;
}

/* Loops of calls on the device that have no launch run in the calling thread. */
static void run_parts(void *user, int32_t parts, mps_part_fn body, void *argument)
{
    (void)user;
    for (int32_t part = 0; part < parts; part++) body(argument, part);
}

static void *alloc_block(void *user, size_t bytes);
static void release_block(void *user, void *block);

mps_status mps__device_set(mps__device *d, const mps_device_ops *ops)
{
    mps_device_ops copy = {0};
    MPS__TRY(mps__struct_in(d->context, "mps_device_ops", &copy, sizeof copy, ops));
    MPS__TRY(check_table(d->context, &copy));
    if (copy.begin && copy.begin(copy.self) != 0) {
        const char *why = copy.failure(copy.self);
        return mps__fail(d->context, MPS_E_PLUGIN, "device '%s' does not open: %.300s", copy.name,
                         why ? why : "it does not say why");
    }
    mps__device_init(d, d->context);
    d->ops = copy;
    d->parallel = (mps_parallel){
        .struct_size = sizeof d->parallel, .threads = 1, .run = run_parts, .user = d};
    d->memory = (mps_allocator){.alloc = alloc_block, .release = release_block, .user = d};
    return MPS_OK;
}

void mps__device_end(mps__device *d)
{
    if (d->ops.name && d->ops.end) d->ops.end(d->ops.self);
    mps__device_init(d, d->context);
}

void mps__device_begin(mps__device *d)
{
    const int64_t held = d->info.bytes_held;
    d->info = (mps_device_info){
        .struct_size = sizeof d->info, .name = d->ops.name, .bytes_held = held};
    d->failed = false;
    d->cancel = NULL;
}

mps__device *mps__device_of(const mps_parallel *p)
{
    return p && p->run == run_parts ? p->user : NULL;
}

/* ---- failures ---- */

/* Store the result of a device call. Later memory calls may overwrite the failure reason. */
static void note(mps__device *d, int failed)
{
    if (!failed) return;
    const char *why = d->ops.failure(d->ops.self);
    d->failed = true;
    snprintf(d->why, sizeof d->why, "%s", why ? why : "it does not say why");
}

void mps__device_fail(mps__device *d)
{
    if (!d->failed) snprintf(d->why, sizeof d->why, "%.300s", d->context->error);
    d->failed = true;
}

mps_status mps__device_status(const mps__device *d)
{
    if (!d->failed) return MPS_OK;
    return mps__fail(d->context, MPS_E_PLUGIN, "device '%s' failed: %s", d->ops.name, d->why);
}

/* ---- memory ---- */

void *mps__device_alloc(mps__device *d, size_t bytes)
{
    void *block = d->ops.alloc(d->ops.self, bytes);
    if (block)
        d->info.bytes_held += (int64_t)bytes;
    else
        mps__fail(d->context, MPS_E_NOMEM, "device '%s' has no memory for %zu bytes", d->ops.name,
                  bytes);
    return block;
}

void mps__device_free(mps__device *d, void *block, size_t bytes)
{
    if (!block) return;
    d->ops.free(d->ops.self, block);
    d->info.bytes_held -= (int64_t)bytes;
}

void *mps__device_fit(mps__device *d, mps__device_block *block, size_t bytes)
{
    if (block->data && bytes <= block->bytes) return block->data;
    mps__device_release(d, block);
    const size_t wanted = bytes + bytes / 8 + sizeof(double);
    block->data = mps__device_alloc(d, wanted);
    if (block->data) block->bytes = wanted;
    return block->data;
}

void mps__device_release(mps__device *d, mps__device_block *block)
{
    mps__device_free(d, block->data, block->bytes);
    *block = (mps__device_block){NULL, 0};
}

static void *alloc_block(void *user, size_t bytes)
{
    mps__device *d = user;
    int k = 0;
    while (k < MPS__DEVICE_BLOCKS && d->block[k].data) k++;
    void *block = k < MPS__DEVICE_BLOCKS && bytes > 0 ? mps__device_alloc(d, bytes) : NULL;
    if (!block) return NULL;
    d->block[k].data = block;
    d->block[k].bytes = bytes;
    return block;
}

static void release_block(void *user, void *block)
{
    mps__device *d = user;
    for (int k = 0; k < MPS__DEVICE_BLOCKS; k++) {
        if (d->block[k].data != block) continue;
        mps__device_free(d, block, d->block[k].bytes);
        d->block[k].data = NULL;
        return;
    }
}

void mps__device_upload(mps__device *d, void *to, const void *from, size_t bytes)
{
    if (d->failed || bytes == 0) return;
    note(d, d->ops.upload(d->ops.self, to, from, bytes));
    d->info.uploads++;
    d->info.bytes_up += (int64_t)bytes;
}

void mps__device_download(mps__device *d, void *to, const void *from, size_t bytes)
{
    if (d->failed || bytes == 0) return;
    note(d, d->ops.download(d->ops.self, to, from, bytes));
    d->info.downloads++;
    d->info.waits++;
    d->info.bytes_down += (int64_t)bytes;
}

void mps__device_clear(mps__device *d, void *to, size_t bytes)
{
    if (d->failed || bytes == 0) return;
    note(d, d->ops.clear(d->ops.self, to, bytes));
    d->info.launches++;
}

void mps__device_copy(mps__device *d, void *to, const void *from, size_t bytes)
{
    if (d->failed || bytes == 0) return;
    note(d, d->ops.copy(d->ops.self, to, from, bytes));
    d->info.launches++;
}

void mps__device_wait(mps__device *d)
{
    if (d->failed || !mps__device_present(d)) return;
    note(d, d->ops.wait(d->ops.self));
    d->info.waits++;
}

void mps__device_invalidate(mps__device *d, void *array, size_t bytes, size_t number)
{
    if (d->ops.invalidated && bytes > 0)
        d->ops.invalidated(d->ops.self, array, bytes, (uint32_t)number);
}

/* ---- loops ---- */

/* File name without folders. */
static const char *name_of(const char *file)
{
    const char *folder = strrchr(file, '/');
    return folder ? folder + 1 : file;
}

/* Set the common fields of a launch. */
static void complete(mps__device *d, mps_launch *launch)
{
    launch->struct_size = sizeof *launch;
    launch->file = name_of(launch->file);
    launch->cancel = d->cancel;
    d->info.launches++;
}

void mps__device_launch(mps__device *d, mps_launch *launch, mps_exact *sums, double *maxima)
{
    if (d->failed || launch->n == 0) return;
    complete(d, launch);
    if (launch->sums == 0 && launch->maxima == 0) {
        note(d, d->ops.launch(d->ops.self, launch));
        return;
    }
    note(d, d->ops.reduce(d->ops.self, launch, sums, maxima));
    d->info.waits++;
    d->info.bytes_down += (int64_t)((size_t)launch->sums * sizeof *sums +
                                    (size_t)launch->maxima * sizeof *maxima);
}

/* Write the results of a launch without rows, which a rank may have. */
static void put_nothing(mps__device *d, const mps_launch *launch, void *to)
{
    double lowest[MPS_PARALLEL_VALUES];
    const size_t sums = (size_t)launch->sums * sizeof(mps_exact);
    for (int32_t k = 0; k < launch->maxima; k++) lowest[k] = -INFINITY;
    mps__device_clear(d, to, sums);
    mps__device_upload(d, (char *)to + sums, lowest, (size_t)launch->maxima * sizeof *lowest);
}

void mps__device_reduce_async(mps__device *d, mps_launch *launch, void *to)
{
    if (launch->n == 0) put_nothing(d, launch, to);
    if (d->failed || launch->n == 0) return;
    complete(d, launch);
    note(d, d->ops.reduce_async(d->ops.self, launch, to));
}
