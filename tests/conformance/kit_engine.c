/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks as threads. A rank posts pointers; after a barrier the others read them, after a second
 * barrier the owner continues. Space is partitioned by recursive coordinate bisection, which each
 * rank computes itself from all positions. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include "kit_engine.h"
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 64, TEXT = 512 };

typedef struct cut {
    int32_t axis; /* -1: all of it belongs to rank `first` */
    double at;
    int32_t first, middle, end; /* ranks first..middle-1 are below, middle..end-1 are not */
} cut;

/* A rank: what it posts, and its copy of the cuts. */
typedef struct seat {
    kit_engine_team *team;
    int32_t rank, dim, cuts;
    cut cut[2 * RANKS];
    /* posted */
    const char *call;
    int64_t size; /* size of an argument that must be equal on all ranks; 0: different ones */
    const void *out;
    const mps_route *route;
    void *in;
    size_t bytes;
    int64_t n;
    const double *x;
    const float *weight;
    uint32_t random; /* the same on all ranks */
} seat;

struct kit_engine_team {
    int32_t ranks, waiting, gone; /* gone: ranks whose function has returned */
    int64_t round;
    bool failed;
    char text[TEXT];
    pthread_mutex_t lock;
    pthread_cond_t next;
    seat seat[RANKS];
};

kit_engine_team *kit_engine_create(int32_t ranks, uint32_t skew)
{
    kit_engine_team *t = calloc(1, sizeof *t);
    if (!t || ranks > RANKS) abort();
    t->ranks = ranks;
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->next, NULL);
    for (int32_t r = 0; r < ranks; r++)
        t->seat[r] = (seat){
            .team = t, .rank = r, .random = skew, .cuts = 1, .cut = {{.axis = -1, .first = 0}}};
    return t;
}

void kit_engine_destroy(kit_engine_team *t)
{
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->next);
    free(t);
}

/* With the lock: the run ends on all ranks. */
static void end_team(kit_engine_team *t, const char *text)
{
    if (!t->failed) snprintf(t->text, sizeof t->text, "%s", text);
    t->failed = true;
    pthread_cond_broadcast(&t->next);
}

/* With the lock, when all wait: they must be in the same call. */
static void compare_calls(kit_engine_team *t)
{
    char text[TEXT];
    for (int32_t r = 1; r < t->ranks && !t->failed; r++) {
        const seat *first = &t->seat[0], *own = &t->seat[r];
        if (strcmp(own->call, first->call) == 0 && own->size == first->size) continue;
        snprintf(
            text, sizeof text,
            "ranks make different calls: '%s' of %lld bytes on rank 0, '%s' of %lld on rank %d",
            first->call, (long long)first->size, own->call, (long long)own->size, (int)r);
        end_team(t, text);
    }
}

/* Call with the lock held: ranks that wait for a rank whose function has returned would wait
 * forever. */
static void look_for_gone(kit_engine_team *t)
{
    char text[TEXT];
    int32_t waits = 0, gone = 0;
    if (t->failed || t->gone == 0 || t->waiting == 0 || t->waiting + t->gone < t->ranks) return;
    while (!t->seat[waits].call) waits++;
    while (t->seat[gone].call) gone++;
    snprintf(text, sizeof text, "ranks make different calls: '%s' on rank %d, none on rank %d",
             t->seat[waits].call, (int)waits, (int)gone);
    end_team(t, text);
}

/* Wait for all ranks. @return non-zero if one has failed */
static int barrier(seat *s, const char *call)
{
    kit_engine_team *t = s->team;
    pthread_mutex_lock(&t->lock);
    const int64_t round = t->round;
    s->call = call;
    if (++t->waiting == t->ranks) compare_calls(t);
    look_for_gone(t);
    if (t->waiting == t->ranks && !t->failed) {
        t->waiting = 0;
        t->round++;
        pthread_cond_broadcast(&t->next);
    }
    while (t->round == round && !t->failed) pthread_cond_wait(&t->next, &t->lock);
    const bool failed = t->failed;
    pthread_mutex_unlock(&t->lock);
    return failed;
}

