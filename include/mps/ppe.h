/* SPDX-License-Identifier: BSD-3-Clause */
/** @file ppe.h  Plug-in interface of pressure solvers and preconditioners.
 *
 *  The system is A p = b: row i is sum_j k_ij (p_i - p_j) + s_i p_i = b_i with k_ij = k_ji, s_i >=
 *  0. A is symmetric positive (semi-)definite for the default models. Rows of a gas may be
 *  nonlinear: A p + gas (f(p) - p) = b, f by mps_ppe_law(). A holds their linear part, so gas_i <=
 *  s_i. Built-in solvers and preconditioners have this interface, too. Equations on a device
 *  (<mps/device.h>) are for those built-in ones alone that mps_sim_device_set() names. */
#ifndef MPS_PPE_H
#define MPS_PPE_H

#include <mps/exact.h>
#include <mps/parallel.h>
#include <mps/ranks.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_solver_ops.api and mps_preconditioner_ops.api. */
#define MPS_PPE_API 1u

/** An equation whose rows lie on several ranks. Each rank has `n` rows. Columns n..n+ghosts-1 are
 *  unknowns of other ranks. All ranks make the same calls in the same order. */
typedef struct mps_ppe_ranks {
    /** sizeof(mps_ppe_ranks) of the library */
    uint32_t struct_size;
    /** Number of this rank. */
    int32_t rank;
    /** Number of ranks. */
    int32_t ranks;
    /** Kept 0. */
    int32_t reserved;
    /** Columns of unknowns of other ranks. */
    int64_t ghosts;
    /** Rows of all ranks. */
    int64_t rows;
    /** Rows of the ranks before this one: the number of row 0 among all rows. */
    int64_t first;
    /** [n + ghosts] columns in the order of the particles, which is the same on all ranks that have
     *  them */
    const int32_t *order;
    /** Ranks that own places [m*dim] of the lab: a function of the place, the same on all ranks. A
     *  column of a particle within reach of an owned place is here. Non-zero: failed. */
    int (*owner)(void *host, int64_t m, const double *x, int32_t *rank);
    /** Set x[n..n+ghosts-1] to the values that the owners have in x[0..n-1]. Non-zero: failed. */
    int (*share)(void *host, double *x);
    /** Combine values of all ranks, as mps_ranks_ops.reduce. Non-zero: failed. */
    int (*reduce)(void *host, int32_t count, size_t bytes, void *values, mps_combine_fn combine);
    /** Collect blocks of all ranks, as mps_ranks_ops.gather. Non-zero: failed. */
    int (*gather)(void *host, const void *own, const int64_t *bytes, void *all);
    /** Make a route between ranks, as mps_ranks_ops.connect. Non-zero: failed, there is none. */
    int (*connect)(void *host, int32_t count, const int32_t *to, const int64_t *sent,
                   mps_route *route);
    /** Free a route. A solver or preconditioner may keep one until its next set-up or until it is
     *  destroyed. Not collective. */
    void (*disconnect)(void *host, mps_route *route);
    /** Exchange elements along a route, as mps_ranks_ops.exchange_begin and exchange_end. Non-zero:
     *  failed. */
    int (*exchange)(void *host, const mps_route *route, size_t bytes, const void *out, void *in);
    /** First argument of these functions. */
    void *host;
} mps_ppe_ranks;

