/* SPDX-License-Identifier: BSD-3-Clause */
/* A communication module without MPI, for single programs with --mpi: TEST_RANKS is "rank count
 * code heard". With two ranks the other one is simulated: it ends with this exit code when the
 * ranks agree, -1: it continues; heard 0: it does not respond to a rank that ends. Requests of the
 * program to the ranks are printed to stderr. */
#include <mps/job.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>

/* Values of ranks that agree, and of a rank that ends; see mps.c and mps_job_ranks_exit(). */
enum { AGREE = 2, LEAVE = 3 };

static int rank, count = 1, code = -1, heard = 1;

static mps_status attach(void *user, mps_sim *sim)
{
    (void)user;
    return sim ? MPS_OK : MPS_E_ARG;
}

static void raise_to(int32_t *value, int32_t other)
{
    if (*value < other) *value = other;
}

static int32_t largest(void *user, int32_t values, int32_t *value, double seconds)
{
    (void)user;
    if (count == 1) return 1;
    if (values == AGREE) {
        raise_to(&value[0], code + 1);
        raise_to(&value[1], code >= 0 ? count - (1 - rank) : 0);
    } else if (values == LEAVE && seconds > 0)
        fprintf(stderr, "rank %d leaves with %d\n", rank, (int)value[1] - 1);
    return heard || seconds == 0;
}

static void largest_numbers(void *user, int32_t values, double *value)
{
    (void)user, (void)values, (void)value;
}

static void end(void *user)
{
    (void)user;
    fputs("messages end\n", stderr);
}

static void end_all(void *user, int32_t with)
{
    (void)user;
    fprintf(stderr, "all ranks end with %d\n", (int)with);
    exit(with);
}

MPS_API mps_status mps_drivers_mpi(mps_job_ranks *ranks);
mps_status mps_drivers_mpi(mps_job_ranks *ranks)
{
    const char *text = getenv("TEST_RANKS");
    if (ranks->struct_size != sizeof *ranks) return MPS_E_VERSION;
    if (text && sscanf(text, "%d %d %d %d", &rank, &count, &code, &heard) != 4) return MPS_E_ARG;
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
