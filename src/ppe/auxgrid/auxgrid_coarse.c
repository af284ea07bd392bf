/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: coarser grids, which merge two cells into one along each axis. On a device a coarse cell
 * sums the contributions of the finer cells, in the order in which the host adds them. */
#include "auxgrid.h"
#include "rows.h"
#include "scan.h"

/* ---- cells ---- */

typedef struct placing {
    const int64_t *key;
    const float *link;
    int64_t *to;
} placing;

/* Cells without links are solved on their own grid and are not coarsened. */
MPS_ROW void place_row(const int dim, const placing *f, int64_t c)
{
    bool linked = false;
    int64_t key = 0;
    for (int s = 0; s < 2 * dim; s++) linked = linked || f->link[c * 2 * dim + s] > 0;
    for (int a = 0; a < dim; a++)
        key |= mps__grid_coordinate(f->key[c], a) / 2 << (a * MPS__GRID_BITS);
    f->to[c] = linked ? key : -1;
}
MPS__LOOP(place_rows, place_row, placing)

/* ---- coefficients ---- */

typedef struct merging {
    const double *shift, *kappa, *count; /* of the finer grid */
    const float *link;
    const int32_t *next;
    const int32_t *home, *list, *start; /* its cells as points of the coarse grid */
    const int32_t *to_next;
    float *to_link;
    double *to_shift, *to_kappa, *to_count;
} merging;

/* Conductance between a cell and the one above it along an axis. As many edges cross between coarse
 * cells as between fine ones; in cells they are half as long. */
MPS_ROW float link_up(const int dim, const merging *f, int32_t below, int32_t above, int axis)
{
    float sum = 0;
    for (int32_t p = f->start[below]; p < f->start[below + 1]; p++) {
        const int64_t link = (int64_t)f->list[p] * 2 * dim + 2 * axis + 1;
        if (f->link[link] > 0 && f->home[f->next[link]] == above) sum += 0.5f * f->link[link];
    }
    return sum;
}

MPS_ROW void merge_row(const int dim, const merging *f, int64_t c)
{
    double shift = 0, kappa = 0, count = 0;
    for (int32_t p = f->start[c]; p < f->start[c + 1]; p++) {
        const int64_t fine = f->list[p];
        shift += f->shift[fine];
        kappa += f->count[fine] * f->kappa[fine];
        count += f->count[fine];
    }
    f->to_shift[c] = shift;
    f->to_kappa[c] = kappa / count;
    f->to_count[c] = count;
    for (int s = 0; s < 2 * dim; s++) {
        const int32_t cell = (int32_t)c, other = f->to_next[c * 2 * dim + s];
        if (other == cell) continue;
        f->to_link[c * 2 * dim + s] = s & 1 ? link_up(dim, f, cell, other, s / 2)
                                            : link_up(dim, f, other, cell, s / 2);
    }
}
MPS__LOOP(merge_rows, merge_row, merging)

static void from_finer(mps__grid *g, const mps__grid_level *fine, mps__grid_level *l)
{
    const merging f = {.shift = fine->shift,
                       .kappa = fine->kappa,
                       .count = fine->count,
                       .link = fine->link,
                       .next = fine->next,
                       .home = l->home,
                       .list = l->list,
                       .start = l->start,
                       .to_next = l->next,
                       .to_link = l->link,
                       .to_shift = l->shift,
                       .to_kappa = l->kappa,
                       .to_count = l->count};
    if (!g->device) mps__grid_list_cells(g, l);
    mps__loop_run(mps__team(g->parallel, l->cells), &merge_rows, g->dim, l->cells, &f);
    mps__grid_weigh_cells(g, fine, l);
}

/* ---- restriction lists, on a device ---- */

typedef struct listing {
    mps__grid_adding list;
    const int32_t *about, *start, *points;
    const uint8_t *side;
    const float *weight;
    int64_t cells, red; /* coarse cells; finer cells that have a residual */
} listing;

/* The corner at which a point adds to the neighbour cell in a direction; -1: none. */
MPS_ROW int corner_to(const int dim, const uint8_t *side, int64_t point, int direction)
{
    const uint8_t *corner = mps__grid_corner[side[point]];
    for (int k = 0; k < 1 << dim; k++)
        if (corner[k] == direction) return k;
    return -1;
}