static int create(const mps_allocator *allocator, void **self, char *text, size_t size)
{
    (void)allocator, (void)self, (void)text, (void)size; /* the seat is the state */
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
}

static void place(void *self, int32_t *rank, int32_t *ranks)
{
    const seat *s = self;
    *rank = s->rank;
    *ranks = s->team->ranks;
}

/* ---- cuts ---- */

typedef struct point {
    double x[3];
    float weight;
} point;

static int sort_axis_of_thread(const void *a, const void *b, int axis)
{
    const double x = ((const point *)a)->x[axis], y = ((const point *)b)->x[axis];
    return (x > y) - (x < y);
}
static int by_x(const void *a, const void *b)
{
    return sort_axis_of_thread(a, b, 0);
}
static int by_y(const void *a, const void *b)
{
    return sort_axis_of_thread(a, b, 1);
}
static int by_z(const void *a, const void *b)
{
    return sort_axis_of_thread(a, b, 2);
}

static int longest_axis(const point *p, int64_t n, int32_t dim)
{
    int axis = 0;
    double most = -1;
    for (int d = 0; d < dim; d++) {
        double lo = INFINITY, hi = -INFINITY;
        for (int64_t k = 0; k < n; k++) {
            lo = fmin(lo, p[k].x[d]);
            hi = fmax(hi, p[k].x[d]);
        }
        if (hi - lo <= most) continue;
        most = hi - lo;
        axis = d;
    }
    return axis;
}

/* Fraction of the weight below a cut. */
static double share_of(seat *s, int32_t first, int32_t middle, int32_t end)
{
    const double even = (double)(middle - first) / (end - first);
    if (s->random == 0) return even;
    s->random = s->random * 1664525u + 1013904223u;
    return even * (0.4 + 1.2 * (double)(s->random >> 8) / (1 << 24));
}

static void cut_points(seat *s, point *p, int64_t n, int32_t first, int32_t end)
{
    cut *c = &s->cut[s->cuts++];
    *c = (cut){.axis = -1, .first = first, .end = end};
    if (end - first == 1) return;
    c->middle = first + (end - first) / 2;
    c->axis = longest_axis(p, n, s->dim);
    qsort(p, (size_t)n, sizeof *p, c->axis == 0 ? by_x : c->axis == 1 ? by_y : by_z);
    double all = 0, below = 0;
    int64_t k = 0;
    for (int64_t i = 0; i < n; i++) all += p[i].weight;
    const double wanted = share_of(s, first, c->middle, end) * all;
    while (k < n && below < wanted) below += p[k++].weight;
    c->at = n == 0 ? 0 : k < n ? p[k].x[c->axis] : p[n - 1].x[c->axis];
    while (k > 0 && p[k - 1].x[c->axis] >= c->at) k--;
    const int32_t middle = c->middle;
    cut_points(s, p, k, first, middle);
    cut_points(s, p + k, n - k, middle, end);
}

static int partition(void *self, int32_t dim, int64_t n, const double *x, const float *weight)
{
    seat *s = self;
    kit_engine_team *t = s->team;
    int64_t all = 0, at = 0;
    s->n = n;
    s->x = x;
    s->weight = weight;
    if (barrier(s, "partition")) return 1;
    for (int32_t r = 0; r < t->ranks; r++) all += t->seat[r].n;
    point *p = malloc((size_t)(all + 1) * sizeof *p);
    if (!p) abort();
    for (int32_t r = 0; r < t->ranks; r++)
        for (int64_t i = 0; i < t->seat[r].n; i++, at++) {
            p[at] = (point){.weight = t->seat[r].weight[i]};
            for (int d = 0; d < dim; d++) p[at].x[d] = t->seat[r].x[i * dim + d];
        }
    s->dim = dim;
    s->cuts = 0;
    cut_points(s, p, all, 0, t->ranks);
    free(p);
    return barrier(s, "partition");
}

