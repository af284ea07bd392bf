/* SPDX-License-Identifier: BSD-3-Clause */
/* The module that mps and the drivers load for --mpi: all of MPI that they need. */
#include <mps/job.h>
#include <mps/mpi.h>
#include <sched.h>
#include <stdbool.h>
#include <time.h>

enum { MOST_VALUES = 8, BUSY_TURNS = 2000 };

static void end(void *user)
{
    (void)user;
    MPI_Finalize();
}

static mps_status attach(void *user, mps_sim *sim)
{
    (void)user;
    return mps_mpi_attach(sim, MPI_COMM_WORLD);
}

/* Yield the processor to other ranks, which may share it; rank 0 may write files for a while. */
static void rest(int turn)
{
    const struct timespec moment = {.tv_nsec = 50000};
    if (turn < BUSY_TURNS)
        sched_yield();
    else
        nanosleep(&moment, NULL);
}

/* Wait for a message, without limit if seconds is 0. */
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

static int32_t largest(void *user, int32_t count, int32_t *values, double seconds)
{
    /* static: MPI may use them after a return */
    static int32_t given[MOST_VALUES], most[MOST_VALUES];
    MPI_Request request;
    (void)user;
    for (int k = 0; k < count; k++) given[k] = values[k];
    MPI_Iallreduce(given, most, count, MPI_INT32_T, MPI_MAX, MPI_COMM_WORLD, &request);
    if (!wait_for(&request, seconds)) return false;
    for (int k = 0; k < count; k++) values[k] = most[k];
    return true;
}

static void largest_numbers(void *user, int32_t count, double *values)
{
    MPI_Request request;
    (void)user;
    MPI_Iallreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD, &request);
    wait_for(&request, 0);
}

static void end_all(void *user, int32_t code)
{
    (void)user;
    MPI_Abort(MPI_COMM_WORLD, code);
}

mps_status mps_drivers_mpi(mps_job_ranks *ranks);
mps_status mps_drivers_mpi(mps_job_ranks *ranks)
{
    int provided, rank, count;
    if (ranks->struct_size != sizeof *ranks) return MPS_E_VERSION;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    *ranks = (mps_job_ranks){.struct_size = sizeof *ranks,
                             .rank = rank,
                             .count = count,
                             .attach = attach,
                             .largest = largest,
                             .largest_numbers = largest_numbers,
                             .end = end,
                             .abort = end_all};
    return MPS_OK;
}
