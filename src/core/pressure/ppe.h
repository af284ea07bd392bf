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

/* Terms of the equation set by models: its scalars, the fluxes of its pairs, and its channels. */
typedef struct mps__ppe_terms {
    mps__equation equation;
    const mps_flux *flux;
    const int32_t *region;
    const double *density, *pressure; /* [n] before the solution */
    double *source, *shift, *value, *gas, *law;
    int32_t *condition;
    bool linear; /* no row has a gas law */
} mps__ppe_terms;

/* Workspace blocks; levels.c and ppe_ranks.c use two of them, the last three are for a device
 * only. */
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

/* Counts of an equation, in device memory. */
typedef struct mps__ppe_counts {
    int64_t unknowns, entries;
    /* above -INFINITY: a row has a lower bound; a component lacks a pressure datum */
    double bounded, lacking;
} mps__ppe_counts;

/* The equation is assembled in the memory space of the loops. On a device all of its arrays are
 * there, until mps__ppe_to_host() copies it to the host. */
typedef struct mps__ppe {
    mps__context *context;
    mps__device *device; /* that has the arrays; NULL: the host */
    mps__device_block on_device[MPS__PPE_BLOCKS];
    /* after mps__ppe_to_host(): the device, with its rows of the particles and pressures */
    mps__device *left;
    int32_t *unknown_device;
    double *p_device;
    const mps_parallel *parallel; /* of the assembly loops */
    /* memory of all arrays: own, or shared with others; valid until its next use */
    mps__scratch own, *scratch;
    /* NULL, or buffers [3 particles], [particles*dim] for the results of mps__ppe_note() */
    double *spare, *spare_x;
    mps__ghosts *ghosts; /* NULL: single rank */
    /* on many ranks: owners of positions in the lab */
    mps_status (*owner)(void *world, int64_t m, const double *x, int32_t *rank);
    void *world;     /* its first argument */
    int64_t n;       /* unknowns of the last assembly */
    int64_t columns; /* unknowns, then those of other ranks in their rows */
    int64_t entries; /* of the matrix */
    int64_t particles;
    /* on a device: its counts, and whether a row has a lower bound */
    mps__ppe_counts *counts_device;
    bool bounded;
    int32_t *unknown;  /* [particles] row of a particle, or column of a ghost; -1: none */
    int32_t *particle; /* [columns] particle of a row or a column */
    int64_t *row;      /* [n+1] CSR without the diagonal */
    int32_t *col;
    float *val;
    double *diagonal, *rhs, *shift, *weight;
    /* [columns*dim] positions minus `moved`: solvers are independent of a uniform motion */
    double *x;
    double moved[3];   /* displacement of the tank at the beginning of the step */
    double *p;         /* [columns] */
    double *gas, *law; /* NULL: all rows are linear */
    /* [n*dim] buffer in which mps__ppe_fill() stores S_i = sum_j k_ij rho_ij r_ij of each row;
     * NULL: not requested. If the equation has the body term, an acceleration a of the tank adds
     * a.S_i to the right side, and an angular acceleration o about a point c adds o.((x_i - c) x
     * S_i), as m x r_ij = x_i x r_ij for the midpoint m of a pair. */
    double *moments;
    bool lacking;       /* a component of any rank has no pressure datum */
    int32_t *component; /* workspace unless a component lacks a datum: then problem.component */
    bool level_free;    /* the largest component has no datum */
    int32_t *queue;     /* [n] workspace */
    int32_t *order;     /* on many ranks [columns] in the order of the particles */
    mps_ppe_problem problem;
    mps_ppe_ranks ranks; /* its member `ranks` */
    mps__sets sets;      /* components of the matrix */
} mps__ppe;

/* Unknowns of all ranks. */
static inline int64_t mps__ppe_rows(const mps__ppe *e)
{
    return e->ranks.ranks > 1 ? e->ranks.rows : e->n;
}

void mps__ppe_init(mps__ppe *e, mps__context *context);
void mps__ppe_free(mps__ppe *e);
/* Assemble a row for every unknown. MPS_E_NOMEM, MPS_E_PLUGIN: of a device */
mps_status mps__ppe_fill(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t);
/* Then set the other arrays of the unknowns, with the old pressures as first guess; on the host in
 * e->spare and e->spare_x. If a component lacks a datum, an equation on a device must be copied to
 * the host for mps__ppe_close(): a solver on the device tests this before it begins
 * (mps_ppe_hint), others have to wait (levels.h). */
mps_status mps__ppe_note(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t);
/* Make an equation that lacks a datum solvable; on the host. */
mps_status mps__ppe_close(mps__ppe *e, const mps_view *s);
/* Set e->ranks for mps__ppe_note(); order of the columns, on the host. ppe_ranks.c */
mps_status mps__ppe_ranks_set(mps__ppe *e);
void mps__ppe_ranks_order(mps__ppe *e);
/* Pressures of all particles from the solution e->p. */
void mps__ppe_scatter(const mps__ppe *e, const mps_view *s, const mps__ppe_terms *t, double *p);

/* ---- an equation on a device (ppe_device.c) ---- */

/* Copy all arrays to the host, where they are valid from now on; */
mps_status mps__ppe_to_host(mps__ppe *e);
/* copy the pressures back to the device. */
mps_status mps__ppe_to_device(mps__ppe *e);
/* Release the device memory; before the device is detached. */
void mps__ppe_release_device(mps__ppe *e, mps__device *d);

/* ---- shared by ppe.c and ppe_device.c ---- */

/* Allocate rows for known e->n and e->columns, entries of the matrix, and laws. */
mps_status mps__ppe_reserve_rows(mps__ppe *e, int32_t dim);
mps_status mps__ppe_reserve_entries(mps__ppe *e);
mps_status mps__ppe_reserve_laws(mps__ppe *e);
/* Let the problem point to the arrays of the equation. */
void mps__ppe_point(mps_ppe_problem *problem, const mps__ppe *e);

#endif
