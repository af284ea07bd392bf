/* SPDX-License-Identifier: BSD-3-Clause */
/* The solvers and preconditioners that come with the library. */
#ifndef MPS_PPE_BUILTIN_H
#define MPS_PPE_BUILTIN_H

#include <mps/ppe.h>
#include <stdbool.h>

/* Where a solver hands the errors of its library: `user` of its table, which is in *self when create() is called. NULL: nowhere. */
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

/* On a device sundials.pcg solves, with jacobi, auxgrid or no preconditioner, an equation that has
 * no singular component and no law of a gas: mps__solvers_there(). Then p and the arrays of the
 * problem are addresses of the device, and the problem's parallel-for is that of the device; on
 * many ranks each rank has a device of its own. For that the core calls the functions below, besides
 * those of the tables. */

/* What sundials.pcg may count on in its solutions on a device, so that it waits less. */
typedef struct mps__pcg_hint {
    bool ready; /* the set-up of the preconditioner waits for nothing, or is left out */
    /* NULL, or a number of the device that is not known yet. Above -INFINITY, the equation must not be solved: the solver ends before it
     * begins, with MPS_PPE_NAN. */
    const double *doubt;
    bool refused; /* out: it did */
    /* NULL, or queue what is to be known of the pressures once they are found: one number of the device. It may be asked of others before, and
     * changes nothing else that is read. */
    void (*look)(void *owner, double *to);
    void *owner;
    double seen; /* out: that number; NaN: it was not asked of the last pressures */
} mps__pcg_hint;
/* It must live until there is another one, or NULL. */
void mps__pcg_expect(void *self, mps__pcg_hint *hint);
/* What they have on a device is given back; call it before the device is detached. */
void mps__pcg_leave(void *self);
void mps__jacobi_leave(void *self);
void mps__auxgrid_leave(void *self);

/* All of them, ended by NULL. */
extern const mps_solver_ops *const mps__builtin_solvers[];
extern const mps_preconditioner_ops *const mps__builtin_preconditioners[];

#endif
