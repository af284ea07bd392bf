/* SPDX-License-Identifier: BSD-3-Clause */
/* The matrix of a pressure equation in hypre's form, and one V-cycle of BoomerAMG on it. */
#include "amg.h"
#include <math.h>
#include <string.h>

/* Fraction of the diagonal that is added to it in components without pressure datum, whose coarsest
 * grid would be singular. It is far below the smallest eigenvalue of a tank, (dp/length)^2, and far
 * above rounding. */
static const double GROUND = 1e-8;

void *mps__hypre_take(const mps_allocator *allocator, int64_t count, size_t size)
{
    if (count < 1) count = 1;
    if ((uint64_t)count > SIZE_MAX / size) return NULL;
    return allocator->alloc(allocator->user, (size_t)count * size);
}

void mps__hypre_release(const mps_allocator *allocator, void *block)
{
    if (block) allocator->release(allocator->user, block);
}

/* ---- memory ---- */

static void drop_objects(mps__amg *a)
{
    if (a->cycle) HYPRE_BoomerAMGDestroy(a->cycle);
    if (a->matrix) HYPRE_IJMatrixDestroy(a->matrix);
    if (a->r) HYPRE_IJVectorDestroy(a->r);
    if (a->z) HYPRE_IJVectorDestroy(a->z);
    a->cycle = NULL;
    a->matrix = NULL;
    a->r = a->z = NULL;
}

void mps__amg_release(mps__amg *a)
{
    const mps_allocator allocator = a->allocator;
    const MPI_Comm comm = a->comm;
    drop_objects(a);
    mps__hypre_release(&allocator, a->index);
    mps__hypre_release(&allocator, a->length);
    mps__hypre_release(&allocator, a->columns);
    mps__hypre_release(&allocator, a->values);
    *a = (mps__amg){.allocator = allocator, .comm = comm};
}

static bool reserve(mps__amg *a, const mps_ppe_problem *problem)
{
    const int64_t columns = mps__hypre_columns(problem);
    int64_t longest = 1;
    for (int64_t i = 0; i < problem->n; i++) {
        const int64_t length = problem->row[i + 1] - problem->row[i] + 1;
        if (length > longest) longest = length;
    }
    if (a->index && columns <= a->capacity && longest <= a->longest) return true;
    mps__amg_release(a);
    const mps_allocator *allocator = &a->allocator;
    a->capacity = columns + columns / 8;
    a->longest = 2 * longest;
    a->index = mps__hypre_take(allocator, a->capacity, sizeof *a->index);
    a->length = mps__hypre_take(allocator, a->capacity, sizeof *a->length);
    a->columns = mps__hypre_take(allocator, a->longest, sizeof *a->columns);
    a->values = mps__hypre_take(allocator, a->longest, sizeof *a->values);
    if (a->index && a->length && a->columns && a->values) return true;
    mps__amg_release(a);
    return false;
}

/* ---- matrix ---- */

/* Global numbers of the columns; those of other ranks are exchanged. */
static bool number_columns(mps__amg *a, const mps_ppe_problem *problem, double *work)
{
    a->n = problem->n;
    a->first = problem->ranks ? problem->ranks->first : 0;
    for (int64_t i = 0; i < problem->n; i++) work[i] = (double)(a->first + i);
    if (mps_ppe_halo(problem, work)) return false;
    for (int64_t i = 0; i < mps__hypre_columns(problem); i++) a->index[i] = (HYPRE_BigInt)work[i];
    return true;
}

/* Copy the entries of row i to columns and values, the diagonal first; an empty row gets a diagonal
 * of 1. @return how many */
static HYPRE_Int copy_row(mps__amg *a, const mps_ppe_problem *problem, int64_t i)
{
    const bool floating = problem->component && problem->component[i] >= 0;
    const double diagonal = problem->diagonal[i] * (floating ? 1 + GROUND : 1);
    HYPRE_Int count = 0;
    a->columns[count] = a->index[i];
    a->values[count++] = diagonal > 0 ? diagonal : 1;
    for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
        a->columns[count] = a->index[problem->col[k]];
        a->values[count++] = (double)problem->val[k];
    }
    return count;
}

static void make_matrix(mps__amg *a, const mps_ppe_problem *problem)
{
    /* last < first: no rows on this rank */
    const HYPRE_BigInt first = (HYPRE_BigInt)a->first, last = first + (HYPRE_BigInt)a->n - 1;
    for (int64_t i = 0; i < problem->n; i++)
        a->length[i] = (HYPRE_Int)(problem->row[i + 1] - problem->row[i]) + 1;
    HYPRE_IJMatrixCreate(a->comm, first, last, first, last, &a->matrix);
    HYPRE_IJMatrixSetObjectType(a->matrix, HYPRE_PARCSR);
    HYPRE_IJMatrixSetRowSizes(a->matrix, a->length);
    HYPRE_IJMatrixInitialize(a->matrix);
    for (int64_t i = 0; i < problem->n; i++) {
        HYPRE_Int count = copy_row(a, problem, i);
        HYPRE_IJMatrixSetValues(a->matrix, 1, &count, &a->index[i], a->columns, a->values);
    }
    HYPRE_IJMatrixAssemble(a->matrix);
}

