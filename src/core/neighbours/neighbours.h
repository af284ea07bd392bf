/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of particles. Cells hold sorted keys, not a grid array, so that the size of the domain costs nothing. */
#ifndef MPS_CORE_NEIGHBOURS_H
#define MPS_CORE_NEIGHBOURS_H

#include "parallel.h"
#include "screens.h"
#include <mps/operators.h>

/* Parts of the particles whose rows are made by one thread each. */
enum { MPS__PARTS = 64 };

/* Corners of cells are multiples of their size: which particles share a cell depends on nothing but their positions. */
typedef struct mps__cells {
    double first[3], size; /* number of cell 0 along each axis, counted from the origin */
    int bits;
} mps__cells;

/* Rows: near pairs in begin[i]..middle[i], the others up to end[i]; ascending columns in each part, so that sums
 * do not depend on how the list was found. Up to begin[i] + count[i] follow those that may come within reach before the next search. */
struct mps_neighbours {
    mps__context *context;
    mps__context own;             /* context of a list that stands alone */
    const mps_parallel *parallel; /* NULL: the calling thread */
    mps__pool pool;               /* of a list that stands alone */
    int32_t dim;
    double dp, skin, re_near, re_far;
    int64_t n, capacity, pair_capacity, near_capacity, weight_capacity, scratch_capacity,
        far_capacity;
    const double *x;
    int64_t *begin;        /* [n], and room of its scan */
    int64_t *middle, *end; /* [n]; the same where the radii are */
    int64_t *far_end;      /* [n] where they are not */
    int32_t *count;        /* [n] candidates of each row */
    int32_t *col;          /* [pairs] within re_far + skin at the last search; rows in any order */
    int64_t pairs;         /* entries of it at the last search */
    int64_t searches;      /* so many were begun */
    /* [n+1] near rows once more, without gaps: what most loops of a step run along; room of its scan */
    int64_t *near_begin;
    int32_t *near_col; /* [near_begin[n]] */
    double *w_r2;      /* [near_begin[n]] room for a weight beside each entry of near_col */
    double *searched;  /* [n*dim] positions at the last search */
    /* [2 n] cell keys and scratch of the sort; from the order to the end of the search. NULL: a device has made the order */
    uint64_t *key;
    int32_t *order;                    /* [2 n] likewise */
    mps__scratch own_scratch, *shared; /* where these two are: its own, or one shared with others */
    mps__cells cells;                  /* of the last order */
    bool valid;                        /* candidates belong to the present order, */
    bool torn;                         /* but what col and the rows hold is not them any more */
    bool sorted;     /* the store was just sorted along the keys: the next search needs no order */
    int64_t longest; /* candidates of one row that is too long for the stack, at most; else 0 */
    double *scratch; /* room to work on such rows, for each part of the particles */
    /* of the next search: NULL, or kinds of the particles; then solids without fluid about them
     * get no pairs, */
    const int32_t *kind;
    bool dummy_rows;      /* nor do dummies, unless this is set */
    bool partial;         /* the last search left such solids out: */
    bool had_dummy_rows;  /* but not dummies */
    const uint8_t *ghost; /* NULL, or [n] 1: a copy of another rank's particle, which gets no row */
    bool ghost_rows;      /* but fluid does; not complete where ghosts end */
    uint8_t *idle;        /* [n] 1 for each of them */
    uint8_t *rim;         /* [n] 1: fluid with dummies not far away; 0 where kinds were not given */
    /* NULL, or what hides particles from each other; its seers are up to date */
    const mps__screens *screens;
};

mps_status mps__neighbours_init(mps_neighbours *l, mps__context *context, int32_t dim, double dp);
void mps__neighbours_free(mps_neighbours *l);
/* Free the arrays of the last search. The next search makes new ones; it still knows how many pairs to expect. */
void mps__neighbours_release(mps_neighbours *l);

/* True if no particle moved by more than half the skin since the last search; places now and then are where loops run, and `ghost`, those that do
 * not count, NULL: none. */
bool mps__neighbours_fresh(const mps_neighbours *l, int64_t n, const double *x,
                           const double *searched, const uint8_t *ghost, double re_far);
