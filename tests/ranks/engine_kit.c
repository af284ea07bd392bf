/* SPDX-License-Identifier: BSD-3-Clause */
/* Conformance of a communication engine: values are functions of ranks and positions, so that each
 * rank knows the values that it must receive. */
#include "engine_kit.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 2000, COMMON = 300, LARGE = 30000 };

typedef struct kit {
    const mps_ranks_ops *ops;
    void *self;
    int32_t rank, ranks;
    char *fault;
} kit;

__attribute__((format(printf, 3, 4))) static void expect(kit *k, bool met, const char *format, ...)
{
    va_list list;
    if (met || k->fault[0]) return;
    const int length = snprintf(k->fault, ENGINE_TEXT, "rank %d of %d: ", (int)k->rank,
                                (int)k->ranks);
    va_start(list, format);
    vsnprintf(k->fault + length, (size_t)(ENGINE_TEXT - length), format, list);
    va_end(list);
}

static void *take(size_t bytes)
{
    void *block = calloc(bytes + 1, 1);
    if (!block) abort();
    return block;
}

static void *alloc(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void release(void *user, void *block)
{
    (void)user;
    free(block);
}

static const mps_allocator allocator = {alloc, release, NULL};

static uint32_t mix(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t h = a * 0x9e3779b1u ^ (b + 0x85ebca6bu) * 0xc2b2ae35u ^
                 (c + 0x27d4eb2fu) * 0x165667b1u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    return h ^ h >> 15;
}

static double fraction(uint32_t a, uint32_t b, uint32_t c)
{
    return (double)(mix(a, b, c) >> 8) / (1 << 24);
}

static bool begin(kit *k, const mps_ranks_ops *ops, char *fault)
{
    char text[ENGINE_TEXT] = "";
    *k = (kit){.ops = ops, .self = ops->user, .fault = fault, .rank = -1};
    const int failed = ops->create(&allocator, &k->self, text, sizeof text);
    expect(k, !failed, "create fails: %s", text);
    if (failed) return false;
    ops->place(k->self, &k->rank, &k->ranks);
    expect(k, k->rank >= 0 && k->rank < k->ranks, "place");
    expect(k, !ops->failure(k->self), "failure before any");
    return true;
}

/* ---- reductions and gathers ---- */

static void add(void *into, const void *from)
{
    int64_t a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    a += b;
    memcpy(into, &a, sizeof a);
}

typedef struct winner {
    double value;
    int64_t rank;
    char name[23]; /* not aligned */
} winner;

static void larger(void *into, const void *from)
{
    winner a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    if (b.value > a.value || (b.value == a.value && b.rank < a.rank)) memcpy(into, from, sizeof b);
}

static void check_sums(kit *k, int32_t count)
{
    int64_t *sums = take((size_t)count * sizeof *sums);
    for (int32_t i = 0; i < count; i++) sums[i] = (int64_t)i * (k->rank + 1);
    expect(k, !k->ops->reduce(k->self, count, sizeof *sums, sums, add), "reduce fails");
    const int64_t all = (int64_t)k->ranks * (k->ranks + 1) / 2;
    for (int32_t i = 0; i < count; i++)
        expect(k, sums[i] == i * all, "sum %d of %d is %lld, not %lld", (int)i, (int)count,
               (long long)sums[i], (long long)(i * all));
    free(sums);
}

static void check_maxima(kit *k, uint32_t round)
{
    winner w[3], best[3];
    memset(w, 0, sizeof w);
    for (uint32_t i = 0; i < 3; i++) {
        for (int32_t r = 0; r < k->ranks; r++) {
            winner one;
            memset(&one, 0, sizeof one);
            one.value = (double)(mix(round, i, (uint32_t)r) % 3); /* often equal */
            one.rank = r;
            snprintf(one.name, sizeof one.name, "rank %d", (int)r);
            if (r == k->rank) w[i] = one;
            if (r == 0)
                best[i] = one;
            else
                larger(&best[i], &one);
        }
    }
    expect(k, !k->ops->reduce(k->self, 3, sizeof *w, w, larger), "reduce fails");
    expect(k, memcmp(w, best, sizeof w) == 0, "largest of structs: %g of %s, not %g of %s",
           w[0].value, w[0].name, best[0].value, best[0].name);
}

/* Sizes of blocks: round 0 all empty, 1 some, else any. */
static void check_gather(kit *k, uint32_t round, uint32_t most)
{
    int64_t *bytes = take((size_t)k->ranks * sizeof *bytes), sum = 0;
    for (int32_t r = 0; r < k->ranks; r++) {
        const uint32_t h = mix(round, 77, (uint32_t)r);
        bytes[r] = round == 0 || (round == 1 && h % 2) ? 0 : h / 7 % most;
        sum += bytes[r];
    }
    unsigned char *own = take((size_t)bytes[k->rank]), *all = take((size_t)sum), *at = all;
    for (int64_t i = 0; i < bytes[k->rank]; i++)
        own[i] = (unsigned char)mix(round, (uint32_t)k->rank, (uint32_t)i);
    expect(k, !k->ops->gather(k->self, own, bytes, all), "gather fails");
    for (int32_t r = 0; r < k->ranks; at += bytes[r++])
        for (int64_t i = 0; i < bytes[r]; i++)
            expect(k, at[i] == (unsigned char)mix(round, (uint32_t)r, (uint32_t)i),
                   "gather: byte %lld of %lld of rank %d", (long long)i, (long long)bytes[r],
                   (int)r);
    free(bytes);
    free(own);
    free(all);
}

/* ---- cuts ---- */

/* The same on all ranks? */
static void expect_alike(kit *k, const void *data, int64_t size, const char *what)
{
    int64_t *bytes = take((size_t)k->ranks * sizeof *bytes);
    for (int32_t r = 0; r < k->ranks; r++) bytes[r] = size;
    char *all = take((size_t)(size * k->ranks));
    expect(k, !k->ops->gather(k->self, data, bytes, all), "gather fails");
    for (int32_t r = 0; r < k->ranks; r++)
        expect(k, memcmp(all + r * size, data, (size_t)size) == 0, "%s is not that of rank %d",
               what, (int)r);
    free(bytes);
    free(all);
}

/* Any position in a box is owned by a rank of its list. */
static void check_boxes(kit *k, int dim, const double *x, const int32_t *owner)
{
    int32_t *list = take((size_t)k->ranks * sizeof *list), count = -1;
    for (uint32_t i = 0; i < COMMON; i++) {
        double lo[3], hi[3];
        for (int d = 0; d < dim; d++) {
            const double size = i % 4 == 0 ? 0
                                           : fraction(i, 5, (uint32_t)d) * (i % 4 == 1 ? 0.05 : 1);
            lo[d] = x[i * (uint32_t)dim + (uint32_t)d] - size * fraction(i, 6, (uint32_t)d);
            hi[d] = lo[d] + size;
        }
        expect(k, !k->ops->overlap(k->self, lo, hi, list, &count), "overlap fails");
        expect(k, count >= 1 && count <= k->ranks, "overlap has %d ranks", (int)count);
        for (int32_t n = 0; n < count; n++)
            expect(k, list[n] >= (n ? list[n - 1] + 1 : 0) && list[n] < k->ranks,
                   "ranks of overlap do not ascend");
        for (uint32_t j = 0; j < COMMON; j++) {
            bool inside = true, listed = false;
            const double *y = x + j * (uint32_t)dim;
            for (int d = 0; d < dim; d++) inside = inside && y[d] >= lo[d] && y[d] <= hi[d];
            for (int32_t n = 0; n < count; n++) listed = listed || list[n] == owner[j];
            expect(k, !inside || listed, "a place of rank %d in a box of others", (int)owner[j]);
        }
    }
    free(list);
}

static void check_owners(kit *k, int dim)
{
    double x[COMMON * 3];
    int32_t owner[COMMON], again;
    for (uint32_t i = 0; i < (uint32_t)(COMMON * dim); i++) {
        x[i] = 1.4 * fraction(i, 1, 2) - 0.2;
        if (i % 3 == 0) x[i] = (double)(mix(i, 3, 4) % 11) / 10; /* those of the lattice */
    }
    memset(owner, -1, sizeof owner);
    expect(k, !k->ops->owner(k->self, COMMON, x, owner), "owner fails");
    expect(k, !k->ops->owner(k->self, 0, x, &again), "owner of no place fails");
    for (int i = 0; i < COMMON; i++) {
        expect(k, owner[i] >= 0 && owner[i] < k->ranks, "owner is %d", (int)owner[i]);
        expect(k, !k->ops->owner(k->self, 1, x + i * dim, &again) && again == owner[i],
               "owner depends on how many places are requested");
    }
    expect_alike(k, owner, sizeof owner, "owner of a place");
    check_boxes(k, dim, x, owner);
}

/* Positions of a partition: random, on a lattice, or all equal. */
enum { RANDOM, LATTICE, POINT, NONE };

static void check_balance(kit *k, int64_t n, const double *x, const float *weight, double balance)
{
    int32_t *owner = take((size_t)n * sizeof *owner);
    int64_t *sum = take((size_t)k->ranks * sizeof *sum), all = 0, most = 0;
    expect(k, !k->ops->owner(k->self, n, x, owner), "owner fails");
    for (int64_t i = 0; i < n; i++) sum[owner[i]] += (int64_t)(weight[i] * 1024);
    expect(k, !k->ops->reduce(k->self, k->ranks, sizeof *sum, sum, add), "reduce fails");
    for (int32_t r = 0; r < k->ranks; r++) {
        all += sum[r];
        most = sum[r] > most ? sum[r] : most;
    }
    const double over = (double)most * k->ranks / (double)all;
    expect(k, balance == 0 || over < balance, "a rank owns %g of the mean, at most %g", over,
           balance);
    free(owner);
    free(sum);
}

static void check_cuts(kit *k, int dim, int form, uint32_t round, double balance)
{
    const int64_t n = form == NONE || (k->rank == 1 && form == LATTICE) ? 0 : PLACES + 37 * k->rank;
    double *x = take((size_t)(n * dim) * sizeof *x);
    float *weight = take((size_t)n * sizeof *weight);
    for (int64_t i = 0; i < n; i++) {
        weight[i] = (float)(0.05 + fraction(round, (uint32_t)i, 9) * 1.8);
        for (int d = 0; d < dim; d++) {
            const uint32_t axis = (uint32_t)(3 * k->rank + d);
            const double at = fraction(round, (uint32_t)i, axis);
            x[i * dim + d] = form == RANDOM ? at * at : form == POINT ? 0.5 : (int)(at * 11) / 10.0;
        }
    }
    expect(k, !k->ops->partition(k->self, dim, n, x, weight), "partition fails");
    check_owners(k, dim);
    if (form == RANDOM) check_balance(k, n, x, weight, balance);
    free(x);
    free(weight);
}

/* ---- routes ---- */

/* Elements that a rank sends to another: mostly none. */
static int64_t elements(uint32_t round, int32_t from, int32_t to, int64_t most)
{
    const uint32_t h = mix(round, (uint32_t)from, (uint32_t)to + 1000);
    if (from == to || round == 0 || h % 3 == 0) return 0;
    return 1 + (h / 3) % most;
}

static unsigned char byte_of(uint32_t round, int32_t from, int32_t to, int64_t at)
{
    return (unsigned char)mix(round + (uint32_t)from * 100, (uint32_t)to, (uint32_t)at);
}

static void connect_ranks(kit *k, uint32_t round, int64_t most, mps_route *route)
{
    int32_t *to = take((size_t)k->ranks * sizeof *to), count = 0, from = 0;
    int64_t *sent = take((size_t)k->ranks * sizeof *sent);
    for (int32_t r = 0; r < k->ranks; r++) {
        const int64_t n = elements(round, k->rank, r, most);
        if (n == 0) continue;
        to[count] = r;
        sent[count++] = n;
    }
    expect(k, !k->ops->connect(k->self, count, to, sent, route), "connect fails");
    expect(k, route->to_count == count, "route sends to %d ranks", (int)route->to_count);
    for (int32_t i = 0; i < count && !k->fault[0]; i++)
        expect(k, route->to[i] == to[i] && route->sent[i] == sent[i], "what a route sends");
    for (int32_t r = 0; r < k->ranks && !k->fault[0]; r++) {
        const int64_t n = elements(round, r, k->rank, most);
        if (n == 0) continue;
        expect(k, from < route->from_count && route->from[from] == r && route->received[from] == n,
               "what a route receives from rank %d", (int)r);
        from++;
    }
    expect(k, route->from_count == from, "route receives from %d ranks", (int)route->from_count);
    free(to);
    free(sent);
}

static void check_exchange(kit *k, const mps_route *route, uint32_t round, size_t bytes)
{
    int64_t outs = 0, ins = 0;
    for (int32_t i = 0; i < route->to_count; i++) outs += route->sent[i];
    for (int32_t i = 0; i < route->from_count; i++) ins += route->received[i];
    unsigned char *out = take((size_t)outs * bytes), *in = take((size_t)ins * bytes), *at = out;
    for (int32_t i = 0; i < route->to_count; i++)
        for (int64_t b = 0; b < route->sent[i] * (int64_t)bytes; b++)
            *at++ = byte_of(round, k->rank, route->to[i], b);
    expect(k,
           !k->ops->exchange_begin(k->self, route, bytes, out, in) &&
               !k->ops->exchange_end(k->self, route),
           "exchange fails");
    at = in;
    for (int32_t i = 0; i < route->from_count; i++)
        for (int64_t b = 0; b < route->received[i] * (int64_t)bytes; b++)
            expect(k, *at++ == byte_of(round, route->from[i], k->rank, b),
                   "byte %lld from rank %d, elements of %zu bytes", (long long)b,
                   (int)route->from[i], bytes);
    free(out);
    free(in);
}

static void check_routes(kit *k)
{
    static const size_t bytes[] = {1, 8, 24, 513};
    mps_route keep, route;
    connect_ranks(k, 99, 7, &keep);
    for (uint32_t round = 0; round < 8; round++) {
        connect_ranks(k, round, 1 + 40 * round, &route);
        for (int b = 0; b < 4; b++) check_exchange(k, &route, round + (uint32_t)b, bytes[b]);
        check_exchange(k, &keep, round, 16);
        k->ops->disconnect(k->self, &route);
    }
    k->ops->disconnect(k->self, &keep);
    connect_ranks(k, 8, LARGE, &route);
    for (uint32_t round = 0; round < 3; round++) check_exchange(k, &route, round, 24);
    k->ops->disconnect(k->self, &route);
}

void engine_kit_check(const mps_ranks_ops *ops, double balance, char *fault)
{
    kit k;
    if (!begin(&k, ops, fault)) return;
    for (int32_t count = 1; count < 3000; count = 7 * count + 1) check_sums(&k, count);
    for (uint32_t round = 0; round < 10; round++) {
        check_maxima(&k, round);
        check_gather(&k, round, round == 9 ? LARGE * 8 : 300);
    }
    for (int dim = 2; dim <= 3; dim++)
        for (int form = RANDOM; form <= NONE; form++)
            check_cuts(&k, dim, form, (uint32_t)(10 * dim + form), balance);
    check_routes(&k);
    expect(&k, !k.ops->failure(k.self), "failure: %s", k.ops->failure(k.self));
    ops->destroy(&allocator, k.self);
}

/* ---- failures ---- */

static int call_partition(kit *k)
{
    const double x[6] = {0, 0, 0, 1, 1, 1};
    const float weight[2] = {1, 1};
    return k->ops->partition(k->self, 3, 2, x, weight);
}

/* Large messages with all ranks; after a failure the engine must not use the arrays. */
static int call_exchange(kit *k, const mps_route *route)
{
    char *out = take((size_t)k->ranks * LARGE * 8), *in = take((size_t)k->ranks * LARGE * 8);
    const int failed = k->ops->exchange_begin(k->self, route, 8, out, in) ||
                       k->ops->exchange_end(k->self, route);
    free(out);
    free(in);
    return failed;
}

static int make_call(kit *k, int call, mps_route *route)
{
    int64_t *values = take((size_t)k->ranks * sizeof *values), number = 8;
    int32_t *to = take((size_t)k->ranks * sizeof *to), count = 0, failed = 0;
    mps_route other = {0};
    for (int32_t r = 0; r < k->ranks; r++)
        if (r != k->rank) to[count++] = r;
    for (int32_t r = 0; r < k->ranks; r++)
        values[r] = call == ENGINE_CONNECT ? LARGE : (int64_t)sizeof number;
    char *all = take((size_t)k->ranks * sizeof number);
    if (call == ENGINE_REDUCE) failed = k->ops->reduce(k->self, 1, sizeof number, &number, add);
    if (call == ENGINE_GATHER) failed = k->ops->gather(k->self, &number, values, all);
    if (call == ENGINE_CONNECT)
        failed = k->ops->connect(k->self, count, to, values, route ? route : &other);
    if (!failed && other.data) k->ops->disconnect(k->self, &other);
    if (call == ENGINE_EXCHANGE) failed = call_exchange(k, route);
    if (call == ENGINE_PARTITION) failed = call_partition(k);
    free(values);
    free(to);
    free(all);
    return failed;
}

void engine_kit_fail(const mps_ranks_ops *ops, int call, int32_t also, char *said, char *fault)
{
    kit k;
    mps_route route = {0};
    char text[ENGINE_TEXT];
    int failed = 0;
    if (!begin(&k, ops, fault)) return;
    failed = make_call(&k, ENGINE_CONNECT, &route); /* another rank may have left it and failed */
    expect(&k, !failed || ops->failure(k.self), "connect fails");
    snprintf(text, sizeof text, "rank %d fails in call %d", (int)k.rank, call);
    if (k.rank == k.ranks - 1 || k.rank == also)
        ops->fail(k.self, text);
    else /* one exchange may end without the rank that fails */
        for (int turn = 0; turn < 3 && !failed; turn++)
            failed = make_call(&k, call, call == ENGINE_CONNECT ? NULL : &route);
    for (int other = 0; other < ENGINE_CALLS; other++)
        expect(&k, make_call(&k, other, other == ENGINE_CONNECT ? NULL : &route),
               "call %d does not fail after a failure in %d", other, call);
    const char *what = ops->failure(k.self);
    snprintf(said, ENGINE_TEXT, "%s", what ? what : "no failure");
    snprintf(text, sizeof text, "rank %d fails in call %d", (int)k.ranks - 1, call);
    expect(&k, also >= 0 || strcmp(said, text) == 0, "the text is '%s', not '%s'", said, text);
    ops->disconnect(k.self, &route);
    ops->destroy(&allocator, k.self);
}