static void make_vector(const mps__amg *a, HYPRE_IJVector *v)
{
    const HYPRE_BigInt first = (HYPRE_BigInt)a->first;
    HYPRE_IJVectorCreate(a->comm, first, first + (HYPRE_BigInt)a->n - 1, v);
    HYPRE_IJVectorSetObjectType(*v, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(*v);
    HYPRE_IJVectorAssemble(*v);
}

/* ---- multigrid ---- */

static void make_cycle(mps__amg *a, const mps_hypre_settings *settings)
{
    static const HYPRE_Int coarsest = 3;
    HYPRE_BoomerAMGCreate(&a->cycle);
    HYPRE_BoomerAMGSetPrintLevel(a->cycle, 0);
    HYPRE_BoomerAMGSetMaxIter(a->cycle, 1);
    HYPRE_BoomerAMGSetTol(a->cycle, 0);
    HYPRE_BoomerAMGSetCoarsenType(a->cycle, settings->coarsening);
    HYPRE_BoomerAMGSetInterpType(a->cycle, settings->interpolation);
    HYPRE_BoomerAMGSetPMaxElmts(a->cycle, settings->row_entries);
    HYPRE_BoomerAMGSetStrongThreshold(a->cycle, settings->threshold);
    HYPRE_BoomerAMGSetAggNumLevels(a->cycle, settings->aggressive_levels);
    /* except for the direct solution on the coarsest grid */
    HYPRE_BoomerAMGSetRelaxType(a->cycle, settings->relaxation);
    HYPRE_BoomerAMGSetRelaxOrder(a->cycle, 0);
    HYPRE_BoomerAMGSetNumSweeps(a->cycle, settings->sweeps);
    HYPRE_BoomerAMGSetCycleNumSweeps(a->cycle, 1, coarsest);
}

static void *object_of(HYPRE_IJVector v)
{
    void *object = NULL;
    HYPRE_IJVectorGetObject(v, &object);
    return object;
}

/* hypre accumulates its errors in one flag. */
static int outcome(void)
{
    const HYPRE_Int error = HYPRE_GetError();
    HYPRE_ClearAllErrors();
    return !error ? 0 : error & HYPRE_ERROR_MEMORY ? MPS_PPE_NOMEM : MPS_PPE_BREAKDOWN;
}

/* Checks of this rank before it calls hypre, which waits for all ranks. */
static int prepare(mps__amg *a, const mps_ppe_problem *problem, double *work)
{
    const int64_t rows = problem->ranks ? problem->ranks->rows : problem->n;
    const bool large = problem->row[problem->n] + problem->n >= INT32_MAX || rows >= INT32_MAX;
    int reason = large ? MPS_PPE_BREAKDOWN : reserve(a, problem) ? 0 : MPS_PPE_NOMEM;
    reason = mps__hypre_worst(problem, reason);
    if (reason) return reason;
    return mps__hypre_worst(problem, number_columns(a, problem, work) ? 0 : MPS_PPE_BREAKDOWN);
}

int mps__amg_setup(mps__amg *a, const mps_ppe_problem *problem, const mps_hypre_settings *settings,
                   double *work)
{
    void *matrix = NULL;
    drop_objects(a); /* the pattern changes every step, so that nothing is kept */
    const int reason = prepare(a, problem, work);
    if (reason) return reason;
    HYPRE_ClearAllErrors();
    make_matrix(a, problem);
    make_vector(a, &a->r);
    make_vector(a, &a->z);
    make_cycle(a, settings);
    HYPRE_IJMatrixGetObject(a->matrix, &matrix);
    HYPRE_BoomerAMGSetup(a->cycle, matrix, object_of(a->r), object_of(a->z));
    return mps__hypre_worst(problem, outcome());
}

int mps__amg_apply(mps__amg *a, const double *r, double *z)
{
    void *matrix = NULL;
    HYPRE_IJMatrixGetObject(a->matrix, &matrix);
    HYPRE_IJVectorSetValues(a->r, (HYPRE_Int)a->n, a->index, r);
    HYPRE_ParVectorSetConstantValues(object_of(a->z), 0);
    HYPRE_BoomerAMGSolve(a->cycle, matrix, object_of(a->r), object_of(a->z));
    HYPRE_IJVectorGetValues(a->z, (HYPRE_Int)a->n, a->index, z);
    return outcome();
}
