/* SPDX-License-Identifier: BSD-3-Clause */
/* One cycle of BoomerAMG, and the solver around it. */
#ifndef MPS_HYPRE_AMG_H
#define MPS_HYPRE_AMG_H

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <mps/hypre.h>
#include <stdbool.h>

/* A prepared matrix. Initialise it with zeros and the allocator. */
typedef struct mps__amg {
    mps_allocator allocator;
    MPI_Comm comm;
    int64_t n, first, capacity, longest;
    HYPRE_BigInt *index;   /* [capacity] global numbers of the columns */
    HYPRE_Int *length;     /* [capacity] entries of a row */
    HYPRE_BigInt *columns; /* [longest] of one row */
    double *values;        /* [longest] */
    HYPRE_IJMatrix matrix;
    HYPRE_IJVector r, z;
    HYPRE_Solver cycle;
} mps__amg;

/* Collective, like mps__amg_apply(). @param work  [columns] workspace @return 0 or a reason
 * MPS_PPE_..., the same on all ranks */
int mps__amg_setup(mps__amg *a, const mps_ppe_problem *problem, const mps_hypre_settings *settings,
                   double *work);
/* z = M^-1 r, M symmetric positive definite. @return 0 or a reason, of this rank */
int mps__amg_apply(mps__amg *a, const double *r, double *z);
/* Free all but the allocator. */
void mps__amg_release(mps__amg *a);

/* The largest reason of all ranks. */
int mps__hypre_worst(const mps_ppe_problem *problem, int reason);
/* Columns of the matrix: the capacity of an array that is multiplied by it. */
static inline int64_t mps__hypre_columns(const mps_ppe_problem *problem)
{
    return problem->n + (problem->ranks ? problem->ranks->ghosts : 0);
}

/* The communicator of these settings; whether this process has this rank, of this number of ranks,
 * in it. */
MPI_Comm mps__hypre_comm(const mps_hypre_settings *settings);
bool mps__hypre_place(MPI_Comm comm, int32_t rank, int32_t ranks);

/* Allocate `count` elements (at least one), not zeroed. NULL: out of memory. */
void *mps__hypre_take(const mps_allocator *allocator, int64_t count, size_t size);
void mps__hypre_release(const mps_allocator *allocator, void *block);

extern const mps_hypre_settings mps__hypre_defaults;
/* Verbs of the solver (pcg.c). */
int mps__hypre_create(const mps_allocator *allocator, void **self);
void mps__hypre_solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                      void *pc_self, double *p, mps_ppe_result *result);
void mps__hypre_destroy(const mps_allocator *allocator, void *self);

#endif
