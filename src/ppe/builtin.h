/* SPDX-License-Identifier: BSD-3-Clause */
/* Built-in solvers and preconditioners. */
#ifndef MPS_PPE_BUILTIN_H
#define MPS_PPE_BUILTIN_H

#include <mps/ppe.h>
#include <stdbool.h>

/* Log of the errors of a solver's library: `user` of its table, passed in *self to create(). NULL:
 * no log. */
typedef struct mps__solver_log {
    void (*warn)(void *user, const char *text);
    void *user;
} mps__solver_log;

extern const mps_solver_ops mps__solver_pcg;
extern const mps_solver_ops mps__solver_bicgstab;
extern const mps_solver_ops mps__solver_gmres;
extern const mps_solver_ops mps__solver_klu;
extern const mps_solver_ops mps__solver_kinsol;
extern const mps_preconditioner_ops mps__preconditioner_jacobi;
extern const mps_preconditioner_ops mps__preconditioner_ic0;
extern const mps_preconditioner_ops mps__preconditioner_auxgrid;

/* On a device sundials.pcg, with jacobi, auxgrid or no preconditioner, solves equations without
 * singular component and without law of a gas: mps__solvers_on_device(). Then p and the arrays of
 * the problem are device addresses, and the problem's parallel-for is that of the device; on many
 * ranks each rank has its own device. The core then also calls the functions below. */

/* Facts about an equation on a device that let sundials.pcg wait less. */
typedef struct mps__pcg_hint {
    bool ready; /* the set-up of the preconditioner does not wait, or is skipped */
    /* NULL, or a number on the device that is not known yet. If it is above -INFINITY, the equation
     * must not be solved: the solver ends at once with MPS_PPE_NAN. */
    const double *doubt;
    bool refused; /* out: whether `doubt` ended the solution */
    /* NULL, or queue a reduction over the final pressures to one number on the device. It may be
     * called for earlier pressures too, and changes no other data that is read. */
    void (*look)(void *owner, double *to);
    void *owner;
    double seen; /* out: that number; NaN: not computed for the final pressures */
} mps__pcg_hint;
/* The hint must stay valid until the next call, which may pass NULL. */
void mps__pcg_expect(void *self, mps__pcg_hint *hint);
/* Free device memory; call it before the device is detached. */
void mps__pcg_release_device(void *self);
void mps__jacobi_release_device(void *self);
void mps__auxgrid_release_device(void *self);

/* All built-in ones, terminated by NULL. */
extern const mps_solver_ops *const mps__builtin_solvers[];
extern const mps_preconditioner_ops *const mps__builtin_preconditioners[];

#endif
