/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid on a device: the host makes the grids, and what a cycle reads of them goes to the device in one block of its memory. A coarse cell
 * gathers there what finer ones add to it on the host, in the same order. */
#include "auxgrid.h"
#include "kernels.h"
#include <string.h>

/* ---- who adds to a cell ---- */

static size_t corners_of(const mps__grid *g)
{
    return (size_t)1 << g->dim;
}

/* The cell that a point of a level adds to at a corner; l->cells: none. */
static int32_t corner_cell(const mps__grid *g, const mps__grid_level *l, int64_t point, size_t k)
{
    const int all = g->dim == 2 ? 9 : MPS__GRID_ABOUT;
    return l->about[(int64_t)l->home[point] * all + mps__grid_corner[l->side[point]][k]];
}

/* Count the cells that add to each cell of a level, or list them too, with their shares. */
static void gather(const mps__grid *g, int k, const mps__grid_adding *a, bool list)
{
    const mps__grid_level *fine = &g->level[k - 1], *l = &g->level[k];
    for (int64_t c = 0; c < fine->red; c++) {
        if (l->home[c] < 0) continue;
        for (size_t corner = 0; corner < corners_of(g); corner++) {
            const int32_t to = corner_cell(g, l, c, corner);
            if (to == l->cells) continue;
            const int32_t at = a->first[to + 1]++;
            if (!list) continue;
            a->from[at] = (int32_t)c;
            a->part[at] = l->share[(size_t)c * corners_of(g) + corner];
        }
    }
}

/* Numbers become places: the list of cell c begins at first[c + 1], and at first[c] when it is there. */
static void add_up(const mps__grid_adding *a, int64_t cells)
{
    int32_t begin = 0;
    for (int64_t c = 0; c < cells; c++) {
        const int32_t count = a->first[c + 1];
        a->first[c + 1] = begin;
        begin += count;
    }
}

/* Lists of all grids but the first, on the host. False when out of memory. */
static bool list_adding(mps__grid_away *a, mps__grid *g)
{
    size_t numbers = 0;
    for (int k = 1; k < g->levels; k++)
        numbers += (size_t)g->level[k].cells + 1 + 2 * corners_of(g) * (size_t)g->level[k - 1].red;
    int32_t *room = mps__grid_room_of(g, &a->lists, (int64_t)numbers, sizeof *room);
    if (!room) return false;
    for (int k = 1; k < g->levels; k++) {
        const int64_t cells = g->level[k].cells;
        const size_t most = corners_of(g) * (size_t)g->level[k - 1].red;
        const mps__grid_adding list = {room, room + cells + 1,
                                       (float *)(void *)(room + cells + 1 + most)};
        room += (size_t)cells + 1 + 2 * most;
        memset(list.first, 0, (size_t)(cells + 1) * sizeof *list.first);
        gather(g, k, &list, false);
        add_up(&list, cells);
        gather(g, k, &list, true);
        a->list[k] = list;
    }
    return true;
}

/* ---- to the device ---- */

/* The block; `base` NULL: it is measured. */
typedef struct sending {
    mps__device *device;
    char *base;
    size_t used;
} sending;

/* Room for an array, with its values or zeros. */
static void *send(sending *s, const void *values, size_t count, size_t size)
{
    char *to = s->base ? s->base + s->used : NULL;
    s->used += (count * size + 255) & ~(size_t)255;
    if (to && values)
        mps__device_upload(s->device, to, values, count * size);
    else if (to)
        mps__device_clear(s->device, to, count * size);
    return to;
}

