/* SPDX-License-Identifier: BSD-3-Clause */
/* A SUNDIALS vector that is threaded and deterministic, uses the handle's memory and supports fused
 * operations. */
#ifndef MPS_PPE_VECTOR_H
#define MPS_PPE_VECTOR_H

#include "sundials_compat.h"
#include <mps/ppe.h>
#include <stdbool.h>

/* Common data of all vectors of one solver. They have capacity for `capacity` elements and use the
 * first n. They are made with the solver, before the size of a problem is known; mps__space_grow()
 * allocates their arrays. */
typedef struct mps__space {
    mps_allocator allocator;
    mps_allocator arrays; /* in the memory space of the loops over them */
    SUNContext context;
    int64_t n, capacity;
    const mps_parallel *parallel;
    /* vectors made in advance for N_VClone, which dereferences NULL when a clone fails */
    N_Vector spare;
    N_Vector owned;                 /* all vectors that own their array */
    const mps_ppe_problem *problem; /* of the solution in progress */
    /* One dot product, computed by the loop that wrote its vectors while they were in cache. Any
     * other write invalidates it. */
    const double *dot_x, *dot_y;
    double dot;
    /* Limits of the stopping vector. */
    const double *weight; /* NULL: no limit of the divergence */
    double norm_limit, divergence_limit;
} mps__space;

/* A vector over a borrowed array, or NULL. Its clones own their arrays. */
N_Vector mps__vector_wrap(mps__space *space, double *data);
/* The stopping vector. After z = N_VProd(r, stop), N_VMaxNorm(z) is the excess of r over the limits
 * and N_VDotProd(z, z) its square; N_VWL2Norm(r, stop) is the excess directly. */
N_Vector mps__vector_stop(mps__space *space);
/* Make `count` vectors in advance of N_VClone. False when out of memory. */
bool mps__space_reserve(mps__space *space, int count);
/* Resize all vectors that own their array to `capacity` elements; their values are lost. False when
 * out of memory: the capacity is 0. */
bool mps__space_grow(mps__space *space, int64_t capacity);
/* The first `count` arrays of vectors that own theirs: workspace while no vector is used. */
void mps__space_lend(const mps__space *space, int count, double **arrays);
/* Free all arrays; later ones are allocated from `arrays`. */
void mps__space_release_device(mps__space *space, const mps_allocator *arrays);
void mps__space_release(mps__space *space);
double *mps__vector_data(N_Vector v);
void mps__vector_point(N_Vector v, double *data);
/* Call it after writing through mps__vector_data(): stored dot products become invalid. */
void mps__vector_written(N_Vector v);

/* Store `dot` as the result of the next N_VDotProd of x and y, in either order. */
void mps__space_remember(mps__space *space, const double *x, const double *y, double dot);

#endif
