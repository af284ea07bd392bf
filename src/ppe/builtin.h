/* SPDX-License-Identifier: BSD-3-Clause */
/* The solvers and preconditioners that come with the library. */
#ifndef MPS_PPE_BUILTIN_H
#define MPS_PPE_BUILTIN_H

#include <mps/ppe.h>

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

/* All of them, ended by NULL. */
extern const mps_solver_ops *const mps__builtin_solvers[];
extern const mps_preconditioner_ops *const mps__builtin_preconditioners[];

#endif
