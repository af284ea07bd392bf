/* SPDX-License-Identifier: BSD-3-Clause */
/* Connected components of the pressure equation, and whether each has a pressure datum: a row with
 * a neighbour of known pressure, or with volume that can change. Nearly always all have one; then
 * one parallel pass over the entries is enough: a union-find of rows, in which the representative
 * is the lowest row. */
#include "levels.h"
#include "union_find.h"
#include "loop.h"
#include <math.h>

typedef struct components {
    int64_t n; /* rows of this rank */
    const int64_t *row;
    const int32_t *col;
    const double *shift;
    mps__atomic_number *parent;
    mps__atomic_number *datum; /* of a representative: 1 if a row of its set has a datum */
    /* [columns] value of the set of each column's row; NULL: single rank */
    double *datum_of;
} components;

/* Most rows join the set of their first column at once. */
MPS_ROW void begin_row(const components *f, int64_t r)
{
    const int64_t first = f->row[r] < f->row[r + 1] ? f->col[f->row[r]] : r;
    mps__atomic_put(&f->parent[r], (int32_t)(first < r ? first : r));
    mps__atomic_put(&f->datum[r], 0);
}
MPS__LOOP_ANY(begin_rows, begin_row, components)

MPS_ROW void join_row(const components *f, int64_t r)
{
    for (int64_t k = f->row[r]; k < f->row[r + 1]; k++) {
        if (f->col[k] >= f->n) continue; /* column of another rank, at any position in the row */
        if (f->col[k] > r) break;
        if (mps__atomic_get(&f->parent[f->col[k]]) != mps__atomic_get(&f->parent[r]))
            mps__union_join(f->parent, (int32_t)r, f->col[k]);
    }
}
MPS__LOOP_ANY(join_rows, join_row, components)

MPS_ROW void raise_row(const components *f, int64_t r)
{
    if (f->shift[r] > 0) mps__atomic_put(&f->datum[mps__union_find(f->parent, (int32_t)r)], 1);
}
MPS__LOOP_ANY(raise_rows, raise_row, components)

MPS_ROW bool lacks_datum(const components *f, int64_t r)
{
    return mps__atomic_get(&f->parent[r]) == r && mps__atomic_get(&f->datum[r]) == 0;
}
MPS__FIRST(lacking_rows, lacks_datum, components)

MPS_ROW void send_row(const components *f, int64_t r)
{
    f->datum_of[r] = mps__atomic_get(&f->datum[mps__union_find(f->parent, (int32_t)r)]);
}
MPS__LOOP_ANY(send_rows, send_row, components)

/* A set with a column of another rank takes over the datum of that row's set. The maximum: whether
 * any set got one. */
MPS_ROW void receive_row(const components *f, int64_t r, double *any)
{
    mps__atomic_number *datum = &f->datum[mps__union_find(f->parent, (int32_t)r)];
    for (int64_t k = f->row[r]; k < f->row[r + 1] && f->datum_of[r] == 0; k++) {
        if (f->col[k] < f->n || !(f->datum_of[f->col[k]] > 0)) continue;
        mps__atomic_put(datum, 1);
        any[0] = 1;
    }
}
MPS__VALUES_ANY(receive_rows, receive_row, components, 0, 1)

static components components_of(const mps__ppe *e)
{
    return (components){.n = e->n,
                        .row = e->row,
                        .col = e->col,
                        .shift = e->shift,
                        .parent = (mps__atomic_number *)(void *)e->queue,
                        .datum = (mps__atomic_number *)(void *)e->component};
}

/* Union-find of the rows of this rank. */
static components find_components(const mps__ppe *e)
{
    const components f = components_of(e);
    mps__loop_run(e->parallel, &begin_rows, MPS__ANY_DIM, e->n, &f);
    mps__loop_run(e->parallel, &join_rows, MPS__ANY_DIM, e->n, &f);
    mps__loop_run(e->parallel, &raise_rows, MPS__ANY_DIM, e->n, &f);
    return f;
}

/* In e->component: a row whose component is not visited yet. In e->queue: end of a component's
 * list. */
enum { NEW = -2, END = -1 };

/* From sets to linked lists: e->queue becomes the next row of the same component, in ascending
 * order. */
static void chain_rows(mps__ppe *e)
{
    int32_t *root = e->queue, *next = e->queue, *last = e->component;
    for (int32_t r = 0; r < e->n; r++) {
        root[r] = root[root[r]]; /* lower rows already have their representatives */
        last[r] = NEW;
    }
    for (int32_t r = 0; r < e->n; r++) {
        const int32_t first = root[r];
        if (first < r) next[last[first]] = r;
        last[first] = r;
    }
    for (int32_t r = 0; r < e->n; r++) {
        if (last[r] == NEW) continue;
        next[last[r]] = END;
        e->component[r] = NEW;
    }
}

/* Flag of a set: it has a pressure datum. */
enum { LEVEL = 1 };

/* The part of a component on this rank, from its first row on. */
static mps__set part_of(const mps__ppe *e, const int64_t *id, int32_t first)
{
    enum { BLOCK = 256 };
    double term[BLOCK];
    mps__set part = {.label = INT64_MAX};
    int32_t count = 0;
    for (int32_t r = first; r != END; r = e->queue[r]) {
        const int64_t own = id[e->particle[r]];
        part.rows++;
        part.label = own < part.label ? own : part.label;
        part.flags |= e->shift[r] > 0 ? LEVEL : 0;
        term[count++] = e->rhs[r];
        if (count < BLOCK) continue;
        mps_exact_add(&part.sum, count, term);
        count = 0;
    }
    mps_exact_add(&part.sum, count, term);
    return part;
}

