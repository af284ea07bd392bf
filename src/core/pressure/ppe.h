/* SPDX-License-Identifier: BSD-3-Clause */
/* Assembly of the pressure equation from pairs and terms. */
#ifndef MPS_CORE_PPE_H
#define MPS_CORE_PPE_H

#include "sets.h"
#include "solvers.h"
#include <mps/stage.h>

/* Scalars of the equation: the channels "equation_...". */
typedef struct mps__equation {
    int32_t radius, complete_surface, body;
    double wall_factor, gain;
} mps__equation;

/* What models say of the equation: its scalars, the fluxes of its pairs, and its channels. */
typedef struct mps__ppe_terms {
    mps__equation equation;
    const mps_flux *flux;
    const int32_t *region;
    const double *density, *pressure; /* [n] those before the solution */
    double *source, *shift, *value, *gas, *law;
    int32_t *condition;
    bool linear; /* no row has the law of a gas */
} mps__ppe_terms;

/* Blocks of scratch; levels.c and ppe_ranks.c take two of them, a device alone has the last three. */
enum {
    MPS__PPE_VALUES,
    MPS__PPE_COLUMNS,
    MPS__PPE_ROWS,
    MPS__PPE_LAWS,
    MPS__PPE_LABELS,
    MPS__PPE_NUMBERS,
    MPS__PPE_MOMENTS,
    MPS__PPE_BOUNDS,
    MPS__PPE_COUNTS,
    MPS__PPE_BLOCKS
};

/* What a device has counted of an equation. */
typedef struct mps__ppe_counts {
    int64_t unknowns, entries;
    double bounded,
        lacking; /* above -INFINITY: a row has a least pressure, a component lacks a level */
} mps__ppe_counts;

/* The equation is assembled where the loops over it run. On a device all of its arrays are there, until it comes to the host. */
typedef struct mps__ppe {
    mps__context *context;
    mps__device *device; /* that has the arrays; NULL: they are on the host */
    mps__device_block there[MPS__PPE_BLOCKS];
    /* after mps__ppe_come(): the device, rows of the particles and pressures there */
    mps__device *left;
    int32_t *unknown_there;
    double *p_there;
    const mps_parallel *parallel; /* of the loops that made them */
    mps__scratch own,
        *scratch; /* where all arrays are: its own, or one shared with others. They last until these take it again */
    double *spare,
        *spare_x; /* NULL, or room [3 particles], [particles*dim] for what mps__ppe_note() writes */
    mps__ghosts *ghosts; /* NULL: alone */
    /* on many ranks: who owns places of the lab */
    mps_status (*owner)(void *world, int64_t m, const double *x, int32_t *rank);
    void *world;     /* its first argument */
    int64_t n;       /* unknowns of the last assembly */
    int64_t columns; /* and those of other ranks that they look at, behind them */
    int64_t entries; /* of the matrix */
    int64_t particles;
    /* on a device: what it has counted, and whether a row has a least pressure */
    mps__ppe_counts *counts_there;
    bool bounded;
    int32_t *unknown;  /* [particles] row of a particle, or column of a ghost; -1: none */
    int32_t *particle; /* [columns] particle of a row or a column */
    int64_t *row;      /* [n+1] CSR beside the diagonal */
    int32_t *col;
    float *val;
    double *diagonal, *rhs, *shift, *weight;
    double *x;         /* [columns*dim] places less `moved`: solvers do not see a uniform motion */
    double moved[3];   /* displacement of the tank at the beginning of the step */
    double *p;         /* [columns] */
    double *gas, *law; /* NULL: all rows are linear */
    /* [n*dim], room that mps__ppe_fill() is given for S_i = sum_j k_ij rho_ij r_ij of each row; NULL: it is not wanted. Where the equation has
     * the body term, an acceleration a of the tank adds a.S_i to the right side, and an angular acceleration o about a point c adds
     * o.((x_i - c) x S_i), as (m x r_ij) of the middle m of a pair is (x_i x r_ij). */
    double *moments;
    bool lacking;       /* a component here or on another rank has no level */
    int32_t *component; /* scratch unless there is one without a level: problem.component */
    bool level_free;    /* the largest component has no level */
    int32_t *queue;     /* [n] scratch */
    int32_t *order;     /* on many ranks [columns] in the order of the particles */
    mps_ppe_problem problem;
    mps_ppe_ranks ranks; /* its entry `ranks` */
    mps__sets sets;      /* components of the matrix */
} mps__ppe;

/* Unknowns of all ranks. */
static inline int64_t mps__ppe_rows(const mps__ppe *e)
{
    return e->ranks.ranks > 1 ? e->ranks.rows : e->n;
}

void mps__ppe_init(mps__ppe *e, mps__context *context);
void mps__ppe_free(mps__ppe *e);
/* Build a row for every unknown. MPS_E_NOMEM, MPS_E_PLUGIN: of a device */
mps_status mps__ppe_fill(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t);
/* Then what an unknown is beside its row, with the old pressures as the first guess. On the host e->spare and e->spare_x take it. Where a
 * component lacks a level, an equation on a device has to come to the host for mps__ppe_close(): a solver there looks for it before it begins
 * (mps__pcg_hint), others have to wait (levels.h). */
mps_status mps__ppe_note(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t);
/* Make an equation that lacks a level solvable; on the host. */
mps_status mps__ppe_close(mps__ppe *e, const mps_view *s);
/* What mps__ppe_note() says of ranks; order of the columns, on the host. ppe_ranks.c */
mps_status mps__ppe_ranks_set(mps__ppe *e);
void mps__ppe_ranks_order(mps__ppe *e);
/* Pressures of all particles from the solution e->p. */
void mps__ppe_scatter(const mps__ppe *e, const mps_view *s, const mps__ppe_terms *t, double *p);

/* ---- an equation on a device (ppe_device.c) ---- */

/* All arrays are on the host from now on, */
mps_status mps__ppe_come(mps__ppe *e);
/* and the pressures on the device again. */
mps_status mps__ppe_go(mps__ppe *e);
/* Give back what is there; before the device is detached. */
void mps__ppe_leave(mps__ppe *e, mps__device *d);

/* ---- for the two files ---- */

/* Room for the rows, e->n and e->columns being known, for entries of the matrix, and for laws. */
mps_status mps__ppe_reserve_rows(mps__ppe *e, int32_t dim);
mps_status mps__ppe_reserve_entries(mps__ppe *e);
mps_status mps__ppe_reserve_laws(mps__ppe *e);
/* The problem sees the arrays of the equation. */
void mps__ppe_point(mps_ppe_problem *problem, const mps__ppe *e);

#endif
