/* SPDX-License-Identifier: BSD-3-Clause */
/* List of built-in solvers and preconditioners; the registry reads it when a handle is created. */
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
