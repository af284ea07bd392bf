/* SPDX-License-Identifier: BSD-3-Clause */
/* Message-passing calls: checks, counters, failures. */
#include "ranks.h"
#include <stdio.h>
#include <string.h>

void mps__ranks_init(mps__ranks *r, mps__context *context)
{
    *r = (mps__ranks){.context = context, .count = 1};
}

static mps_status check_table(mps__context *c, const mps_ranks_ops *ops)
{
    MPS__CHECK(c, ops->api == MPS_RANKS_API, "mps_ranks_ops.api is %u: this version knows %u",
               ops->api, MPS_RANKS_API);
    MPS__CHECK(c, ops->name && ops->name[0], "mps_ranks_ops.name is NULL or empty");
    const bool complete = ops->create && ops->destroy && ops->place && ops->partition &&
                          ops->owner && ops->overlap && ops->connect && ops->disconnect &&
                          ops->exchange_begin && ops->exchange_end && ops->reduce && ops->gather &&
                          ops->fail && ops->failure;
    MPS__CHECK(c, complete, "engine of ranks '%s' lacks a function: all are needed", ops->name);
    return MPS_OK;
}

mps_status mps__ranks_set(mps__ranks *r, const mps_ranks_ops *ops)
{
    mps_ranks_ops copy = {0};
    MPS__TRY(mps__struct_in(r->context, "mps_ranks_ops", &copy, sizeof copy, ops));
    MPS__TRY(check_table(r->context, &copy));
    void *self = copy.user;
    char text[MPS__HINT_SIZE] = "";
    if (copy.create(&r->context->allocator, &self, text, sizeof text))
        return mps__fail(r->context, text[0] ? MPS_E_PLUGIN : MPS_E_NOMEM,
                         "engine of ranks '%s': %s", copy.name, text[0] ? text : "no memory");
    int32_t rank = -1, count = 0;
    copy.place(self, &rank, &count);
    if (count < 1 || rank < 0 || rank >= count) {
        copy.destroy(&r->context->allocator, self);
        return mps__fail(r->context, MPS_E_PLUGIN,
                         "engine of ranks '%s' says that this is rank %d of %d: must be 0..ranks-1",
                         copy.name, (int)rank, (int)count);
    }
    *r = (mps__ranks){
        .context = r->context, .ops = copy, .self = self, .rank = rank, .count = count};
    return MPS_OK;
}

void mps__ranks_free(mps__ranks *r)
{
    if (r->ops.destroy) r->ops.destroy(&r->context->allocator, r->self);
    mps__ranks_init(r, r->context);
}

mps_status mps__ranks_status(mps__ranks *r)
{
    if (!r->failed) return MPS_OK;
    const char *text = r->ops.failure(r->self);
    return mps__fail(r->context, MPS_E_RANKS, "%.400s",
                     text ? text : "the messages between ranks failed");
}

mps_status mps__ranks_report(mps__ranks *r, mps_status status)
{
    char text[MPS__ERROR_SIZE];
    if (!mps__ranks_many(r) || status >= 0 || r->failed) return status;
    snprintf(text, sizeof text, "rank %d of %d: %.400s", (int)r->rank, (int)r->count,
             r->context->error);
    r->failed = true;
    r->ops.fail(r->self, text);
    return status;
}

/* Whether the call is executed; counts it. */
static bool begin(mps__ranks *r, int64_t bytes)
{
    if (!mps__ranks_many(r) || r->failed) return false;
    r->rounds++;
    r->bytes += bytes;
    return true;
}

void mps__ranks_reduce(mps__ranks *r, int32_t count, size_t bytes, void *values,
                       mps_combine_fn combine)
{
    if (!begin(r, count * (int64_t)bytes)) return;
    const double start = mps__clock();
    r->failed = r->ops.reduce(r->self, count, bytes, values, combine) != 0;
    r->seconds += mps__clock() - start;
}

static void any_text(void *into, const void *from)
{
    char *a = into;
    const char *b = from;
    if (b[0] && (!a[0] || strcmp(b, a) < 0)) memcpy(a, b, MPS__ERROR_SIZE);
}

mps_status mps__ranks_text(mps__ranks *r, mps_status status)
{
    mps__ranks_reduce(r, 1, MPS__ERROR_SIZE, r->context->error, any_text);
    return status;
}

static void larger(void *into, const void *from)
{
    double a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    if (b > a) memcpy(into, from, sizeof b);
}

