/* SPDX-License-Identifier: BSD-3-Clause */
/** @file operators.h  Kernels and MPS operators on any cloud of particles, with no simulation and no time step.
 *
 *  An mps_neighbours object holds the neighbour list of a cloud, an mps_stencil is a read-only view of it for one
 *  radius with the kernel's constants. Operators take a stencil and plain arrays. All results are the same bytes for
 *  any number of threads. Notation: r_ij = x_j - x_i, W = W(|r_ij|, re), D = dim. */
#ifndef MPS_OPERATORS_H
#define MPS_OPERATORS_H

#include <mps/parallel.h>
#include <mps/types.h>

#include <math.h>

MPS_BEGIN_DECLS

/** A kernel W(r, re) for 0 <= r < re, not negative; it is never called outside. Must be thread-safe. */
typedef double (*mps_kernel_fn)(void *user, double r, double re);

/** Kernels known by number. */
enum { MPS_KERNEL_IMPROVED = 1, MPS_KERNEL_ORIGINAL = 2, MPS_KERNEL_CUSTOM = 3 };

/** A weight function by name or by callback. */
typedef struct mps_kernel {
    int32_t id;       /**< MPS_KERNEL_... */
    mps_kernel_fn fn; /**< callback of a user's kernel, else NULL */
    void *user;       /**< first argument of fn */
} mps_kernel;

/** Find a built-in kernel: "improved" re/(0.85 r + 0.15 re) - 1, W22 (3), or "original" re/r - 1, Z14 (3). */
MPS_API mps_status mps_kernel_find(const char *name, mps_kernel *kernel);

/** Make a kernel from a callback. */
MPS_API mps_status mps_kernel_custom(mps_kernel_fn fn, void *user, mps_kernel *kernel);

/** W(r, re); 0 for r >= re. */
MPS_API double mps_kernel_value(const mps_kernel *kernel, double r, double re);

/** W(r, re) for 0 <= r < re, unchecked, for the inner loops of plug-ins. */
static inline double mps_kernel_weight(const mps_kernel *kernel, double r, double re)
{
    if (kernel->id == MPS_KERNEL_IMPROVED) return re / (0.85 * r + 0.15 * re) - 1.0;
    if (kernel->id == MPS_KERNEL_ORIGINAL) return re / r - 1.0;
    return kernel->fn(kernel->user, r, re);
}

/** w[k] = W(r[k], re), unchecked; the built-in kernels take several r at a time. w may be r. */
static inline void mps_kernel_weights(const mps_kernel *kernel, double re, int32_t count, const double *r, double *w)
{
    if (kernel->id == MPS_KERNEL_IMPROVED)
        for (int32_t k = 0; k < count; k++) w[k] = re / (0.85 * r[k] + 0.15 * re) - 1.0;
    else if (kernel->id == MPS_KERNEL_ORIGINAL)
        for (int32_t k = 0; k < count; k++) w[k] = re / r[k] - 1.0;
    else
        for (int32_t k = 0; k < count; k++) w[k] = kernel->fn(kernel->user, r[k], re);
}

/** Constants of a full square or cubic lattice: n0 = sum W and lambda = sum W r^2 / sum W, W22 (7)(8).
 *  @param re  radius [m] @param n0,lambda out, either may be NULL; lambda [m2] */
MPS_API mps_status mps_lattice_constants(const mps_kernel *kernel, int32_t dim, double dp, double re, double *n0, double *lambda);

/** Use a user's kernel for all operators of a simulation, before its first step. */
MPS_API mps_status mps_kernel_use(mps_sim *sim, const mps_kernel *kernel);

/** Read-only view of a cloud and its pairs for one radius. Row i: col[begin[i]] .. col[end[i]-1], r_ij < re, j != i.
 *  Pairs are symmetric. Valid until the cloud is built again, or until the callback that got it returns. */
