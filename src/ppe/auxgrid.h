/* SPDX-License-Identifier: BSD-3-Clause */
/* The hierarchy of background grids behind the preconditioner auxgrid. A grid is a list of the cells that hold something, so
 * its size follows the particles and never their bounding box. */
#ifndef MPS_PPE_AUXGRID_H
#define MPS_PPE_AUXGRID_H

#include <mps/ppe.h>
#include <stdbool.h>

enum {
    MPS__GRID_BITS =
        20, /* of a cell's coordinate; what lies further out is put into the last cell */
    MPS__GRID_LEVELS = 22,  /* after 20 halvings one cell is left */
    MPS__GRID_DIRECT = 150, /* fewer cells are solved directly */
    MPS__GRID_CHUNKS =
        8 /* parts of the particles, each summed by one thread; a fixed number, so that sums do not depend on the threads */
};

/* One grid, and how the points above it (particles, or the cells of the finer grid) reach its cells. The `red` cells, whose
 * coordinates have an even sum, come first: a cell's neighbours have the other colour. */
typedef struct mps__grid_level {
    int64_t points, point_capacity;
    int64_t cells, red, cell_capacity;
    int32_t *home; /* [points] cell that holds the point, -1: none */
    int32_t *at;   /* [points << dim] cells that a point takes its value from */
    float *share;  /* [points << dim] and how much of each; 0 or a sum of 1 */
    int64_t *key;  /* [cells] packed coordinates */
    int32_t *
        next; /* [cells * 2 dim] neighbours below and above along each axis, itself where there is none */
    float *link;     /* [cells * 2 dim] conductances to them, equal from both sides */
    double *shift;   /* [cells] the rest of the diagonal */
    double *inverse; /* [cells] of the diagonal, 0 for a cell with nothing */
    double *kappa;   /* [cells] mean conductivity of its points */
    double *count;   /* [cells] particles */
    double *b, *x;   /* [cells] right side and solution of the cycle in progress */
} mps__grid_level;

typedef struct mps__grid {
    mps_allocator allocator;
    const mps_parallel *parallel;
    int dim;
    bool one;                     /* one density everywhere */
    double lo[3], size, per_size; /* corner, edge and 1 / edge of the first grid's cells [m] */
    double unit;                  /* matrix entries times this are of order one */
    int levels;
    mps__grid_level level[MPS__GRID_LEVELS];
    int64_t table_size, table_capacity; /* a power of two */
    int64_t *table_key;  /* [table_size] hash table from coordinates to cells, -1: free */
    int32_t *table_cell; /* [table_size] */
    int64_t point_capacity;
    int64_t *point_key;  /* [points] coordinates of the cell that holds a point, -1: none */
    double *point_kappa; /* [points]; free when all grids are there */
    int64_t order_capacity;
    int32_t *order;       /* [cells] cells in order of appearance to cells by colour */
    size_t part_capacity; /* bytes */
    void *
        parts; /* [chunks * cells] what each chunk adds to the first grid: floats [2 dim] of links, or a double */
    int32_t range[MPS__GRID_CHUNKS][2]
                 [2]; /* red and black cells that a chunk adds to, first and one past the last */
    double *factor;   /* [direct * direct] L of the last grid's L D L' */
    double *pivot;    /* [direct] 1/D, 0 where D is */
} mps__grid;

/* ---- cells (auxgrid_cells.c) ---- */

static inline int64_t mps__grid_coordinate(int64_t key, int axis)
{
    return key >> (axis * MPS__GRID_BITS) & ((1 << MPS__GRID_BITS) - 1);
}

void mps__grid_release(mps__grid *g);
/* Room for what the chunks add to the first grid. */
bool mps__grid_reserve_parts(mps__grid *g);
/* First point of a chunk; of the one behind the last: the end. */
static inline int64_t mps__grid_chunk(int64_t points, int chunk)
{
    return points * chunk / MPS__GRID_CHUNKS;
}
/* Room to find the cells of so many points. */
bool mps__grid_reserve(mps__grid *g, int64_t points);
/* Cells and neighbours of a level from point_key; links and sums are zero. False when out of memory. */
bool mps__grid_cells(mps__grid *g, mps__grid_level *l, int64_t points);

/* ---- coefficients (auxgrid_links.c) ---- */

/* Conductivity of each row, from which the cell size follows. */
void mps__grid_measure(mps__grid *g, const mps_ppe_problem *problem);
/* Coordinates of the particles' cells into point_key. */
void mps__grid_place(mps__grid *g, const mps_ppe_problem *problem);
/* Coefficients of the first grid and the shares of the particles. False when out of memory. */
bool mps__grid_from_matrix(mps__grid *g, const mps_ppe_problem *problem);
/* All coarser grids. False when out of memory. */
bool mps__grid_coarsen(mps__grid *g);

/* ---- cycle (auxgrid_cycle.c) ---- */

/* Inverse diagonals and the factors of the last grid. False: a coefficient is not finite. */
bool mps__grid_factorise(mps__grid *g);
/* One V-cycle from b to x of the first grid. */
void mps__grid_cycle(mps__grid *g);
/* Sum the particles' values into the right side of the first grid. */
void mps__grid_restrict(mps__grid *g, const double *values, double scale);
/* Value of a point from the cells around it; for a constant number of corners, 2^dim, the loop unrolls. */
static inline double mps__grid_value_of(const mps__grid_level *l, const int corners, int64_t point)
{
    const int32_t *at = l->at + point * corners;
    const float *share = l->share + point * corners;
    double s = 0;
    for (int k = 0; k < corners; k++) s += (double)share[k] * l->x[at[k]];
    return s;
}
static inline double mps__grid_value(const mps__grid_level *l, int dim, int64_t point)
{
    return dim == 2 ? mps__grid_value_of(l, 4, point) : mps__grid_value_of(l, 8, point);
}

#endif
