/* SPDX-License-Identifier: BSD-3-Clause */
/** @file ppe.h  Plug-in interface of pressure solvers and preconditioners.
 *
 *  The system is A p = b: row i is sum_j k_ij (p_i - p_j) + s_i p_i = b_i with k_ij = k_ji, s_i >=
 *  0. A is symmetric positive (semi-)definite for the default models. Rows of a gas may be
 *  nonlinear: A p + gas (f(p) - p) = b, f by mps_ppe_law(). A holds their linear part, so gas_i <=
 *  s_i. Built-in solvers and preconditioners use this interface too.
 *
 *  On a device (<mps/device.h>) a solver and a preconditioner with `device` solve equations without
 *  singular components and without nonlinear rows. Then `mps_ppe_problem.device` is not NULL: the
 *  arrays of the equation and all vectors are in device memory, and only loops read and write them:
 *  mps_ppe_rows(), mps_ppe_sum(), mps_ppe_max(). The same loops run on the host. */
#ifndef MPS_PPE_H
#define MPS_PPE_H

#include <mps/exact.h>
#include <mps/parallel.h>
#include <mps/ranks.h>
#include <mps/stage.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_solver_ops.api and mps_preconditioner_ops.api. */
#define MPS_PPE_API 1u

/** An equation whose rows are distributed over ranks. Each rank has `n` rows. Columns n..n+ghosts-1
 *  are ghost columns: unknowns of other ranks. All ranks make the same calls in the same order. */
typedef struct mps_ppe_ranks {
    /** sizeof(mps_ppe_ranks) of the library */
    uint32_t struct_size;
    /** Number of this rank. */
    int32_t rank;
    /** Number of ranks. */
    int32_t ranks;
    /** Kept 0. */
    int32_t reserved;
    /** Number of ghost columns. */
    int64_t ghosts;
    /** Number of rows of all ranks. */
    int64_t rows;
    /** Number of rows of lower ranks: the global index of row 0. */
    int64_t first;
    /** [n + ghosts] columns in the order of the particles, which is the same on all ranks that have
     *  these particles */
    const int32_t *order;
    /** Owner ranks of positions x [m*dim] in the lab: a function of the position, the same on all
     *  ranks. This rank has a column for each particle within reach of an owned position. Non-zero:
     *  failed. */
    int (*owner)(void *host, int64_t m, const double *x, int32_t *rank);
    /** Halo exchange: set x[n..n+ghosts-1] to the values of x[0..n-1] of the owners. Non-zero:
     *  failed. */
    int (*halo)(void *host, double *x);
    /** Allreduce, as mps_ranks_ops.reduce. Non-zero: failed. */
    int (*reduce)(void *host, int32_t count, size_t bytes, void *values, mps_combine_fn combine);
    /** Collect blocks of all ranks (allgather), as mps_ranks_ops.gather. Non-zero: failed. */
    int (*gather)(void *host, const void *own, const int64_t *bytes, void *all);
    /** Create a route between ranks, as mps_ranks_ops.connect. Non-zero: failed, no route. */
    int (*connect)(void *host, int32_t count, const int32_t *to, const int64_t *sent,
                   mps_route *route);
    /** Free a route. A solver or preconditioner may keep a route until its next setup or until it
     *  is destroyed. Not collective. */
    void (*disconnect)(void *host, mps_route *route);
    /** Exchange elements along a route, as mps_ranks_ops.exchange_begin and exchange_end. Non-zero:
     *  failed. */
    int (*exchange)(void *host, const mps_route *route, size_t bytes, const void *out, void *in);
    /** First argument of these functions. */
    void *host;
} mps_ppe_ranks;

/** Facts about an equation on a device that let a solver wait for the device less often. Owned by
 *  the library. */
typedef struct mps_ppe_hint {
    /** sizeof(mps_ppe_hint) of the library */
    uint32_t struct_size;
    /** out: 1: the solver has not iterated because of `unsolvable`, and returns MPS_PPE_NAN. 0 on
     *  entry. */
    int32_t refused;
    /** NULL, or a number in device memory, which the host does not know yet. If it is above
     *  -INFINITY, the equation must not be solved. */
    const double *unsolvable;
    /** NULL, or queue a reduction over the pressures p to one number in device memory. A solver may
     *  call it for other than the final pressures too. */
    void (*reduce)(void *owner, double *to);
    /** First argument of `reduce`. */
    void *owner;
    /** out: the number of `reduce` for the final pressures; NaN: not computed. NaN on entry. */
    double reduced;
} mps_ppe_hint;

