/* SPDX-License-Identifier: BSD-3-Clause */
/* A SUNDIALS vector that is threaded and deterministic, lives in the handle's memory and answers fused questions. */
#ifndef MPS_PPE_VECTOR_H
#define MPS_PPE_VECTOR_H

#include "sundials_compat.h"
#include <mps/ppe.h>
#include <stdbool.h>

/* What all vectors of one solver share. They have room for `capacity` elements and use the first n. They are made with the solver, before the
 * size of a problem is known, and mps__space_grow() gives them their arrays. */
typedef struct mps__space {
    mps_allocator allocator;
    mps_allocator arrays; /* of the host or of a device: where the loops over them run */
    SUNContext context;
    int64_t n, capacity;
    const mps_parallel *parallel;
    /* list of vectors made ahead for N_VClone, which dereferences NULL when a clone fails */
    N_Vector spare;
    N_Vector owned;                 /* list of all vectors with an array of their own */
    const mps_ppe_problem *problem; /* of the solution in progress */
    /* One dot product computed by the kernel that wrote its vectors, while they were in cache. Any other write forgets it. */
    const double *dot_x, *dot_y;
    double dot;
    /* Limits behind the stopping vector. */
    const double *weight; /* NULL: divergence not asked */
    double norm_limit, divergence_limit;
} mps__space;

/* A vector over a borrowed array, or NULL. Its clones own theirs. */
N_Vector mps__vector_wrap(mps__space *space, double *data);
/* The stopping vector: N_VProd of r and it to z makes N_VDotProd(z, z) the square of how far r is above the limits, and N_VMaxNorm(z) that
 * itself; N_VWL2Norm(r, stop) is it at once. */
N_Vector mps__vector_stop(mps__space *space);
/* Make `count` vectors ahead of N_VClone. False when out of memory. */
bool mps__space_reserve(mps__space *space, int count);
/* Room for `capacity` elements in all vectors that own their array; what was in them is lost. False when out of memory: the capacity is 0. */
bool mps__space_grow(mps__space *space, int64_t capacity);
/* The first `count` arrays of vectors that own theirs: scratch while no vector is used. */
void mps__space_lend(const mps__space *space, int count, double **arrays);
/* Give back all arrays; the next ones come from `arrays`. */
void mps__space_leave(mps__space *space, const mps_allocator *arrays);
void mps__space_release(mps__space *space);
double *mps__vector_data(N_Vector v);
void mps__vector_point(N_Vector v, double *data);
/* Call it after writing through mps__vector_data(): stored dot products are not valid any more. */
void mps__vector_written(N_Vector v);

/* The next N_VDotProd of x and y, in either order, answers `dot`. */
void mps__space_remember(mps__space *space, const double *x, const double *y, double dot);

#endif
