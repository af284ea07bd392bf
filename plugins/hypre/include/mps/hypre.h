/* SPDX-License-Identifier: BSD-3-Clause */
/** @file hypre.h  Pressure solver "hypre.boomeramg" of the plug-in library libmps_hypre: conjugate
 *  gradients with the algebraic multigrid of hypre as preconditioner. It shares no code with the
 *  built-in solvers, so that they can be checked against it.
 *
 *  hypre needs MPI. If MPI is not running, the library starts it for this process alone and ends it
 *  with the program. A program that uses MPI itself starts it before the first call of this library
 *  and ends it after its last simulation is destroyed. hypre has one state for the whole process:
 *  only one handle at a time may step with this solver. hypre allocates with malloc and aborts the
 *  program if memory runs out.
 *
 *  One simulation on many ranks (mps_mpi_attach()) needs the communicator in
 *  mps_hypre_settings.comm:
 *
 *      MPI_Comm comm = MPI_COMM_WORLD;
 *      mps_mpi_attach(sim, comm);
 *      settings.comm = &comm;
 *      mps_hypre_register(sim, &settings);
 *
 *  All ranks make these calls with the same settings. The last digits of the pressures then depend
 *  on the number of ranks and on the cuts between them. hypre waits inside MPI: if a rank fails or
 *  dies there, the others may wait forever. */
#ifndef MPS_HYPRE_H
#define MPS_HYPRE_H

#include <mps/ppe.h>

MPS_BEGIN_DECLS

/** Settings of BoomerAMG; methods have the numbers of hypre's manual. Initialise it with
 *  mps_hypre_settings_init(). */
typedef struct mps_hypre_settings {
    /** Set by mps_hypre_settings_init(). */
    uint32_t struct_size;
    /** 0..22; default 8: PMIS. */
    int32_t coarsening;
    /** 0..18; default 6: extended+i. */
    int32_t interpolation;
    /** Largest number of entries of an interpolation row, 0..100; 0: any number; default 4. */
    int32_t row_entries;
    /** A symmetric relaxation: 6, 7, 8, 16 or 18; default 18: l1-Jacobi. */
    int32_t relaxation;
    /** Relaxations before and after each coarse grid, 1..16; default 1. */
    int32_t sweeps;
    /** Finest levels that are coarsened twice, 0..25; default 1. */
    int32_t aggressive_levels;
    /** Smallest strength of a strong connection, 0 <= threshold < 1; default 0.5. */
    double threshold;
    /** NULL, or buffer for the text of a failed call of this library. */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
    /** NULL: MPI_COMM_SELF, for simulations on one rank. Otherwise points to an MPI_Comm whose
     *  ranks are those of the simulation, in the same order. hypre uses this
     *  communicator itself: it must stay valid until the handle is destroyed. */
    const void *comm;
} mps_hypre_settings;

/** Set every entry to its default. @param size  sizeof(mps_hypre_settings)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_hypre_settings_init(mps_hypre_settings *settings, size_t size);

/** Table of the solver, for mps_solver_register() or to be called directly. Starts MPI if it is not
 *  running. The solver fails with MPS_PPE_BREAKDOWN if the ranks of an equation are not those of
 *  settings->comm.
 *  @param settings  NULL for the defaults; otherwise borrowed, and read when mps_solver_use()
 *                   creates a state
 *  @param ops       out
 *  @return MPS_E_ARG (which setting is wrong, and what is allowed), MPS_E_VERSION, MPS_E_STATE if
 *          MPI has ended already or does not start; text in settings->error */
MPS_API mps_status mps_hypre_solver(const mps_hypre_settings *settings, mps_solver_ops *ops);

/** Register "hypre.boomeramg" on a handle. mps_solver_use(sim, "hypre.boomeramg", NULL) then
 *  chooses it.
 *  @param settings  as for mps_hypre_solver(); must stay valid until the handle is destroyed
 *  @return as mps_hypre_solver() and mps_solver_register(); MPS_E_STATE if the ranks of the handle
 *          are not those of settings->comm, e.g. because mps_mpi_attach() is called later */
MPS_API mps_status mps_hypre_register(mps_sim *sim, const mps_hypre_settings *settings);

MPS_END_DECLS

#endif
