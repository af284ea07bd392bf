/* SPDX-License-Identifier: BSD-3-Clause */
/* Hierarchy of background grids of the preconditioner auxgrid. A grid lists only the cells that
 * contain points: its size depends on the number of particles, not on their bounding box. */
#ifndef MPS_PPE_AUXGRID_H
#define MPS_PPE_AUXGRID_H

#include "device.h"
#include "loop.h"
#include "builtin.h"
#include <stdbool.h>

enum {
    /* of a cell coordinate; points further out are assigned to the last cell */
    MPS__GRID_BITS = 21,
    MPS__GRID_LEVELS = 22,  /* after 19 halvings four cells are left along each axis */
    MPS__GRID_DIRECT = 150, /* fewer cells are solved directly */
    MPS__GRID_ABOUT = 27,   /* a cell and its neighbours, in 3-D */
    /* many ranks: a grid of at least this many cells is divided among the ranks */
    MPS__GRID_WHOLE = 65536
};

/* Buffer that grows and is reused; its contents are not preserved. */
typedef struct mps__grid_buffer {
    void *at;
    int64_t bytes;
} mps__grid_buffer;

/* Restriction list on a device: the finer cells that add to each cell. Those of cell c end before
 * end[c], where those of cell c + 1 begin. */
typedef struct mps__grid_adding {
    int64_t *end;  /* [cells], also workspace of the prefix sum */
    int32_t *from; /* ascending for each cell */
    float *part;   /* weight of the finer cell's residual */
} mps__grid_adding;

/* One grid, and its interpolation from and to the points above it (particles, or the cells of the
 * finer grid).
 *
 * Order of the cells: first the `red` ones, whose coordinates have an even sum, then the black ones
 * (neighbours along an axis have different colours), both sorted by key. Sums over cells and the
 * direct solution of the last grid then depend only on the set of cells, not on the order in which
 * particles were found. A sum over particles runs in the order of the particles.
 *
 * The neighbourhood of a cell (3^dim cells, itself included) is numbered by one digit of base three
 * for each axis: 0 the same coordinate, 1 one less, 2 one more. */
typedef struct mps__grid_level {
    int64_t points, cells, red;
    mps__grid_buffer point_buffer, cell_buffer, adding_buffer;
    int32_t *home; /* [points] cell that contains the point, -1: none */
    /* [points] bit a: which side of its cell the point is nearer to along axis a, 0 below, 1
     * above */
    uint8_t *side;
    /* [points << dim] interpolation weights of the cells on that side; 0 or a sum of 1 */
    float *weight;
    int32_t *list; /* [points] the points sorted by cell, in their own order within each */
    /* [cells + 1] first entry of each cell in `list`; on a host, of the first grid: in the order of
     * `visit` */
    int32_t *start;
    int64_t *key;   /* [cells] packed coordinates */
    int32_t *about; /* [cells * 3^dim] neighbourhood of each cell, `cells` where there is none */
    /* [cells * 2 dim] neighbours below and above along each axis, the cell itself where there is
     * none */
    int32_t *next;
    float *link;     /* [cells * 2 dim] conductances to them, equal on both sides */
    double *shift;   /* [cells] remainder of the diagonal */
    double *inverse; /* [cells] of the diagonal, 0 for an empty row */
    double *kappa;   /* [cells] mean conductivity of its points */
    double *count;   /* [cells] number of particles */
    /* [cells + 1] right side and solution of the cycle; x[cells], of no cell, is 0 */
    double *b, *x;
    mps__grid_adding adding; /* on a device, except for the first grid */
    double *rest;            /* [red] residuals, on a device, except for the last grid */
} mps__grid_level;