void mps__ranks_max(mps__ranks *r, int32_t count, double *values)
{
    mps__ranks_reduce(r, count, sizeof *values, values, larger);
}

mps_status mps__ranks_agree(mps__ranks *r, mps_status status)
{
    double worst = -(double)status;
    if (!mps__ranks_many(r)) return status;
    mps__ranks_max(r, 1, &worst);
    MPS__TRY(mps__ranks_status(r));
    if (!(worst > 0)) return status;
    if (status >= 0) r->context->error[0] = 0;
    return mps__ranks_text(r, (mps_status)-worst);
}

static void added(void *into, const void *from)
{
    int64_t a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    a += b;
    memcpy(into, &a, sizeof a);
}

void mps__ranks_add(mps__ranks *r, int32_t count, int64_t *values)
{
    mps__ranks_reduce(r, count, sizeof *values, values, added);
}

static void joined(void *into, const void *from)
{
    mps_exact_join(into, from);
}

void mps__ranks_sum(mps__ranks *r, int32_t count, mps_exact *sums)
{
    mps__ranks_reduce(r, count, sizeof *sums, sums, joined);
}

void mps__ranks_gather(mps__ranks *r, const void *own, const int64_t *bytes, void *all)
{
    if (!begin(r, r->count > 1 ? bytes[r->rank] : 0)) return;
    const double start = mps__clock();
    r->failed = r->ops.gather(r->self, own, bytes, all) != 0;
    r->seconds += mps__clock() - start;
}

void mps__ranks_gather_number(mps__ranks *r, int64_t own, int64_t *values)
{
    for (int32_t k = 0; k < r->count; k++) values[k] = k == r->rank ? own : 0;
    mps__ranks_add(r, r->count, values);
}

void mps__ranks_connect(mps__ranks *r, int32_t count, const int32_t *to, const int64_t *sent,
                        mps_route *route)
{
    if (!begin(r, 0)) return;
    const double start = mps__clock();
    r->failed = r->ops.connect(r->self, count, to, sent, route) != 0;
    r->seconds += mps__clock() - start;
}

void mps__ranks_exchange(mps__ranks *r, const mps_route *route, size_t bytes, const void *out,
                         void *in)
{
    int64_t sent = 0;
    for (int32_t k = 0; k < route->to_count; k++) sent += route->sent[k] * (int64_t)bytes;
    if (!begin(r, sent)) return;
    const double start = mps__clock();
    r->failed = r->ops.exchange_begin(r->self, route, bytes, out, in) != 0 ||
                r->ops.exchange_end(r->self, route) != 0;
    r->seconds += mps__clock() - start;
}

void mps__ranks_send_to_first(mps__ranks *r, const void *own, const int64_t *bytes, void *all)
{
    static const int32_t first = 0;
    mps_route route = {0};
    if (!begin(r, r->rank == 0 ? 0 : bytes[r->rank])) return;
    const int64_t sent = bytes[r->rank];
    const bool sends = r->rank != 0 && sent > 0;
    r->failed = r->ops.connect(r->self, sends, &first, &sent, &route) != 0;
    if (r->failed) return;
    if (r->rank == 0 && sent > 0) memcpy(all, own, (size_t)sent);
    r->failed = r->ops.exchange_begin(r->self, &route, 1, own, (char *)all + (all ? sent : 0)) ||
                r->ops.exchange_end(r->self, &route);
    r->ops.disconnect(r->self, &route);
}

mps_status mps__ranks_collect(mps__ranks *r, void **list, int64_t *count, size_t size)
{
    if (!mps__ranks_many(r)) return MPS_OK;
    int64_t *bytes = mps__alloc(r->context, r->count, sizeof *bytes), all = 0;
    if (!bytes) return MPS_E_NOMEM;
    mps__ranks_gather_number(r, *count, bytes);
    for (int32_t k = 0; k < r->count; k++) {
        all += bytes[k];
        bytes[k] *= (int64_t)size;
    }
    mps_status status = mps__ranks_status(r);
    void *larger = status == MPS_OK ? mps__alloc(r->context, all, size) : NULL;
    if (status == MPS_OK && !larger) status = MPS_E_NOMEM;
    if (status == MPS_OK) {
        mps__ranks_gather(r, *list, bytes, larger);
        mps__free(r->context, *list);
        *list = larger;
        *count = all;
        status = mps__ranks_status(r);
    }
    mps__free(r->context, bytes);
    return status;
}
