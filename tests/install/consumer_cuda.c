/* SPDX-License-Identifier: BSD-3-Clause */
/* A program outside of the library that requests a GPU from the plug-in library libmps_cuda.
 * Without one it gets an error, and runs on the host. */
#include <mps/cuda.h>
#include <mps/mps.h>
#include <stdio.h>
#include <string.h>

int main(void)
{
    mps_config config;
    mps_sim *sim;
    mps_cuda_info info;
    char error[400] = "";
    mps_config_init(&config, sizeof config);
    config.dim = 2;
    config.dp = 0.1;
    if (mps_sim_create(&config, &sim) != MPS_OK) return 1;
    mps_cuda_info_init(&info, sizeof info);
    const mps_status there = mps_cuda_info_get(0, &info, error, sizeof error);
    const mps_status used = mps_cuda_use(sim, 0);
    if (there == MPS_OK)
        printf("GPU 0 of %d: %s\n", (int)info.count, info.name);
    else
        printf("%s\n%s\n", error, mps_sim_error(sim));
    const int failed = there != used || (there != MPS_OK && !strstr(mps_sim_error(sim), error));
    mps_sim_destroy(sim);
    return failed;
}