enum { MPS__GRID_DIVIDED_BUFFERS = 5 };
enum {
    MPS__GRID_VALUES,
    MPS__GRID_ENTRIES,
    MPS__GRID_PLACES,
    MPS__GRID_SEND_DEVICE,
    MPS__GRID_RECEIVE_DEVICE,
    MPS__GRID_OWNED_DEVICE,
    MPS__GRID_OWNERS_DEVICE,
    MPS__GRID_VISITS_DEVICE,
    MPS__GRID_PACKET,
    MPS__GRID_HOST, /* the buffers from here on are on the host, even if the grid is on a device */
    MPS__GRID_COUNTS = MPS__GRID_HOST,
    MPS__GRID_KEYS,
    MPS__GRID_OWNERS,
    MPS__GRID_CELLS,
    MPS__GRID_CENTRES,
    MPS__GRID_MARKS,
    MPS__GRID_SENT,
    MPS__GRID_RECEIVED,
    MPS__GRID_PARTNERS,
    MPS__GRID_PARTS_OUT,
    MPS__GRID_PARTS_IN,
    MPS__GRID_OUT,
    MPS__GRID_IN,
    MPS__GRID_CELL_KEYS,
    MPS__GRID_AROUND,
    MPS__GRID_WIDE,
    MPS__GRID_FACES,
    MPS__GRID_BUFFERS
};

/* Halo exchange of cell values: cells that a rank sends and cells that it receives, in the order of
 * the route. */
typedef struct mps__grid_plan {
    mps__grid_buffer buffer[4];
    int64_t sends, receives;
    int32_t *send, *receive;
    double *out, *in;
    mps_route route;
    bool connected;
} mps__grid_plan;

/* Cells of rank 0, of rank 1, ..., ascending for each. */
typedef struct mps__grid_owned {
    int64_t *first; /* [ranks + 1] */
    int32_t *cell;  /* [cells] */
} mps__grid_owned;

/* A grid that is divided among the ranks: each solves its own cells. */
typedef struct mps__grid_divided {
    mps__grid_buffer buffer[MPS__GRID_DIVIDED_BUFFERS];
    int32_t *owner; /* [cells] */
    mps__grid_owned owned;
    int64_t own, own_red; /* own cells, red ones first */
    int32_t *cell;        /* [own] */
    double *rest;         /* [cells] residuals of red cells */
    int64_t adding;
    /* [adding] red cells whose residuals are restricted to own cells of the coarser grid */
    int32_t *add;
    mps__grid_plan ring; /* x of the cells that own cells, or points of this rank, read */
    mps__grid_plan left; /* residuals */
} mps__grid_divided;

/* Lists of a rank in the memory of its device. */
typedef struct mps__grid_device_lists {
    int64_t *send, *receive; /* parts */
    int64_t *owned;          /* [cells] of the first grid, as in mps__grid_owned */
    int32_t *owner;          /* [cells] of the first grid */
    double *packet;          /* values copied between host and device */
} mps__grid_device_lists;

/* Many ranks. The owner of a cell of the first grid is the rank that owns its centre; the owner of
 * a coarser cell is the owner of its first finer cell. The owner has all particles of its cells and
 * sums them; contributions to neighbour cells are sent to their owners. Every rank has the cells
 * and coefficients of all grids. On large grids each rank solves its own cells. The right side of
 * the first small grid is collected on all ranks, and each of them solves that grid and all coarser
 * ones identically. Devices do not divide grids: each solves all cells. */
typedef struct mps__grid_ranks {
    mps_ppe_ranks table; /* ranks == 0: one rank */
    mps__grid_buffer buffer[MPS__GRID_BUFFERS];
    int64_t n;             /* rows of this rank */
    int64_t columns;       /* and of other ranks: points of the first grid */
    double *value;         /* [columns] */
    double *entries;       /* [columns] of the rows */
    int32_t *place;        /* [columns] index of a column in the order of the particles */
    int64_t *bytes;        /* [ranks] of each message */
    int64_t *count;        /* [ranks] scratch */
    mps__grid_owned owned; /* cells of the first grid */
    int32_t *owner;        /* [cells] of the first grid */
    const int64_t *key;    /* [cells] of the first grid, on the host */
    const int32_t *about;  /* [cells * 3^dim] of the first grid, on the host */
    mps__grid_device_lists on_device;
    double *out, *in;
    /* contributions sent to and received from other ranks, in the order of the route */
    int64_t *send, *receive;
    mps_route route;
    bool connected;
    int64_t whole; /* cells from which on a grid is divided */
    int divided;   /* number of divided levels, from the first on */
    mps__grid_divided level[MPS__GRID_LEVELS];
} mps__grid_ranks;

