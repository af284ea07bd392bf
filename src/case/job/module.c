/* SPDX-License-Identifier: BSD-3-Clause */
/* Loads libraries on demand, so that programs run where these are not installed. */
#include "run.h"
#include "run_file.h"
#include <mps/device.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *mps__job_module(const char *name)
{
    char path[1200];
    const bool found = mps__program_file(name, MODULE_FOLDER, path, sizeof path);
    return dlopen(found ? path : name, RTLD_NOW | RTLD_GLOBAL);
}

/* ---- devices ---- */

/* The device number of "cuda:2"; of "cuda" that of MPS_CUDA_OF_RANK.
 * @return UNKNOWN: the text is neither */
enum { OF_RANK = -1, UNKNOWN = -2 };
static int number_of(const char *device)
{
    char *end;
    if (strcmp(device, "cuda") == 0) return OF_RANK;
    if (strncmp(device, "cuda:", 5) != 0 || device[5] < '0' || device[5] > '9') return UNKNOWN;
    const long number = strtol(device + 5, &end, 10);
    return *end || number > 1023 ? UNKNOWN : (int)number;
}

bool mps__job_device_known(const char *device)
{
    return number_of(device) != UNKNOWN;
}

bool mps__job_device(mps_job *job)
{
    typedef mps_status use_fn(mps_sim * sim, int32_t number);
    const char *device = job->config.device;
    use_fn *use;
    if (!device) return true;
    void *module = mps__job_module("libmps_cuda.so.1"),
         *symbol = module ? dlsym(module, "mps_cuda_use") : NULL;
    if (!symbol && mps__job_ranks(job) > 1) /* other ranks may have it and wait for this one */
        mps_sim_device_set(job->sim, NULL);
    if (!symbol)
        return mps__job_fail(job, MPS_EXIT_USAGE,
                             "device '%s': %s; it is built where clang and LLVM are: cmake "
                             "-DMPS_DEVICE=ON; of the packages of libmps it needs libmps-cuda1",
                             device, dlerror());
    memcpy(&use, &symbol, sizeof use); /* ISO C has no cast from void * to a function pointer */
    if (use(job->sim, number_of(device)) == MPS_OK) return true;
    return mps__job_fail(job, MPS_EXIT_USAGE, "%s", mps_sim_error(job->sim));
}
