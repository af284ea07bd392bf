/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: memory, and finding the cells that hold something through a hash table of their coordinates. */
#include "auxgrid.h"
#include "kernels.h"

/* ---- memory: it grows and is kept ---- */

static void drop_points(mps__grid *g, mps__grid_level *l)
{
    mps__give(&g->allocator, l->home);
    mps__give(&g->allocator, l->at);
    mps__give(&g->allocator, l->share);
    l->home = l->at = NULL;
    l->share = NULL;
    l->point_capacity = 0;
}

static void drop_cells(mps__grid *g, mps__grid_level *l)
{
    void *all[] = {l->key, l->next, l->link, l->shift, l->inverse, l->kappa, l->count, l->b, l->x};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__give(&g->allocator, all[k]);
    l->key = NULL;
    l->next = NULL;
    l->link = NULL;
    l->shift = l->inverse = l->kappa = l->count = l->b = l->x = NULL;
    l->cell_capacity = 0;
}

static bool reserve_points(mps__grid *g, mps__grid_level *l, int64_t points)
{
    if (points <= l->point_capacity) return true;
    drop_points(g, l);
    int64_t capacity = points + points / 32;
    l->home = mps__take(&g->allocator, capacity, sizeof *l->home);
    l->at = mps__take(&g->allocator, capacity << g->dim, sizeof *l->at);
    l->share = mps__take(&g->allocator, capacity << g->dim, sizeof *l->share);
    if (l->home && l->at && l->share)
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
    l->next = mps__take(&g->allocator, capacity * 2 * g->dim, sizeof *l->next);
    l->link = mps__take(&g->allocator, capacity * 2 * g->dim, sizeof *l->link);
    l->shift = mps__take(&g->allocator, capacity, sizeof *l->shift);
    l->inverse = mps__take(&g->allocator, capacity, sizeof *l->inverse);
    l->kappa = mps__take(&g->allocator, capacity, sizeof *l->kappa);
    l->count = mps__take(&g->allocator, capacity, sizeof *l->count);
    l->b = mps__take(&g->allocator, capacity, sizeof *l->b);
    l->x = mps__take(&g->allocator, capacity, sizeof *l->x);
    if (l->key && l->next && l->link && l->shift && l->inverse && l->kappa && l->count && l->b &&
        l->x)
        l->cell_capacity = capacity;
    else
        drop_cells(g, l);
    return l->cell_capacity > 0;
}

static void drop_work(mps__grid *g)
{
    void *all[] = {g->point_key, g->point_kappa, g->order, g->table_key, g->table_cell, g->parts};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__give(&g->allocator, all[k]);
    g->point_key = g->table_key = NULL;
    g->point_kappa = NULL;
    g->order = g->table_cell = NULL;
    g->parts = NULL;
    g->point_capacity = g->table_capacity = g->order_capacity = 0;
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
    g->order = mps__take(&g->allocator, g->order_capacity, sizeof *g->order);
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
    if (g->point_key && g->point_kappa && reserve_table(g, table_for(points / 8)))
        g->point_capacity = capacity;
    else
        drop_work(g);
    return g->point_capacity > 0;
}

bool mps__grid_reserve_parts(mps__grid *g)
{
    const size_t cells = (size_t)g->level[0].cells, links = 2 * (size_t)g->dim * sizeof(float);
    const size_t each = MPS__GRID_CHUNKS *
                        (g->one ? sizeof(double)
                                : links); /* 2 dim floats are no less than a double */
    if (cells * each < g->part_capacity) return true;
    mps__give(&g->allocator, g->parts);
    g->part_capacity = (cells + cells / 8 + 1) * each;
    g->parts = mps__take(&g->allocator, (int64_t)g->part_capacity, 1);
    if (!g->parts) g->part_capacity = 0;
    return g->parts;
}

void mps__grid_release(mps__grid *g)
{
    for (int k = 0; k < MPS__GRID_LEVELS; k++) {
        drop_points(g, &g->level[k]);
        drop_cells(g, &g->level[k]);
    }
    drop_work(g);
    mps__give(&g->allocator, g->factor);
    mps__give(&g->allocator, g->pivot);
    g->factor = g->pivot = NULL;
}

/* ---- cells ---- */

/* Slot of a key, or the free one where it belongs. */
static int64_t slot(const mps__grid *g, int64_t key)
{
    uint64_t hash = (uint64_t)key * 0x9e3779b97f4a7c15u;
    int64_t s = (int64_t)(hash >> 20) & (g->table_size - 1);
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

/* Number the red cells first. */
static void sort_cells(mps__grid *g, mps__grid_level *l)
{
    int32_t seen = 0, red = 0, black = (int32_t)l->red;
    for (int64_t i = 0; i < l->points; i++) {
        if (l->home[i] < 0) continue;
        if (l->home[i] == seen) {
            int32_t cell = is_red(g->point_key[i]) ? red++ : black++;
            l->key[cell] = g->point_key[i];
            g->order[seen++] = cell;
        }
        l->home[i] = g->order[l->home[i]];
    }
    for (int64_t s = 0; s < g->table_size; s++)
        if (g->table_key[s] >= 0) g->table_cell[s] = g->order[g->table_cell[s]];
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

bool mps__grid_cells(mps__grid *g, mps__grid_level *l, int64_t points)
{
    if (!reserve_points(g, l, points)) return false;
    l->points = points;
    if (!find_cells(g, l) || !reserve_cells(g, l, l->cells) || !reserve_order(g, l->cells))
        return false;
    sort_cells(g, l);
    find_neighbours(g, l);
    for (int64_t c = 0; c < l->cells; c++) l->shift[c] = l->kappa[c] = l->count[c] = 0;
    return true;
}