/* Points of a grid sorted by cell, on a device. Each array has two halves; a sort pass reads one
 * and writes the other. */
typedef struct mps__grid_sorted {
    uint64_t *key; /* UINT64_MAX: none */
    int32_t *order;
    int64_t *number;         /* [points] prefix sum of the cells that begin */
    const uint64_t *key_now; /* the half that is sorted */
    const int32_t *order_now;
} mps__grid_sorted;

/* Results of a set-up on a device, downloaded in one copy; loops reduce into it on the device. */
typedef struct mps__grid_reported {
    struct {
        mps_exact sums[2];
        double maxima[5];
    } look;        /* of the matrix rows */
    double square; /* mean of r_ij^2 */
    struct {
        mps_exact sums[3];
        double largest;
    } measure;       /* of conductivities */
    double cells[2]; /* of the grid sorted last: cells, red cells */
} mps__grid_reported;

typedef struct mps__grid {
    mps_allocator allocator, host; /* of the arrays; of the host arrays of ranks */
    const mps_parallel *parallel;
    mps__device *device; /* memory space of the arrays and of the loops; NULL: host */
    int dim;
    bool one; /* one density everywhere */
    /* corner [cells], edge and 1 / edge of the first grid's cells [m] */
    double corner[3], size, per_size;
    double unit; /* matrix entries times this are of order one */
    bool laid;   /* corner and size are set */
    int levels;
    mps__grid_level level[MPS__GRID_LEVELS];
    int64_t table_size, table_capacity; /* a power of two */
    int64_t *table_key;  /* [table_size] hash table from coordinates to cells, -1: free */
    int32_t *table_cell; /* [table_size] */
    int64_t point_capacity;
    int64_t *point_key;  /* [points] coordinates of the cell that holds a point, -1: none */
    double *point_kappa; /* [points]; free for use once all grids are set up */
    mps__grid_buffer visit_buffer;
    /* [cells] cells of the first grid in the order in which particles meet them; NULL: order of the
     * cells */
    int32_t *visit;
    int64_t order_capacity;
    int32_t *order;               /* [2 * cells] to sort cells */
    mps__grid_buffer sort_buffer; /* to sort points, on a device */
    mps__grid_sorted sorted;
    size_t part_capacity; /* bytes */
    /* contributions of the particles of each cell to its neighbourhood, or the faces of two
     * densities */
    void *parts;
    double *factor;               /* [direct * direct] L of the last grid's L D L' */
    double *pivot;                /* [direct] 1/D, 0 where D is */
    double *bad;                  /* [levels] 1 if a diagonal is not finite, on a device */
    mps__grid_reported *reported; /* on a device */
    /* cells of the first grid whose particles are summed: all, or those of this rank */
    int64_t visits;
    mps__grid_ranks ranks;
} mps__grid;

static inline bool mps__grid_many(const mps__grid *g)
{
    return g->ranks.table.ranks > 1;
}

/* Size of the neighbourhood of a cell, itself included. */
MPS_ROW int mps__grid_all(const int dim)
{
    return dim == 2 ? 9 : MPS__GRID_ABOUT;
}

/* ---- memory (auxgrid_memory.c): grows and is reused; false or NULL: out of memory ---- */

