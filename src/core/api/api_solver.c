/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of the pressure solver: choice, limits, registration. */
#include "sim.h"

mps_status mps_solver_use(mps_sim *sim, const char *solver, const char *preconditioner)
{
    MPS__SETS(sim);
    return mps__solvers_use(&sim->world.solvers, solver, preconditioner);
}

mps_status mps_solver_limits_set(mps_sim *sim, const mps_solver_limits *limits)
{
    MPS__SETS(sim);
    return mps__solvers_set_limits(&sim->world.solvers, limits);
}

mps_status mps_solver_name(const mps_sim *sim, const char **solver, const char **preconditioner)
{
    if (!sim) return MPS_E_ARG;
    const mps__solvers *s = &sim->world.solvers;
    if (solver) *solver = s->use->name;
    if (preconditioner) *preconditioner = s->pc ? s->pc->name : "none";
    return MPS_OK;
}

mps_status mps_solver_register(mps_sim *sim, const mps_solver_ops *ops)
{
    MPS__SETS(sim);
    return mps__solvers_register(&sim->world.solvers, ops);
}

mps_status mps_preconditioner_register(mps_sim *sim, const mps_preconditioner_ops *ops)
{
    MPS__SETS(sim);
    return mps__solvers_register_preconditioner(&sim->world.solvers, ops);
}
