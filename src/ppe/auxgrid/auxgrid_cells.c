/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: the cells that contain points. The host finds them with a hash table of their
 * coordinates, a device by sorting the points. */
#include "auxgrid.h"
#include "rows.h"
#include <string.h>

/* Slot of a key, or the free slot where it is inserted. */
static int64_t slot(const mps__grid *g, int64_t key)
{
    uint64_t hash = (uint64_t)key * 0x9e3779b97f4a7c15u;
    /* high bits, which depend on all coordinates; low ones for very large tables */
    int64_t s = (int64_t)(hash >> 40 ^ hash >> 20) & (g->table_size - 1);
    while (g->table_key[s] != key && g->table_key[s] != -1) s = (s + 1) & (g->table_size - 1);
    return s;
}

/* Assign points to cells, numbered by order of appearance; count cells and red cells. False: the
 * table is too small. */
static bool fill_table(mps__grid *g, mps__grid_level *l)
{
    const int64_t all = mps__grid_table_for(l->points);
    g->table_size = all < g->table_capacity ? all : g->table_capacity;
    for (int64_t s = 0; s < g->table_size; s++) g->table_key[s] = -1;
    l->cells = l->red = 0;
    for (int64_t i = 0; i < l->points; i++) {
        int64_t key = g->point_key[i];
        /* consecutive particles are mostly in the same cell */
        l->home[i] = i > 0 && key == g->point_key[i - 1] ? l->home[i - 1] : -1;
        if (key < 0 || l->home[i] >= 0) continue;
        int64_t s = slot(g, key);
        if (g->table_key[s] < 0) {
            if (l->cells + l->cells / 2 >= g->table_size) return false;
            g->table_key[s] = key;
            g->table_cell[s] = (int32_t)l->cells++;
            l->red += mps__grid_is_red(key);
        }
        l->home[i] = g->table_cell[s];
    }
    return true;
}

/* The initial table assumes a few points in each cell; with fewer it grows and keeps its size. */
static bool find_cells(mps__grid *g, mps__grid_level *l)
{
    while (!fill_table(g, l))
        if (!mps__grid_reserve_table(g, 2 * g->table_capacity)) return false;
    return true;
}

enum { LOW_DIGIT = 11 }; /* bits; of a coordinate, the rest is the high digit */

/* One pass of a radix sort: sort cells in `from` by one digit of their keys into `to`, stable. */
static void sort_digit(const int64_t *key, int shift, int bits, int64_t cells, const int32_t *from,
                       int32_t *to)
{
    int32_t first[1 << LOW_DIGIT] = {0}, sum = 0;
    const int64_t mask = (1 << bits) - 1;
    for (int64_t c = 0; c < cells; c++) first[key[c] >> shift & mask]++;
    for (int64_t d = 0; d <= mask; d++) {
        const int32_t count = first[d];
        first[d] = sum;
        sum += count;
    }
    for (int64_t c = 0; c < cells; c++) to[first[key[from[c]] >> shift & mask]++] = from[c];
}

/* Cells sorted by key, in one of the two halves of `order`. Digits that are equal in all keys are
 * skipped. */
static const int32_t *sort_keys(const mps__grid *g, const int64_t *key, int64_t cells)
{
    int32_t *from = g->order, *to = g->order + g->order_capacity;
    int64_t differ = 0;
    for (int64_t c = 0; c < cells; c++) {
        from[c] = (int32_t)c;
        differ |= key[c] ^ key[0];
    }
    for (int shift = 0, bits; shift < 3 * MPS__GRID_BITS; shift += bits) {
        bits = shift % MPS__GRID_BITS ? MPS__GRID_BITS - LOW_DIGIT : LOW_DIGIT;
        if (!(differ >> shift & ((1 << bits) - 1))) continue;
        sort_digit(key, shift, bits, cells, from, to);
        int32_t *swap = from;
        from = to;
        to = swap;
    }
    return from;
}

typedef struct renumbering {
    int32_t *home;
    const int32_t *number; /* new number of each cell, by order of appearance */
} renumbering;

MPS_ROW void renumber_row(const renumbering *f, int64_t i)
{
    if (f->home[i] >= 0) f->home[i] = f->number[f->home[i]];
}
MPS__LOOP_ANY(renumber_rows, renumber_row, renumbering)

/* Keys of cells in order of appearance replace those of the points in point_key. */
static void list_keys(mps__grid *g)
{
    for (int64_t s = 0; s < g->table_size; s++)
        if (g->table_key[s] >= 0) g->point_key[g->table_cell[s]] = g->table_key[s];
}

int64_t mps__grid_find(mps__grid *g, mps__grid_level *l, int64_t points)
{
    l->points = points;
    if (!mps__grid_reserve_points(g, l)) return -1;
    if (!find_cells(g, l)) return -1;
    list_keys(g);
    return l->cells;
}

