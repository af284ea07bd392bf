/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: the cells of a grid on a device, whose threads cannot insert into a common hash table.
 * Points are sorted by cell, and a cell begins where a key differs from the previous one. Cells and
 * their order are those of the host. */
#include "auxgrid.h"
#include "scan.h"
#include "sort.h"

/* Length of the runs of points that are sorted first. */
enum { FIRST_RUN = 64 };

static const uint64_t no_cell = UINT64_MAX, black = (uint64_t)1 << 63;

/* Arguments of the loops. */
typedef struct sorting {
    int64_t n; /* number of points */
    const int64_t *point_key;
    const uint64_t *key;
    uint64_t *new_key;
    int32_t *new_order;
    int64_t *number;
} sorting;

/* ---- order ---- */

/* Red cells come first. */
MPS_ROW uint64_t sort_key(int64_t key)
{
    if (key < 0) return no_cell;
    return (uint64_t)key | (mps__grid_is_red(key) ? 0 : black);
}

MPS_ROW void rank_row(const sorting *f, int64_t i)
{
    const int64_t begin = i - i % FIRST_RUN,
                  end = begin + FIRST_RUN < f->n ? begin + FIRST_RUN : f->n;
    const uint64_t own = sort_key(f->point_key[i]);
    int64_t to = begin;
    for (int64_t k = begin; k < end; k++) {
        const uint64_t other = sort_key(f->point_key[k]);
        to += other < own || (other == own && k < i);
    }
    f->new_key[to] = own;
    f->new_order[to] = (int32_t)i;
}
MPS__LOOP_ANY(rank_rows, rank_row, sorting)

/* ---- cells ---- */

MPS_ROW bool begins(const sorting *f, int64_t a)
{
    return f->key[a] != no_cell && (a == 0 || f->key[a] != f->key[a - 1]);
}

MPS_ROW void begin_row(const sorting *f, int64_t a)
{
    f->number[a] = begins(f, a);
}
MPS__LOOP_ANY(begin_rows, begin_row, sorting)

/* Maxima: number of cells, of red cells. */
MPS_ROW void count_row(const sorting *f, int64_t a, double *most)
{
    const double cells = (double)f->number[a];
    if (cells > most[0]) most[0] = cells;
    if (!(f->key[a] & black) && cells > most[1]) most[1] = cells;
}
MPS__VALUES_ANY(count_cells, count_row, sorting, 0, 2)

void mps__grid_sort(mps__grid *g, const mps__grid_level *l)
{
    const mps__grid_sorted *s = &g->sorted;
    const int64_t n = l->points;
    sorting f = {.n = n,
                 .point_key = g->point_key,
                 .new_key = s->key,
                 .new_order = s->order,
                 .number = s->number};
    mps__sorting m = {.n = n,
                      .run = FIRST_RUN,
                      .key = s->key,
                      .order = s->order,
                      .new_key = s->key + n,
                      .new_order = s->order + n};
    mps__loop_run(g->parallel, &rank_rows, MPS__ANY_DIM, n, &f);
    mps__merge_sort(g->parallel, &m);
    f.key = m.key;
    mps__loop_run_cheap(g->parallel, &begin_rows, MPS__ANY_DIM, n, &f);
    mps__scan(g->parallel, s->number, n);
    mps__values_reduce_async(g->device, &count_cells, MPS__ANY_DIM, n, &f, g->reported->cells);
    g->sorted.key_now = m.key;
    g->sorted.order_now = m.order;
}

void mps__grid_count(const mps__grid *g, mps__grid_level *l)
{
    double cells[2] = {0, 0};
    mps__device_download(g->device, cells, g->reported->cells, sizeof cells);
    mps__grid_counted(l, cells);
}

/* ---- homes, keys, neighbours ---- */

typedef struct numbering {
    int64_t n, cells, red;
    const uint64_t *sorted;
    const int32_t *order;
    const int64_t *point_key;
    const int64_t *number;
    int32_t *home, *list, *start, *next;
    int64_t *key;
    float *link;
} numbering;

/* One entry of the sorted order. */
MPS_ROW void number_row(const numbering *f, int64_t a)
{
    const int32_t point = f->order[a];
    const bool none = f->sorted[a] == no_cell;
    const int64_t cell = f->number[a] - 1;
    f->home[point] = none ? -1 : (int32_t)cell;
    if (none) return;
    f->list[a] = point;
    if (a == 0 || f->number[a - 1] <= cell) {
        f->key[cell] = (int64_t)(f->sorted[a] & ~black);
        f->start[cell] = (int32_t)a;
    }
    if (cell == f->cells - 1 && (a == f->n - 1 || f->sorted[a + 1] == no_cell))
        f->start[f->cells] = (int32_t)(a + 1);
}
MPS__LOOP_ANY(number_rows, number_row, numbering)

/* The cell with a key of one colour, `none` if there is none. */
MPS_ROW int32_t cell_of(const numbering *f, int64_t key, int64_t none)
{
    const bool red = mps__grid_is_red(key);
    int64_t lo = red ? 0 : f->red, hi = red ? f->red : f->cells;
    const int64_t end = hi;
    while (lo < hi) {
        const int64_t c = lo + (hi - lo) / 2;
        if (f->key[c] < key)
            lo = c + 1;
        else
            hi = c;
    }
    return (int32_t)(lo < end && f->key[lo] == key ? lo : none);
}