void mps__grid_release(mps__grid *g);
/* Buffers to find the cells of this many points. */
bool mps__grid_reserve(mps__grid *g, int64_t points);
/* Buffers of the points and the cells of a level, whose numbers are known. */
bool mps__grid_reserve_points(mps__grid *g, mps__grid_level *l);
bool mps__grid_reserve_cells(mps__grid *g, mps__grid_level *l);
/* Buffers of the residuals of a grid and of the restriction list of the coarser one. */
bool mps__grid_reserve_adding(mps__grid *g, mps__grid_level *fine, mps__grid_level *l);
/* Workspace to sort points. */
bool mps__grid_reserve_sorted(mps__grid *g, int64_t points);
bool mps__grid_reserve_table(mps__grid *g, int64_t size);
bool mps__grid_reserve_order(mps__grid *g, int64_t cells);
/* At least this many bytes in `parts`. */
bool mps__grid_reserve_parts(mps__grid *g, size_t bytes);
/* Number of slots for this many cells. */
int64_t mps__grid_table_for(int64_t cells);
/* A buffer that is reused; one on the host. */
void *mps__grid_buffer_of(mps__grid *g, mps__grid_buffer *buffer, int64_t count, size_t size);
void *mps__grid_buffer_host(mps__grid *g, mps__grid_buffer *buffer, int64_t count, size_t size);

/* ---- cells (auxgrid_cells.c) ---- */

static inline int64_t mps__grid_coordinate(int64_t key, int axis)
{
    return key >> (axis * MPS__GRID_BITS) & ((1 << MPS__GRID_BITS) - 1);
}

static inline bool mps__grid_is_red(int64_t key)
{
    return ((mps__grid_coordinate(key, 0) + mps__grid_coordinate(key, 1) +
             mps__grid_coordinate(key, 2)) &
            1) == 0;
}

/* Replace the keys in point_key by those of the cells, each once. Returns their number, -1 when out
 * of memory. */
int64_t mps__grid_find(mps__grid *g, mps__grid_level *l, int64_t points);
/* Cells and neighbours of a level from point_key; links are zero. False when out of memory. */
bool mps__grid_cells(mps__grid *g, mps__grid_level *l, int64_t points);
/* Second half of mps__grid_cells(): the cells have been found and counted. */
bool mps__grid_make_cells(mps__grid *g, mps__grid_level *l);
/* On a host: sort the points of a coarser grid by cell. A device has them sorted already. */
void mps__grid_list_cells(const mps__grid *g, mps__grid_level *l);

/* ---- cells on a device (auxgrid_sort.c) ---- */

/* Sort the points by cell and count the cells into `reported` on the device. */
void mps__grid_sort(mps__grid *g, const mps__grid_level *l);
/* Copy these counts to the host and into the level. A maximum is -INFINITY if no row has a
 * value. */
void mps__grid_count(const mps__grid *g, mps__grid_level *l);
static inline void mps__grid_counted(mps__grid_level *l, const double cells[2])
{
    l->cells = cells[0] > 0 ? (int64_t)cells[0] : 0;
    l->red = cells[1] > 0 ? (int64_t)cells[1] : 0;
}
/* Set homes, keys, lists of points, neighbours. */
void mps__grid_number(mps__grid *g, mps__grid_level *l);
/* As mps__grid_find(), for points whose keys are on the device. */
int64_t mps__grid_find_device(mps__grid *g, mps__grid_level *l, int64_t points);
/* Homes of the points of a level among its cells, from the keys of both. */
void mps__grid_home(mps__grid *g, mps__grid_level *l);
/* Sort the points in the own cells of a rank by cell, as mps__grid_list() does on the host. */
void mps__grid_list_own(mps__grid *g, mps__grid_level *l);

/* ---- coefficients of the first grid (auxgrid_links.c) ---- */

/* Data common to all rows. */
typedef struct mps__grid_common {
    double square;   /* mean of r_ij^2 */
    double least[3]; /* [dim] the largest of -x */
} mps__grid_common;

/* On a device: this whole section up to sorting and counting the cells of the first grid. Returns 0
 * or a reason of failure. */
int mps__grid_ask(mps__grid *g, const mps_ppe_problem *problem);
/* Check and sample all rows. Returns 0, or the reason of failure, the same on all ranks: too many
 * unknowns on one rank, or an invalid diagonal entry. */
