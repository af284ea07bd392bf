/* SPDX-License-Identifier: BSD-3-Clause */
/* Decisions of all ranks. MPI is in a module that programs load on demand: they run without MPI
 * too. */
#include "run.h"
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

/* How long a rank that ends waits for the others to receive its exit code [s]. */
static const double PATIENCE = 20;

/* What ranks reduce; LEAVES: 0, or 1 + exit code; PRINTS: of the ranks that fail, the lowest has
 * the largest number. */
enum { VALUE, LEAVES, PRINTS, VALUES };

bool mps__job_first(const mps_job *job)
{
    return !job->config.ranks || job->config.ranks->rank == 0;
}

int32_t mps__job_ranks(const mps_job *job)
{
    return job->config.ranks ? job->config.ranks->count : 1;
}

int32_t mps__job_most(mps_job *job, int32_t value)
{
    const mps_job_ranks *r = job->config.ranks;
    int32_t values[VALUES] = {[VALUE] = value};
    if (mps__job_ranks(job) == 1) return value;
    r->largest(r->user, VALUES, values, 0);
    if (values[LEAVES] && !job->code) job->code = values[LEAVES] - 1;
    return values[VALUE];
}

int32_t mps__job_broadcast(mps_job *job, int32_t value)
{
    return mps__job_most(job, mps__job_first(job) ? value : 0);
}

bool mps__job_agree(mps_job *job)
{
    const mps_job_ranks *r = job->config.ranks;
    const int32_t number = r ? r->count - r->rank : 1;
    int32_t values[VALUES] = {[VALUE] = job->code, [PRINTS] = job->code ? number : 0};
    if (mps__job_ranks(job) > 1) r->largest(r->user, VALUES, values, 0);
    job->prints = job->code && values[PRINTS] == number;
    job->code = values[LEAVES] ? values[LEAVES] - 1 : values[VALUE];
    return !values[LEAVES] && job->code == 0;
}

bool mps__job_collect(const mps_job *job)
{
    return mps__job_ranks(job) == 1 || mps_particles_collect(job->sim) == MPS_OK;
}

void mps__job_collect_end(const mps_job *job)
{
    if (mps__job_ranks(job) > 1) mps_particles_collect_end(job->sim);
}

/* ---- programs ---- */

int32_t mps_job_ranks_exit(const mps_job_ranks *ranks, int32_t code, int32_t *speak)
{
    *speak = 1;
    if (!ranks || ranks->count == 1) return code;
    const int32_t number = ranks->count - ranks->rank;
    int32_t values[VALUES] = {[LEAVES] = code + 1, [PRINTS] = number};
    const bool received = ranks->largest(ranks->user, VALUES, values, PATIENCE) != 0;
    *speak = !received || values[PRINTS] == number;
    return received ? values[LEAVES] - 1 : -1;
}

mps_status mps_job_ranks_load(mps_job_ranks *ranks, char *error, size_t error_size)
{
    if (!ranks || !error || error_size == 0) return MPS_E_ARG;
    *ranks = (mps_job_ranks){.struct_size = sizeof *ranks};
    void *module = mps__job_module("mps_drivers_mpi.so"),
         *symbol = module ? dlsym(module, "mps_drivers_mpi") : NULL;
    mps_job_ranks_begin_fn begin;
    if (!symbol) {
        snprintf(error, error_size, "%s", dlerror());
        return MPS_E_IO;
    }
    memcpy(&begin, &symbol, sizeof begin); /* ISO C has no cast from void * to a function pointer */
    const mps_status status = begin(ranks);
    if (status != MPS_OK)
        snprintf(error, error_size, "mps_drivers_mpi.so is of another version of libmps_case");
    return status;
}
