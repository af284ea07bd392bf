/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of a GPU, copies, begin and end of a handle. Everything is queued in the handle's stream;
 * only a download and cuda_wait() wait. */
#include "handle.h"
#include <stdlib.h>
#include <string.h>

/* Buffers are larger than requested by 1/SPARE, in steps of ALIGN: the number of particles
 * varies. */
enum { ALIGN = 256, SPARE = 16 };

int cuda_enter(cuda *c)
{
    c->text.line[0] = '\0';
    return cuda_check(&c->text, c->driver, c->driver->push(c->gpu->context), "context of the GPU");
}

void cuda_exit(cuda *c)
{
    cuda_handle before;
    c->driver->pop(&before);
}

/* ---- a handle begins and ends ---- */

int cuda_begin(void *self)
{
    cuda *c = self;
    c->text.line[0] = '\0';
    c->gpu = cuda_gpu_open(c->number, &c->text);
    if (!c->gpu) return 1;
    c->driver = c->gpu->driver;
    int failed = cuda_enter(c);
    if (!failed) {
        failed = cuda_check(&c->text, c->driver, c->driver->stream(&c->stream, CUDA_NON_BLOCKING),
                            "a stream of the GPU");
        cuda_exit(c);
    }
    if (failed) cuda_gpu_close(c->gpu);
    if (failed) c->gpu = NULL;
    return failed;
}

void cuda_end(void *self)
{
    cuda *c = self;
    if (c->gpu && cuda_enter(c) == 0) {
        c->driver->wait(c->stream);
        for (size_t k = 0; k < c->blocks; k++) c->driver->memory_free(c->block[k].begin);
        const cuda_block own[] = {c->terms, c->results, c->arguments};
        for (size_t k = 0; k < sizeof own / sizeof *own; k++)
            if (own[k].begin) c->driver->memory_free(own[k].begin);
        c->driver->end_stream(c->stream);
        cuda_exit(c);
    }
    if (c->gpu) cuda_gpu_close(c->gpu);
    if (c->ended) *c->ended = true;
    free(c->block);
    free(c);
}

/* ---- memory ---- */

/* Return unused buffers to the driver. @return whether there were any */
static bool drop_unused(cuda *c)
{
    size_t kept = 0;
    c->driver->wait(c->stream);
    for (size_t k = 0; k < c->blocks; k++) {
        if (c->block[k].used)
            c->block[kept++] = c->block[k];
        else
            c->driver->memory_free(c->block[k].begin);
    }
    const bool any = kept < c->blocks;
    c->blocks = kept;
    return any;
}

static int ask(cuda *c, size_t bytes, cuda_address *begin)
{
    const cuda_driver *d = c->driver;
    int error = d->take(begin, bytes);
    if (error && drop_unused(c)) error = d->take(begin, bytes);
    return cuda_check(&c->text, d, error, "memory of the GPU");
}

int cuda_fit(cuda *c, cuda_block *block, size_t bytes)
{
    if (bytes <= block->bytes) return 0;
    if (block->begin) {
        c->driver->wait(c->stream);
        c->driver->memory_free(block->begin);
    }
    *block = (cuda_block){0};
    if (ask(c, bytes + bytes / 2, &block->begin)) return 1;
    block->bytes = bytes + bytes / 2;
    return 0;
}

/* The smallest free buffer that is large enough and at most twice as large. */
static cuda_block *find_unused(cuda *c, size_t bytes)
{
    cuda_block *best = NULL;
    for (size_t k = 0; k < c->blocks; k++) {
        cuda_block *r = &c->block[k];
        if (r->used || r->bytes < bytes || r->bytes / 2 > bytes + ALIGN) continue;
        if (!best || r->bytes < best->bytes) best = r;
    }
    return best;
}

static bool grow_blocks(cuda *c)
{
    if (c->blocks < c->block_capacity) return true;
    const size_t capacity = 2 * c->block_capacity + 64;
    cuda_block *list = realloc(c->block, capacity * sizeof *list);
    if (!list) return cuda_fail(&c->text, "no memory of the host") == 0;
    c->block = list;
    c->block_capacity = capacity;
    return true;
}

void *cuda_take(void *self, uint64_t wanted)
{
    cuda *c = self;
    const size_t bytes = (size_t)((wanted + wanted / SPARE + ALIGN - 1) / ALIGN * ALIGN);
    cuda_block *r = find_unused(c, wanted);
    if (!r && grow_blocks(c) && cuda_enter(c) == 0) {
        cuda_address begin;
        if (ask(c, bytes, &begin) == 0) {
            r = &c->block[c->blocks++];
            *r = (cuda_block){.begin = begin, .bytes = bytes};
        }
        cuda_exit(c);
    }
    if (!r) return NULL;
    r->used = true;
    return (void *)(uintptr_t)r->begin;
}

void cuda_free(void *self, void *block)
{
    cuda *c = self;
    for (size_t k = 0; k < c->blocks; k++)
        if (c->block[k].used && c->block[k].begin == (uintptr_t)block) c->block[k].used = false;
}

/* ---- copies ---- */

int cuda_upload(void *self, void *to, const void *from, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver,
                                  c->driver->up((uintptr_t)to, from, bytes, c->stream),
                                  "copy to the GPU");
    cuda_exit(c);
    return failed;
}

int cuda_download(void *self, void *to, const void *from, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    int error = c->driver->down(to, (uintptr_t)from, bytes, c->stream);
    if (!error) error = c->driver->wait(c->stream);
    const int failed = cuda_check(&c->text, c->driver, error, "copy from the GPU");
    cuda_exit(c);
    return failed;
}

int cuda_clear(void *self, void *to, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver,
                                  c->driver->fill((uintptr_t)to, 0, bytes, c->stream),
                                  "clear on the GPU");
    cuda_exit(c);
    return failed;
}

int cuda_copy(void *self, void *to, const void *from, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver,
                                  c->driver->copy((uintptr_t)to, (uintptr_t)from, bytes, c->stream),
                                  "copy on the GPU");
    cuda_exit(c);
    return failed;
}

int cuda_wait(void *self)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver, c->driver->wait(c->stream),
                                  "wait for the GPU");
    cuda_exit(c);
    return failed;
}
