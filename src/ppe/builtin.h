/* SPDX-License-Identifier: BSD-3-Clause */
/* Built-in solvers and preconditioners. */
#ifndef MPS_PPE_BUILTIN_H
#define MPS_PPE_BUILTIN_H

#include <mps/ppe.h>

extern const mps_solver_ops mps__solver_pcg;
extern const mps_solver_ops mps__solver_bicgstab;
extern const mps_solver_ops mps__solver_gmres;
extern const mps_solver_ops mps__solver_klu;
extern const mps_solver_ops mps__solver_kinsol;
extern const mps_preconditioner_ops mps__preconditioner_jacobi;
extern const mps_preconditioner_ops mps__preconditioner_ic0;
extern const mps_preconditioner_ops mps__preconditioner_auxgrid;

/* All built-in ones, terminated by NULL. The first solver is the default. `user` of a solver,
 * passed in *self to create(): NULL, or the mps__context that logs errors of its library. */
extern const mps_solver_ops *const mps__builtin_solvers[];
extern const mps_preconditioner_ops *const mps__builtin_preconditioners[];

#endif
