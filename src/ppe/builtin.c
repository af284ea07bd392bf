/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of built-in solvers and preconditioners; the registry goes through it at the creation of a handle. */
#include "builtin.h"
#include <stddef.h>

const mps_solver_ops *const mps__builtin_solvers[] = {
    &mps__solver_pcg, &mps__solver_bicgstab, &mps__solver_gmres,
    &mps__solver_klu, &mps__solver_kinsol,   NULL,
};

const mps_preconditioner_ops *const mps__builtin_preconditioners[] = {
    &mps__preconditioner_jacobi,
    &mps__preconditioner_ic0,
    &mps__preconditioner_auxgrid,
    NULL,
};
