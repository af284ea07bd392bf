/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid on many ranks: the own cells of a rank on a large grid, and the cells that it needs from
 * others. All ranks know all cells and their owners; a rank requests the cells that it needs from
 * their owners. */
#include "auxgrid.h"
#include "rows.h"
#include <string.h>

enum { SEND, RECEIVE, OUT, IN };              /* buffers of a plan */
enum { OWNERS, OWNED, RESTS, ADDED, FIRSTS }; /* buffers of a grid */

/* ---- plans ---- */

static void disconnect(mps__grid *g, mps__grid_plan *p)
{
    if (p->connected) g->ranks.table.disconnect(g->ranks.table.host, &p->route);
    p->connected = false;
}

static void release(mps__grid *g, mps__grid_buffer *buffer, int count)
{
    for (int k = 0; k < count; k++) {
        mps__release(&g->allocator, buffer[k].at);
        buffer[k] = (mps__grid_buffer){NULL, 0};
    }
}

void mps__grid_undivide(mps__grid *g)
{
    for (int k = 0; k < MPS__GRID_LEVELS; k++) {
        disconnect(g, &g->ranks.level[k].ring);
        disconnect(g, &g->ranks.level[k].left);
    }
    g->ranks.divided = 0;
}

void mps__grid_divided_release(mps__grid *g)
{
    mps__grid_undivide(g);
    for (int k = 0; k < MPS__GRID_LEVELS; k++) {
        mps__grid_divided *d = &g->ranks.level[k];
        release(g, d->ring.buffer, 4);
        release(g, d->left.buffer, 4);
        release(g, d->buffer, MPS__GRID_DIVIDED_BUFFERS);
    }
}

int mps__grid_plan_exchange(mps__grid *g, mps__grid_plan *p, double *values)
{
    const mps_ppe_ranks *t = &g->ranks.table;
    for (int64_t k = 0; k < p->sends; k++) p->out[k] = values[p->send[k]];
    if (t->exchange(t->host, &p->route, sizeof *values, p->out, p->in)) return MPS_PPE_BREAKDOWN;
    for (int64_t k = 0; k < p->receives; k++) values[p->receive[k]] = p->in[k];
    return 0;
}

/* List the needed cells of other ranks by rank, their numbers into `count`. @return number of
 * owners, listed in `to` and at the begin of `count` */
static int32_t list_needed(mps__grid *g, mps__grid_plan *p, const mps__grid_divided *d,
                           const uint8_t *need, int32_t *to)
{
    mps__grid_ranks *r = &g->ranks;
    int64_t listed = 0;
    int32_t owners = 0;
    for (int32_t k = 0; k < r->table.ranks; k++) {
        const int64_t before = listed;
        for (int64_t c = d->owned.first[k]; c < d->owned.first[k + 1] && k != r->table.rank; c++)
            if (need[d->owned.cell[c]]) p->receive[listed++] = d->owned.cell[c];
        if (listed == before) continue;
        to[owners] = k;
        r->count[owners++] = listed - before;
    }
    return owners;
}

/* Send requests along `asking`; the requested values are sent the other way. */
static int answer(mps__grid *g, mps__grid_plan *p, const mps_route *asking)
{
    const mps_ppe_ranks *t = &g->ranks.table;
    p->sends = 0;
    for (int32_t k = 0; k < asking->from_count; k++) p->sends += asking->received[k];
    p->send = mps__grid_buffer_of(g, &p->buffer[SEND], p->sends, sizeof *p->send);
    p->out = mps__grid_buffer_of(g, &p->buffer[OUT], p->sends, sizeof *p->out);
    p->in = mps__grid_buffer_of(g, &p->buffer[IN], p->receives, sizeof *p->in);
    if (!p->send || !p->out || !p->in) return MPS_PPE_NOMEM;
    if (t->exchange(t->host, asking, sizeof *p->send, p->receive, p->send))
        return MPS_PPE_BREAKDOWN;
    if (t->connect(t->host, asking->from_count, asking->from, asking->received, &p->route))
        return MPS_PPE_BREAKDOWN;
    p->connected = true;
    return 0;
}

/* @param need  [cells + 1] 1 for cells whose values this rank needs */
static int make_plan(mps__grid *g, mps__grid_plan *p, const mps__grid_divided *d,
                     const uint8_t *need)
{
    mps__grid_ranks *r = &g->ranks;
    const int64_t first = d->owned.first[r->table.rank], end = d->owned.first[r->table.rank + 1],
                  cells = d->owned.first[r->table.ranks];
    int32_t *to = mps__grid_buffer_of(g, &r->buffer[MPS__GRID_PARTNERS], r->table.ranks,
                                      sizeof *to);
    mps_route asking;
    p->receives = 0;
    for (int64_t c = 0; c < cells; c++)
        p->receives += need[d->owned.cell[c]] && !(c >= first && c < end);
    p->receive = mps__grid_buffer_of(g, &p->buffer[RECEIVE], p->receives, sizeof *p->receive);
    if (!to || !p->receive) return MPS_PPE_NOMEM;
    const int32_t owners = list_needed(g, p, d, need, to);
    if (r->table.connect(r->table.host, owners, to, r->count, &asking)) return MPS_PPE_BREAKDOWN;
    const int reason = answer(g, p, &asking);
    r->table.disconnect(r->table.host, &asking);
    return reason;
}

/* ---- cells ---- */

