/* SPDX-License-Identifier: BSD-3-Clause */
/* Migration of particles between ranks, construction of ghosts, and halo exchange. */
#include "ghosts.h"
#include <math.h>
#include <string.h>

/* Block of particles whose bounding box is tested before the particles: neighbours in memory are
 * neighbours in space. */
enum { BLOCK = 64 };

/* A particle to be sent to a rank. */
struct mps__parcel {
    int32_t rank, particle;
};

void mps__ghosts_init(mps__ghosts *g, mps__context *context, mps__ranks *ranks,
                      mps__particles *particles)
{
    *g = (mps__ghosts){
        .context = context, .ranks = ranks, .particles = particles, .on_device = {.orders = -1}};
}

static void forget_route(mps__ghosts *g)
{
    if (g->connected) g->ranks->ops.disconnect(g->ranks->self, &g->route);
    g->connected = false;
    g->sends = g->receives = 0;
}

void mps__ghosts_free(mps__ghosts *g)
{
    forget_route(g);
    void *all[] = {g->ghost, g->run, g->send, g->receive, g->parcel, g->out, g->in, g->staged};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__free(g->context, all[k]);
    mps__ghosts_init(g, g->context, g->ranks, g->particles);
}

/* ---- packets: all fields of a particle in sequence ---- */

size_t mps__ghosts_packet(const mps__particles *s)
{
    size_t bytes = 0;
    for (int32_t k = 0; k < s->fields; k++) bytes += mps__field_element(&s->field[k]);
    return bytes;
}

void mps__ghosts_pack(const mps__particles *s, int64_t i, char *to)
{
    for (int32_t k = 0; k < s->fields; to += mps__field_element(&s->field[k++])) {
        const size_t bytes = mps__field_element(&s->field[k]);
        memcpy(to, (const char *)*s->field[k].data + (size_t)i * bytes, bytes);
    }
}

void mps__ghosts_unpack(const mps__particles *s, int64_t i, const char *from)
{
    for (int32_t k = 0; k < s->fields; from += mps__field_element(&s->field[k++])) {
        const size_t bytes = mps__field_element(&s->field[k]);
        memcpy((char *)*s->field[k].data + (size_t)i * bytes, from, bytes);
    }
}

/* Move the `aside` particles behind the store from index `from` to index `to`. */
static void move_tail(const mps__particles *s, int64_t aside, int64_t from, int64_t to)
{
    for (int32_t k = 0; k < s->fields && aside > 0 && from != to; k++) {
        const size_t bytes = mps__field_element(&s->field[k]);
        char *data = *s->field[k].data;
        memmove(data + (size_t)to * bytes, data + (size_t)from * bytes, (size_t)aside * bytes);
    }
}

/* Insert `count` particles from packets in g->in before those set aside. */
static mps_status append(mps__ghosts *g, int64_t count, int64_t aside)
{
    mps__particles *s = g->particles;
    const size_t bytes = mps__ghosts_packet(s);
    s->n += aside; /* number of particles copied if the arrays grow */
    const mps_status status = mps__particles_reserve(s, count);
    s->n -= aside;
    MPS__TRY(status);
    move_tail(s, aside, s->n, s->n + count);
    for (int64_t k = 0; k < count; k++) mps__ghosts_unpack(s, s->n + k, g->in + (size_t)k * bytes);
    s->n += count;
    return mps__grow(g->context, (void **)&g->ghost, &g->capacity, s->n - count,
                     mps__capacity_for(s->n + aside, g->capacity), 1);
}

/* ---- routes ---- */

static mps_status add_parcel(mps__ghosts *g, int32_t rank, int64_t particle)
{
    if (g->parcels == g->parcel_capacity)
        MPS__TRY(mps__grow(g->context, (void **)&g->parcel, &g->parcel_capacity, g->parcels,
                           2 * g->parcels + 1024, sizeof *g->parcel));
    g->parcel[g->parcels++] = (struct mps__parcel){rank, (int32_t)particle};
    return MPS_OK;
}

