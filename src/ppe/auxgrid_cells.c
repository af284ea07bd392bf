/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: memory, and finding the cells that hold something through a hash table of their coordinates. */
#include "auxgrid.h"
#include "kernels.h"

/* ---- memory: it grows and is kept ---- */

static void drop_points(mps__grid *g, mps__grid_level *l)
{
    mps__give(&g->allocator, l->home);
    mps__give(&g->allocator, l->side);
    mps__give(&g->allocator, l->share);
    l->home = NULL;
    l->side = NULL;
    l->share = NULL;
    l->point_capacity = 0;
}

static void drop_cells(mps__grid *g, mps__grid_level *l)
{
    void *all[] = {l->key,     l->about, l->next,  l->link, l->shift,
                   l->inverse, l->kappa, l->count, l->b,    l->x};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__give(&g->allocator, all[k]);
    l->key = NULL;
    l->about = l->next = NULL;
    l->link = NULL;
    l->shift = l->inverse = l->kappa = l->count = l->b = l->x = NULL;
    l->cell_capacity = 0;
}

/* A cell and those about it. */
static int all_about(const mps__grid *g)
{
    return g->dim == 2 ? 9 : MPS__GRID_ABOUT;
}

static bool reserve_points(mps__grid *g, mps__grid_level *l, int64_t points)
{
    if (points <= l->point_capacity) return true;
    drop_points(g, l);
    int64_t capacity = points + points / 32;
    l->home = mps__take(&g->allocator, capacity, sizeof *l->home);
    l->side = mps__take(&g->allocator, capacity, sizeof *l->side);
    l->share = mps__take(&g->allocator, capacity << g->dim, sizeof *l->share);
    if (l->home && l->side && l->share)
        l->point_capacity = capacity;
    else
        drop_points(g, l);
    return l->point_capacity > 0;
}

static bool reserve_cells(mps__grid *g, mps__grid_level *l, int64_t cells)
{
    if (cells < l->cell_capacity) return true;
    drop_cells(g, l);
    int64_t capacity = cells + cells / 8 + 1; /* a grid may have no cell at all */
    l->key = mps__take(&g->allocator, capacity, sizeof *l->key);
    l->about = mps__take(&g->allocator, capacity * all_about(g), sizeof *l->about);
    l->next = mps__take(&g->allocator, capacity * 2 * g->dim, sizeof *l->next);
    l->link = mps__take(&g->allocator, capacity * 2 * g->dim, sizeof *l->link);
    l->shift = mps__take(&g->allocator, capacity, sizeof *l->shift);
    l->inverse = mps__take(&g->allocator, capacity, sizeof *l->inverse);
    l->kappa = mps__take(&g->allocator, capacity, sizeof *l->kappa);
    l->count = mps__take(&g->allocator, capacity, sizeof *l->count);
    l->b = mps__take(&g->allocator, capacity, sizeof *l->b);
    l->x = mps__take(&g->allocator, capacity, sizeof *l->x);
    if (l->key && l->about && l->next && l->link && l->shift && l->inverse && l->kappa &&
        l->count && l->b && l->x)
        l->cell_capacity = capacity;
    else
        drop_cells(g, l);
    return l->cell_capacity > 0;
}

static void drop_work(mps__grid *g)
{
    void *all[] = {g->point_key, g->point_kappa, g->list,       g->turn, g->start,
                   g->order,     g->table_key,   g->table_cell, g->parts};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__give(&g->allocator, all[k]);
    g->point_key = g->table_key = NULL;
    g->point_kappa = NULL;
    g->list = g->turn = g->start = g->order = g->table_cell = NULL;
    g->parts = NULL;
    g->point_capacity = g->table_capacity = g->order_capacity = g->turn_capacity = 0;
    g->part_capacity = 0;
}

static int64_t table_for(int64_t cells)
{
    int64_t size = 16;
    while (size < cells + cells / 2) size *= 2;
    return size;
}

static bool reserve_table(mps__grid *g, int64_t size)
{
    if (size <= g->table_capacity) return true;
    mps__give(&g->allocator, g->table_key);
    mps__give(&g->allocator, g->table_cell);
    g->table_key = mps__take(&g->allocator, size, sizeof *g->table_key);
    g->table_cell = mps__take(&g->allocator, size, sizeof *g->table_cell);
    g->table_capacity = g->table_key && g->table_cell ? size : 0;
    return g->table_capacity > 0;
}

