/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: memory, of the host or of a device. The arrays of the points of a level are in one
 * block, those of its cells in another. */
#include "auxgrid.h"
#include "rows.h"
#include "scan.h"

static void *fit(const mps_allocator *a, mps__grid_buffer *r, int64_t count, size_t size)
{
    const int64_t bytes = count * (int64_t)size;
    if (r->at && bytes <= r->bytes) return r->at;
    mps__release(a, r->at);
    r->bytes = bytes + bytes / 8 + 64;
    r->at = mps__take(a, r->bytes, 1);
    if (!r->at) r->bytes = 0;
    return r->at;
}

void *mps__grid_buffer_of(mps__grid *g, mps__grid_buffer *r, int64_t count, size_t size)
{
    return fit(&g->allocator, r, count, size);
}

void *mps__grid_buffer_host(mps__grid *g, mps__grid_buffer *r, int64_t count, size_t size)
{
    return fit(&g->host, r, count, size);
}

static void drop(mps__grid *g, mps__grid_buffer *r)
{
    mps__release(&g->allocator, r->at);
    *r = (mps__grid_buffer){NULL, 0};
}

/* ---- blocks of several arrays ---- */

/* A block; `base` NULL: only its size is computed. */
typedef struct block {
    char *base;
    size_t used;
} block;

static void *put(block *b, int64_t count, size_t size)
{
    void *at = b->base ? b->base + b->used : NULL;
    b->used += ((size_t)count * size + 255) & ~(size_t)255;
    return at;
}

static void put_points(block *b, const mps__grid *g, mps__grid_level *l)
{
    l->home = put(b, l->points, sizeof *l->home);
    l->side = put(b, l->points, sizeof *l->side);
    l->weight = put(b, l->points << g->dim, sizeof *l->weight);
    l->list = put(b, l->points, sizeof *l->list);
}

/* A grid may have no cells. */
static void put_cells(block *b, const mps__grid *g, mps__grid_level *l)
{
    const int64_t cells = l->cells, sides = 2 * cells * g->dim;
    l->key = put(b, cells, sizeof *l->key);
    l->start = put(b, cells + 1, sizeof *l->start);
    l->about = put(b, cells * mps__grid_all(g->dim), sizeof *l->about);
    l->next = put(b, sides, sizeof *l->next);
    l->link = put(b, sides, sizeof *l->link);
    l->shift = put(b, cells, sizeof *l->shift);
    l->inverse = put(b, cells, sizeof *l->inverse);
    l->kappa = put(b, cells, sizeof *l->kappa);
    l->count = put(b, cells, sizeof *l->count);
    l->b = put(b, cells + 1, sizeof *l->b);
    l->x = put(b, cells + 1, sizeof *l->x);
}

bool mps__grid_reserve_points(mps__grid *g, mps__grid_level *l)
{
    block b = {NULL, 0};
    put_points(&b, g, l);
    b = (block){mps__grid_buffer_of(g, &l->point_buffer, (int64_t)b.used, 1), 0};
    put_points(&b, g, l);
    return b.base;
}

bool mps__grid_reserve_cells(mps__grid *g, mps__grid_level *l)
{
    block b = {NULL, 0};
    put_cells(&b, g, l);
    b = (block){mps__grid_buffer_of(g, &l->cell_buffer, (int64_t)b.used, 1), 0};
    put_cells(&b, g, l);
    return b.base;
}

/* A finer cell adds to at most one cell at each of its corners. */
static void put_adding(block *b, const mps__grid *g, mps__grid_level *fine, mps__grid_level *l)
{
    mps__grid_adding *a = &l->adding;
    fine->rest = put(b, fine->red, sizeof *fine->rest);
    a->end = put(b, mps__scan_size(l->cells), sizeof *a->end);
    a->from = put(b, fine->red << g->dim, sizeof *a->from);
    a->part = put(b, fine->red << g->dim, sizeof *a->part);
}

bool mps__grid_reserve_adding(mps__grid *g, mps__grid_level *fine, mps__grid_level *l)
{
    block b = {NULL, 0};
    put_adding(&b, g, fine, l);
    b = (block){mps__grid_buffer_of(g, &l->adding_buffer, (int64_t)b.used, 1), 0};
    put_adding(&b, g, fine, l);
    return b.base;
}

/* Two halves of keys and indices: a sort pass reads one and writes the other. */
static void put_sorted(block *b, mps__grid_sorted *s, int64_t points)
{
    s->key = put(b, 2 * points, sizeof *s->key);
    s->order = put(b, 2 * points, sizeof *s->order);
    s->number = put(b, mps__scan_size(points), sizeof *s->number);
}