/* Number the red cells first, and the cells of each colour by key. */
static void sort_cells(mps__grid *g, mps__grid_level *l)
{
    const int64_t *key = g->point_key;
    list_keys(g);
    const int32_t *sorted = sort_keys(g, key, l->cells);
    int32_t *number = g->order + (sorted == g->order ? g->order_capacity : 0);
    int32_t red = 0, black = (int32_t)l->red;
    for (int64_t c = 0; c < l->cells; c++) {
        const int32_t cell = sorted[c];
        number[cell] = mps__grid_is_red(key[cell]) ? red++ : black++;
        l->key[number[cell]] = key[cell];
    }
    for (int64_t s = 0; s < g->table_size; s++)
        if (g->table_key[s] >= 0) g->table_cell[s] = number[g->table_cell[s]];
    mps__loop_run_cheap(g->parallel, &renumber_rows, MPS__ANY_DIM, l->points,
                        &(renumbering){l->home, number});
}

static void find_neighbours(const mps__grid *g, mps__grid_level *l)
{
    int sides = 2 * g->dim;
    for (int64_t c = 0; c < l->cells * sides; c++) {
        l->next[c] = (int32_t)(c / sides);
        l->link[c] = 0;
    }
    for (int64_t c = 0; c < l->cells; c++)
        for (int a = 0; a < g->dim; a++) {
            if (mps__grid_coordinate(l->key[c], a) == (1 << MPS__GRID_BITS) - 1) continue;
            int64_t s = slot(g, l->key[c] + ((int64_t)1 << (a * MPS__GRID_BITS)));
            if (g->table_key[s] < 0) continue;
            l->next[c * sides + 2 * a + 1] = g->table_cell[s];
            l->next[(int64_t)g->table_cell[s] * sides + 2 * a] = (int32_t)c;
        }
}

typedef struct around {
    int64_t cells;
    const int32_t *next;
    int32_t *about;
    double *b, *x;
} around;

/* Neighbourhood of a cell: each neighbour is found from one that is a step nearer. The last row is
 * the sentinel, which stands for missing cells. */
MPS_ROW void find_about(const int dim, const around *f, int64_t c)
{
    const int all = mps__grid_all(dim), sides = 2 * dim;
    int32_t *about = f->about + c * all;
    if (c == f->cells) {
        f->b[c] = f->x[c] = 0;
        return;
    }
    for (int k = 0; k < all; k++) {
        about[k] = (int32_t)(k == 0 ? c : f->cells);
        for (int a = 0, power = 1; a < dim && about[k] == f->cells; a++, power *= 3) {
            const int digit = k / power % 3;
            const int64_t from = about[k - digit * power];
            if (digit == 0 || from == f->cells) continue;
            const int32_t next = f->next[from * sides + 2 * a + digit - 1];
            if (next != from) about[k] = next;
        }
    }
}
MPS__LOOP(cells_about, find_about, around)

/* Number the cells and find their neighbours with the table. */
static bool number_cells(mps__grid *g, mps__grid_level *l)
{
    if (!mps__grid_reserve_order(g, l->cells)) return false;
    sort_cells(g, l);
    find_neighbours(g, l);
    return true;
}

bool mps__grid_cells(mps__grid *g, mps__grid_level *l, int64_t points)
{
    l->points = points;
    if (!mps__grid_reserve_points(g, l)) return false;
    if (!g->device) return find_cells(g, l) && mps__grid_make_cells(g, l);
    mps__grid_sort(g, l);
    mps__grid_count(g, l);
    return mps__grid_make_cells(g, l);
}

bool mps__grid_make_cells(mps__grid *g, mps__grid_level *l)
{
    if (!mps__grid_reserve_cells(g, l)) return false;
    if (g->device)
        mps__grid_number(g, l);
    else if (!number_cells(g, l))
        return false;
    mps__loop_run(mps__team(g->parallel, l->cells), &cells_about, g->dim, l->cells + 1,
                  &(around){l->cells, l->next, l->about, l->b, l->x});
    return true;
}

void mps__grid_list_cells(const mps__grid *g, mps__grid_level *l)
{
    int32_t *next = g->order, end = 0;
    memset(next, 0, (size_t)l->cells * sizeof *next);
    for (int64_t i = 0; i < l->points; i++)
        if (l->home[i] >= 0) next[l->home[i]]++;
    for (int64_t c = 0; c < l->cells; c++) {
        const int32_t count = next[c];
        l->start[c] = next[c] = end;
        end += count;
    }
    l->start[l->cells] = end;
    for (int64_t i = 0; i < l->points; i++)
        if (l->home[i] >= 0) l->list[next[l->home[i]]++] = (int32_t)i;
}