/* Sort the parcels by rank into g->send, and connect the ranks. */
static mps_status connect_ranks(mps__ghosts *g)
{
    mps__ranks *r = g->ranks;
    int64_t *sent = mps__scratch_take(g->context, g->particles->scratch, 3, 3 * (int64_t)r->count,
                                      sizeof *sent);
    MPS__TRY(mps__grow(g->context, (void **)&g->send, &g->send_capacity, 0, g->parcels,
                       sizeof *g->send));
    if (!sent) return MPS_E_NOMEM;
    int64_t *at = sent + r->count, next = 0;
    int32_t *to = (int32_t *)(void *)(at + r->count), count = 0;
    memset(sent, 0, (size_t)r->count * sizeof *sent);
    for (int64_t k = 0; k < g->parcels; k++) sent[g->parcel[k].rank]++;
    for (int32_t k = 0; k < r->count; next += sent[k++]) at[k] = next;
    for (int64_t k = 0; k < g->parcels; k++)
        g->send[at[g->parcel[k].rank]++] = g->parcel[k].particle;
    for (int32_t k = 0; k < r->count; k++) {
        if (sent[k] == 0) continue;
        to[count] = k;
        sent[count++] = sent[k];
    }
    g->sends = g->parcels;
    const double start = mps__clock();
    r->failed = r->failed || r->ops.connect(r->self, count, to, sent, &g->route);
    r->seconds += mps__clock() - start;
    MPS__TRY(mps__ranks_status(r));
    g->connected = true;
    for (int32_t k = 0; k < g->route.from_count; k++) g->receives += g->route.received[k];
    return MPS_OK;
}

/* Allocate the buffers; old contents are lost. */
static mps_status reserve_buffers(mps__ghosts *g, size_t bytes)
{
    MPS__TRY(
        mps__grow(g->context, (void **)&g->out, &g->out_capacity, 0, g->sends * (int64_t)bytes, 1));
    return mps__grow(g->context, (void **)&g->in, &g->in_capacity, 0, g->receives * (int64_t)bytes,
                     1);
}

/* Send packets of all parcels; received packets are in g->in. */
static mps_status send_parcels(mps__ghosts *g)
{
    const mps__particles *s = g->particles;
    const size_t bytes = mps__ghosts_packet(s);
    MPS__TRY(connect_ranks(g));
    MPS__TRY(reserve_buffers(g, bytes));
    for (int64_t k = 0; k < g->sends; k++)
        mps__ghosts_pack(s, g->send[k], g->out + (size_t)k * bytes);
    mps__ranks_exchange(g->ranks, &g->route, bytes, g->out, g->in);
    return mps__ranks_status(g->ranks);
}

/* Ranges of owned particles. */
static mps_status find_runs(mps__ghosts *g)
{
    const int64_t n = g->particles->n;
    g->runs = 0;
    for (int64_t i = 0; i < n;) {
        while (i < n && g->ghost[i]) i++;
        if (i == n) break;
        if (2 * g->runs == g->run_capacity)
            MPS__TRY(mps__grow(g->context, (void **)&g->run, &g->run_capacity, 2 * g->runs,
                               4 * g->runs + 64, sizeof *g->run));
        g->run[2 * g->runs] = i;
        while (i < n && !g->ghost[i]) i++;
        g->run[2 * g->runs++ + 1] = i;
    }
    return MPS_OK;
}

/* ---- owners ---- */

/* Ranks that own particles begin .. n-1. */
static mps_status find_owners(mps__ghosts *g, const mps__placing *p, int64_t begin, int32_t *owner)
{
    mps__ranks *r = g->ranks;
    const int64_t n = g->particles->n;
    double X[BLOCK * 3];
    for (int64_t from = begin; from < n && !r->failed; from += BLOCK) {
        const int64_t to = from + BLOCK < n ? from + BLOCK : n;
        for (int64_t i = from; i < to; i++)
            p->place(p->argument, i, X + (i - from) * g->particles->dim);
        r->failed = r->ops.owner(r->self, to - from, X, owner + from) != 0;
    }
    return mps__ranks_status(r);
}

