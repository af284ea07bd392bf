/* SPDX-License-Identifier: BSD-3-Clause */
/* A pool of threads. A loop is a round: the caller opens it, works on its own parts and on parts
 * that no thread has begun, closes it, and waits only for parts that others have begun. So a thread
 * without a core costs nothing, and a round completes without any other thread. */
#ifndef _GNU_SOURCE /* the build sets it, in front of plain.h */
#define _GNU_SOURCE /* sched_getcpu() */
#endif
#include "device.h"
#include "parallel.h"
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

enum { CACHE_LINE = 64, LOOKS = 32 };

/* Waiting threads spin for this time, then sleep [s]. Serial code between two loops of a step takes
 * 1 to 30 microseconds, waking a thread about 10. */
static const double SPIN = 50e-6;

/* If other processes use the cores, threads make loops slower than one thread would be. Gained and
 * lost time is measured every MEASURED rounds. After a loss of MOST_LOSS [s] loops run in the
 * calling thread for REST_PER_LOSS times that time, longer each time, at most REST_MOST [s]. Gains
 * up to MOST_GAIN [s], a few time slices of the system, offset later losses: a core that is taken
 * away occasionally is no reason to rest. */
enum { MEASURED = 8 };
static const double MOST_GAIN = 20e-3, MOST_LOSS = 0.3e-3, REST_PER_LOSS = 4, REST_MOST = 0.25;

/* State of a crew in one number: number of workers in a round, whether the round is open, and its
 * number. */
#define INSIDE      UINT64_C(0xffff)
#define OPEN        UINT64_C(0x10000)
#define QUIT        UINT64_C(0x20000)
#define ROUND_SHIFT 20

/* A thread and the parts that it runs first. */
typedef struct seat {
    _Atomic int32_t next;
    int32_t end;
    atomic_int core; /* core of the thread at the start of the round */
    struct mps__crew *crew;
    pthread_t thread;
    /* avoids false sharing of a cache line or of a pair of lines */
    char apart[2 * CACHE_LINE - 32];
} seat;

struct mps__crew {
    char before[2 * CACHE_LINE];
    _Atomic uint64_t state;
    char after[2 * CACHE_LINE];
    atomic_int sleepers; /* workers waiting for `opened` */
    atomic_bool waiting; /* the caller waits for `empty` */
    atomic_bool busy;    /* a round is in progress: nested loops run in their own thread */
    pthread_mutex_t lock;
    pthread_cond_t opened, empty;
    /* of the round, written while no worker is in it */
    mps_part_fn body;
    void *argument;
    /* of the caller [s]: gains minus losses, the last rest and its end (0: not resting) */
    double balance, rest, rest_until;
    int32_t seats;
    seat seat[]; /* the first one belongs to the caller */
};

static inline void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/* ---- waiting ---- */

/* Whether a worker that last saw round `seen` has work. */
static inline bool has_news(struct mps__crew *c, uint64_t seen)
{
    const uint64_t s = atomic_load(&c->state);
    return (s & QUIT) || ((s & OPEN) && s >> ROUND_SHIFT != seen);
}

static inline bool is_empty(struct mps__crew *c, uint64_t unused)
{
    (void)unused;
    return !(atomic_load(&c->state) & INSIDE);
}

/* Core of the calling thread, -1: unknown. */
static int core_now(void)
{
#ifdef __linux__
    return sched_getcpu();
#else
    return -1;
#endif
}

/* Whether the calling thread is on the core of another thread of this round and would block it by
 * spinning. */
static bool is_in_the_way(struct mps__crew *c, const seat *own)
{
    const int core = core_now();
    /* the caller checks all others, they check the caller */
    const int32_t first = own == c->seat, end = own == c->seat ? c->seats : 1;
    for (int32_t k = first; k < end && core >= 0; k++)
        if (atomic_load_explicit(&c->seat[k].core, memory_order_relaxed) == core) return true;
    return false;
}

