/* SPDX-License-Identifier: BSD-3-Clause */
/** @file ppe.h  Plug-in interface of pressure solvers and preconditioners.
 *
 *  The system is A p = b: row i is sum_j k_ij (p_i - p_j) + s_i p_i = b_i with k_ij = k_ji, s_i >= 0. A is symmetric positive
 *  (semi-)definite for the default models. Rows of a gas may be nonlinear: A p + gas (f(p) - p) = b, f by mps_ppe_law(); A holds
 *  their linear part, so gas_i <= s_i. Built-in solvers use this interface and no other. */
#ifndef MPS_PPE_H
#define MPS_PPE_H

#include <mps/parallel.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_solver_ops.api and mps_preconditioner_ops.api. */
#define MPS_PPE_API 1u

/** One pressure equation; all arrays are borrowed for the duration of the call. */
typedef struct mps_ppe_problem {
    uint32_t struct_size;     /**< sizeof(mps_ppe_problem) */
    int32_t dim;              /**< 2 or 3 */
    int64_t n;                /**< unknowns */
    const int64_t *row;       /**< [n+1] CSR row starts of the entries beside the diagonal */
    const int32_t *col;       /**< [row[n]] columns, ascending in a row */
    const float *val;         /**< [row[n]] -k_ij: half the memory traffic of doubles; entries ij and ji are equal */
    const double *diagonal;   /**< [n] s_i + sum_j k_ij of the entries as they are stored, so that rows keep their sum */
    const double *rhs;        /**< [n]; already free of the null space when components are singular */
    const double *shift;      /**< [n] s_i: the row sums */
    const double *weight;     /**< [n] residual times weight = divergence times dt */
    const double *x;          /**< [n*dim] positions of the unknowns [m] */
    double dp;                /**< particle spacing [m] */
    double tolerance;         /**< relative 2-norm of the residual wanted */
    double divergence;        /**< largest |residual * weight| wanted; 0: not asked */
    int32_t max_iterations;   /**< at most */
    int32_t components;       /**< singular components (no Dirichlet row, no shift) */
    const int32_t *component; /**< [n] 0..components-1 of a singular one, else -1; NULL if there is none */
    const double *gas;        /**< [n] >= 0, coefficient of a nonlinear row; NULL if there is no nonlinear row */
    const double *law;        /**< [n] P_i > 0 of a nonlinear row [Pa], 0 of a linear one; NULL with gas */
    /** Threads to use; NULL: the calling thread. Valid as long as the matrix. */
    const mps_parallel *parallel;
} mps_ppe_problem;

/** Why a solver stopped. */
enum {
    MPS_PPE_CONVERGED = 0,      /**< both tolerances met */
    MPS_PPE_MAX_ITERATIONS = 1, /**< best effort in p, residual as reported */
    MPS_PPE_INDEFINITE = 2,     /**< met a direction of negative curvature: matrix or preconditioner is not positive definite */
    MPS_PPE_NAN = 3,            /**< NaN or infinity in matrix, right side or result */
    MPS_PPE_BREAKDOWN = 4,      /**< factorisation or recurrence failed */
    MPS_PPE_NOMEM = 5           /**< an allocation failed */
};

/** What a solver reports. */
typedef struct mps_ppe_result {
    int32_t reason;       /**< MPS_PPE_... */
    int32_t iterations;   /**< 0 for a direct solver */
    double residual;      /**< true relative 2-norm |b - A p| / |b| */
    double divergence;    /**< true largest |(b - A p)_i weight_i| */
    double setup_seconds; /**< factorisation, preconditioner */
} mps_ppe_result;

/** A preconditioner z = M^-1 r. */
typedef struct mps_preconditioner_ops {
    uint32_t struct_size; /**< sizeof(mps_preconditioner_ops) */
    uint32_t api;         /**< MPS_PPE_API */
    const char *name;     /**< e.g. "jacobi" */
    int32_t symmetric;    /**< 1: M is symmetric positive definite (conjugate gradients need it) */
    /** New state in *self (may stay `user`). Non-zero: out of memory. Memory comes from `allocator`. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Prepare for a matrix, which stays valid until the last apply. @return MPS_PPE_CONVERGED, or a reason of failure */
    int (*setup)(void *self, const mps_ppe_problem *problem);
    /** z = M^-1 r, both [n]. @return as setup */
    int (*apply)(void *self, const double *r, double *z);
    void (*destroy)(void *self); /**< gives back all memory */
    void *user;                  /**< what *self holds when create is called, e.g. settings; default NULL */
    const char *help;            /**< NULL, or one line for lists */
} mps_preconditioner_ops;

