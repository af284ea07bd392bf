/* SPDX-License-Identifier: BSD-3-Clause */
/* A program outside of the library that runs on the ranks of MPI with the plug-in library
 * libmps_mpi. */
#include <mps/mpi.h>
#include <mps/mps.h>
#include <stdio.h>

static mps_status run(mps_sim *sim)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.3, 0.2, 0};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.6;
    tank.size[1] = 0.4;
    mps_status status = mps_mpi_attach(sim, MPI_COMM_WORLD);
    if (status == MPS_OK) status = mps_solver_use(sim, "sundials.pcg", "jacobi");
    if (status == MPS_OK) status = mps_tank_add(sim, &tank, NULL);
    if (status == MPS_OK) status = mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
    for (int k = 0; k < 3 && status >= 0; k++) status = mps_step(sim, 1, NULL);
    return status;
}

int main(int argc, char **argv)
{
    mps_config config;
    mps_sim *sim;
    int32_t rank = -1, ranks = 0;
    MPI_Init(&argc, &argv);
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    if (mps_sim_create(&config, &sim) != MPS_OK) return 1;
    const int failed = run(sim) < 0 || mps_sim_ranks(sim, &rank, &ranks) < 0;
    printf("rank %d of %d: %s\n", (int)rank, (int)ranks, failed ? mps_sim_error(sim) : "done");
    mps_sim_destroy(sim);
    MPI_Finalize();
    return failed;
}