/* Index in cut[] of the part above: a cut is followed by all cuts below it. */
static int32_t above(const seat *s, int32_t k)
{
    return k + 1 + 2 * (s->cut[k].middle - s->cut[k].first) - 1;
}

static int owner(void *self, int64_t n, const double *x, int32_t *rank)
{
    const seat *s = self;
    for (int64_t i = 0; i < n; i++) {
        int32_t k = 0;
        while (s->cut[k].axis >= 0)
            k = x[i * s->dim + s->cut[k].axis] < s->cut[k].at ? k + 1 : above(s, k);
        rank[i] = s->cut[k].first;
    }
    return 0;
}

static void find_overlap(const seat *s, int32_t k, const double *lo, const double *hi,
                         int32_t *rank, int32_t *count)
{
    const cut *c = &s->cut[k];
    if (c->axis < 0) {
        rank[(*count)++] = c->first;
        return;
    }
    if (lo[c->axis] < c->at) find_overlap(s, k + 1, lo, hi, rank, count);
    if (hi[c->axis] >= c->at) find_overlap(s, above(s, k), lo, hi, rank, count);
}

static int overlap(void *self, const double *lo, const double *hi, int32_t *rank, int32_t *count)
{
    *count = 0;
    find_overlap(self, 0, lo, hi, rank, count);
    return 0;
}

/* ---- messages ---- */

static void fail(void *self, const char *text)
{
    kit_engine_team *t = ((seat *)self)->team;
    pthread_mutex_lock(&t->lock);
    end_team(t, text);
    pthread_mutex_unlock(&t->lock);
}

/* Elements that a rank sends to another, and how many go to others before them. */
static int64_t sent_to(const mps_route *route, int32_t rank, int64_t *before)
{
    *before = 0;
    for (int32_t k = 0; k < route->to_count; k++) {
        if (route->to[k] == rank) return route->sent[k];
        *before += route->sent[k];
    }
    return 0;
}

static void disconnect_ranks(void *self, mps_route *route)
{
    (void)self;
    free(route->data);
    free((void *)route->sent);
    *route = (mps_route){0};
}

static int connect_ranks(void *self, int32_t count, const int32_t *to, const int64_t *sent,
                         mps_route *route)
{
    seat *s = self;
    kit_engine_team *t = s->team;
    int32_t *list = calloc(2 * RANKS, sizeof *list);
    int64_t *elements = calloc(2 * RANKS, sizeof *elements), before;
    if (!list || !elements) abort();
    memcpy(list, to, (size_t)count * sizeof *to);
    memcpy(elements, sent, (size_t)count * sizeof *sent);
    *route = (mps_route){.to_count = count,
                         .to = list,
                         .sent = elements,
                         .from = list + RANKS,
                         .received = elements + RANKS,
                         .data = list};
    s->route = route;
    int failed = barrier(s, "connect");
    for (int32_t r = 0; r < t->ranks && !failed; r++) {
        const int64_t received = r == s->rank ? 0 : sent_to(t->seat[r].route, s->rank, &before);
        if (received == 0) continue;
        list[RANKS + route->from_count] = r;
        elements[RANKS + route->from_count++] = received;
    }
    failed = barrier(s, "connect") || failed;
    if (failed) disconnect_ranks(self, route); /* all others have read it, or none has */
    return failed;
}

static int exchange_begin(void *self, const mps_route *route, size_t bytes, const void *out,
                          void *in)
{
    seat *s = self;
    s->route = route;
    s->bytes = bytes;
    s->out = out;
    s->in = in;
    return 0;
}

