/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid on many ranks: owners of the cells of the first grid, and their messages. All ranks
 * number the cells identically, so that messages need no keys.
 *
 * Sums over particles have the same terms in the same order as on one rank: the owner of a cell has
 * all of its particles as rows or columns, in the order of the particles, and sends its
 * contributions to neighbour cells of other owners one by one.
 *
 * Owners, lists and messages are on the host. Where a rank has a device, arrays of particles and
 * cells are on the device: auxgrid_ranks_device.c. */
#include "auxgrid.h"
#include "rows.h"
#include "loop.h"
#include <string.h>

enum {
    /* owners not known yet; SEEN: the cell has particles on this rank */
    UNSEEN = -1,
    SEEN = -2
};

/* ---- memory ---- */

void *mps__grid_ranks_buffer(mps__grid *g, int which, int64_t count, size_t size)
{
    mps__grid_buffer *r = &g->ranks.buffer[which];
    return which < MPS__GRID_HOST ? mps__grid_buffer_of(g, r, count, size)
                                  : mps__grid_buffer_host(g, r, count, size);
}

static void *buffer(mps__grid *g, int which, int64_t count, size_t size)
{
    return mps__grid_ranks_buffer(g, which, count, size);
}

static void disconnect(mps__grid_ranks *r)
{
    if (r->connected) r->table.disconnect(r->table.host, &r->route);
    r->connected = false;
}

void mps__grid_ranks_release(mps__grid *g)
{
    const int64_t whole = g->ranks.whole;
    disconnect(&g->ranks);
    mps__grid_divided_release(g);
    for (int k = 0; k < MPS__GRID_BUFFERS; k++)
        mps__release(k < MPS__GRID_HOST ? &g->allocator : &g->host, g->ranks.buffer[k].at);
    g->ranks = (mps__grid_ranks){.whole = whole};
}

typedef struct placing {
    const int32_t *order;
    int32_t *place;
} placing;

MPS_ROW void place_column(const placing *f, int64_t k)
{
    f->place[f->order[k]] = (int32_t)k;
}
MPS__LOOP_ANY(place_columns, place_column, placing)

int mps__grid_ranks_begin(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_ranks *r = &g->ranks;
    disconnect(r);
    mps__grid_undivide(g);
    r->table = problem->ranks ? *problem->ranks : (mps_ppe_ranks){.ranks = 0};
    if (!mps__grid_many(g)) return 0;
    const int32_t ranks = r->table.ranks;
    r->n = problem->n;
    r->columns = mps__columns(problem);
    r->value = buffer(g, MPS__GRID_VALUES, r->columns, sizeof *r->value);
    r->entries = buffer(g, MPS__GRID_ENTRIES, r->columns, sizeof *r->entries);
    r->place = buffer(g, MPS__GRID_PLACES, r->columns, sizeof *r->place);
    r->owned.first = buffer(g, MPS__GRID_COUNTS, 3 * (int64_t)ranks + 1, sizeof *r->owned.first);
    if (!r->value || !r->entries || !r->place || !r->owned.first) return MPS_PPE_NOMEM;
    r->bytes = r->owned.first + ranks + 1;
    r->count = r->bytes + ranks;
    mps__loop_run_cheap(problem->parallel, &place_columns, MPS__ANY_DIM, r->columns,
                        &(placing){r->table.order, r->place});
    return 0;
}

/* ---- messages ---- */

/* Collect one number of each rank in `count`. Returns their sum, -1 after a failure. */
static int64_t collect_count(mps__grid_ranks *r, int64_t own)
{
    int64_t sum = 0;
    for (int32_t k = 0; k < r->table.ranks; k++) r->bytes[k] = sizeof own;
    if (r->table.gather(r->table.host, &own, r->bytes, r->count)) return -1;
    for (int32_t k = 0; k < r->table.ranks; k++) sum += r->count[k];
    return sum;
}

/* Collect `count` elements of each rank. */
static int gather(mps__grid_ranks *r, const void *own, size_t size, void *all)
{
    for (int32_t k = 0; k < r->table.ranks; k++) r->bytes[k] = r->count[k] * (int64_t)size;
    return r->table.gather(r->table.host, own, r->bytes, all) ? MPS_PPE_BREAKDOWN : 0;
}

int mps__grid_ranks_halo(mps__grid *g, const double *values)
{
    mps__grid_ranks *r = &g->ranks;
    mps__vectors_copy(mps__team(g->parallel, r->n), r->n, values, r->value);
    return r->table.halo(r->table.host, r->value) ? MPS_PPE_BREAKDOWN : 0;
}