/* Partition space by the owned particles begin .. end-1 of each rank. */
static mps_status divide(mps__ghosts *g, const mps__placing *p, int64_t begin, int64_t end)
{
    mps__ranks *r = g->ranks;
    const int dim = g->particles->dim;
    int64_t count = 0;
    double *X = mps__alloc(g->context, (end - begin) * dim, sizeof *X);
    float *weight = mps__alloc(g->context, end - begin, sizeof *weight);
    for (int64_t i = mps__own_from(g, begin); X && weight && i < end; i = mps__own_from(g, i + 1)) {
        p->place(p->argument, i, X + count * dim);
        weight[count++] = p->weight(p->argument, i);
    }
    const double start = mps__clock();
    if (X && weight && !r->failed)
        r->failed = r->ops.partition(r->self, dim, count, X, weight) != 0;
    r->seconds += mps__clock() - start;
    const mps_status status = X && weight ? mps__ranks_status(r) : MPS_E_NOMEM;
    mps__free(g->context, X);
    mps__free(g->context, weight);
    g->cut = status == MPS_OK;
    g->recut = false;
    return status;
}

mps_status mps__ghosts_adopt(mps__ghosts *g, const mps__placing *p)
{
    mps__particles *s = g->particles;
    const mps__ranks *r = g->ranks;
    if (!mps__ranks_many(r) || s->n == g->known) return MPS_OK;
    const int64_t fresh = s->n - g->known, generation = s->generation, solids = s->solids;
    if (!g->cut)
        MPS__TRY(divide(g, p, g->known + fresh * r->rank / r->count,
                        g->known + fresh * (r->rank + 1) / r->count));
    int32_t *owner = mps__scratch_take(g->context, s->scratch, 1, 2 * s->n, sizeof *owner);
    if (!owner) return MPS_E_NOMEM;
    int32_t *order = owner + s->n;
    int64_t count = 0;
    MPS__TRY(mps__grow(g->context, (void **)&g->ghost, &g->capacity, g->known, s->n, 1));
    MPS__TRY(find_owners(g, p, g->known, owner));
    for (int64_t i = 0; i < s->n; i++)
        if (i < g->known || owner[i] == r->rank) order[count++] = (int32_t)i;
    MPS__TRY(mps__particles_permute(s, count, order));
    memset(g->ghost + g->known, 0, (size_t)(s->n - g->known));
    g->orders++;
    g->known = s->n;
    g->divided = true;
    s->generation = generation;
    s->solids = solids;
    return find_runs(g);
}

/* Send particles to their new owners, delete the ghosts, and receive particles. */
static mps_status migrate(mps__ghosts *g, const mps__placing *p, int64_t aside)
{
    mps__particles *s = g->particles;
    const int64_t n = s->n;
    int64_t keep = 0;
    int32_t *owner = mps__scratch_take(g->context, s->scratch, 1, 2 * n, sizeof *owner);
    if (!owner) return MPS_E_NOMEM;
    int32_t *order = owner + n;
    MPS__TRY(find_owners(g, p, 0, owner));
    g->parcels = 0;
    for (int64_t i = 0; i < n; i++) {
        if (g->ghost[i]) continue;
        if (owner[i] == g->ranks->rank)
            order[keep++] = (int32_t)i;
        else
            MPS__TRY(add_parcel(g, owner[i], i));
    }
    MPS__TRY(send_parcels(g));
    MPS__TRY(mps__particles_permute(s, keep, order));
    move_tail(s, aside, n, keep);
    return append(g, g->receives, aside);
}

/* ---- ghosts ---- */

static void widen(double lo[3], double hi[3], const double *X, double reach, int dim)
{
    for (int d = 0; d < dim; d++) {
        lo[d] = fmin(lo[d], X[d] - reach);
        hi[d] = fmax(hi[d], X[d] + reach);
    }
}

/* Parcels of particle i to all ranks that own space within its reach. */
static mps_status add_particle(mps__ghosts *g, int64_t i, const double *X, double reach,
                               int32_t *rank)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    int32_t count = 0;
    widen(lo, hi, X, reach, g->particles->dim);
    g->ranks->failed = g->ranks->ops.overlap(g->ranks->self, lo, hi, rank, &count) != 0;
    for (int32_t k = 0; k < count; k++)
        if (rank[k] != g->ranks->rank) MPS__TRY(add_parcel(g, rank[k], i));
    return mps__ranks_status(g->ranks);
}

