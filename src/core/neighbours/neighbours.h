/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of particles. Cells are sorted keys, not a grid array, so that the cost does not depend on
 * the size of the domain. */
#ifndef MPS_CORE_NEIGHBOURS_H
#define MPS_CORE_NEIGHBOURS_H

#include "parallel.h"
#include "occluders.h"
#include <mps/operators.h>

/* Parts of the particles; one thread makes the rows of a part. */
enum { MPS__PARTS = 64 };

/* Cell boundaries are multiples of the cell size: which particles share a cell depends on their
 * positions alone. */
typedef struct mps__cells {
    double first[3], size; /* index of cell 0 along each axis, counted from the origin */
    int bits;
} mps__cells;

/* CSR rows: near pairs in begin[i]..middle[i], other pairs in reach up to end[i], both with
 * ascending columns, so that sums do not depend on the search. Up to begin[i] + count[i] follow
 * candidates that may come within reach before the next search. */
struct mps_neighbours {
    mps__context *context;
    mps__context own;             /* context of a standalone list */
    const mps_parallel *parallel; /* NULL: the calling thread */
    mps__pool pool;               /* of a standalone list */
    int32_t dim;
    double dp, skin, re_near, re_far;
    int64_t n, capacity, pair_capacity, near_capacity, weight_capacity, scratch_capacity,
        far_capacity;
    const double *x;
    int64_t *begin;        /* [n], with the workspace of its scan */
    int64_t *middle, *end; /* [n]; one array if the radii are equal */
    int64_t *far_end;      /* [n] memory of `end` if the radii differ */
    int32_t *count;        /* [n] candidates of each row */
    int32_t *col;          /* [pairs] within re_far + skin at the last search; rows not in order */
    int64_t pairs;         /* entries of col at the last search */
    int64_t searches;      /* number of searches begun */
    /* [n+1] compact copy of the near rows, which most loops of a step use; with the workspace of
     * its scan */
    int64_t *near_begin;
    int32_t *near_col; /* [near_begin[n]] */
    double *w_r2;      /* [near_begin[n]] buffer for a weight of each entry of near_col */
    double *searched;  /* [n*dim] positions at the last search */
    /* [2 n] cell keys and workspace of the sort; valid from the ordering to the end of the search.
     * NULL: a device made the order */
    uint64_t *key;
    int32_t *order;                    /* [2 n] order, and workspace of its sort */
    mps__scratch own_scratch, *shared; /* memory of key and order: own, or shared with others */
    mps__cells cells;                  /* of the last ordering */
    bool valid;                        /* candidates belong to the present order */
    bool torn;                         /* col and the rows have been overwritten since */
    /* particles were just permuted along the keys: the next search needs no order */
    bool sorted;
    /* largest number of candidates of a row that exceeds the stack buffer, else 0 */
    int64_t longest;
    double *scratch; /* workspace for such rows, for each part of the particles */
    /* for the next search: NULL, or kinds of the particles; then solids without fluid in reach get
     * no pairs, */
    const int32_t *kind;
    bool dummy_rows;      /* and dummies get none unless this is set */
    bool partial;         /* the last search skipped such solids, */
    bool had_dummy_rows;  /* but not dummies */
    const uint8_t *ghost; /* NULL, or [n] 1: a ghost, which gets no row */
    /* unless this is set and it is fluid; rows at the edge of the ghost layer are incomplete */
    bool ghost_rows;
    uint8_t *idle;         /* [n] 1: a skipped solid */
    uint8_t *near_dummies; /* [n] 1: fluid with dummies nearby; 0 if there are no kinds */
    /* NULL, or the occluders; their near-plate particles are up to date */
    const mps__occluders *occluders;
};

mps_status mps__neighbours_init(mps_neighbours *l, mps__context *context, int32_t dim, double dp);
void mps__neighbours_free(mps_neighbours *l);
/* Free the arrays of the last search. The next search allocates new ones with the same estimate of
 * pairs. */
void mps__neighbours_release(mps_neighbours *l);

/* Whether no particle has moved by more than half the skin since the last search. Positions, and
 * `ghost`, the particles to skip (NULL: none), are in the memory space of the loops. */
bool mps__neighbours_fresh(const mps_neighbours *l, int64_t n, const double *x,
                           const double *searched, const uint8_t *ghost, double re_far);