/* Spin for SPIN seconds at most. */
static inline __attribute__((always_inline)) bool
spin(seat *own, bool (*done)(struct mps__crew *, uint64_t), uint64_t seen)
{
    struct mps__crew *c = own->crew;
    double end = 0;
    do {
        for (int k = 0; k < LOOKS; k++) {
            if (done(c, seen)) return true;
            relax();
        }
        if (is_in_the_way(c, own)) return false;
        if (end == 0) end = mps__clock() + SPIN;
    } while (mps__clock() < end);
    return false;
}

static void await_news(seat *own, uint64_t seen)
{
    struct mps__crew *c = own->crew;
    if (spin(own, has_news, seen)) return;
    pthread_mutex_lock(&c->lock);
    /* before the last check: the caller looks for sleepers after it opened a round */
    atomic_fetch_add(&c->sleepers, 1);
    while (!has_news(c, seen)) pthread_cond_wait(&c->opened, &c->lock);
    atomic_fetch_sub(&c->sleepers, 1);
    pthread_mutex_unlock(&c->lock);
}

/* @return time taken, without spinning [s] */
static double await_empty(struct mps__crew *c)
{
    if (spin(&c->seat[0], is_empty, 0)) return 0;
    const double begin = mps__clock();
    pthread_mutex_lock(&c->lock);
    atomic_store(&c->waiting, true);
    while (!is_empty(c, 0)) pthread_cond_wait(&c->empty, &c->lock);
    atomic_store(&c->waiting, false);
    pthread_mutex_unlock(&c->lock);
    return mps__clock() - begin;
}

static void wake(struct mps__crew *c, pthread_cond_t *condition)
{
    pthread_mutex_lock(&c->lock);
    pthread_cond_broadcast(condition);
    pthread_mutex_unlock(&c->lock);
}

/* ---- a round ---- */

/* Run the parts of the own seat, then the remaining parts of the others. Returns their number. */
static int32_t take_parts(struct mps__crew *c, int32_t own)
{
    int32_t taken = 0;
    for (int32_t k = 0; k < c->seats; k++) {
        seat *s = &c->seat[(own + k) % c->seats];
        for (;;) {
            if (atomic_load_explicit(&s->next, memory_order_relaxed) >= s->end) break;
            const int32_t part = atomic_fetch_add_explicit(&s->next, 1, memory_order_relaxed);
            if (part >= s->end) break;
            c->body(c->argument, part);
            taken++;
        }
    }
    return taken;
}

/* Enter the open round unless it is the one seen last. Writes before it opened are visible
 * inside. */
static bool enter(struct mps__crew *c, uint64_t *seen)
{
    uint64_t s = atomic_load(&c->state);
    while ((s & OPEN) && s >> ROUND_SHIFT != *seen)
        if (atomic_compare_exchange_weak(&c->state, &s, s + 1)) {
            *seen = s >> ROUND_SHIFT;
            return true;
        }
    return false;
}

static void leave(struct mps__crew *c)
{
    const uint64_t before = atomic_fetch_sub(&c->state, 1);
    if ((before & INSIDE) == 1 && !(before & OPEN) && atomic_load(&c->waiting)) wake(c, &c->empty);
}

static void *work(void *argument)
{
    seat *own = argument;
    struct mps__crew *c = own->crew;
    uint64_t seen = 0;
    for (;;) {
        await_news(own, seen);
        if (atomic_load(&c->state) & QUIT) return NULL;
        if (!enter(c, &seen)) continue;
        atomic_store_explicit(&own->core, core_now(), memory_order_relaxed);
        take_parts(c, (int32_t)(own - c->seat));
        leave(c);
    }
}

/* Add a gain, or a loss (negative) [s]. */
static void book(struct mps__crew *c, double gain)
{
    c->balance = fmin(c->balance + gain, MOST_GAIN);
    c->rest = fmax(c->rest - fmax(gain, 0), 0);
    if (c->balance > -MOST_LOSS) return;
    c->rest = fmin(2 * c->rest - REST_PER_LOSS * c->balance, REST_MOST);
    c->rest_until = mps__clock() + c->rest;
    c->balance = 0;
}