int mps__grid_ranks_exchange(mps__grid *g)
{
    const mps__grid_ranks *r = &g->ranks;
    double *parts = g->parts;
    const int64_t sent = mps__grid_sent(r), received = mps__grid_received(r);
    if (g->device)
        mps__grid_to_host(g, r->on_device.send, sent, 1, &parts, r->out);
    else
        for (int64_t k = 0; k < sent; k++) r->out[k] = parts[r->send[k]];
    if (r->table.exchange(r->table.host, &r->route, sizeof *parts, r->out, r->in))
        return MPS_PPE_BREAKDOWN;
    if (g->device)
        mps__grid_to_device(g, r->on_device.receive, received, 1, &parts, r->in);
    else
        for (int64_t k = 0; k < received; k++) parts[r->receive[k]] = r->in[k];
    return 0;
}

int mps__grid_ranks_collect(mps__grid *g, const mps__grid_owned *owned, int arrays,
                            double *const *array)
{
    mps__grid_ranks *r = &g->ranks;
    const int64_t first = owned->first[r->table.rank],
                  own = owned->first[r->table.rank + 1] - first, all = owned->first[r->table.ranks];
    double *out = buffer(g, MPS__GRID_OUT, own * arrays, sizeof *out),
           *in = buffer(g, MPS__GRID_IN, all * arrays, sizeof *in);
    if (!out || !in) return MPS_PPE_NOMEM;
    if (g->device)
        mps__grid_to_host(g, r->on_device.owned + first, own, arrays, array, out);
    else
        for (int64_t k = 0; k < own; k++)
            for (int a = 0; a < arrays; a++) out[k * arrays + a] = array[a][owned->cell[first + k]];
    for (int32_t k = 0; k < r->table.ranks; k++)
        r->count[k] = owned->first[k + 1] - owned->first[k];
    if (gather(r, out, (size_t)arrays * sizeof *out, in)) return MPS_PPE_BREAKDOWN;
    if (g->device)
        mps__grid_to_device(g, r->on_device.owned, all, arrays, array, in);
    else
        for (int64_t k = 0; k < all; k++)
            for (int a = 0; a < arrays; a++) array[a][owned->cell[k]] = in[k * arrays + a];
    return 0;
}

/* ---- cells ---- */

/* Conductivities and numbers of entries of all columns, the first into `value`. */
static int exchange_rows(mps__grid *g)
{
    mps__grid_ranks *r = &g->ranks;
    if (r->table.halo(r->table.host, r->entries)) return MPS_PPE_BREAKDOWN;
    return mps__grid_ranks_halo(g, g->point_kappa);
}

/* Keys of this rank, on the host. NULL: out of memory */
static const int64_t *own_keys(mps__grid *g, int64_t own)
{
    if (!g->device) return g->point_key;
    int64_t *key = buffer(g, MPS__GRID_CELL_KEYS, own, sizeof *key);
    if (key) mps__device_download(g->device, key, g->point_key, (size_t)own * sizeof *key);
    return key;
}

/* Keys of the cells that contain rows of any rank; a key may occur several times. */
static int collect_keys(mps__grid *g, const mps_ppe_problem *problem, const int64_t **key,
                        int64_t *keys)
{
    mps__grid_ranks *r = &g->ranks;
    mps__grid_place(g, problem, r->n);
    const int64_t own = g->device ? mps__grid_find_device(g, &g->level[0], r->n)
                                  : mps__grid_find(g, &g->level[0], r->n);
    if (own < 0) return MPS_PPE_NOMEM;
    const int64_t *found = own_keys(g, own);
    *keys = collect_count(r, own);
    if (*keys < 0) return MPS_PPE_BREAKDOWN;
    int64_t *all = buffer(g, MPS__GRID_KEYS, *keys, sizeof *all);
    *key = all;
    return all && found ? gather(r, found, sizeof *all, all) : MPS_PPE_NOMEM;
}

/* Centres of the cells that have particles on this rank; with a device, of all cells, because homes
 * are not on the host. Returns their number, -1: out of memory. */
