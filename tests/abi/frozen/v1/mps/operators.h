/* SPDX-License-Identifier: BSD-3-Clause */
/** @file operators.h  Kernels and MPS operators on any set of particles, without a simulation or a
 *  time step.
 *
 *  An mps_neighbours object is the neighbour list of a set of particles. An mps_stencil is a
 *  read-only view of it for one radius, with the constants of the kernel. Operators take a stencil
 *  and plain arrays. Results have the same bytes for any number of threads.
 *
 *  Notation: r_ij = x_j - x_i, W = W(|r_ij|, re), D = dim.
 *  W22: Wen, Zhao & Wan (2022). Z14: Zhang, Wan & Hino (2014). (n): equation number there.
 *
 *  Errors: an operator returns MPS_E_ARG if the stencil or an array is invalid. The text names it
 *  and what is allowed: mps_neighbours_error() for a stencil of a list, mps_sim_error() for a
 *  stencil of a simulation. A stencil that was never filled returns only the status code, no
 *  text. */
#ifndef MPS_OPERATORS_H
#define MPS_OPERATORS_H

#include <mps/parallel.h>
#include <mps/types.h>

#include <math.h>

MPS_BEGIN_DECLS

/* ---- kernels --------------------------------------------------------------------------------- */

/** A kernel W(r, re) >= 0, called for 0 <= r < re only. It must be thread-safe. */
typedef double (*mps_kernel_fn)(void *user, double r, double re);

/** Identifiers of kernels. */
enum {
    /** re/(0.85 r + 0.15 re) - 1, W22 (3): finite at r = 0. */
    MPS_KERNEL_IMPROVED = 1,
    /** re/r - 1, Z14 (3). */
    MPS_KERNEL_ORIGINAL = 2,
    /** A callback. */
    MPS_KERNEL_CUSTOM = 3
};

/** A weight function by identifier or callback. A member of mps_stencil; its layout is fixed within
 *  a major version. */
typedef struct mps_kernel {
    /** Set by mps_kernel_init(), or sizeof(mps_kernel). */
    uint32_t struct_size;
    /** MPS_KERNEL_... */
    int32_t id;
    /** Callback of MPS_KERNEL_CUSTOM, else NULL. */
    mps_kernel_fn fn;
    /** First argument of fn. */
    void *user;
} mps_kernel;

/** Set struct_size and zero. @param size  sizeof(mps_kernel) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_kernel_init(mps_kernel *kernel, size_t size);

/** Fill a kernel with a built-in one.
 *  @param name    "improved" or "original"
 *  @param kernel  initialised by mps_kernel_init(); out
 *  @return MPS_E_ARG: NULL, or not initialised; MPS_E_NAME */
MPS_API mps_status mps_kernel_find(const char *name, mps_kernel *kernel);

/** Fill a kernel with a callback. @param kernel  initialised by mps_kernel_init(); out
 *  @return MPS_E_ARG: NULL, or not initialised */
MPS_API mps_status mps_kernel_custom(mps_kernel_fn fn, void *user, mps_kernel *kernel);

/** W(r, re); 0 for r >= re, r < 0 and for an invalid kernel. */
MPS_API double mps_kernel_value(const mps_kernel *kernel, double r, double re);

/** W(r, re) for 0 <= r < re, unchecked, for the inner loops of plug-ins. */
static inline double mps_kernel_weight(const mps_kernel *kernel, double r, double re)
{
    if (kernel->id == MPS_KERNEL_IMPROVED) return re / (0.85 * r + 0.15 * re) - 1.0;
    if (kernel->id == MPS_KERNEL_ORIGINAL) return re / r - 1.0;
    return kernel->fn(kernel->user, r, re);
}

