/* SPDX-License-Identifier: BSD-3-Clause */
/* The MPI engine against the kit, under mpirun; also with messages split into small pieces, like
 * those of more than 2^31 bytes. */
#include "mpi_engine.h"
#include "engine_kit.h"
#include <stdio.h>
#include <string.h>

static int wrong;

/* Rank 0 prints the first fault of all ranks. */
static void report(const char *what, const char *fault)
{
    int32_t rank, ranks;
    char text[ENGINE_TEXT];
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    for (int32_t r = 0; r < ranks; r++) {
        snprintf(text, sizeof text, "%s", fault);
        MPI_Bcast(text, sizeof text, MPI_CHAR, r, MPI_COMM_WORLD);
        if (!text[0]) continue;
        wrong = 1;
        if (rank == 0) printf("%s: rank %d says: %s\n", what, (int)r, text);
    }
}

static void check(int64_t chunk)
{
    char fault[ENGINE_TEXT] = "", what[80];
    const mps__mpi_start start = {.comm = MPI_COMM_WORLD, .chunk = chunk};
    const mps_ranks_ops ops = mps__mpi_table(&start);
    engine_kit_check(&ops, 1.05, fault);
    snprintf(what, sizeof what, "calls, pieces of %lld", (long long)chunk);
    report(what, fault);
}

static void check_failure(int call, int32_t also)
{
    char fault[ENGINE_TEXT] = "", said[ENGINE_TEXT] = "", first[ENGINE_TEXT], what[80];
    const mps__mpi_start start = {.comm = MPI_COMM_WORLD};
    const mps_ranks_ops ops = mps__mpi_table(&start);
    engine_kit_fail(&ops, call, also, said, fault);
    memcpy(first, said, sizeof first);
    MPI_Bcast(first, sizeof first, MPI_CHAR, 0, MPI_COMM_WORLD);
    if (!fault[0] && strcmp(first, said) != 0)
        snprintf(fault, sizeof fault, "'%.150s' is not the text of rank 0, '%.150s'", said, first);
    snprintf(what, sizeof what, "failure in call %d, %d fails too", call, (int)also);
    report(what, fault);
}

int main(int argc, char **argv)
{
    int32_t ranks;
    MPI_Init(&argc, &argv);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    check(0);
    check(4099);
    for (int call = 0; call < ENGINE_CALLS; call++) {
        check_failure(call, -1);
        for (int32_t also = 0; also < 2 && also < ranks; also++) check_failure(call, also);
    }
    check(0); /* after failures of other engines */
    MPI_Finalize();
    return wrong;
}