static bool reserve_order(mps__grid *g, int64_t cells)
{
    if (cells < g->order_capacity) return true;
    mps__give(&g->allocator, g->order);
    g->order_capacity = cells + cells / 8 + 1;
    g->order = mps__take(&g->allocator, 2 * g->order_capacity, sizeof *g->order);
    if (!g->order) g->order_capacity = 0;
    return g->order;
}

bool mps__grid_reserve(mps__grid *g, int64_t points)
{
    if (!g->factor)
        g->factor = mps__take(&g->allocator, MPS__GRID_DIRECT * MPS__GRID_DIRECT,
                              sizeof *g->factor);
    if (!g->pivot) g->pivot = mps__take(&g->allocator, MPS__GRID_DIRECT, sizeof *g->pivot);
    if (!g->factor || !g->pivot) return false;
    if (points <= g->point_capacity && g->table_capacity > 0) return true;
    drop_work(g);
    const int64_t capacity = points + points / 32;
    g->point_key = mps__take(&g->allocator, capacity, sizeof *g->point_key);
    g->point_kappa = mps__take(&g->allocator, capacity, sizeof *g->point_kappa);
    g->list = mps__take(&g->allocator, capacity, sizeof *g->list);
    if (g->point_key && g->point_kappa && g->list && reserve_table(g, table_for(points / 8)))
        g->point_capacity = capacity;
    else
        drop_work(g);
    return g->point_capacity > 0;
}

bool mps__grid_reserve_parts(mps__grid *g, size_t bytes)
{
    if (bytes < g->part_capacity) return true;
    mps__give(&g->allocator, g->parts);
    g->part_capacity = bytes + bytes / 8 + sizeof(double);
    g->parts = mps__take(&g->allocator, (int64_t)g->part_capacity, 1);
    if (!g->parts) g->part_capacity = 0;
    return g->parts;
}

bool mps__grid_reserve_turns(mps__grid *g, int64_t cells)
{
    if (cells < g->turn_capacity) return true;
    mps__give(&g->allocator, g->turn);
    mps__give(&g->allocator, g->start);
    const int64_t capacity = cells + cells / 8 + 1;
    g->turn = mps__take(&g->allocator, capacity, sizeof *g->turn);
    g->start = mps__take(&g->allocator, capacity, sizeof *g->start);
    g->turn_capacity = g->turn && g->start ? capacity : 0;
    return g->turn_capacity > 0;
}

void mps__grid_release(mps__grid *g)
{
    for (int k = 0; k < MPS__GRID_LEVELS; k++) {
        drop_points(g, &g->level[k]);
        drop_cells(g, &g->level[k]);
    }
    drop_work(g);
    mps__grid_ranks_release(g);
    mps__give(&g->allocator, g->factor);
    mps__give(&g->allocator, g->pivot);
    g->factor = g->pivot = NULL;
}

/* ---- cells ---- */

/* Slot of a key, or the free one where it belongs. */
static int64_t slot(const mps__grid *g, int64_t key)
{
    uint64_t hash = (uint64_t)key * 0x9e3779b97f4a7c15u;
    /* high bits, which all coordinates have a part in; low ones for very large tables */
    int64_t s = (int64_t)(hash >> 40 ^ hash >> 20) & (g->table_size - 1);
    while (g->table_key[s] != key && g->table_key[s] != -1) s = (s + 1) & (g->table_size - 1);
    return s;
}

static bool is_red(int64_t key)
{
    return ((mps__grid_coordinate(key, 0) + mps__grid_coordinate(key, 1) +
             mps__grid_coordinate(key, 2)) &
            1) == 0;
}

/* Homes by order of appearance; counts cells and red ones. False: the table is too small. */
static bool fill_table(mps__grid *g, mps__grid_level *l)
{
    const int64_t all = table_for(l->points);
    g->table_size = all < g->table_capacity ? all : g->table_capacity;
    for (int64_t s = 0; s < g->table_size; s++) g->table_key[s] = -1;
    l->cells = l->red = 0;
    for (int64_t i = 0; i < l->points; i++) {
        int64_t key = g->point_key[i];
        l->home[i] = i > 0 && key == g->point_key[i - 1]
                         ? l->home[i - 1]
                         : -1; /* particles come sorted along cells */
        if (key < 0 || l->home[i] >= 0) continue;
        int64_t s = slot(g, key);
        if (g->table_key[s] < 0) {
            if (l->cells + l->cells / 2 >= g->table_size) return false;
            g->table_key[s] = key;
            g->table_cell[s] = (int32_t)l->cells++;
            l->red += is_red(key);
        }
        l->home[i] = g->table_cell[s];
    }
    return true;
}