/** w[k] = W(r[k], re), unchecked; loops of the built-in kernels vectorise. w may be r. */
static inline void mps_kernel_weights(const mps_kernel *kernel, double re, int32_t count,
                                      const double *r, double *w)
{
    if (kernel->id == MPS_KERNEL_IMPROVED)
        for (int32_t k = 0; k < count; k++) w[k] = re / (0.85 * r[k] + 0.15 * re) - 1.0;
    else if (kernel->id == MPS_KERNEL_ORIGINAL)
        for (int32_t k = 0; k < count; k++) w[k] = re / r[k] - 1.0;
    else
        for (int32_t k = 0; k < count; k++) w[k] = kernel->fn(kernel->user, r[k], re);
}

/** Constants of a full square or cubic lattice: n0 = sum W and lambda = sum W r^2 / sum W,
 *  W22 (7)(8).
 *  @param dim        2 or 3
 *  @param dp         spacing [m], > 0
 *  @param re         radius [m], dp < re < 100 dp
 *  @param n0,lambda  out [-], [m2]; either may be NULL
 *  @return MPS_E_ARG: an argument is out of its range, or the kernel is negative, not finite, or 0
 *          at all distances of the lattice */
MPS_API mps_status mps_lattice_constants(const mps_kernel *kernel, int32_t dim, double dp,
                                         double re, double *n0, double *lambda);

/** Use a kernel of the user for all operators of a simulation.
 *  @param kernel  copied
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | the kernel is invalid; the text states where |
 *  | MPS_E_STATE | a step was done |
 *  | MPS_E_BUSY | called from a monitor, a verb or a callback | */
MPS_API mps_status mps_kernel_use(mps_sim *sim, const mps_kernel *kernel);

/* ---- stencils -------------------------------------------------------------------------------- */

/** Read-only view of a set of particles and its pairs for one radius. Row i is col[begin[i]] ..
 *  col[end[i]-1]: all j != i with |r_ij| < re. Pairs are symmetric. Valid until the list is built
 *  again; a stencil of a simulation until the next step, add or remove; a stencil of a verb until
 *  the verb returns. */
typedef struct mps_stencil {
    /** Set by mps_stencil_init(), or sizeof(mps_stencil). */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** Private: receives error texts of operators. NULL: no texts. */
    void *host;
    /** Number of particles. */
    int64_t n;
    /** Spacing [m]. */
    double dp;
    /** Radius [m]. */
    double re;
    /** Number density of the lattice [-]. */
    double n0;
    /** lambda of the lattice [m2]. */
    double lambda;
    /** Weight function. */
    mps_kernel kernel;
    /** Threads of operators; NULL: the calling thread. Owned by the list or the simulation. */
    const mps_parallel *parallel;
    /** [n*dim] positions [m] */
    const double *x;
    /** [n] first pair of a row */
    const int64_t *begin;
    /** [n] one past the last pair of a row */
    const int64_t *end;
    /** Neighbours. */
    const int32_t *col;
    /** NULL, or W/|r_ij|^2 of each entry of col [1/m2]; set for verbs of a step. */
    const double *w_r2;
} mps_stencil;

/** Set struct_size and zero. @param size  sizeof(mps_stencil) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_stencil_init(mps_stencil *stencil, size_t size);

/** First pair of row i. */
static inline int64_t mps_stencil_begin(const mps_stencil *s, int64_t i)
{
    return s->begin[i];
}

/** One past the last pair of row i. */
static inline int64_t mps_stencil_end(const mps_stencil *s, int64_t i)
{
    return s->end[i];
}

/** Neighbour of pair number k. */
static inline int64_t mps_stencil_column(const mps_stencil *s, int64_t k)
{
    return s->col[k];
}

/** Number of pairs that a row function copies to local arrays before it processes them: `most` on a
 *  processor with vector instructions, 1 on a device. The results are the same. */
#ifdef MPS_DEVICE
#define MPS_PAIRS(most) 1
#else
#define MPS_PAIRS(most) (most)
#endif