/* Parcels of particles begin .. end-1; usually no other rank is near the block. */
static mps_status add_block(mps__ghosts *g, const mps__placing *p, int64_t begin, int64_t end,
                            int32_t *rank)
{
    const mps__particles *s = g->particles;
    const int dim = s->dim;
    double X[BLOCK * 3], lo[3] = {INFINITY, INFINITY, INFINITY},
                         hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    int32_t count = 0;
    for (int64_t i = begin; i < end; i++) {
        p->place(p->argument, i, X + (i - begin) * dim);
        widen(lo, hi, X + (i - begin) * dim, s->kind[i] == MPS_WALL ? p->reach_walls : p->reach,
              dim);
    }
    g->ranks->failed = g->ranks->ops.overlap(g->ranks->self, lo, hi, rank, &count) != 0;
    MPS__TRY(mps__ranks_status(g->ranks));
    if (count == 1 && rank[0] == g->ranks->rank) return MPS_OK;
    for (int64_t i = begin; i < end; i++)
        MPS__TRY(add_particle(g, i, X + (i - begin) * dim,
                              s->kind[i] == MPS_WALL ? p->reach_walls : p->reach, rank));
    return MPS_OK;
}

static mps_status find_ghosts(mps__ghosts *g, const mps__placing *p)
{
    const int64_t n = g->particles->n;
    int32_t *rank = mps__scratch_take(g->context, g->particles->scratch, 4, g->ranks->count,
                                      sizeof *rank);
    if (!rank) return MPS_E_NOMEM;
    g->parcels = 0;
    for (int64_t from = 0; from < n; from += BLOCK)
        MPS__TRY(add_block(g, p, from, from + BLOCK < n ? from + BLOCK : n, rank));
    return MPS_OK;
}

mps_status mps__ghosts_renew(mps__ghosts *g, const mps__placing *p, int64_t aside)
{
    mps__particles *s = g->particles;
    if (!mps__ranks_many(g->ranks)) return MPS_OK;
    /* over all ranks, no particle is added or removed */
    const int64_t generation = s->generation, solids = s->solids;
    if (g->recut) MPS__TRY(divide(g, p, 0, s->n));
    forget_route(g);
    MPS__TRY(migrate(g, p, aside));
    forget_route(g);
    const int64_t owned = s->n;
    MPS__TRY(find_ghosts(g, p));
    MPS__TRY(send_parcels(g));
    MPS__TRY(append(g, g->receives, aside));
    MPS__TRY(mps__grow(g->context, (void **)&g->receive, &g->receive_capacity, 0, g->receives,
                       sizeof *g->receive));
    for (int64_t k = 0; k < g->receives; k++) g->receive[k] = (int32_t)(owned + k);
    memset(g->ghost, 0, (size_t)owned);
    memset(g->ghost + owned, 1, (size_t)(s->n - owned));
    memset(g->ghost + s->n, 0, (size_t)aside);
    g->orders++;
    g->known = s->n;
    g->reach = p->reach;
    s->generation = generation;
    s->solids = solids;
    return MPS_OK;
}

/* ---- order ---- */

mps_status mps__ghosts_ordered(mps__ghosts *g, const int32_t *order)
{
    const int64_t n = g->particles->n;
    if (!mps__ranks_many(g->ranks)) return MPS_OK;
    int32_t *place = mps__scratch_take(g->context, g->particles->scratch, 2, n, sizeof *place);
    if (!place) return MPS_E_NOMEM;
    for (int64_t k = 0; k < n; k++) place[order[k]] = (int32_t)k;
    for (int64_t k = 0; k < g->sends; k++) g->send[k] = place[g->send[k]];
    for (int64_t k = 0; k < g->receives; k++) g->receive[k] = place[g->receive[k]];
    memset(g->ghost, 0, (size_t)n); /* particles set aside are no ghosts */
    for (int64_t k = 0; k < g->receives; k++) g->ghost[g->receive[k]] = 1;
    g->orders++;
    return find_runs(g);
}

mps_status mps__ghosts_reset_reserve(mps__ghosts *g, int64_t n)
{
    if (!mps__ranks_many(g->ranks)) return MPS_OK;
    MPS__TRY(
        mps__grow(g->context, (void **)&g->run, &g->run_capacity, 2 * g->runs, 2, sizeof *g->run));
    return mps__grow(g->context, (void **)&g->ghost, &g->capacity, g->capacity, n + 1, 1);
}

void mps__ghosts_reset(mps__ghosts *g, int64_t known)
{
    forget_route(g);
    memset(g->ghost, 0, (size_t)g->particles->n);
    g->orders++;
    g->known = known;
    g->runs = known > 0;
    g->run[0] = 0;
    g->run[1] = known;
}