/** One pressure equation, assembled by the library; all arrays are borrowed for the call. */
typedef struct mps_ppe_problem {
    /** sizeof(mps_ppe_problem) of the library */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** Unknowns. */
    int64_t n;
    /** [n+1] CSR row starts of the off-diagonal entries */
    const int64_t *row;
    /** [row[n]] columns, ascending in a row; on many ranks in the order of the particles; ghost
     *  columns are >= n */
    const int32_t *col;
    /** [row[n]] -k_ij in single precision, which halves the memory traffic; entries ij and ji are
     *  equal. */
    const float *val;
    /** [n] s_i + sum_j k_ij of the stored (rounded) entries, so that row sums are exact */
    const double *diagonal;
    /** [n] right-hand side; orthogonal to the null space of singular components */
    const double *rhs;
    /** [n] s_i: the row sums */
    const double *shift;
    /** [n] residual times weight = divergence times dt */
    const double *weight;
    /** [n*dim] positions of the unknowns minus the displacement of the tank [m], so that a solution
     *  does not depend on a uniform motion; on many ranks [(n + ghosts)*dim] */
    const double *x;
    /** Particle spacing [m]. */
    double dp;
    /** Required relative 2-norm of the residual. */
    double tolerance;
    /** Required upper bound of |residual * weight|; 0: no limit. */
    double divergence;
    /** Maximum number of iterations. */
    int32_t max_iterations;
    /** Number of singular components (no Dirichlet row, no shift). */
    int32_t components;
    /** [n] 0..components-1 in a singular component, else -1; NULL without singular components */
    const int32_t *component;
    /** [n] >= 0, coefficient of a nonlinear row; NULL if there is no nonlinear row */
    const double *gas;
    /** [n] P_i > 0 of a nonlinear row [Pa], 0 of a linear one; NULL with gas */
    const double *law;
    /** Threads of the solver; NULL: the calling thread. Valid as long as the matrix. */
    const mps_parallel *parallel;
    /** NULL: this rank has all rows. Otherwise vectors that are multiplied by the matrix need a
     *  capacity of n + ghosts values. */
    const mps_ppe_ranks *ranks;
    /** NULL: the arrays are in host memory. Otherwise the allocator of the device memory in which
     *  the arrays are; the host does not dereference its addresses. Valid until the state has
     *  released its device memory; at most 128 blocks of a handle at the same time. */
    const mps_allocator *device;
    /** NULL, or facts about the equation, for a solver with `hint`. */
    mps_ppe_hint *hint;
} mps_ppe_problem;

/** Halo exchange of x at ghost columns; does nothing if this rank has all rows.
 *  @param x  [n + ghosts] @return 0, or non-zero after a failure */
static inline int mps_ppe_halo(const mps_ppe_problem *problem, double *x)
{
    return problem->ranks ? problem->ranks->halo(problem->ranks->host, x) : 0;
}

/** Allreduce; does nothing if this rank has all rows. @return as mps_ppe_halo() */
static inline int mps_ppe_reduce(const mps_ppe_problem *problem, int32_t count, size_t bytes,
                                 void *values, mps_combine_fn combine)
{
    return problem->ranks
               ? problem->ranks->reduce(problem->ranks->host, count, bytes, values, combine)
               : 0;
}

/** Allreduce of sums and maxima over rows in one message, at most 4 of each. In: over the rows of
 *  this rank; out: over the rows of all ranks. @return as mps_ppe_halo() */
MPS_API int mps_ppe_total(const mps_ppe_problem *problem, const mps_exact_values *values);

/** Run a loop over the unknowns, in the memory space of the arrays of the equation. The view has
 *  dim, n and dp; it has no arrays. On a device the call does not wait.
 *  @param rows    defined by MPS_ROWS(): row i writes entries of row i only
 *  @param fields  numbers and arrays, no pointers to other structs: rows->bytes bytes, copied */
MPS_API void mps_ppe_rows(const mps_ppe_problem *problem, const mps_rows *rows, const void *fields);

/** Sums over the unknowns of all ranks, with the same bytes for any number of threads and ranks,
 *  and on a device (mps/exact.h). On a device the call waits for the result.
 *  @param count  1..4 @param add  defined by MPS_SUMS() @param sums  [count] out
 *  @return 0, or non-zero: another count, the device or another rank failed */
MPS_API int mps_ppe_sum(const mps_ppe_problem *problem, int32_t count, const mps_sums *add,
                        const void *fields, double *sums);