typedef struct mps_stencil {
    uint32_t struct_size; /**< sizeof(mps_stencil) */
    int32_t dim;          /**< 2 or 3 */
    int64_t n;            /**< particles */
    double dp;            /**< spacing [m] */
    double re;            /**< radius [m] */
    double n0;            /**< lattice number density */
    double lambda;        /**< lattice lambda [m2] */
    mps_kernel kernel;    /**< weight function */
    /** Threads of operators; NULL: the calling thread. Belongs to the list or the simulation. */
    const mps_parallel *parallel;
    const double *x;      /**< [n*dim] positions [m] */
    const int64_t *begin; /**< [n] first pair of a row */
    const int64_t *end;   /**< [n] one past the last pair of a row */
    const int32_t *col;   /**< neighbours */
    const double *w_r2;   /**< NULL, or W/|r_ij|^2 beside col [1/m2], as in the verbs of a step */
} mps_stencil;

/** One pair of a row, for the inner loops of plug-ins. */
typedef struct mps_pair {
    double d[3]; /**< r_ij = x_j - x_i [m]; the third is 0 in 2-D */
    double r2;   /**< |r_ij|^2 [m2] */
    double r;    /**< |r_ij| [m] */
    double w;    /**< W(r, re) */
    int64_t j;   /**< neighbour */
    double w_r2; /**< W/|r_ij|^2 [1/m2] */
} mps_pair;

/** mps_stencil_pair() for a constant `dim` = s->dim: loops over d < dim unroll. */
static inline mps_pair mps_stencil_pair_dim(int32_t dim, const mps_stencil *s, int64_t i, int64_t k)
{
    mps_pair q;
    q.j = s->col[k];
    const double *a = s->x + i * dim, *b = s->x + q.j * dim;
    q.d[0] = b[0] - a[0];
    q.d[1] = b[1] - a[1];
    q.d[2] = dim == 3 ? b[2] - a[2] : 0.0;
    q.r2 = q.d[0] * q.d[0] + q.d[1] * q.d[1];
    if (dim == 3) q.r2 += q.d[2] * q.d[2];
    q.r = sqrt(q.r2);
    if (s->w_r2) {
        q.w_r2 = s->w_r2[k];
        q.w = q.w_r2 * q.r2;
    } else {
        q.w = mps_kernel_weight(&s->kernel, q.r, s->re);
        q.w_r2 = q.w / q.r2;
    }
    return q;
}

/** Pair number k (begin[i] <= k < end[i]) of row i. */
static inline mps_pair mps_stencil_pair(const mps_stencil *s, int64_t i, int64_t k)
{
    return mps_stencil_pair_dim(s->dim, s, i, k);
}

/** Neighbour list of a cloud. */
typedef struct mps_neighbours mps_neighbours;

/** Create an empty list.
 *  @param dim 2 or 3 @param dp spacing [m] @param allocator NULL for malloc @param list out, destroy with mps_neighbours_destroy() */
MPS_API mps_status mps_neighbours_create(int32_t dim, double dp, const mps_allocator *allocator, mps_neighbours **list);

/** Destroy a list; NULL is allowed. */
MPS_API void mps_neighbours_destroy(mps_neighbours *list);

/** Threads that build the list, and those of its stencils. Without this call: the calling thread.
 *  @param parallel  copied. `run` NULL: threads of the list's own, parallel->threads of them
 *  @return MPS_E_ARG, MPS_E_VERSION */
MPS_API mps_status mps_neighbours_parallel_set(mps_neighbours *list, const mps_parallel *parallel);

/** Find all pairs of two radii; positions are borrowed until the next build. Particles nearer than 1e-6 dp to each other are no pair: what
 *  has no distance has no direction (so are the two faces of a thin plate). They do not add to each other's sums.
 *  @param n particles, 1..2^31-1 @param x [n*dim] finite @param re_near,re_far radii [m], 0 < re_near <= re_far
 *  @return MPS_E_ARG, MPS_E_NOMEM (the list is empty then) */
MPS_API mps_status mps_neighbours_build(mps_neighbours *list, int64_t n, const double *x, double re_near, double re_far);

/** Which radius of a list or of a simulation. */
enum { MPS_NEAR = 0, MPS_FAR = 1 };

/** View of the pairs of one radius. @param kernel copied; n0 and lambda come from its lattice */
MPS_API mps_status mps_neighbours_stencil_get(const mps_neighbours *list, int32_t which, const mps_kernel *kernel, mps_stencil *stencil);

