/* SPDX-License-Identifier: BSD-3-Clause */
/* The module that the drivers load for --mpi: all that they ask of MPI. */
#include "common/ranks.h"
#include <mps/mpi.h>
#include <sched.h>
#include <time.h>

enum { MOST_VALUES = 8, BUSY_TURNS = 2000 };

static void begin(int *rank, int *count)
{
    int provided;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, count);
}

static void end(void)
{
    MPI_Finalize();
}

static mps_status attach(mps_sim *sim)
{
    return mps_mpi_attach(sim, MPI_COMM_WORLD);
}

/* Leave the processor to other ranks, which may share it; rank 0 may be writing for a while. */
static void rest(int turn)
{
    const struct timespec moment = {.tv_nsec = 50000};
    if (turn < BUSY_TURNS)
        sched_yield();
    else
        nanosleep(&moment, NULL);
}

/* Wait for a message, for ever if seconds is 0. */
static bool wait_for(MPI_Request *request, double seconds)
{
    const double start = MPI_Wtime();
    int done = 0;
    for (int turn = 0; !done; turn += turn < BUSY_TURNS) {
        MPI_Test(request, &done, MPI_STATUS_IGNORE);
        if (!done && seconds > 0 && MPI_Wtime() - start > seconds) return false;
        if (!done) rest(turn);
    }
    return true;
}

static bool largest(int count, int *values, double seconds)
{
    static int given[MOST_VALUES], most[MOST_VALUES]; /* MPI may use them after a return */
    MPI_Request request;
    for (int k = 0; k < count; k++) given[k] = values[k];
    MPI_Iallreduce(given, most, count, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &request);
    if (!wait_for(&request, seconds)) return false;
    for (int k = 0; k < count; k++) values[k] = most[k];
    return true;
}

static void largest_numbers(int count, double *values)
{
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD, &request);
    wait_for(&request, 0);
}

static void end_all(int code)
{
    MPI_Abort(MPI_COMM_WORLD, code);
}

extern const ranks_engine mps_drivers_mpi;
const ranks_engine mps_drivers_mpi = {begin, end, attach, largest, largest_numbers, end_all};
