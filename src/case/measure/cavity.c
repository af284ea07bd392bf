/* SPDX-License-Identifier: BSD-3-Clause */
/* Flood fill of the cells without liquid. */
#include "cavity.h"
#include <math.h>
#include <stdlib.h>

enum { LEAST_CELLS = 4, LIQUID = -1 };

/* Fraction of liquid in the part of a cell that is not solid. */
static double filling(const raster *g, int64_t cell)
{
    return g->share[RASTER_LIQUID][cell] / fmax(1 - g->share[RASTER_SOLID][cell], 0.1);
}

/* Empty part of a cell, in cells. */
static double emptiness(const raster *g, int64_t cell)
{
    return fmax(0, 1 - g->share[RASTER_SOLID][cell] - g->share[RASTER_LIQUID][cell]);
}

bool mps__cavities_create(cavities *c, mps_sim *sim, const double *from, const double *to)
{
    double dp = 0, lo[3], hi[3];
    mps_sim_shape(sim, NULL, &dp);
    for (int d = 0; d < 3; d++) { /* centres of cells */
        lo[d] = from[d] + 0.5 * dp;
        hi[d] = fmax(to[d], from[d] + dp) - 0.5 * dp;
    }
    *c = (cavities){0};
    if (!mps__raster_create(&c->grid, sim, lo, hi, 1)) return false;
    c->body = malloc((size_t)c->grid.count * sizeof *c->body);
    c->queue = malloc((size_t)c->grid.count * sizeof *c->queue);
    return c->body && c->queue;
}

void mps__cavities_free(cavities *c)
{
    mps__raster_free(&c->grid);
    free(c->body);
    free(c->queue);
    c->body = NULL;
    c->queue = NULL;
}

/* Neighbour k of a cell across a face, or -1. */
static int64_t across(const raster *g, int64_t cell, int k)
{
    int64_t stride = 1, at = cell;
    for (int d = 0; d < k / 2; d++) {
        at /= g->size[d];
        stride *= g->size[d];
    }
    at = at % g->size[k / 2] + (k % 2 ? 1 : -1);
    return at < 0 || at >= g->size[k / 2] ? -1 : cell + (k % 2 ? stride : -stride);
}

/* Number all cells of the region of `first`. @return their count */
static int64_t body_fill(cavities *c, int64_t first, int32_t number)
{
    int64_t count = 0, done = 0;
    c->body[first] = number;
    c->queue[count++] = first;
    while (done < count) {
        int64_t cell = c->queue[done++];
        for (int k = 0; k < 2 * c->grid.dim; k++) {
            int64_t next = across(&c->grid, cell, k);
            if (next < 0 || c->body[next] != 0) continue;
            c->body[next] = number;
            c->queue[count++] = next;
        }
    }
    return count;
}

/* Empty space of the `count` cells in the queue and of the liquid cells up to two away, which are
 * not entirely full. */
static double body_volume(cavities *c, int64_t count)
{
    const raster *g = &c->grid;
    double sum = 0;
    for (int ring = 0; ring < 2; ring++)
        for (int64_t i = 0, end = count; i < end; i++)
            for (int k = 0; k < 2 * g->dim; k++) {
                int64_t next = across(g, c->queue[i], k);
                if (next < 0 || c->body[next] != LIQUID) continue;
                c->body[next] = LIQUID - 1; /* visited once only */
                c->queue[count++] = next;
            }
    for (int64_t i = 0; i < count; i++) sum += emptiness(g, c->queue[i]);
    return sum * pow(g->dp, g->dim);
}

double mps__cavities_volume(cavities *c, mps_sim *sim)
{
    const raster *g = &c->grid;
    double all = 0, open = 0;
    int64_t most = 0;
    int32_t bodies = 0;
    if (!mps__raster_fill(&c->grid, sim)) return NAN;
    for (int64_t i = 0; i < g->count; i++) c->body[i] = filling(g, i) < 0.5 ? 0 : LIQUID;
    for (int64_t i = 0; i < g->count; i++) {
        if (c->body[i] != 0) continue;
        int64_t cells = body_fill(c, i, ++bodies);
        if (cells < LEAST_CELLS) continue;
        double volume = body_volume(c, cells);
        all += volume;
        if (cells <= most) continue;
        most = cells;
        open = volume;
    }
    return all - open;
}