int mps__grid_look(const mps_ppe_problem *problem, mps__grid_common *common);
/* Conductivity of each row, which determines the cell size. */
void mps__grid_measure(mps__grid *g, const mps_ppe_problem *problem, double square);
/* Set the corner of the first grid. */
void mps__grid_lay(mps__grid *g, const mps_ppe_problem *problem, const double *least);
/* Write the cell coordinates of the first `points` particles to point_key. */
void mps__grid_place(mps__grid *g, const mps_ppe_problem *problem, int64_t points);
/* Coefficients of the first grid and interpolation weights of the particles. Returns 0 or a reason
 * of failure. */
int mps__grid_from_matrix(mps__grid *g, const mps_ppe_problem *problem);

/* Positions of particles relative to the cells of the first grid. */
typedef struct mps__grid_positions {
    const double *x;
    double corner[3], per_size;
} mps__grid_positions;

static inline mps__grid_positions mps__grid_positions_of(const mps__grid *g,
                                                         const mps_ppe_problem *problem)
{
    return (mps__grid_positions){
        problem->x, {g->corner[0], g->corner[1], g->corner[2]}, g->per_size};
}

/* Position of a particle in cells, within the range of coordinates. */
MPS_ROW double mps__grid_position(const int dim, const mps__grid_positions *p, int64_t i, int a)
{
    const double most = (1 << MPS__GRID_BITS) - 0.5;
    double u = p->x[i * dim + a] * p->per_size - p->corner[a];
    u = u > 0 ? u : 0;
    return u < most ? u : most;
}

/* Links of the first grid from the pairs of particles, for several densities (auxgrid_edges.c).
 * Returns 0 or a reason of failure. */
int mps__grid_edges(mps__grid *g, const mps_ppe_problem *problem);

/* ---- coarser grids (auxgrid_coarse.c) ---- */

/* Set up all coarser grids. False when out of memory. */
bool mps__grid_coarsen(mps__grid *g);
/* On a device: right side of level k, restricted from the residuals of the finer one. */
void mps__grid_restrict_level(const mps__grid *g, int k);

/* ---- transfer (auxgrid_transfer.c) ---- */

/* Cells on the side that a point is nearer to, as numbers in the neighbourhood: [side][corner]. */
extern const uint8_t mps__grid_corner[8][8];
/* Number of a cell in the neighbourhood of its neighbour: each step reversed. */
extern const uint8_t mps__grid_opposite[MPS__GRID_ABOUT];

/* Sort the particles by cell of the first grid. False when out of memory. */
bool mps__grid_list(mps__grid *g);
/* Interpolation weights and sides of the particles. Their shifts replace their conductivities in
 * point_kappa. */
void mps__grid_weigh_particles(mps__grid *g, const mps_ppe_problem *problem);
/* Interpolation weights and sides of the cells of the finer grid. */
void mps__grid_weigh_cells(const mps__grid *g, const mps__grid_level *fine, mps__grid_level *l);
/* Restrict the values [n] of the particles to the right side of the first grid. Returns 0 or a
 * reason of failure. */
int mps__grid_restrict(mps__grid *g, const double *values, double scale);

/* ---- many ranks (auxgrid_ranks.c); all return 0 or a reason of failure ---- */

/* Number of contributions to other ranks, and from them. */
static inline int64_t mps__grid_sent(const mps__grid_ranks *r)
{
    int64_t sum = 0;
    for (int32_t k = 0; k < r->route.to_count; k++) sum += r->route.sent[k];
    return sum;
}
static inline int64_t mps__grid_received(const mps__grid_ranks *r)
{
    int64_t sum = 0;
    for (int32_t k = 0; k < r->route.from_count; k++) sum += r->route.received[k];
    return sum;
}

/* Prepare for an equation, on one rank or many. */
int mps__grid_ranks_begin(mps__grid *g, const mps_ppe_problem *problem);
void mps__grid_ranks_release(mps__grid *g);
/* A reused buffer: MPS__GRID_VALUES .. in the memory of the grid, from MPS__GRID_HOST on in that of
 * the host. */
