/* SPDX-License-Identifier: BSD-3-Clause */
/* The ranks of a run with --mpi. A driver without --mpi is rank 0 of one, and all calls here return at once.
 *
 * All ranks build the same case and make the same calls of the library. Rank 0 alone has files, and decides what is written when; the others
 * learn it by ranks_most(). */
#ifndef MPS_EXAMPLES_RANKS_H
#define MPS_EXAMPLES_RANKS_H

#include <mps/mps.h>
#include <stdbool.h>
#include <stdio.h>

/* What the module of the drivers for MPI, examples/mpi, does for ranks.c. Its one symbol is `mps_drivers_mpi`. */
typedef struct ranks_engine {
    void (*begin)(int *rank, int *count);
    void (*end)(void);
    mps_status (*attach)(mps_sim *sim);
    /* Largest of each value over all ranks. @return false: not all ranks came within so many seconds; 0: wait for ever */
    bool (*largest)(int count, int *values, double seconds);
    /* The same of numbers, and it waits for ever. */
    void (*largest_numbers)(int count, double *values);
    void (*abort)(int code);
} ranks_engine;

/* Look for --mpi and begin with MPI before anything is printed. Exits with a message if that cannot be, or if mpirun started several
 * processes without --mpi. @return whether the run is one of MPI */
bool ranks_begin(const char *program, int argc, char **argv);
/* This is rank 0. */
bool ranks_first(void);
int ranks_count(void);
/* Largest value of all ranks. All ranks make this call; it does not return where one of them exits instead. */
int ranks_most(int value);
/* The same for each of some numbers. */
void ranks_largest(int count, double *values);
/* A value that rank 0 decides; what the others give does not count. Values are not negative. */
int ranks_told(int value);
/* Where messages go: stderr of rank 0. Others keep theirs, which are shown if rank 0 has none. */
FILE *ranks_messages(void);
/* The simulation runs on the ranks; it is destroyed by ranks_detach() or when the program exits. */
mps_status ranks_attach(mps_sim *sim);
void ranks_detach(void);
/* exit() on all ranks: others do so in their next ranks_most(), or are ended if they do not come to one. */
_Noreturn void ranks_exit(int code);

/* Particles of all ranks at rank 0, until ranks_gather_end(), which is allowed after a failure as well. */
bool ranks_gather(mps_sim *sim);
void ranks_gather_end(mps_sim *sim);

#endif
