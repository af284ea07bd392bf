/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory, start of messages, and the loop that waits for them. */
#include "mpi_engine.h"
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* Iterations of a waiting loop: the first ones spin, the next ones yield the processor, the others
 * sleep. */
enum { BUSY = 200, YIELDING = 2000, SLEEP = 50000 /* ns */ };
/* Busy iterations between two tests for failures: a test costs as much as an iteration. */
enum { LISTEN = 16 };
/* Time for cancelled messages to end: at once, or when the other rank knows of the failure [s]. */
static const double patience = 2;

void *mps__mpi_alloc(mps__mpi *e, size_t size)
{
    return e->allocator.alloc(e->allocator.user, size);
}

void mps__mpi_release(mps__mpi *e, void *block)
{
    if (block) e->allocator.release(e->allocator.user, block);
}

void *mps__mpi_scratch(mps__mpi *e, size_t bytes)
{
    if (bytes <= e->scratch_bytes && e->scratch) return e->scratch;
    mps__mpi_release(e, e->scratch);
    e->scratch_bytes = bytes + bytes / 4 + 1024;
    e->scratch = mps__mpi_alloc(e, e->scratch_bytes);
    if (!e->scratch) mps__mpi_fail(e, "no memory for messages between ranks");
    return e->scratch;
}

double mps__mpi_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void mps__mpi_rest(int64_t turn)
{
    if (turn < BUSY) return;
    if (turn < YIELDING)
        sched_yield();
    else
        nanosleep(&(struct timespec){.tv_nsec = SLEEP}, NULL);
}

static void stop(mps__mpi *e, mps__mpi_list *list)
{
    int done = 0;
    const double end = mps__mpi_now() + patience;
    for (int32_t k = 0; k < list->count; k++)
        if (list->request[k] != MPI_REQUEST_NULL) MPI_Cancel(&list->request[k]);
    for (int64_t turn = 0; !done && mps__mpi_now() < end; turn++) {
        if (MPI_Testall(list->count, list->request, &done, MPI_STATUSES_IGNORE) != MPI_SUCCESS)
            break;
        mps__mpi_rest(turn);
    }
    if (!done) e->stuck = true;
    list->count = 0;
}

/* A rank that has failed cancels its receives and sends no more. A send completes if the other rank
 * receives it; otherwise MPI keeps it. */
void mps__mpi_stop(mps__mpi *e)
{
    if (e->exchange.count > 0) stop(e, &e->exchange);
    if (e->other.count > 0) stop(e, &e->other);
}

static int stop_all(mps__mpi *e)
{
    mps__mpi_stop(e);
    return 1;
}

static MPI_Request *next_request(mps__mpi *e, mps__mpi_list *list)
{
    if (list->count == list->capacity) {
        const int32_t capacity = 2 * list->capacity + 16;
        MPI_Request *larger = mps__mpi_alloc(e, (size_t)capacity * sizeof(MPI_Request));
        if (!larger) {
            mps__mpi_fail(e, "no memory for messages between ranks");
            return NULL;
        }
        if (list->count > 0)
            memcpy(larger, list->request, (size_t)list->count * sizeof(MPI_Request));
        mps__mpi_release(e, list->request);
        list->request = larger;
        list->capacity = capacity;
    }
    return &list->request[list->count];
}

int mps__mpi_send(mps__mpi *e, mps__mpi_list *list, int tag, int32_t rank, const void *data,
                  int64_t bytes)
{
    for (int64_t at = 0; at < bytes; at += e->chunk) {
        const int64_t size = bytes - at < e->chunk ? bytes - at : e->chunk;
        MPI_Request *request = next_request(e, list);
        if (!request) return stop_all(e);
        const int code = MPI_Isend((const char *)data + at, (int)size, MPI_BYTE, rank, tag, e->data,
                                   request);
        if (code != MPI_SUCCESS) {
            mps__mpi_error(e, "MPI_Isend", code);
            return stop_all(e);
        }
        list->count++;
    }
    return 0;
}

int mps__mpi_receive(mps__mpi *e, mps__mpi_list *list, int tag, int32_t rank, void *data,
                     int64_t bytes)
{
    for (int64_t at = 0; at < bytes; at += e->chunk) {
        const int64_t size = bytes - at < e->chunk ? bytes - at : e->chunk;
        MPI_Request *request = next_request(e, list);
        if (!request) return stop_all(e);
        const int code = MPI_Irecv((char *)data + at, (int)size, MPI_BYTE, rank, tag, e->data,
                                   request);
        if (code != MPI_SUCCESS) {
            mps__mpi_error(e, "MPI_Irecv", code);
            return stop_all(e);
        }
        list->count++;
    }
    return 0;
}

static void time_out(mps__mpi *e, const char *call)
{
    char text[MPS__MPI_TEXT];
    snprintf(
        text, sizeof text,
        "rank %d of %d: no answer from other ranks for %g s in '%s': a rank has died, or makes "
        "other calls; a longer time: environment variable MPS_MPI_WATCHDOG [s]",
        (int)e->rank, (int)e->ranks, e->watchdog, call);
    mps__mpi_fail(e, text);
}

int mps__mpi_wait(mps__mpi *e, mps__mpi_list *list, const char *call)
{
    double end = 0;
    for (int64_t turn = 0; !e->failed; turn++) {
        int done = 0;
        const int code = MPI_Testall(list->count, list->request, &done, MPI_STATUSES_IGNORE);
        if (code != MPI_SUCCESS) mps__mpi_error(e, call, code);
        if (code == MPI_SUCCESS && done) {
            list->count = 0;
            return 0;
        }
        if (turn < BUSY && turn % LISTEN != LISTEN - 1) continue;
        if (mps__mpi_failed(e) || turn < BUSY) continue;
        if (turn == BUSY) end = mps__mpi_now() + e->watchdog;
        if (turn > BUSY && mps__mpi_now() > end) time_out(e, call);
        mps__mpi_rest(turn);
    }
    return stop_all(e);
}