/* List the parts of this rank; e->component becomes the index in the list. */
static mps_status list_parts(mps__ppe *e, const int64_t *id)
{
    mps__sets_begin(&e->sets, e->context);
    for (int32_t r = 0; r < e->n; r++) {
        if (e->component[r] != NEW) continue;
        const mps__set part = part_of(e, id, r);
        for (int32_t k = r; k != END; k = e->queue[k]) e->component[k] = (int32_t)e->sets.parts;
        MPS__TRY(mps__sets_add(&e->sets, &part));
    }
    return MPS_OK;
}

/* Join parts of different ranks. Labels are ids, which doubles represent exactly. */
static mps_status join_border(mps__ppe *e, double *label)
{
    if (e->ranks.halo(e->ranks.host, label)) return mps__ranks_status(e->ghosts->ranks);
    for (int64_t r = 0; r < e->n; r++)
        for (int64_t k = e->row[r]; k < e->row[r + 1]; k++)
            if (e->col[k] >= e->n)
                MPS__TRY(mps__sets_join(&e->sets, (int64_t)label[r], (int64_t)label[e->col[k]]));
    return MPS_OK;
}

/* Of sets of equal size the first one, with the least label, counts as the largest. */
static bool largest_is_free(const mps__sets *s)
{
    int64_t largest = 0;
    for (int64_t k = 1; k < s->count; k++)
        if (s->list[k].rows > s->list[largest].rows) largest = k;
    return s->count > 0 && !(s->list[largest].flags & LEVEL);
}

/* Number the sets without a datum, and subtract the mean from their right sides. Returns their
 * number. */
static int32_t balance(mps__ppe *e, const double *label)
{
    int32_t singular = 0;
    for (int64_t k = 0; k < e->sets.count; k++)
        e->sets.list[k].number = e->sets.list[k].flags & LEVEL ? -1 : singular++;
    for (int64_t r = 0; r < e->n; r++) {
        const mps__set *set = mps__sets_find(&e->sets, (int64_t)label[r]);
        e->component[r] = set->number;
        if (set->number >= 0) e->rhs[r] -= mps_exact_value(&set->sum) / (double)set->rows;
    }
    return singular;
}

void mps__levels_look(mps__ppe *e)
{
    const components f = find_components(e);
    e->level_free = false;
    if (e->device) {
        mps__values_reduce_async(e->device, &lacking_rows, MPS__ANY_DIM, e->n, &f,
                                 &e->counts_device->lacking);
        return;
    }
    double lacking = mps__first_run(e->parallel, &lacking_rows, e->n, &f) < e->n;
    if (e->ranks.ranks > 1) mps__ranks_max(e->ghosts->ranks, 1, &lacking);
    e->lacking = lacking > 0;
}

/* On many ranks with a device: propagate the flags between ranks until no further set gets a datum.
 * @param lacking  out: above -INFINITY if a set without a datum remains */
static mps_status spread_levels(mps__ppe *e, double *lacking)
{
    mps__ranks *ranks = e->ghosts->ranks;
    components f = components_of(e);
    double any = 1;
    f.datum_of = mps__device_fit(e->device, &e->on_device[MPS__PPE_LABELS],
                                 (size_t)e->columns * sizeof *f.datum_of);
    if (!f.datum_of) return MPS_E_NOMEM;
    while (*lacking > -INFINITY && any > 0) {
        mps__loop_run(e->parallel, &send_rows, MPS__ANY_DIM, e->n, &f);
        if (e->ranks.halo(e->ranks.host, f.datum_of)) return mps__ranks_status(ranks);
        double found[2] = {0, -INFINITY};
        mps__values_run(e->parallel, &receive_rows, MPS__ANY_DIM, e->n, &f, NULL, &found[0]);
        mps__values_run(e->parallel, &lacking_rows, MPS__ANY_DIM, e->n, &f, NULL, &found[1]);
        mps__ranks_max(ranks, 2, found);
        any = found[0];
        *lacking = found[1];
    }
    return mps__ranks_status(ranks);
}

mps_status mps__levels_wait(mps__ppe *e)
{
    double lacking = -INFINITY;
    if (e->n > 0)
        mps__device_download(e->device, &lacking, &e->counts_device->lacking, sizeof lacking);
    if (e->ranks.ranks > 1) {
        mps__ranks_max(e->ghosts->ranks, 1, &lacking);
        MPS__TRY(spread_levels(e, &lacking));
    }
    e->lacking = lacking > -INFINITY;
    return mps__device_status(e->device);
}

mps_status mps__levels_find(mps__ppe *e, const int64_t *id, int32_t *singular)
{
    mps__ranks none = {.context = e->context, .count = 1};
    mps__ranks *ranks = e->ghosts ? e->ghosts->ranks : &none;
    double *label = mps__scratch_take(e->context, e->scratch, MPS__PPE_LABELS, e->columns,
                                      sizeof *label);
    if (!label) return MPS_E_NOMEM;
    chain_rows(e);
    MPS__TRY(list_parts(e, id));
    for (int64_t r = 0; r < e->n; r++) label[r] = (double)e->sets.part[e->component[r]].label;
    if (e->ranks.ranks > 1) MPS__TRY(join_border(e, label));
    MPS__TRY(mps__sets_merge(&e->sets, ranks));
    e->level_free = largest_is_free(&e->sets);
    *singular = balance(e, label);
    return MPS_OK;
}