static bool is_resting(struct mps__crew *c)
{
    if (c->rest_until > 0 && mps__clock() >= c->rest_until) c->rest_until = 0;
    return c->rest_until > 0;
}

/* Processor time of the calling thread [s]: excludes preemption. */
static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void open_round(struct mps__crew *c, uint64_t round, int32_t parts)
{
    for (int32_t k = 0; k < c->seats; k++) {
        atomic_store_explicit(&c->seat[k].next, (int32_t)((int64_t)parts * k / c->seats),
                              memory_order_relaxed);
        c->seat[k].end = (int32_t)((int64_t)parts * (k + 1) / c->seats);
    }
    atomic_store_explicit(&c->seat[0].core, core_now(), memory_order_relaxed);
    atomic_store(&c->state, round << ROUND_SHIFT | OPEN);
    if (atomic_load(&c->sleepers) > 0) wake(c, &c->opened);
}

static void run_round(struct mps__crew *c, int32_t parts, mps_part_fn body, void *argument)
{
    const uint64_t round = (atomic_load(&c->state) >> ROUND_SHIFT) + 1;
    const bool measured = round % MEASURED == 0;
    const double begin = mps__clock();
    c->body = body;
    c->argument = argument;
    open_round(c, round, parts);
    const double before = measured ? processor_time() : 0;
    const int32_t taken = take_parts(c, 0);
    const double worked = measured ? processor_time() - before : 0;
    atomic_fetch_and(&c->state, ~OPEN);
    /* Waiting for threads preempted in the middle of a part. Less than the caller's own time for
     * their parts is no loss. */
    const double held_up = await_empty(c), all = held_up > 0 || measured ? mps__clock() - begin : 0;
    const double lost = fmax(held_up - (all - held_up) * (c->seats - 1), 0);
    if (lost > 0) book(c, -lost);
    if (measured && taken > 0) book(c, MEASURED * (worked * parts / taken - (all - lost)));
}

/* ---- a crew ---- */

static void drop_crew(mps__pool *p)
{
    struct mps__crew *c = p->crew;
    p->crew = NULL;
    p->tried = false;
    if (!c) return;
    atomic_fetch_or(&c->state, QUIT);
    wake(c, &c->opened);
    for (int32_t k = 1; k < c->seats; k++) pthread_join(c->seat[k].thread, NULL);
    pthread_cond_destroy(&c->empty);
    pthread_cond_destroy(&c->opened);
    pthread_mutex_destroy(&c->lock);
    mps__free(p->context, c);
}

