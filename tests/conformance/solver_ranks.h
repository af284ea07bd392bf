/* SPDX-License-Identifier: BSD-3-Clause */
/* A solver on one rank and on two, for the kit of solvers. */
#ifndef SOLVER_RANKS_H
#define SOLVER_RANKS_H

#include "solver_kit.h"

enum { KIT_RANKS_TEXT = 1024 };

/* Whether a pair supports several ranks. */
bool kit_ranks_allowed(const mps_solver_ops *solver, const mps_preconditioner_ops *pc);

/* Solve the equations of a small dam break through the library. A pair for several ranks must have
 * the same solution on one rank and on two; the library must refuse other pairs on two ranks.
 * @param solver  NULL: one of the library that accepts the preconditioner @param pc  NULL: none
 * @return whether it failed; `text`: the reason */
bool kit_ranks_failed(const mps_solver_ops *solver, const mps_preconditioner_ops *pc,
                      char text[KIT_RANKS_TEXT]);

#endif