void mps__ghosts_rows(const mps__ghosts *g, mps_range_fn rows, void *argument, int64_t begin,
                      int64_t end)
{
    int64_t lo = 0, hi = g->runs;
    if (!mps__ranks_many(g->ranks)) {
        rows(argument, begin, end);
        return;
    }
    while (lo < hi) { /* the first range that ends after `begin` */
        const int64_t middle = lo + (hi - lo) / 2;
        if (g->run[2 * middle + 1] > begin)
            hi = middle;
        else
            lo = middle + 1;
    }
    for (; lo < g->runs && g->run[2 * lo] < end; lo++) {
        const int64_t from = g->run[2 * lo] > begin ? g->run[2 * lo] : begin,
                      to = g->run[2 * lo + 1] < end ? g->run[2 * lo + 1] : end;
        rows(argument, from, to);
    }
}

/* ---- values ---- */

/* Pack the values of array a, interleaved by element with those of the other arrays. */
static void pack(const mps__ghosts *g, const mps__halo_array *a, const char *staged, char *out,
                 size_t bytes)
{
    for (int64_t k = 0; k < g->sends; k++)
        memcpy(out + (size_t)k * bytes,
               a->on_device ? staged + (size_t)k * a->bytes
                            : (const char *)a->values + (size_t)g->send[k] * a->bytes,
               a->bytes);
}

static void unpack(const mps__ghosts *g, const mps__halo_array *a, char *staged, const char *in,
                   size_t bytes)
{
    for (int64_t k = 0; k < g->receives; k++)
        memcpy(a->on_device ? staged + (size_t)k * a->bytes
                            : (char *)a->values + (size_t)g->receive[k] * a->bytes,
               in + (size_t)k * bytes, a->bytes);
}

mps_status mps__ghosts_exchange_at(mps__ghosts *g, mps__device *d, const mps__halo_array *shared,
                                   int32_t count)
{
    size_t bytes = 0, at = 0, staged = 0;
    bool on_device = false;
    if (!mps__ranks_many(g->ranks) || count == 0) return MPS_OK;
    for (int32_t a = 0; a < count; a++) bytes += shared[a].bytes;
    for (int32_t a = 0; a < count; a++) on_device = on_device || shared[a].on_device;
    MPS__TRY(reserve_buffers(g, bytes));
    if (on_device) MPS__TRY(mps__ghosts_fetch(g, d, shared, count));
    for (int32_t a = 0; a < count; at += shared[a++].bytes) {
        pack(g, &shared[a], g->staged + (size_t)g->sends * staged, g->out + at, bytes);
        staged += shared[a].on_device ? shared[a].bytes : 0;
    }
    mps__ranks_exchange(g->ranks, &g->route, bytes, g->out, g->in);
    MPS__TRY(mps__ranks_status(g->ranks));
    at = staged = 0;
    for (int32_t a = 0; a < count; at += shared[a++].bytes) {
        unpack(g, &shared[a], g->staged + (size_t)g->receives * staged, g->in + at, bytes);
        staged += shared[a].on_device ? shared[a].bytes : 0;
    }
    return on_device ? mps__ghosts_bring(g, d, shared, count) : MPS_OK;
}

mps_status mps__ghosts_exchange_indexed(mps__ghosts *g, mps__device *d, const int32_t *index,
                                        double *x)
{
    MPS__TRY(reserve_buffers(g, sizeof *x));
    double *out = (double *)(void *)g->out, *in = (double *)(void *)g->in;
    if (d) MPS__TRY(mps__ghosts_fetch_indexed(g, d, index, x, out));
    for (int64_t k = 0; !d && k < g->sends; k++) {
        const int32_t at = index[g->send[k]];
        out[k] = at >= 0 ? x[at] : 0;
    }
    mps__ranks_exchange(g->ranks, &g->route, sizeof *x, out, in);
    MPS__TRY(mps__ranks_status(g->ranks));
    for (int64_t k = 0; !d && k < g->receives; k++) {
        const int32_t at = index[g->receive[k]];
        if (at >= 0) x[at] = in[k];
    }
    return d ? mps__ghosts_bring_indexed(g, d, index, x, in) : MPS_OK;
}