static void send_level(sending *s, const mps__grid *g, int k, mps__grid_away *a)
{
    const mps__grid_level *l = &g->level[k];
    const mps__grid_adding *list = &a->list[k];
    mps__grid_level *to = &a->grid.level[k];
    const size_t points = (size_t)l->points, cells = (size_t)l->cells, sides = 2 * (size_t)g->dim,
                 all = g->dim == 2 ? 9 : MPS__GRID_ABOUT,
                 adding = k > 0 ? (size_t)list->first[cells] : 0;
    to->home = send(s, l->home, points, sizeof *l->home);
    to->side = send(s, l->side, points, sizeof *l->side);
    to->share = send(s, l->share, points * corners_of(g), sizeof *l->share);
    to->about = send(s, l->about, cells * all, sizeof *l->about);
    to->next = send(s, l->next, cells * sides, sizeof *l->next);
    to->link = send(s, l->link, cells * sides, sizeof *l->link);
    to->inverse = send(s, l->inverse, cells, sizeof *l->inverse);
    to->b = send(s, NULL, cells + 1, sizeof *l->b);
    to->x = send(s, NULL, cells + 1, sizeof *l->x);
    if (k + 1 < g->levels) a->rest[k] = send(s, NULL, (size_t)l->red, sizeof(double));
    if (k == 0) return;
    a->there_list[k].first = send(s, list->first, cells + 1, sizeof *list->first);
    a->there_list[k].from = send(s, list->from, adding, sizeof *list->from);
    a->there_list[k].part = send(s, list->part, adding, sizeof *list->part);
}

static void send_all(sending *s, const mps__grid *g, mps__grid_away *a, const double *inverse)
{
    const mps__grid_level *l = &g->level[0];
    const size_t all = g->dim == 2 ? 9 : MPS__GRID_ABOUT;
    for (int k = 0; k < g->levels; k++) send_level(s, g, k, a);
    a->grid.list = send(s, g->list, (size_t)l->points, sizeof *g->list);
    a->grid.start = send(s, g->start, (size_t)g->turns + 1, sizeof *g->start);
    a->grid.parts = send(s, NULL, (size_t)(l->cells + 1) * all, sizeof(double));
    a->inverse = send(s, inverse, (size_t)l->points, sizeof *inverse);
    l = &g->level[g->levels - 1];
    a->grid.factor = send(s, g->factor, (size_t)(l->cells * l->cells), sizeof *g->factor);
    a->grid.pivot = send(s, g->pivot, (size_t)l->cells, sizeof *g->pivot);
}

static bool reserve(mps__grid_away *a, mps__device *d, size_t bytes)
{
    if (a->room && a->device == d && bytes <= a->bytes) return true;
    mps__grid_leave(a);
    a->bytes = bytes + bytes / 8;
    a->room = mps__device_room(d, a->bytes);
    a->device = d;
    return a->room != NULL;
}

int mps__grid_send(mps__grid_away *a, mps__grid *g, mps__device *d, const double *inverse)
{
    sending s = {.device = d};
    a->there = false;
    if (!list_adding(a, g)) return MPS_PPE_NOMEM;
    mps__grid_mirror_last(g);
    a->grid = *g;
    a->grid.parallel = &d->parallel;
    a->grid.away = a;
    send_all(&s, g, a, inverse);
    if (!reserve(a, d, s.used)) return MPS_PPE_NOMEM;
    s = (sending){.device = d, .base = a->room};
    send_all(&s, g, a, inverse);
    a->there = true;
    return 0;
}

void mps__grid_leave(mps__grid_away *a)
{
    if (a->room) mps__device_give(a->device, a->room, a->bytes);
    a->room = NULL;
    a->there = false;
}

/* ---- a cycle ---- */

/* What loops over cells see of those that add to them. */
typedef struct gathering {
    mps__grid_adding list;
    const double *rest;
    double *b;
} gathering;

MPS_ROW void gather_row(const int dim, const gathering *f, int64_t c)
{
    double sum = 0;
    (void)dim;
    for (int32_t k = f->list.first[c]; k < f->list.first[c + 1]; k++)
        sum += (double)f->list.part[k] * f->rest[f->list.from[k]];
    f->b[c] = sum;
}
MPS__LOOP_ANY(gather_rows, gather_row, gathering)

void mps__grid_gather(const mps__grid_away *a, int k)
{
    const mps__grid_level *l = &a->grid.level[k];
    mps__loop_run_cheap(a->grid.parallel, &gather_rows, MPS__ANY_DIM, l->cells,
                        &(gathering){a->there_list[k], a->rest[k - 1], l->b});
}
