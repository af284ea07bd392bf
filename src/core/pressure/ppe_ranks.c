/* SPDX-License-Identifier: BSD-3-Clause */
/* The pressure equation on many ranks: halo exchange and reductions for solvers. */
#include "ppe.h"
#include "loop.h"

static int exchange_columns(void *host, double *x)
{
    const mps__ppe *e = host;
    const mps_status status = mps__ghosts_exchange_indexed(e->ghosts, e->device, e->unknown, x);
    /* inform the other ranks at once: the next calls of this rank differ from theirs */
    mps__ranks_report(e->ghosts->ranks, status);
    return status < 0;
}

static int reduce_values(void *host, int32_t count, size_t bytes, void *values,
                         mps_combine_fn combine)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_reduce(r, count, bytes, values, combine);
    return r->failed;
}

static int collect_blocks(void *host, const void *own, const int64_t *bytes, void *all)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_gather(r, own, bytes, all);
    return r->failed;
}

static int connect_ranks(void *host, int32_t count, const int32_t *to, const int64_t *sent,
                         mps_route *route)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_connect(r, count, to, sent, route);
    return r->failed;
}

static void disconnect_ranks(void *host, mps_route *route)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    r->ops.disconnect(r->self, route);
}

static int exchange_elements(void *host, const mps_route *route, size_t bytes, const void *out,
                             void *in)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_exchange(r, route, bytes, out, in);
    return r->failed;
}

static int find_owners(void *host, int64_t m, const double *x, int32_t *rank)
{
    const mps__ppe *e = host;
    return e->owner(e->world, m, x, rank) < 0;
}

/* Arguments of a loop over columns on a device. */
typedef struct ordering {
    int64_t n, columns;
    const int32_t *particle;
    int32_t *order;
} ordering;

/* Own columns are ascending, and so are those of other ranks. The index of a column is its position
 * among its own kind plus the number of columns of the other kind with a lower particle. */
MPS_ROW void order_row(const ordering *f, int64_t k)
{
    const bool own = k < f->n;
    const int64_t begin = own ? f->n : 0;
    int64_t lo = begin, hi = own ? f->columns : f->n;
    while (lo < hi) {
        const int64_t other = lo + (hi - lo) / 2;
        if (f->particle[other] < f->particle[k])
            lo = other + 1;
        else
            hi = other;
    }
    f->order[k - (own ? 0 : f->n) + lo - begin] = (int32_t)k;
}
MPS__LOOP_ANY(order_rows, order_row, ordering)

/* Rows and columns of other ranks, merged by their particles. */
void mps__ppe_ranks_order(mps__ppe *e)
{
    int64_t row = 0, column = e->n;
    if (e->ranks.ranks < 2) return;
    if (e->device) {
        mps__loop_run(e->parallel, &order_rows, MPS__ANY_DIM, e->columns,
                      &(ordering){e->n, e->columns, e->particle, e->order});
        return;
    }
    for (int64_t k = 0; k < e->columns; k++) {
        const bool own = column == e->columns ||
                         (row < e->n && e->particle[row] < e->particle[column]);
        e->order[k] = (int32_t)(own ? row++ : column++);
    }
}

mps_status mps__ppe_ranks_set(mps__ppe *e)
{
    if (!e->ghosts || !mps__ranks_many(e->ghosts->ranks)) return MPS_OK;
    mps__ranks *r = e->ghosts->ranks;
    int64_t *rows = mps__scratch_take(e->context, e->scratch, MPS__PPE_NUMBERS, r->count,
                                      sizeof *rows);
    if (!rows) return MPS_E_NOMEM;
    mps__ranks_gather_number(r, e->n, rows);
    e->ranks = (mps_ppe_ranks){.struct_size = sizeof e->ranks,
                               .rank = r->rank,
                               .ranks = r->count,
                               .ghosts = e->columns - e->n,
                               .order = e->order,
                               .owner = find_owners,
                               .halo = exchange_columns,
                               .reduce = reduce_values,
                               .gather = collect_blocks,
                               .connect = connect_ranks,
                               .disconnect = disconnect_ranks,
                               .exchange = exchange_elements,
                               .host = e};
    for (int32_t k = 0; k < r->count; k++) {
        e->ranks.first += k < r->rank ? rows[k] : 0;
        e->ranks.rows += rows[k];
    }
    mps__ppe_ranks_order(e);
    return mps__ranks_status(r);
}