/** Maxima over the unknowns of all ranks; NaN is ignored. @param maxima  [count] out; -INFINITY
 *  without unknowns @return as mps_ppe_sum() */
MPS_API int mps_ppe_max(const mps_ppe_problem *problem, int32_t count, const mps_sums *raise,
                        const void *fields, double *maxima);

/** Why a solver stopped. */
enum {
    /** Both limits are met. */
    MPS_PPE_CONVERGED = 0,
    /** p is the best iterate; residual and divergence are its errors. */
    MPS_PPE_MAX_ITERATIONS = 1,
    /** Negative curvature: matrix or preconditioner is not positive definite. */
    MPS_PPE_INDEFINITE = 2,
    /** NaN or infinity in matrix, right-hand side or result. */
    MPS_PPE_NAN = 3,
    /** Factorisation or recurrence failed. */
    MPS_PPE_BREAKDOWN = 4,
    /** An allocation failed. */
    MPS_PPE_NOMEM = 5
};

/** Result of a solver. Owned and initialised by the caller of the solver: a solver sets single
 *  members and does not change struct_size. */
typedef struct mps_ppe_result {
    /** Set by mps_ppe_result_init(), or sizeof(mps_ppe_result). */
    uint32_t struct_size;
    /** MPS_PPE_... */
    int32_t reason;
    /** 0 for a direct solver */
    int32_t iterations;
    /** Kept 0. */
    int32_t reserved;
    /** True relative 2-norm |b - A p| / |b|. */
    double residual;
    /** True maximum of |(b - A p)_i weight_i|. */
    double divergence;
    /** Time of factorisation and preconditioner setup [s]. */
    double setup_seconds;
} mps_ppe_result;

/** Set struct_size and zero. @param size  sizeof(mps_ppe_result) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_ppe_result_init(mps_ppe_result *result, size_t size);

/** A preconditioner z = M^-1 r. */
typedef struct mps_preconditioner_ops {
    /** sizeof(mps_preconditioner_ops) */
    uint32_t struct_size;
    /** MPS_PPE_API */
    uint32_t api;
    /** e.g. "jacobi" */
    const char *name;
    /** 1: M is symmetric positive definite (conjugate gradients need it) */
    int32_t symmetric;
    /** Create a state in *self; on entry *self is `user`, which it may remain. Allocates from
     *  `allocator`. Non-zero: out of memory. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Set up for a matrix. `problem` is valid until the last apply.
     *  @return MPS_PPE_CONVERGED, or a reason of failure */
    int (*setup)(void *self, const mps_ppe_problem *problem);
    /** z = M^-1 r, both [n]. @return as setup */
    int (*apply)(void *self, const double *r, double *z);
    /** Frees all memory with the allocator that was passed to create. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Value of *self on entry to create, e.g. settings; default NULL. */
    void *user;
    /** NULL, or one line for lists. */
    const char *help;
    /** 1: supports equations distributed over ranks (mps_ppe_problem.ranks); default 0 */
    int32_t ranks;
    /** 1: supports equations on a device (mps_ppe_problem.device); default 0 */
    int32_t device;
    /** On many ranks: largest distance of the unknowns that it reads from an owned position [dp];
     *  0: the far radius is sufficient. */
    double reach;
    /** NULL, or free the device memory of the state, which may not have any. Called before the
     *  device is detached; setup follows before the next apply. destroy frees device memory too. */
    void (*release_device)(void *self);
    /** NULL, or the name of a registered preconditioner. If a solution fails with this one
     *  (MPS_PPE_INDEFINITE or MPS_PPE_BREAKDOWN), the library solves again with that one and logs a
     *  warning. That one must have `symmetric`, `ranks` and `device` if this one has, and at most
     *  its reach. */
    const char *fallback;
    /** 1: on one rank setup on a device queues loops and does not wait for their results, so that a
     *  solver may call it before it knows whether the iteration has to begin; default 0 */
    int32_t setup_async;
    /** Kept 0. */
    int32_t reserved;
} mps_preconditioner_ops;