/* Whether this holds for a known square of the largest displacement. */
bool mps__neighbours_within(const mps_neighbours *l, int64_t n, double re_far, double square);
/* Order of particles by cell, within a cell by id, [n] in l->order; for permuting the store before
 * a search. It depends on positions and ids alone. `id` NULL: within a cell by index. */
mps_status mps__neighbours_order(mps_neighbours *l, int64_t n, const double *x, const int64_t *id,
                                 double re_far);
/* Arrays of an ordering in the memory space of the loops. */
typedef struct mps__order_arrays {
    const double *x;
    const int64_t *id;
    uint64_t *key;  /* [2 n] workspace */
    int32_t *order; /* [2 n] order and workspace */
} mps__order_arrays;
/* The order of mps__neighbours_order() by loops on a device; the result is in on_device->order.
 * NULL: failed, mps__neighbours_order() reports the cause. */
const int32_t *mps__neighbours_order_device(mps_neighbours *l, int64_t n, double re_far,
                                            const mps__order_arrays *on_device);
/* To be called when the particles have been permuted into l->order. */
void mps__neighbours_sorted(mps_neighbours *l, int64_t n);
/* Search candidates; positions must be finite and are not copied. Rows are exact, but occluders are
 * not applied yet. Resets l->kind. */
mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near,
                                  double re_far);
/* The search in parts, for a device: allocation and parameters; the search itself; the end. */
mps_status mps__neighbours_begin(mps_neighbours *l, int64_t n, const double *x, double re_near,
                                 double re_far);
void mps__neighbours_end(mps_neighbours *l);
/* Arrays of a search in the memory space of the loops, for particles in cell order on one rank. */
typedef struct mps__search_arrays {
    const double *x;
    const int32_t *kind;
    uint64_t *key;  /* [n] keys */
    int64_t *begin; /* [n], with the workspace of its scan */
    int64_t *middle, *end;
    int32_t *count, *col;
    uint8_t *idle, *near_dummies;
} mps__search_arrays;
/* Count the candidates of each row, and allocate l->pairs entries. If l->longest > 0, a row is too
 * long for the functions below. `on_device` needs no `col`. */
mps_status mps__neighbours_count_device(mps_neighbours *l, const mps__search_arrays *on_device);
/* Store exact rows. */
void mps__neighbours_fill_device(mps_neighbours *l, const mps__search_arrays *on_device);
/* Keys of the cells of the last ordering. */
void mps__neighbours_keys(const mps_neighbours *l, const double *x, uint64_t *key);
/* Exact rows at other positions from the candidates; occluders are not applied. */
void mps__neighbours_rows(mps_neighbours *l, const double *x);
/* Arrays of a list, and positions, in the memory space of the loops. */
typedef struct mps__row_arrays {
    const double *x;
    const int64_t *begin;
    const int32_t *count;
    int64_t *middle, *end;
    int32_t *col;
    const mps__occluder *occluder; /* occluders, if any */
    const mps__near_plate *near_plate;
    const int32_t *slot;
} mps__row_arrays;
/* mps__neighbours_rows() with arrays in another memory space. Only if no row exceeds the stack
 * buffer. */
void mps__neighbours_rows_device(mps_neighbours *l, const double *x,
                                 const mps__row_arrays *on_device);
/* Remove occluded pairs from exact rows. */
void mps__neighbours_hide(mps_neighbours *l);
void mps__neighbours_hide_device(const mps_neighbours *l, const mps__row_arrays *on_device);
/* Set near_begin from the rows; the arrays are those of the list in the memory space of the
 * loops. */
void mps__neighbours_near(const mps_neighbours *l, const int64_t *begin, const int64_t *middle,
                          int64_t *near_begin);
/* Allocate the arrays of the near rows: near_begin[n] pairs. */
mps_status mps__neighbours_near_fit(mps_neighbours *l, int64_t pairs);
/* Bits of a cell index along one axis in a key. */
int mps__cell_bits(int32_t dim);
/* Stencil of one radius; the list is not empty. */
mps_status mps__neighbours_view(const mps_neighbours *l, int32_t which, const mps_kernel *kernel,
                                mps_stencil *view);
/* Sort cell keys and particle indices with them; both have capacity 2 n. neighbours_sort.c */
void mps__sort_keys(uint64_t *key, int32_t *order, int64_t n);

#endif