/* The owner of a coarse cell is the owner of its first finer cell. */
static int find_owners(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const mps__grid_level *l = &g->level[k], *fine = l - 1;
    d->owner = mps__grid_buffer_of(g, &d->buffer[OWNERS], l->cells, sizeof *d->owner);
    if (!d->owner) return MPS_PPE_NOMEM;
    if (k == 0) memcpy(d->owner, g->ranks.owner, (size_t)l->cells * sizeof *d->owner);
    for (int64_t c = k > 0 ? fine->cells : 0; c-- > 0;)
        if (l->home[c] >= 0) d->owner[l->home[c]] = d[-1].owner[c];
    return 0;
}

static int list_owned(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const mps__grid_level *l = &g->level[k];
    const int32_t ranks = g->ranks.table.ranks, rank = g->ranks.table.rank;
    d->owned.first = mps__grid_buffer_of(g, &d->buffer[FIRSTS], ranks + 2, sizeof *d->owned.first);
    d->owned.cell = mps__grid_buffer_of(g, &d->buffer[OWNED], l->cells, sizeof *d->owned.cell);
    if (!d->owned.first || !d->owned.cell) return MPS_PPE_NOMEM;
    int64_t *first = d->owned.first;
    memset(first, 0, (size_t)(ranks + 2) * sizeof *first);
    for (int64_t c = 0; c < l->cells; c++) first[d->owner[c] + 2]++;
    for (int32_t q = 0; q < ranks; q++) first[q + 2] += first[q + 1];
    for (int64_t c = 0; c < l->cells; c++) d->owned.cell[first[d->owner[c] + 1]++] = (int32_t)c;
    d->cell = d->owned.cell + first[rank];
    d->own = first[rank + 1] - first[rank];
    for (d->own_red = 0; d->own_red < d->own && d->cell[d->own_red] < l->red;) d->own_red++;
    return 0;
}

/* ---- needs ---- */

static void mark_corners(const mps__grid *g, const mps__grid_level *l, int64_t point, uint8_t *need)
{
    const int all = g->dim == 2 ? 9 : MPS__GRID_ABOUT;
    for (int k = 0; k < 1 << g->dim; k++)
        need[l->about[(int64_t)l->home[point] * all + mps__grid_corner[l->side[point]][k]]] = 1;
}

/* Mark the neighbours of own cells and the cells that own points interpolate from. */
static void mark_ring(const mps__grid *g, int k, uint8_t *need)
{
    const mps__grid_divided *d = &g->ranks.level[k];
    const mps__grid_level *l = &g->level[k];
    const int sides = 2 * g->dim;
    for (int64_t c = 0; c < d->own; c++)
        for (int s = 0; s < sides; s++) need[l->next[(int64_t)d->cell[c] * sides + s]] = 1;
    for (int64_t i = 0; i < (k == 0 ? g->ranks.n : d[-1].own); i++) {
        const int64_t point = k == 0 ? i : d[-1].cell[i];
        if (l->home[point] >= 0) mark_corners(g, l, point, need);
    }
}

/* Whether a cell adds to an own cell of the coarser grid. */
static bool adds_to_own(const mps__grid *g, int k, int64_t cell)
{
    const mps__grid_level *l = &g->level[k + 1];
    const int all = g->dim == 2 ? 9 : MPS__GRID_ABOUT;
    for (int a = 0; a < 1 << g->dim; a++) {
        const int32_t to =
            l->about[(int64_t)l->home[cell] * all + mps__grid_corner[l->side[cell]][a]];
        if (to < l->cells && g->ranks.level[k + 1].owner[to] == g->ranks.table.rank) return true;
    }
    return false;
}

static int list_added(mps__grid *g, int k, uint8_t *need)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const mps__grid_level *fine = &g->level[k], *l = fine + 1;
    d->adding = 0;
    for (int64_t c = 0; c < fine->red; c++) {
        need[c] = l->home[c] >= 0 && adds_to_own(g, k, c);
        d->adding += need[c];
    }
    d->add = mps__grid_buffer_of(g, &d->buffer[ADDED], d->adding, sizeof *d->add);
    d->rest = mps__grid_buffer_of(g, &d->buffer[RESTS], fine->cells, sizeof *d->rest);
    if (!d->add || !d->rest) return MPS_PPE_NOMEM;
    d->adding = 0;
    for (int64_t c = 0; c < fine->red; c++)
        if (need[c]) d->add[d->adding++] = (int32_t)c;
    return 0;
}

static int plan_level(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const int64_t cells = g->level[k].cells + 1;
    uint8_t *need = mps__grid_buffer_of(g, &g->ranks.buffer[MPS__GRID_MARKS], cells, sizeof *need);
    if (!need) return MPS_PPE_NOMEM;
    memset(need, 0, (size_t)cells);
    mark_ring(g, k, need);
    int reason = make_plan(g, &d->ring, d, need);
    memset(need, 0, (size_t)cells);
    if (!reason) reason = list_added(g, k, need);
    return reason ? reason : make_plan(g, &d->left, d, need);
}

int mps__grid_divide(mps__grid *g)
{
    int reason = 0, divided = 0;
    while (divided < g->levels - 1 && g->level[divided].cells >= g->ranks.whole) divided++;
    for (int k = 0; k <= divided && divided > 0 && !reason; k++) {
        reason = find_owners(g, k);
        if (!reason) reason = list_owned(g, k);
    }
    for (int k = 0; k < divided && !reason; k++) reason = plan_level(g, k);
    g->ranks.divided = divided;
    return reason;
}
