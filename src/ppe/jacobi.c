/* SPDX-License-Identifier: BSD-3-Clause */
/* jacobi: the inverse of the diagonal. */
#include "builtin.h"
#include "rows.h"
#include "loop.h"
#include <math.h>

typedef struct jacobi {
    mps_allocator allocator;
    mps_allocator arrays; /* of the host or of a device */
    double *inverse;      /* [capacity] */
    int64_t n, capacity;
    const mps_parallel *parallel;
} jacobi;

static int create(const mps_allocator *allocator, void **self)
{
    jacobi *j = mps__take(allocator, 1, sizeof *j);
    if (!j) return MPS_PPE_NOMEM;
    *j = (jacobi){.allocator = *allocator, .arrays = *allocator};
    *self = j;
    return 0;
}

/* Allocate the array in the memory space of the loops over it. */
static void settle(jacobi *j, const mps_parallel *parallel)
{
    mps__device *d = mps__device_of(parallel);
    const mps_allocator wanted = d ? d->memory : j->allocator;
    if (wanted.alloc == j->arrays.alloc && wanted.user == j->arrays.user) return;
    mps__release(&j->arrays, j->inverse);
    j->inverse = NULL;
    j->capacity = 0;
    j->arrays = wanted;
}

static void release_device(void *self)
{
    settle(self, NULL);
}

static bool reserve(jacobi *j, int64_t n)
{
    if (n <= j->capacity) return true;
    mps__release(&j->arrays, j->inverse);
    j->capacity = n + n / 8;
    j->inverse = mps__take(&j->arrays, j->capacity, sizeof *j->inverse);
    if (!j->inverse) j->capacity = 0;
    return j->inverse;
}

/* Checks of the diagonal. */
enum { POISON, NEGATIVE, VALUES };

typedef struct operands {
    const double *x;
    double *z;
} operands;

/* An empty row is a particle without neighbours; its residual is 0. */
MPS_ROW double inverse_of(double d)
{
    return d > 0 ? 1 / d : 1;
}

MPS_ROW void invert_row(const operands *o, int64_t i, double *found)
{
    const double d = o->x[i];
    if (!isfinite(d)) found[POISON] = 1;
    if (d < 0) found[NEGATIVE] = 1;
    o->z[i] = inverse_of(d);
}
MPS__VALUES_ANY(invert_rows, invert_row, operands, 0, VALUES)

MPS_ROW void invert_device(const operands *o, int64_t i)
{
    o->z[i] = inverse_of(o->x[i]);
}
MPS__LOOP_ANY(invert_rows_device, invert_device, operands)

static int setup(void *self, const mps_ppe_problem *problem)
{
    jacobi *j = self;
    settle(j, problem->parallel);
    if (!reserve(j, problem->n)) return MPS_PPE_NOMEM;
    j->n = problem->n;
    j->parallel = problem->parallel;
    double found[VALUES] = {0};
    const operands rows = {.x = problem->diagonal, .z = j->inverse};
    /* the solver on a device does not begin if the diagonal fails the checks below */
    if (mps__device_of(problem->parallel) && !problem->ranks) {
        mps__loop_run(problem->parallel, &invert_rows_device, MPS__ANY_DIM, problem->n, &rows);
        return 0;
    }
    mps__values_run(mps__team(problem->parallel, problem->n), &invert_rows, MPS__ANY_DIM,
                    problem->n, &rows, NULL, found);
    mps_ppe_total(problem, &(mps_exact_values){.maxima = VALUES, .maximum = found});
    return found[POISON] > 0 ? MPS_PPE_NAN : found[NEGATIVE] > 0 ? MPS_PPE_INDEFINITE : 0;
}

static int apply(void *self, const double *r, double *z)
{
    const jacobi *j = self;
    mps__vectors_product(j->parallel, j->n, j->inverse, r, z);
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    jacobi *j = self;
    if (!j) return;
    mps__release(&j->arrays, j->inverse);
    mps__release(allocator, j);
}

const mps_preconditioner_ops mps__preconditioner_jacobi = {
    .struct_size = sizeof(mps_preconditioner_ops),
    .api = MPS_PPE_API,
    .name = "jacobi",
    .symmetric = 1,
    .create = create,
    .setup = setup,
    .apply = apply,
    .destroy = destroy,
    .help = "Diagonal scaling",
    .ranks = 1,
    .device = 1,
    .release_device = release_device,
    .setup_async = 1,
};
