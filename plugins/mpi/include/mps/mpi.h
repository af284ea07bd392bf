/* SPDX-License-Identifier: BSD-3-Clause */
/** @file mpi.h  Plug-in library libmps_mpi: runs one simulation on the ranks of a communicator of
 *  MPI. Recursive coordinate bisection (RCB) of Zoltan partitions space.
 *
 *      MPI_Init(&argc, &argv);
 *      mps_sim_create(&config, &sim);
 *      mps_mpi_attach(sim, MPI_COMM_WORLD);
 *      ... build and step, the same on all ranks ...
 *      mps_sim_destroy(sim);
 *      MPI_Finalize();
 *
 *  If a rank fails, the call of each rank fails with MPS_E_RANKS or its own status, and
 *  mps_sim_error() returns the text of the rank that failed first. A call that waits for other
 *  ranks for more than 300 s fails, and its text names the call; the environment variable
 *  MPS_MPI_WATCHDOG changes this number of seconds. If a process dies, mpirun ends the others.
 *  Zoltan waits inside MPI and allocates with malloc: if memory runs out on a rank during a new
 *  partition, the others may wait forever.
 *
 *  After a failure each rank destroys its handle and may call MPI_Finalize(). MPI then keeps the
 *  resources of pending messages: two communicators per handle, and some memory. */
#ifndef MPS_MPI_H
#define MPS_MPI_H

#include <mpi.h>
#include <mps/ranks.h>

MPS_BEGIN_DECLS

/** Run a handle on all ranks of a communicator. Collective: all ranks call it, before particles,
 *  solids, probes or steps. All ranks destroy the handle before MPI_Finalize(); rank 0 waits in
 *  mps_sim_destroy() for the others. Handles used at the same time in different threads need
 *  MPI_THREAD_MULTIPLE.
 *  @param comm  an intracommunicator; the library duplicates it. The program has called
 *               MPI_Init() or MPI_Init_thread(): MPI_THREAD_FUNNELED is enough if the thread that
 *               called it calls the library
 *  @return MPS_E_PLUGIN (MPI is not running, no memory, wrong communicator or environment), and as
 *          mps_sim_ranks_set(); text in mps_sim_error() */
MPS_API mps_status mps_mpi_attach(mps_sim *sim, MPI_Comm comm);

MPS_END_DECLS

#endif