/** A solver. What is demanded of it, with every matrix; the kit of tests/conformance checks a table for all of this (solver_kit.h:
 *  kit_check_solver(), kit_check_preconditioner(); link solver_kit.c and solver_systems.c to a program of your own):
 *  - p is finite when solve() returns, also after a failure; iterations are 0..max_iterations.
 *  - CONVERGED says that residual and divergence are within the limits. With it and with MAX_ITERATIONS both are true to 1 %
 *    (mps_ppe_check() fills them), and p has the mean zero over each singular component.
 *  - A first guess that is the solution costs at most one iteration, whatever its level over a singular component. A guess that is not
 *    finite is not used, and is no failure. A right side of zeros gives zeros.
 *  - NaN or infinity in matrix, diagonal or right side: MPS_PPE_NAN.
 *  - Too few iterations: MPS_PPE_MAX_ITERATIONS, with a residual not worse than that of zeros, which is 1.
 *  - A tolerance below rounding (1e-18) ends as MPS_PPE_MAX_ITERATIONS with a residual below 1e-10: neither as a breakdown nor as
 *    converged. A right side that is not free of the null space ends so too, with the rest solved (residual below 0.9).
 *  - With `symmetric`: a matrix that is not positive definite, or has a negative diagonal entry, gives MPS_PPE_INDEFINITE.
 *  - The same bytes and iterations with any number of threads; the same bytes from a state that solved other systems before.
 *  - MPS_PPE_NOMEM when an allocation fails. destroy() gives all memory back.
 *  - One unknown, rows without entries beside the diagonal, several components and densities of 1000 : 1 (with the default
 *    preconditioner) are solved. */
typedef struct mps_solver_ops {
    uint32_t struct_size;       /**< sizeof(mps_solver_ops) */
    uint32_t api;               /**< MPS_PPE_API */
    const char *name;           /**< e.g. "sundials.pcg" */
    const char *preconditioner; /**< default preconditioner, or NULL if it uses none */
    int32_t symmetric;          /**< 1: needs a symmetric positive definite matrix and preconditioner */
    /** New state in *self, as for a preconditioner. */
    int (*create)(const mps_allocator *allocator, void **self);
    /** Solve. p [n] holds the first guess and takes the solution. pc (ops, state) is NULL for "none"; its setup has not
     *  been called. Must fill `result`; p stays finite whatever happens. */
    void (*solve)(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc, void *pc_self, double *p,
                  mps_ppe_result *result);
    void (*destroy)(void *self); /**< gives back all memory */
    int32_t nonlinear;           /**< 1: solves problems with nonlinear rows (mps_ppe_problem.law) too; default 0 */
    void *user;                  /**< as for a preconditioner */
    const char *help;            /**< NULL, or one line for lists */
} mps_solver_ops;

/** Register a solver on a handle under its name; the table is copied. @return MPS_E_ARG for a taken name or a missing entry */
MPS_API mps_status mps_solver_register(mps_sim *sim, const mps_solver_ops *ops);

/** Register a preconditioner on a handle. */
MPS_API mps_status mps_preconditioner_register(mps_sim *sim, const mps_preconditioner_ops *ops);

/** Law of a nonlinear row: f(p) = P ln(1 + p/P), which has f(0) = 0 and the slope 1 there; rising and concave. Below p = -0.99 P, where
 *  next to no gas is left, it goes on along its tangent, so that it is finite for every p.
 *  @param law    P [Pa]; 0: f(p) = p
 *  @param slope  NULL, or out: f'(p) > 0
 *  @return f(p) [Pa] */
MPS_API double mps_ppe_law(double law, double p, double *slope);

/** Check of a solution, for plug-ins: fills residual and divergence of `result` with the true values for p.
 *  @param work [n] scratch, holds b - A p afterwards */
MPS_API void mps_ppe_check(const mps_ppe_problem *problem, const double *p, double *work, mps_ppe_result *result);

MPS_END_DECLS

#endif
