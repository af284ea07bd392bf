/* SPDX-License-Identifier: BSD-3-Clause */
/* Routes, exchanges, reductions and allgathers, from sends and receives: MPI can cancel these when
 * a rank fails, but no collective call. */
#include "mpi_engine.h"
#include <stdlib.h>
#include <string.h>

enum { EXCHANGE = 1, CONNECT, REDUCE, GATHER };

static size_t aligned(size_t bytes)
{
    return (bytes + 63) & ~(size_t)63;
}

/* ---- reductions: recursive doubling ---- */

static int swap(mps__mpi *e, int32_t rank, const char *out, char *in, int64_t bytes)
{
    return (in && mps__mpi_receive(e, &e->other, REDUCE, rank, in, bytes)) ||
           (out && mps__mpi_send(e, &e->other, REDUCE, rank, out, bytes)) ||
           mps__mpi_wait(e, &e->other, "reduce");
}

static void combine_all(int32_t count, size_t bytes, char *into, const char *from,
                        mps_combine_fn combine)
{
    for (int32_t k = 0; k < count; k++, into += bytes, from += bytes) combine(into, from);
}

/* Both ranks of a pair combine the same two values in the same order, so that they have the same
 * bytes. Ranks beyond the largest power of two send their values to another rank and receive the
 * result. */
int mps__mpi_reduce(void *engine, int32_t count, size_t bytes, void *values, mps_combine_fn combine)
{
    mps__mpi *e = engine;
    const size_t size = (size_t)count * bytes;
    if (mps__mpi_failed(e)) return 1;
    if (e->ranks == 1 || size == 0) return 0;
    char *mine = mps__mpi_scratch(e, 2 * aligned(size));
    if (!mine) return 1;
    char *in = mine + aligned(size);
    int32_t power = 1;
    while (2 * power <= e->ranks) power *= 2;
    const int32_t extra = e->ranks - power;
    memcpy(mine, values, size);
    if (e->rank >= power) {
        if (swap(e, e->rank - power, mine, NULL, (int64_t)size) ||
            swap(e, e->rank - power, NULL, mine, (int64_t)size))
            return 1;
        memcpy(values, mine, size);
        return 0;
    }
    if (e->rank < extra) {
        if (swap(e, e->rank + power, NULL, in, (int64_t)size)) return 1;
        combine_all(count, bytes, mine, in, combine);
    }
    for (int32_t step = 1; step < power; step *= 2) {
        const bool first = !(e->rank & step);
        if (swap(e, e->rank ^ step, mine, in, (int64_t)size)) return 1;
        combine_all(count, bytes, first ? mine : in, first ? in : mine, combine);
        if (!first) memcpy(mine, in, size);
    }
    if (e->rank < extra && swap(e, e->rank + power, mine, NULL, (int64_t)size)) return 1;
    memcpy(values, mine, size);
    return 0;
}

/* ---- allgather: in step k a rank sends the 2^k blocks that end with its own to rank + 2^k ---- */

/* Send or receive the `count` blocks of ranks that end with `last`, modulo the number of ranks. */
static int move_blocks(mps__mpi *e, bool send, int32_t rank, int32_t last, int32_t count,
                       const int64_t *at, char *all)
{
    const int32_t first = last - count + 1;
    const int32_t range[2][2] = {
        {first < 0 ? first + e->ranks : first, first < 0 ? e->ranks : last + 1},
        {0, first < 0 ? last + 1 : 0}};
    for (int k = 0; k < 2; k++) {
        const int64_t begin = at[range[k][0]], bytes = at[range[k][1]] - begin;
        if (bytes > 0 && (send ? mps__mpi_send(e, &e->other, GATHER, rank, all + begin, bytes)
                               : mps__mpi_receive(e, &e->other, GATHER, rank, all + begin, bytes)))
            return 1;
    }
    return 0;
}

int mps__mpi_gather(void *engine, const void *own, const int64_t *bytes, void *all)
{
    mps__mpi *e = engine;
    const int32_t ranks = e->ranks;
    if (mps__mpi_failed(e)) return 1;
    int64_t *at = mps__mpi_scratch(e, ((size_t)ranks + 1) * sizeof *at);
    if (!at) return 1;
    at[0] = 0;
    for (int32_t k = 0; k < ranks; k++) at[k + 1] = at[k] + bytes[k];
    if (bytes[e->rank] > 0) memmove((char *)all + at[e->rank], own, (size_t)bytes[e->rank]);
    for (int32_t step = 1; step < ranks; step *= 2) {
        const int32_t count = step < ranks - step ? step : ranks - step,
                      to = (e->rank + step) % ranks, from = (e->rank - step + ranks) % ranks;
        if (move_blocks(e, false, from, from, count, at, all) ||
            move_blocks(e, true, to, e->rank, count, at, all) ||
            mps__mpi_wait(e, &e->other, "gather"))
            return 1;
    }
    return 0;
}