MPS_ROW void count_adding(const int dim, const listing *f, int64_t c)
{
    const int all = mps__grid_all(dim);
    int64_t count = 0;
    for (int k = 0; k < all; k++) {
        const int32_t home = f->about[c * all + k];
        if (home == f->cells) continue;
        for (int32_t p = f->start[home]; p < f->start[home + 1]; p++)
            count += f->points[p] < f->red &&
                     corner_to(dim, f->side, f->points[p], mps__grid_opposite[k]) >= 0;
    }
    f->list.end[c] = count;
}
MPS__LOOP(count_rows, count_adding, listing)

/* Insert into the ascending list of the entries so far. */
MPS_ROW void insert(const mps__grid_adding *l, int64_t begin, int64_t at, int32_t from, float part)
{
    for (; at > begin && l->from[at - 1] > from; at--) {
        l->from[at] = l->from[at - 1];
        l->part[at] = l->part[at - 1];
    }
    l->from[at] = from;
    l->part[at] = part;
}

MPS_ROW void fill_adding(const int dim, const listing *f, int64_t c)
{
    const int all = mps__grid_all(dim);
    const int64_t begin = c > 0 ? f->list.end[c - 1] : 0;
    int64_t at = begin;
    for (int k = 0; k < all; k++) {
        const int32_t home = f->about[c * all + k];
        if (home == f->cells) continue;
        for (int32_t p = f->start[home]; p < f->start[home + 1]; p++) {
            const int32_t point = f->points[p];
            const int corner = point < f->red
                                   ? corner_to(dim, f->side, point, mps__grid_opposite[k])
                                   : -1;
            if (corner >= 0)
                insert(&f->list, begin, at++, point, f->weight[((int64_t)point << dim) + corner]);
        }
    }
}
MPS__LOOP(fill_rows, fill_adding, listing)

static bool list_adding(mps__grid *g, mps__grid_level *fine, mps__grid_level *l)
{
    if (!mps__grid_reserve_adding(g, fine, l)) return false;
    const listing f = {.list = l->adding,
                       .about = l->about,
                       .start = l->start,
                       .points = l->list,
                       .side = l->side,
                       .weight = l->weight,
                       .cells = l->cells,
                       .red = fine->red};
    mps__loop_run(g->parallel, &count_rows, g->dim, l->cells, &f);
    mps__scan(g->parallel, l->adding.end, l->cells);
    mps__loop_run(g->parallel, &fill_rows, g->dim, l->cells, &f);
    return true;
}

bool mps__grid_coarsen(mps__grid *g)
{
    while (g->levels < MPS__GRID_LEVELS && g->level[g->levels - 1].cells >= MPS__GRID_DIRECT) {
        mps__grid_level *fine = &g->level[g->levels - 1], *l = fine + 1;
        mps__loop_run(mps__team(g->parallel, fine->cells), &place_rows, g->dim, fine->cells,
                      &(placing){fine->key, fine->link, g->point_key});
        if (!mps__grid_cells(g, l, fine->cells)) return false;
        from_finer(g, fine, l);
        if (g->device && !list_adding(g, fine, l)) return false;
        g->levels++;
    }
    return true;
}

/* ---- a cycle ---- */

typedef struct restriction {
    mps__grid_adding list;
    const double *rest;
    double *b;
} restriction;

MPS_ROW void restrict_row(const restriction *f, int64_t c)
{
    double sum = 0;
    for (int64_t k = c > 0 ? f->list.end[c - 1] : 0; k < f->list.end[c]; k++)
        sum += (double)f->list.part[k] * f->rest[f->list.from[k]];
    f->b[c] = sum;
}
MPS__LOOP_ANY(restrict_rows, restrict_row, restriction)

void mps__grid_restrict_level(const mps__grid *g, int k)
{
    const mps__grid_level *l = &g->level[k];
    mps__loop_run_cheap(g->parallel, &restrict_rows, MPS__ANY_DIM, l->cells,
                        &(restriction){l->adding, l[-1].rest, l->b});
}