static int exchange_end(void *self, const mps_route *route)
{
    seat *s = self;
    kit_engine_team *t = s->team;
    char *in = s->in;
    if (barrier(s, "exchange")) return 1;
    for (int32_t k = 0; k < route->from_count; k++) {
        const seat *from = &t->seat[route->from[k]];
        int64_t before;
        const int64_t elements = sent_to(from->route, s->rank, &before);
        if (elements != route->received[k] || from->bytes != s->bytes) {
            fail(self, "ranks exchange different arrays");
            return 1;
        }
        memcpy(in, (const char *)from->out + (size_t)before * s->bytes,
               (size_t)elements * s->bytes);
        in += (size_t)elements * s->bytes;
    }
    return barrier(s, "exchange");
}

static int reduce(void *self, int32_t count, size_t bytes, void *values, mps_combine_fn combine)
{
    seat *s = self;
    kit_engine_team *t = s->team;
    char *result = malloc((size_t)count * bytes);
    if (!result) abort();
    s->out = values;
    s->size = count * (int64_t)bytes;
    int failed = barrier(s, "reduce");
    for (int32_t r = 0; r < t->ranks && !failed; r++)
        for (int32_t k = 0; k < count; k++) {
            const char *from = (const char *)t->seat[r].out + (size_t)k * bytes;
            if (r == 0)
                memcpy(result + (size_t)k * bytes, from, bytes);
            else
                combine(result + (size_t)k * bytes, from);
        }
    failed = barrier(s, "reduce") || failed;
    if (!failed) memcpy(values, result, (size_t)count * bytes);
    s->size = 0;
    free(result);
    return failed;
}

static int gather(void *self, const void *own, const int64_t *bytes, void *all)
{
    seat *s = self;
    kit_engine_team *t = s->team;
    char *at = all;
    s->out = own;
    int failed = barrier(s, "gather");
    for (int32_t r = 0; r < t->ranks && !failed; at += bytes[r++])
        if (bytes[r] > 0) memcpy(at, t->seat[r].out, (size_t)bytes[r]);
    return barrier(s, "gather") || failed;
}

static const char *failure(void *self)
{
    kit_engine_team *t = ((seat *)self)->team;
    pthread_mutex_lock(&t->lock);
    const char *text = t->failed ? t->text : NULL;
    pthread_mutex_unlock(&t->lock);
    return text;
}

mps_ranks_ops kit_engine_ops(kit_engine_team *team, int32_t rank)
{
    return (mps_ranks_ops){.struct_size = sizeof(mps_ranks_ops),
                           .api = MPS_RANKS_API,
                           .name = "threads",
                           .create = create,
                           .destroy = destroy,
                           .place = place,
                           .partition = partition,
                           .owner = owner,
                           .overlap = overlap,
                           .connect = connect_ranks,
                           .disconnect = disconnect_ranks,
                           .exchange_begin = exchange_begin,
                           .exchange_end = exchange_end,
                           .reduce = reduce,
                           .gather = gather,
                           .fail = fail,
                           .failure = failure,
                           .user = &team->seat[rank]};
}

/* ---- threads ---- */

typedef struct task {
    kit_engine_team *team;
    void (*body)(void *argument, int32_t rank);
    void *argument;
    int32_t rank;
} task;

static void *run_task(void *argument)
{
    const task *k = argument;
    kit_engine_team *t = k->team;
    k->body(k->argument, k->rank);
    pthread_mutex_lock(&t->lock);
    t->gone++;
    t->seat[k->rank].call = NULL;
    look_for_gone(t);
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

void kit_engine_run(kit_engine_team *team, void (*body)(void *argument, int32_t rank),
                    void *argument)
{
    pthread_t thread[RANKS];
    task tasks[RANKS];
    team->gone = 0;
    for (int32_t r = 0; r < team->ranks; r++) {
        tasks[r] = (task){team, body, argument, r};
        if (pthread_create(&thread[r], NULL, run_task, &tasks[r])) abort();
    }
    for (int32_t r = 0; r < team->ranks; r++) pthread_join(thread[r], NULL);
}
