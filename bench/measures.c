/* SPDX-License-Identifier: BSD-3-Clause */
/* Clocks, memory and the bandwidth of the machine. */
#include "bench.h"
#include <stdlib.h>
#include <time.h>

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double bench_wall(void)
{
    return seconds(CLOCK_MONOTONIC);
}

double bench_cpu(void)
{
    return seconds(CLOCK_PROCESS_CPUTIME_ID);
}

double bench_triad(void)
{
    const size_t n = 8u << 20;
    double *a = malloc(n * sizeof *a), *b = malloc(n * sizeof *b), *c = malloc(n * sizeof *c),
           best = 0;
    if (!a || !b || !c) bench_fail("triad", "no memory");
    for (size_t i = 0; i < n; i++) a[i] = b[i] = c[i] = (double)i;
    for (int run = 0; run < 5; run++) {
        const double t = bench_cpu();
        for (size_t i = 0; i < n; i++) a[i] = b[i] + 3.0 * c[i];
        const double rate = 3.0 * (double)(n * sizeof *a) / (bench_cpu() - t) * 1e-9;
        if (rate > best && a[n / 2] > 0) best = rate;
    }
    free(a);
    free(b);
    free(c);
    return best;
}

/* The size stands before each block, in bytes that keep malloc's alignment. */
enum { BEFORE = 32 };

static void *take(void *user, size_t size)
{
    bench_memory *m = user;
    char *block = malloc(size + BEFORE);
    if (!block) return NULL;
    *(size_t *)(void *)block = size;
    m->held += size;
    if (m->held > m->peak) m->peak = m->held;
    return block + BEFORE;
}

static void release(void *user, void *block)
{
    bench_memory *m = user;
    char *start = (char *)block - BEFORE;
    m->held -= *(size_t *)(void *)start;
    free(start);
}

mps_allocator bench_allocator(bench_memory *memory)
{
    *memory = (bench_memory){0};
    return (mps_allocator){take, release, memory};
}