MPS_ROW void neighbour_row(const int dim, const numbering *f, int64_t c)
{
    const int64_t key = f->key[c], last = (1 << MPS__GRID_BITS) - 1;
    for (int a = 0; a < dim; a++) {
        const int64_t at = mps__grid_coordinate(key, a), one = (int64_t)1 << (a * MPS__GRID_BITS),
                      side = c * 2 * dim + 2 * a;
        f->next[side] = at == 0 ? (int32_t)c : cell_of(f, key - one, c);
        f->next[side + 1] = at == last ? (int32_t)c : cell_of(f, key + one, c);
        f->link[side] = f->link[side + 1] = 0;
    }
}
MPS__LOOP(neighbour_rows, neighbour_row, numbering)

static numbering numbering_of(const mps__grid *g, const mps__grid_level *l)
{
    const mps__grid_sorted *s = &g->sorted;
    return (numbering){.n = l->points,
                       .cells = l->cells,
                       .red = l->red,
                       .sorted = s->key_now,
                       .order = s->order_now,
                       .point_key = g->point_key,
                       .number = s->number,
                       .home = l->home,
                       .list = l->list,
                       .start = l->start,
                       .next = l->next,
                       .key = l->key,
                       .link = l->link};
}

void mps__grid_number(mps__grid *g, mps__grid_level *l)
{
    const numbering f = numbering_of(g, l);
    mps__loop_run(g->parallel, &number_rows, MPS__ANY_DIM, l->points, &f);
    mps__loop_run(g->parallel, &neighbour_rows, g->dim, l->cells, &f);
}

/* ---- many ranks: cells of all ranks, points of this one ---- */

/* Keys of the cells replace those of the points, in the sorted order. */
MPS_ROW void key_row(const numbering *f, int64_t a)
{
    if (f->sorted[a] == no_cell || (a > 0 && f->sorted[a] == f->sorted[a - 1])) return;
    f->key[f->number[a] - 1] = (int64_t)(f->sorted[a] & ~black);
}
MPS__LOOP_ANY(key_rows, key_row, numbering)

int64_t mps__grid_find_device(mps__grid *g, mps__grid_level *l, int64_t points)
{
    l->points = points;
    mps__grid_sort(g, l);
    mps__grid_count(g, l);
    numbering f = numbering_of(g, l);
    f.key = g->point_key;
    mps__loop_run(g->parallel, &key_rows, MPS__ANY_DIM, points, &f);
    return l->cells;
}

MPS_ROW void home_row(const numbering *f, int64_t i)
{
    f->home[i] = cell_of(f, f->point_key[i], -1);
}
MPS__LOOP_ANY(home_rows, home_row, numbering)

void mps__grid_home(mps__grid *g, mps__grid_level *l)
{
    const numbering f = numbering_of(g, l);
    mps__loop_run(g->parallel, &home_rows, MPS__ANY_DIM, l->points, &f);
}

/* Arguments of loops over columns in the order of the particles. */
typedef struct listing {
    const int32_t *column, *owner, *home;
    const int64_t *key;
    int64_t *point_key;
    int32_t rank;
    int64_t n, visits;
    const uint64_t *sorted;
    const int32_t *order;
    const int64_t *number;
    int32_t *list, *start;
} listing;

/* Columns in cells of other ranks get no key, so that they are sorted to the end. */
MPS_ROW void choose_row(const listing *f, int64_t k)
{
    const int32_t home = f->home[f->column[k]];
    f->point_key[k] = f->owner[home] == f->rank ? f->key[home] : -1;
}
MPS__LOOP_ANY(choose_rows, choose_row, listing)

MPS_ROW void list_row(const listing *f, int64_t a)
{
    const int64_t visit = f->number[a] - 1;
    if (f->sorted[a] == no_cell) return;
    f->list[a] = f->column[f->order[a]];
    if (a == 0 || f->number[a - 1] <= visit) f->start[visit] = (int32_t)a;
    if (visit == f->visits - 1 && (a == f->n - 1 || f->sorted[a + 1] == no_cell))
        f->start[f->visits] = (int32_t)(a + 1);
}
MPS__LOOP_ANY(list_rows, list_row, listing)

void mps__grid_list_own(mps__grid *g, mps__grid_level *l)
{
    const mps__grid_ranks *r = &g->ranks;
    listing f = {.column = r->table.order,
                 .owner = r->on_device.owner,
                 .home = l->home,
                 .key = l->key,
                 .point_key = g->point_key,
                 .rank = r->table.rank,
                 .n = l->points,
                 .visits = g->visits,
                 .number = g->sorted.number,
                 .list = l->list,
                 .start = l->start};
    mps__device_clear(g->device, l->start, (size_t)(l->cells + 1) * sizeof *l->start);
    mps__loop_run(g->parallel, &choose_rows, MPS__ANY_DIM, l->points, &f);
    mps__grid_sort(g, l);
    f.sorted = g->sorted.key_now;
    f.order = g->sorted.order_now;
    mps__loop_run(g->parallel, &list_rows, MPS__ANY_DIM, l->points, &f);
}