/** The stencil of a simulation's particles at their present positions (all kinds). Rebuilds the list if needed.
 *  Valid until the next step, add or remove, and until particles are moved. Leases for reading do not matter: while any lease is open,
 *  nobody is put at another place. @return MPS_E_BUSY while positions are leased for writing */
MPS_API mps_status mps_stencil_get(mps_sim *sim, int32_t which, mps_stencil *stencil);

/** n_i = sum_j W. W22 (7). @param n [s->n] out */
MPS_API mps_status mps_op_number_density(const mps_stencil *s, double *n);

/** delta_i = S_i/S0 - 1, S_i = sum over j and i itself of a kernel of support s->re: what a particle is short of its volume.
 *  The kernel is Wendland C2 in 2-D and (1 - q^2)^3, q = r/re, in 3-D. Unlike n it hardly sees the shape of the lattice.
 *  @param delta [s->n] out [-] */
MPS_API mps_status mps_op_volume_deviation(const mps_stencil *s, double *delta);

/** Sum of f by the same kernel, over S0: for f = 1 it is 1 + delta_i. With the volumes f_j that particles should have, in cells of the
 *  lattice, it is 1 where they have them. @param f [n] @param sum [n] out, not f */
MPS_API mps_status mps_op_volume_sum(const mps_stencil *s, const double *f, double *sum);

/** \<grad f\>_i = D/n0 sum_j (f_j - f_i) r_ij/|r_ij|^2 W. W22 (4). @param f [n] @param grad [n*dim] out [f/m] */
MPS_API mps_status mps_op_gradient(const mps_stencil *s, const double *f, double *grad);

/** \<grad f\>_i = D/n0 sum_j (f_j + f_i) r_ij/|r_ij|^2 W, momentum conserving. W22 (9). */
MPS_API mps_status mps_op_gradient_conservative(const mps_stencil *s, const double *f, double *grad);

/** \<grad f\>_i = D/n0 B_i sum_j (f_j - f_i) r_ij/|r_ij|^2 W, exact for linear f where B is not bounded.
 *  @param b [n*dim*dim] from mps_op_correction() */
MPS_API mps_status mps_op_gradient_corrected(const mps_stencil *s, const double *b, const double *f, double *grad);

/** \<div u\>_i = D/n0 sum_j (u_j - u_i).r_ij/|r_ij|^2 W. W22 (5). @param u [n*dim] @param div [n] out */
MPS_API mps_status mps_op_divergence(const mps_stencil *s, const double *u, double *div);

/** As mps_op_divergence() with B_i: exact for linear u where B is not bounded. */
MPS_API mps_status mps_op_divergence_corrected(const mps_stencil *s, const double *b, const double *u, double *div);

/** \<lap f\>_i = 2D/(n0 lambda) sum_j (f_j - f_i) W. W22 (6). @param f [n] @param lap [n] out */
MPS_API mps_status mps_op_laplacian(const mps_stencil *s, const double *f, double *lap);

/** Laplacian of a vector field, component by component. @param u [n*dim] @param lap [n*dim] out */
MPS_API mps_status mps_op_laplacian_vector(const mps_stencil *s, const double *u, double *lap);

/** A_i = D/n0 sum_j (x_i - x_j)/|r_ij| W. W22 (11): points out of the fluid. @param a [n*dim] out [-] */
MPS_API mps_status mps_op_asymmetry(const mps_stencil *s, double *a);

/** B_i = M_i^-1, M_i = D/n0 sum_j r_ij (x) r_ij/|r_ij|^2 W, eigenvalues of M raised to `floor` where they are smaller.
 *  @param floor  > 0, e.g. 0.2 @param b [n*dim*dim] out, symmetric; unit matrix for a particle without neighbours */
MPS_API mps_status mps_op_correction(const mps_stencil *s, double floor, double *b);

/** Inverse of a symmetric matrix m [dim*dim] whose eigenvalues are raised to `floor` where they are smaller.
 *  @param inverse  [dim*dim] out @return MPS_E_ARG: dim is not 2 or 3, m is not finite, floor is not > 0 and finite */
MPS_API mps_status mps_matrix_inverse_bounded(int32_t dim, const double *m, double floor, double *inverse);

MPS_END_DECLS

#endif
