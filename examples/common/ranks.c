/* SPDX-License-Identifier: BSD-3-Clause */
/* MPI is in a module beside the drivers, which is loaded for --mpi: drivers run where there is no MPI, too. */
#include "ranks.h"
#include "cli.h"
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A rank that exits waits for the others to hear of it [s]. */
static const double patience = 20;

static struct {
    const ranks_engine *engine; /* NULL: without --mpi */
    int rank, count;            /* count 0: as 1 */
    mps_sim *sim;
    FILE *kept; /* messages of another rank than 0 */
    char *text;
    size_t size;
} self;

/* ---- the beginning ---- */

static _Noreturn void refuse_module(const char *program)
{
    fprintf(stderr,
            "%s: --mpi: %s; it is built with the drivers where there are MPI and Zoltan (Debian: "
            "libopenmpi-dev, libtrilinos-zoltan-dev): cmake -DMPS_WITH_MPI=ON; of the packages of "
            "libmps --mpi needs libmps-mpi1\n",
            program, dlerror());
    exit(CLI_USAGE);
}

/* A number that mpirun of Open MPI, or of MPICH and others, gives to each process. */
static int started_with(const char *openmpi, const char *pmi)
{
    const char *text = getenv(openmpi);
    if (!text) text = getenv(pmi);
    return text ? atoi(text) : 0;
}

/* Several processes that are not one run would all write to the same folder. */
static void check_alone(const char *program)
{
    const int count = started_with("OMPI_COMM_WORLD_SIZE", "PMI_SIZE");
    if (count < 2) return;
    if (started_with("OMPI_COMM_WORLD_RANK", "PMI_RANK") == 0)
        fprintf(stderr,
                "%s: mpirun started %d processes: --mpi makes one run of them; without it start "
                "one process\n",
                program, count);
    else
        sleep(1); /* mpirun ends all processes with the first one that exits so */
    exit(CLI_USAGE);
}

static void finish(void)
{
    self.engine->end();
    if (self.kept) fclose(self.kept);
    free(self.text);
}

/* From the folder of the program, or where the system has libraries. */
static void *open_module(void)
{
    static const char name[] = "mps_drivers_mpi.so";
    char path[1024];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - sizeof name);
    while (length > 0 && path[length - 1] != '/') length--;
    if (length < 0) length = 0;
    memcpy(path + length, name, sizeof name);
    return dlopen(length > 0 && access(path, F_OK) == 0 ? path : name, RTLD_NOW | RTLD_GLOBAL);
}

bool ranks_begin(const char *program, int argc, char **argv)
{
    bool wanted = false;
    for (int i = 1; i < argc; i++) wanted = wanted || strcmp(argv[i], "--mpi") == 0;
    if (!wanted) check_alone(program);
    if (!wanted || self.engine) return wanted;
    void *module = open_module();
    self.engine = module ? dlsym(module, "mps_drivers_mpi") : NULL;
    if (!self.engine) refuse_module(program);
    self.engine->begin(&self.rank, &self.count);
    if (self.rank > 0) self.kept = open_memstream(&self.text, &self.size);
    atexit(finish);
    return true;
}

bool ranks_first(void)
{
    return self.rank == 0;
}

int ranks_count(void)
{
    return self.count > 0 ? self.count : 1;
}

FILE *ranks_messages(void)
{
    return self.kept ? self.kept : stderr;
}

mps_status ranks_attach(mps_sim *sim)
{
    self.sim = sim;
    return self.engine ? self.engine->attach(sim) : MPS_OK;
}

void ranks_detach(void)
{
    mps_sim_destroy(self.sim);
    self.sim = NULL;
}

/* ---- deciding together ---- */

/* What ranks combine; LEAVES: 0, or 1 + exit code; TELLS: of the ranks that leave, the lowest has the largest number. */
enum { VALUE, LEAVES, TELLS, VALUES };

static _Noreturn void leave(int code)
{
    ranks_detach();
    exit(code);
}

int ranks_most(int value)
{
    int values[VALUES] = {[VALUE] = value};
    if (ranks_count() == 1) return value;
    self.engine->largest(VALUES, values, 0);
    if (values[LEAVES]) leave(values[LEAVES] - 1);
    return values[VALUE];
}

void ranks_largest(int count, double *values)
{
    ranks_most(0);
    if (ranks_count() > 1) self.engine->largest_numbers(count, values);
}

int ranks_told(int value)
{
    return ranks_most(ranks_first() ? value : 0);
}

static void show_kept(void)
{
    if (!self.kept) return;
    fflush(self.kept);
    fputs(self.text, stderr);
}

_Noreturn void ranks_exit(int code)
{
    int values[VALUES] = {[LEAVES] = code + 1, [TELLS] = self.count - self.rank};
    if (ranks_count() == 1) leave(code);
    const bool heard = self.engine->largest(VALUES, values, patience);
    if (!heard || values[TELLS] == self.count - self.rank) show_kept();
    if (!heard) self.engine->abort(code);
    leave(values[LEAVES] - 1);
}

/* ---- particles ---- */

bool ranks_gather(mps_sim *sim)
{
    return ranks_count() == 1 || mps_particles_gather(sim) == MPS_OK;
}

void ranks_gather_end(mps_sim *sim)
{
    if (ranks_count() > 1) mps_particles_gather_end(sim);
}