/* The table starts with room for a few points in each cell; where they are fewer it grows, and stays so. */
static bool find_cells(mps__grid *g, mps__grid_level *l)
{
    while (!fill_table(g, l))
        if (!reserve_table(g, 2 * g->table_capacity)) return false;
    return true;
}

enum { LOW_DIGIT = 11 }; /* bits; of a coordinate, the rest is the high digit */

/* Sort cells in `from` by one digit of their keys into `to`, which keeps the order of equal ones. */
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

/* Cells in order of their keys, one of the two halves of `order`. Digits that all cells share cost nothing. */
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

/* What a loop works on; each uses its own. */
typedef struct finding {
    const mps__grid *g;
    mps__grid_level *l;
    const int32_t *number; /* of the cells, by order of appearance */
} finding;

static void renumber_rows(void *argument, int64_t begin, int64_t end)
{
    const finding *f = argument;
    for (int64_t i = begin; i < end; i++)
        if (f->l->home[i] >= 0) f->l->home[i] = f->number[f->l->home[i]];
}

/* Keys of cells in order of appearance replace those of the points. */
static void list_keys(mps__grid *g)
{
    for (int64_t s = 0; s < g->table_size; s++)
        if (g->table_key[s] >= 0) g->point_key[g->table_cell[s]] = g->table_key[s];
}

int64_t mps__grid_find(mps__grid *g, mps__grid_level *l, int64_t points)
{
    if (!reserve_points(g, l, points)) return -1;
    l->points = points;
    if (!find_cells(g, l)) return -1;
    list_keys(g);
    return l->cells;
}

/* Number the red cells first, and cells of a colour by key. */
static void sort_cells(mps__grid *g, mps__grid_level *l)
{
    const int64_t *key = g->point_key;
    list_keys(g);
    const int32_t *sorted = sort_keys(g, key, l->cells);
    int32_t *number = g->order + (sorted == g->order ? g->order_capacity : 0);
    int32_t red = 0, black = (int32_t)l->red;
    for (int64_t c = 0; c < l->cells; c++) {
        const int32_t cell = sorted[c];
        number[cell] = is_red(key[cell]) ? red++ : black++;
        l->key[number[cell]] = key[cell];
    }
    for (int64_t s = 0; s < g->table_size; s++)
        if (g->table_key[s] >= 0) g->table_cell[s] = number[g->table_cell[s]];
    mps_parallel_rows_least(g->parallel, l->points, MPS__TEAM_LEAST / 2, renumber_rows,
                            &(finding){.l = l, .number = number});
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

/* Cells about those of a range, each found as the neighbour of one that is a step nearer. */
static void find_about(void *argument, int64_t begin, int64_t end)
{
    static const int power[3] = {1, 3, 9};
    const mps__grid *g = ((const finding *)argument)->g;
    const mps__grid_level *l = ((const finding *)argument)->l;
    const int all = all_about(g), sides = 2 * g->dim;
    for (int64_t c = begin; c < end; c++) {
        int32_t *about = l->about + c * all;
        for (int k = 0; k < all; k++) {
            about[k] = (int32_t)(k == 0 ? c : l->cells);
            for (int a = 0; a < g->dim && about[k] == l->cells; a++) {
                const int digit = k / power[a] % 3;
                const int64_t from = about[k - digit * power[a]];
                if (digit == 0 || from == l->cells) continue;
                const int32_t next = l->next[from * sides + 2 * a + digit - 1];
                if (next != from) about[k] = next;
            }
        }
    }
}

bool mps__grid_cells(mps__grid *g, mps__grid_level *l, int64_t points)
{
    if (!reserve_points(g, l, points)) return false;
    l->points = points;
    if (!find_cells(g, l) || !reserve_cells(g, l, l->cells) || !reserve_order(g, l->cells))
        return false;
    sort_cells(g, l);
    find_neighbours(g, l);
    mps_parallel_rows(mps__team(g->parallel, l->cells), l->cells, find_about,
                      &(finding){.g = g, .l = l});
    for (int64_t c = 0; c < l->cells; c++) l->shift[c] = l->kappa[c] = l->count[c] = 0;
    l->b[l->cells] = l->x[l->cells] = 0;
    return true;
}
