/* SPDX-License-Identifier: BSD-3-Clause */
/* The hierarchy of background grids behind the preconditioner auxgrid. A grid is a list of the cells that hold something, so
 * its size follows the particles and never their bounding box. */
#ifndef MPS_PPE_AUXGRID_H
#define MPS_PPE_AUXGRID_H

#include "device.h"
#include "loop.h"
#include "builtin.h"
#include <stdbool.h>

enum {
    MPS__GRID_BITS =
        21, /* of a cell's coordinate; what lies further out is put into the last cell */
    MPS__GRID_LEVELS = 22,  /* after 19 halvings four cells are left along each axis */
    MPS__GRID_DIRECT = 150, /* fewer cells are solved directly */
    MPS__GRID_ABOUT = 27,   /* a cell and those about it, in 3-D */
    MPS__GRID_TURNS = 256,  /* cells whose particles are worth a second thread */
    MPS__GRID_WHOLE =
        65536 /* many ranks: cells of a grid from which on each rank works on its own cells only */
};

/* Room that grows and is kept; its contents are not. */
typedef struct mps__grid_room {
    void *at;
    int64_t bytes;
} mps__grid_room;

/* Cells of the finer grid that add to each cell, on a device: those of cell c end before end[c], where those of c + 1 begin. */
typedef struct mps__grid_adding {
    int64_t *end;  /* [cells], and room to sum them up */
    int32_t *from; /* ascending for each */
    float *part;   /* of what is left of their right side */
} mps__grid_adding;

/* One grid, and how the points above it (particles, or the cells of the finer grid) reach its cells.
 *
 * Order of the cells: first the `red` ones, whose coordinates have an even sum, then the black ones (a cell's neighbours have
 * the other colour), both by key. A sum over cells, and the direct solution of the last grid, then depends on the set of
 * cells alone, and not on which particle was met first. A sum over particles runs in the order of the particles.
 *
 * The cells about a cell are numbered by one digit of base three for each axis: 0 the same coordinate, 1 one less, 2 one more. */
typedef struct mps__grid_level {
    int64_t points, cells, red;
    mps__grid_room point_room, cell_room, adding_room;
    int32_t *home; /* [points] cell that holds the point, -1: none */
    uint8_t *
        side; /* [points] bit a: which side of its cell the point is nearer to along axis a, 0 below, 1 above */
    float *
        share; /* [points << dim] how much a point takes from the cells on that side; 0 or a sum of 1 */
    int32_t *list; /* [points] the points by cell, in their order in each */
    int32_t *
        start; /* [cells + 1] the first in `list` of each cell; of the first grid on a host, of each turn */
    int64_t *key;   /* [cells] packed coordinates */
    int32_t *about; /* [cells * 3^dim] the cells about each, `cells` where there is none */
    int32_t *
        next; /* [cells * 2 dim] neighbours below and above along each axis, itself where there is none */
    float *link;     /* [cells * 2 dim] conductances to them, equal from both sides */
    double *shift;   /* [cells] the rest of the diagonal */
    double *inverse; /* [cells] of the diagonal, 0 for a cell with nothing */
    double *kappa;   /* [cells] mean conductivity of its points */
    double *count;   /* [cells] particles */
    double *b,
        *x; /* [cells + 1] right side and solution of the cycle in progress; the last x, for no cell, is 0 */
    mps__grid_adding adding; /* on a device, but of the first grid */
    double *rest;            /* [red] residuals, on a device, but of the last grid */
} mps__grid_level;

enum { MPS__GRID_DIVIDED_ROOMS = 5 };
enum {
    MPS__GRID_VALUES,
    MPS__GRID_ENTRIES,
    MPS__GRID_PLACES,
    MPS__GRID_SEND_THERE,
    MPS__GRID_RECEIVE_THERE,
    MPS__GRID_OWNED_THERE,
    MPS__GRID_OWNERS_THERE,
    MPS__GRID_TURNS_THERE,
    MPS__GRID_PACKET,
    MPS__GRID_HERE, /* from here on memory of the host, whatever the grid has */
    MPS__GRID_COUNTS = MPS__GRID_HERE,
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
    MPS__GRID_ROOMS
};