static int64_t find_centres(mps__grid *g, double **centre)
{
    mps__grid_ranks *r = &g->ranks;
    const mps__grid_level *l = &g->level[0];
    int64_t seen = g->device ? l->cells : 0;
    for (int64_t c = 0; c < l->cells; c++) r->owner[c] = g->device ? SEEN : UNSEEN;
    for (int64_t i = 0; i < l->points && !g->device; i++) {
        seen += r->owner[l->home[i]] == UNSEEN;
        r->owner[l->home[i]] = SEEN;
    }
    double *x = *centre = buffer(g, MPS__GRID_CENTRES, seen * g->dim, sizeof *x);
    if (!x) return -1;
    for (int64_t c = 0; c < l->cells; c++)
        for (int a = 0; a < g->dim && r->owner[c] == SEEN; a++)
            *x++ = ((double)mps__grid_coordinate(r->key[c], a) + 0.5 + g->corner[a]) * g->size;
    return seen;
}

/* List the cells that this rank owns in `own` [cells]. Returns their number, -1: out of memory, -2:
 * failed */
static int64_t find_own(mps__grid *g, int32_t *own)
{
    mps__grid_ranks *r = &g->ranks;
    const mps__grid_level *l = &g->level[0];
    double *centre;
    const int64_t seen = find_centres(g, &centre);
    int64_t count = 0;
    int32_t *rank = buffer(g, MPS__GRID_PARTNERS, seen, sizeof *rank);
    if (seen < 0 || !rank) return -1;
    if (r->table.owner(r->table.host, seen, centre, rank)) return -2;
    for (int64_t c = 0; c < l->cells; c++)
        if (r->owner[c] == SEEN && *rank++ == r->table.rank) own[count++] = (int32_t)c;
    return count;
}

/* Owners of all cells. Each cell has one, which has all of its particles. */
static int find_owners(mps__grid *g)
{
    mps__grid_ranks *r = &g->ranks;
    const int64_t cells = g->level[0].cells;
    r->owned.cell = buffer(g, MPS__GRID_CELLS, 2 * cells, sizeof *r->owned.cell);
    r->owner = buffer(g, MPS__GRID_OWNERS, cells, sizeof *r->owner);
    if (!r->owned.cell || !r->owner) return MPS_PPE_NOMEM;
    int32_t *own = r->owned.cell + cells;
    const int64_t count = find_own(g, own);
    if (count < 0) return count == -1 ? MPS_PPE_NOMEM : MPS_PPE_BREAKDOWN;
    if (collect_count(r, count) != cells) return MPS_PPE_BREAKDOWN;
    r->owned.first[0] = 0;
    for (int32_t k = 0; k < r->table.ranks; k++)
        r->owned.first[k + 1] = r->owned.first[k] + r->count[k];
    if (gather(r, own, sizeof *own, r->owned.cell)) return MPS_PPE_BREAKDOWN;
    for (int32_t k = 0; k < r->table.ranks; k++)
        for (int64_t c = r->owned.first[k]; c < r->owned.first[k + 1]; c++)
            r->owner[r->owned.cell[c]] = k;
    return 0;
}

/* ---- contributions to other ranks ---- */

/* Owner of the neighbour in direction k of a cell; -1: no such cell. */
static int32_t owner_about(const mps__grid *g, int64_t cell, int k)
{
    const int32_t other = g->ranks.about[cell * mps__grid_all(g->dim) + k];
    return other == g->level[0].cells ? -1 : g->ranks.owner[other];
}

/* Contributions of own cells to other ranks. Without a list: count those for each rank into
 * `count`. Otherwise write them to the list, those for a rank from its entry of `bytes` on. */
static void list_sent(mps__grid *g, int64_t *list)
{
    mps__grid_ranks *r = &g->ranks;
    const int all = mps__grid_all(g->dim);
    const int32_t rank = r->table.rank;
    for (int64_t c = r->owned.first[rank]; c < r->owned.first[rank + 1]; c++)
        for (int k = 1; k < all; k++) {
            const int32_t owner = owner_about(g, r->owned.cell[c], k);
            if (owner < 0 || owner == rank) continue;
            if (list)
                list[r->bytes[owner]++] = (int64_t)r->owned.cell[c] * all + k;
            else
                r->count[owner]++;
        }
}

/* Contributions to receive, in the order in which they are sent: by rank, cell and direction.
 * @param beside  [cells] 1 for a cell in the neighbourhood of an own one
 * @return how many; at most `most` of them are listed */
static int64_t list_received(const mps__grid *g, const uint8_t *beside, int64_t most, int64_t *list)
{
    const mps__grid_ranks *r = &g->ranks;
    const int all = mps__grid_all(g->dim);
    int64_t listed = 0;
    for (int64_t c = 0; c < r->owned.first[r->table.ranks]; c++) {
        const int32_t cell = r->owned.cell[c];
        if (!beside[cell] || r->owner[cell] == r->table.rank) continue;
        for (int k = 1; k < all; k++) {
            if (owner_about(g, cell, k) != r->table.rank) continue;
            if (listed < most) list[listed] = (int64_t)cell * all + k;
            listed++;
        }
    }
    return listed;
}