/** One pressure equation, made by the library; all arrays are borrowed for the call. */
typedef struct mps_ppe_problem {
    /** sizeof(mps_ppe_problem) of the library */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** Unknowns. */
    int64_t n;
    /** [n+1] CSR row starts of the entries beside the diagonal */
    const int64_t *row;
    /** [row[n]] columns, ascending in a row; on many ranks in the order of the particles, and those
     *  of other ranks are n and above */
    const int32_t *col;
    /** [row[n]] -k_ij in single precision, for half the memory traffic; entries ij and ji are
     *  equal. */
    const float *val;
    /** [n] s_i + sum_j k_ij of the entries as they are stored, so that rows keep their sum */
    const double *diagonal;
    /** [n] right side; free of the null space where components are singular */
    const double *rhs;
    /** [n] s_i: the row sums */
    const double *shift;
    /** [n] residual times weight = divergence times dt */
    const double *weight;
    /** [n*dim] positions of the unknowns less the displacement of the tank [m], so that a solution
     *  does not depend on a uniform motion; on many ranks [(n + ghosts)*dim] */
    const double *x;
    /** Particle spacing [m]. */
    double dp;
    /** Relative 2-norm of the residual wanted. */
    double tolerance;
    /** Largest |residual * weight| wanted; 0: no limit. */
    double divergence;
    /** Most iterations. */
    int32_t max_iterations;
    /** Singular components (no Dirichlet row, no shift). */
    int32_t components;
    /** [n] 0..components-1 of a singular component, else -1; NULL if there is none */
    const int32_t *component;
    /** [n] >= 0, coefficient of a nonlinear row; NULL if there is no nonlinear row */
    const double *gas;
    /** [n] P_i > 0 of a nonlinear row [Pa], 0 of a linear one; NULL with gas */
    const double *law;
    /** Threads to use; NULL: the calling thread. Valid as long as the matrix. */
    const mps_parallel *parallel;
    /** NULL: all rows are here. Otherwise arrays of unknowns that are multiplied by the matrix need
     *  room for n + ghosts values. */
    const mps_ppe_ranks *ranks;
} mps_ppe_problem;

/** Set the values of x at columns of other ranks; does nothing where all rows are here.
 *  @param x  [n + ghosts] @return 0, or non-zero after a failure */
static inline int mps_ppe_share(const mps_ppe_problem *problem, double *x)
{
    return problem->ranks ? problem->ranks->share(problem->ranks->host, x) : 0;
}

/** Combine values of all ranks; does nothing where all rows are here. @return as mps_ppe_share() */
static inline int mps_ppe_reduce(const mps_ppe_problem *problem, int32_t count, size_t bytes,
                                 void *values, mps_combine_fn combine)
{
    return problem->ranks
               ? problem->ranks->reduce(problem->ranks->host, count, bytes, values, combine)
               : 0;
}

/** Sums and maxima over the rows of all ranks, from those of this rank, in one message: at most 4
 *  of each. @return as mps_ppe_share() */
MPS_API int mps_ppe_total(const mps_ppe_problem *problem, const mps_exact_values *values);

/** Why a solver stopped. */
enum {
    /** Both limits are met. */
    MPS_PPE_CONVERGED = 0,
    /** Best effort in p; residual and divergence tell how good. */
    MPS_PPE_MAX_ITERATIONS = 1,
    /** Negative curvature: matrix or preconditioner is not positive definite. */
    MPS_PPE_INDEFINITE = 2,
    /** NaN or infinity in matrix, right side or result. */
    MPS_PPE_NAN = 3,
    /** Factorisation or recurrence failed. */
    MPS_PPE_BREAKDOWN = 4,
    /** An allocation failed. */
    MPS_PPE_NOMEM = 5
};

/** What a solver reports. It belongs to the caller of the solver, which initialises it: a solver
 *  sets members, one by one, and leaves struct_size alone. */
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
    /** True largest |(b - A p)_i weight_i|. */
    double divergence;
    /** Time for factorisation and preconditioner [s]. */
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
    /** New state in *self, which holds `user` before and may keep it. Memory comes from
     *  `allocator`. Non-zero: out of memory. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Prepare for a matrix, which stays valid until the last apply.
     *  @return MPS_PPE_CONVERGED, or a reason of failure */
    int (*setup)(void *self, const mps_ppe_problem *problem);
    /** z = M^-1 r, both [n]. @return as setup */
    int (*apply)(void *self, const double *r, double *z);
    /** Gives back all memory to the allocator that create was given. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** What *self holds when create is called, e.g. settings; default NULL. */
    void *user;
    /** NULL, or one line for lists. */
    const char *help;
    /** 1: works on equations whose rows lie on several ranks (mps_ppe_problem.ranks); default 0 */
    int32_t ranks;
    /** Kept 0. */
    int32_t reserved;
    /** On many ranks: farthest distance from an owned place of unknowns that it looks at [dp]; 0:
     *  the far radius is enough. */
    double reach;
} mps_preconditioner_ops;