bool mps__grid_reserve_sorted(mps__grid *g, int64_t points)
{
    block b = {NULL, 0};
    put_sorted(&b, &g->sorted, points);
    b = (block){mps__grid_buffer_of(g, &g->sort_buffer, (int64_t)b.used, 1), 0};
    put_sorted(&b, &g->sorted, points);
    return b.base;
}

/* ---- scratch ---- */

static void drop_work(mps__grid *g)
{
    void *all[] = {g->point_key, g->point_kappa, g->order, g->table_key, g->table_cell, g->parts};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__release(&g->allocator, all[k]);
    g->point_key = g->table_key = NULL;
    g->point_kappa = NULL;
    g->order = g->table_cell = NULL;
    g->parts = NULL;
    g->point_capacity = g->table_capacity = g->order_capacity = 0;
    g->part_capacity = 0;
}

int64_t mps__grid_table_for(int64_t cells)
{
    int64_t size = 16;
    while (size < cells + cells / 2) size *= 2;
    return size;
}

bool mps__grid_reserve_table(mps__grid *g, int64_t size)
{
    if (size <= g->table_capacity) return true;
    mps__release(&g->allocator, g->table_key);
    mps__release(&g->allocator, g->table_cell);
    g->table_key = mps__take(&g->allocator, size, sizeof *g->table_key);
    g->table_cell = mps__take(&g->allocator, size, sizeof *g->table_cell);
    g->table_capacity = g->table_key && g->table_cell ? size : 0;
    return g->table_capacity > 0;
}

bool mps__grid_reserve_order(mps__grid *g, int64_t cells)
{
    if (cells < g->order_capacity) return true;
    mps__release(&g->allocator, g->order);
    g->order_capacity = cells + cells / 8 + 1;
    g->order = mps__take(&g->allocator, 2 * g->order_capacity, sizeof *g->order);
    if (!g->order) g->order_capacity = 0;
    return g->order;
}

/* Arrays of the last grid, and the results of the set-up. */
static bool reserve_few(mps__grid *g)
{
    const mps_allocator *a = &g->allocator;
    if (!g->factor)
        g->factor = mps__take(a, MPS__GRID_DIRECT * MPS__GRID_DIRECT, sizeof *g->factor);
    if (!g->pivot) g->pivot = mps__take(a, MPS__GRID_DIRECT, sizeof *g->pivot);
    if (g->device && !g->bad) g->bad = mps__take(a, MPS__GRID_LEVELS, sizeof *g->bad);
    if (g->device && !g->reported) g->reported = mps__take(a, 1, sizeof *g->reported);
    return g->factor && g->pivot && ((g->bad && g->reported) || !g->device);
}

bool mps__grid_reserve(mps__grid *g, int64_t points)
{
    if (!reserve_few(g)) return false;
    if (g->device && !mps__grid_reserve_sorted(g, points)) return false;
    if (points <= g->point_capacity && (g->table_capacity > 0 || g->device)) return true;
    drop_work(g);
    const int64_t capacity = points + points / 32;
    g->point_key = mps__take(&g->allocator, capacity, sizeof *g->point_key);
    g->point_kappa = mps__take(&g->allocator, capacity, sizeof *g->point_kappa);
    if (g->point_key && g->point_kappa &&
        (g->device || mps__grid_reserve_table(g, mps__grid_table_for(points / 8))))
        g->point_capacity = capacity;
    else
        drop_work(g);
    return g->point_capacity > 0;
}

bool mps__grid_reserve_parts(mps__grid *g, size_t bytes)
{
    if (bytes < g->part_capacity) return true;
    mps__release(&g->allocator, g->parts);
    g->part_capacity = bytes + bytes / 8 + sizeof(double);
    g->parts = mps__take(&g->allocator, (int64_t)g->part_capacity, 1);
    if (!g->parts) g->part_capacity = 0;
    return g->parts;
}

void mps__grid_release(mps__grid *g)
{
    for (int k = 0; k < MPS__GRID_LEVELS; k++) {
        drop(g, &g->level[k].point_buffer);
        drop(g, &g->level[k].cell_buffer);
        drop(g, &g->level[k].adding_buffer);
    }
    drop(g, &g->visit_buffer);
    drop(g, &g->sort_buffer);
    drop_work(g);
    mps__grid_ranks_release(g);
    mps__release(&g->allocator, g->factor);
    mps__release(&g->allocator, g->pivot);
    mps__release(&g->allocator, g->bad);
    mps__release(&g->allocator, g->reported);
    g->factor = g->pivot = g->bad = NULL;
    g->reported = NULL;
    g->laid = false;
}