static uint8_t *mark_beside(mps__grid *g)
{
    const mps__grid_ranks *r = &g->ranks;
    const mps__grid_level *l = &g->level[0];
    const int all = mps__grid_all(g->dim);
    uint8_t *beside = buffer(g, MPS__GRID_MARKS, l->cells + 1, sizeof *beside);
    if (!beside) return NULL;
    memset(beside, 0, (size_t)l->cells + 1);
    for (int64_t c = r->owned.first[r->table.rank]; c < r->owned.first[r->table.rank + 1]; c++)
        for (int k = 1; k < all; k++) beside[r->about[(int64_t)r->owned.cell[c] * all + k]] = 1;
    return beside;
}

/* A route to the ranks that receive contributions. */
static int connect_owners(mps__grid *g)
{
    mps__grid_ranks *r = &g->ranks;
    const int32_t ranks = r->table.ranks;
    int32_t *to = buffer(g, MPS__GRID_PARTNERS, ranks, sizeof *to), partners = 0;
    int64_t sent = 0;
    memset(r->count, 0, (size_t)ranks * sizeof *r->count);
    list_sent(g, NULL);
    for (int32_t k = 0; k < ranks; sent += r->count[k++]) r->bytes[k] = sent;
    r->send = buffer(g, MPS__GRID_SENT, sent, sizeof *r->send);
    if (!to || !r->send) return MPS_PPE_NOMEM;
    list_sent(g, r->send);
    for (int32_t k = 0; k < ranks; k++) {
        if (r->count[k] == 0) continue;
        to[partners] = k;
        r->count[partners++] = r->count[k];
    }
    if (r->table.connect(r->table.host, partners, to, r->count, &r->route))
        return MPS_PPE_BREAKDOWN;
    r->connected = true;
    r->out = buffer(g, MPS__GRID_PARTS_OUT, sent, sizeof *r->out);
    return r->out ? 0 : MPS_PPE_NOMEM;
}

static int find_parts(mps__grid *g)
{
    mps__grid_ranks *r = &g->ranks;
    const int reason = connect_owners(g);
    const uint8_t *beside = mark_beside(g);
    if (reason) return reason;
    const int64_t received = mps__grid_received(r);
    r->receive = buffer(g, MPS__GRID_RECEIVED, received, sizeof *r->receive);
    r->in = buffer(g, MPS__GRID_PARTS_IN, received, sizeof *r->in);
    if (!beside || !r->receive || !r->in) return MPS_PPE_NOMEM;
    return list_received(g, beside, received, r->receive) == received ? 0 : MPS_PPE_BREAKDOWN;
}

/* Cells from the columns and the keys of all ranks, on the host. */
static int cells_on_rank(mps__grid *g, const mps_ppe_problem *problem, const int64_t *key,
                         int64_t keys)
{
    mps__grid_ranks *r = &g->ranks;
    mps__grid_level *l = &g->level[0];
    mps__grid_place(g, problem, r->columns);
    memcpy(g->point_key + r->columns, key, (size_t)keys * sizeof *key);
    if (!mps__grid_cells(g, l, r->columns + keys)) return MPS_PPE_NOMEM;
    l->points = r->columns; /* the keys after them are those of cells, not of particles */
    r->key = l->key;
    r->about = l->about;
    return 0;
}

int mps__grid_ranks_cells(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_ranks *r = &g->ranks;
    const int64_t *key, columns = r->columns;
    int64_t keys;
    int reason = exchange_rows(g);
    if (!reason) reason = collect_keys(g, problem, &key, &keys);
    if (reason) return reason;
    if (columns + keys >= INT32_MAX) return MPS_PPE_BREAKDOWN;
    if (!mps__grid_reserve(g, columns + keys)) return MPS_PPE_NOMEM;
    mps__vectors_copy(mps__team(g->parallel, columns), columns, r->value, g->point_kappa);
    reason = g->device ? mps__grid_cells_device(g, problem, key, keys)
                       : cells_on_rank(g, problem, key, keys);
    if (!reason) reason = find_owners(g);
    if (!reason) reason = find_parts(g);
    return reason || !g->device ? reason : mps__grid_owners_to_device(g);
}
