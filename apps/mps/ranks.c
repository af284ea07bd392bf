/* SPDX-License-Identifier: BSD-3-Clause */
/* One run of many processes: they start, refuse and end together, and each message is shown
 * once. */
#include "cli.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What ranks reduce: the exit code + 1 of failed ranks; the lowest of these has the largest
 * TELLS. */
enum { FAILS, TELLS, VALUES };

void cli_print(const choices *c, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    if (c->kept) {
        const size_t used = strlen(c->kept->text);
        vsnprintf(c->kept->text + used, sizeof c->kept->text - used, format, values);
    } else
        vfprintf(stderr, format, values);
    va_end(values);
}

static void show(const choices *c, bool speak)
{
    if (speak) fputs(c->kept->text, stderr);
    c->kept->text[0] = '\0';
}

int cli_begin(choices *c, int argc, char **argv)
{
    static cli_text kept;
    char error[640] = "";
    for (int i = 1; i < argc; i++) c->mpi = c->mpi || strcmp(argv[i], "--mpi") == 0;
    if (!c->mpi) return -1;
    kept.ranks.struct_size = sizeof kept.ranks;
    if (mps_job_ranks_load(&kept.ranks, error, sizeof error) != MPS_OK) {
        fprintf(stderr,
                "mps: --mpi: %s; it is built where there are MPI and Zoltan (Debian: "
                "libopenmpi-dev, libtrilinos-zoltan-dev): cmake -DMPS_WITH_MPI=ON; of the "
                "packages of libmps --mpi needs libmps-mpi1\n",
                error);
        return MPS_EXIT_USAGE;
    }
    c->kept = &kept;
    return -1;
}

/* A number that mpirun of Open MPI, or of MPICH and others, sets for each process. */
static int started_with(const char *openmpi, const char *pmi)
{
    const char *text = getenv(openmpi);
    if (!text) text = getenv(pmi);
    return text ? (int)strtol(text, NULL, 10) : 0;
}

int cli_check_alone(const choices *c)
{
    const int count = started_with("OMPI_COMM_WORLD_SIZE", "PMI_SIZE");
    if (c->kept || count < 2) return -1;
    if (started_with("OMPI_COMM_WORLD_RANK", "PMI_RANK") == 0)
        fprintf(stderr,
                "mps %s: mpirun started %d processes: --mpi of 'mps run' and 'mps resume' makes "
                "one run of them; without it start one process\n",
                c->verb, count);
    else
        sleep(1); /* mpirun ends all processes when the first one exits with a failure */
    return MPS_EXIT_USAGE;
}

int cli_agree(const choices *c, int code)
{
    if (!c->kept) return code;
    const mps_job_ranks *r = &c->kept->ranks;
    const int32_t number = code >= 0 ? r->count - r->rank : 0;
    int32_t values[VALUES] = {[FAILS] = code + 1, [TELLS] = number};
    r->largest(r->user, VALUES, values, 0);
    const bool all_go_on = values[FAILS] == 0;
    show(c, all_go_on ? r->rank == 0 : number > 0 && values[TELLS] == number);
    if (!all_go_on) r->end(r->user);
    return values[FAILS] - 1;
}

int cli_end(const choices *c, int code)
{
    int32_t speak;
    if (!c->kept) return code;
    const mps_job_ranks *r = &c->kept->ranks;
    const int32_t all = mps_job_ranks_exit(r, code, &speak);
    show(c, speak != 0);
    if (all < 0) r->abort(r->user, MPS_EXIT_FAILED);
    r->end(r->user);
    return all;
}