/** A solver. The kit of tests/conformance checks a table for all demands below (solver_kit.h:
 *  kit_check_solver(), kit_check_preconditioner(); link solver_kit.c, solver_systems.c,
 *  solver_ranks.c and kit_engine.c to your program). With every matrix:
 *  - p is finite when solve() returns, also after a failure; iterations are 0..max_iterations.
 *  - CONVERGED: residual and divergence are within the limits. With CONVERGED and with
 *    MAX_ITERATIONS both are true to 1 % (mps_ppe_check() fills them), and p has the mean zero over
 *    each singular component.
 *  - A first guess that is the solution costs at most one iteration, whatever its level over a
 *    singular component. A first guess that is not finite is not used, and is no failure. A right
 *    side of zeros gives zeros.
 *  - NaN or infinity in matrix, diagonal or right side: MPS_PPE_NAN.
 *  - Too few iterations: MPS_PPE_MAX_ITERATIONS, with a residual not above 1, that of zeros.
 *  - A tolerance below rounding (1e-18): MPS_PPE_MAX_ITERATIONS with a residual below 1e-10, not a
 *    breakdown and not CONVERGED. A right side that is not free of the null space: likewise, with
 *    the rest solved (residual below 0.9).
 *  - With `symmetric`: a matrix that is not positive definite, or has a negative diagonal entry,
 *    gives MPS_PPE_INDEFINITE.
 *  - The same bytes and iterations with any number of threads; the same bytes from a state that
 *    solved other systems before.
 *  - MPS_PPE_NOMEM when an allocation fails. destroy() gives back all memory.
 *  - One unknown, rows without entries beside the diagonal, several components and densities of
 *    1000 : 1 (with the default preconditioner) are solved.
 *  - With `ranks` 1: the solution on two ranks is that on one, within 1e-9. */
typedef struct mps_solver_ops {
    /** sizeof(mps_solver_ops) */
    uint32_t struct_size;
    /** MPS_PPE_API */
    uint32_t api;
    /** e.g. "sundials.pcg" */
    const char *name;
    /** Default preconditioner, or NULL if it uses none. */
    const char *preconditioner;
    /** 1: needs a symmetric positive definite matrix and preconditioner */
    int32_t symmetric;
    /** New state in *self, as for a preconditioner. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Solve. p [n] holds the first guess and takes the solution; it stays finite whatever happens.
     *  pc and pc_self (table and state) are NULL for "none"; pc->setup was not called. `result` is
     *  initialised; set its members. */
    void (*solve)(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                  void *pc_self, double *p, mps_ppe_result *result);
    /** Gives back all memory to the allocator that create was given. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** 1: solves problems with nonlinear rows (mps_ppe_problem.law) too; default 0 */
    int32_t nonlinear;
    /** As for a preconditioner. */
    void *user;
    /** NULL, or one line for lists. */
    const char *help;
    /** 1: works on equations whose rows lie on several ranks (mps_ppe_problem.ranks); default 0 */
    int32_t ranks;
} mps_solver_ops;

/** Register a solver on a handle under its name; the table is copied.
 *  @return MPS_E_ARG (a taken name, a missing entry), MPS_E_VERSION, MPS_E_BUSY */
MPS_API mps_status mps_solver_register(mps_sim *sim, const mps_solver_ops *ops);

/** Register a preconditioner on a handle. @return as mps_solver_register() */
MPS_API mps_status mps_preconditioner_register(mps_sim *sim, const mps_preconditioner_ops *ops);

/** Law of a nonlinear row: f(p) = P ln(1 + p/P), with f(0) = 0 and slope 1 there; rising and
 *  concave. Below p = -0.99 P, where hardly any gas is left, f continues along its tangent, so that
 *  it is finite for every p.
 *  @param law    P [Pa]; 0: f(p) = p
 *  @param slope  NULL, or out: f'(p) > 0
 *  @return f(p) [Pa] */
MPS_API double mps_ppe_law(double law, double p, double *slope);

/** Set residual and divergence of `result` to the true values for p, for plug-ins.
 *  @param work    [n] scratch, holds b - A p afterwards
 *  @param result  initialised by mps_ppe_result_init()
 *  @return MPS_E_ARG: result is not initialised */
MPS_API mps_status mps_ppe_check(const mps_ppe_problem *problem, const double *p, double *work,
                                 mps_ppe_result *result);

MPS_END_DECLS

#endif