/* Start as many threads as possible. They block signals, which belong to the application. */
static void start_threads(struct mps__crew *c, int32_t seats)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    c->seat[0].crew = c;
    for (c->seats = 1; c->seats < seats; c->seats++) {
        seat *s = &c->seat[c->seats];
        s->crew = c;
        if (pthread_create(&s->thread, NULL, work, s)) break;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

/* Without memory or threads loops run in the calling thread: no failure, hence no error text. */
static void make_crew(mps__pool *p)
{
    const mps_allocator *a = &p->context->allocator;
    const size_t bytes = sizeof *p->crew + (size_t)p->parallel.threads * sizeof *p->crew->seat;
    struct mps__crew *c = a->alloc(a->user, bytes);
    p->tried = true;
    if (!c) return;
    memset(c, 0, bytes);
    const bool lock = !pthread_mutex_init(&c->lock, NULL),
               opened = !pthread_cond_init(&c->opened, NULL);
    if (lock && opened && !pthread_cond_init(&c->empty, NULL)) {
        start_threads(c, p->parallel.threads);
        p->crew = c;
        return;
    }
    if (lock) pthread_mutex_destroy(&c->lock);
    if (opened) pthread_cond_destroy(&c->opened);
    mps__free(p->context, c);
}

static void run_pool(void *user, int32_t parts, mps_part_fn body, void *argument)
{
    mps__pool *p = user;
    struct mps__crew *c = p->crew;
    if (!p->tried) {
        make_crew(p);
        c = p->crew;
    }
    if (c && c->seats > 1 && !atomic_exchange(&c->busy, true)) {
        const bool alone = is_resting(c);
        if (!alone) run_round(c, parts, body, argument);
        atomic_store(&c->busy, false);
        if (!alone) return;
    }
    for (int32_t part = 0; part < parts; part++) body(argument, part);
}

/* ---- the pool ---- */

mps_status mps_parallel_init(mps_parallel *parallel, size_t size)
{
    static const mps_parallel one = {.struct_size = sizeof one, .threads = 1};
    return mps__struct_init("mps_parallel", parallel, size, &one, sizeof one);
}

void mps__pool_init(mps__pool *p, mps__context *context)
{
    *p = (mps__pool){.context = context, .own = true};
    p->parallel = (mps_parallel){
        .struct_size = sizeof p->parallel, .threads = 1, .run = run_pool, .user = p};
}

mps_status mps__pool_set(mps__pool *p, const mps_parallel *host, const char *what)
{
    if (host->run) {
        MPS__CHECK(p->context, mps__struct_check(NULL, "mps_parallel", host) == MPS_OK,
                   "%s.struct_size is %u: call mps_parallel_init() first", what, host->struct_size);
    }
    MPS__CHECK(p->context, host->threads >= 0 && host->threads <= MPS__THREADS_MOST,
               "%s.threads is %d: 0..%d", what, host->threads, MPS__THREADS_MOST);
    drop_crew(p);
    p->own = !host->run;
    p->parallel.run = p->own ? run_pool : host->run;
    p->parallel.user = p->own ? p : host->user;
    if (host->threads > 1) p->parallel.threads = host->threads;
    return MPS_OK;
}

void mps__pool_resize(mps__pool *p, int32_t threads)
{
    if (threads == p->parallel.threads) return;
    drop_crew(p);
    p->parallel.threads = threads;
}

void mps__pool_free(mps__pool *p)
{
    drop_crew(p);
}

/* ---- loops ---- */

typedef struct zeroing {
    const mps__block *blocks;
    int32_t count;
} zeroing;

/* Zero the numbers begin..end-1 of the concatenated blocks. */
static void zero_rows(void *argument, int64_t begin, int64_t end)
{
    const zeroing *z = argument;
    for (int32_t k = 0; k < z->count && end > 0; k++) {
        const int64_t count = z->blocks[k].count, last = end < count ? end : count;
        if (begin < last)
            memset(z->blocks[k].values + begin, 0, (size_t)(last - begin) * sizeof(double));
        begin = begin > count ? begin - count : 0;
        end -= count;
    }
}

void mps__parallel_zero(const mps_parallel *p, const mps__block *blocks, int32_t count)
{
    mps__device *d = mps__device_of(p);
    int64_t all = 0;
    for (int32_t k = 0; d && k < count; k++)
        mps__device_clear(d, blocks[k].values, (size_t)blocks[k].count * sizeof(double));
    for (int32_t k = 0; !d && k < count; k++) all += blocks[k].count;
    mps_parallel_rows_least(p, all, MPS__ROWS_CHEAP, zero_rows, &(zeroing){blocks, count});
}

typedef struct copying {
    char *to;
    const char *from;
} copying;

static void copy_rows(void *argument, int64_t begin, int64_t end)
{
    const copying *c = argument;
    memcpy(c->to + begin, c->from + begin, (size_t)(end - begin));
}

void mps__parallel_copy(const mps_parallel *p, void *to, const void *from, size_t bytes)
{
    mps__device *d = mps__device_of(p);
    if (d)
        mps__device_copy(d, to, from, bytes);
    else
        mps_parallel_rows_least(p, (int64_t)bytes, MPS__ROWS_CHEAP * sizeof(double), copy_rows,
                                &(copying){to, from});
}