/* Values of cells that a rank sends to others, and cells whose values it gets, in the order of the route. */
typedef struct mps__grid_plan {
    mps__grid_room room[4];
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

/* A grid that is divided among the ranks: each works on its own cells. */
typedef struct mps__grid_divided {
    mps__grid_room room[MPS__GRID_DIVIDED_ROOMS];
    int32_t *owner; /* [cells] */
    mps__grid_owned owned;
    int64_t own, own_red; /* own cells, which begin with the red ones */
    int32_t *cell;        /* [own] */
    double *rest;         /* [cells] residuals of red cells */
    int64_t adding;
    int32_t *add; /* [adding] red cells that own cells of the coarser grid take residuals from */
    mps__grid_plan ring; /* x of cells that own cells, or points of this rank, look at */
    mps__grid_plan left; /* rest */
} mps__grid_divided;

/* Lists of a rank that has a device, in its memory. */
typedef struct mps__grid_there {
    int64_t *send, *receive; /* parts */
    int64_t *owned;          /* [cells] of the first grid, as mps__grid_owned has them */
    int32_t *owner;          /* [cells] of it */
    double *packet;          /* values on their way to the host or from there */
} mps__grid_there;

/* Many ranks: each cell of the first grid is owned by the rank that owns its centre, one of a coarser grid by the owner of its first cell.
 * The owner sums the particles of the cell, which it all has, and what they add to the cells about it goes to the owners of these. All
 * ranks have the cells and coefficients of all grids. Of large grids each solves its own cells; the right side of the first small one is
 * collected on all ranks, which do the same with it and all coarser ones. Devices do not divide grids: each solves all of their cells. */
typedef struct mps__grid_ranks {
    mps_ppe_ranks table; /* its `ranks` are 0: alone */
    mps__grid_room room[MPS__GRID_ROOMS];
    int64_t n;             /* rows of this rank */
    int64_t columns;       /* and those of other ranks: points of the first grid */
    double *value;         /* [columns] */
    double *entries;       /* [columns] of the rows */
    int32_t *place;        /* [columns] of a column in the order of the particles */
    int64_t *bytes;        /* [ranks] of a message */
    int64_t *count;        /* [ranks] scratch */
    mps__grid_owned owned; /* cells of the first grid */
    int32_t *owner;        /* [cells] of it */
    const int64_t *key;    /* [cells] of it, on the host */
    const int32_t *about;  /* [cells * 3^dim] the same */
    mps__grid_there there;
    double *out, *in;
    int64_t *send,
        *receive; /* parts that go to other ranks and come from them, in the order of the route */
    mps_route route;
    bool connected;
    int64_t whole; /* cells of a grid from which on it is divided */
    int divided;   /* levels that are divided, from the first on */
    mps__grid_divided level[MPS__GRID_LEVELS];
} mps__grid_ranks;

/* Points of a grid in the order of their cells, on a device. Each array has two halves, of which one is sorted into the other. */
typedef struct mps__grid_sorted {
    uint64_t *key; /* UINT64_MAX: none */
    int32_t *order;
    int64_t *number;         /* [points] cells that have begun up to a place */
    const uint64_t *key_now; /* the half that is in order */
    const int32_t *order_now;
} mps__grid_sorted;

/* What a device tells of a set-up, in one copy; loops gather it there. */
typedef struct mps__grid_told {
    struct {
        mps_exact sums[2];
        double maxima[5];
    } look;        /* at the rows */
    double square; /* mean of r_ij^2 */
    struct {
        mps_exact sums[3];
        double largest;
    } measure;       /* of conductivities */
    double cells[2]; /* of the grid that was sorted last: cells, red ones */
} mps__grid_told;

typedef struct mps__grid {
    mps_allocator allocator, host; /* of the arrays; of what ranks keep on the host */
    const mps_parallel *parallel;
    mps__device *device; /* whose memory the arrays are in, and where loops run; NULL: here */
    int dim;
    bool one; /* one density everywhere */
    double corner[3], size,
        per_size; /* corner [cells], edge and 1 / edge of the first grid's cells [m] */
    double unit;  /* matrix entries times this are of order one */
    bool laid;    /* corner and size are there */
    int levels;
    mps__grid_level level[MPS__GRID_LEVELS];
    int64_t table_size, table_capacity; /* a power of two */
    int64_t *table_key;  /* [table_size] hash table from coordinates to cells, -1: free */
    int32_t *table_cell; /* [table_size] */
    int64_t point_capacity;
    int64_t *point_key;  /* [points] coordinates of the cell that holds a point, -1: none */
    double *point_kappa; /* [points]; free when all grids are there */
    mps__grid_room turn_room;
    int32_t *
        turn; /* [cells] cells of the first grid as particles meet them; NULL: each turn is that cell */
    int64_t order_capacity;
    int32_t *order;           /* [2 * cells] to sort the cells */
    mps__grid_room sort_room; /* to sort points, on a device */
    mps__grid_sorted sorted;
    size_t part_capacity; /* bytes */
    void *
        parts; /* what the particles of each cell add to the cells about it, or the faces of two densities */
    double *factor;       /* [direct * direct] L of the last grid's L D L' */
    double *pivot;        /* [direct] 1/D, 0 where D is */
    double *bad;          /* [levels] whether a diagonal is not finite, on a device */
    mps__grid_told *told; /* on a device */
    int64_t
        turns; /* cells of the first grid that particles are summed for: all, or those of this rank */
    mps__grid_ranks ranks;
} mps__grid;

static inline bool mps__grid_many(const mps__grid *g)
{
    return g->ranks.table.ranks > 1;
}

/* A cell and those about it. */
MPS_ROW int mps__grid_all(const int dim)
{
    return dim == 2 ? 9 : MPS__GRID_ABOUT;
}

/* ---- memory (auxgrid_memory.c): it grows and is kept; false or NULL: there is none ---- */

void mps__grid_release(mps__grid *g);
/* Room to find the cells of so many points. */
bool mps__grid_reserve(mps__grid *g, int64_t points);
/* Room for the points and the cells of a level, whose numbers are known. */
bool mps__grid_reserve_points(mps__grid *g, mps__grid_level *l);
bool mps__grid_reserve_cells(mps__grid *g, mps__grid_level *l);
/* Room for the residuals of a grid and the lists of the coarser one. */
bool mps__grid_reserve_adding(mps__grid *g, mps__grid_level *fine, mps__grid_level *l);
/* Room to sort points. */
bool mps__grid_reserve_sorted(mps__grid *g, int64_t points);
bool mps__grid_reserve_table(mps__grid *g, int64_t size);
bool mps__grid_reserve_order(mps__grid *g, int64_t cells);
/* Room for so many bytes in `parts`. */
bool mps__grid_reserve_parts(mps__grid *g, size_t bytes);
/* Slots for so many cells. */
int64_t mps__grid_table_for(int64_t cells);
/* Room that is kept, and the same on the host. */
void *mps__grid_room_of(mps__grid *g, mps__grid_room *room, int64_t count, size_t size);
void *mps__grid_room_here(mps__grid *g, mps__grid_room *room, int64_t count, size_t size);

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

/* Keys of the cells from point_key, where the keys then are, each once. Returns their number, -1 when out of memory. */
int64_t mps__grid_find(mps__grid *g, mps__grid_level *l, int64_t points);
/* Cells and neighbours of a level from point_key; links are zero. False when out of memory. */
bool mps__grid_cells(mps__grid *g, mps__grid_level *l, int64_t points);
/* The second half of it: the cells have been found and counted. */
bool mps__grid_make_cells(mps__grid *g, mps__grid_level *l);
/* On a host: the points of each cell of a coarser grid. A device has them from the order of the points. */
void mps__grid_list_cells(const mps__grid *g, mps__grid_level *l);

/* ---- cells on a device (auxgrid_sort.c) ---- */

/* Points in the order of their cells, which are counted into `told` of the device, */
void mps__grid_sort(mps__grid *g, const mps__grid_level *l);
/* and from there into the level. A maximum is -INFINITY where no row has one. */
void mps__grid_count(const mps__grid *g, mps__grid_level *l);
static inline void mps__grid_counted(mps__grid_level *l, const double cells[2])
{
    l->cells = cells[0] > 0 ? (int64_t)cells[0] : 0;
    l->red = cells[1] > 0 ? (int64_t)cells[1] : 0;
}
/* Then homes, keys, lists of points, neighbours. */
void mps__grid_number(mps__grid *g, mps__grid_level *l);
/* As mps__grid_find(), for points whose keys are on the device. */
int64_t mps__grid_find_there(mps__grid *g, mps__grid_level *l, int64_t points);
/* Homes of the points of a level among its cells, from the keys of both. */
void mps__grid_home(mps__grid *g, mps__grid_level *l);
/* Points of the own cells of a rank by cell, as mps__grid_list() has them on the host. */
void mps__grid_list_own(mps__grid *g, mps__grid_level *l);

/* ---- coefficients of the first grid (auxgrid_links.c) ---- */

/* What the rows have in common. */
typedef struct mps__grid_common {
    double square;   /* mean of r_ij^2 */
    double least[3]; /* [dim] the largest of -x */
} mps__grid_common;

/* On a device, all of this section up to the cells of the first grid, which are sorted and counted. Returns 0 or a reason of failure. */
int mps__grid_ask(mps__grid *g, const mps_ppe_problem *problem);
/* Look at all rows. Returns 0, or why they are refused, the same on all ranks: too many unknowns on one, or a diagonal entry. */
int mps__grid_look(const mps_ppe_problem *problem, mps__grid_common *common);
/* Conductivity of each row, from which the cell size follows. */
void mps__grid_measure(mps__grid *g, const mps_ppe_problem *problem, double square);
/* Corner of the first grid. */
void mps__grid_lay(mps__grid *g, const mps_ppe_problem *problem, const double *least);
/* Coordinates of the cells of the first particles into point_key. */
void mps__grid_place(mps__grid *g, const mps_ppe_problem *problem, int64_t points);
/* Coefficients of the first grid and the shares of the particles. Returns 0 or a reason of failure. */
int mps__grid_from_matrix(mps__grid *g, const mps_ppe_problem *problem);

/* Where particles are among the cells of the first grid. */
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

/* Links of the first grid from the pairs of particles, for more than one density (auxgrid_wires.c). Returns 0 or a reason of failure. */
int mps__grid_wires(mps__grid *g, const mps_ppe_problem *problem);

/* ---- coarser grids (auxgrid_coarse.c) ---- */

/* All of them. False when out of memory. */
bool mps__grid_coarsen(mps__grid *g);
/* On a device: right side of level k from the residuals of the finer one. */
void mps__grid_gather(const mps__grid *g, int k);

/* ---- transfer (auxgrid_transfer.c) ---- */

/* Cells on the side that a point is nearer to, as numbers about its cell: [side][corner]. */
extern const uint8_t mps__grid_corner[8][8];
/* Number of a cell about its neighbour: each step the other way. */
extern const uint8_t mps__grid_opposite[MPS__GRID_ABOUT];

/* Particles by cell of the first grid. False when out of memory. */
bool mps__grid_list(mps__grid *g);
/* Shares and sides of the particles, whose shifts take the place of their conductivities in point_kappa. */
void mps__grid_share_particles(mps__grid *g, const mps_ppe_problem *problem);
/* The same of the cells of the finer grid. */
void mps__grid_share_cells(const mps__grid *g, const mps__grid_level *fine, mps__grid_level *l);
/* Sum the values [n] of the particles into the right side of the first grid. Returns 0 or a reason of failure. */
int mps__grid_restrict(mps__grid *g, const double *values, double scale);

/* ---- many ranks (auxgrid_ranks.c); all return 0 or a reason of failure ---- */

/* Parts that go to other ranks, and that come from them. */
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

/* Begin with an equation, on one rank or many. */
int mps__grid_ranks_begin(mps__grid *g, const mps_ppe_problem *problem);
void mps__grid_ranks_release(mps__grid *g);
/* Room that is kept: MPS__GRID_VALUES .. of the grid, from MPS__GRID_HERE on of the host. */
void *mps__grid_ranks_room(mps__grid *g, int which, int64_t count, size_t size);
/* Cells of the first grid and their owners, after mps__grid_lay(). Conductivities and numbers of entries of all columns. */
int mps__grid_ranks_cells(mps__grid *g, const mps_ppe_problem *problem);
/* Values [n] of the rows into `value`, and those of the other columns. */
int mps__grid_ranks_share(mps__grid *g, const double *values);
/* What particles of one rank add to cells of another, into `parts`. */
int mps__grid_ranks_exchange(mps__grid *g);
/* Values of cells: those of each rank's own cells to all ranks. They stand in MPS__GRID_IN in the order of `owned`, all of a cell together. */
int mps__grid_ranks_collect(mps__grid *g, const mps__grid_owned *owned, int arrays,
                            double *const *array);

/* ---- many ranks with a device each (auxgrid_ranks_there.c) ---- */

/* Cells of the first grid from the keys of all ranks, as mps__grid_cells() makes them, and homes of all columns. Keys and neighbours of the
 * cells are copied to the host, which finds the owners. Returns 0 or a reason of failure. */
int mps__grid_cells_there(mps__grid *g, const mps_ppe_problem *problem, const int64_t *key,
                          int64_t keys);
/* Copy owners and lists to the device. Returns 0 or a reason of failure. */
int mps__grid_owners_go(mps__grid *g);
/* Copy values at places of several arrays to the host, all of a place together, and back. place: [count] on the device */
void mps__grid_come(mps__grid *g, const int64_t *place, int64_t count, int arrays,
                    double *const *array, double *values);
void mps__grid_go(mps__grid *g, const int64_t *place, int64_t count, int arrays,
                  double *const *array, const double *values);

/* ---- divided grids (auxgrid_divided.c) ---- */

/* After all grids are there. */
int mps__grid_divide(mps__grid *g);
/* Free the routes; no grid is divided. */
void mps__grid_undivide(mps__grid *g);
void mps__grid_divided_release(mps__grid *g);
/* Values of the cells of a plan from their owners. */
int mps__grid_plan_share(mps__grid *g, mps__grid_plan *p, double *values);

/* ---- the last grid (auxgrid_last.c) ---- */

/* Factors of its matrix. */
void mps__grid_factorise_last(mps__grid *g);
/* Its x from its b. */
void mps__grid_solve_last(const mps__grid *g);

/* ---- cycle (auxgrid_cycle.c) ---- */

/* Inverse diagonals and the factors of the last grid. False: a coefficient is not finite. */
bool mps__grid_factorise(mps__grid *g);
/* One V-cycle from b to x of the first grid. Returns 0 or a reason of failure. */
int mps__grid_cycle(mps__grid *g);

/* How points take values from the cells of a level. */
typedef struct mps__grid_points {
    const int32_t *home, *about;
    const uint8_t *side;
    const float *share;
    const double *x;
} mps__grid_points;

static inline mps__grid_points mps__grid_points_of(const mps__grid_level *l)
{
    return (mps__grid_points){l->home, l->about, l->side, l->share, l->x};
}

/* Value of a point from the cells around it. */
MPS_ROW double mps__grid_value(const int dim, const mps__grid_points *p, int64_t point)
{
    const int corners = 1 << dim;
    const int32_t *about = p->about + (int64_t)p->home[point] * (dim == 2 ? 9 : MPS__GRID_ABOUT);
    const uint8_t *corner = mps__grid_corner[p->side[point]];
    const float *share = p->share + point * corners;
    double s = 0;
    for (int k = 0; k < corners; k++) s += (double)share[k] * p->x[about[corner[k]]];
    return s;
}

#endif