/* ---- routes ---- */

typedef struct hello {
    int64_t rank, elements;
} hello;

static void add_number(void *into, const void *from)
{
    int32_t a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    a += b;
    memcpy(into, &a, sizeof a);
}

static int by_rank(const void *a, const void *b)
{
    const int64_t x = ((const hello *)a)->rank, y = ((const hello *)b)->rank;
    return (x > y) - (x < y);
}

/* Count the ranks that send to this one. No rank returns before all have called, so that messages
 * of two routes are not mixed. */
static int count_senders(mps__mpi *e, int32_t count, const int32_t *to, int32_t *senders)
{
    int32_t *number = mps__mpi_alloc(e, (size_t)e->ranks * sizeof *number);
    if (!number) mps__mpi_fail(e, "no memory for a route between ranks");
    for (int32_t k = 0; number && k < e->ranks; k++) number[k] = 0;
    for (int32_t k = 0; number && k < count; k++) number[to[k]] = 1;
    const int failed = !number || mps__mpi_reduce(e, e->ranks, sizeof *number, number, add_number);
    *senders = failed ? 0 : number[e->rank];
    mps__mpi_release(e, number);
    return failed;
}

static int greet(mps__mpi *e, int32_t count, const int32_t *to, const int64_t *sent,
                 int32_t senders, hello *in)
{
    hello *out = in + senders;
    for (int32_t k = 0; k < senders; k++)
        if (mps__mpi_receive(e, &e->other, CONNECT, MPI_ANY_SOURCE, &in[k], sizeof *in)) return 1;
    for (int32_t k = 0; k < count; k++) {
        out[k] = (hello){e->rank, sent[k]};
        if (mps__mpi_send(e, &e->other, CONNECT, to[k], &out[k], sizeof *out)) return 1;
    }
    if (mps__mpi_wait(e, &e->other, "connect")) return 1;
    qsort(in, (size_t)senders, sizeof *in, by_rank);
    return 0;
}

/* Lists of a route in one block, numbers of elements before numbers of ranks. */
static int fill_route(mps__mpi *e, int32_t count, const int32_t *to, const int64_t *sent,
                      int32_t senders, const hello *in, mps_route *route)
{
    const size_t entries = (size_t)count + (size_t)senders;
    int64_t *elements = mps__mpi_alloc(e, (entries + 1) * (sizeof *elements + sizeof(int32_t)));
    if (!elements) {
        mps__mpi_fail(e, "no memory for a route between ranks");
        return 1;
    }
    int32_t *rank = (int32_t *)(void *)(elements + entries);
    for (int32_t k = 0; k < count; k++) {
        rank[k] = to[k];
        elements[k] = sent[k];
    }
    for (int32_t k = 0; k < senders; k++) {
        rank[count + k] = (int32_t)in[k].rank;
        elements[count + k] = in[k].elements;
    }
    *route = (mps_route){.to_count = count,
                         .from_count = senders,
                         .to = rank,
                         .sent = elements,
                         .from = rank + count,
                         .received = elements + count,
                         .data = elements};
    return 0;
}

int mps__mpi_connect(void *engine, int32_t count, const int32_t *to, const int64_t *sent,
                     mps_route *route)
{
    mps__mpi *e = engine;
    int32_t senders = 0;
    *route = (mps_route){0};
    if (mps__mpi_failed(e) || count_senders(e, count, to, &senders)) return 1;
    hello *in = mps__mpi_scratch(e, ((size_t)senders + (size_t)count + 1) * sizeof *in);
    return !in || greet(e, count, to, sent, senders, in) ||
           fill_route(e, count, to, sent, senders, in, route);
}

void mps__mpi_disconnect(void *engine, mps_route *route)
{
    mps__mpi_release(engine, route->data);
    *route = (mps_route){0};
}

int mps__mpi_exchange_begin(void *engine, const mps_route *route, size_t bytes, const void *out,
                            void *in)
{
    mps__mpi *e = engine;
    char *to = in;
    const char *from = out;
    int failed = mps__mpi_failed(e);
    for (int32_t k = 0; k < route->from_count && !failed; k++) {
        const int64_t size = route->received[k] * (int64_t)bytes;
        failed = mps__mpi_receive(e, &e->exchange, EXCHANGE, route->from[k], to, size);
        to += size;
    }
    for (int32_t k = 0; k < route->to_count && !failed; k++) {
        const int64_t size = route->sent[k] * (int64_t)bytes;
        failed = mps__mpi_send(e, &e->exchange, EXCHANGE, route->to[k], from, size);
        from += size;
    }
    return failed;
}

int mps__mpi_exchange_end(void *engine, const mps_route *route)
{
    mps__mpi *e = engine;
    (void)route;
    return mps__mpi_wait(e, &e->exchange, "exchange");
}
