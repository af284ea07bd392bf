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

/* On a device sundials.pcg solves with either of jacobi and auxgrid, or alone, an equation of one rank whose components are not singular:
 * arrays of the problem and p are there, and so is its parallel-for.
 * What they have on a device is given back; call it before the device is detached. */
void mps__pcg_leave(void *self);
void mps__jacobi_leave(void *self);
void mps__auxgrid_leave(void *self);

/* All of them, ended by NULL. */
extern const mps_solver_ops *const mps__builtin_solvers[];
extern const mps_preconditioner_ops *const mps__builtin_preconditioners[];

#endif