/** One pair of a row, for the inner loops of plug-ins. */
typedef struct mps_pair {
    /** r_ij = x_j - x_i [m]; the third is 0 in 2-D */
    double d[3];
    /** |r_ij|^2 [m2] */
    double r2;
    /** |r_ij| [m] */
    double r;
    /** W(r, re) */
    double w;
    /** Neighbour. */
    int64_t j;
    /** W/|r_ij|^2 [1/m2] */
    double w_r2;
} mps_pair;

/** mps_stencil_pair() for a constant `dim` = s->dim: loops over d < dim unroll. */
static inline mps_pair mps_stencil_pair_dim(int32_t dim, const mps_stencil *s, int64_t i, int64_t k)
{
    mps_pair q;
    q.j = mps_stencil_column(s, k);
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

/* ---- neighbour lists ------------------------------------------------------------------------- */

/** Neighbour list of a set of particles. */
typedef struct mps_neighbours mps_neighbours;

/** Create an empty list.
 *  @param dim        2 or 3
 *  @param dp         spacing [m], > 0
 *  @param allocator  NULL: malloc and free; copied
 *  @param list       out: the list, or NULL on failure; destroy it with mps_neighbours_destroy()
 *  @return MPS_E_ARG (without text, because there is no list), MPS_E_NOMEM */
MPS_API mps_status mps_neighbours_create(int32_t dim, double dp, const mps_allocator *allocator,
                                         mps_neighbours **list);

/** Destroy a list; NULL is allowed. */
MPS_API void mps_neighbours_destroy(mps_neighbours *list);

/** Text of the last failed call on a list or one of its stencils: what failed, which value, what is
 *  allowed. Never NULL; valid until the next call. */
MPS_API const char *mps_neighbours_error(const mps_neighbours *list);

/** Set the threads that build the list, and those of its stencils. Default: the calling thread.
 *  @param parallel  copied. `run` NULL: parallel->threads threads of the list
 *  @return MPS_E_ARG, MPS_E_VERSION */
MPS_API mps_status mps_neighbours_parallel_set(mps_neighbours *list, const mps_parallel *parallel);

/** Find all pairs of two radii. Particles closer than 1e-6 dp are no pair, because their direction
 *  is undefined (the two faces of a thin plate).
 *  @param n                number of particles, 1..2^31-1
 *  @param x                [n*dim] positions [m], finite; borrowed until the next build
 *  @param re_near,re_far   radii [m], 0 < re_near <= re_far
 *  @return MPS_E_ARG, MPS_E_NOMEM; the list is empty then */
MPS_API mps_status mps_neighbours_build(mps_neighbours *list, int64_t n, const double *x,
                                        double re_near, double re_far);

/** The radii of a list or of a simulation. */
enum {
    /** re_near */
    MPS_NEAR = 0,
    /** re_far */
    MPS_FAR = 1
};

/** View of the pairs of one radius.
 *  @param which    MPS_NEAR or MPS_FAR
 *  @param kernel   copied; n0 and lambda are those of its lattice
 *  @param stencil  initialised by mps_stencil_init(); out
 *  @return MPS_E_ARG (also if the list is empty), MPS_E_VERSION */
MPS_API mps_status mps_neighbours_stencil_get(const mps_neighbours *list, int32_t which,
                                              const mps_kernel *kernel, mps_stencil *stencil);

/** Stencil of all particles of a simulation (all kinds) at their current positions. The list is
 *  rebuilt if necessary. Particles are not reordered while a lease is open.
 *  @param which    MPS_NEAR or MPS_FAR
 *  @param stencil  initialised by mps_stencil_init(); out
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | no particles; which; stencil is not initialised |
 *  | MPS_E_BUSY | positions are leased for writing; called from a verb or a callback |
 *  | MPS_E_LOST, MPS_E_STATE | a particle left the domain, or all did |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_stencil_get(mps_sim *sim, int32_t which, mps_stencil *stencil);

/* ---- operators ------------------------------------------------------------------------------- */

/** n_i = sum_j W. W22 (7). @param n  [s->n] out */
MPS_API mps_status mps_op_number_density(const mps_stencil *s, double *n);

/** delta_i = S_i/S0 - 1: relative deviation of the particle density; > 0: compressed. S_i is the
 *  sum over j and i itself of a smooth kernel of support s->re: Wendland C2 in 2-D, (1 - q^2)^3
 *  with q = r/re in 3-D. S0 is the sum on the lattice. Unlike n_i it depends only weakly on the
 *  arrangement of the particles.
 *  @param delta  [s->n] out [-] */
MPS_API mps_status mps_op_volume_deviation(const mps_stencil *s, double *delta);

/** sum_j f_j/S0 with the kernel of mps_op_volume_deviation(): 1 + delta_i for f = 1. If f_j is the
 *  nominal volume of particle j in cells of the lattice, the result is 1 where the volumes are
 *  nominal.
 *  @param f [n] @param sum  [n] out, not f */
MPS_API mps_status mps_op_volume_sum(const mps_stencil *s, const double *f, double *sum);

/** \<grad f\>_i = D/n0 sum_j (f_j - f_i) r_ij/|r_ij|^2 W. W22 (4).
 *  @param f  [n] @param grad  [n*dim] out [f/m] */
MPS_API mps_status mps_op_gradient(const mps_stencil *s, const double *f, double *grad);

/** \<grad f\>_i = D/n0 sum_j (f_j + f_i) r_ij/|r_ij|^2 W, which conserves momentum. W22 (9). */
MPS_API mps_status mps_op_gradient_conservative(const mps_stencil *s, const double *f,
                                                double *grad);

/** \<grad f\>_i = D/n0 B_i sum_j (f_j - f_i) r_ij/|r_ij|^2 W, exact for linear f where B is not
 *  bounded by `floor`.
 *  @param b  [n*dim*dim] from mps_op_correction() */
MPS_API mps_status mps_op_gradient_corrected(const mps_stencil *s, const double *b, const double *f,
                                             double *grad);

/** \<div u\>_i = D/n0 sum_j (u_j - u_i).r_ij/|r_ij|^2 W. W22 (5).
 *  @param u  [n*dim] @param div  [n] out */
MPS_API mps_status mps_op_divergence(const mps_stencil *s, const double *u, double *div);

/** As mps_op_divergence() with B_i: exact for linear u where B is not bounded by `floor`. */
MPS_API mps_status mps_op_divergence_corrected(const mps_stencil *s, const double *b,
                                               const double *u, double *div);

/** \<lap f\>_i = 2D/(n0 lambda) sum_j (f_j - f_i) W. W22 (6). @param f  [n] @param lap  [n] out */
MPS_API mps_status mps_op_laplacian(const mps_stencil *s, const double *f, double *lap);

/** Laplacian of a vector field, component by component. @param u  [n*dim] @param lap  [n*dim]
 *  out */
MPS_API mps_status mps_op_laplacian_vector(const mps_stencil *s, const double *u, double *lap);

/** A_i = D/n0 sum_j (x_i - x_j)/|r_ij| W: directed out of the fluid. W22 (11).
 *  @param a  [n*dim] out [-] */
MPS_API mps_status mps_op_asymmetry(const mps_stencil *s, double *a);

/** B_i = M_i^-1, M_i = D/n0 sum_j r_ij (x) r_ij/|r_ij|^2 W; eigenvalues of M below `floor` are
 *  raised to it.
 *  @param floor  > 0, e.g. 0.2
 *  @param b      [n*dim*dim] out, symmetric; unit matrix for a particle without neighbours */
MPS_API mps_status mps_op_correction(const mps_stencil *s, double floor, double *b);

/** Inverse of a symmetric matrix; eigenvalues below `floor` are raised to it.
 *  @param m        [dim*dim]
 *  @param inverse  [dim*dim] out
 *  @return MPS_E_ARG: dim is not 2 or 3, m is not finite, floor is not finite and > 0 */
MPS_API mps_status mps_matrix_inverse_bounded(int32_t dim, const double *m, double floor,
                                              double *inverse);

MPS_END_DECLS

#endif