/* The same where the square of the longest way is known. */
bool mps__neighbours_within(const mps_neighbours *l, int64_t n, double re_far, double square);
/* Order of particles by cell, within a cell by id, [n] in l->order; for sorting the store before a search. It depends on positions and ids alone.
 * `id` NULL: within a cell by place. */
mps_status mps__neighbours_order(mps_neighbours *l, int64_t n, const double *x, const int64_t *id,
                                 double re_far);
/* Arrays of an order where loops run. */
typedef struct mps__order_arrays {
    const double *x;
    const int64_t *id;
    uint64_t *key;  /* [2 n] room */
    int32_t *order; /* [2 n] likewise */
} mps__order_arrays;
/* The same order by loops of a device: where it is in there->order. NULL: it is for mps__neighbours_order() to say what is wrong. */
const int32_t *mps__neighbours_order_there(mps_neighbours *l, int64_t n, double re_far,
                                           const mps__order_arrays *there);
/* The particles were put into l->order. */
void mps__neighbours_sorted(mps_neighbours *l, int64_t n);
/* Search candidates; positions must be finite and are borrowed. Rows are exact, but screens hide nothing yet. l->kind is forgotten. */
mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near,
                                  double re_far);
/* The same in parts, for what is done on a device: room and what the list is about, the search itself, the end. */
mps_status mps__neighbours_begin(mps_neighbours *l, int64_t n, const double *x, double re_near,
                                 double re_far);
void mps__neighbours_end(mps_neighbours *l);
/* Arrays of a search where loops run, of particles in the order of their cells, on one rank. */
typedef struct mps__search_arrays {
    const double *x;
    const int32_t *kind;
    uint64_t *key;  /* [n] room for keys */
    int64_t *begin; /* [n], and room of its scan */
    int64_t *middle, *end;
    int32_t *count, *col;
    uint8_t *idle, *rim;
} mps__search_arrays;
/* Count the candidates of each row, and make room for l->pairs of them. With l->longest above 0 some row is too long for what follows.
 * `there` needs no `col`. */
mps_status mps__neighbours_count_there(mps_neighbours *l, const mps__search_arrays *there);
/* Exact rows. */
void mps__neighbours_fill_there(mps_neighbours *l, const mps__search_arrays *there);
/* Keys of the cells of the last order. */
void mps__neighbours_keys(const mps_neighbours *l, const double *x, uint64_t *key);
/* Exact rows at other positions from the candidates, without what screens hide. */
void mps__neighbours_rows(mps_neighbours *l, const double *x);
/* Arrays of a list, and positions, where loops run. */
typedef struct mps__row_arrays {
    const double *x;
    const int64_t *begin;
    const int32_t *count;
    int64_t *middle, *end;
    int32_t *col;
    const mps__screen *screen; /* of the screens, if there are any */
    const mps__seer *seer;
    const int32_t *slot;
} mps__row_arrays;
/* The same with arrays that are elsewhere. Only where no row is too long for the stack. */
void mps__neighbours_rows_there(mps_neighbours *l, const double *x, const mps__row_arrays *there);
/* Take what screens hide out of rows that are exact. */
void mps__neighbours_hide(mps_neighbours *l);
void mps__neighbours_hide_there(const mps_neighbours *l, const mps__row_arrays *there);
/* Set near_begin from the rows; the arrays are those of the list where loops run. */
void mps__neighbours_near(const mps_neighbours *l, const int64_t *begin, const int64_t *middle,
                          int64_t *near_begin);
/* Room for what stands in the near rows: near_begin[n] pairs. */
mps_status mps__neighbours_near_fit(mps_neighbours *l, int64_t pairs);
/* Bits of a cell number along one axis in a key. */
int mps__cell_bits(int32_t dim);
/* Pairs of one radius; the list is not empty. */
mps_status mps__neighbours_view(const mps_neighbours *l, int32_t which, const mps_kernel *kernel,
                                mps_stencil *view);
/* Sort cell keys and the particles' numbers with them; both have room for 2 n. neighbours_sort.c */
void mps__sort_keys(uint64_t *key, int32_t *order, int64_t n);

#endif