void *mps__grid_ranks_buffer(mps__grid *g, int which, int64_t count, size_t size);
/* Cells of the first grid and their owners, after mps__grid_lay(); conductivities and numbers of
 * entries of all columns. */
int mps__grid_ranks_cells(mps__grid *g, const mps_ppe_problem *problem);
/* Copy the values [n] of the rows to `value` and exchange those of the other columns. */
int mps__grid_ranks_halo(mps__grid *g, const double *values);
/* Exchange the contributions of particles to cells of other ranks, in `parts`. */
int mps__grid_ranks_exchange(mps__grid *g);
/* Collect the values of all cells from their owners on all ranks, into MPS__GRID_IN in the order of
 * `owned`, all values of a cell together. */
int mps__grid_ranks_collect(mps__grid *g, const mps__grid_owned *owned, int arrays,
                            double *const *array);

/* ---- many ranks with a device each (auxgrid_ranks_device.c) ---- */

/* Cells of the first grid from the keys of all ranks, as mps__grid_cells() makes them, and homes of
 * all columns. Copies keys and neighbours of the cells to the host, which finds the owners. Returns
 * 0 or a reason of failure. */
int mps__grid_cells_device(mps__grid *g, const mps_ppe_problem *problem, const int64_t *key,
                           int64_t keys);
/* Copy owners and lists to the device. Returns 0 or a reason of failure. */
int mps__grid_owners_to_device(mps__grid *g);
/* Copy the values at given indices of several arrays to the host, all values of an index together,
 * and back. place: [count] on the device */
void mps__grid_to_host(mps__grid *g, const int64_t *place, int64_t count, int arrays,
                       double *const *array, double *values);
void mps__grid_to_device(mps__grid *g, const int64_t *place, int64_t count, int arrays,
                         double *const *array, const double *values);

/* ---- divided grids (auxgrid_divided.c) ---- */

/* Divide large grids, after all grids are set up. */
int mps__grid_divide(mps__grid *g);
/* Free the routes; no grid is divided. */
void mps__grid_undivide(mps__grid *g);
void mps__grid_divided_release(mps__grid *g);
/* Halo exchange of the values of the cells of a plan. */
int mps__grid_plan_exchange(mps__grid *g, mps__grid_plan *p, double *values);

/* ---- the last grid (auxgrid_last.c) ---- */

/* Factorise its matrix. */
void mps__grid_factorise_last(mps__grid *g);
/* Solve for x from b. */
void mps__grid_solve_last(const mps__grid *g);

/* ---- cycle (auxgrid_cycle.c) ---- */

/* Inverse diagonals and the factors of the last grid. False: a coefficient is not finite. */
bool mps__grid_factorise(mps__grid *g);
/* One V-cycle from b to x of the first grid. Returns 0 or a reason of failure. */
int mps__grid_cycle(mps__grid *g);

/* Interpolation from the cells of a level to points. */
typedef struct mps__grid_points {
    const int32_t *home, *about;
    const uint8_t *side;
    const float *weight;
    const double *x;
} mps__grid_points;

static inline mps__grid_points mps__grid_points_of(const mps__grid_level *l)
{
    return (mps__grid_points){l->home, l->about, l->side, l->weight, l->x};
}

/* Interpolated value of a point. */
MPS_ROW double mps__grid_value(const int dim, const mps__grid_points *p, int64_t point)
{
    const int corners = 1 << dim;
    const int32_t *about = p->about + (int64_t)p->home[point] * (dim == 2 ? 9 : MPS__GRID_ABOUT);
    const uint8_t *corner = mps__grid_corner[p->side[point]];
    const float *weight = p->weight + point * corners;
    double s = 0;
    for (int k = 0; k < corners; k++) s += (double)weight[k] * p->x[about[corner[k]]];
    return s;
}

#endif