/** A solver. The kit of tests/conformance checks all requirements below (solver_kit.h:
 *  kit_check_solver(), kit_check_preconditioner(); link solver_kit.c, solver_systems.c,
 *  solver_ranks.c and kit_engine.c to your program). For every matrix:
 *  - p is finite when solve() returns, also after a failure; iterations is in 0..max_iterations.
 *  - CONVERGED: residual and divergence are within the limits. With CONVERGED and MAX_ITERATIONS
 *    both are correct within 1 % (mps_ppe_check() computes them), and the mean of p over each
 *    singular component is zero.
 *  - An initial guess equal to the solution, up to a constant over a singular component, needs at
 *    most one iteration. A non-finite initial guess is ignored and is no failure. A zero right-hand
 *    side gives p = 0.
 *  - NaN or infinity in matrix, diagonal or right-hand side: MPS_PPE_NAN.
 *  - Too few iterations: MPS_PPE_MAX_ITERATIONS, with a residual of at most 1, the residual of p =
 *    0.
 *  - A tolerance below rounding (1e-18): MPS_PPE_MAX_ITERATIONS with a residual below 1e-10, not a
 *    breakdown and not CONVERGED. A right-hand side with a part in the null space:
 *    MPS_PPE_MAX_ITERATIONS, with the other part solved (residual below 0.9).
 *  - With `symmetric`: a matrix that is not positive definite, or has a negative diagonal entry,
 *    gives MPS_PPE_INDEFINITE.
 *  - Bytes and iterations do not depend on the number of threads; bytes do not depend on systems
 *    that the state solved before.
 *  - MPS_PPE_NOMEM if an allocation fails. destroy() frees all memory.
 *  - Systems with one unknown, with rows without off-diagonal entries, with several components and
 *    with densities of 1000 : 1 (with the default preconditioner) are solved.
 *  - With `ranks` 1: the solutions on two ranks and on one rank agree within 1e-9. */
typedef struct mps_solver_ops {
    /** sizeof(mps_solver_ops) */
    uint32_t struct_size;
    /** MPS_PPE_API */
    uint32_t api;
    /** e.g. "sundials.pcg" */
    const char *name;
    /** Default preconditioner, or NULL if the solver uses none. */
    const char *preconditioner;
    /** 1: needs a symmetric positive definite matrix and preconditioner */
    int32_t symmetric;
    /** Create a state, as mps_preconditioner_ops.create. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Solve. p [n]: in: initial guess; out: solution, finite also after a failure. pc and pc_self
     *  (table and state) are NULL for "none"; pc->setup was not called. `result` is initialised;
     *  set its members. */
    void (*solve)(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                  void *pc_self, double *p, mps_ppe_result *result);
    /** Frees all memory with the allocator that was passed to create. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** 1: also solves problems with nonlinear rows (mps_ppe_problem.law); default 0 */
    int32_t nonlinear;
    /** As mps_preconditioner_ops.user. */
    void *user;
    /** NULL, or one line for lists. */
    const char *help;
    /** 1: supports equations distributed over ranks (mps_ppe_problem.ranks); default 0 */
    int32_t ranks;
    /** As mps_preconditioner_ops.device; then the preconditioner needs it too. */
    int32_t device;
    /** 1: uses mps_ppe_problem.hint. 0: the library waits for the device before a solution that the
     *  hint may refuse. Default 0. */
    int32_t hint;
    /** As mps_preconditioner_ops.release_device; solve follows. */
    void (*release_device)(void *self);
} mps_solver_ops;

/** Register a solver on a handle under its name; the table is copied.
 *  @return MPS_E_ARG (a taken name, a missing entry), MPS_E_VERSION, MPS_E_BUSY */
MPS_API mps_status mps_solver_register(mps_sim *sim, const mps_solver_ops *ops);

/** Register a preconditioner on a handle. @return as mps_solver_register(); MPS_E_NAME: its
 *  fallback is not registered */
MPS_API mps_status mps_preconditioner_register(mps_sim *sim, const mps_preconditioner_ops *ops);

/** Law of a nonlinear row: f(p) = P ln(1 + p/P), with f(0) = 0 and slope 1 there; rising and
 *  concave. Below p = -0.99 P, where almost no gas remains, f is its tangent, so that it is finite
 *  for every p.
 *  @param law    P [Pa]; 0: f(p) = p
 *  @param slope  NULL, or out: f'(p) > 0
 *  @return f(p) [Pa] */
MPS_API double mps_ppe_law(double law, double p, double *slope);

/** Set residual and divergence of `result` to the true values for p, for plug-ins.
 *  @param work    [n] workspace; out: b - A p
 *  @param result  initialised by mps_ppe_result_init()
 *  @return MPS_E_ARG: result is not initialised */
MPS_API mps_status mps_ppe_check(const mps_ppe_problem *problem, const double *p, double *work,
                                 mps_ppe_result *result);

MPS_END_DECLS

#endif
