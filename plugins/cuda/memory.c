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

void cuda_leave(cuda *c)
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
        cuda_leave(c);
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
        for (size_t k = 0; k < c->rooms; k++) c->driver->give(c->room[k].begin);
        const cuda_room own[] = {c->terms, c->results, c->arguments};
        for (size_t k = 0; k < sizeof own / sizeof *own; k++)
            if (own[k].begin) c->driver->give(own[k].begin);
        c->driver->end_stream(c->stream);
        cuda_leave(c);
    }
    if (c->gpu) cuda_gpu_close(c->gpu);
    if (c->ended) *c->ended = true;
    free(c->room);
    free(c);
}

/* ---- memory ---- */

/* Return unused buffers to the driver. @return whether there were any */
static bool drop_unused(cuda *c)
{
    size_t kept = 0;
    c->driver->wait(c->stream);
    for (size_t k = 0; k < c->rooms; k++) {
        if (c->room[k].used)
            c->room[kept++] = c->room[k];
        else
            c->driver->give(c->room[k].begin);
    }
    const bool any = kept < c->rooms;
    c->rooms = kept;
    return any;
}

static int ask(cuda *c, size_t bytes, cuda_address *begin)
{
    const cuda_driver *d = c->driver;
    int error = d->take(begin, bytes);
    if (error && drop_unused(c)) error = d->take(begin, bytes);
    return cuda_check(&c->text, d, error, "memory of the GPU");
}

int cuda_fit(cuda *c, cuda_room *room, size_t bytes)
{
    if (bytes <= room->bytes) return 0;
    if (room->begin) {
        c->driver->wait(c->stream);
        c->driver->give(room->begin);
    }
    *room = (cuda_room){0};
    if (ask(c, bytes + bytes / 2, &room->begin)) return 1;
    room->bytes = bytes + bytes / 2;
    return 0;
}

/* The smallest free buffer that is large enough and at most twice as large. */
static cuda_room *free_room(cuda *c, size_t bytes)
{
    cuda_room *best = NULL;
    for (size_t k = 0; k < c->rooms; k++) {
        cuda_room *r = &c->room[k];
        if (r->used || r->bytes < bytes || r->bytes / 2 > bytes + ALIGN) continue;
        if (!best || r->bytes < best->bytes) best = r;
    }
    return best;
}

static bool more_rooms(cuda *c)
{
    if (c->rooms < c->room_capacity) return true;
    const size_t capacity = 2 * c->room_capacity + 64;
    cuda_room *list = realloc(c->room, capacity * sizeof *list);
    if (!list) return cuda_fail(&c->text, "no memory of the host") == 0;
    c->room = list;
    c->room_capacity = capacity;
    return true;
}

void *cuda_take(void *self, uint64_t wanted)
{
    cuda *c = self;
    const size_t bytes = (size_t)((wanted + wanted / SPARE + ALIGN - 1) / ALIGN * ALIGN);
    cuda_room *r = free_room(c, wanted);
    if (!r && more_rooms(c) && cuda_enter(c) == 0) {
        cuda_address begin;
        if (ask(c, bytes, &begin) == 0) {
            r = &c->room[c->rooms++];
            *r = (cuda_room){.begin = begin, .bytes = bytes};
        }
        cuda_leave(c);
    }
    if (!r) return NULL;
    r->used = true;
    return (void *)(uintptr_t)r->begin;
}

void cuda_give(void *self, void *room)
{
    cuda *c = self;
    for (size_t k = 0; k < c->rooms; k++)
        if (c->room[k].used && c->room[k].begin == (uintptr_t)room) c->room[k].used = false;
}

/* ---- copies ---- */

int cuda_upload(void *self, void *to, const void *from, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver,
                                  c->driver->up((uintptr_t)to, from, bytes, c->stream),
                                  "copy to the GPU");
    cuda_leave(c);
    return failed;
}

int cuda_download(void *self, void *to, const void *from, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    int error = c->driver->down(to, (uintptr_t)from, bytes, c->stream);
    if (!error) error = c->driver->wait(c->stream);
    const int failed = cuda_check(&c->text, c->driver, error, "copy from the GPU");
    cuda_leave(c);
    return failed;
}

int cuda_clear(void *self, void *to, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver,
                                  c->driver->fill((uintptr_t)to, 0, bytes, c->stream),
                                  "clear on the GPU");
    cuda_leave(c);
    return failed;
}

int cuda_copy(void *self, void *to, const void *from, uint64_t bytes)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver,
                                  c->driver->copy((uintptr_t)to, (uintptr_t)from, bytes, c->stream),
                                  "copy on the GPU");
    cuda_leave(c);
    return failed;
}

int cuda_wait(void *self)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = cuda_check(&c->text, c->driver, c->driver->wait(c->stream),
                                  "wait for the GPU");
    cuda_leave(c);
    return failed;
}
